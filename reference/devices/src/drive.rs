//! A servo drive behind a CiA 402 dictionary.

use crate::canopen::{Address, Answer, Application, Objects};
use crate::conditions::Conditions;

const CONTROLWORD: Address = Address::new(0x6040, 0);
const STATUSWORD: Address = Address::new(0x6041, 0);
const MODE: Address = Address::new(0x6060, 0);
const MODE_DISPLAY: Address = Address::new(0x6061, 0);

/// Ready to switch on, voltage there, no quick stop, remote.
const AT_REST: i64 = 0x0231;

/// A drive whose state follows the controlword at once.
#[derive(Debug, Default)]
pub(crate) struct Drive {
    pub(crate) conditions: Conditions,
}

impl Drive {
    /// Bits 0 to 2 of the statusword: ready to switch on, switched on, operation enabled.
    fn statusword(controlword: u32) -> i64 {
        match controlword & 0x0F {
            0x07 => AT_REST | 0x02,
            0x0F => AT_REST | 0x06,
            _ => AT_REST,
        }
    }
}

impl Application for Drive {
    fn writing(&mut self, address: Address, _: &[u8]) -> Answer {
        if address.index() < 0x2000 {
            Answer::Now
        } else {
            self.conditions.answer()
        }
    }

    fn written(&mut self, address: Address, objects: &mut Objects) {
        let number = objects.number(address).unwrap_or(0);
        match address {
            CONTROLWORD => objects.set_number(STATUSWORD, Drive::statusword(number)),
            MODE => objects.set_number(MODE_DISPLAY, i64::from(number)),
            _ => {}
        }
    }

    fn reset(&mut self, objects: &mut Objects) {
        objects.set_number(STATUSWORD, AT_REST);
    }
}
