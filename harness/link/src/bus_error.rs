//! What a CAN controller tells of trouble on the bus.

use std::fmt;

/// An error frame of a CAN interface, as Linux lays it out (`linux/can/error.h`):
///
/// | where | what |
/// | --- | --- |
/// | class bit 0 | the driver gave up sending |
/// | class bit 1 | arbitration lost, data 0: after which bit |
/// | class bit 2 | controller, data 1: its state |
/// | class bit 3 | protocol violation, data 2: which, data 3: where |
/// | class bit 4 | transceiver, data 4: which wire |
/// | class bit 5 | no acknowledge |
/// | class bit 6 | bus off |
/// | class bit 7 | bus error |
/// | class bit 8 | controller restarted |
/// | class bit 9 | data 6 and 7 count transmit and receive errors |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BusError {
    class: u16,
    data: [u8; 8],
}

const CLASSES: [(u16, &str); 9] = [
    (BUS_OFF, "bus off"),
    (RESTARTED, "controller restarted"),
    (NOT_ACKNOWLEDGED, "no acknowledge"),
    (1 << 1, "arbitration lost"),
    (CONTROLLER, "controller"),
    (1 << 3, "protocol violation"),
    (1 << 4, "transceiver"),
    (1 << 7, "bus error"),
    (1 << 0, "the driver gave up sending"),
];
const CONTROLLER: u16 = 1 << 2;
const NOT_ACKNOWLEDGED: u16 = 1 << 5;
const BUS_OFF: u16 = 1 << 6;
const RESTARTED: u16 = 1 << 8;
const COUNTERS: u16 = 1 << 9;

/// Bits of data 1.
const CONTROLLER_STATES: [(u8, &str); 7] = [
    (RECEIVE_OVERFLOW, "receive buffer overflow"),
    (0x02, "transmit buffer overflow"),
    (0x04, "receive error warning"),
    (0x08, "transmit error warning"),
    (0x10, "receive error passive"),
    (0x20, "transmit error passive"),
    (0x40, "error active"),
];
const RECEIVE_OVERFLOW: u8 = 0x01;

impl BusError {
    /// From the class bits of the identifier, and the data.
    pub const fn new(class: u16, data: [u8; 8]) -> BusError {
        BusError { class, data }
    }

    /// The controller has left the bus.
    pub const fn is_bus_off(&self) -> bool {
        self.class & BUS_OFF != 0
    }

    /// The controller lost frames because nobody fetched them in time.
    pub const fn is_receive_overflow(&self) -> bool {
        self.class & CONTROLLER != 0 && self.data[1] & RECEIVE_OVERFLOW != 0
    }

    /// How many transmit and receive errors the controller counts, where the driver tells.
    pub const fn counters(&self) -> Option<(u8, u8)> {
        if self.class & COUNTERS != 0 {
            Some((self.data[6], self.data[7]))
        } else {
            None
        }
    }
}

impl fmt::Display for BusError {
    /// `controller: transmit error passive; transmit errors 136, receive errors 0`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (bit, name) in CLASSES {
            if self.class & bit == 0 {
                continue;
            }
            write!(f, "{separator}{name}")?;
            separator = "; ";
            match bit {
                0x02 if self.data[0] != 0 => write!(f, " after bit {}", self.data[0])?,
                CONTROLLER => self.fmt_controller(f)?,
                0x08 => write!(f, " {:02X}h at {:02X}h", self.data[2], self.data[3])?,
                0x10 => write!(f, " {:02X}h", self.data[4])?,
                _ => {}
            }
        }
        if separator.is_empty() {
            write!(f, "error class {:03X}h", self.class)?;
        }
        if let Some((transmit, receive)) = self.counters() {
            write!(f, "; transmit errors {transmit}, receive errors {receive}")?;
        }
        Ok(())
    }
}

impl BusError {
    fn fmt_controller(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = ": ";
        for (bit, name) in CONTROLLER_STATES {
            if self.data[1] & bit != 0 {
                write!(f, "{separator}{name}")?;
                separator = ", ";
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_frame_is_read_out() {
        // Class 204h: controller and counters; data 1 = 20h transmit error passive; 136 transmit errors.
        let error = BusError::new(0x204, [0, 0x20, 0, 0, 0, 0, 136, 0]);
        assert_eq!(
            error.to_string(),
            "controller: transmit error passive; transmit errors 136, receive errors 0"
        );
        assert!(!error.is_bus_off() && !error.is_receive_overflow());
    }

    #[test]
    fn several_classes_are_all_told() {
        let error = BusError::new(0x046, [17, 0x01, 0, 0, 0, 0, 0, 0]);
        assert_eq!(
            error.to_string(),
            "bus off; arbitration lost after bit 17; controller: receive buffer overflow"
        );
        assert!(error.is_bus_off() && error.is_receive_overflow());
        assert_eq!(error.counters(), None);
    }

    #[test]
    fn an_unknown_class_is_kept() {
        assert_eq!(BusError::new(0x400, [0; 8]).to_string(), "error class 400h");
    }
}
