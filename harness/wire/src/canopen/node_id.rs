//! The node-ID.

use std::fmt;

bounded! {
    /// A node-ID, `1..=127`.
    pub struct NodeId(u8) in 1..=127
}

impl fmt::Display for NodeId {
    /// Decimal.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}
