//! How the encoder measures and shows what it measures, as settings, and their faults.

use crate::modbus::SpeedSign;
use crate::{Fault, Variant};

/// The settings of an encoder's behaviour.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Behaviour {
    /// Legal variant: a change of the counting direction mirrors the position as well; a preset puts it right.
    pub position_jumps_with_direction: bool,
    /// Whether the speed that it shows on CAN carries its sign.
    pub speed_sign: SpeedSign,
    /// The highest speed that it shows on CAN, in 1/10000 rpm.
    pub highest_speed: i32,
    /// Bit 0 of 6000h turns the counting direction, and not the sign of the speed alone.
    pub direction_turns_count: bool,
    /// What writing 6003h does to the position.
    pub preset: PresetEffect,
    /// Whole turns are counted, and not the angle alone.
    pub turns_counted: bool,
    /// Past the last position comes the first.
    pub position_wraps: bool,
    /// What the shaft turns while the power is off is counted.
    pub turns_unpowered_counted: bool,
    /// The position that a preset has made survives a reset.
    pub preset_kept: bool,
    /// 2003h sets how many counts a turn has.
    pub resolution_obeyed: bool,
    /// 6500h shows what 6000h sets.
    pub status_follows: bool,
    /// 6200h is the event timer of TPDO1.
    pub cyclic_timer_is_event_timer: bool,
    /// What is saved when it is written survives a reset.
    pub settings_saved: bool,
}

/// What writing 6003h does to the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PresetEffect {
    /// It is the value from then on.
    Sets,
    /// Nothing.
    None,
    /// It is the value more than before.
    Adds,
    /// It is the value, unless that was written before.
    SetsOnce,
    /// It is the value in the other counting direction, while that is turned.
    SetsMirrored,
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour {
            position_jumps_with_direction: false,
            speed_sign: SpeedSign::Kept,
            highest_speed: i32::MAX,
            direction_turns_count: true,
            preset: PresetEffect::Sets,
            turns_counted: true,
            position_wraps: true,
            turns_unpowered_counted: true,
            preset_kept: true,
            resolution_obeyed: true,
            status_follows: true,
            cyclic_timer_is_event_timer: true,
            settings_saved: true,
        }
    }
}

pub(super) const POSITION_JUMPS_WITH_DIRECTION: Variant = Variant {
    name: "position-jumps-with-direction",
    words: "mirrors its position when bit 0 of 6000h changes, as if the shaft had been counted so from the start",
    apply: |behaviour| behaviour.encoder.position_jumps_with_direction = true,
};

const SPEED_SIGN_LOST: Fault = Fault {
    name: "speed-sign-lost-on-can",
    breaks: "Liaomiao encoder manual, object 2000h: the speed is signed",
    words: "shows the magnitude of the speed in 2000h and in both TPDOs",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.speed_sign = SpeedSign::Lost,
};

const SPEED_CLIPPED: Fault = Fault {
    name: "speed-clipped",
    breaks: "Liaomiao encoder manual, object 2000h: 32 bits, and shaft speeds of 6000 rpm and more",
    words: "shows 3276.7 rpm for every higher speed, as one that was kept in 16 bits",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.highest_speed = 32_767_000,
};

const DIRECTION_OF_COUNT_FIXED: Fault = Fault {
    name: "direction-of-count-fixed",
    breaks: "CiA 406: object 6000h, code sequence",
    words: "turns the sign of the speed with bit 0 of 6000h, and goes on counting the position as before",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.direction_turns_count = false,
};

const PRESET_WITHOUT_EFFECT: Fault = Fault {
    name: "preset-without-effect",
    breaks: "CiA 406: object 6003h, the position is set to the preset value",
    words: "keeps what is written to 6003h and leaves the position as it is",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.preset = PresetEffect::None,
};

const PRESET_ADDED: Fault = Fault {
    name: "preset-added",
    breaks: "CiA 406: object 6003h, the position is set to the preset value",
    words: "adds the preset value to the position, as if it were an offset",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.preset = PresetEffect::Adds,
};

const PRESET_ONLY_ONCE: Fault = Fault {
    name: "preset-only-once",
    breaks: "CiA 406: object 6003h, the position is set to the preset value",
    words: "does nothing when the preset value that it has already is written again",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.preset = PresetEffect::SetsOnce,
};

const PRESET_MIRRORED: Fault = Fault {
    name: "preset-mirrored",
    breaks: "CiA 406: object 6003h, the position is set to the preset value",
    words: "takes a preset for a position in the other direction while that is turned",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.preset = PresetEffect::SetsMirrored,
};

const PRESET_LOST_AT_RESET: Fault = Fault {
    name: "preset-lost-at-reset",
    breaks: "Liaomiao encoder manual, section 5: 6003h is saved by itself",
    words: "still reads 6003h after a reset, and shows the position as it was without the preset",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.preset_kept = false,
};

const TURNS_NOT_COUNTED: Fault = Fault {
    name: "turns-not-counted",
    breaks: "Liaomiao encoder manual, object 1000h: an encoder of several turns",
    words: "shows the angle within the turn and never counts a turn",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.turns_counted = false,
};

const POSITION_STOPS_AT_THE_END: Fault = Fault {
    name: "position-stops-at-the-end",
    breaks: "CiA 406: object 6002h, the position is counted within the total measuring range",
    words: "stays at its highest or lowest position when the shaft turns on",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.position_wraps = false,
};

const TURNS_UNPOWERED_MISSED: Fault = Fault {
    name: "turns-unpowered-missed",
    breaks: "Liaomiao encoder manual: an absolute encoder",
    words: "has after power-on the position from before, wherever the shaft has turned to",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.turns_unpowered_counted = false,
};

const RESOLUTION_WITHOUT_EFFECT: Fault = Fault {
    name: "resolution-without-effect",
    breaks: "Liaomiao encoder manual, object 2003h: bits within a turn",
    words: "keeps what is written to 2003h and goes on counting 65536 to the turn",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.resolution_obeyed = false,
};

const OPERATING_STATUS_FROZEN: Fault = Fault {
    name: "operating-status-frozen",
    breaks: "CiA 406: object 6500h shows what 6000h has set",
    words: "reads 0 in 6500h whatever was written to 6000h",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.status_follows = false,
};

const CYCLIC_TIMER_WITHOUT_EFFECT: Fault = Fault {
    name: "cyclic-timer-without-effect",
    breaks: "CiA 406: object 6200h is the event timer of TPDO1",
    words: "keeps 6200h and 1800h:05 apart, and sends TPDO1 by the latter alone",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.cyclic_timer_is_event_timer = false,
};

const SETTINGS_FORGOTTEN: Fault = Fault {
    name: "settings-forgotten",
    breaks: "Liaomiao encoder manual, section 5: what is saved when it is written",
    words: "has its default settings again after every reset",
    caught_by: "cia406",
    apply: |behaviour| behaviour.encoder.settings_saved = false,
};

const LIMITS_NOT_CHECKED: Fault = Fault {
    name: "limits-not-checked",
    breaks: "CiA 301: SDO abort codes 06090030h to 06090032h, a value out of range",
    words: "takes and keeps a value that is beyond the range of its object",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.limits_checked = false,
};

/// The faults of what is measured.
pub(super) const FAULTS: &[Fault] = &[
    SPEED_SIGN_LOST,
    SPEED_CLIPPED,
    DIRECTION_OF_COUNT_FIXED,
    PRESET_WITHOUT_EFFECT,
    PRESET_ADDED,
    PRESET_ONLY_ONCE,
    PRESET_MIRRORED,
    PRESET_LOST_AT_RESET,
    TURNS_NOT_COUNTED,
    POSITION_STOPS_AT_THE_END,
    TURNS_UNPOWERED_MISSED,
    RESOLUTION_WITHOUT_EFFECT,
    OPERATING_STATUS_FROZEN,
    CYCLIC_TIMER_WITHOUT_EFFECT,
    SETTINGS_FORGOTTEN,
    LIMITS_NOT_CHECKED,
];
