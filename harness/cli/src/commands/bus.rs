//! `fieldproof bus`

use fieldproof_link::real::{Hub, HubOptions};
use fieldproof_report::{Problem, Severity};

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::options::BusOptions;
use crate::screen::Screen;
use crate::stop;

/// Prints the links of a bus without adapters, one a line, and carries its frames until it is interrupted.
pub(crate) fn bus(options: &BusOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let stop = stop::on_interrupt()?;
    let hub = Hub::listen(&HubOptions {
        tcp: options.tcp,
        terminals: options.pty.unwrap_or(0).into(),
        bit_rate: options.bit_rate,
        paced: options.paced,
    });
    let mut hub = hub.map_err(|error| Complaint::bench(error.to_string()))?;
    let links = hub.addresses().iter();
    let links: String = links.map(|address| format!("slcan:{address}\n")).collect();
    screen.print(&links);
    let carried = hub.run(stop, |notice| {
        screen.complain(&[Problem::new(Severity::Warning, notice)]);
    });
    carried.map_err(|error| Complaint::bench(format!("the bus broke: {error}")))?;
    Ok(Exit::Passed)
}
