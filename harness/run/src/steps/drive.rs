//! `drive-enter`, `expect-drive`.

use std::time::Duration;

use fieldproof_can::Id;
use fieldproof_link::Instant;
use fieldproof_suite::model::{DriveState, DriveTarget, ExpectDrive, StatusBit};
use fieldproof_wire::canopen::{Multiplexer, PdoNumber, Service};

use super::sdo::LOOK;
use crate::limits::show;
use crate::sdo::{Outcome, show_abort};
use crate::stop::{Came, Stop};
use crate::tester::Tester;

const CONTROLWORD: Multiplexer = Multiplexer::new(0x6040, 0);
const STATUSWORD: Multiplexer = Multiplexer::new(0x6041, 0);

/// How long a drive may take for a transition: a brake opens, a circuit is charged.
const PATIENCE: Duration = Duration::from_secs(2);
/// No way to a state is longer: two controlwords out of fault, three up, and one that came too early.
const MOST_CONTROLWORDS: usize = 6;

impl Tester<'_> {
    pub(super) fn drive_enter(&mut self, target: DriveTarget) -> Result<(), Stop> {
        let mut statusword = self.statusword()?;
        for _ in 0..MOST_CONTROLWORDS {
            let state = state_of(statusword);
            if state == Some(state_for(target)) {
                return Ok(());
            }
            for controlword in way(state, target) {
                self.write_controlword(*controlword)?;
            }
            let until = self.session.now() + PATIENCE;
            statusword = self.statusword()?;
            while state_of(statusword) == state && self.session.now() < until {
                statusword = self.look_again()?;
            }
        }
        if state_of(statusword) == Some(state_for(target)) {
            return Ok(());
        }
        Err(Stop::undecided(
            format!(
                "the drive could not be brought into {}",
                name(state_for(target))
            ),
            name(state_for(target)),
            show_statusword(statusword),
        ))
    }

    pub(super) fn expect_drive(&mut self, step: &ExpectDrive) -> Result<(), Stop> {
        let patience = step.stays.map_or(PATIENCE, |_| Duration::ZERO);
        let within = step.within.unwrap_or(patience);
        let until = self.session.now() + within;
        let mut statusword = self.statusword_of(step, within)?;
        while !says(statusword, step) && self.session.now() < until {
            statusword = self.statusword_after(step, until)?;
        }
        if !says(statusword, step) {
            return Err(wrong(statusword, step, &format!("within {}", show(within))));
        }
        let Some(lasting) = step.lasting.or(step.stays) else {
            return Ok(());
        };
        let until = self.session.now() + lasting;
        while self.session.now() < until {
            statusword = self.look_again()?;
            if !says(statusword, step) {
                return Err(wrong(statusword, step, &format!("for {}", show(lasting))));
            }
        }
        Ok(())
    }

    fn statusword_of(&mut self, step: &ExpectDrive, within: Duration) -> Result<u16, Stop> {
        match step.in_tpdo {
            None => self.statusword(),
            Some(number) => self.statusword_in(number, self.session.now() + within),
        }
    }

    fn statusword_after(&mut self, step: &ExpectDrive, until: Instant) -> Result<u16, Stop> {
        match step.in_tpdo {
            None => self.look_again(),
            Some(number) => self.statusword_in(number, until),
        }
    }

    fn look_again(&mut self) -> Result<u16, Stop> {
        let next = self.session.now() + LOOK;
        self.session.collect_until(next)?;
        self.statusword()
    }

    fn statusword(&mut self) -> Result<u16, Stop> {
        match self.sdo_upload(STATUSWORD, self.device.timing.sdo_response)? {
            Outcome::Done(value) => match value.of_size(Some(2)) {
                [low, high] => Ok(u16::from_le_bytes([*low, *high])),
                bytes => Err(Stop::mismatch(
                    "the statusword has another size",
                    "2 bytes",
                    format!("{} bytes", bytes.len()),
                    Came::Other,
                )),
            },
            Outcome::Refused(code) => Err(Stop::mismatch(
                "reading the statusword is refused",
                "a value",
                show_abort(code),
                Came::Abort(code.0),
            )),
        }
    }

    /// The statusword that the next TPDO begins with.
    fn statusword_in(&mut self, number: u8, until: Instant) -> Result<u16, Stop> {
        let pdo = PdoNumber::new(number)
            .ok_or_else(|| Stop::Bench(format!("there is no TPDO{number}")))?;
        let id = self.identifier(Service::TransmitPdo(pdo))?;
        let within = until.since(self.session.last_sent().end);
        let Some((frame, _)) = self.first_frame(Id::Standard(id), within)? else {
            return Err(Stop::mismatch(
                format!("TPDO{number} does not come"),
                format!("{:03X} with the statusword", id.raw()),
                "nothing",
                Came::Silence,
            ));
        };
        match frame.bytes() {
            [low, high, ..] => Ok(u16::from_le_bytes([*low, *high])),
            _ => Err(Stop::mismatch(
                format!("TPDO{number} has no room for the statusword"),
                "2 bytes at least",
                frame.to_string(),
                Came::Frame(frame),
            )),
        }
    }

    /// Writes a controlword, which is put back after the case.
    fn write_controlword(&mut self, controlword: u16) -> Result<(), Stop> {
        let before = self.value_before(CONTROLWORD, 2)?;
        self.remember_object(CONTROLWORD, &before);
        let within = self.device.timing.sdo_response;
        match self.sdo_download(CONTROLWORD, &controlword.to_le_bytes(), within)? {
            Outcome::Done(()) => Ok(()),
            Outcome::Refused(code) => Err(Stop::undecided(
                format!("the controlword {controlword:04X}h is refused"),
                "accepted",
                show_abort(code),
            )),
        }
    }
}

/// The controlwords to write in a state on the way to another; none where the drive goes on by itself.
fn way(state: Option<DriveState>, target: DriveTarget) -> &'static [u16] {
    use DriveState::{
        Fault, FaultReactionActive, NotReadyToSwitchOn, OperationEnabled, QuickStopActive,
        ReadyToSwitchOn, SwitchOnDisabled, SwitchedOn,
    };
    match (state, target) {
        (Some(NotReadyToSwitchOn | FaultReactionActive), _) => &[],
        (Some(Fault), _) => &[0x0000, 0x0080, 0x0000],
        (None | Some(QuickStopActive), _) | (_, DriveTarget::SwitchOnDisabled) => &[0x0000],
        (Some(SwitchOnDisabled), _) | (_, DriveTarget::ReadyToSwitchOn) => &[0x0006],
        (Some(ReadyToSwitchOn | OperationEnabled), _) | (_, DriveTarget::SwitchedOn) => &[0x0007],
        (Some(SwitchedOn), DriveTarget::OperationEnabled) => &[0x000F],
    }
}

const fn state_for(target: DriveTarget) -> DriveState {
    match target {
        DriveTarget::SwitchOnDisabled => DriveState::SwitchOnDisabled,
        DriveTarget::ReadyToSwitchOn => DriveState::ReadyToSwitchOn,
        DriveTarget::SwitchedOn => DriveState::SwitchedOn,
        DriveTarget::OperationEnabled => DriveState::OperationEnabled,
    }
}

/// The state that a statusword names.
const fn state_of(statusword: u16) -> Option<DriveState> {
    match (statusword & 0x4F, statusword & 0x6F) {
        (0x00, _) => Some(DriveState::NotReadyToSwitchOn),
        (0x40, _) => Some(DriveState::SwitchOnDisabled),
        (0x08, _) => Some(DriveState::Fault),
        (0x0F, _) => Some(DriveState::FaultReactionActive),
        (_, 0x21) => Some(DriveState::ReadyToSwitchOn),
        (_, 0x23) => Some(DriveState::SwitchedOn),
        (_, 0x27) => Some(DriveState::OperationEnabled),
        (_, 0x07) => Some(DriveState::QuickStopActive),
        _ => None,
    }
}

const fn name(state: DriveState) -> &'static str {
    match state {
        DriveState::NotReadyToSwitchOn => "not ready to switch on",
        DriveState::SwitchOnDisabled => "switch on disabled",
        DriveState::ReadyToSwitchOn => "ready to switch on",
        DriveState::SwitchedOn => "switched on",
        DriveState::OperationEnabled => "operation enabled",
        DriveState::QuickStopActive => "quick stop active",
        DriveState::FaultReactionActive => "fault reaction active",
        DriveState::Fault => "fault",
    }
}

const fn bit(bit: StatusBit) -> (u8, &'static str) {
    match bit {
        StatusBit::VoltageEnabled => (4, "voltage enabled"),
        StatusBit::Remote => (9, "remote"),
        StatusBit::TargetReached => (10, "target reached"),
        StatusBit::SetPointAcknowledge => (12, "set-point acknowledge"),
        StatusBit::SpeedZero => (12, "speed zero"),
    }
}

fn says(statusword: u16, step: &ExpectDrive) -> bool {
    let shows = |which: &StatusBit| statusword & (1 << bit(*which).0) != 0;
    state_of(statusword).is_some_and(|state| step.is.contains(&state))
        && step.with.iter().all(shows)
        && !step.without.iter().any(shows)
}

fn show_statusword(statusword: u16) -> String {
    let state = state_of(statusword).map_or("no state that there is", name);
    format!("{state} (statusword {statusword:04X}h)")
}

fn wrong(statusword: u16, step: &ExpectDrive, when: &str) -> Stop {
    let states: Vec<&str> = step.is.iter().map(|state| name(*state)).collect();
    let mut expected = states.join(" or ");
    let bits = step.with.iter().map(|which| (which, 1));
    for (which, value) in bits.chain(step.without.iter().map(|which| (which, 0))) {
        let (number, name) = bit(*which);
        expected.push_str(&format!(", bit {number} ({name}) = {value}"));
    }
    Stop::differs(
        "the statusword does not say what it should",
        format!("{expected} {when}"),
        show_statusword(statusword),
        Came::Value(i128::from(statusword)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_by_the_bits_that_name_them() {
        for (statusword, state) in [
            (0x0000, Some(DriveState::NotReadyToSwitchOn)),
            (0x0250, Some(DriveState::SwitchOnDisabled)),
            (0x1670, Some(DriveState::SwitchOnDisabled)),
            (0x0231, Some(DriveState::ReadyToSwitchOn)),
            (0x02B3, Some(DriveState::SwitchedOn)),
            (0x1637, Some(DriveState::OperationEnabled)),
            (0x0217, Some(DriveState::QuickStopActive)),
            (0x021F, Some(DriveState::FaultReactionActive)),
            (0x0238, Some(DriveState::Fault)),
            (0x0211, None),
            (0x0261, None),
        ] {
            assert_eq!(state_of(statusword), state, "{statusword:04X}");
        }
    }

    #[test]
    fn every_state_is_reached_from_every_other() {
        use DriveState::{
            Fault, OperationEnabled, QuickStopActive, ReadyToSwitchOn, SwitchOnDisabled, SwitchedOn,
        };
        let after = |state, controlword| match (state, controlword) {
            (Fault, 0x0080) | (_, 0x0000) if state != Fault || controlword == 0x80 => {
                SwitchOnDisabled
            }
            (SwitchOnDisabled | SwitchedOn | OperationEnabled, 0x0006) => ReadyToSwitchOn,
            (ReadyToSwitchOn | OperationEnabled, 0x0007) => SwitchedOn,
            (SwitchedOn, 0x000F) => OperationEnabled,
            _ => state,
        };
        for from in [
            SwitchOnDisabled,
            ReadyToSwitchOn,
            SwitchedOn,
            OperationEnabled,
            QuickStopActive,
            Fault,
        ] {
            for target in [
                DriveTarget::SwitchOnDisabled,
                DriveTarget::ReadyToSwitchOn,
                DriveTarget::SwitchedOn,
                DriveTarget::OperationEnabled,
            ] {
                let mut state = from;
                for _ in 0..MOST_CONTROLWORDS {
                    if state != state_for(target) {
                        let words = way(Some(state), target).iter();
                        state = words.fold(state, |state, word| after(state, *word));
                    }
                }
                assert_eq!(state, state_for(target), "from {from:?}");
            }
        }
    }
}
