//! Where the shaft is and how fast it turns.

use std::time::Duration;

use super::{Behaviour, Model};
use crate::canopen::{Address, Objects};

const TARGET_TORQUE: Address = Address::new(0x6071, 0);
const TORQUE_DEMAND: Address = Address::new(0x6074, 0);
const TORQUE_ACTUAL: Address = Address::new(0x6077, 0);
const TARGET_POSITION: Address = Address::new(0x607A, 0);
const POSITION_DEMAND: Address = Address::new(0x6062, 0);
const PROFILE_VELOCITY: Address = Address::new(0x6081, 0);
const ACCELERATION: Address = Address::new(0x6083, 0);
const DECELERATION: Address = Address::new(0x6084, 0);
const TARGET_VELOCITY: Address = Address::new(0x60FF, 0);
const VELOCITY_DEMAND: Address = Address::new(0x606B, 0);
const VELOCITY_ACTUAL: Address = Address::new(0x606C, 0);

pub(super) const PROFILE_POSITION: i8 = 1;
pub(super) const PROFILE_VELOCITY_MODE: i8 = 3;
const PROFILE_TORQUE: i8 = 4;
const CYCLIC_POSITION: i8 = 8;
const CYCLIC_VELOCITY: i8 = 9;
const CYCLIC_TORQUE: i8 = 10;

/// Between two looks at the shaft.
pub(super) const TICK: Duration = Duration::from_millis(5);
const TICK_MS: i64 = 5;

/// What the motor does.
#[derive(Debug, Default)]
pub(super) struct Motion {
    /// Thousandths of the drive's unit of velocity.
    velocity: i64,
    /// Millionths of a count that the shaft has turned beyond its position.
    remainder: i64,
    /// The position that is approached.
    target: Option<i64>,
    /// The position that is approached after it.
    next: Option<i64>,
    /// A set-point was taken, and bit 4 of the controlword is still 1.
    pub(super) acknowledged: bool,
    halted: bool,
}

/// A new set-point, by bits 5 and 6 of the controlword.
#[derive(Debug, Clone, Copy)]
pub(super) struct SetPoint {
    pub(super) at_once: bool,
    pub(super) relative: bool,
}

fn signed(objects: &Objects, address: Address) -> i64 {
    objects
        .number(address)
        .map_or(0, |number| i64::from(number.cast_signed()))
}

fn signed_16(objects: &Objects, address: Address) -> i64 {
    let bits = objects.number(address).unwrap_or(0) & 0xFFFF;
    if bits & 0x8000 != 0 {
        i64::from(bits) - 0x1_0000
    } else {
        i64::from(bits)
    }
}

impl Motion {
    /// The motor has no torque any more, or another mode.
    pub(super) fn stop(&mut self) {
        *self = Motion::default();
    }

    /// Bit 8 of the controlword.
    pub(super) fn halt(&mut self, halted: bool) {
        self.halted = halted;
    }

    pub(super) fn is_still(&self) -> bool {
        self.velocity == 0
    }

    /// Takes 607Ah as a set-point; `false` if there are two already.
    pub(super) fn take(&mut self, model: &Model, point: SetPoint, objects: &Objects) -> bool {
        let from = match (point.relative, self.next.or(self.target)) {
            (false, _) => 0,
            (true, Some(before)) => before,
            (true, None) => signed(objects, model.position),
        };
        let target = from.saturating_add(signed(objects, TARGET_POSITION));
        if point.at_once || self.target.is_none() {
            self.target = Some(target);
            self.next = None;
        } else if self.next.is_none() {
            self.next = Some(target);
        } else {
            return false;
        }
        true
    }

    /// Whether the target of `mode` is reached; while it is halted, whether it stands.
    pub(super) fn has_arrived(&self, mode: i8, objects: &Objects) -> bool {
        match mode {
            _ if self.halted => self.is_still(),
            PROFILE_POSITION => self.target.is_none(),
            PROFILE_VELOCITY_MODE => self.velocity == signed(objects, TARGET_VELOCITY) * 1000,
            _ => true,
        }
    }

    /// Whether another look at the shaft is worth while.
    pub(super) fn is_busy(&self, mode: i8, objects: &Objects) -> bool {
        !self.is_still()
            || !self.has_arrived(mode, objects)
            || (mode == CYCLIC_POSITION && !self.halted)
            || (mode == CYCLIC_VELOCITY && signed(objects, TARGET_VELOCITY) != 0)
    }

    /// A tick has passed in `mode`.
    pub(super) fn advance(
        &mut self,
        mode: i8,
        model: &Model,
        behaviour: &Behaviour,
        objects: &mut Objects,
    ) {
        let position = signed(objects, model.position);
        let position = match mode {
            PROFILE_POSITION => self.approach(model, position, objects),
            PROFILE_VELOCITY_MODE | CYCLIC_VELOCITY => {
                let demanded = signed(objects, TARGET_VELOCITY) * 1000;
                let demanded = if self.halted { 0 } else { demanded };
                self.velocity = if mode == CYCLIC_VELOCITY {
                    demanded
                } else {
                    self.ramp(demanded, behaviour, objects)
                };
                position + self.counts(model)
            }
            CYCLIC_POSITION if !self.halted => signed(objects, TARGET_POSITION),
            _ => position,
        };
        objects.set_number(model.position, position);
        objects.set_number(POSITION_DEMAND, position);
    }

    /// The position after a tick of a move to the target.
    fn approach(&mut self, model: &Model, position: i64, objects: &Objects) -> i64 {
        let speed = i64::from(objects.number(PROFILE_VELOCITY).unwrap_or(0)) * 1000;
        let Some(target) = self.target.filter(|_| !self.halted) else {
            self.velocity = 0;
            return position;
        };
        self.velocity = speed * (target - position).signum();
        let reached = position + self.counts(model);
        let passed = (target - position).signum() != (target - reached).signum();
        if !passed && target != position {
            return reached;
        }
        self.velocity = 0;
        self.remainder = 0;
        self.target = self.next.take();
        target
    }

    /// The velocity after a tick of a ramp: 6083h and 6084h are milliseconds for 1000 units of velocity.
    fn ramp(&self, demanded: i64, behaviour: &Behaviour, objects: &Objects) -> i64 {
        let faster = demanded.abs() > self.velocity.abs();
        let parameter = if faster { ACCELERATION } else { DECELERATION };
        let parameter = i64::from(objects.number(parameter).unwrap_or(0));
        let step = if !behaviour.ramp_is_time {
            parameter * TICK_MS
        } else if let Some(step) = (1_000_000 * TICK_MS).checked_div(parameter) {
            step
        } else {
            return demanded;
        };
        let change = (demanded - self.velocity).clamp(-step, step);
        self.velocity + change
    }

    /// The counts of a tick.
    fn counts(&mut self, model: &Model) -> i64 {
        let (counts, seconds) = model.counts_a_second;
        let millionths = self.velocity.saturating_mul(TICK_MS * counts) / seconds + self.remainder;
        self.remainder = millionths % 1_000_000;
        millionths / 1_000_000
    }

    /// Shows velocity and torque.
    pub(super) fn show(&self, mode: i8, behaviour: &Behaviour, objects: &mut Objects) {
        let velocity = self.velocity / 1000;
        let shown = if behaviour.velocity_signed {
            velocity
        } else {
            velocity.abs()
        };
        objects.set_number(VELOCITY_DEMAND, velocity);
        objects.set_number(VELOCITY_ACTUAL, shown);
        let torque = match mode {
            PROFILE_TORQUE | CYCLIC_TORQUE if !self.halted => signed_16(objects, TARGET_TORQUE),
            _ => 0,
        };
        objects.set_number(TORQUE_DEMAND, torque);
        objects.set_number(TORQUE_ACTUAL, torque);
    }
}
