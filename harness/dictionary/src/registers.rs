//! Modbus register maps: what a device claims to have in its four tables.
//!
//! The file that says so is read elsewhere; here is what it means.

use std::collections::{BTreeMap, BTreeSet};

use crate::Access;

/// The registers, coils and discrete inputs that a device claims to have.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RegisterMap {
    tables: BTreeMap<Table, RegisterTable>,
}

/// One of the four tables of the Modbus data model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Table {
    /// Bits that can be written: functions 01h, 05h, 0Fh.
    Coils,
    /// Bits that can only be read: function 02h.
    DiscreteInputs,
    /// Registers that can be written: functions 03h, 06h, 10h, 16h, 17h.
    Holding,
    /// Registers that can only be read: function 04h.
    Input,
}

impl Table {
    /// Every table.
    pub const ALL: [Table; 4] = [
        Table::Coils,
        Table::DiscreteInputs,
        Table::Holding,
        Table::Input,
    ];

    /// Its name in a file: `holding`.
    pub const fn name(self) -> &'static str {
        match self {
            Table::Coils => "coils",
            Table::DiscreteInputs => "discrete-inputs",
            Table::Holding => "holding",
            Table::Input => "input",
        }
    }

    /// Whether it holds bits.
    pub const fn holds_bits(self) -> bool {
        matches!(self, Table::Coils | Table::DiscreteInputs)
    }

    /// Whether the data model lets it be written.
    pub const fn can_be_written(self) -> bool {
        matches!(self, Table::Coils | Table::Holding)
    }
}

/// One table of a map.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RegisterTable {
    /// What is known of the addresses that nothing is said of.
    pub holes: Holes,
    registers: BTreeMap<u16, Register>,
}

/// What a device does with an address that its map does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Holes {
    /// Reading it gives a value.
    Answered,
    /// It is refused.
    Refused,
    /// The documents do not say.
    #[default]
    Unknown,
}

/// One value of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Register {
    /// The address of its (first) register in the PDU, from 0.
    pub address: u16,
    /// What it is called.
    pub name: String,
    /// How its bits are to be read.
    pub kind: Kind,
    /// What may be done with it: read only, write only, or read and write.
    pub access: Access,
    /// The lowest value, if it is not that of its type.
    pub low: Option<i64>,
    /// The highest value, if it is not that of its type.
    pub high: Option<i64>,
    /// The value after a reset to defaults, if it is known.
    pub default: Option<i64>,
    /// The unit of the scaled value; empty if it has none.
    pub unit: String,
    /// What a count is multiplied with to give the unit.
    pub scale: Option<Scale>,
    /// Which word of a 32-bit value comes first, if it is known.
    pub word_order: Option<WordOrder>,
    /// Whether a value written survives power-off, if it is known.
    pub persists: Option<bool>,
    /// What writing it does; `None` if that is not known.
    pub effects: Option<BTreeSet<WriteEffect>>,
    /// What single values mean.
    pub codes: BTreeMap<i64, String>,
    /// What single bits mean, from bit 0.
    pub bits: BTreeMap<u8, String>,
    /// The line of the file, from 1.
    pub line: u32,
}

/// How the bits of a value are to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// One bit, of a table of bits.
    Bit,
    /// 16 bits.
    U16,
    /// 16 bits in two's complement.
    I16,
    /// 32 bits in two registers.
    U32,
    /// 32 bits in two's complement, in two registers.
    I32,
    /// An IEEE 754 number in two registers; its limits, default and codes are bit patterns.
    F32,
}

impl Kind {
    /// How many addresses it takes.
    pub const fn words(self) -> u16 {
        match self {
            Kind::Bit | Kind::U16 | Kind::I16 => 1,
            Kind::U32 | Kind::I32 | Kind::F32 => 2,
        }
    }

    /// How many bits it has.
    pub const fn bits(self) -> u8 {
        match self {
            Kind::Bit => 1,
            Kind::U16 | Kind::I16 => 16,
            Kind::U32 | Kind::I32 | Kind::F32 => 32,
        }
    }

    /// The lowest value that it can hold.
    pub const fn lowest(self) -> i64 {
        match self {
            Kind::I16 => i16::MIN as i64,
            Kind::I32 => i32::MIN as i64,
            Kind::Bit | Kind::U16 | Kind::U32 | Kind::F32 => 0,
        }
    }

    /// The highest value that it can hold.
    pub const fn highest(self) -> i64 {
        match self {
            Kind::Bit => 1,
            Kind::U16 => u16::MAX as i64,
            Kind::I16 => i16::MAX as i64,
            Kind::I32 => i32::MAX as i64,
            Kind::U32 | Kind::F32 => u32::MAX as i64,
        }
    }

    /// Its name in a file: `u16`.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::Bit => "bit",
            Kind::U16 => "u16",
            Kind::I16 => "i16",
            Kind::U32 => "u32",
            Kind::I32 => "i32",
            Kind::F32 => "f32",
        }
    }
}

/// What counts are multiplied with: `multiply / divide`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    /// Above the line.
    pub multiply: i64,
    /// Below the line; more than 0.
    pub divide: i64,
}

/// The order of the two words of a 32-bit value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WordOrder {
    /// The high word has the lower address.
    HighFirst,
    /// The low word has the lower address.
    LowFirst,
}

/// What writing a register does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum WriteEffect {
    /// It changes its value, and nothing that cannot be put back by writing it again.
    Writes,
    /// It writes non-volatile memory.
    Persists,
    /// It changes the address or the line.
    Readdresses,
    /// Something may move.
    Moves,
    /// The device is reset, or others of its values are.
    Resets,
}

impl Register {
    /// The addresses it takes.
    pub fn addresses(&self) -> std::ops::RangeInclusive<u16> {
        self.address..=self.address.saturating_add(self.kind.words() - 1)
    }

    /// The lowest value it may have.
    pub fn lowest(&self) -> i64 {
        self.low.unwrap_or(self.kind.lowest())
    }

    /// The highest value it may have.
    pub fn highest(&self) -> i64 {
        self.high.unwrap_or(self.kind.highest())
    }
}

impl RegisterTable {
    /// A table without values.
    pub fn new(holes: Holes) -> RegisterTable {
        RegisterTable {
            holes,
            registers: BTreeMap::new(),
        }
    }

    /// Adds a value.
    ///
    /// # Errors
    /// The value that has one of its addresses already.
    pub fn insert(&mut self, register: Register) -> Result<(), Box<Register>> {
        match self.in_the_way(&register) {
            Some(other) => Err(Box::new(other.clone())),
            None => {
                self.registers.insert(register.address, register);
                Ok(())
            }
        }
    }

    fn in_the_way(&self, register: &Register) -> Option<&Register> {
        register
            .addresses()
            .find_map(|address| self.containing(address))
    }

    /// The value that starts at `address`.
    pub fn register(&self, address: u16) -> Option<&Register> {
        self.registers.get(&address)
    }

    /// The value that `address` belongs to: its only register, or one of two.
    pub fn containing(&self, address: u16) -> Option<&Register> {
        let (_, register) = self.registers.range(..=address).next_back()?;
        register.addresses().contains(&address).then_some(register)
    }

    /// Every value, in address order.
    pub fn registers(&self) -> impl Iterator<Item = &Register> {
        self.registers.values()
    }

    /// The addresses beside the values of the table that belong to none, in order: after each value or row of values
    /// one, and the one before the first.
    pub fn holes_beside(&self) -> BTreeSet<u16> {
        let before = self.registers.keys().map(|start| start.checked_sub(1));
        let after = self.registers.values();
        let after = after.map(|register| register.addresses().end().checked_add(1));
        before
            .chain(after)
            .flatten()
            .filter(|address| self.containing(*address).is_none())
            .collect()
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.registers.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.registers.is_empty()
    }
}

impl RegisterMap {
    /// Gives the map a table, in the place of the one it had.
    pub fn set_table(&mut self, table: Table, values: RegisterTable) {
        self.tables.insert(table, values);
    }

    /// A table, if the device has it.
    pub fn table(&self, table: Table) -> Option<&RegisterTable> {
        self.tables.get(&table)
    }

    /// The tables that the device has.
    pub fn tables(&self) -> impl Iterator<Item = (Table, &RegisterTable)> {
        self.tables.iter().map(|(table, values)| (*table, values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn register(address: u16, kind: Kind) -> Register {
        Register {
            address,
            name: "a".to_owned(),
            kind,
            access: Access::ReadWrite,
            low: None,
            high: Some(10),
            default: None,
            unit: String::new(),
            scale: None,
            word_order: None,
            persists: None,
            effects: None,
            codes: BTreeMap::new(),
            bits: BTreeMap::new(),
            line: 1,
        }
    }

    #[test]
    fn a_value_has_its_addresses_for_itself() {
        let mut table = RegisterTable::default();
        table.insert(register(6, Kind::U32)).unwrap();
        for (address, kind) in [
            (5, Kind::I32),
            (6, Kind::U16),
            (7, Kind::U16),
            (7, Kind::F32),
        ] {
            let in_the_way = table.insert(register(address, kind)).unwrap_err();
            assert_eq!(in_the_way.address, 6, "{address} {kind:?}");
        }
        table.insert(register(8, Kind::U16)).unwrap();
        assert_eq!(table.len(), 2);
        assert_eq!(table.containing(7).unwrap().address, 6);
        assert!(table.register(7).is_none() && table.containing(9).is_none());
    }

    #[test]
    fn limits_are_those_of_the_type_where_none_are_given() {
        let one = register(1, Kind::I16);
        assert_eq!((one.lowest(), one.highest()), (-32_768, 10));
        assert_eq!(Kind::U32.highest(), 4_294_967_295);
        assert_eq!(Kind::Bit.highest(), 1);
    }

    #[test]
    fn holes_lie_beside_values() {
        let mut table = RegisterTable::default();
        for (address, kind) in [
            (0, Kind::U16),
            (1, Kind::U32),
            (5, Kind::U16),
            (0xFFFF, Kind::U16),
        ] {
            table.insert(register(address, kind)).unwrap();
        }
        assert_eq!(table.holes_beside(), BTreeSet::from([3, 4, 6, 0xFFFE]));
        assert!(RegisterTable::default().holes_beside().is_empty());
    }
}
