//! The Huacheng SSTS1 servo drive.

pub mod registers;
