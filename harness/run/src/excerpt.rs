//! The frames around a failure, decoded.

use fieldproof_dictionary::Dictionary;
use fieldproof_link::PortIndex;
use fieldproof_record::ExcerptLine;

use crate::modbus::show_bytes;
use crate::session::{Session, Traffic};
use crate::words::{can_words, frame_of, serial_words};

/// How many frames before the failure are shown.
const LINES: usize = 12;

/// The last frames of the case, the last one marked.
pub(crate) fn excerpt(session: &Session<'_>, dictionary: Option<&Dictionary>) -> Vec<ExcerptLine> {
    let traffic: Vec<&Traffic> = session.trace().collect();
    let first = traffic.len().saturating_sub(LINES);
    let mut lines: Vec<ExcerptLine> = traffic[first..]
        .iter()
        .map(|traffic| line(session, dictionary, traffic))
        .collect();
    if let Some(last) = lines.last_mut() {
        last.marked = true;
    }
    lines
}

fn line(session: &Session<'_>, dictionary: Option<&Dictionary>, traffic: &Traffic) -> ExcerptLine {
    match traffic {
        Traffic::Can(event) => {
            let frame = frame_of(event);
            ExcerptLine {
                at_ns: event.at_ns,
                port: session.port_name(PortIndex(event.port.into())).to_owned(),
                direction: event.direction,
                raw: frame.map(|frame| frame.to_string()).unwrap_or_default(),
                decoded: frame
                    .map(|frame| can_words(&frame, dictionary))
                    .unwrap_or_default(),
                marked: false,
            }
        }
        Traffic::Serial(event) => {
            let index = PortIndex(event.port.into());
            let port = session.port_name(index);
            ExcerptLine {
                at_ns: event.at_ns,
                port: port.to_owned(),
                direction: event.direction,
                raw: show_bytes(&event.bytes),
                decoded: serial_words(event, port, session.line(index)),
                marked: false,
            }
        }
    }
}
