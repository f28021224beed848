//! What each verb does. One file a family of verbs.

mod bench;
mod drive;
mod flood;
mod frames;
mod mapping;
mod modbus;
mod nmt;
mod pdo;
mod sdo;
mod serial;

use fieldproof_suite::model::{Repeat, Step};

pub(crate) use frames::main_role;

use crate::stop::Stop;
use crate::tester::Tester;
use crate::value::Actual;

impl Tester<'_> {
    /// Carries out one step.
    pub(crate) fn step(&mut self, step: &Step) -> Result<(), Stop> {
        match step {
            Step::Send(step) => self.send(step),
            Step::Expect(step) => self.expect(step),
            Step::ExpectSilence(step) => {
                let silent = self.expect_silence(step);
                silent.map_err(|stop| self.with_answer(stop))
            }
            Step::Nmt(step) => self.nmt(step),
            Step::NmtEnter(state) => self.nmt_enter(*state),
            Step::ExpectState(step) => self.expect_state(step),
            Step::ExpectBootUp(step) => self.expect_boot_up(step),
            Step::ExpectHeartbeat(step) => self.expect_heartbeat(step),
            Step::Sync(step) => self.sync(step),
            Step::StartSync(step) => self.start_sync(step),
            Step::StopSync => self.stop_sync(),
            Step::ExpectTpdo(step) => self.expect_tpdo(step),
            Step::ExpectMapping(step) => self.expect_mapping(step),
            Step::SendRpdo(step) => self.send_rpdo(step),
            Step::SdoRead(step) => self.sdo_read(step),
            Step::SdoWrite(step) => self.sdo_write(step),
            Step::DriveEnter(target) => self.drive_enter(*target),
            Step::ExpectDrive(step) => self.expect_drive(step),
            Step::Modbus(step) => self.modbus(step).map_err(|stop| self.with_answer(stop)),
            Step::SendBytes(step) => self.send_raw_bytes(step),
            Step::ExpectBytes(step) => {
                let came = self.expect_bytes(step);
                came.map_err(|stop| self.with_answer(stop))
            }
            Step::Connect(step) => self.connect(&step.name),
            Step::Disconnect(step) => self.disconnect(step),
            Step::Stimulate(step) => self.stimulate(step),
            Step::SetBitRate(bit_rate) => self.set_bit_rate(*bit_rate),
            Step::Flood(flood) => self.flood(flood),
            Step::Repeat(repeat) => self.repeat(repeat),
        }
    }
}

impl Tester<'_> {
    /// Puts the number of this time where the steps of a repeat find it.
    pub(crate) fn count(&mut self, repeat: &Repeat, time: u32) {
        if let Some(name) = &repeat.count_as {
            let number = i128::from(repeat.from) + i128::from(time);
            self.saved.insert(name.clone(), Actual::Number(number));
        }
    }

    fn repeat(&mut self, repeat: &Repeat) -> Result<(), Stop> {
        for time in 0..repeat.times {
            self.count(repeat, time);
            repeat
                .steps
                .iter()
                .try_for_each(|step| self.step(&step.value))?;
        }
        Ok(())
    }
}

/// The name of the check a step makes, if it has one.
pub(crate) fn check_of(step: &Step) -> Option<&str> {
    match step {
        Step::Expect(step) => step.check.as_deref(),
        Step::ExpectSilence(step) => step.check.as_deref(),
        Step::ExpectState(step) => step.check.as_deref(),
        Step::ExpectTpdo(step) => step.check.as_deref(),
        Step::ExpectMapping(step) => step.check.as_deref(),
        Step::SdoRead(step) => step.check.as_deref(),
        Step::SdoWrite(step) => step.check.as_deref(),
        Step::ExpectDrive(step) => step.check.as_deref(),
        Step::Modbus(step) => step.check.as_deref(),
        Step::ExpectBytes(step) => step.check.as_deref(),
        Step::Send(_)
        | Step::Flood(_)
        | Step::Nmt(_)
        | Step::NmtEnter(_)
        | Step::DriveEnter(_)
        | Step::ExpectBootUp(_)
        | Step::ExpectHeartbeat(_)
        | Step::Sync(_)
        | Step::StartSync(_)
        | Step::StopSync
        | Step::SendRpdo(_)
        | Step::SendBytes(_)
        | Step::Connect(_)
        | Step::Disconnect(_)
        | Step::Stimulate(_)
        | Step::SetBitRate(_)
        | Step::Repeat(_) => None,
    }
}

/// Whether a step only prepares: when it does not succeed, nothing was judged.
pub(crate) fn is_precondition(step: &Step) -> bool {
    matches!(step, Step::NmtEnter(_) | Step::DriveEnter(_))
}
