//! The engine over TCP: against our reference slaves, and against servers that do one thing wrong.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test may fail this way"
)]

mod bench;
mod scripted_server;
mod slaves;
