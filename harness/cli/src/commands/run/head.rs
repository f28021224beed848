//! The first and the last line of a run's journal.

use std::env;

use fieldproof_record::{FORMAT, PlannedLane, RunFinished, RunStarted, UsedFile};

use crate::complaint::Complaint;
use crate::day::now;
use crate::input;
use crate::library::Device;
use crate::options::{DepthName, RunOptions};
use crate::player::{Plan, TOOL};
use crate::reports::manifest::sha256;

/// What is about to be played, and the hash of everything it is played from.
pub(super) fn run_started(
    devices: &[&Device],
    plan: &Plan,
    options: &RunOptions,
) -> Result<RunStarted, Complaint> {
    let mut files: Vec<UsedFile> = Vec::new();
    if let Some(bench) = &options.bench {
        let bytes = input::read_bytes(bench).map_err(|problem| Complaint::input(*problem))?;
        files.push(UsedFile {
            kind: "bench".to_owned(),
            path: bench.display().to_string(),
            sha256: sha256(&bytes),
        });
    }
    let mut lanes = Vec::new();
    for device in devices {
        device.files.iter().for_each(|file| add(&mut files, file));
        let suites = plan.suites(device);
        for (suite, _) in &suites {
            if files.iter().all(|file| file.path != suite.path) {
                files.push(UsedFile {
                    kind: "suite".to_owned(),
                    path: suite.path.clone(),
                    sha256: sha256(suite.text().as_bytes()),
                });
            }
        }
        let cases: usize = suites.iter().map(|(_, cases)| cases).sum();
        lanes.push(PlannedLane {
            device: device.name().to_owned(),
            cases: cases as u64,
            simulated: device.is_simulated(),
            files: device.files.iter().map(|it| it.path.clone()).collect(),
        });
    }
    Ok(RunStarted {
        format: FORMAT,
        tool: TOOL.to_owned(),
        started: now(),
        arguments: env::args().skip(1).collect(),
        settings: options.settings.iter().map(|it| it.0.clone()).collect(),
        bench: options
            .bench
            .as_ref()
            .map(|bench| bench.display().to_string()),
        strict: options.strict,
        depth: match options.depth {
            DepthName::Default => "default".to_owned(),
            DepthName::Full => "full".to_owned(),
        },
        seed: options.seed,
        files,
        lanes,
    })
}

/// The end of a run, now.
pub(super) fn run_finished() -> RunFinished {
    RunFinished { finished: now() }
}

/// Each file once.
fn add(files: &mut Vec<UsedFile>, file: &UsedFile) {
    if !files.contains(file) {
        files.push(file.clone());
    }
}
