//! Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::complaint::Complaint;
use crate::exit::INTERRUPTED_TWICE;

static STOP: AtomicBool = AtomicBool::new(false);

/// From now on, the first Ctrl-C (or termination) sets the flag given back, so that devices are put back and reports
/// written; the second ends the program at once.
pub(crate) fn on_interrupt() -> Result<&'static AtomicBool, Complaint> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED_TWICE);
        }
    })
    .map_err(|error| Complaint::bench(format!("Ctrl-C cannot be watched: {error}")))?;
    Ok(&STOP)
}
