//! YAML into typed conformance cases.
//!
//! The way of a suite file: `yaml` reads text into a tree in which every node knows its place; `read` reads that tree
//! into the words of the language, [`model`], with the place of every mistake, and replaces the placeholders of a
//! table's row on the way (`expand`); [`load()`] does all of it and gives back [`Suite`]s and [`Diagnostic`]s.
//! A device description, a register map and a bench take the same way: [`load_device`], [`load_registers`],
//! [`load_bench`].

pub mod bench;
pub mod catalogue;
pub mod code;
pub mod device;
mod diagnostic;
#[cfg(test)]
mod documented;
mod expand;
mod file;
mod forms;
pub mod identity;
mod lines;
mod load;
pub mod model;
mod node;
mod problem;
mod read;
mod read_with;
pub mod scalar;
mod schema;
pub mod waivers;
mod yaml;

pub use diagnostic::{Diagnostic, Position, Severity};
pub use expand::Environment;
pub use load::{
    CaseRef, Columns, Loaded, SourceFile, Suite, load, load_bench, load_catalogue, load_device,
    load_registers, load_waivers, unknown_checks, unknown_entries,
};
pub use schema::{
    bench_schema, catalogue_schema, device_schema, registers_schema, schema, waivers_schema,
};
