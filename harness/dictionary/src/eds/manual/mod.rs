//! The object dictionary that a manual prints: a second claim, to be held against the EDS.
//!
//! A [`Table`] is written down from the manual, a row for a row; [`compare`] finds where the two differ. Which of them
//! is right only the device can say.

mod compare;
mod table;

pub use compare::{Difference, compare};
pub use table::{Row, Size, Status, Table, TableError};
