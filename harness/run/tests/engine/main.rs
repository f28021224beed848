//! The engine against small scripted devices: what it judges, what it leaves alone, what it puts back.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test may fail this way"
)]

mod blocks;
mod finding;
mod judging;
mod pdos;
mod restoring;
mod scripted;
