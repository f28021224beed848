//! The folder that reports are in, and all of them made from its journal. A file appears there whole or not at all.

pub(crate) mod manifest;

use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, UNIX_EPOCH};

use fieldproof_record::{Entry, Event, JournalError, JournalReader, RunFinished, RunStarted};
use fieldproof_report::junit::{JunitLane, SuiteHead, assemble};
use fieldproof_report::{Candump, Html, Json, LaneSummary, Pcapng, Problem, Severity, Tap};
use tempfile::NamedTempFile;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::journal::JOURNAL;

/// What a folder of reports came to.
pub(crate) struct Made {
    /// The first line of its journal.
    pub(crate) start: RunStarted,
    /// What the lanes came to.
    pub(crate) lanes: Vec<LaneSummary>,
}

/// Lines of a journal are read in pieces of this size.
const READ_BYTES: usize = 1 << 18;

/// The traffic is in a folder of its own.
const TRAFFIC: &str = "traffic";

/// Every report but the traffic.
const REPORTS: [&str; 5] = [
    "junit.xml",
    "report.html",
    "report.json",
    "report.tap",
    manifest::NAME,
];

/// Takes away what an earlier run left in `folder`, so that nobody takes it for this one's.
pub(crate) fn clear(folder: &Path) -> Result<(), Complaint> {
    let remove = |path: PathBuf| match fs::remove_file(&path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(Complaint::unwritable(path.display(), &error))
        }
        _ => Ok(()),
    };
    for name in REPORTS {
        remove(folder.join(name))?;
    }
    let Ok(traffic) = fs::read_dir(folder.join(TRAFFIC)) else {
        return Ok(());
    };
    for file in traffic.flatten() {
        let path = file.path();
        if path
            .extension()
            .is_some_and(|it| it == "log" || it == "pcapng")
        {
            remove(path)?;
        }
    }
    Ok(())
}

/// Makes every report in `folder` from the journal that is there.
pub(crate) fn make(folder: &Path) -> Result<Made, Complaint> {
    let journal = folder.join(JOURNAL);
    let (start, finished, lanes) = Making::new(folder, &journal)?.make()?;
    let mut files: Vec<String> = vec![JOURNAL.to_owned()];
    files.extend(REPORTS[..REPORTS.len() - 1].iter().map(|&it| it.to_owned()));
    for lane in &start.lanes {
        files.extend(traffic_names(&lane.device));
    }
    files.sort();
    drop(finished);
    manifest::write(folder, &files)?;
    Ok(Made { start, lanes })
}

fn traffic_names(device: &str) -> [String; 2] {
    [
        format!("{TRAFFIC}/{device}.log"),
        format!("{TRAFFIC}/{device}.pcapng"),
    ]
}

type Out = BufWriter<NamedTempFile>;

/// Everything that is made of a journal.
struct Making<'a> {
    folder: &'a Path,
    journal: &'a Path,
    start: RunStarted,
    /// When the lanes were opened, since 1970.
    started: Duration,
    html: Html<File>,
    json: Json<Out>,
    tap: Tap<Out>,
    junit: Vec<(Vec<SuiteHead>, File)>,
    finished: Option<RunFinished>,
    lanes: Vec<LaneSummary>,
}

impl<'a> Making<'a> {
    fn new(folder: &'a Path, journal: &'a Path) -> Result<Making<'a>, Complaint> {
        let start = reader(journal)?.start().clone();
        let started = humantime::parse_rfc3339(&start.started)
            .ok()
            .and_then(|at| at.duration_since(UNIX_EPOCH).ok());
        let begin = || -> io::Result<Making<'a>> {
            fs::create_dir_all(folder.join(TRAFFIC))?;
            let out = || temporary(folder).map(BufWriter::new);
            Ok(Making {
                folder,
                journal,
                started: started.unwrap_or_default(),
                html: Html::new(&start, tempfile::tempfile_in(folder)?),
                json: Json::new(out()?, &start)?,
                tap: Tap::new(out()?, start.strict)?,
                junit: Vec::new(),
                finished: None,
                lanes: Vec::new(),
                start,
            })
        };
        begin().map_err(|error| Complaint::unwritable(folder.display(), &error))
    }

    #[allow(clippy::type_complexity, reason = "told once, used once")]
    fn make(mut self) -> Result<(RunStarted, Option<RunFinished>, Vec<LaneSummary>), Complaint> {
        for lane in 0..self.start.lanes.len() {
            self.lane(lane)?;
        }
        let folder = self.folder;
        self.finish()
            .map_err(|error| Complaint::unwritable(folder.display(), &error))
    }

    fn lane(&mut self, lane: usize) -> Result<(), Complaint> {
        let planned = self.start.lanes[lane].clone();
        let folder = self.folder;
        let unwritable = |error: io::Error| Complaint::unwritable(folder.display(), &error);
        let mut makers = Makers::new(self, &planned.device).map_err(unwritable)?;
        let mut summary = LaneSummary {
            device: planned.device.clone(),
            ..LaneSummary::default()
        };
        let mut reader = reader(self.journal)?;
        let number = u32::try_from(lane).unwrap_or(u32::MAX);
        loop {
            match reader.entry(Some(number)) {
                Ok(Some(Entry::Lane(_, event))) => {
                    summary.event(&event);
                    makers.event(self, &event).map_err(unwritable)?;
                }
                Ok(Some(Entry::RunFinished(end))) => self.finished = Some(end),
                Ok(Some(Entry::RunStarted(_))) => {}
                Ok(None) => break,
                Err(error) => return Err(unreadable(self.journal, &error)),
            }
        }
        let early = incomplete(&summary, planned.cases);
        makers.finish(self, early.as_deref()).map_err(unwritable)?;
        self.lanes.push(summary);
        Ok(())
    }

    fn finish(mut self) -> io::Result<(RunStarted, Option<RunFinished>, Vec<LaneSummary>)> {
        let incomplete: Vec<String> = self
            .lanes
            .iter()
            .zip(&self.start.lanes)
            .filter_map(|(lane, planned)| incomplete(lane, planned.cases))
            .collect();
        let incomplete = (!incomplete.is_empty()).then(|| incomplete.join("; "));
        let json = self
            .json
            .finish(self.finished.as_ref(), incomplete.as_deref())?;
        keep(json, &self.folder.join("report.json"))?;
        let mut html = BufWriter::new(temporary(self.folder)?);
        self.html.finish(&mut html, incomplete.as_deref())?;
        keep(html, &self.folder.join("report.html"))?;
        let tap = self.tap.finish(incomplete.as_deref())?;
        keep(tap, &self.folder.join("report.tap"))?;
        let mut junit = BufWriter::new(temporary(self.folder)?);
        assemble(&mut junit, std::mem::take(&mut self.junit))?;
        keep(junit, &self.folder.join("junit.xml"))?;
        Ok((self.start, self.finished, self.lanes))
    }
}

/// What is made of one lane.
struct Makers {
    junit: JunitLane<BufWriter<File>>,
    candump: Candump<Out>,
    pcapng: Pcapng<Out>,
    names: [String; 2],
}

impl Makers {
    fn new(making: &mut Making<'_>, device: &str) -> io::Result<Makers> {
        making.html.begin_lane(device);
        making.json.begin_lane(device)?;
        let out = || temporary(making.folder).map(BufWriter::new);
        let junit = BufWriter::new(tempfile::tempfile_in(making.folder)?);
        Ok(Makers {
            junit: JunitLane::new(junit, making.start.strict),
            candump: Candump::new(out()?, making.started),
            pcapng: Pcapng::new(out()?, making.started, &making.start.tool)?,
            names: traffic_names(device),
        })
    }

    fn event(&mut self, making: &mut Making<'_>, event: &Event) -> io::Result<()> {
        making.html.event(event)?;
        making.json.event(event)?;
        making.tap.event(event)?;
        self.junit.event(event);
        self.candump.event(event)?;
        self.pcapng.event(event)
    }

    fn finish(mut self, making: &mut Making<'_>, early: Option<&str>) -> io::Result<()> {
        making.json.end_lane()?;
        if let Some(why) = early {
            self.junit.ended_early(why)?;
        }
        let (cases, heads) = self.junit.finish()?;
        let mut cases = cases.into_inner()?;
        cases.rewind()?;
        making.junit.push((heads, cases));
        let [log, pcapng] = &self.names;
        keep(self.candump.finish()?, &making.folder.join(log))?;
        keep(self.pcapng.finish()?, &making.folder.join(pcapng))
    }
}

/// Why this lane is not all that was to be played.
fn incomplete(lane: &LaneSummary, planned: u64) -> Option<String> {
    let device = &lane.device;
    let there = lane.counts.total();
    if let Some(reason) = &lane.stopped {
        return Some(format!(
            "{device} was stopped: {reason}; {there} of {planned} cases were played"
        ));
    }
    (!lane.complete).then(|| {
        format!("{device} did not come to its end; {there} of {planned} cases were played")
    })
}

pub(crate) fn reader(journal: &Path) -> Result<JournalReader<BufReader<File>>, Complaint> {
    let file = File::open(journal).map_err(|error| unreadable(journal, &error.into()))?;
    JournalReader::new(BufReader::with_capacity(READ_BYTES, file))
        .map_err(|error| unreadable(journal, &error))
}

pub(crate) fn unreadable(journal: &Path, error: &JournalError) -> Complaint {
    let message = match error {
        JournalError::Io(error) => format!("cannot be read: {error}"),
        other => other.to_string(),
    };
    Complaint {
        problems: vec![
            Problem::new(Severity::Error, message).in_file(journal.display().to_string()),
        ],
        exit: Exit::WrongInput,
    }
}

/// A file that is gone if it is not kept.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".fieldproof-");
    #[cfg(unix)]
    {
        // As any other file: readable for those whom the user's mask lets read.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn keep(mut file: Out, path: &Path) -> io::Result<()> {
    file.flush()?;
    let named =
        |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
    file.into_inner()?
        .persist(path)
        .map_err(|error| named(error.error))?;
    Ok(())
}
