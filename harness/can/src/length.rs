//! How many bits a frame takes on the bus.
//!
//! | field | base format | extended format | stuffed |
//! | --- | --- | --- | --- |
//! | start of frame | 1 | 1 | yes |
//! | identifier, RTR (SRR), IDE | 13 | 13 | yes |
//! | identifier extension, RTR, r1 | | 20 | yes |
//! | r0, data length code | 5 | 5 | yes |
//! | data | 8 a byte | 8 a byte | yes |
//! | CRC sequence | 15 | 15 | yes |
//! | CRC delimiter, acknowledge slot and delimiter, end of frame | 10 | 10 | no |
//!
//! After five equal bits in the stuffed part the sender adds one of the other level, which itself counts as the first
//! of the next run. The simulated bus asks for the length of every frame, so both the CRC and the stuff bits are taken
//! a byte at a time from tables.

use crate::{Frame, Id};

/// Bits between two frames that belong to neither.
pub const INTERMISSION_BITS: u32 = 3;

const CRC_BITS: u32 = 15;
const CRC_POLYNOMIAL: u16 = 0x4599;
const UNSTUFFED_TAIL_BITS: u32 = 10;
const BASE_HEADER_BITS: u32 = 19;
const EXTENDED_HEADER_BITS: u32 = 39;

impl Frame {
    /// The bits from start of frame to end of frame, stuff bits included. [`INTERMISSION_BITS`] come on top.
    pub fn bits(&self) -> u32 {
        self.bits_unstuffed() + self.stuff_bits()
    }

    /// The same without stuff bits.
    pub fn bits_unstuffed(&self) -> u32 {
        self.stuffed_part_bits() + UNSTUFFED_TAIL_BITS
    }

    /// The same with as many stuff bits as a frame of this format and length can have at most.
    pub fn bits_worst_case(&self) -> u32 {
        // At worst the first five bits are equal, and then every four with the stuff bit before them.
        self.bits_unstuffed() + (self.stuffed_part_bits() - 1) / 4
    }

    /// The CRC sequence, 15 bits.
    pub fn crc15(&self) -> u16 {
        let (header, _) = self.header();
        // Leading zeros change nothing in this CRC, so the header is taken as whole bytes.
        let header = header.to_be_bytes();
        crc15(&header[self.header_start()..], self.bytes())
    }

    /// Where in 8 bytes a right-aligned header begins.
    fn header_start(&self) -> usize {
        if self.id().is_extended() { 3 } else { 5 }
    }

    fn stuffed_part_bits(&self) -> u32 {
        self.header().1 + 8 * self.bytes().len() as u32 + CRC_BITS
    }

    /// Start of frame to data length code, right-aligned, and how many bits that is.
    fn header(&self) -> (u64, u32) {
        let remote = u64::from(self.is_remote());
        let length = self.len() as u64;
        match self.id() {
            Id::Standard(id) => {
                let header = u64::from(id.raw()) << 7 | remote << 6 | length;
                (header, BASE_HEADER_BITS)
            }
            Id::Extended(id) => {
                let base = u64::from(id.raw() >> 18);
                let extension = u64::from(id.raw() & 0x3_FFFF);
                let substitute_and_ide = 0b11 << 25;
                let header =
                    base << 27 | substitute_and_ide | extension << 7 | remote << 6 | length;
                (header, EXTENDED_HEADER_BITS)
            }
        }
    }

    fn stuff_bits(&self) -> u32 {
        let (header, bits) = self.header();
        // Filled up to whole bytes in front with alternating bits of which the last is recessive: the start of frame
        // then begins a run, and nothing is stuffed before it.
        let filled = (header | 0x5555_5555_5555_5555 << bits).to_be_bytes();
        // Filled up behind with the opposite of the last bit, which can never be the fifth of a run.
        let crc = self.crc15();
        let crc = (crc << 1 | (!crc & 1)).to_be_bytes();
        let mut counter = StuffCounter::START;
        counter.take(&filled[self.header_start()..]);
        counter.take(self.bytes());
        counter.take(&crc);
        counter.stuffed
    }
}

/// The CRC of `header` and `data` together, 13 bytes at most. It is the sum of what each byte alone would give in its
/// place, so that no look-up waits for another.
fn crc15(header: &[u8], data: &[u8]) -> u16 {
    let sum = |bytes: &[u8], after: usize| {
        let tables = CRC_TABLES[after..].iter();
        let bytes = bytes.iter().rev().zip(tables);
        bytes.fold(0, |crc, (byte, table)| crc ^ table[usize::from(*byte)])
    };
    sum(header, data.len()) ^ sum(data, 0)
}

/// A header of 5 bytes and 8 bytes of data.
const LONGEST: usize = 13;

/// By the number of bytes after it and its value: the CRC of a byte.
static CRC_TABLES: [[u16; 256]; LONGEST] = crc_tables();

const fn crc_tables() -> [[u16; 256]; LONGEST] {
    let mut tables = [[0; 256]; LONGEST];
    let mut after = 0;
    while after < LONGEST {
        let mut byte = 0;
        while byte < 256 {
            let mut crc = if after == 0 {
                (byte as u16) << 7
            } else {
                tables[after - 1][byte]
            };
            let mut bit = 0;
            while bit < 8 {
                let carry = crc & 0x4000 != 0;
                crc = crc << 1 & 0x7FFF;
                if carry {
                    crc ^= CRC_POLYNOMIAL;
                }
                bit += 1;
            }
            tables[after][byte] = crc;
            byte += 1;
        }
        after += 1;
    }
    tables
}

/// Counts stuff bits. Its state is the level of the last bit on the bus and the length of the run that it ends, `1..=4`
/// (the fifth is followed at once by a stuff bit, which begins a run): bit 2 and bits 1..0, both in bits 10..8 of
/// `state`, ready for [`STUFF_TABLE`].
struct StuffCounter {
    state: u16,
    stuffed: u32,
}

impl StuffCounter {
    /// A run of one dominant bit.
    const START: StuffCounter = StuffCounter {
        state: 0,
        stuffed: 0,
    };

    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let entry = STUFF_TABLE[usize::from(self.state & 0x700 | u16::from(*byte))];
            self.state = entry;
            self.stuffed += u32::from(entry & 0xFF);
        }
    }
}

/// By state (bits 10..8) and byte: the next state in bits 10..8, the number of stuff bits in bits 7..0.
static STUFF_TABLE: [u16; 8 * 256] = stuff_table();

const fn stuff_table() -> [u16; 8 * 256] {
    let mut table = [0; 8 * 256];
    let mut index = 0;
    while index < table.len() {
        table[index] = stuff_entry((index >> 8) as u16, index as u8);
        index += 1;
    }
    table
}

const fn stuff_entry(state: u16, byte: u8) -> u16 {
    let mut level = state >> 2;
    let mut run = (state & 3) + 1;
    let mut stuffed = 0;
    let mut shift = 8;
    while shift > 0 {
        shift -= 1;
        let bit = (byte >> shift & 1) as u16;
        run = if bit == level { run + 1 } else { 1 };
        level = bit;
        if run == 5 {
            stuffed += 1;
            level = 1 - level;
            run = 1;
        }
    }
    (level << 2 | (run - 1)) << 8 | stuffed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::any_frame;
    use proptest::prelude::*;

    fn frame(text: &str) -> Frame {
        text.parse().unwrap()
    }

    fn push(bits: &mut Vec<bool>, value: u32, count: u32) {
        for shift in (0..count).rev() {
            bits.push(value >> shift & 1 == 1);
        }
    }

    /// Start of frame to data, field by field.
    fn naive_fields(frame: &Frame) -> Vec<bool> {
        let mut bits = vec![false];
        match frame.id() {
            Id::Standard(id) => {
                push(&mut bits, u32::from(id.raw()), 11);
                bits.extend([frame.is_remote(), false, false]);
            }
            Id::Extended(id) => {
                push(&mut bits, id.raw() >> 18, 11);
                bits.extend([true, true]);
                push(&mut bits, id.raw(), 18);
                bits.extend([frame.is_remote(), false, false]);
            }
        }
        push(&mut bits, frame.len() as u32, 4);
        for byte in frame.bytes() {
            push(&mut bits, u32::from(*byte), 8);
        }
        bits
    }

    fn naive_crc(bits: &[bool]) -> u16 {
        let mut crc = 0;
        for bit in bits {
            let carry = *bit != (crc & 0x4000 != 0);
            crc = crc << 1 & 0x7FFF;
            if carry {
                crc ^= CRC_POLYNOMIAL;
            }
        }
        crc
    }

    fn naive_bits(frame: &Frame) -> u32 {
        let mut plain = naive_fields(frame);
        let crc = naive_crc(&plain);
        push(&mut plain, u32::from(crc), 15);
        let mut on_bus: Vec<bool> = Vec::new();
        for bit in plain {
            on_bus.push(bit);
            if run(&on_bus) == 5 {
                on_bus.push(!bit);
            }
        }
        on_bus.len() as u32 + 10
    }

    fn run(bits: &[bool]) -> usize {
        let last = bits.last();
        bits.iter()
            .rev()
            .take_while(|bit| Some(*bit) == last)
            .count()
    }

    #[test]
    fn crc15_has_its_published_check_value() {
        // CRC-15/CAN in the catalogue of parametrised CRC algorithms: check 059E.
        assert_eq!(crc15(b"1234", b"56789"), 0x059E);
    }

    #[test]
    fn lengths_without_stuff_bits_and_at_worst() {
        // Text books: 44 + 8n and 64 + 8n bits; at worst one stuff bit more for every four of the 34 + 8n (54 + 8n)
        // after the first. With the intermission 47, 111, 67 and 131; 55, 135, 80 and 160.
        let cases = [
            ("000#", 44, 52),
            ("000#0000000000000000", 108, 132),
            ("00000000#", 64, 77),
            ("00000000#0000000000000000", 128, 157),
            ("000#R8", 44, 52),
        ];
        for (text, unstuffed, worst) in cases {
            assert_eq!(frame(text).bits_unstuffed(), unstuffed, "{text}");
            assert_eq!(frame(text).bits_worst_case(), worst, "{text}");
        }
    }

    #[test]
    fn stuff_bits_counted_by_hand() {
        let header = naive_fields(&frame("000#"));
        assert_eq!(header, [false; 19]);
        assert_eq!(naive_crc(&header), 0);
        // With the CRC 34 zeros: a stuff bit after every five, six in all, and four zeros left over.
        assert_eq!(frame("000#").bits(), 44 + 6);
        assert_eq!(frame("000#").crc15(), 0);
    }

    proptest! {
        #[test]
        fn tables_and_bit_by_bit_agree(frame in any_frame()) {
            prop_assert_eq!(frame.crc15(), naive_crc(&naive_fields(&frame)));
            prop_assert_eq!(frame.bits(), naive_bits(&frame));
        }

        #[test]
        fn long_runs_agree_too(
            id in prop_oneof![Just(0u16), Just(0x7FF), Just(0x01F), 0..=0x7FFu16],
            data in proptest::collection::vec(
                prop_oneof![Just(0u8), Just(0xFF), Just(0x1F), Just(0xF8), Just(0x0F), Just(0x87)], 0..=8),
        ) {
            let frame = Frame::data(crate::StandardId::new(id).unwrap(), &data).unwrap();
            prop_assert_eq!(frame.bits(), naive_bits(&frame));
        }

        #[test]
        fn exact_lies_between_unstuffed_and_worst(frame in any_frame()) {
            prop_assert!(frame.bits_unstuffed() <= frame.bits());
            prop_assert!(frame.bits() <= frame.bits_worst_case());
        }
    }
}
