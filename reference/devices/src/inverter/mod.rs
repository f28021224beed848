//! A 510-series inverter (A510) with a Modbus port: what stands behind a CANopen gateway.

mod registers;

use fieldproof_link::{
    Framing, Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus,
    StimulusKind, Transmission,
};

use crate::catalogue::{DeviceKind, Medium, PortKind, Settings, UnknownFault};
use crate::modbus::{self, Behaviour, ModbusSlave, Registers as _};
pub use registers::{InverterRegisters, LINE, STATION};

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "teco-inverter",
    title: "TECO A510 inverter",
    ports: &[PortKind {
        role: "serial",
        medium: Medium::Serial(LINE),
    }],
    faults: &[modbus::faults::COMMON, modbus::faults::LINE],
    variants: &[modbus::variants::SLOW],
    build,
};

fn build(settings: &Settings) -> Result<Box<dyn Participant>, UnknownFault> {
    let behaviour = KIND.behaviour(crate::Behaviour::default(), settings)?;
    let registers = InverterRegisters::at(settings.address.unwrap_or(STATION));
    let slave = ModbusSlave::new(registers, behaviour.modbus, settings.seed);
    Ok(Box::new(Inverter {
        slave: slave.over(settings.framing),
        powered: true,
    }))
}

/// The inverter: one serial port, [`LINE`], station [`STATION`].
#[derive(Debug, Clone)]
pub struct Inverter {
    slave: ModbusSlave<InverterRegisters>,
    powered: bool,
}

impl Inverter {
    /// One that conforms; `seed` fixes its response times.
    pub fn new(seed: u64) -> Inverter {
        Inverter::behaving(Behaviour::CONFORMING, seed)
    }

    /// One that behaves so; `seed` fixes its response times.
    pub fn behaving(behaviour: Behaviour, seed: u64) -> Inverter {
        Inverter {
            slave: ModbusSlave::new(InverterRegisters::default(), behaviour, seed),
            powered: true,
        }
    }

    /// The same on a connection, if `framing` says how frames are told apart there.
    pub fn over(self, framing: Option<Framing>) -> Inverter {
        Inverter {
            slave: self.slave.over(framing),
            ..self
        }
    }

    /// Its registers.
    pub fn registers(&self) -> &InverterRegisters {
        self.slave.registers()
    }
}

impl Participant for Inverter {
    fn line(&self, _: usize) -> Line {
        match self.powered {
            true => self.slave.line(),
            false => Line::Off,
        }
    }

    fn receive(&mut self, now: Instant, _: usize, reception: Reception, _: &mut Outbox) {
        if let Reception::Character(character) = reception
            && self.powered
        {
            self.slave.receive(now, character);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.slave.wake_at().filter(|_| self.powered)
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        if self.powered
            && let Some(characters) = self.slave.wake(now)
        {
            out.send(0, Transmission::Characters(characters));
        }
    }

    /// Process values are registers, the number in hexadecimal: `register 2520`. With the power off it takes no part;
    /// after power-on its registers are those of a new one.
    fn stimulate(
        &mut self,
        _: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        let registers = self.slave.registers_mut();
        match stimulus {
            Stimulus::Power { on } => {
                if *on && !self.powered {
                    *registers = InverterRegisters::at(registers.address());
                    self.slave.restart();
                }
                self.powered = *on;
                Ok(())
            }
            Stimulus::ProcessValue { name, value } => registers.set_process_value(name, *value),
            Stimulus::Setting { name, value } if name == "address" => registers.set_address(*value),
            _ => Err(NotOffered),
        }
    }

    fn offers(&self) -> Vec<StimulusKind> {
        vec![
            StimulusKind::Power,
            StimulusKind::ProcessValue,
            StimulusKind::Setting,
        ]
    }

    /// Every register: `register 2501`, the value in decimal.
    fn state(&self) -> State {
        self.slave.state()
    }
}

#[cfg(test)]
mod tests;
