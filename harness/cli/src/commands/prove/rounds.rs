//! What is played: each device as it is, in its variants, with its faults, and with trouble on its line.

use std::collections::BTreeSet;
use std::sync::Arc;

use fieldproof_devices::Fault;
use serde::Serialize;

use crate::bench::Behaviour;
use crate::complaint::Complaint;
use crate::library::{Device, Library};
use crate::line_trouble::{Must, TROUBLES};
use crate::options::ProveOptions;
use crate::player::Plan;
use crate::value_faults::ValueFault;
use crate::{select, value_faults};

/// What a device is made to be.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind", content = "name")]
pub(super) enum Guise {
    AsItIs,
    Variant(&'static str),
    Fault(String),
    Line(&'static str),
    /// With this node-ID, or this Modbus address, or both.
    Numbers {
        node: Option<u8>,
        address: Option<u8>,
    },
}

/// One device in one guise, to be played with all suites.
pub(super) struct Round {
    pub(super) device: Arc<Device>,
    pub(super) guise: Guise,
    pub(super) behaviour: Behaviour,
    pub(super) expects: Expects,
}

/// What a round must come to.
pub(super) enum Expects {
    /// Everything passes.
    Passes,
    /// A fault is caught.
    Caught(Claim),
    /// Trouble on the line.
    Line(Must),
}

/// What a fault claims of itself.
pub(super) struct Claim {
    /// The clause that it breaks.
    pub(super) breaks: &'static str,
    /// The service whose suites must catch it.
    pub(super) caught_by: &'static str,
    /// The first line of a failure names one of these.
    pub(super) named: Vec<String>,
}

impl Claim {
    fn of(fault: &Fault) -> Claim {
        Claim {
            breaks: fault.breaks,
            caught_by: fault.caught_by,
            named: fault
                .named()
                .iter()
                .map(|word| (*word).to_owned())
                .collect(),
        }
    }

    fn of_value(fault: ValueFault) -> Claim {
        let text = fault.to_string();
        let address = text.split(':').nth(1).unwrap_or_default();
        let caught_by = match fault {
            ValueFault::Object(_) => "sdo",
            ValueFault::Register(_) => "registers",
        };
        Claim {
            breaks: fault.kind().breaks(),
            caught_by,
            named: vec![format!("{address}h")],
        }
    }
}

/// Node-IDs and Modbus addresses: the first and the last, and one that suites give to another node.
const NUMBERS: [(u8, u8); 3] = [(1, 1), (127, 247), (111, 246)];

/// A fault that is not one of a single value shows in any row of a walk, or in none: so many are played.
const ROWS_OF_A_WALK: u16 = 8;

pub(super) fn rounds(
    library: &Library,
    plan: &Plan,
    options: &ProveOptions,
) -> Result<Vec<Round>, Complaint> {
    let devices: Vec<&Device> = library
        .devices
        .iter()
        .filter(|device| !plan.suites(device).is_empty())
        .collect();
    if devices.is_empty() {
        return Err(select::nothing_selected());
    }
    select::must_be_simulated(&devices)?;
    faults_must_be_known(&devices, &options.faults)?;
    Ok(devices
        .into_iter()
        .flat_map(|device| rounds_of(device, library, options))
        .collect())
}

fn rounds_of(device: &Device, library: &Library, options: &ProveOptions) -> Vec<Round> {
    let whole = Arc::new(device.clone());
    let sampled = Arc::new(device.with_some_of_each(&library.suites, ROWS_OF_A_WALK));
    let configured = Arc::new(sampled.configured());
    let round = |device: &Arc<Device>, guise, behaviour, expects| Round {
        device: Arc::clone(device),
        guise,
        expects,
        behaviour: Behaviour {
            seed: options.seed,
            ..behaviour
        },
    };
    let as_it_is = round(&whole, Guise::AsItIs, Behaviour::default(), Expects::Passes);
    let variants = device.variants().iter().map(|variant| {
        let behaviour = Behaviour {
            variant: Some(variant.name.to_owned()),
            ..Behaviour::default()
        };
        round(
            &whole,
            Guise::Variant(variant.name),
            behaviour,
            Expects::Passes,
        )
    });
    let asked =
        |name: &str| options.faults.is_empty() || options.faults.iter().any(|it| it == name);
    let named = device.faults().filter(|fault| asked(fault.name));
    let named = named.map(|fault| (&sampled, fault.name.to_owned(), Claim::of(fault)));
    let of_objects = match options.faults.is_empty() {
        true => value_faults::some(device),
        false => {
            let asked = options.faults.iter();
            asked
                .filter_map(|name| value_faults::of(device, name))
                .collect()
        }
    };
    let of_objects = of_objects
        .into_iter()
        .map(|fault| (&whole, fault.to_string(), Claim::of_value(fault)));
    let faults = named.chain(of_objects).map(|(device, name, claim)| {
        let behaviour = Behaviour {
            fault: Some(name.clone()),
            ..Behaviour::default()
        };
        round(
            device,
            Guise::Fault(name),
            behaviour,
            Expects::Caught(claim),
        )
    });
    let troubles = TROUBLES.iter().filter(|trouble| {
        options.faults.is_empty() && device.kind.is_some_and(|kind| trouble.fits(kind))
    });
    let troubles = troubles.map(|trouble| {
        let behaviour = Behaviour {
            line: Some(trouble.trouble),
            ..Behaviour::default()
        };
        let expects = Expects::Line(trouble.must);
        let device = match trouble.configures() {
            true => &configured,
            false => &sampled,
        };
        round(device, Guise::Line(trouble.name), behaviour, expects)
    });
    let numbers = NUMBERS
        .iter()
        .filter(|_| options.faults.is_empty())
        .map(|(node, address)| {
            let numbered = device.numbered(*node, *address);
            // What a dictionary says with $NODEID is another number now.
            let numbered = Arc::new(numbered.with_some_of_each(&library.suites, ROWS_OF_A_WALK));
            let canopen = numbered.description.canopen.as_ref();
            let modbus = numbered.description.modbus.as_ref();
            let guise = Guise::Numbers {
                node: canopen.map(|it| it.node),
                address: modbus.map(|it| it.address),
            };
            // A switch may not have all positions, and cannot be put back then.
            let expects = Expects::Line(Must::FailNothing);
            round(&numbered, guise, Behaviour::default(), expects)
        });
    [as_it_is]
        .into_iter()
        .chain(variants)
        .chain(faults)
        .chain(troubles)
        .chain(numbers)
        .collect()
}

fn faults_must_be_known(devices: &[&Device], asked: &[String]) -> Result<(), Complaint> {
    let known: BTreeSet<&str> = devices
        .iter()
        .flat_map(|device| device.faults().map(|it| it.name))
        .collect();
    let is_known = |name: &&String| {
        let of_object = |device: &&Device| value_faults::of(device, name).is_some();
        known.contains(name.as_str()) || devices.iter().any(of_object)
    };
    match asked.iter().find(|name| !is_known(name)) {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = known.iter().copied().collect();
            Err(Complaint::unknown("fault", name, &known))
        }
    }
}
