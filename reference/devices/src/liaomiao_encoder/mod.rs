//! The Liaomiao multi-turn encoder.

pub mod model;
pub mod registers;
