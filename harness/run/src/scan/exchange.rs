//! One request to a Modbus server, and what comes back.

use std::time::Duration;

use fieldproof_link::{
    Framing, Instant, Lane, Line, LinkError, Origin, PortIndex, Reception, Transmission,
};
use fieldproof_wire::modbus::rtu::RtuAdu;
use fieldproof_wire::modbus::tcp::TcpAdu;

use crate::serial::{Assembler, SerialFrame};

/// The port that servers are asked through.
pub(super) struct Exchange<'l> {
    lane: &'l mut dyn Lane,
    port: PortIndex,
    assembler: Assembler,
    framing: Framing,
    silence: Duration,
    timeout: Duration,
    transaction: u16,
    /// The end of what was last on the line.
    busy_until: Instant,
}

/// What came back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Outcome {
    /// An answer: its PDU.
    Answer(Vec<u8>),
    /// Something that is no answer: the bytes.
    Noise(Vec<u8>),
    /// Nothing in time.
    Silence,
}

impl Exchange<'_> {
    /// `None` if the port carries no characters.
    pub(super) fn new(
        lane: &mut dyn Lane,
        port: PortIndex,
        timeout: Duration,
    ) -> Option<Exchange<'_>> {
        let properties = lane.ports().get(port.0)?;
        let assembler = Assembler::new(properties.line, properties.has_bit_times())?;
        let (framing, silence) = match properties.line {
            Line::Stream(framing) => (framing, Duration::ZERO),
            Line::Serial(settings) => (Framing::Rtu, settings.silence_3_5()),
            Line::Off | Line::Can { .. } => return None,
        };
        let busy_until = lane.now();
        Some(Exchange {
            lane,
            port,
            assembler,
            framing,
            silence,
            timeout,
            transaction: 0,
            busy_until,
        })
    }

    /// Whether requests carry a header, and so a unit in the place of an address.
    pub(super) fn is_modbus_tcp(&self) -> bool {
        self.framing == Framing::ModbusTcp
    }

    /// Sends `pdu` to `address` and waits for what comes back.
    pub(super) fn ask(&mut self, address: u8, pdu: &[u8]) -> Result<Outcome, LinkError> {
        self.transaction = self.transaction.wrapping_add(1);
        let bytes = match self.framing {
            Framing::ModbusTcp => {
                TcpAdu::new(self.transaction, address, pdu).map(|adu| adu.encode())
            }
            Framing::Rtu => RtuAdu::new(address, pdu).map(|adu| adu.encode()),
        };
        let Some(bytes) = bytes else {
            return Ok(Outcome::Silence);
        };
        let at = self.busy_until + self.silence;
        let sent = self.lane.send(self.port, at, Transmission::bytes(&bytes))?;
        self.busy_until = sent.end;
        let mut until = sent.end + self.timeout;
        let mut outcome = Outcome::Silence;
        while let Some(frame) = self.frame(until)? {
            match self.answer(address, &frame.bytes) {
                Some(answer) => return Ok(Outcome::Answer(answer)),
                None => outcome = Outcome::Noise(frame.bytes),
            }
            // Whoever sent it may still be sending.
            until = until.max(self.busy_until + self.silence);
        }
        Ok(outcome)
    }

    /// The PDU of the answer that `bytes` are, if they are the one that is waited for.
    fn answer(&self, address: u8, bytes: &[u8]) -> Option<Vec<u8>> {
        match self.framing {
            Framing::ModbusTcp => {
                let adu = TcpAdu::parse(bytes).ok()?;
                let is_meant = adu.unit() == address && adu.transaction() == self.transaction;
                is_meant.then(|| adu.pdu().to_vec())
            }
            Framing::Rtu => {
                let adu = RtuAdu::parse(bytes).ok()?;
                (adu.address() == address).then(|| adu.pdu().to_vec())
            }
        }
    }

    /// The next frame that begins until `until`.
    fn frame(&mut self, until: Instant) -> Result<Option<SerialFrame>, LinkError> {
        loop {
            let ends_at = self.assembler.ends_at();
            let Some(arrival) = self.lane.receive(ends_at.unwrap_or(until))? else {
                return Ok(ends_at.and_then(|end| self.assembler.finish(end)));
            };
            let (Reception::Character(character), Origin::Bus) = (arrival.what, arrival.origin)
            else {
                continue;
            };
            self.busy_until = arrival.at;
            let whole = self.assembler.take(arrival.at, Origin::Bus, character);
            if whole.is_some() {
                return Ok(whole);
            }
        }
    }
}
