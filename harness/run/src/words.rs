//! What a frame means, in words.

use fieldproof_can::{Frame, Id};
use fieldproof_dictionary::Dictionary;
use fieldproof_link::{Framing, Lane, Line};
use fieldproof_record::{Direction, Event, FrameEvent, SerialEvent, Sink};
use fieldproof_wire::describe::{
    Direction as ModbusDirection, describe_frame, describe_modbus, describe_modbus_tcp,
};

use crate::object_names::object_names;

/// The frame of an event, if it is one.
pub(crate) fn frame_of(event: &FrameEvent) -> Option<Frame> {
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
pub(crate) fn can_words(frame: &Frame, dictionary: Option<&Dictionary>) -> String {
    let words = describe_frame(frame);
    match dictionary.and_then(|dictionary| object_names(frame, &words, dictionary)) {
        Some(names) => format!("{words}  [{names}]"),
        None => words,
    }
}

/// The bytes on the port called `port` in words.
pub(crate) fn serial_words(event: &SerialEvent, port: &str, line: Line) -> String {
    // On the device's own port the tester is the master; behind a gateway the device is.
    let from_master = match event.direction {
        Direction::Sent => true,
        Direction::Companion => false,
        Direction::Received => port != crate::tester::SERIAL && port != crate::tester::TCP,
    };
    let direction = match from_master {
        true => ModbusDirection::Request,
        false => ModbusDirection::Response,
    };
    match line {
        Line::Stream(Framing::ModbusTcp) => describe_modbus_tcp(&event.bytes, direction),
        _ => describe_modbus(&event.bytes, direction),
    }
}

/// Adds to every frame what it means, so that nobody needs the dictionary to read the record.
pub(crate) struct Explaining<'a> {
    sink: &'a mut dyn Sink,
    dictionary: Option<&'a Dictionary>,
    ports: Vec<(String, Line)>,
}

impl<'a> Explaining<'a> {
    pub(crate) fn new(
        sink: &'a mut dyn Sink,
        dictionary: Option<&'a Dictionary>,
        lane: &dyn Lane,
    ) -> Explaining<'a> {
        let ports = lane.ports().iter();
        Explaining {
            sink,
            dictionary,
            ports: ports.map(|port| (port.name.clone(), port.line)).collect(),
        }
    }
}

impl Sink for Explaining<'_> {
    fn emit(&mut self, mut event: Event) {
        match &mut event {
            Event::Frame(frame) => {
                let words = frame_of(frame).map(|frame| can_words(&frame, self.dictionary));
                frame.decoded = words.map(Into::into);
            }
            Event::Serial(serial) => {
                if let Some((port, line)) = self.ports.get(usize::from(serial.port)) {
                    serial.decoded = Some(serial_words(serial, port, *line).into());
                }
            }
            _ => {}
        }
        self.sink.emit(event);
    }
}
