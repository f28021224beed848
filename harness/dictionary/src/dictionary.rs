//! The object dictionary.

use std::collections::BTreeMap;

use crate::{DataType, Default, Number};

/// The objects a device claims to have, in index order.
#[derive(Debug, Clone, PartialEq, std::default::Default)]
pub struct Dictionary {
    objects: BTreeMap<u16, Object>,
}

impl Dictionary {
    /// The object at `index`.
    pub fn object(&self, index: u16) -> Option<&Object> {
        self.objects.get(&index)
    }

    /// The entry at `index` and sub-index `sub`; a variable is at sub-index 0.
    pub fn entry(&self, index: u16, sub: u8) -> Option<&Entry> {
        self.object(index)?.entries.get(&sub)
    }

    /// Every object, in index order.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        self.objects.values()
    }

    /// Every entry with its index and sub-index, in that order.
    pub fn entries(&self) -> impl Iterator<Item = (u16, u8, &Entry)> {
        self.objects().flat_map(|object| {
            object
                .entries
                .iter()
                .map(|(sub, entry)| (object.index, *sub, entry))
        })
    }
}

impl FromIterator<Object> for Dictionary {
    /// Of two objects with one index the later stays.
    fn from_iter<I: IntoIterator<Item = Object>>(objects: I) -> Dictionary {
        Dictionary {
            objects: objects
                .into_iter()
                .map(|object| (object.index, object))
                .collect(),
        }
    }
}

/// One index of the dictionary.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Its index.
    pub index: u16,
    /// Its name as the file has it.
    pub name: String,
    /// Its object code.
    pub kind: ObjectKind,
    /// Its entries by sub-index; a variable or domain has one, at 0.
    pub entries: Entries,
    /// The line of its section, from 1.
    pub line: usize,
}

/// The entries of an object by sub-index, in that order. Most objects have one: a tree would take more room than it is
/// worth.
#[derive(Debug, Clone, PartialEq, std::default::Default)]
pub struct Entries(Vec<(u8, Entry)>);

impl Entries {
    /// The entry at `sub`.
    pub fn get(&self, sub: &u8) -> Option<&Entry> {
        let at = self.0.binary_search_by_key(sub, |(sub, _)| *sub).ok()?;
        self.0.get(at).map(|(_, entry)| entry)
    }

    /// Puts `entry` at `sub`, in place of what was there.
    pub fn insert(&mut self, sub: u8, entry: Entry) {
        // Files describe sub-indices in their order.
        if self.0.last().is_none_or(|(last, _)| *last < sub) {
            self.0.push((sub, entry));
            return;
        }
        match self.0.binary_search_by_key(&sub, |(sub, _)| *sub) {
            Ok(at) => {
                if let Some((_, old)) = self.0.get_mut(at) {
                    *old = entry;
                }
            }
            Err(at) => self.0.insert(at, (sub, entry)),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Each sub-index with its entry.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (&u8, &Entry)> {
        self.0.iter().map(|(sub, entry)| (sub, entry))
    }

    /// The sub-indices.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = &u8> {
        self.0.iter().map(|(sub, _)| sub)
    }

    /// The entries.
    pub fn values(&self) -> impl DoubleEndedIterator<Item = &Entry> {
        self.0.iter().map(|(_, entry)| entry)
    }

    /// The entries, to be changed.
    pub fn values_mut(&mut self) -> impl DoubleEndedIterator<Item = &mut Entry> {
        self.0.iter_mut().map(|(_, entry)| entry)
    }

    /// The entry at `sub`, to be changed.
    pub fn get_mut(&mut self, sub: u8) -> Option<&mut Entry> {
        let at = self.0.binary_search_by_key(&sub, |(sub, _)| *sub).ok()?;
        self.0.get_mut(at).map(|(_, entry)| entry)
    }
}

impl FromIterator<(u8, Entry)> for Entries {
    /// Of two entries with one sub-index the later stays.
    fn from_iter<I: IntoIterator<Item = (u8, Entry)>>(entries: I) -> Entries {
        let mut made = Entries::default();
        for (sub, entry) in entries {
            made.insert(sub, entry);
        }
        made
    }
}

/// The object code (CiA 301).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ObjectKind {
    /// 0, an object without data.
    Null,
    /// 2, a large block of data.
    Domain,
    /// 5, the definition of a simple type.
    DefType,
    /// 6, the definition of a record type.
    DefStruct,
    /// 7, a single value.
    Variable,
    /// 8, entries of one type.
    Array,
    /// 9, entries of several types.
    Record,
    /// Any other code.
    Unknown(u8),
}

impl ObjectKind {
    /// The kind whose object code is `code`.
    pub const fn from_code(code: u8) -> ObjectKind {
        match code {
            0 => ObjectKind::Null,
            2 => ObjectKind::Domain,
            5 => ObjectKind::DefType,
            6 => ObjectKind::DefStruct,
            7 => ObjectKind::Variable,
            8 => ObjectKind::Array,
            9 => ObjectKind::Record,
            other => ObjectKind::Unknown(other),
        }
    }

    /// Its object code.
    pub const fn code(self) -> u8 {
        match self {
            ObjectKind::Null => 0,
            ObjectKind::Domain => 2,
            ObjectKind::DefType => 5,
            ObjectKind::DefStruct => 6,
            ObjectKind::Variable => 7,
            ObjectKind::Array => 8,
            ObjectKind::Record => 9,
            ObjectKind::Unknown(code) => code,
        }
    }
}

/// One sub-index of an object: a value that can be read or written.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Its name as the file has it.
    pub name: String,
    /// Its type.
    pub data_type: DataType,
    /// What may be done with it.
    pub access: Access,
    /// The lowest value it takes, if one is given; for a REALn, its bit pattern.
    pub low_limit: Option<Number>,
    /// The highest value it takes, if one is given; for a REALn, its bit pattern.
    pub high_limit: Option<Number>,
    /// Its value after a reset to defaults, if one is given.
    pub default: Option<Default>,
    /// Its value in this device, if a DCF gives one.
    pub parameter_value: Option<Default>,
    /// What it is called in this device, if a DCF says so.
    pub denotation: Option<String>,
    /// Whether it may be mapped into a PDO.
    pub pdo_mapping: bool,
    /// The line of its section, from 1.
    pub line: usize,
}

impl Entry {
    /// The default as an SDO carries it for node `node`: little-endian in the size of the data type, or the bytes of
    /// the string. `None` if no default is given, or if it does not fit the type.
    pub fn default_bytes(&self, node: u8) -> Option<Vec<u8>> {
        self.default.as_ref()?.bytes(self.data_type, node)
    }

    /// The value that a DCF gives, else the default, in the form of [`Entry::default_bytes`].
    pub fn configured_bytes(&self, node: u8) -> Option<Vec<u8>> {
        let value = self.parameter_value.as_ref().or(self.default.as_ref());
        value?.bytes(self.data_type, node)
    }
}

/// What may be done with an entry, as CiA 306 writes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Access {
    /// `ro`
    ReadOnly,
    /// `wo`
    WriteOnly,
    /// `rw`
    ReadWrite,
    /// `rwr`: read and write, and a PDO may only read it (the device sends it).
    ReadWriteOnRead,
    /// `rww`: read and write, and a PDO may only write it (the device receives it).
    ReadWriteOnWrite,
    /// `const`: read only, and the value never changes.
    Constant,
}

impl Access {
    /// The access that `word` names, in any case.
    pub fn from_word(word: &str) -> Option<Access> {
        let all = [
            Access::ReadOnly,
            Access::WriteOnly,
            Access::ReadWrite,
            Access::ReadWriteOnRead,
            Access::ReadWriteOnWrite,
            Access::Constant,
        ];
        all.into_iter()
            .find(|access| access.word().eq_ignore_ascii_case(word))
    }

    /// Its word.
    pub const fn word(self) -> &'static str {
        match self {
            Access::ReadOnly => "ro",
            Access::WriteOnly => "wo",
            Access::ReadWrite => "rw",
            Access::ReadWriteOnRead => "rwr",
            Access::ReadWriteOnWrite => "rww",
            Access::Constant => "const",
        }
    }

    /// Whether an SDO may read it.
    pub const fn readable(self) -> bool {
        !matches!(self, Access::WriteOnly)
    }

    /// Whether an SDO may write it.
    pub const fn writable(self) -> bool {
        !matches!(self, Access::ReadOnly | Access::Constant)
    }
}
