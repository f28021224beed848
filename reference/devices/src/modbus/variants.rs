//! What a right Modbus slave may do otherwise.

use std::time::Duration;

use super::Remains;
use crate::Variant;

/// Slow, as a device with other things to do.
pub(crate) const SLOW: Variant = Variant {
    name: "slow-modbus",
    words: "answers after 80 ms",
    apply: |behaviour| behaviour.modbus.processing_delay = Duration::from_millis(80),
};

/// A frame with a gap above 1.5 characters should be discarded, which is not a must.
pub(crate) const GAPS_TOLERATED: Variant = Variant {
    name: "gaps-tolerated",
    words: "takes a frame in which characters are up to 3.5 characters apart: V1.02 says it should be discarded",
    apply: |behaviour| behaviour.modbus.frame_remains = Some(Remains::OfTornFrames),
};
