//! What the encoder measures, and what its two ports share of how it shows that.

use super::{Behaviour, PresetEffect};

/// The shaft as the encoder sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct EncoderModel {
    /// The position shown, in counts: turns above, the angle in the low [`EncoderModel::single_turn_bits`] bits.
    pub(crate) position: u32,
    /// The speed of the shaft in 1/10000 rpm, positive clockwise.
    pub(crate) speed_ten_thousandths_rpm: i32,
    /// The temperature inside in 1/100 °C.
    pub(crate) temperature_hundredths: i16,
    /// Bits of the position that count within a turn, 8 to 16.
    pub(crate) single_turn_bits: u8,
    /// Whether turning counter-clockwise counts up.
    pub(crate) counter_clockwise: bool,
    /// The preset value that was written last.
    pub(crate) preset: u32,
    /// By how much presets have moved the position.
    pub(crate) preset_by: u32,
}

impl Default for EncoderModel {
    /// At rest at zero, at 25 °C, as the encoder leaves the factory.
    fn default() -> EncoderModel {
        EncoderModel {
            position: 0,
            speed_ten_thousandths_rpm: 0,
            temperature_hundredths: 2_500,
            single_turn_bits: 16,
            counter_clockwise: false,
            preset: 0,
            preset_by: 0,
        }
    }
}

impl EncoderModel {
    /// The speed as both ports show it, in 1/10000 rpm: negative while the position counts down.
    pub(crate) fn shown_speed(&self) -> i32 {
        if self.counter_clockwise {
            self.speed_ten_thousandths_rpm.saturating_neg()
        } else {
            self.speed_ten_thousandths_rpm
        }
    }

    /// Turns the shaft so that `speed`, in 1/10000 rpm, is shown.
    pub(crate) fn set_shown_speed(&mut self, speed: i32) {
        self.speed_ten_thousandths_rpm = speed;
        self.speed_ten_thousandths_rpm = self.shown_speed();
    }

    /// The shaft turns by `counts` of 1/65536 turn, clockwise where they are positive.
    pub(crate) fn turn(&mut self, counts: i32, behaviour: &Behaviour) {
        let counts = counts >> self.coarseness();
        let reversed = self.counter_clockwise && behaviour.direction_turns_count;
        let counts = if reversed {
            counts.saturating_neg()
        } else {
            counts
        };
        let turned = if behaviour.position_wraps {
            self.position.wrapping_add_signed(counts)
        } else {
            self.position.saturating_add_signed(counts)
        };
        self.position = if behaviour.turns_counted {
            turned
        } else {
            let angle = u32::MAX >> (32 - u32::from(self.split()));
            self.position & !angle | turned & angle
        };
    }

    /// A preset value is written.
    pub(crate) fn set_preset(&mut self, value: u32, effect: PresetEffect) {
        let position = match effect {
            PresetEffect::SetsOnce if self.preset == value => self.position,
            PresetEffect::Sets | PresetEffect::SetsOnce => value,
            PresetEffect::None => self.position,
            PresetEffect::Adds => self.position.wrapping_add(value),
            PresetEffect::SetsMirrored if self.counter_clockwise => value.wrapping_neg(),
            PresetEffect::SetsMirrored => value,
        };
        let by = position.wrapping_sub(self.position);
        self.preset = value;
        self.preset_by = self.preset_by.wrapping_add(by);
        self.position = position;
    }

    /// The position is as it was without any preset.
    pub(crate) fn forget_preset(&mut self) {
        self.position = self.position.wrapping_sub(self.preset_by);
        self.preset_by = 0;
    }

    /// Sets whether turning counter-clockwise counts up.
    pub(crate) fn set_direction(&mut self, counter_clockwise: bool, behaviour: &Behaviour) {
        let changes = self.counter_clockwise != counter_clockwise;
        if changes && behaviour.position_jumps_with_direction {
            self.position = self.position.wrapping_neg();
        }
        self.counter_clockwise = counter_clockwise;
    }

    /// The angle within the turn in 1/65536 of it.
    pub(crate) fn angle(&self) -> u16 {
        let [_, _, high, low] = (self.position << self.coarseness()).to_be_bytes();
        u16::from_be_bytes([high, low])
    }

    /// Makes the present angle `angle`, in 1/65536 turn, and keeps the turns.
    pub(crate) fn set_angle(&mut self, angle: u16) {
        let bits = self.split();
        let turns = self.position >> bits;
        self.position = (turns << bits) | (u32::from(angle) >> self.coarseness());
    }

    /// Splits the 32 bits of the position another way: `bits` (8 to 16) for the angle. The turns stay as far as there is
    /// room for them, the angle as far as it can be told.
    pub(crate) fn set_single_turn_bits(&mut self, bits: u8) {
        let turns = self.position >> self.split();
        let angle = self.angle();
        self.single_turn_bits = bits;
        self.single_turn_bits = self.split();
        self.position = turns << self.split();
        self.set_angle(angle);
    }

    /// By how many bits the angle is coarser than 1/65536 turn.
    fn coarseness(&self) -> u8 {
        16 - self.split()
    }

    /// The bits of the angle; what the encoder cannot have counts as the nearest it can.
    fn split(&self) -> u8 {
        self.single_turn_bits.clamp(8, 16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_is_the_fraction_of_a_turn_whatever_the_split() {
        let mut model = EncoderModel {
            position: 0x08D0_100B,
            ..EncoderModel::default()
        };
        assert_eq!(model.angle(), 0x100B);
        model.set_single_turn_bits(8);
        assert_eq!(model.position, 0x0008_D010);
        assert_eq!(model.angle(), 0x1000);
        model.set_angle(0x8000);
        assert_eq!(model.position, 0x0008_D080);
        model.set_single_turn_bits(16);
        assert_eq!(model.position, 0x08D0_8000);
    }

    #[test]
    fn direction_turns_the_sign_of_the_speed_shown() {
        let mut model = EncoderModel::default();
        model.set_shown_speed(-120_000);
        assert_eq!(model.shown_speed(), -120_000);
        model.counter_clockwise = true;
        assert_eq!(model.shown_speed(), 120_000);
        model.set_shown_speed(-5);
        assert_eq!(model.shown_speed(), -5);
    }

    #[test]
    fn a_turn_counts_by_split_and_direction_and_goes_round() {
        let right = Behaviour::default();
        let mut model = EncoderModel::default();
        model.turn(-65_536, &right);
        assert_eq!(model.position, 0xFFFF_0000);
        model.turn(3 * 65_536 + 1, &right);
        assert_eq!(model.position, 0x0002_0001);
        model.set_single_turn_bits(12);
        model.turn(65_536, &right);
        assert_eq!(model.position, 0x0000_3000);
        model.set_direction(true, &right);
        assert_eq!(model.position, 0x0000_3000);
        model.turn(32_768, &right);
        assert_eq!(model.position, 0x0000_2800);
    }

    #[test]
    fn a_preset_is_remembered_as_what_it_moved() {
        let mut model = EncoderModel {
            position: 70,
            ..EncoderModel::default()
        };
        model.set_preset(500, PresetEffect::Sets);
        model.turn(5, &Behaviour::default());
        model.set_preset(100, PresetEffect::Sets);
        assert_eq!((model.position, model.preset_by), (100, 25));
        model.forget_preset();
        assert_eq!((model.position, model.preset_by), (75, 0));
    }

    #[test]
    fn every_public_field_value_is_survived() {
        for single_turn_bits in [0, 7, 17, 255] {
            let mut model = EncoderModel {
                position: u32::MAX,
                single_turn_bits,
                ..EncoderModel::default()
            };
            model.set_angle(model.angle());
            let behaviour = Behaviour {
                turns_counted: false,
                ..Behaviour::default()
            };
            model.turn(i32::MIN, &behaviour);
            model.turn(i32::MAX, &Behaviour::default());
            model.set_single_turn_bits(0);
            assert_eq!(model.single_turn_bits, 8);
        }
    }
}
