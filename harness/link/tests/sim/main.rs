//! The simulated lane, by frame scripts with exact instants and by properties.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy's exemption for tests ends at their helper functions.

mod actor;
mod can;
mod companions;
mod connections;
mod lane;
mod properties;
mod serial;
mod wrap;
