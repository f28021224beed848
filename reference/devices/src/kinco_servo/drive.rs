//! The drive behind the dictionary.

use crate::canopen::{Abort, Address, Answer, Application, Objects};

const CONTROLWORD: Address = Address::new(0x6040, 0);
const STATUSWORD: Address = Address::new(0x6041, 0);
const MODE: Address = Address::new(0x6060, 0);
const MODE_DISPLAY: Address = Address::new(0x6061, 0);
const POSITION: Address = Address::new(0x6063, 0);

/// Ready to switch on, voltage there, no quick stop, remote.
const AT_REST: i64 = 0x0231;

/// A drive whose state follows the controlword at once.
#[derive(Debug, Default)]
pub(super) struct Drive {
    pub(super) hardware_fault: bool,
    pub(super) local_control: bool,
}

impl Drive {
    pub(super) fn state(&self) -> [(String, String); 2] {
        [
            ("hardware-fault", self.hardware_fault),
            ("local-control", self.local_control),
        ]
        .map(|(name, active)| (name.to_owned(), active.to_string()))
    }

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
        } else if self.hardware_fault {
            Answer::Refused(Abort::HARDWARE)
        } else if self.local_control {
            Answer::Refused(Abort::LOCAL_CONTROL)
        } else {
            Answer::Now
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
        objects.set_number(POSITION, 0);
    }
}
