//! Conditions under which a device refuses to have its values written.

use fieldproof_link::{Instant, NotOffered};

use crate::canopen::{Abort, Answer, HARDWARE, Slave};

/// `hardware-fault` refuses writes with an EMCY, `local-control` without one.
#[derive(Debug, Default)]
pub(crate) struct Conditions {
    hardware_fault: bool,
    local_control: bool,
}

impl Conditions {
    /// Brings the condition called `name` about, or ends it.
    ///
    /// # Errors
    /// [`NotOffered`]: another condition.
    pub(crate) fn set(
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

    /// What a write is answered under them.
    pub(crate) fn answer(&self) -> Answer {
        if self.hardware_fault {
            Answer::Refused(Abort::HARDWARE)
        } else if self.local_control {
            Answer::Refused(Abort::LOCAL_CONTROL)
        } else {
            Answer::Now
        }
    }

    /// Whether the panel has control.
    pub(crate) fn is_local(&self) -> bool {
        self.local_control
    }

    pub(crate) fn state(&self) -> [(String, String); 2] {
        [
            ("hardware-fault", self.hardware_fault),
            ("local-control", self.local_control),
        ]
        .map(|(name, active)| (name.to_owned(), active.to_string()))
    }
}
