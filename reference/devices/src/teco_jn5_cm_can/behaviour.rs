//! How the gateway behaves, as settings, and its faults.

use crate::modbus::master::Answers;
use crate::{Fault, Variant};

/// The settings of a gateway's behaviour.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Behaviour {
    /// Two registers that it takes for each other.
    pub swapped_registers: Option<[u16; 2]>,
    /// Bit 15 of 6042h becomes the direction of the inverter.
    pub direction_passed_on: bool,
    /// Bit 7 of 6040h becomes the fault reset of the inverter.
    pub fault_reset_passed_on: bool,
    /// Counts of 2502h for one count of 6042h.
    pub counts_per_target: u16,
    /// The bits of 2502h that a frequency command can have.
    pub frequency_mask: u16,
    /// A download is confirmed when the inverter has answered; otherwise when it was asked.
    pub waits_for_inverter: bool,
    /// A refusal of the inverter aborts the download.
    pub refusals_passed_on: bool,
    /// How 6042h says backwards.
    pub target_sign: TargetSign,
    /// A change of direction leaves the other bits of 2501h as they are.
    pub direction_keeps_run: bool,
    /// Bit 7 of 6040h alone clears a fault, and not every write.
    pub fault_reset_on_bit_7_only: bool,
    /// What an RPDO sets goes on to the inverter.
    pub pdo_passed_on: bool,
    /// What the TPDOs show is read from the inverter again and again.
    pub polls: bool,
    /// What 6041h shows.
    pub run_state: RunState,
    /// Legal variant: what 6041h is while the motor runs, and while it does not. The manual has no bits.
    pub statuswords: [u16; 2],
    /// Legal variant: 6043h is the frequency behind the ramp.
    pub demand_behind_ramp: bool,
    /// Legal variant: half a count of 6043h is a whole one.
    pub demand_rounded_up: bool,
    /// Counts of 2523h for one count of 6043h.
    pub counts_per_demand: u16,
    /// The register of group 25 that a write to 2025h:01 goes to is 2500h and this.
    pub first_written: u16,
    /// A value passes through 2025h with its bytes in order.
    pub bytes_in_order: bool,
    /// What an upload answers when the inverter does not.
    pub lost: Lost,
    /// The inverter is asked again after it has once not answered.
    pub asks_again: bool,
    /// What is taken for an answer of the inverter.
    pub answers: Answers,
    /// The code of an exception is not taken for the value.
    pub exceptions_told: bool,
}

/// How 6042h says backwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetSign {
    /// By bit 15, beside the magnitude.
    Bit15,
    /// As an INTEGER16 does.
    TwosComplement,
}

/// What 6041h shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunState {
    /// Whether the inverter runs.
    OfInverter,
    /// Whether it was told to.
    OfCommand,
    /// Nothing.
    Frozen,
}

/// What an upload of 2025h answers when the inverter does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    /// It is aborted.
    Aborts,
    /// 0.
    Zero,
    /// It is not answered at all.
    Hangs,
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour {
            swapped_registers: None,
            direction_passed_on: true,
            fault_reset_passed_on: true,
            counts_per_target: 2,
            frequency_mask: 0xFFFF,
            waits_for_inverter: true,
            refusals_passed_on: true,
            target_sign: TargetSign::Bit15,
            direction_keeps_run: true,
            fault_reset_on_bit_7_only: true,
            pdo_passed_on: true,
            polls: true,
            run_state: RunState::OfInverter,
            statuswords: [1, 0],
            demand_behind_ramp: false,
            demand_rounded_up: false,
            counts_per_demand: 2,
            first_written: 0,
            bytes_in_order: true,
            lost: Lost::Aborts,
            asks_again: true,
            answers: Answers::Right,
            exceptions_told: true,
        }
    }
}

pub(super) const SWAPS_TWO_REGISTERS: Fault = Fault {
    name: "gateway-swaps-two-registers",
    breaks: "TECO JN5-CM-CAN manual 4.7: sub-index of 2025h is the member of group 25 plus one",
    words: "reads the output frequency (2524h) for the frequency command (2523h), and the other way round",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.swapped_registers = Some([0x2523, 0x2524]),
};

pub(super) const DIRECTION_LOST: Fault = Fault {
    name: "gateway-direction-lost",
    breaks: "TECO JN5-CM-CAN manual 4.6: bit 15 of 6042h is the direction",
    words: "runs forward whatever bit 15 of 6042h says",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.direction_passed_on = false,
};

pub(super) const FAULT_RESET_LOST: Fault = Fault {
    name: "gateway-fault-reset-lost",
    breaks: "TECO JN5-CM-CAN manual 4.6: bit 7 of 6040h clears faults",
    words: "does not tell the inverter to clear its fault",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.fault_reset_passed_on = false,
};

pub(super) const FREQUENCY_HALVED: Fault = Fault {
    name: "gateway-frequency-halved",
    breaks: "TECO JN5-CM-CAN manual 4.6: 6042h counts 0.02 Hz",
    words: "writes 6042h to 2502h as it is, so the motor turns at half the speed",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.counts_per_target = 1,
};

pub(super) const FREQUENCY_IN_15_BITS: Fault = Fault {
    name: "gateway-frequency-in-15-bits",
    breaks: "TECO JN5-CM-CAN manual 4.6: 6042h goes up to 400 Hz",
    words: "doubles 6042h within 15 bits, so that from 327.68 Hz on the frequency begins again at 0",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.frequency_mask = 0x7FFF,
};

pub(super) const CONFIRMS_EARLY: Fault = Fault {
    name: "gateway-confirms-early",
    breaks: "CiA 301: SDO download, confirmed when it is done",
    words: "confirms a download before the inverter was asked",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.waits_for_inverter = false,
};

pub(super) const REFUSAL_HIDDEN: Fault = Fault {
    name: "gateway-refusal-hidden",
    breaks: "CiA 301: SDO abort transfer",
    words: "confirms a download that the inverter refused or did not answer",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.refusals_passed_on = false,
};

pub(super) const TARGET_AS_INTEGER16: Fault = Fault {
    name: "gateway-target-as-integer16",
    breaks: "TECO JN5-CM-CAN manual 4.6: bit 15 of 6042h is the direction, bits 14 to 0 the frequency",
    words: "reads 6042h as CiA 402 has it, in two's complement",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.target_sign = TargetSign::TwosComplement,
};

pub(super) const DIRECTION_STOPS: Fault = Fault {
    name: "gateway-direction-stops",
    breaks: "TECO JN5-CM-CAN manual 4.6: bit 15 of 6042h is the direction and nothing else",
    words: "clears the run bit of 2501h when the direction changes",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.direction_keeps_run = false,
};

pub(super) const FAULT_RESET_BY_ANY_WRITE: Fault = Fault {
    name: "gateway-fault-reset-by-any-write",
    breaks: "TECO JN5-CM-CAN manual 4.6: bit 7 of 6040h clears faults, 0 does nothing",
    words: "clears the fault of the inverter with every write to 6040h",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.fault_reset_on_bit_7_only = false,
};

pub(super) const PDO_NOT_PASSED_ON: Fault = Fault {
    name: "gateway-pdo-not-passed-on",
    breaks: "TECO JN5-CM-CAN manual 1: RPDOs carry what can be written",
    words: "keeps what an RPDO sets and does not tell the inverter",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.pdo_passed_on = false,
};

pub(super) const NOT_POLLED: Fault = Fault {
    name: "gateway-not-polled",
    breaks: "TECO JN5-CM-CAN manual 1: TPDOs carry what can be read",
    words: "sends in TPDO2 what was last read over SDO",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.polls = false,
};

pub(super) const RUN_STATE_OF_COMMAND: Fault = Fault {
    name: "gateway-run-state-of-command",
    breaks: "TECO JN5-CM-CAN manual 4.6: 6041h is the state of the inverter",
    words: "shows in 6041h that the inverter was told to run, not that it runs",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.run_state = RunState::OfCommand,
};

pub(super) const RUN_STATE_FROZEN: Fault = Fault {
    name: "gateway-run-state-frozen",
    breaks: "TECO JN5-CM-CAN manual 4.6: 6041h is the state of the inverter",
    words: "reads 0 in 6041h whether the inverter runs or not",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.run_state = RunState::Frozen,
};

pub(super) const DEMAND_NOT_HALVED: Fault = Fault {
    name: "gateway-demand-not-halved",
    breaks: "TECO JN5-CM-CAN manual 4.6: 6043h counts 0.02 Hz",
    words: "shows in 6043h what 2523h holds, so twice the frequency",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.counts_per_demand = 1,
};

pub(super) const WRITES_ONE_FURTHER: Fault = Fault {
    name: "gateway-writes-one-further",
    breaks: "TECO JN5-CM-CAN manual 4.7: sub-index of 2025h is the member of group 25 plus one",
    words: "reads the register of a sub-index and writes the one after it",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.first_written = 1,
};

pub(super) const BYTE_ORDER: Fault = Fault {
    name: "gateway-byte-order",
    breaks: "CiA 301: numbers are transmitted least significant byte first",
    words: "passes a register through 2025h with its bytes as Modbus has them",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.bytes_in_order = false,
};

pub(super) const LOST_INVERTER_READS_ZERO: Fault = Fault {
    name: "gateway-lost-inverter-reads-zero",
    breaks: "CiA 301: SDO abort transfer",
    words: "answers 0 for a register when the inverter does not answer",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.lost = Lost::Zero,
};

pub(super) const LOST_INVERTER_HANGS: Fault = Fault {
    name: "gateway-lost-inverter-hangs",
    breaks: "CiA 301: SDO upload, confirmed service",
    words: "does not answer an upload at all when the inverter does not answer",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.lost = Lost::Hangs,
};

pub(super) const LOST_FOR_GOOD: Fault = Fault {
    name: "gateway-lost-for-good",
    breaks: "TECO JN5-CM-CAN manual 4.7: an access to 2025h is an access to the inverter",
    words: "refuses everything that concerns the inverter once that has not answered, until it is reset",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.asks_again = false,
};

pub(super) const CRC_UNCHECKED: Fault = Fault {
    name: "gateway-crc-unchecked",
    breaks: "MODBUS over serial line V1.02, 2.5.1.2: a frame with a wrong CRC is discarded",
    words: "takes an answer of the inverter whose CRC is wrong",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.answers = Answers::CrcUnchecked,
};

pub(super) const STATION_UNCHECKED: Fault = Fault {
    name: "gateway-station-unchecked",
    breaks: "MODBUS over serial line V1.02, 2.2: the address field of an answer says which slave it is from",
    words: "takes the answer of another station for that of the inverter",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.answers = Answers::StationUnchecked,
};

pub(super) const EXCEPTION_AS_VALUE: Fault = Fault {
    name: "gateway-exception-as-value",
    breaks: "MODBUS application protocol V1.1b3, 7: an exception is no value",
    words: "gives the exception code of the inverter as the value of the register",
    caught_by: "gateway",
    apply: |behaviour| behaviour.gateway.exceptions_told = false,
};

pub(super) const STATUSWORD_OF_CIA402: Variant = Variant {
    name: "statusword-of-cia402",
    words: "shows 0237h in 6041h while the motor runs and 0231h while it does not: the manual has no bits",
    apply: |behaviour| behaviour.gateway.statuswords = [0x0237, 0x0231],
};

pub(super) const DEMAND_BEHIND_RAMP: Variant = Variant {
    name: "demand-behind-ramp",
    words: "shows in 6043h the frequency behind the ramp (2524h), which is 0 at rest: the manual does not say which",
    apply: |behaviour| behaviour.gateway.demand_behind_ramp = true,
};

pub(super) const DEMAND_ROUNDED_UP: Variant = Variant {
    name: "demand-rounded-up",
    words: "rounds half a count of 6043h up: the manual does not say how it is rounded",
    apply: |behaviour| behaviour.gateway.demand_rounded_up = true,
};
