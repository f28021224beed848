//! Several lanes at once, one thread each.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};
use std::thread;

use fieldproof_record::{Event, Sink};
use fieldproof_report::{Console, ConsoleOptions, LaneSummary};

use crate::complaint::Complaint;
use crate::journal::{LaneJournal, RunJournal};
use crate::library::Device;
use crate::player::{self, Plan};
use crate::progress::Progress;
use crate::screen::Screen;

/// What all lanes show themselves on.
pub(super) struct Stage<'s> {
    shown: Mutex<Shown<'s>>,
    progress: Progress,
    text: bool,
}

struct Shown<'s> {
    console: Console,
    screen: &'s mut Screen,
}

impl<'s> Stage<'s> {
    /// For lanes of these devices. Without `text`, nothing is printed.
    pub(super) fn new(
        devices: &[&str],
        options: ConsoleOptions,
        progress: Progress,
        text: bool,
        screen: &'s mut Screen,
    ) -> Stage<'s> {
        Stage {
            shown: Mutex::new(Shown {
                console: Console::new(devices, options),
                screen,
            }),
            progress,
            text,
        }
    }

    /// What the lanes came to, and the screen for others.
    pub(super) fn leave(self) -> (Vec<LaneSummary>, &'s mut Screen) {
        self.progress.clear();
        let shown = self
            .shown
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        (shown.console.summaries(), shown.screen)
    }

    fn show(&self, change: impl FnOnce(&mut Console) -> String) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let text = change(&mut shown.console);
        if self.text && !text.is_empty() {
            self.progress.suspend(|| shown.screen.print(&text));
        }
    }
}

/// Where the events of one lane go.
struct LaneSink<'a, 's> {
    stage: &'a Stage<'s>,
    lane: usize,
    device: String,
    journal: LaneJournal,
}

impl Sink for LaneSink<'_, '_> {
    fn emit(&mut self, event: Event) {
        // What is shown is kept already.
        self.journal.write(&event);
        if Console::wants(&event) {
            match &event {
                Event::LaneStarted(lane) => self.device.clone_from(&lane.device),
                Event::CaseStarted(case) => self.stage.progress.begins(&self.device, &case.id),
                Event::CaseFinished(case) => {
                    let progress = &self.stage.progress;
                    progress.finished(self.lane, &self.device, &case.id);
                }
                _ => {}
            }
            self.stage.show(|console| console.event(self.lane, &event));
        }
    }
}

/// Plays every device in a thread of its own.
pub(super) fn play(
    devices: &[&Device],
    plan: &Plan,
    journal: &RunJournal,
    stage: &Stage<'_>,
    stop: &AtomicBool,
) -> Result<(), Complaint> {
    let play = |lane: usize, device: &Device| -> Result<(), Complaint> {
        let mut sink = LaneSink {
            stage,
            lane,
            device: device.name().to_owned(),
            journal: journal.lane(lane, !device.is_simulated()),
        };
        let played = player::play(device, plan, &mut sink, stop);
        stage.show(|console| console.end(lane));
        played.map_err(|error| Complaint::bench(error.to_string()))?;
        Ok(())
    };
    thread::scope(|scope| {
        let play = &play;
        let lanes: Vec<_> = devices
            .iter()
            .enumerate()
            .map(|(lane, device)| scope.spawn(move || play(lane, device)))
            .collect();
        lanes
            .into_iter()
            .zip(devices)
            .try_for_each(|(lane, device)| match lane.join() {
                Ok(played) => played,
                Err(_) => Err(Complaint::bench(format!(
                    "the lane of {} broke down",
                    device.name()
                ))),
            })
    })
}
