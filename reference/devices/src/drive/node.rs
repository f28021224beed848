//! A drive on its CAN port.

use fieldproof_can::Frame;
use fieldproof_link::{Instant, NotOffered, Outbox, State};

use super::{Drive, Model};
use crate::canopen::{Factory, Profile, Slave};
use crate::catalogue::Behaviour;

/// The CANopen slave and the drive behind it.
#[derive(Debug)]
pub(crate) struct DriveNode {
    pub(crate) slave: Slave,
    drive: Drive,
}

impl DriveNode {
    pub(crate) fn new(
        model: &'static Model,
        profile: Profile,
        behaviour: Behaviour,
        factory: Factory,
    ) -> DriveNode {
        let mut drive = Drive::new(model, behaviour.drive);
        let slave = Slave::new(profile, behaviour.canopen, factory, &mut drive);
        DriveNode { slave, drive }
    }

    pub(crate) fn receive(&mut self, now: Instant, frame: &Frame) {
        self.slave.receive(now, frame, &mut self.drive);
        self.drive.settle(now, &mut self.slave);
    }

    pub(crate) fn wake_at(&self) -> Option<Instant> {
        let times = [self.slave.wake_at(), self.drive.wake_at()];
        times.into_iter().flatten().min()
    }

    pub(crate) fn wake(&mut self, now: Instant, port: usize, out: &mut Outbox) {
        self.drive.wake(now, &mut self.slave);
        self.slave.wake(now, port, &mut self.drive, out);
        self.drive.settle(now, &mut self.slave);
    }

    pub(crate) fn power(&mut self, now: Instant, on: bool) {
        if !on {
            self.drive.power_off();
        }
        self.slave.power(now, on, &mut self.drive);
        if on {
            self.drive.settle(now, &mut self.slave);
        }
    }

    /// Beside the conditions of every device, `drive-fault` makes the drive fault.
    ///
    /// # Errors
    /// [`NotOffered`]: another condition.
    pub(crate) fn set_condition(
        &mut self,
        now: Instant,
        name: &str,
        active: bool,
    ) -> Result<(), NotOffered> {
        if name == "drive-fault" {
            self.drive.set_cause(active);
        } else {
            let conditions = &mut self.drive.conditions;
            conditions.set(now, name, active, &mut self.slave)?;
            self.drive.show(&mut self.slave.objects);
            self.slave.values_changed();
        }
        self.drive.settle(now, &mut self.slave);
        Ok(())
    }

    pub(crate) fn state(&self) -> State {
        let mut state = self.slave.state();
        state.extend(self.drive.conditions.state());
        let drive = &self.drive;
        state.insert("drive", drive.power.name());
        state.insert("drive-fault", drive.cause.to_string());
        state
    }
}
