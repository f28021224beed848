//! A Modbus slave with every public function and all four tables: port 0 on a serial line (19200 8E1, address 1).

mod identification;
mod tables;

use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
    Transmission,
};

use crate::catalogue::{Behaviour, DeviceKind, Medium, PortKind, Settings, UnknownFault, Variant};
use crate::modbus::{self, ModbusSlave};
use tables::CompleteRegisters;

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "modbus-complete",
    title: "A Modbus slave that has everything",
    ports: &[PortKind {
        role: "serial",
        medium: Medium::Serial(tables::LINE),
    }],
    faults: modbus::faults::COMPLETE,
    variants: &[
        modbus::variants::SLOW,
        modbus::variants::GAPS_TOLERATED,
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

impl Participant for ModbusComplete {
    fn line(&self, _: usize) -> Line {
        match self.powered {
            true => self.modbus.line(),
            false => Line::Off,
        }
    }

    fn receive(&mut self, now: Instant, _: usize, reception: Reception, _: &mut Outbox) {
        if let Reception::Character(character) = reception
            && self.powered
        {
            self.modbus.receive(now, character);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.modbus.wake_at().filter(|_| self.powered)
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        if self.powered
            && let Some(characters) = self.modbus.wake(now)
        {
            out.send(0, Transmission::Characters(characters));
        }
    }

    /// Process values are inputs, by their numbers in hexadecimal: `input register 0005`, `discrete input 0003`.
    fn stimulate(
        &mut self,
        _: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        let registers = self.modbus.registers_mut();
        match stimulus {
            Stimulus::Power { on } => {
                if *on && !self.powered {
                    registers.power_on();
                    self.modbus.restart();
                }
                self.powered = *on;
            }
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
mod tests;
