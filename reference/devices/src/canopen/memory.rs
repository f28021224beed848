//! What survives power-off.

use std::collections::BTreeMap;

use super::{Abort, Address, Slave};

pub(super) const STORE: u16 = 0x1010;
pub(super) const RESTORE: u16 = 0x1011;
/// When the device was configured.
const CONFIGURATION_DATE: u16 = 0x1020;

/// Non-volatile memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct Memory {
    pub(crate) values: BTreeMap<Address, Vec<u8>>,
    /// The node-ID, `1..=127`, or 255 for none.
    pub(crate) node: u8,
    /// Bits a second.
    pub(crate) bit_rate: u32,
}

/// The part of the dictionary that a sub-index of 1010h and 1011h stands for.
pub(crate) fn group(sub: u8) -> std::ops::RangeInclusive<u16> {
    match sub {
        2 => 0x1000..=0x1FFF,
        3 => 0x6000..=0x9FFF,
        4.. => 0x2000..=0x5FFF,
        _ => 0x1000..=0x9FFF,
    }
}

impl Slave {
    /// 1010h takes `save`, 1011h `load`; both only where bit 0 of the value says that they can.
    pub(super) fn store_or_restore(&mut self, address: Address, value: &[u8]) -> Result<(), Abort> {
        let stores = address.index() == STORE;
        let departs = &self.behaviour.departs;
        let able = self.objects.number(address).unwrap_or(0) & 1 != 0;
        let mut signature = if stores { *b"save" } else { *b"load" };
        if departs.signatures_reversed {
            signature.reverse();
        }
        let any = if stores {
            self.behaviour.stores_without_signature
        } else {
            departs.restores_without_signature
        };
        if !able || (value != signature && !any) {
            return Err(Abort::CANNOT_STORE);
        }
        if stores && self.behaviour.stores {
            self.store(address);
            if self.behaviour.departs.store_shows_signature {
                self.objects.set(address, value);
            }
        } else if !stores && self.behaviour.restores {
            self.restore(address);
        }
        Ok(())
    }

    fn store(&mut self, address: Address) {
        let departs = &self.behaviour.departs;
        let group = group(if departs.store_groups_ignored {
            1
        } else {
            address.sub()
        });
        let kept = |index: u16| match index {
            0x1600..=0x17FF | 0x1A00..=0x1BFF if !self.behaviour.pdo.mapping_stored => false,
            0x1400..=0x1BFF => !departs.pdo_parameters_unsaved,
            CONFIGURATION_DATE => !departs.configuration_date_unsaved,
            _ => true,
        };
        let saved = &mut self.memory.values;
        saved.retain(|saved, _| !group.contains(&saved.index()));
        let differing = self.objects.differing(&group, self.node);
        saved.extend(
            differing
                .into_iter()
                .filter(|(address, _)| kept(address.index())),
        );
    }

    fn restore(&mut self, address: Address) {
        let departs = &self.behaviour.departs;
        let group = group(if departs.restore_groups_ignored {
            1
        } else {
            address.sub()
        });
        let saved = &mut self.memory.values;
        saved.retain(|saved, _| !group.contains(&saved.index()));
        if departs.restores_at_once {
            self.objects.load(group, self.node, &self.memory.values);
        }
    }
}
