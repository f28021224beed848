//! The values of the object dictionary.

use std::collections::BTreeMap;

use fieldproof_dictionary::{Dictionary, Entry};

use super::emergency::ERROR_HISTORY;
use super::{Abort, Address, ObjectFault, ObjectFaultKind};

/// One value with its attributes.
#[derive(Debug, Clone)]
pub(crate) struct Object {
    pub(crate) readable: bool,
    pub(crate) writable: bool,
    pub(crate) mappable: bool,
    /// The number of bytes, where the type fixes it.
    size: Option<usize>,
    /// The number of bits, where the type fixes it.
    bits: Option<u32>,
    signed: bool,
    low: Option<i128>,
    high: Option<i128>,
    value: Vec<u8>,
}

impl Object {
    fn new(entry: &Entry) -> Object {
        Object {
            readable: entry.access.readable(),
            writable: entry.access.writable(),
            mappable: entry.pdo_mapping,
            size: entry.data_type.bytes(),
            bits: entry.data_type.bits(),
            signed: entry.data_type.is_signed(),
            low: None,
            high: None,
            value: Vec::new(),
        }
    }

    /// A value that nothing describes.
    fn surplus() -> Object {
        Object {
            readable: true,
            writable: false,
            mappable: false,
            size: Some(1),
            bits: Some(8),
            signed: false,
            low: None,
            high: None,
            value: vec![0],
        }
    }

    /// Makes it other than its description says.
    fn spoil(&mut self, kind: ObjectFaultKind) {
        match kind {
            ObjectFaultKind::Missing | ObjectFaultKind::Surplus => {}
            ObjectFaultKind::WrongDefault => {
                if let Some(first) = self.value.first_mut() {
                    *first ^= 1;
                }
            }
            ObjectFaultKind::WrongSize => {
                self.size = self.size.map(|size| size + 1);
                self.value.push(0);
            }
            ObjectFaultKind::Writable => self.writable = true,
            ObjectFaultKind::ReadOnly => self.writable = false,
            ObjectFaultKind::Readable => self.readable = true,
            ObjectFaultKind::TooHigh => self.high = None,
            ObjectFaultKind::TooLow => self.low = None,
        }
    }

    fn load(&mut self, entry: &Entry, node: u8) {
        self.size = entry.data_type.bytes();
        self.low = entry.low_limit.map(|limit| limit.value(node));
        self.high = entry.high_limit.map(|limit| limit.value(node));
        let zeros = || vec![0; self.size.unwrap_or(0)];
        self.value = entry.default_bytes(node).unwrap_or_else(zeros);
    }

    pub(crate) fn value(&self) -> &[u8] {
        &self.value
    }

    /// The number of bytes, where the type fixes it.
    pub(crate) fn size(&self) -> Option<usize> {
        self.size
    }

    /// The number of bits that a PDO carries, where the type fixes it.
    pub(crate) fn bits(&self) -> Option<u32> {
        self.bits
    }

    /// The value as an unsigned number; what does not fit 32 bits is left out.
    pub(crate) fn number(&self) -> u32 {
        let bytes = self.value.iter().take(4).rev();
        bytes.fold(0, |number, byte| number << 8 | u32::from(*byte))
    }

    /// Whether a value of the right length is within the limits.
    fn limits(&self, value: &[u8]) -> Result<(), Abort> {
        if self.low.is_none() && self.high.is_none() {
            return Ok(());
        }
        let negative = self.signed && value.last().is_some_and(|byte| byte & 0x80 != 0);
        let start = if negative { -1 } else { 0 };
        let bytes = value.iter().rev();
        let number = bytes.fold(start, |number: i128, byte| number << 8 | i128::from(*byte));
        if self.high.is_some_and(|high| number > high) {
            return Err(Abort::TOO_HIGH);
        }
        if self.low.is_some_and(|low| number < low) {
            return Err(Abort::TOO_LOW);
        }
        Ok(())
    }

    /// Whether `value` may be written as far as length and limits go.
    pub(crate) fn takes(&self, value: &[u8]) -> Result<(), Abort> {
        match self.size {
            Some(size) if value.len() > size => Err(Abort::TOO_LONG),
            Some(size) if value.len() < size => Err(Abort::TOO_SHORT),
            _ => self.limits(value),
        }
    }
}

/// All values, in order of address.
#[derive(Debug, Clone)]
pub(crate) struct Objects {
    dictionary: &'static Dictionary,
    addresses: Vec<Address>,
    objects: Vec<Object>,
    fault: Option<ObjectFault>,
    /// A value has changed since [`Objects::take_changed`].
    changed: bool,
}

impl Objects {
    pub(crate) fn new(dictionary: &'static Dictionary, fault: Option<ObjectFault>) -> Objects {
        let entries = dictionary.entries();
        let mut all: BTreeMap<Address, Object> = entries
            .map(|(index, sub, entry)| (Address::new(index, sub), Object::new(entry)))
            .collect();
        if let Some(fault) = fault {
            match fault.kind() {
                ObjectFaultKind::Missing => drop(all.remove(&fault.address())),
                ObjectFaultKind::Surplus => {
                    all.entry(fault.address()).or_insert_with(Object::surplus);
                }
                _ => {}
            }
        }
        Objects {
            dictionary,
            addresses: all.keys().copied().collect(),
            objects: all.into_values().collect(),
            fault,
            changed: true,
        }
    }

    /// Gives every value of an index in `indexes` what it has after a reset: what was saved, else the default.
    pub(crate) fn load(
        &mut self,
        indexes: std::ops::RangeInclusive<u16>,
        node: u8,
        saved: &BTreeMap<Address, Vec<u8>>,
    ) {
        for (address, object) in self.addresses.iter().zip(&mut self.objects) {
            let entry = self.dictionary.entry(address.index(), address.sub());
            let Some(entry) = entry.filter(|_| indexes.contains(&address.index())) else {
                continue;
            };
            object.load(entry, node);
            if let Some(value) = saved.get(address) {
                object.value.clone_from(value);
            }
            if let Some(fault) = self.fault.filter(|fault| fault.address() == *address) {
                object.spoil(fault.kind());
            }
        }
        self.changed = true;
    }

    /// The slot of `address`.
    ///
    /// # Errors
    /// The object or the sub-index does not exist.
    pub(crate) fn find(&self, address: Address) -> Result<usize, Abort> {
        self.addresses.binary_search(&address).map_err(|place| {
            let near = [place.checked_sub(1), Some(place)];
            let mut near = near.into_iter().flatten();
            let same = |slot: &Address| slot.index() == address.index();
            if near.any(|place| self.addresses.get(place).is_some_and(same)) {
                Abort::NO_SUB_INDEX
            } else {
                Abort::NO_OBJECT
            }
        })
    }

    pub(crate) fn at(&self, slot: usize) -> Option<&Object> {
        self.objects.get(slot)
    }

    pub(crate) fn get(&self, address: Address) -> Option<&Object> {
        self.at(self.find(address).ok()?)
    }

    /// The value at `address` as an unsigned number, if it exists.
    pub(crate) fn number(&self, address: Address) -> Option<u32> {
        self.get(address).map(Object::number)
    }

    /// Sets a value from inside the device; of a value of fixed size as many bytes as it has. Nothing happens where
    /// there is no such object.
    pub(crate) fn set(&mut self, address: Address, value: &[u8]) {
        let Ok(slot) = self.find(address) else { return };
        let Some(object) = self.objects.get_mut(slot) else {
            return;
        };
        let value = value.get(..object.size.unwrap_or(value.len()));
        if let Some(value) = value.filter(|value| *value != object.value) {
            object.value.clear();
            object.value.extend_from_slice(value);
            self.changed = true;
        }
    }

    /// Sets a number from inside the device, in the size of the object.
    pub(crate) fn set_number(&mut self, address: Address, value: i64) {
        self.set(address, &value.to_le_bytes());
    }

    /// Gives every value that has the default of node `from` the default of node `to`.
    pub(crate) fn readdress(&mut self, from: u8, to: u8) {
        for (address, object) in self.addresses.iter().zip(&mut self.objects) {
            let entry = self.dictionary.entry(address.index(), address.sub());
            let default = |node| entry.and_then(|entry| entry.default_bytes(node));
            if let (Some(old), Some(new)) = (default(from), default(to))
                && old == object.value
            {
                object.value = new;
            }
        }
        self.changed = true;
    }

    /// Whether a value has changed since this was last asked.
    pub(crate) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = (Address, &Object)> {
        self.addresses.iter().copied().zip(&self.objects)
    }

    /// The parameters of `indexes` that are not what a reset without saved values gives. What a PDO can carry is no
    /// parameter, nor is the error history.
    pub(crate) fn differing(
        &self,
        indexes: &std::ops::RangeInclusive<u16>,
        node: u8,
    ) -> BTreeMap<Address, Vec<u8>> {
        let candidates = self.iter().filter(|(address, object)| {
            object.writable
                && !object.mappable
                && address.index() != ERROR_HISTORY
                && indexes.contains(&address.index())
        });
        candidates
            .filter_map(|(address, _)| {
                Some((address, self.unless_default(address, node)?.to_vec()))
            })
            .collect()
    }

    /// The value at `address` unless it is the default of node `node`.
    pub(crate) fn unless_default(&self, address: Address, node: u8) -> Option<&[u8]> {
        let entry = self.dictionary.entry(address.index(), address.sub())?;
        let mut fresh = Object::new(entry);
        fresh.load(entry, node);
        let object = self.get(address)?;
        (fresh.value != object.value).then_some(&object.value)
    }
}
