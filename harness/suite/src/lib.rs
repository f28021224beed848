//! YAML into typed conformance cases.
//!
//! The way of a suite file: [`yaml`] reads text into a tree in which every node knows its place; [`expand`] turns the
//! rows of a table into cases on that tree; [`model`] says what a step is, and the tree is read into it with the place
//! of every mistake; [`load`] does all of it and gives back [`Suite`]s and [`Diagnostic`]s.

pub mod device;
mod diagnostic;
pub mod model;
pub mod scalar;

pub use diagnostic::{Diagnostic, Position, Severity};
