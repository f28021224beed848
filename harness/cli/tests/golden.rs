//! The command line as a user sees it: each folder below `tests/golden` is a call of the program.
//!
//! | file | meaning |
//! | --- | --- |
//! | `cmd` | the arguments, separated by spaces; several lines are calls one after the other |
//! | `files/` | what lies in the folder that it is called in |
//! | `stdout`, `stderr` | what the calls print, in which the wall time is `T`; no file for nothing |
//! | `exit` | the exit code of each call |
//! | `written` | the files that are there afterwards and were not before; no file for none |
//!
//! With `UPDATE_GOLDEN` set, what comes is written in the place of what is expected.

#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod support;

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use libtest_mimic::{Arguments, Failed, Trial};
use support::{Folder, collect};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut folders: Vec<_> = fs::read_dir(golden)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    folders.sort();
    let trials = folders
        .into_iter()
        .map(|folder| {
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            Trial::test(name, move || test(&folder))
        })
        .collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn test(golden: &Path) -> Result<(), Failed> {
    let folder = Folder::new();
    copy(&golden.join("files"), &folder);
    let before = folder.files();
    let (mut out, mut error, mut exits) = (String::new(), String::new(), String::new());
    let calls = fs::read_to_string(golden.join("cmd"))?;
    for call in calls.lines() {
        let arguments: Vec<&str> = call.split_whitespace().collect();
        let ran = folder.run(&arguments);
        out.push_str(&ran.out());
        error.push_str(&ran.error());
        exits.push_str(&format!(
            "{}\n",
            ran.exit().ok_or("the program was killed")?
        ));
    }
    let written: String = folder
        .files()
        .iter()
        .filter(|file| !before.contains(file))
        .map(|file| format!("{file}\n"))
        .collect();
    let mut wrong = String::new();
    for (name, came) in [
        ("exit", exits),
        ("stderr", error),
        ("stdout", without_wall_time(&out)),
        ("written", written),
    ] {
        wrong.push_str(&compare(&golden.join(name), &came));
    }
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(Failed::from(wrong)),
    }
}

/// What is wrong with `came`, if anything.
fn compare(path: &Path, came: &str) -> String {
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        match came.is_empty() {
            true => drop(fs::remove_file(path)),
            false => fs::write(path, came).unwrap(),
        }
    }
    let expected = fs::read_to_string(path).unwrap_or_default();
    if expected == came {
        return String::new();
    }
    let name = path.file_name().unwrap().to_string_lossy();
    format!("--- {name}: expected\n{expected}--- {name}: came\n{came}---\n")
}

fn copy(from: &Path, to: &Folder) {
    if !from.is_dir() {
        return;
    }
    let mut files = Vec::new();
    collect(from, &mut files);
    for file in files {
        let name = file
            .strip_prefix(from)
            .unwrap()
            .to_string_lossy()
            .into_owned();
        to.write(&name, fs::read(&file).unwrap());
    }
}

/// The only thing that differs from run to run.
fn without_wall_time(text: &str) -> String {
    const BEFORE: &str = "played in ";
    text.split_inclusive('\n')
        .map(|line| match line.split_once(BEFORE) {
            Some((before, _)) => format!("{before}{BEFORE}T\n"),
            None => line.to_owned(),
        })
        .collect()
}
