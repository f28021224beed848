//! PDO: the communication and mapping parameters, and the data they describe.

use std::fmt;

use fieldproof_can::Id;

use super::Multiplexer;
use super::identifier_entry::RawIdentifierEntry;
use crate::{Rule, Violation};

/// The value of sub-index 01h of 1400h.. and 1800h..: which identifier a PDO has.
///
/// | bits | content |
/// | --- | --- |
/// | 31 | 1: the PDO does not exist |
/// | 30 | 1: no remote frames |
/// | 29 | 1: 29-bit identifier |
/// | 28..0 | identifier |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PdoIdentifier {
    /// Whether the PDO exists.
    pub valid: bool,
    /// Whether it may be asked for with a remote frame.
    pub rtr_allowed: bool,
    /// The identifier.
    pub id: Id,
}

impl PdoIdentifier {
    /// The value.
    pub fn encode(&self) -> u32 {
        RawIdentifierEntry::new(!self.valid, !self.rtr_allowed, self.id).0
    }

    /// Reads the value.
    ///
    /// # Errors
    /// [`Violation`]: bits above an 11-bit identifier.
    pub fn parse(value: u32) -> Result<PdoIdentifier, Violation> {
        let raw = RawIdentifierEntry(value);
        Ok(PdoIdentifier {
            valid: !raw.bit_31(),
            rtr_allowed: !raw.bit_30(),
            id: raw.id()?,
        })
    }
}

bounded! {
    /// Every how many SYNCs a PDO is sent, `1..=240`.
    pub struct SyncCount(u8) in 1..=240
}

/// The value of sub-index 02h of 1400h.. and 1800h..: when a PDO is sent, or taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TransmissionType {
    /// 0: with the next SYNC after an event.
    SynchronousAcyclic,
    /// 1 to 240: with every n-th SYNC.
    SynchronousCyclic(SyncCount),
    /// 241 to 251
    Reserved(u8),
    /// 252: sampled with SYNC, sent when asked for with a remote frame.
    SynchronousOnRequest,
    /// 253: sampled and sent when asked for with a remote frame.
    EventDrivenOnRequest,
    /// 254: on an event of the manufacturer's.
    EventDrivenByManufacturer,
    /// 255: on an event of the device profile's.
    EventDrivenByProfile,
}

impl TransmissionType {
    /// The value.
    pub const fn code(self) -> u8 {
        match self {
            TransmissionType::SynchronousAcyclic => 0,
            TransmissionType::SynchronousCyclic(count) => count.raw(),
            TransmissionType::Reserved(code) => code,
            TransmissionType::SynchronousOnRequest => 252,
            TransmissionType::EventDrivenOnRequest => 253,
            TransmissionType::EventDrivenByManufacturer => 254,
            TransmissionType::EventDrivenByProfile => 255,
        }
    }

    /// What the value means.
    pub const fn from_code(code: u8) -> TransmissionType {
        if let Some(count) = SyncCount::new(code) {
            return TransmissionType::SynchronousCyclic(count);
        }
        match code {
            0 => TransmissionType::SynchronousAcyclic,
            252 => TransmissionType::SynchronousOnRequest,
            253 => TransmissionType::EventDrivenOnRequest,
            254 => TransmissionType::EventDrivenByManufacturer,
            255 => TransmissionType::EventDrivenByProfile,
            code => TransmissionType::Reserved(code),
        }
    }

    /// Whether SYNC has a part in it.
    pub const fn is_synchronous(self) -> bool {
        matches!(
            self,
            TransmissionType::SynchronousAcyclic
                | TransmissionType::SynchronousCyclic(_)
                | TransmissionType::SynchronousOnRequest
        )
    }
}

impl fmt::Display for TransmissionType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TransmissionType::SynchronousAcyclic => {
                write!(f, "with the next SYNC after an event")
            }
            TransmissionType::SynchronousCyclic(count) if count.raw() == 1 => {
                write!(f, "with every SYNC")
            }
            TransmissionType::SynchronousCyclic(count) => {
                write!(f, "with one SYNC in {}", count.raw())
            }
            TransmissionType::Reserved(code) => write!(f, "reserved {code}"),
            TransmissionType::SynchronousOnRequest => {
                write!(f, "sampled with SYNC, sent on a remote frame")
            }
            TransmissionType::EventDrivenOnRequest => {
                write!(f, "sampled and sent on a remote frame")
            }
            TransmissionType::EventDrivenByManufacturer => {
                write!(f, "on an event of the manufacturer's")
            }
            TransmissionType::EventDrivenByProfile => {
                write!(f, "on an event of the device profile's")
            }
        }
    }
}

bounded! {
    /// How many bits of an object are mapped, `1..=64`.
    pub struct MappedBits(u8) in 1..=64
}

/// The value of a sub-index of 1600h.. and 1A00h..: an object in a PDO.
///
/// | bits | content |
/// | --- | --- |
/// | 31..16 | index |
/// | 15..8 | sub-index |
/// | 7..0 | length in bits |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MappingEntry {
    /// The object.
    pub object: Multiplexer,
    /// How many bits it takes.
    pub bits: MappedBits,
}

impl MappingEntry {
    /// The value.
    pub fn encode(&self) -> u32 {
        u32::from(self.object.index) << 16
            | u32::from(self.object.sub) << 8
            | u32::from(self.bits.raw())
    }

    /// Reads the value.
    ///
    /// # Errors
    /// [`Violation`]: a length outside `1..=64`. Its offset counts the bytes of the value, low byte first.
    pub fn parse(value: u32) -> Result<MappingEntry, Violation> {
        let [bits, sub, index_low, index_high] = value.to_le_bytes();
        Ok(MappingEntry {
            object: Multiplexer::new(u16::from_le_bytes([index_low, index_high]), sub),
            bits: MappedBits::parse(bits, 0)?,
        })
    }
}

impl fmt::Display for MappingEntry {
    /// `6041h:00, 16 bits`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} bits", self.object, self.bits.raw())
    }
}

/// The objects in a PDO, in order: at most 64 bits.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Mapping(Vec<MappingEntry>);

impl Mapping {
    /// These objects; `None` if they take more than 64 bits.
    pub fn new(entries: Vec<MappingEntry>) -> Option<Mapping> {
        let mapping = Mapping(entries);
        (mapping.bits() <= 64).then_some(mapping)
    }

    /// These objects as the dictionary holds them.
    ///
    /// # Errors
    /// [`Violation`]: a value that is no entry, or more than 64 bits. Its offset counts the bytes of all values.
    pub fn parse(values: &[u32]) -> Result<Mapping, Violation> {
        let mut entries = Vec::with_capacity(values.len());
        for (position, value) in values.iter().enumerate() {
            let entry = MappingEntry::parse(*value).map_err(|violation| Violation {
                offset: violation.offset + 4 * position,
                ..violation
            })?;
            entries.push(entry);
        }
        let mapping = Mapping(entries);
        match mapping.bits() {
            ..=64 => Ok(mapping),
            bits => Err(Violation::new(
                Rule::Length,
                4 * values.len(),
                format!("{bits} bits"),
                "at most 64 bits",
            )),
        }
    }

    /// The objects.
    pub fn entries(&self) -> &[MappingEntry] {
        &self.0
    }

    /// How many bits they take.
    pub fn bits(&self) -> u32 {
        self.0.iter().map(|entry| u32::from(entry.bits.raw())).sum()
    }

    /// The length of the PDO in bytes, `0..=8`.
    pub fn bytes(&self) -> usize {
        self.bits().div_ceil(8) as usize
    }

    /// The raw value of every object in `data`: the first object has the lowest bits. What follows the last object is
    /// passed over.
    ///
    /// # Errors
    /// [`Violation`]: fewer bytes than mapped, or more than 8.
    pub fn unpack(&self, data: &[u8]) -> Result<Vec<(Multiplexer, u64)>, Violation> {
        if !(self.bytes()..=8).contains(&data.len()) {
            return Err(Violation::length(data.len(), self.bytes()));
        }
        let mut bytes = [0; 8];
        bytes[..data.len()].copy_from_slice(data);
        let all = u64::from_le_bytes(bytes);
        let mut at = 0;
        let values = self.0.iter().map(|entry| {
            let bits = u32::from(entry.bits.raw());
            let value = all >> at & (u64::MAX >> (64 - bits));
            at += bits;
            (entry.object, value)
        });
        Ok(values.collect())
    }

    /// The data of a PDO with these raw values, one for each object; bits beyond an object's length are left out.
    /// `None` if there are more or fewer values than objects.
    pub fn pack(&self, values: &[u64]) -> Option<Vec<u8>> {
        if values.len() != self.0.len() {
            return None;
        }
        let mut all = 0;
        let mut at = 0;
        for (entry, value) in self.0.iter().zip(values) {
            let bits = u32::from(entry.bits.raw());
            all |= (value & (u64::MAX >> (64 - bits))) << at;
            at += bits;
        }
        Some(all.to_le_bytes()[..self.bytes()].to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn identifier_entries_are_these_values() {
        let id = Id::standard(0x182).unwrap();
        let cases = [
            (0x0000_0182, true, true, id),
            (0x8000_0182, false, true, id),
            (0x4000_0182, true, false, id),
            (0x6000_0182, true, false, Id::extended(0x182).unwrap()),
        ];
        for (value, valid, rtr_allowed, id) in cases {
            let entry = PdoIdentifier {
                valid,
                rtr_allowed,
                id,
            };
            assert_eq!(PdoIdentifier::parse(value), Ok(entry), "{value:08X}");
            assert_eq!(entry.encode(), value);
        }
        assert_eq!(
            PdoIdentifier::parse(0x0000_1182).unwrap_err().to_string(),
            "range: found 00001182h in a value for 11-bit identifiers at byte 0, expected at most 7FFh, or bit 29 set"
        );
    }

    #[test]
    fn transmission_types_keep_their_value() {
        for code in 0..=255 {
            assert_eq!(TransmissionType::from_code(code).code(), code);
        }
        assert_eq!(
            TransmissionType::from_code(17).to_string(),
            "with one SYNC in 17"
        );
        assert_eq!(
            TransmissionType::from_code(241),
            TransmissionType::Reserved(241)
        );
        assert!(!TransmissionType::from_code(254).is_synchronous());
        assert!(TransmissionType::from_code(240).is_synchronous());
    }

    #[test]
    fn mapping_entries_are_these_values() {
        let entry = MappingEntry::parse(0x6041_0010).unwrap();
        assert_eq!(entry.to_string(), "6041h:00, 16 bits");
        assert_eq!(entry.encode(), 0x6041_0010);
        for value in [0x6041_0000, 0x6041_0041] {
            assert!(MappingEntry::parse(value).is_err());
        }
    }

    #[test]
    fn a_mapping_says_what_the_data_is() {
        let mapping = Mapping::parse(&[0x6063_0020, 0x6041_0010]).unwrap();
        assert_eq!(mapping.bytes(), 6);
        let data = [0x13, 0xD1, 0xFF, 0xFF, 0x31, 0x02];
        let position = Multiplexer::new(0x6063, 0);
        let status = Multiplexer::new(0x6041, 0);
        assert_eq!(
            mapping.unpack(&data),
            Ok(vec![(position, 0xFFFF_D113), (status, 0x0231)])
        );
        assert_eq!(mapping.pack(&[0xFFFF_D113, 0x0231]), Some(data.to_vec()));
        assert_eq!(mapping.pack(&[0]), None);
        assert_eq!(
            mapping.unpack(&data[..5]).unwrap_err().to_string(),
            "length: found 5 bytes, expected 6 bytes"
        );
    }

    #[test]
    fn a_mapping_has_at_most_64_bits() {
        let long = [0x6063_0020, 0x6063_0020, 0x6041_0010];
        assert_eq!(
            Mapping::parse(&long).unwrap_err().to_string(),
            "length: found 80 bits, expected at most 64 bits"
        );
        assert_eq!(
            Mapping::parse(&[0x6063_0020, 0]).unwrap_err().to_string(),
            "range: found 0 at byte 4, expected 1 to 64"
        );
    }

    fn any_mapping() -> impl Strategy<Value = Mapping> {
        proptest::collection::vec(1..=64u8, 0..=8).prop_map(|lengths| {
            let mut entries = Vec::new();
            let mut left = 64;
            for bits in lengths {
                if bits <= left {
                    left -= bits;
                    entries.push(MappingEntry {
                        object: Multiplexer::new(0x2000, bits),
                        bits: MappedBits::new(bits).unwrap(),
                    });
                }
            }
            Mapping::new(entries).unwrap()
        })
    }

    proptest! {
        #[test]
        fn what_is_unpacked_is_packed_again(mapping in any_mapping(), data: [u8; 8]) {
            let values: Vec<u64> = mapping.unpack(&data).unwrap().into_iter().map(|(_, value)| value).collect();
            let packed = mapping.pack(&values).unwrap();
            let whole = (mapping.bits() / 8) as usize;
            prop_assert_eq!(&packed[..whole], &data[..whole]);
            let again = mapping.unpack(&packed).unwrap();
            prop_assert!(again.into_iter().map(|(_, value)| value).eq(values));
        }

        #[test]
        fn any_value_is_an_entry_or_refused(value: u32) {
            if let Ok(entry) = MappingEntry::parse(value) {
                prop_assert_eq!(entry.encode(), value);
            }
            if let Ok(entry) = PdoIdentifier::parse(value) {
                prop_assert_eq!(entry.encode(), value);
            }
        }
    }
}
