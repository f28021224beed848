//! How the gateway behaves, as settings, and its faults.

use crate::Fault;

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
    /// A download is confirmed when the inverter has answered; otherwise when it was asked.
    pub waits_for_inverter: bool,
    /// A refusal of the inverter aborts the download.
    pub refusals_passed_on: bool,
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour {
            swapped_registers: None,
            direction_passed_on: true,
            fault_reset_passed_on: true,
            counts_per_target: 2,
            waits_for_inverter: true,
            refusals_passed_on: true,
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
