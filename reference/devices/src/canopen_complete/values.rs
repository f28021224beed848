//! The values of every type: what is set at 2001h to 201Bh is what a PDO can send at 2101h to 211Bh.

use fieldproof_link::{Instant, NotOffered};

use crate::canopen::{Abort, Address, Answer, Application, HARDWARE, Objects, Slave};

/// 2000h and the data type.
const SET: std::ops::RangeInclusive<u16> = 0x2001..=0x201B;
/// From a value that is set to the same one to be sent.
const TO_BE_SENT: u16 = 0x100;

/// What can happen to the values beside the bus.
#[derive(Debug, Default)]
pub(crate) struct Values {
    hardware_fault: bool,
    local_control: bool,
}

impl Values {
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
}

fn show(index: u16, objects: &mut Objects) {
    let value = objects.get(Address::new(index, 0));
    if let Some(value) = value.map(|object| object.value().to_vec()) {
        objects.set(Address::new(index + TO_BE_SENT, 0), &value);
    }
}

impl Application for Values {
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
        if SET.contains(&address.index()) {
            show(address.index(), objects);
        }
    }

    fn reset(&mut self, objects: &mut Objects) {
        SET.for_each(|index| show(index, objects));
    }
}
