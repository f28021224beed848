//! `fieldproof stimulate`

use fieldproof_report::{Problem, Severity};

use crate::complaint::Complaint;
use crate::control;
use crate::exit::Exit;
use crate::options::StimulateOptions;
use crate::stimulus_words::parse;

/// Does something to a served device.
pub(crate) fn stimulate(options: &StimulateOptions) -> Result<Exit, Complaint> {
    let words: Vec<&str> = options.stimulus.iter().map(String::as_str).collect();
    if parse(&words).is_none() {
        let message = format!("\"{}\" is no stimulus", words.join(" "));
        return Err(Complaint::input(
            Problem::new(Severity::Error, message)
                .help("`fieldproof stimulate --help` shows how they are written"),
        ));
    }
    control::give(&options.socket, &options.stimulus)
        .map_err(|error| Complaint::bench(format!("{}: {error}", options.socket.display())))?;
    Ok(Exit::Passed)
}
