//! Everything that a case could have left changed.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::Slave;
use super::emergency::ERROR_HISTORY;

impl Slave {
    /// Everything that a case could have left changed.
    pub(crate) fn state(&self) -> BTreeMap<String, String> {
        let mut state = BTreeMap::new();
        for (address, object) in self.objects.iter() {
            if object.writable && address.index() != ERROR_HISTORY {
                state.insert(address.to_string(), hexadecimal(object.value()));
            }
        }
        for (address, value) in &self.memory.values {
            state.insert(format!("saved {address}"), hexadecimal(value));
        }
        let facts = [
            ("power", if self.powered { "on" } else { "off" }.to_owned()),
            ("nmt", self.state.name().to_owned()),
            ("lss", self.lss.name().to_owned()),
            ("sdo", self.sdo.name().to_owned()),
            ("node", self.node.to_string()),
            ("node pending", self.pending_node.to_string()),
            ("node saved", self.memory.node.to_string()),
            ("bit-rate", self.bit_rate.to_string()),
            ("bit-rate pending", self.pending_bit_rate.to_string()),
            ("bit-rate saved", self.memory.bit_rate.to_string()),
        ];
        state.extend(facts.map(|(name, value)| (name.to_owned(), value)));
        state.extend(self.servers_state());
        state
    }
}

/// As a number is written: the most significant byte first.
fn hexadecimal(value: &[u8]) -> String {
    let mut text = String::with_capacity(2 * value.len());
    for byte in value.iter().rev() {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02X}");
    }
    text
}
