//! Everything that a case could have left changed.

use fieldproof_link::{State, StateName};

use super::Slave;
use super::emergency::ERROR_HISTORY;

impl Slave {
    /// Everything that a case could have left changed.
    pub(crate) fn state(&self) -> State {
        let mut state = State::default();
        for (address, object) in self.objects.iter() {
            if object.writable && address.index() != ERROR_HISTORY {
                let name = StateName::Object("", address.index(), address.sub());
                state.insert(name, object.value());
            }
        }
        for (address, value) in &self.memory.values {
            let name = StateName::Object("saved ", address.index(), address.sub());
            state.insert(name, value.as_slice());
        }
        state.insert("power", if self.powered { "on" } else { "off" });
        state.insert("nmt", self.state.name());
        state.insert("lss", self.lss.name());
        state.insert("sdo", self.sdo.name());
        state.insert("node", self.node);
        state.insert("node pending", self.pending_node);
        state.insert("node saved", self.memory.node);
        state.insert("bit-rate", self.bit_rate);
        state.insert("bit-rate pending", self.pending_bit_rate);
        state.insert("bit-rate saved", self.memory.bit_rate);
        state.extend(self.servers_state());
        state
    }
}
