//! EDS and DCF files (CiA 306): read liberally, checked strictly, written back.
//!
//! Line ends, the case of keys and words, the base of numbers, the order of sections and blanks do not matter.
//! `SubNumber` and the object lists are not trusted: an entry exists if it has a section. What the reader cannot use
//! becomes a [`Finding`]; [`check`] finds what else breaks a rule.

mod check;
mod commissioning;
mod compact;
mod device_info;
mod field;
mod finding;
pub mod manual;
mod model;
mod object_keys;
mod objects;
mod place;
mod read;
mod rules;
mod write;

pub use check::{check, check_file_name};
pub use commissioning::Commissioning;
pub use device_info::DeviceInfo;
pub use finding::{Finding, Severity};
pub use model::Eds;
pub use read::{decode, read};
pub use rules::{RULES, Rule};
pub use write::write;

pub use crate::ini::{Key, Section, Stray};
