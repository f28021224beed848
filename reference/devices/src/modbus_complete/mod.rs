//! A Modbus slave with every public function and all four tables: port 0 on a serial line (19200 8E1, address 1), port 1
//! and those after it connections of Modbus TCP.

mod identification;
mod tables;

use fieldproof_link::{
    Framing, Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus,
    StimulusKind, Transmission,
};

use crate::catalogue::{Behaviour, DeviceKind, Medium, PortKind, Settings, UnknownFault, Variant};
use crate::modbus::{self, Departure, ModbusSlave};
use tables::CompleteRegisters;

/// The port on a serial line; all others are connections of Modbus TCP.
const SERIAL: usize = 0;

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "modbus-complete",
    title: "A Modbus slave that has everything",
    ports: &[
        PortKind {
            role: "serial",
            medium: Medium::Serial(tables::LINE),
        },
        PortKind {
            role: "tcp",
            medium: Medium::Tcp,
        },
    ],
    faults: modbus::faults::COMPLETE,
    variants: &[
        modbus::variants::SLOW,
        modbus::variants::GAPS_TOLERATED,
        Variant {
            name: "bad-header-closes",
            words: "ends a connection over which a header came that is none",
            apply: |behaviour| behaviour.modbus.bad_header_closes = true,
        },
        Variant {
            name: "last-request-first",
            words: "does several requests of one packet from the last to the first: the transaction tells which is which",
            apply: |behaviour| behaviour.modbus.last_request_first = true,
        },
        Variant {
            name: "busy-at-times",
            words: "takes up to 30 ms more for an answer than it took for the last",
            apply: |behaviour| {
                behaviour.modbus.processing_jitter = std::time::Duration::from_millis(30);
            },
        },
    ],
    build,
};

fn build(settings: &Settings) -> Result<Box<dyn Participant>, UnknownFault> {
    let behaviour = KIND.behaviour(Behaviour::default(), settings)?;
    let registers = CompleteRegisters::new(settings.address.unwrap_or(tables::ADDRESS));
    let modbus = ModbusSlave::new(registers, behaviour.modbus, settings.seed);
    Ok(Box::new(ModbusComplete {
        modbus: modbus.over(settings.framing),
        powered: true,
    }))
}

/// The slave on its port.
#[derive(Debug)]
struct ModbusComplete {
    modbus: ModbusSlave<CompleteRegisters>,
    powered: bool,
}

impl ModbusComplete {
    fn power(&mut self, on: bool) {
        if on && !self.powered {
            let keeps_all = self.modbus.departs(Departure::NothingLost);
            let keeps_nothing = self.modbus.departs(Departure::MemoryLost);
            let registers = self.modbus.registers_mut();
            if !keeps_all {
                registers.power_on();
            }
            if keeps_nothing {
                registers.forget();
            }
            self.modbus.restart();
        }
        self.powered = on;
    }
}

impl Participant for ModbusComplete {
    fn line(&self, port: usize) -> Line {
        match (self.powered, port) {
            (false, _) => Line::Off,
            (true, SERIAL) => self.modbus.line(),
            // The port of that name, and those of further connections.
            (true, _) => Line::Stream(Framing::ModbusTcp),
        }
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, _: &mut Outbox) {
        match (port, reception) {
            _ if !self.powered => {}
            (SERIAL, Reception::Character(character)) => self.modbus.receive(now, character),
            (SERIAL, _) => {}
            (port, what) => self.modbus.receive_over_tcp(now, port, what),
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        let wakes = [self.modbus.wake_at(), self.modbus.wake_tcp_at()];
        wakes.into_iter().flatten().min().filter(|_| self.powered)
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        if !self.powered {
            return;
        }
        if self.modbus.wake_at().is_some_and(|at| at <= now)
            && let Some(characters) = self.modbus.wake(now)
        {
            out.send(SERIAL, Transmission::Characters(characters));
        }
        if let Some((port, what)) = self.modbus.wake_tcp(now) {
            out.send(port, what);
        }
    }

    /// Process values are inputs, by their numbers in hexadecimal: `input register 0005`, `discrete input 0003`.
    fn stimulate(
        &mut self,
        _: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        if let Stimulus::Power { on } = stimulus {
            self.power(*on);
            return Ok(());
        }
        let registers = self.modbus.registers_mut();
        match stimulus {
            Stimulus::Power { .. } => {}
            Stimulus::ProcessValue { name, value } => registers.set_process_value(name, *value)?,
            Stimulus::Condition { name, active } => registers.set_condition(name, *active)?,
            Stimulus::Setting { name, value } if name == "address" => {
                registers.set_address(*value)?;
            }
            Stimulus::Setting { name, value } if name == "baud" => {
                registers.set_baud(*value)?;
                self.modbus.restart();
            }
            Stimulus::Setting { .. } => return Err(NotOffered),
        }
        Ok(())
    }

    fn offers(&self) -> Vec<StimulusKind> {
        vec![
            StimulusKind::Power,
            StimulusKind::ProcessValue,
            StimulusKind::Condition,
            StimulusKind::Setting,
        ]
    }

    fn state(&self) -> State {
        self.modbus.state()
    }
}

#[cfg(test)]
mod tcp_tests;
#[cfg(test)]
mod tests;
