//! The program `fieldproof`: reads arguments, connects benches, prints, writes reports, exits. It is a library too, so
//! that tests can play what it plays.

mod bench;
mod commands;
mod complaint;
mod control;
mod day;
mod embedded;
mod exit;
mod glob;
mod history;
mod input;
mod journal;
mod library;
mod line_trouble;
mod links;
mod operator;
mod options;
mod player;
mod problems;
mod progress;
mod reports;
mod screen;
mod select;
mod stimulus_words;
mod stop;
mod value_faults;
mod waivers;

pub use bench::{Behaviour, NotConnected};
pub use complaint::Complaint;
pub use exit::Exit;
pub use library::{Device, Library, Place};
pub use operator::Operator;
pub use options::{
    AddressList, BusOptions, CheckOptions, Color, Command, CompareFormat, CompareOptions,
    EdsCheckOptions, EdsCommand, EffectName, Format, KeyValue, ListOptions, NewDeviceOptions,
    Options, ProveOptions, ReportOptions, RunOptions, ScanOptions, SchemaKind, Selection,
    ServeOptions, StimulateOptions,
};
pub use player::{Plan, play};

use screen::Screen;

/// Does what `options` say, and gives back what to exit with.
pub fn main(options: &Options) -> Exit {
    let mut screen = Screen::new(options.color);
    let done = match &options.command {
        Command::Run(options) => commands::run::run(options, &mut screen),
        Command::Compare(options) => commands::compare::compare(options, &mut screen),
        Command::Report(options) => commands::report::report(options, &mut screen),
        Command::List(options) => commands::list::list(options, &mut screen),
        Command::Check(options) => commands::check::check(options, &mut screen),
        Command::Eds {
            command: EdsCommand::Check(options),
        } => commands::eds::check(options, &mut screen),
        Command::Schema { kind } => commands::schema::schema(*kind, &mut screen),
        Command::Faults { format } => commands::devices::faults(*format, &mut screen),
        Command::Devices { format } => commands::devices::devices(*format, &mut screen),
        Command::Bus(options) => commands::bus::bus(options, &mut screen),
        Command::Prove(options) => commands::prove::prove(options, &mut screen),
        Command::Serve(options) => commands::serve::serve(options, &mut screen),
        Command::Scan(options) => commands::scan::scan(options, &mut screen),
        Command::Stimulate(options) => commands::stimulate::stimulate(options),
        Command::NewDevice(options) => commands::new_device::new_device(options, &mut screen),
        Command::Export { directory, force } => {
            commands::export::export(directory, *force, &mut screen)
        }
    };
    let done = done.and_then(|exit| match screen.take_loss() {
        Some(error) => Err(Complaint::unwritable("standard output", &error)),
        None => Ok(exit),
    });
    match done {
        Ok(exit) => exit,
        Err(complaint) => {
            screen.complain(&complaint.problems);
            complaint.exit
        }
    }
}
