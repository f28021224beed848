//! What else a right drive may do.

use std::time::Duration;

use crate::Variant;

pub(crate) const BRAKE: Variant = Variant {
    name: "brake",
    words: "opens a brake for 80 ms before it is in operation enabled; how long a transition takes is the drive's affair",
    apply: |behaviour| behaviour.drive.enabling = Duration::from_millis(80),
};

pub(crate) const ENABLED_STEP_BY_STEP: Variant = Variant {
    name: "enabled-step-by-step",
    words: "goes from ready to switch on to switched on when it is told to enable operation at once, and is enabled by the same controlword written again, as editions of the profile before CiA 402-2 had it",
    apply: |behaviour| behaviour.drive.enables_directly = false,
};

pub(crate) const QUICK_STOP_NOT_RESUMED: Variant = Variant {
    name: "quick-stop-not-resumed",
    words: "leaves quick stop active by disable voltage alone; CiA 402 advises against transition 16",
    apply: |behaviour| behaviour.drive.quick_stop_resumable = false,
};

pub(crate) const QUICK_STOP_BIT_AT_REST: Variant = Variant {
    name: "quick-stop-bit-at-rest",
    words: "shows bit 5 of the statusword as 1 in switch on disabled and fault, where CiA 402 leaves it open",
    apply: |behaviour| behaviour.drive.quick_stop_bit_at_rest = true,
};

pub(crate) const MODE_SWITCHED_LATER: Variant = Variant {
    name: "mode-switched-later",
    words: "shows a new mode of operation 40 ms after it was told, when it has switched",
    apply: |behaviour| behaviour.drive.mode_switching = Duration::from_millis(40),
};

pub(crate) const UNSUPPORTED_MODE_PASSED_OVER: Variant = Variant {
    name: "unsupported-mode-passed-over",
    words: "takes a mode of operation that it has not into 6060h, and stays in the one it is in",
    apply: |behaviour| behaviour.drive.unsupported_mode_refused = false,
};
