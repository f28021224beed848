//! NMT and error control, and each of their faults.

use super::KIND;
use crate::script::{conforms, departs, departures, assert_same, Script};
use crate::Settings;

/// Every command in every state, told by the heartbeat.
const COMMANDS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B17100014000000
    < 58A#6017100000000000
    > 000#800A
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    wait 18 ms
    < 70A#05
    > 000#01
    > 000#010A00
    > 000#020B
    > 000#020A
    wait 18 ms
    < 70A#04
    > 000#0100
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    > 000#8000
    wait 16 ms
    < 70A#7F
    > 000#0200
    > 000#800A
    > 000#810A
    wait 6 ms
    < 70A#00
    > 000#820A
    wait 6 ms
    < 70A#00
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    > 000#820A
    wait 6 ms
    < 70A#00
    > 000#020A
    > 000#810A
    wait 6 ms
    < 70A#00
";
