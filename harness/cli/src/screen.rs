//! What is shown on the terminal.

use std::io::{self, IsTerminal, Write};

use anstream::{AutoStream, ColorChoice};
use fieldproof_report::{Ink, Problem, render};

use crate::options::Color;

/// Standard output and error. Everything is given with colours, and these are taken out where they do not belong. Once
/// nobody reads an output any more (`| head`), what follows is dropped without a word; any other loss is kept in mind.
pub(crate) struct Screen {
    out: AutoStream<io::Stdout>,
    error: AutoStream<io::Stderr>,
    lost: Option<io::Error>,
}

/// The ink that everything for a [`Screen`] is made with.
pub(crate) const INK: Ink = Ink::Coloured;

/// Nobody reads more at once.
const SHOWN_PROBLEMS: usize = 20;

impl Screen {
    pub(crate) fn new(color: Color) -> Screen {
        let choice = match color {
            Color::Auto => ColorChoice::Auto,
            Color::Always => ColorChoice::Always,
            Color::Never => ColorChoice::Never,
        };
        Screen {
            out: AutoStream::new(io::stdout(), choice),
            error: AutoStream::new(io::stderr(), choice),
            lost: None,
        }
    }

    /// Whether a progress bar makes sense: on a terminal that somebody looks at. Build machines offer terminals, too.
    pub(crate) fn shows_progress() -> bool {
        io::stderr().is_terminal() && std::env::var_os("CI").is_none()
    }

    /// Prints `text` as it is.
    pub(crate) fn print(&mut self, text: &str) {
        let written = self.out.write_all(text.as_bytes());
        if let Err(error) = written.and_then(|()| self.out.flush())
            && error.kind() != io::ErrorKind::BrokenPipe
        {
            self.lost.get_or_insert(error);
        }
    }

    /// Why something that was printed did not get to where it belongs, a full disk for instance.
    /// Lets whoever reads see now what was printed.
    pub(crate) fn flush(&mut self) {
        let _ = self.out.flush();
    }

    pub(crate) fn take_loss(&mut self) -> Option<io::Error> {
        self.lost.take()
    }

    /// Prints `value` as JSON.
    pub(crate) fn print_json(&mut self, value: &impl serde::Serialize) {
        // Our own values have text keys only and cannot fail.
        let text = serde_json::to_string_pretty(value).unwrap_or_default();
        self.print(&format!("{text}\n"));
    }

    /// Prints `problems` to standard error: the first of them, if they are many.
    pub(crate) fn complain(&mut self, problems: &[Problem]) {
        self.complain_first(problems, SHOWN_PROBLEMS);
    }

    /// Prints all of `problems` to standard error.
    pub(crate) fn complain_all(&mut self, problems: &[Problem]) {
        self.complain_first(problems, problems.len());
    }

    fn complain_first(&mut self, problems: &[Problem], most: usize) {
        for (index, problem) in problems.iter().take(most).enumerate() {
            let gap = if index == 0 {
                ""
            } else {
                "
"
            };
            let text = render(problem, INK);
            let _ = write!(self.error, "{gap}{text}");
        }
        if let Some(more) = problems.len().checked_sub(most).filter(|more| *more > 0) {
            let _ = writeln!(
                self.error,
                "
and {more} more"
            );
        }
        let _ = self.error.flush();
    }
}
