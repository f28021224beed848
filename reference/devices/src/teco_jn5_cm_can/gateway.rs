//! From objects to the registers of the inverter and back.
//!
//! | object | register |
//! | --- | --- |
//! | 2025h:`n` | 2500h + `n` - 1, read with 03h, written with 06h |
//! | 6040h bit 0, bit 7 | 2501h bit 0 (run), bit 3 (fault reset) |
//! | 6042h bits 0 to 14, bit 15 | 2502h (0.01 Hz, so twice the value), 2501h bit 1 (reverse) |
//! | 603Fh | 2521h |
//! | 6041h bit 0 | 2520h bit 0 (running) |
//! | 6043h bits 0 to 14, bit 15 | 2523h (so half the value), 2520h bit 1 (reverse) |

use std::collections::VecDeque;
use std::time::Duration;

use fieldproof_link::Instant;

use super::{Behaviour, Lost, RunState, TargetSign};
use crate::canopen::{Abort, Address, Answer, Application, Objects, Slave};
use crate::inverter::{LINE, STATION};
use crate::modbus::{Failure, ModbusMaster, Reply, RequestId};

const GROUP_25: u16 = 0x2025;
const ERROR_CODE: Address = Address::new(0x603F, 0);
const CONTROLWORD: Address = Address::new(0x6040, 0);
const STATUSWORD: Address = Address::new(0x6041, 0);
const TARGET_VELOCITY: Address = Address::new(0x6042, 0);
const VELOCITY_DEMAND: Address = Address::new(0x6043, 0);
/// Through which the inverter is commanded beside 6040h and 6042h.
const OPERATION_SIGNAL: Address = Address::new(GROUP_25, 0x02);

const OPERATION_REGISTER: u16 = 0x2501;
const FREQUENCY_REGISTER: u16 = 0x2502;
const STATE_REGISTER: u16 = 0x2520;
/// 2520h to 2524h
const STATUS_REGISTERS: u16 = 5;
const FREQUENCY_DEMAND_REGISTER: u16 = 0x2523;
const OUTPUT_FREQUENCY_REGISTER: u16 = 0x2524;

const RUN: u16 = 1 << 0;
const REVERSE: u16 = 1 << 1;
const FAULT_RESET: u16 = 1 << 3;
const SIGN: u16 = 1 << 15;

const TIMEOUT: Duration = Duration::from_millis(100);
const POLL_PERIOD: Duration = Duration::from_millis(100);
/// The exception that says that a value is not one.
const ILLEGAL_DATA_VALUE: u8 = 3;

/// Something the inverter is to be asked, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    /// A register for an upload.
    Read(Address),
    /// 2520h and what follows, for an upload or for the PDOs.
    Status(Option<Address>),
    /// A value that was downloaded.
    Write { address: Address, value: u16 },
    /// The direction, after the frequency of the same object.
    Direction { address: Address, reverse: bool },
}

/// The Modbus master's side of the module.
#[derive(Debug)]
pub(super) struct Gateway {
    pub(super) master: ModbusMaster,
    behaviour: Behaviour,
    tasks: VecDeque<Task>,
    current: Option<(RequestId, Task)>,
    /// 2501h as it was written last.
    operation: u16,
    /// What 6040h and 6042h were when the inverter last took them.
    controlword: u16,
    target: u16,
    /// What is written now goes on to the inverter.
    passes_on: bool,
    /// The inverter has once not answered, and is not asked again.
    gone: bool,
    /// Values set beside the bus: they stay until the inverter is commanded.
    pub(super) held: Vec<Address>,
    pub(super) poll_at: Option<Instant>,
}

impl Gateway {
    pub(super) fn new(behaviour: Behaviour) -> Gateway {
        Gateway {
            master: ModbusMaster::new(LINE, TIMEOUT).taking(behaviour.answers),
            behaviour,
            tasks: VecDeque::new(),
            current: None,
            operation: 0,
            controlword: 0,
            target: 0,
            passes_on: true,
            gone: false,
            held: Vec::new(),
            poll_at: None,
        }
    }

    /// A frame is coming, from an SDO client or another.
    pub(super) fn hears(&mut self, from_client: bool) {
        self.passes_on = from_client || self.behaviour.pdo_passed_on;
    }

    pub(super) fn operation(&self) -> u16 {
        self.operation
    }

    /// Whether the PDOs are to be kept fresh.
    pub(super) fn keep_polling(&mut self, now: Instant, operational: bool) {
        if !operational || !self.behaviour.polls {
            self.poll_at = None;
        } else if self.poll_at.is_none() {
            self.poll_at = Some(now);
        }
    }

    /// Asks the inverter what is to be asked next, unless it is being asked.
    pub(super) fn go_on(&mut self, now: Instant) {
        if self.poll_at.is_some_and(|at| at <= now) {
            self.poll_at = Some(now + POLL_PERIOD);
            if !self.tasks.contains(&Task::Status(None)) {
                self.tasks.push_back(Task::Status(None));
            }
        }
        if self.current.is_some() {
            return;
        }
        let Some(task) = self.tasks.pop_front() else {
            return;
        };
        let id = match task {
            Task::Read(address) => self.read(now, member(address), 1),
            Task::Status(_) => self.read(now, STATE_REGISTER, STATUS_REGISTERS),
            Task::Write { address, value } => {
                let (register, value) = self.command(address, value);
                self.write(now, register, value)
            }
            Task::Direction { reverse, .. } => {
                let operation = self.with_direction(reverse);
                self.write(now, OPERATION_REGISTER, operation)
            }
        };
        self.current = Some((id, task));
    }

    fn read(&mut self, now: Instant, register: u16, quantity: u16) -> RequestId {
        let register = match quantity {
            1 => self.as_taken(register),
            _ => register,
        };
        self.master.read_holding(now, STATION, register, quantity)
    }

    fn write(&mut self, now: Instant, register: u16, value: u16) -> RequestId {
        let register = self.as_taken(register);
        self.master.write_single(now, STATION, register, value)
    }

    /// The register that the gateway takes for `register`.
    fn as_taken(&self, register: u16) -> u16 {
        match self.behaviour.swapped_registers {
            Some([first, second]) if register == first => second,
            Some([first, second]) if register == second => first,
            _ => register,
        }
    }

    /// What a value that was downloaded to `address` writes first.
    fn command(&self, address: Address, value: u16) -> (u16, u16) {
        match address {
            CONTROLWORD => {
                let run = value & 1;
                let says = value & 1 << 7 != 0 || !self.behaviour.fault_reset_on_bit_7_only;
                let asked = says && self.behaviour.fault_reset_passed_on;
                let reset = if asked { FAULT_RESET } else { 0 };
                let others = self.operation & !(RUN | FAULT_RESET);
                (OPERATION_REGISTER, others | run | reset)
            }
            TARGET_VELOCITY => {
                let magnitude = match self.behaviour.target_sign {
                    TargetSign::Bit15 => value & !SIGN,
                    TargetSign::TwosComplement => value.cast_signed().unsigned_abs(),
                };
                let counts = magnitude.saturating_mul(self.behaviour.counts_per_target);
                (FREQUENCY_REGISTER, counts & self.behaviour.frequency_mask)
            }
            _ => {
                let register = member(address) + self.behaviour.first_written;
                (register, self.in_order(value))
            }
        }
    }

    fn with_direction(&self, reverse: bool) -> u16 {
        let operation = if reverse {
            self.operation | REVERSE
        } else {
            self.operation & !REVERSE
        };
        if operation == self.operation || self.behaviour.direction_keeps_run {
            operation
        } else {
            operation & !RUN
        }
    }

    /// A value of 2025h as a register has it, and the other way round.
    fn in_order(&self, value: u16) -> u16 {
        if self.behaviour.bytes_in_order {
            value
        } else {
            value.swap_bytes()
        }
    }

    /// Gives what the inverter answered to whoever waits for it.
    pub(super) fn deliver(&mut self, now: Instant, slave: &mut Slave) {
        while let Some((id, result)) = self.master.take_result() {
            if let Some((_, task)) = self.current.take_if(|(current, _)| *current == id) {
                self.finish(now, task, result, slave);
            }
        }
        self.go_on(now);
    }

    fn finish(
        &mut self,
        now: Instant,
        task: Task,
        result: Result<Reply, Failure>,
        slave: &mut Slave,
    ) {
        self.gone |= result == Err(Failure::NoAnswer) && !self.behaviour.asks_again;
        match (task, result) {
            (Task::Read(address), Ok(Reply::Registers(registers))) => {
                let value = self.in_order(registers.first().copied().unwrap_or_default());
                slave.finish_upload(now, address, Ok(&value.to_le_bytes()));
            }
            (Task::Status(awaited), Ok(Reply::Registers(registers))) => {
                self.show_status(&registers, &mut slave.objects);
                let value = awaited.and_then(|address| slave.objects.number(address));
                if let (Some(address), Some(value)) = (awaited, value) {
                    slave.finish_upload(now, address, Ok(&value.to_le_bytes()));
                }
            }
            (Task::Read(address) | Task::Status(Some(address)), result) => {
                self.fail_upload(now, address, result.err(), slave);
            }
            (Task::Status(None), _) => {}
            (Task::Write { address, value }, Ok(_)) => {
                if self.taken(address, value) {
                    slave.finish_download(now, address, Ok(()));
                }
            }
            (Task::Direction { address, reverse }, Ok(_)) => {
                self.operation = self.with_direction(reverse);
                slave.finish_download(now, address, Ok(()));
            }
            (Task::Write { address, .. } | Task::Direction { address, .. }, Err(failure)) => {
                self.put_back(address, &mut slave.objects);
                let outcome = if self.behaviour.refusals_passed_on {
                    Err(abort(failure))
                } else {
                    Ok(())
                };
                slave.finish_download(now, address, outcome);
            }
        }
    }

    /// The inverter has not given what an upload asks for.
    fn fail_upload(
        &self,
        now: Instant,
        address: Address,
        failure: Option<Failure>,
        slave: &mut Slave,
    ) {
        let silent = failure == Some(Failure::NoAnswer);
        match (failure, self.behaviour.lost) {
            (Some(Failure::Exception(code)), _) if !self.behaviour.exceptions_told => {
                slave.finish_upload(now, address, Ok(&[code, 0]));
            }
            (_, Lost::Zero) if silent => slave.finish_upload(now, address, Ok(&[0, 0])),
            (_, Lost::Hangs) if silent => {}
            _ => {
                let abort = failure.map_or(Abort::HARDWARE, abort);
                slave.finish_upload(now, address, Err(abort));
            }
        }
    }

    /// The inverter has taken the first register of `address`; `false` if the direction is still to come.
    fn taken(&mut self, address: Address, value: u16) -> bool {
        self.held.clear();
        match address {
            CONTROLWORD => {
                (_, self.operation) = self.command(address, value);
                self.controlword = value;
            }
            OPERATION_SIGNAL => self.operation = value,
            TARGET_VELOCITY => {
                self.target = value;
                let reverse = value & SIGN != 0 && self.behaviour.direction_passed_on;
                if self.with_direction(reverse) != self.operation {
                    self.tasks.push_front(Task::Direction { address, reverse });
                    return false;
                }
            }
            _ => {}
        }
        true
    }

    /// The inverter has not taken what was written.
    fn put_back(&self, address: Address, objects: &mut Objects) {
        match address {
            CONTROLWORD => objects.set_number(address, i64::from(self.controlword)),
            TARGET_VELOCITY => objects.set_number(address, i64::from(self.target)),
            _ => {}
        }
    }

    fn show_status(&self, registers: &[u16], objects: &mut Objects) {
        let at = |register: u16| {
            let place = usize::from(self.as_taken(register).wrapping_sub(STATE_REGISTER));
            registers.get(place).copied().unwrap_or_default()
        };
        let state = at(STATE_REGISTER);
        let sign = if state & REVERSE == 0 { 0 } else { SIGN };
        let runs = match self.behaviour.run_state {
            RunState::OfInverter => state & RUN != 0,
            RunState::OfCommand => self.operation & RUN != 0,
            RunState::Frozen => false,
        };
        let [running, resting] = self.behaviour.statuswords;
        let demand = self.demand(at(FREQUENCY_DEMAND_REGISTER), at(OUTPUT_FREQUENCY_REGISTER));
        for (address, value) in [
            (ERROR_CODE, at(STATE_REGISTER + 1)),
            (STATUSWORD, if runs { running } else { resting }),
            (VELOCITY_DEMAND, demand | sign),
        ] {
            if !self.held.contains(&address) {
                objects.set_number(address, i64::from(value));
            }
        }
    }

    /// 6043h, without its direction.
    fn demand(&self, before_ramp: u16, behind_ramp: u16) -> u16 {
        let frequency = if self.behaviour.demand_behind_ramp {
            behind_ramp
        } else {
            before_ramp
        };
        let half = u16::from(self.behaviour.demand_rounded_up);
        frequency.saturating_add(half) / self.behaviour.counts_per_demand.max(1)
    }
}

/// The register of group 25 that a sub-index of 2025h stands for.
fn member(address: Address) -> u16 {
    0x2500 + u16::from(address.sub()).saturating_sub(1)
}

fn abort(failure: Failure) -> Abort {
    match failure {
        Failure::Exception(ILLEGAL_DATA_VALUE) => Abort::INVALID_VALUE,
        Failure::Exception(_) => Abort::CANNOT_STORE,
        Failure::NoAnswer | Failure::Malformed => Abort::HARDWARE,
    }
}

impl Application for Gateway {
    fn reading(&mut self, address: Address) -> Answer {
        let task = match address {
            _ if address.index() == GROUP_25 && address.sub() != 0 => Task::Read(address),
            ERROR_CODE | STATUSWORD | VELOCITY_DEMAND if !self.held.contains(&address) => {
                Task::Status(Some(address))
            }
            _ => return Answer::Now,
        };
        if self.gone {
            return Answer::Refused(Abort::HARDWARE);
        }
        self.tasks.push_back(task);
        Answer::Later
    }

    fn writing(&mut self, address: Address, value: &[u8]) -> Answer {
        let group_25 = address.index() == GROUP_25;
        if !group_25 && address != CONTROLWORD && address != TARGET_VELOCITY {
            return Answer::Now;
        }
        if self.gone {
            return Answer::Refused(Abort::HARDWARE);
        }
        if !self.passes_on {
            return Answer::Now;
        }
        let value = <[u8; 2]>::try_from(value).map_or(0, u16::from_le_bytes);
        self.tasks.push_back(Task::Write { address, value });
        if self.behaviour.waits_for_inverter {
            Answer::Later
        } else {
            Answer::Now
        }
    }

    fn reset(&mut self, _: &mut Objects) {
        self.master.clear();
        self.tasks.clear();
        self.current = None;
        self.operation = 0;
        self.controlword = 0;
        self.target = 0;
        self.gone = false;
        self.held.clear();
        self.poll_at = None;
    }
}
