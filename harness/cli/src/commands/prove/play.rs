//! All rounds are played, as many at once as there are processors.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::rounds::Round;
use super::tally::Tally;
use crate::complaint::Complaint;
use crate::player::{self, Plan};
use crate::progress::Progress;

/// Plays one round. A device that cannot be put back stops its lane; the cases after that one are played on a fresh
/// device, for each is to show what it catches.
fn play_round(plan: &Plan, round: &Round, stop: &AtomicBool) -> Result<Tally, Complaint> {
    let mut tally = Tally::default();
    let mut plan = Plan {
        behaviour: round.behaviour.clone(),
        ..plan.clone()
    };
    loop {
        let stops = tally.stops.len();
        let tried = tally.tried.len();
        player::play(&round.device, &plan, &mut tally, stop)
            .map_err(|error| Complaint::bench(error.to_string()))?;
        let whole = tally.stops.len() == stops;
        let nothing_new = tally.tried.len() == tried;
        if whole || nothing_new || stop.load(Ordering::Relaxed) {
            return Ok(tally);
        }
        plan.except.clone_from(&tally.tried);
    }
}

/// Plays all rounds, as many at once as there are processors.
pub(super) fn play_all(
    plan: &Plan,
    rounds: &[Round],
    stop: &AtomicBool,
    shown: bool,
) -> Result<Vec<Tally>, Complaint> {
    let next = AtomicUsize::new(0);
    let progress = Progress::new(rounds.len() as u64, shown);
    let done: Mutex<BTreeMap<usize, Tally>> = Mutex::default();
    let work = || -> Result<(), Complaint> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(round) = rounds.get(index) else {
                return Ok(());
            };
            let tally = play_round(plan, round, stop)?;
            done.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(index, tally);
            progress.step();
        }
    };
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let worked: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..processors).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(thread::ScopedJoinHandle::join)
            .collect()
    });
    progress.clear();
    for worked in worked {
        worked.unwrap_or_else(|_| Err(Complaint::bench("a lane broke down")))?;
    }
    Ok(done
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
        .into_values()
        .collect())
}
