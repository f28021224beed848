//! `fieldproof scan`

mod bench;
mod found;
mod known;
mod table;

use std::fs;
use std::sync::atomic::Ordering;
use std::time::Duration;

use fieldproof_link::real::{NoStimuli, RealLane, SocketCan};
use fieldproof_link::{LinkError, PortIndex};
use fieldproof_report::{Problem, Severity};
use fieldproof_run::scan::{
    CanopenFound, CanopenScan, MOST_ADDRESSES, ModbusFound, ModbusScan, scan_canopen, scan_modbus,
};
use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::device::{Parity, PortDescription};

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::options::{Format, ScanOptions};
use crate::progress::Progress;
use crate::screen::Screen;
use crate::{links, stop};
use found::Found;
use known::Known;

/// Where nothing says how fast a CAN bus is, in bits a second.
const BIT_RATE: u32 = 500_000;

/// How a Modbus line is set where nothing is said, by the specification of the serial line.
const SERIAL: PortDescription = PortDescription::Serial {
    baud: 19_200,
    parity: Parity::Even,
    stop_bits: 1,
    companion: None,
};

const CANOPEN_TIMEOUT_MS: u32 = 500;
const MODBUS_TIMEOUT_MS: u32 = 200;

/// Finds out what is on a link, prints it, and writes a bench to start from.
pub(crate) fn scan(options: &ScanOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let link = links::read(&options.on)?;
    check(options, &link)?;
    let known = Known::load(options.device.as_deref())?;
    let port = port(options, &link);
    let set = bench::link(&options.on, &link, &port);
    let found = match &port {
        PortDescription::Can { .. } => {
            Found::on_canopen(set, &canopen(options, &link, &port)?, &known)
        }
        PortDescription::Serial { .. } | PortDescription::Tcp { .. } => {
            Found::on_modbus(set, &modbus(options, &link, &port)?, &known)
        }
    };
    let text = bench::text(&found, &known, options.bench.as_deref());
    match options.format {
        Format::Json => screen.print_json(&found.with_bench(text.as_deref())),
        Format::Text => screen.print(&table::text(&found)),
    }
    let written = match (&options.bench, &text) {
        (Some(path), Some(text)) => {
            fs::write(path, text).map_err(|error| Complaint::unwritable(path.display(), &error))?;
            if options.format == Format::Text {
                screen.print(&format!(
                    "\nbench written to {path}\nnext: fieldproof run --bench {path} --dry-run\n",
                    path = path.display()
                ));
            }
            true
        }
        (None, Some(text)) => {
            if options.format == Format::Text {
                screen.print(&format!("\na bench to start from:\n\n{text}"));
            }
            true
        }
        (Some(_), None) => {
            let problem = Problem::new(Severity::Warning, "no bench is written");
            screen.complain(&[problem.note("nothing was found that there is a description of")]);
            false
        }
        (None, None) => true,
    };
    Ok(match found.devices.is_empty() || !written {
        true => Exit::Failed,
        false => Exit::Passed,
    })
}

/// What can be wrong with the options before anything is opened.
fn check(options: &ScanOptions, link: &Link) -> Result<(), Complaint> {
    let wrong = |message: &str, help: &str| {
        let problem = Problem::new(Severity::Error, message);
        Err(Complaint::input(problem.help(help)))
    };
    if link.kind == LinkKind::Sim {
        return wrong(
            "there is nothing to find in simulation",
            "`fieldproof devices` lists the devices that are simulated",
        );
    }
    let on_can = link.kind.carries_can();
    if options.addresses.is_some() && on_can {
        return wrong(
            "a CAN bus has no Modbus addresses",
            "all 127 node-IDs are asked at once",
        );
    }
    if (options.bit_rate.is_some() || options.lss) && !on_can {
        return wrong(
            "`--bit-rate` and `--lss` are for CAN",
            "a serial line is set by its link: `serial:/dev/ttyUSB0?baud=9600&parity=none`",
        );
    }
    match &options.bench {
        Some(path) if path.exists() && !options.force => {
            let problem = Problem::new(Severity::Error, "the file is there already");
            let problem = problem.in_file(path.display().to_string());
            Err(Complaint::input(problem.help("`--force` overwrites it")))
        }
        _ => Ok(()),
    }
}

/// How the tester's port is set.
fn port(options: &ScanOptions, link: &Link) -> PortDescription {
    if !link.kind.carries_can() {
        let parameters = &link.parameters;
        return match SERIAL {
            PortDescription::Serial {
                baud,
                parity,
                stop_bits,
                companion,
            } => PortDescription::Serial {
                baud: parameters.baud.unwrap_or(baud),
                parity: parameters.parity.unwrap_or(parity),
                stop_bits: parameters.stop_bits.unwrap_or(stop_bits),
                companion,
            },
            other => other,
        };
    }
    let of_interface = match link.kind {
        LinkKind::SocketCan => SocketCan::bit_rate_of(&link.target),
        _ => None,
    };
    let said = options.bit_rate.or(link.parameters.bit_rate);
    PortDescription::Can {
        bit_rate: said.or(of_interface).unwrap_or(BIT_RATE),
    }
}

fn open(role: &str, link: &Link, port: &PortDescription) -> Result<RealLane, Complaint> {
    let mut link = link.clone();
    // `--bit-rate` comes before what the link says.
    if let PortDescription::Can { bit_rate } = port {
        link.parameters.bit_rate = Some(*bit_rate);
    }
    let port = links::open(role, &link, port);
    let port = port.map_err(|error| Complaint::bench(error.to_string()))?;
    Ok(RealLane::new(vec![port], Box::new(NoStimuli)))
}

fn milliseconds(number: u32) -> Duration {
    Duration::from_millis(number.into())
}

/// Nobody who acknowledges is nobody found, and no broken link.
fn canopen(
    options: &ScanOptions,
    link: &Link,
    port: &PortDescription,
) -> Result<Option<CanopenFound>, Complaint> {
    let mut lane = open("can", link, port)?;
    let how = CanopenScan {
        listen: milliseconds(options.listen),
        timeout: milliseconds(options.timeout.unwrap_or(CANOPEN_TIMEOUT_MS)),
        lss: options.lss,
    };
    // Slaves that were switched to configuration are switched back before the program ends.
    let stop = match options.lss {
        true => Some(stop::on_interrupt()?),
        false => None,
    };
    let found = scan_canopen(&mut lane, PortIndex(0), &how);
    if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
        return Err(Complaint::bench("the scan was interrupted"));
    }
    match found {
        Ok(found) => Ok(Some(found)),
        Err(LinkError::NotAcknowledged { .. }) => Ok(None),
        Err(error) => Err(Complaint::bench(error.to_string())),
    }
}

fn modbus(
    options: &ScanOptions,
    link: &Link,
    port: &PortDescription,
) -> Result<ModbusFound, Complaint> {
    let mut lane = open("serial", link, port)?;
    let addresses = options.addresses.as_ref().map(|list| list.0.clone());
    let addresses = addresses.unwrap_or_default();
    let how = ModbusScan {
        timeout: milliseconds(options.timeout.unwrap_or(MODBUS_TIMEOUT_MS)),
        addresses,
    };
    let number = match how.addresses.len() {
        0 => MOST_ADDRESSES,
        number => number,
    };
    let progress = Progress::of(number as u64, "addresses", Screen::shows_progress());
    let found = scan_modbus(&mut lane, PortIndex(0), &how, || progress.step());
    progress.clear();
    found.map_err(|error| Complaint::bench(error.to_string()))
}
