//! Real links, without hardware: over loopback connections and pseudo-terminals.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy's exemption for tests ends at their helper functions.

mod slcan;
mod slcan_hub;
mod slcan_throughput;
