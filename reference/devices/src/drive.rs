//! A servo drive behind a CiA 402 dictionary.

use fieldproof_link::{Instant, NotOffered};

use crate::canopen::{Abort, Address, Answer, Application, HARDWARE, Objects, Slave};

const CONTROLWORD: Address = Address::new(0x6040, 0);
const STATUSWORD: Address = Address::new(0x6041, 0);
const MODE: Address = Address::new(0x6060, 0);
const MODE_DISPLAY: Address = Address::new(0x6061, 0);

/// Ready to switch on, voltage there, no quick stop, remote.
const AT_REST: i64 = 0x0231;

/// A drive whose state follows the controlword at once.
#[derive(Debug, Default)]
pub(crate) struct Drive {
    hardware_fault: bool,
    local_control: bool,
}

impl Drive {
    /// `hardware-fault` refuses writes with an EMCY, `local-control` without one.
    ///
    /// # Errors
    /// [`NotOffered`]: another condition.
    pub(crate) fn set_condition(
        &mut self,
        now: Instant,
        name: &str,
        active: bool,
        slave: &mut Slave,
    ) -> Result<(), NotOffered> {
        match name {
            "hardware-fault" => {
                if std::mem::replace(&mut self.hardware_fault, active) != active {
                    slave.set_error(now, HARDWARE, active);
                }
            }
            "local-control" => self.local_control = active,
            _ => return Err(NotOffered),
        }
        Ok(())
    }

    pub(crate) fn state(&self) -> [(String, String); 2] {
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
    }
}
