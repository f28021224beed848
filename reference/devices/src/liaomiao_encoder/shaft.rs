//! The shaft as the object dictionary shows it.

use crate::canopen::{Address, Application, Objects};
use crate::modbus::SpeedSign;

use super::{Behaviour, EncoderModel};

const SPEED: Address = Address::new(0x2000, 0);
const SINGLE_TURN_BITS: Address = Address::new(0x2003, 0);
const OPERATING_PARAMETERS: Address = Address::new(0x6000, 0);
const PRESET: Address = Address::new(0x6003, 0);
const POSITION: Address = Address::new(0x6004, 0);
const OPERATING_STATUS: Address = Address::new(0x6500, 0);

/// The model behind the CAN side's objects.
#[derive(Debug)]
pub(super) struct Shaft<'a> {
    pub(super) model: &'a mut EncoderModel,
    pub(super) behaviour: &'a Behaviour,
}

impl Shaft<'_> {
    /// Puts what is measured, and how it is counted, into the dictionary.
    pub(super) fn show(&self, objects: &mut Objects) {
        let highest = self.behaviour.highest_speed;
        let speed = match self.behaviour.speed_sign {
            SpeedSign::Kept => self.model.shown_speed(),
            SpeedSign::Lost => self.model.shown_speed().saturating_abs(),
        };
        let speed = speed.clamp(highest.saturating_neg(), highest);
        let direction = i64::from(self.model.counter_clockwise);
        objects.set_number(SPEED, i64::from(speed));
        objects.set_number(POSITION, i64::from(self.model.position));
        objects.set_number(OPERATING_PARAMETERS, direction);
        if self.behaviour.resolution_obeyed {
            objects.set_number(SINGLE_TURN_BITS, i64::from(self.model.single_turn_bits));
        }
        if self.behaviour.status_follows {
            objects.set_number(OPERATING_STATUS, direction);
        }
    }
}

impl Application for Shaft<'_> {
    fn written(&mut self, address: Address, objects: &mut Objects) {
        let number = objects.number(address).unwrap_or(0);
        match address {
            // Bits 1 to 15 are reserved and read 0.
            OPERATING_PARAMETERS => self.model.set_direction(number & 1 != 0, self.behaviour),
            SINGLE_TURN_BITS if self.behaviour.resolution_obeyed => {
                self.model.set_single_turn_bits(number.to_le_bytes()[0]);
            }
            PRESET => self.model.set_preset(number, self.behaviour.preset),
            _ => return,
        }
        self.show(objects);
    }

    fn reset(&mut self, objects: &mut Objects) {
        if !self.behaviour.preset_kept {
            self.model.forget_preset();
        }
        if !self.behaviour.settings_saved {
            self.model.set_direction(false, self.behaviour);
            self.model.set_single_turn_bits(16);
        }
        self.show(objects);
    }
}
