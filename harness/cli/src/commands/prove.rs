//! `fieldproof prove`: are the suites themselves any good? Every fault of every reference device must be caught by the
//! cases that are about it, every case must catch one, and without a fault, and in every legal variant, everything must
//! pass. A line in trouble must never make a case pass that it ought not.

mod judge;
mod play;
mod rounds;
mod show;
mod tally;
mod watch;

use std::sync::atomic::Ordering;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::Library;
use crate::options::{Format, ProveOptions};
use crate::player::Plan;
use crate::screen::Screen;
use crate::{select, stop};

/// Plays every suite against every fault and shows which case catches which.
pub(crate) fn prove(options: &ProveOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&options.selection)?;
    let plan = Plan {
        cases: options.selection.cases.clone(),
        ..Plan::default()
    };
    select::patterns_must_match(&library, &plan)?;
    let rounds = rounds::rounds(&library, &plan, options)?;
    let stop = stop::on_interrupt()?;
    let shown = options.format == Format::Text && Screen::shows_progress();
    let tallies = play::play_all(&plan, &rounds, watch::LIMIT, stop, shown)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Complaint::bench("interrupted"));
    }
    let proof = judge::judge(&rounds, &tallies, is_whole(options));
    match options.format {
        Format::Json => screen.print_json(&proof),
        Format::Text => screen.print(&show::text(&proof)),
    }
    Ok(match proof.holds {
        true => Exit::Passed,
        false => Exit::Failed,
    })
}

/// Whether everything is played. A case of a part may catch a fault that is not in it.
fn is_whole(options: &ProveOptions) -> bool {
    let selection = &options.selection;
    let all = [
        &selection.suites,
        &selection.devices,
        &selection.cases,
        &options.faults,
    ];
    all.into_iter().all(Vec::is_empty)
}
