//! Real links, with the test on their other side.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // Clippy's exemption for tests ends at their helper functions.

mod serial;
mod slcan;
mod slcan_hub;
mod slcan_throughput;
