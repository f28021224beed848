//! A servo drive behind a CiA 402 dictionary: power state machine, modes of operation, and a shaft that turns.

mod behaviour;
pub(crate) mod faults;
mod motion;
mod node;
mod power;
#[cfg(test)]
mod tests;
pub(crate) mod variants;

use std::time::Duration;

use fieldproof_link::Instant;

use crate::canopen::{Abort, Address, Answer, Application, DeviceError, Objects, Slave};
use crate::conditions::Conditions;

pub use behaviour::{Behaviour, TargetReached};
use motion::{Motion, SetPoint};
pub(crate) use node::DriveNode;
pub use power::{Command, Power};

const ERROR_CODE: Address = Address::new(0x603F, 0);
const CONTROLWORD: Address = Address::new(0x6040, 0);
const STATUSWORD: Address = Address::new(0x6041, 0);
const QUICK_STOP_OPTION: Address = Address::new(0x605A, 0);
const MODE: Address = Address::new(0x6060, 0);
const MODE_DISPLAY: Address = Address::new(0x6061, 0);
const SUPPORTED_MODES: Address = Address::new(0x6502, 0);

/// Of the statusword.
const VOLTAGE_ENABLED: u16 = 1 << 4;
const QUICK_STOP: u16 = 1 << 5;
const REMOTE: u16 = 1 << 9;
const TARGET_REACHED: u16 = 1 << 10;
/// Set-point acknowledge, speed, or drive follows the command value.
const MODE_BIT: u16 = 1 << 12;

/// Of the controlword.
const NEW_SET_POINT: u16 = 1 << 4;
const CHANGE_AT_ONCE: u16 = 1 << 5;
const RELATIVE: u16 = 1 << 6;
const FAULT_RESET: u16 = 1 << 7;
const HALT: u16 = 1 << 8;

/// How long the motor of this drive takes to stop.
const STOPPING: Duration = Duration::from_millis(10);

/// The signal of the position sensor is gone.
const SENSOR: DeviceError = DeviceError {
    code: 0x7305,
    register_bit: 0x21,
};

/// What one drive is and another is not.
#[derive(Debug)]
pub(crate) struct Model {
    /// The modes of operation there are.
    pub(crate) modes: &'static [i8],
    /// Where the shaft is.
    pub(crate) position: Address,
    /// At velocity 1 the shaft turns by so many counts in so many seconds.
    pub(crate) counts_a_second: (i64, i64),
    /// The manufacturer's own alarm code, if there is one.
    pub(crate) alarm: Option<Address>,
}

/// A drive.
#[derive(Debug)]
pub(crate) struct Drive {
    model: &'static Model,
    behaviour: Behaviour,
    conditions: Conditions,
    power: Power,
    controlword: u16,
    /// What makes it fault is there.
    cause: bool,
    /// The fault was reported, and its end was not.
    reported: bool,
    /// The state that follows by itself, and when.
    following: Option<(Power, Option<Instant>)>,
    mode: i8,
    /// The mode that follows, and when.
    next_mode: Option<(i8, Option<Instant>)>,
    motion: Motion,
    /// The next look at the shaft.
    tick: Option<Instant>,
}

impl Drive {
    pub(crate) fn new(model: &'static Model, behaviour: Behaviour) -> Drive {
        Drive {
            model,
            behaviour,
            conditions: Conditions::default(),
            power: Power::NotReady,
            controlword: 0,
            cause: false,
            reported: false,
            following: None,
            mode: 0,
            next_mode: None,
            motion: Motion::default(),
            tick: None,
        }
    }

    fn enter(&mut self, power: Power) {
        self.power = power;
        self.following = None;
        if power != Power::OperationEnabled {
            self.motion.stop();
        }
    }

    /// A controlword was written.
    fn command(&mut self, objects: &Objects) {
        let word = objects.number(CONTROLWORD).unwrap_or(0);
        let word = u16::try_from(word).unwrap_or(0);
        let before = std::mem::replace(&mut self.controlword, word);
        let rising = |bit| word & bit != 0 && before & bit == 0;
        if self.power == Power::Fault {
            let asked = if self.behaviour.fault_reset_on_edge {
                rising(FAULT_RESET)
            } else {
                word & FAULT_RESET != 0
            };
            if asked && !(self.cause && self.behaviour.fault_waits_for_cause) {
                self.enter(self.behaviour.after_fault_reset);
                return;
            }
        }
        if self.behaviour.commands_decoded || matches!(word & 0x0F, 0x0 | 0x2 | 0x6 | 0x7 | 0xF) {
            self.obey(Command::of(word), objects);
        }
        if self.power == Power::OperationEnabled {
            let new = if self.behaviour.set_point_on_edge {
                rising(NEW_SET_POINT)
            } else {
                word & NEW_SET_POINT != 0
            };
            self.operate(word, new, objects);
        }
    }

    fn obey(&mut self, command: Command, objects: &Objects) {
        let behaviour = &self.behaviour;
        let surplus = behaviour.surplus_transitions.iter();
        let surplus = surplus.fold(None, |found, (from, by, to)| {
            let fits = *from == self.power && *by == command;
            if fits { Some(*to) } else { found }
        });
        if let Some(to) = surplus {
            return self.enter(to);
        }
        if behaviour
            .missing_transitions
            .contains(&(self.power, command))
        {
            return;
        }
        match (self.power, command, self.power.after(command)) {
            (from, _, to) if from == to => {}
            (Power::QuickStopActive, Command::EnableOperation, to) => {
                if behaviour.quick_stop_resumable && self.following.is_none() {
                    self.enter(to);
                }
            }
            (Power::ReadyToSwitchOn, Command::EnableOperation, _)
                if !behaviour.enables_directly =>
            {
                self.enter(Power::SwitchedOn);
            }
            (_, Command::EnableOperation, to) if !behaviour.enabling.is_zero() => {
                if self.following.is_none() {
                    self.enter(Power::SwitchedOn);
                    self.following = Some((to, None));
                }
            }
            (_, Command::QuickStop, Power::QuickStopActive) => self.quick_stop(objects),
            (_, _, to) => self.enter(to),
        }
    }

    /// 605Ah: 0 takes the torque away, 1 to 3 end in switch on disabled, 5 to 8 stay.
    fn quick_stop(&mut self, objects: &Objects) {
        let chosen = self.behaviour.quick_stop_option;
        let option = chosen.or_else(|| objects.number(QUICK_STOP_OPTION));
        self.enter(Power::QuickStopActive);
        match option {
            Some(0) => self.enter(Power::SwitchOnDisabled),
            Some(5..=8) => {}
            _ => self.following = Some((Power::SwitchOnDisabled, None)),
        }
    }

    /// What an enabled drive takes from the controlword beside its state.
    fn operate(&mut self, word: u16, new_set_point: bool, objects: &Objects) {
        self.motion.halt(word & HALT != 0 && self.behaviour.halts);
        if self.mode != motion::PROFILE_POSITION {
            return;
        }
        if new_set_point {
            let point = SetPoint {
                at_once: word & CHANGE_AT_ONCE != 0,
                relative: word & RELATIVE != 0,
            };
            self.motion.acknowledged |= self.motion.take(self.model, point, objects);
        } else if word & NEW_SET_POINT == 0 && self.behaviour.acknowledge_withdrawn {
            self.motion.acknowledged = false;
        }
    }

    fn has_mode(&self, mode: i8) -> bool {
        mode == 0 || self.model.modes.contains(&mode)
    }

    fn choose_mode(&mut self, objects: &Objects) {
        let [code, ..] = objects.number(MODE).unwrap_or(0).to_le_bytes();
        let mode = code.cast_signed();
        if !self.behaviour.mode_display_follows {
            return;
        }
        let taken = self.behaviour.any_mode_taken || self.has_mode(mode);
        if !taken || self.next_mode.is_some_and(|(next, _)| next == mode) {
            return;
        }
        self.next_mode = Some((mode, None)).filter(|_| mode != self.mode);
        if self.behaviour.mode_switching.is_zero() {
            self.take_mode();
        }
    }

    fn take_mode(&mut self) {
        if let Some((mode, _)) = self.next_mode.take() {
            self.mode = mode;
            self.motion.stop();
        }
    }

    fn statusword(&self, objects: &Objects) -> u16 {
        let behaviour = &self.behaviour;
        let mut word = self.power.bits();
        match self.power {
            Power::NotReady | Power::SwitchOnDisabled | Power::FaultReaction | Power::Fault
                if behaviour.quick_stop_bit_at_rest =>
            {
                word |= QUICK_STOP;
            }
            _ if !behaviour.quick_stop_bit_shown => word &= !QUICK_STOP,
            _ => {}
        }
        let operates = self.power == Power::OperationEnabled;
        let arrived = match behaviour.target_reached {
            TargetReached::Honest => self.motion.has_arrived(self.mode, objects),
            TargetReached::Always => true,
            TargetReached::Never => false,
        };
        let mode_bit = match self.mode {
            motion::PROFILE_POSITION => {
                self.motion.acknowledged && behaviour.set_point_acknowledged
            }
            motion::PROFILE_VELOCITY_MODE => self.motion.is_still() == behaviour.speed_zero_shown,
            mode => mode >= 8,
        };
        let local = self.conditions.is_local() && behaviour.local_control_told;
        let remote = behaviour.remote_bit_shown && !local;
        let bits = [
            (VOLTAGE_ENABLED, behaviour.voltage_bit_shown),
            (REMOTE, remote),
            (TARGET_REACHED, operates && arrived && self.mode != 0),
            (MODE_BIT, operates && mode_bit),
        ];
        let shown = bits.into_iter().filter(|(_, shown)| *shown);
        shown.fold(word, |word, (bit, _)| word | bit)
    }

    fn show(&self, objects: &mut Objects) {
        objects.set_number(STATUSWORD, i64::from(self.statusword(objects)));
        objects.set_number(MODE_DISPLAY, i64::from(self.mode));
        let operates = self.power == Power::OperationEnabled;
        let mode = if operates { self.mode } else { 0 };
        self.motion.show(mode, &self.behaviour, objects);
    }

    /// What makes it fault begins or ends.
    pub(crate) fn set_cause(&mut self, cause: bool) {
        self.cause = cause;
    }

    /// There is no power: what it was doing is forgotten.
    pub(crate) fn power_off(&mut self) {
        self.enter(Power::NotReady);
        self.next_mode = None;
        self.tick = None;
        self.reported = false;
    }

    /// Something has happened, now: what follows from it by and by.
    pub(crate) fn settle(&mut self, now: Instant, slave: &mut Slave) {
        if self.cause && !self.reported {
            self.fail(now, slave);
        } else if self.reported
            && !self.cause
            && !matches!(self.power, Power::FaultReaction | Power::Fault)
        {
            self.recover(now, slave);
        }
        let stopping = match self.following {
            Some((Power::OperationEnabled, _)) => self.behaviour.enabling,
            _ => STOPPING,
        };
        if let Some((_, due @ None)) = &mut self.following {
            *due = Some(now + stopping);
        }
        if let Some((_, due @ None)) = &mut self.next_mode {
            *due = Some(now + self.behaviour.mode_switching);
        }
        let busy =
            self.power == Power::OperationEnabled && self.motion.is_busy(self.mode, &slave.objects);
        self.tick = busy.then(|| self.tick.unwrap_or(now + motion::TICK));
    }

    fn fail(&mut self, now: Instant, slave: &mut Slave) {
        self.reported = true;
        if self.behaviour.error_code_shown {
            let code = SENSOR
                .code
                .wrapping_add(self.behaviour.error_code_difference);
            slave.objects.set_number(ERROR_CODE, i64::from(code));
        }
        if let Some(alarm) = self.model.alarm {
            slave.objects.set_number(alarm, 2);
        }
        if self.behaviour.fault_disables {
            if self.power.is_powered() {
                self.enter(Power::FaultReaction);
                self.following = Some((Power::Fault, None));
            } else {
                self.enter(Power::Fault);
            }
        }
        self.show(&mut slave.objects);
        if self.behaviour.fault_reported {
            slave.set_error(now, SENSOR, true);
        }
        slave.values_changed();
    }

    fn recover(&mut self, now: Instant, slave: &mut Slave) {
        self.reported = false;
        slave.objects.set_number(ERROR_CODE, 0);
        if let Some(alarm) = self.model.alarm {
            slave.objects.set_number(alarm, 0);
        }
        if self.behaviour.fault_reported {
            slave.set_error(now, SENSOR, false);
        }
        slave.values_changed();
    }

    pub(crate) fn wake_at(&self) -> Option<Instant> {
        let following = self.following.and_then(|(_, due)| due);
        let mode = self.next_mode.and_then(|(_, due)| due);
        [following, mode, self.tick].into_iter().flatten().min()
    }

    pub(crate) fn wake(&mut self, now: Instant, slave: &mut Slave) {
        let is_due = |due: Option<Instant>| due.is_some_and(|due| due <= now);
        if !is_due(self.wake_at()) {
            return;
        }
        if let Some((power, due)) = self.following
            && is_due(due)
        {
            self.enter(power);
        }
        if self.next_mode.is_some_and(|(_, due)| is_due(due)) {
            self.take_mode();
        }
        if is_due(self.tick) {
            self.tick = None;
            let objects = &mut slave.objects;
            self.motion
                .advance(self.mode, self.model, &self.behaviour, objects);
        }
        self.show(&mut slave.objects);
        slave.values_changed();
        self.settle(now, slave);
    }
}

impl Application for Drive {
    fn writing(&mut self, address: Address, value: &[u8]) -> Answer {
        if address.index() < 0x2000 {
            return Answer::Now;
        }
        if address == CONTROLWORD && !self.behaviour.local_control_told {
            return Answer::Now;
        }
        if address == MODE
            && let [code] = value
            && !self.has_mode(code.cast_signed())
            && self.behaviour.unsupported_mode_refused
            && !self.behaviour.any_mode_taken
        {
            return Answer::Refused(Abort::INVALID_VALUE);
        }
        self.conditions.answer()
    }

    fn written(&mut self, address: Address, objects: &mut Objects) {
        match address {
            CONTROLWORD => self.command(objects),
            MODE => self.choose_mode(objects),
            _ if address.index() < 0x6000 => return,
            _ => {}
        }
        self.show(objects);
    }

    fn reset(&mut self, objects: &mut Objects) {
        if self.behaviour.reset_disables || self.power == Power::NotReady {
            self.enter(Power::SwitchOnDisabled);
        }
        self.controlword = 0;
        self.reported = false;
        self.next_mode = None;
        self.mode = 0;
        let modes = objects.number(SUPPORTED_MODES).unwrap_or(0);
        let surplus = self.behaviour.surplus_modes;
        objects.set_number(SUPPORTED_MODES, i64::from(modes | surplus));
        self.show(objects);
    }
}
