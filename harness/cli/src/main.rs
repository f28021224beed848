//! The program.

use std::process::ExitCode;

use clap::Parser;
use fieldproof::Options;

fn main() -> ExitCode {
    fieldproof::main(&Options::parse()).into()
}
