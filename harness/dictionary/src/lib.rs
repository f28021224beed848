//! What a device claims: the CANopen object dictionary of its EDS file, and its Modbus register map.
//!
//! An EDS is read from text here and comes out typed, with the line where each thing was said: [`eds`] reads liberally,
//! what it cannot use becomes a finding, never an error. [`registers`] is what a register map means; its YAML is read
//! where the rest of the YAML is.

mod data_type;
mod dictionary;
pub mod eds;
mod ini;
mod integer;
pub mod registers;
mod value;

pub use data_type::DataType;
pub use dictionary::{Access, Dictionary, Entries, Entry, Object, ObjectKind};
pub use value::{Default, Number};
