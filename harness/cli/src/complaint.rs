//! Why a command could not do what it was asked for.

use std::fmt;
use std::io;

use fieldproof_report::{Problem, Severity};

use crate::exit::Exit;

/// What is wrong, to be shown, and what to exit with.
#[derive(Debug)]
pub struct Complaint {
    /// At least one.
    pub problems: Vec<Problem>,
    /// Wrong input or a broken bench.
    pub exit: Exit,
}

impl Complaint {
    /// The input is wrong in this one way.
    pub(crate) fn input(problem: Problem) -> Complaint {
        Complaint::inputs(vec![problem])
    }

    /// The input is wrong in these ways.
    pub(crate) fn inputs(problems: Vec<Problem>) -> Complaint {
        Complaint {
            problems,
            exit: Exit::WrongInput,
        }
    }

    /// Something that is asked for by name does not exist. The nearest of `known` is offered, and all are listed.
    pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> Complaint {
        let problem = Problem::new(Severity::Error, format!("no {what} is called \"{name}\""));
        Complaint::input(with_choice(problem, name, known))
    }

    /// A file of ours cannot be written.
    pub(crate) fn unwritable(path: impl fmt::Display, error: &io::Error) -> Complaint {
        let problem = Problem::new(Severity::Error, format!("cannot be written: {error}"));
        Complaint {
            problems: vec![problem.in_file(path.to_string())],
            exit: Exit::Broken,
        }
    }

    /// The bench broke.
    pub(crate) fn bench(message: impl Into<String>) -> Complaint {
        Complaint {
            problems: vec![Problem::new(Severity::Error, message)],
            exit: Exit::Broken,
        }
    }
}

/// `problem` with the names there are, and the nearest of them to `name`.
pub(crate) fn with_choice(problem: Problem, name: &str, known: &[&str]) -> Problem {
    let problem = match known {
        [] => problem,
        _ => problem.note(format!("there are: {}", wrapped(known))),
    };
    match nearest(name, known) {
        Some(nearest) => problem.help(format!("did you mean \"{nearest}\"?")),
        None => problem,
    }
}

/// `names` with commas, in lines that are not too long.
fn wrapped(names: &[&str]) -> String {
    const LONGEST: usize = 90;
    let mut text = String::new();
    let mut column = 0;
    for (index, name) in names.iter().enumerate() {
        if index > 0 {
            text.push(',');
            let full = column + name.len() > LONGEST;
            text.push(if full { '\n' } else { ' ' });
            column = if full { 0 } else { column };
        }
        text.push_str(name);
        column += name.len() + 2;
    }
    text
}

/// The one of `known` that `name` was most likely meant to be.
fn nearest<'k>(name: &str, known: &[&'k str]) -> Option<&'k str> {
    let name = name.to_lowercase();
    let likeness = |known: &str| match known.contains(&name) {
        true => 1.0,
        false => strsim::jaro_winkler(&name, known),
    };
    known
        .iter()
        .map(|known| (likeness(known), *known))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_name_is_offered() {
        let known = ["huacheng-ssts1", "kinco-servo", "teco-jn5-cm-can"];
        assert_eq!(nearest("kinko-servo", &known), Some("kinco-servo"));
        assert_eq!(nearest("TECO", &known), Some("teco-jn5-cm-can"));
        assert_eq!(nearest("xyz", &known), None);
    }
}
