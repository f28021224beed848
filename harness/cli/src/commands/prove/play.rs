//! All rounds are played, as many at once as there are processors.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use super::rounds::Round;
use super::tally::Tally;
use super::watch::{Watched, watch};
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

/// Plays all rounds, as many at once as there are processors. None of them takes longer than `limit`.
pub(super) fn play_all(
    plan: &Plan,
    rounds: &[Round],
    limit: Duration,
    stop: &AtomicBool,
    shown: bool,
) -> Result<Vec<Tally>, Complaint> {
    let next = AtomicUsize::new(0);
    let all_done = AtomicBool::new(false);
    let watched: Vec<Watched> = rounds.iter().map(|_| Watched::default()).collect();
    let progress = Progress::new(rounds.len() as u64, shown);
    let done: Mutex<BTreeMap<usize, Tally>> = Mutex::default();
    let work = || -> Result<(), Complaint> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let (Some(round), Some(watched)) = (rounds.get(index), watched.get(index)) else {
                return Ok(());
            };
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            watched.begin();
            let mut tally = play_round(plan, round, &watched.stop)?;
            watched.end();
            tally.hung = watched.hung();
            done.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(index, tally);
            progress.step();
        }
    };
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let worked: Vec<_> = thread::scope(|scope| {
        scope.spawn(|| watch(&watched, limit, stop, &all_done));
        let workers: Vec<_> = (0..processors).map(|_| scope.spawn(work)).collect();
        let worked = workers
            .into_iter()
            .map(thread::ScopedJoinHandle::join)
            .collect();
        all_done.store(true, Ordering::Relaxed);
        worked
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
