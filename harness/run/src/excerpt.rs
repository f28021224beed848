//! The frames around a failure, decoded.

use fieldproof_can::{Frame, Id};
use fieldproof_dictionary::Dictionary;
use fieldproof_link::{Framing, Line, PortIndex};
use fieldproof_record::{Direction, ExcerptLine, FrameEvent};
use fieldproof_wire::describe::{
    Direction as ModbusDirection, describe_frame, describe_modbus, describe_modbus_tcp,
};

use crate::modbus::show_bytes;
use crate::object_names::object_names;
use crate::session::{Session, Traffic};

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
                    .map(|frame| describe(&frame, dictionary))
                    .unwrap_or_default(),
                marked: false,
            }
        }
        Traffic::Serial(event) => {
            // On the device's own port the tester is the master; behind a gateway the device is.
            let from_master = match event.direction {
                Direction::Sent => true,
                Direction::Companion => false,
                Direction::Received => {
                    let name = session.port_name(PortIndex(event.port.into()));
                    name != crate::tester::SERIAL && name != crate::tester::TCP
                }
            };
            let direction = if from_master {
                ModbusDirection::Request
            } else {
                ModbusDirection::Response
            };
            ExcerptLine {
                at_ns: event.at_ns,
                port: session.port_name(PortIndex(event.port.into())).to_owned(),
                direction: event.direction,
                raw: show_bytes(&event.bytes),
                decoded: match session.line(PortIndex(event.port.into())) {
                    Line::Stream(Framing::ModbusTcp) => {
                        describe_modbus_tcp(&event.bytes, direction)
                    }
                    _ => describe_modbus(&event.bytes, direction),
                },
                marked: false,
            }
        }
    }
}

fn frame_of(event: &FrameEvent) -> Option<Frame> {
    let id = if event.extended {
        Id::extended(event.id)
    } else {
        Id::standard(event.id as u16)
    }?;
    if event.remote {
        Frame::remote(id, event.len)
    } else {
        Frame::data(id, event.data.get(..usize::from(event.len))?)
    }
}

/// The frame in words, with the names of its objects where the dictionary knows them.
fn describe(frame: &Frame, dictionary: Option<&Dictionary>) -> String {
    let words = describe_frame(frame);
    match dictionary.and_then(|dictionary| object_names(frame, &words, dictionary)) {
        Some(names) => format!("{words}  [{names}]"),
        None => words,
    }
}
