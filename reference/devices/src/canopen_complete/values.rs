//! The values of every type: what is set at 2001h to 201Bh is what a PDO can send at 2101h to 211Bh.

use crate::canopen::{Address, Answer, Application, Objects};
use crate::conditions::Conditions;

/// 2000h and the data type.
const SET: std::ops::RangeInclusive<u16> = 0x2001..=0x201B;
/// From a value that is set to the same one to be sent.
const TO_BE_SENT: u16 = 0x100;

/// What can happen to the values beside the bus.
#[derive(Debug, Default)]
pub(crate) struct Values {
    pub(crate) conditions: Conditions,
}

fn show(index: u16, objects: &mut Objects) {
    let value = objects.get(Address::new(index, 0));
    if let Some(value) = value.map(|object| object.value().to_vec()) {
        objects.set(Address::new(index + TO_BE_SENT, 0), &value);
    }
}

impl Application for Values {
    fn reading(&mut self, address: Address) -> Answer {
        if address.index() < 0x2000 {
            Answer::Now
        } else {
            self.conditions.answer_to_reading()
        }
    }

    fn writing(&mut self, address: Address, _: &[u8]) -> Answer {
        if address.index() < 0x2000 {
            Answer::Now
        } else {
            self.conditions.answer()
        }
    }

    fn written(&mut self, address: Address, objects: &mut Objects) {
        if SET.contains(&address.index()) {
            show(address.index(), objects);
        }
    }

    fn reset(&mut self, objects: &mut Objects) {
        SET.for_each(|index| show(index, objects));
    }
}
