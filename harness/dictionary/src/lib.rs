//! What a device claims: the CANopen object dictionary of its EDS file, and its Modbus register map.
//!
//! Both are read from text and come out typed, with the line where each thing was said. [`eds`] reads liberally: what
//! it cannot use becomes a finding, never an error.

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
