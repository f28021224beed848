//! The journal of a run, written as it happens.
//!
//! What a case left is with the operating system when the case ends, so that nothing but the machine itself can lose it.
//! On real devices it is on the disk then, too. In simulation, where a thousand cases end in the time that a disk takes
//! for one, the disk follows as fast as it can. When a line cannot be written, the run is stopped.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use fieldproof_record::{Entry, Event, RunFinished, RunStarted, write_event};

use crate::complaint::Complaint;

/// The name of the journal in a folder of reports.
pub(crate) const JOURNAL: &str = "run.jsonl";

/// So much of a long case is kept at most before it is handed over.
const LARGEST_BUFFER: usize = 1 << 16;

/// The journal of a run.
pub(crate) struct RunJournal {
    shared: Arc<Shared>,
    disk: Option<JoinHandle<()>>,
    path: PathBuf,
}

struct Shared {
    state: Mutex<State>,
    wake: Condvar,
    stop: &'static AtomicBool,
    file: File,
}

#[derive(Default)]
struct State {
    failed: Option<io::Error>,
    /// Something was written that is not known to be on the disk.
    unsynced: bool,
    finished: bool,
}

impl RunJournal {
    /// Begins the journal in `folder`, which is made if it is not there. `stop` is set when a line cannot be written.
    pub(crate) fn open(
        folder: &Path,
        start: &RunStarted,
        stop: &'static AtomicBool,
    ) -> Result<RunJournal, Complaint> {
        fs::create_dir_all(folder).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => {
                let error = io::Error::new(error.kind(), "it is there and no folder");
                Complaint::unwritable(folder.display(), &error)
            }
            _ => Complaint::unwritable(folder.display(), &error),
        })?;
        let path = folder.join(JOURNAL);
        let begin = || -> io::Result<File> {
            let mut file = File::create(&path)?;
            let mut line = Vec::new();
            Entry::RunStarted(Box::new(start.clone())).write(&mut line)?;
            file.write_all(&line)?;
            file.sync_all()?;
            // The name is on the disk when the folder is.
            #[cfg(unix)]
            File::open(folder)?.sync_all()?;
            Ok(file)
        };
        let file = begin().map_err(|error| Complaint::unwritable(path.display(), &error))?;
        let shared = Arc::new(Shared {
            state: Mutex::default(),
            wake: Condvar::new(),
            stop,
            file,
        });
        let for_disk = Arc::clone(&shared);
        let disk = thread::spawn(move || for_disk.follow());
        Ok(RunJournal {
            shared,
            disk: Some(disk),
            path,
        })
    }

    /// Where lane number `lane` writes. What happens `live` is handed over at once and waits for the disk after each
    /// case.
    pub(crate) fn lane(&self, lane: usize, live: bool) -> LaneJournal {
        LaneJournal {
            shared: Arc::clone(&self.shared),
            lane: u32::try_from(lane).unwrap_or(u32::MAX),
            live,
            buffer: Vec::new(),
        }
    }

    /// Ends the journal: all of it is on the disk then.
    pub(crate) fn finish(mut self, end: RunFinished) -> Result<(), Complaint> {
        let mut line = Vec::new();
        // Writing to memory cannot fail.
        let _ = Entry::RunFinished(end).write(&mut line);
        self.shared.append(&line);
        self.close();
        let failed = self.shared.lock().failed.take();
        match failed {
            Some(error) => Err(Complaint::unwritable(self.path.display(), &error)),
            None => Ok(()),
        }
    }

    fn close(&mut self) {
        self.shared.lock().finished = true;
        self.shared.wake.notify_all();
        if let Some(disk) = self.disk.take() {
            // It cannot panic.
            let _ = disk.join();
        }
    }
}

impl Drop for RunJournal {
    fn drop(&mut self) {
        self.close();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whole lines, those of other lanes before or after them.
    fn append(&self, lines: &[u8]) {
        let mut state = self.lock();
        if state.failed.is_some() {
            return;
        }
        match (&self.file).write_all(lines) {
            Ok(()) => state.unsynced = true,
            Err(error) => self.fail(&mut state, error),
        }
    }

    fn sync(&self) {
        self.lock().unsynced = false;
        if let Err(error) = self.file.sync_data() {
            self.fail(&mut self.lock(), error);
        }
    }

    fn fail(&self, state: &mut State, error: io::Error) {
        state.failed.get_or_insert(error);
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Keeps the disk as close behind as it can be.
    fn follow(&self) {
        loop {
            let mut state = self.lock();
            while !state.unsynced && !state.finished {
                state = self
                    .wake
                    .wait(state)
                    .unwrap_or_else(PoisonError::into_inner);
            }
            let (unsynced, finished) = (state.unsynced, state.finished);
            drop(state);
            if unsynced {
                self.sync();
            }
            if finished {
                return;
            }
        }
    }
}

/// Where one lane writes.
pub(crate) struct LaneJournal {
    shared: Arc<Shared>,
    lane: u32,
    live: bool,
    buffer: Vec<u8>,
}

impl LaneJournal {
    fn hand_over(&mut self) {
        self.shared.append(&self.buffer);
        self.buffer.clear();
    }
}

impl LaneJournal {
    /// One more event of the lane.
    pub(crate) fn write(&mut self, event: &Event) {
        // Writing to memory cannot fail.
        let _ = write_event(&mut self.buffer, self.lane, event);
        let case_ends = matches!(event, Event::CaseFinished(_) | Event::LaneFinished(_));
        if !self.live && !case_ends && self.buffer.len() < LARGEST_BUFFER {
            return;
        }
        self.hand_over();
        match (case_ends, self.live) {
            (false, _) => {}
            (true, true) => self.shared.sync(),
            (true, false) => self.shared.wake.notify_one(),
        }
    }
}

impl Drop for LaneJournal {
    fn drop(&mut self) {
        self.hand_over();
    }
}
