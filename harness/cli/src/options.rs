//! What can be written on the command line.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum, value_parser};
use fieldproof_record::Setting;
use fieldproof_run::effect_name;
use fieldproof_suite::model::{Depth, Effect};

/// Plays conformance suites against CANopen and Modbus field devices.
#[derive(Debug, Parser)]
#[command(name = "fieldproof", version, max_term_width = 100, after_help = EXIT_CODES)]
pub struct Options {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Whether output has colours.
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub color: Color,
}

const EXIT_CODES: &str = "Exit codes:
  0  everything passed (documented deviations included, unless --strict)
  1  something failed or was inconclusive
  2  the input was wrong, or nothing was selected or played
  3  the bench broke, or the run was interrupted";

/// A command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Play suites against devices and write reports
    Run(RunOptions),
    /// Make all reports again from the journal of a run, finished or not
    Report(ReportOptions),
    /// Put two runs side by side: what fails now, what no more, which times have moved
    Compare(CompareOptions),
    /// List the cases of the suites
    List(ListOptions),
    /// Read and check suites and device descriptions; play nothing
    Check(CheckOptions),
    /// Work with EDS files
    Eds {
        /// What to do.
        #[command(subcommand)]
        command: EdsCommand,
    },
    /// Print a JSON Schema
    Schema {
        /// Of which kind of file.
        #[arg(default_value = "suite")]
        kind: SchemaKind,
    },
    /// List the faults that the reference devices can have, with the clause each breaks
    Faults {
        /// How to print them.
        #[arg(long, default_value = "text")]
        format: Format,
    },
    /// List the devices
    Devices {
        /// How to print them.
        #[arg(long, default_value = "text")]
        format: Format,
    },
    /// Play every suite against every fault and show which case catches which
    Prove(ProveOptions),
    /// Run a reference device on real links until interrupted
    Serve(ServeOptions),
    /// Find out what is on a link, and write a bench to start from
    Scan(ScanOptions),
    /// Do something beside the bus to a device that is served
    Stimulate(StimulateOptions),
    /// Offer a CAN bus without adapters, which programs share over SLCAN, until interrupted
    Bus(BusOptions),
    /// Write a device description to start from
    NewDevice(NewDeviceOptions),
    /// Write the suites and device descriptions that the program carries into a folder
    Export {
        /// The folder.
        directory: PathBuf,
        /// Overwrite files that are there.
        #[arg(long)]
        force: bool,
    },
}

/// Which suites, cases and devices.
#[derive(Debug, Default, Args)]
pub struct Selection {
    /// Suites by id or the beginning of one (`canopen`, `canopen.nmt`), files, or folders; all that the program
    /// carries if none is given. A `device.yaml` takes the place of the description of that device.
    #[arg(value_name = "SUITE")]
    pub suites: Vec<String>,
    /// Only this device, by name or by the folder of its device.yaml; may be repeated.
    #[arg(long = "device", value_name = "NAME|DIR")]
    pub devices: Vec<String>,
    /// Only cases whose id is like this, in which `*` stands for anything; may be repeated.
    #[arg(long = "case", value_name = "PATTERN")]
    pub cases: Vec<String>,
}

/// Options of `run`.
#[derive(Debug, Args)]
pub struct RunOptions {
    /// What is played.
    #[command(flatten)]
    pub selection: Selection,
    /// Play on the devices of this bench, and do only what it permits.
    #[arg(long, value_name = "FILE")]
    pub bench: Option<PathBuf>,
    /// Ask nobody for stimuli on real links: cases that need one are skipped, unless the bench has a command for it.
    #[arg(long)]
    pub no_operator: bool,
    /// How long an operator may take over a stimulus, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 120)]
    pub operator_timeout: u64,
    /// Show what would be played on what, and what is skipped and why.
    #[arg(long)]
    pub dry_run: bool,
    /// How thorough to be: `full` plays what takes long on real time, too.
    #[arg(long, value_name = "DEPTH", value_enum, default_value = "default")]
    pub depth: DepthName,
    /// Documented deviations fail, and only the strict abort codes pass.
    #[arg(long)]
    pub strict: bool,
    /// Permit only these effects; without a bench file all are permitted, with one only those that it lists.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub allow: Vec<EffectName>,
    /// Do not permit these effects.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub deny: Vec<EffectName>,
    /// Switch this fault on in the reference devices that have it, and play only those.
    #[arg(long, value_name = "NAME")]
    pub fault: Option<String>,
    /// Use this legal variant of the reference devices that have it, and play only those.
    #[arg(long, value_name = "NAME", conflicts_with = "fault")]
    pub variant: Option<String>,
    /// The seed of everything that is drawn by lot, such as response times.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Where reports are written.
    #[arg(long, value_name = "DIR", default_value = "reports")]
    pub reports: PathBuf,
    /// Something to be said in the reports: `operator`, `order`, `serial`, `firmware` or whatever else; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<KeyValue>,
    /// Show every case with its verdict and time, and deviations in full.
    #[arg(long, short)]
    pub verbose: bool,
    /// Show only what did not pass, and the summary.
    #[arg(long, short, conflicts_with = "verbose")]
    pub quiet: bool,
    /// How to print the outcome.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

/// `operator=A. Smith`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyValue(pub Setting);

impl std::str::FromStr for KeyValue {
    type Err = String;

    fn from_str(text: &str) -> Result<KeyValue, String> {
        let (key, value) = text
            .split_once('=')
            .ok_or("expected a key, = and a value")?;
        let (key, value) = (key.trim(), value.trim());
        if key.is_empty() || key.chars().any(char::is_control) {
            return Err("the key is empty".to_owned());
        }
        Ok(KeyValue(Setting {
            key: key.to_owned(),
            value: value.to_owned(),
        }))
    }
}

/// Options of `compare`.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_EXIT_CODES)]
pub struct CompareOptions {
    /// The reports of the run before: the folder, or its journal.
    #[arg(value_name = "OLD")]
    pub old: PathBuf,
    /// The reports of the run after.
    #[arg(value_name = "NEW")]
    pub new: PathBuf,
    /// Accepted failures, each with a reason and the day it expires.
    #[arg(long, value_name = "FILE")]
    pub waivers: Option<PathBuf>,
    /// Documented deviations are failures.
    #[arg(long)]
    pub strict: bool,
    /// A measurement that has become slower is a regression, too.
    #[arg(long)]
    pub fail_on_slower: bool,
    /// How to print it.
    #[arg(long, default_value = "text")]
    pub format: CompareFormat,
}

const COMPARE_EXIT_CODES: &str = "Exit codes:
  0  no worse than before
  1  a case fails that did not, or a waiver that is needed has expired
  2  the input was wrong
  3  no worse as far as it goes, but the new run did not come to its end";

/// How a comparison is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CompareFormat {
    /// For people.
    Text,
    /// For programs.
    Json,
    /// A page.
    Html,
}

/// Options of `report`.
#[derive(Debug, Args)]
pub struct ReportOptions {
    /// The folder with the journal, `run.jsonl`.
    #[arg(value_name = "DIR", default_value = "reports")]
    pub folder: PathBuf,
    /// How to print the outcome.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

/// Options of `serve`.
#[derive(Debug, Args)]
pub struct ServeOptions {
    /// The reference device.
    #[arg(value_name = "DEVICE")]
    pub device: String,
    /// A link for it: `socketcan:vcan0`, `serial:/dev/ttyUSB0`, `tcp:127.0.0.1:502`; `ROLE=LINK` says for which of its
    /// ports. May be repeated.
    #[arg(long, value_name = "[ROLE=]LINK", required = true)]
    pub on: Vec<String>,
    /// Its CANopen node-ID.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=127))]
    pub node: Option<u8>,
    /// Its Modbus address.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=247))]
    pub address: Option<u8>,
    /// Switch this fault on.
    #[arg(long, value_name = "NAME")]
    pub fault: Option<String>,
    /// Be this legal variant.
    #[arg(long, value_name = "NAME", conflicts_with = "fault")]
    pub variant: Option<String>,
    /// The seed of its response times.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Take stimuli from this socket; see `fieldproof stimulate`.
    #[arg(long, value_name = "SOCKET")]
    pub control: Option<PathBuf>,
}

/// Options of `stimulate`.
#[derive(Debug, Args)]
pub struct StimulateOptions {
    /// The socket that the device was served with.
    #[arg(value_name = "SOCKET")]
    pub socket: PathBuf,
    /// `power on`, `power off`, `process-value NAME VALUE`, `condition NAME on`, `condition NAME off` or
    /// `setting NAME VALUE`.
    #[arg(value_name = "STIMULUS", required = true, allow_hyphen_values = true)]
    pub stimulus: Vec<String>,
}

/// Options of `scan`.
#[derive(Debug, Args)]
#[command(after_help = SCAN_EXIT_CODES)]
pub struct ScanOptions {
    /// The link: `socketcan:can0`, `slcan:/dev/ttyACM0@250000`, `serial:/dev/ttyUSB0?baud=9600&parity=none`,
    /// `tcp:192.168.0.5:502`. A serial line is set to 19200 baud, even parity and 1 stop bit, unless it says otherwise.
    #[arg(long, value_name = "LINK")]
    pub on: String,
    /// Bits a second of a CAN bus [default: what the link or its interface says, else 500000]
    #[arg(long, value_name = "BITS", value_parser = value_parser!(u32).range(1..=1_000_000))]
    pub bit_rate: Option<u32>,
    /// How long to listen on a CAN bus before anything is asked, in milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 1000, value_parser = value_parser!(u32).range(..=3_600_000))]
    pub listen: u32,
    /// How long a device may take to answer, in milliseconds [default: 500 on CAN, 200 for Modbus]
    #[arg(long, value_name = "MS", value_parser = value_parser!(u32).range(1..=60_000))]
    pub timeout: Option<u32>,
    /// Ask LSS slaves for their identity, too: those without a node-ID, or the only slave there is. They are switched to
    /// configuration for that, and back to waiting.
    #[arg(long)]
    pub lss: bool,
    /// Ask these Modbus addresses only: `1-32,40`; on Modbus TCP they are units.
    #[arg(long, value_name = "LIST")]
    pub addresses: Option<AddressList>,
    /// What is found and not recognised is this device, by name or by the folder of its device.yaml.
    #[arg(long, value_name = "NAME|DIR")]
    pub device: Option<String>,
    /// Write the bench into this file.
    #[arg(long, value_name = "FILE")]
    pub bench: Option<PathBuf>,
    /// Overwrite that file if it is there.
    #[arg(long, requires = "bench")]
    pub force: bool,
    /// How to print what is found.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

const SCAN_EXIT_CODES: &str =
    "It only listens and reads; with --lss it switches LSS slaves, and back.

Exit codes:
  0  something was found
  1  nothing was found, or nothing that the bench asked for can be written of
  2  the input was wrong
  3  the link cannot be opened, or it broke, or the bench cannot be written";

/// Modbus addresses, in the order they are given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AddressList(pub Vec<u8>);

impl std::str::FromStr for AddressList {
    type Err = String;

    fn from_str(text: &str) -> Result<AddressList, String> {
        let number = |text: &str| {
            let number = text.trim().parse::<u8>();
            number.map_err(|_| format!("`{text}` is no address from 0 to 255"))
        };
        let mut addresses = Vec::new();
        for part in text.split(',') {
            let (first, last) = match part.split_once('-') {
                Some((first, last)) => (number(first)?, number(last)?),
                None => (number(part)?, number(part)?),
            };
            if first > last {
                return Err(format!("`{part}` goes backwards"));
            }
            let new = (first..=last).filter(|it| !addresses.contains(it));
            let new: Vec<u8> = new.collect();
            addresses.extend(new);
        }
        Ok(AddressList(addresses))
    }
}

/// Options of `list`.
#[derive(Debug, Args)]
pub struct ListOptions {
    /// What is listed.
    #[command(flatten)]
    pub selection: Selection,
    /// List instead what should be tested, entry by entry of each catalogue, with the cases that test it; fails where an
    /// entry has neither a case nor a reason.
    #[arg(long)]
    pub coverage: bool,
    /// Only this catalogue; may be repeated.
    #[arg(long = "catalogue", value_name = "NAME", requires = "coverage")]
    pub catalogues: Vec<String>,
    /// How to print it.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

/// Options of `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    /// Files or folders; what the program carries if none is given.
    #[arg(value_name = "PATH")]
    pub paths: Vec<String>,
    /// How to print what is wrong.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

/// A command on EDS files.
#[derive(Debug, Subcommand)]
pub enum EdsCommand {
    /// Check EDS files: what is wrong in them, and what to do
    Check(EdsCheckOptions),
}

/// Options of `eds check`.
#[derive(Debug, Args)]
#[command(after_help = EDS_EXIT_CODES)]
pub struct EdsCheckOptions {
    /// EDS or DCF files.
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Compare each file with the object dictionary that a manual prints, written down as a table.
    #[arg(long, value_name = "TABLE")]
    pub against: Option<PathBuf>,
    /// How to print the findings.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

const EDS_EXIT_CODES: &str = "Exit codes:
  0  no errors; there may be warnings
  1  an error is found
  2  a file cannot be read";

/// Options of `prove`.
#[derive(Debug, Args)]
pub struct ProveOptions {
    /// What is played.
    #[command(flatten)]
    pub selection: Selection,
    /// Only this fault; may be repeated.
    #[arg(long = "fault", value_name = "NAME")]
    pub faults: Vec<String>,
    /// The seed of everything that is drawn by lot, such as response times.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// How to print the outcome.
    #[arg(long, default_value = "text")]
    pub format: Format,
}

/// Options of `bus`.
#[derive(Debug, Args)]
#[command(after_help = BUS_EXIT_CODES)]
#[command(group(ArgGroup::new("places").args(["tcp", "pty"]).required(true).multiple(true)))]
pub struct BusOptions {
    /// Listen here for connections; port 0 is a free one.
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub tcp: Option<SocketAddr>,
    /// Make so many pseudo-terminals.
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(1..=32))]
    pub pty: Option<u8>,
    /// Let each frame take its time on the bus; else it takes none.
    #[arg(long)]
    pub paced: bool,
    /// Bits a second for programs that set none.
    #[arg(long, value_name = "BITS", default_value_t = 125_000, value_parser = value_parser!(u32).range(1..=1_000_000))]
    pub bit_rate: u32,
}

const BUS_EXIT_CODES: &str = "It prints its links, one a line, and ends with Ctrl-C.

Exit codes:
  0  it was interrupted
  2  the input was wrong
  3  the address is taken, or the bus broke";

/// Options of `new-device`.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("claims").args(["eds", "registers"]).required(true).multiple(true)))]
pub struct NewDeviceOptions {
    /// The folder, which gives the device its name.
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
    /// The EDS of the device; features are inferred from it, and it is copied.
    #[arg(long, value_name = "FILE")]
    pub eds: Option<PathBuf>,
    /// The register map of the device, which is copied.
    #[arg(long, value_name = "FILE")]
    pub registers: Option<PathBuf>,
}

/// How something is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Text,
    /// For programs.
    Json,
}

/// Whether output has colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Color {
    /// On a terminal that has them.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// Of which kind of file a schema is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SchemaKind {
    /// A suite.
    Suite,
    /// A device description.
    Device,
    /// A register map.
    Registers,
    /// A bench.
    Bench,
    /// A catalogue of what should be tested.
    Catalogue,
    /// One line of a journal.
    Journal,
    /// The report for programs, `report.json`.
    Report,
    /// What `compare --format json` prints.
    Comparison,
    /// A file of accepted failures.
    Waivers,
}

/// How thorough a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DepthName {
    /// As a matter of course.
    Default,
    /// With what takes long on real time.
    Full,
}

impl From<DepthName> for Depth {
    fn from(name: DepthName) -> Depth {
        match name {
            DepthName::Default => Depth::Default,
            DepthName::Full => Depth::Full,
        }
    }
}

/// An effect by its name in the suite language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectName(pub Effect);

/// All effects, in the order of the language's documentation.
pub(crate) const EFFECTS: [Effect; 6] = [
    Effect::Writes,
    Effect::Persists,
    Effect::Readdresses,
    Effect::Moves,
    Effect::Resets,
    Effect::DisturbsBus,
];

impl ValueEnum for EffectName {
    fn value_variants<'a>() -> &'a [EffectName] {
        const NAMES: [EffectName; 6] = [
            EffectName(EFFECTS[0]),
            EffectName(EFFECTS[1]),
            EffectName(EFFECTS[2]),
            EffectName(EFFECTS[3]),
            EffectName(EFFECTS[4]),
            EffectName(EFFECTS[5]),
        ];
        &NAMES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(effect_name(self.0)))
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn options_are_consistent() {
        Options::command().debug_assert();
    }

    #[test]
    fn addresses_are_numbers_and_ranges() {
        let read = |text: &str| text.parse::<AddressList>().map(|list| list.0);
        assert_eq!(read("7"), Ok(vec![7]));
        assert_eq!(read("1-3,255,2"), Ok(vec![1, 2, 3, 255]));
        assert_eq!(read("9-3"), Err("`9-3` goes backwards".to_owned()));
        for wrong in ["", "256", "1-", "x", "1,,2", "-1"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
