//! The folder that reports are written to. A file appears there whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek};
use std::path::{Path, PathBuf};

use fieldproof_record::{Event, Journal, Sink};
use fieldproof_report::junit::{JunitLane, SuiteHead, assemble};
use tempfile::NamedTempFile;

use crate::complaint::Complaint;

/// The folder.
pub(crate) struct Reports {
    folder: PathBuf,
}

/// What is written of one lane while it is played.
pub(crate) struct LaneReports {
    path: PathBuf,
    journal: Journal<BufWriter<NamedTempFile>>,
    junit: JunitLane<BufWriter<File>>,
}

/// The cases of a finished lane for the JUnit file.
pub(crate) type LaneCases = (Vec<SuiteHead>, File);

impl Reports {
    /// Makes the folder if it is not there.
    pub(crate) fn open(folder: &Path) -> Result<Reports, Complaint> {
        fs::create_dir_all(folder).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => {
                let error = io::Error::new(error.kind(), "it is there and no folder");
                Complaint::unwritable(folder.display(), &error)
            }
            _ => Complaint::unwritable(folder.display(), &error),
        })?;
        Ok(Reports {
            folder: folder.to_owned(),
        })
    }

    /// Begins the reports of the lane of `device`.
    pub(crate) fn lane(&self, device: &str, strict: bool) -> Result<LaneReports, Complaint> {
        let path = self.folder.join(format!("{device}.jsonl"));
        let unwritable = |error: io::Error| Complaint::unwritable(path.display(), &error);
        let journal = self.temporary().map_err(unwritable)?;
        let junit = tempfile::tempfile_in(&self.folder).map_err(unwritable)?;
        Ok(LaneReports {
            journal: Journal::new(BufWriter::new(journal)),
            junit: JunitLane::new(BufWriter::new(junit), strict),
            path,
        })
    }

    /// Writes `junit.xml` of all lanes.
    pub(crate) fn junit(&self, lanes: Vec<LaneCases>) -> Result<(), Complaint> {
        let path = self.folder.join("junit.xml");
        let write = || -> io::Result<()> {
            let mut out = BufWriter::new(self.temporary()?);
            assemble(&mut out, lanes)?;
            keep(out, &path)
        };
        write().map_err(|error| Complaint::unwritable(path.display(), &error))
    }

    /// A file that is gone if it is not kept.
    fn temporary(&self) -> io::Result<NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".fieldproof-");
        #[cfg(unix)]
        {
            // As any other file: readable for those whom the user's mask lets read.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        builder.tempfile_in(&self.folder)
    }
}

impl LaneReports {
    /// Puts the journal in its place.
    pub(crate) fn finish(self) -> Result<LaneCases, Complaint> {
        let LaneReports {
            path,
            journal,
            junit,
        } = self;
        let write = || -> io::Result<LaneCases> {
            keep(journal.finish()?, &path)?;
            let (cases, heads) = junit.finish()?;
            let mut cases = cases.into_inner()?;
            cases.rewind()?;
            Ok((heads, cases))
        };
        write().map_err(|error| Complaint::unwritable(path.display(), &error))
    }
}

impl Sink for LaneReports {
    fn emit(&mut self, event: Event) {
        self.journal.write(&event);
        self.junit.event(&event);
    }
}

fn keep(file: BufWriter<NamedTempFile>, path: &Path) -> io::Result<()> {
    file.into_inner()?.persist(path)?;
    Ok(())
}
