//! A bench.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::bench::{Echo, Framing, Link, LinkKind, LinkParameters};
use crate::code;
use crate::device::Parity;
use crate::model::{Effect, Located, StimulusName};
use crate::problem::{Wrong, nearest};
use crate::read_with::{located_address, located_node};
use crate::scalar::{Text, Time, read_as_text};

/// Which devices stand on the bench, and what may be done to them.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Bench")]
pub(crate) struct BenchFile {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub(crate) language: u32,
    /// The name of the bench.
    pub(crate) bench: Located<String>,
    /// What stands on it.
    #[schemars(length(min = 1))]
    pub(crate) devices: Located<Vec<Located<BenchDeviceFile>>>,
}

/// A device on the bench.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "BenchDevice")]
pub(crate) struct BenchDeviceFile {
    /// What the bench calls it; reports are named so.
    pub(crate) name: Located<String>,
    /// A device that the program carries (`kinco-servo`), or the folder of a `device.yaml`, seen from this file
    /// (`./my-drive`, `.`).
    pub(crate) device: Located<String>,
    /// The link of each port, by the role that the description gives it: `{can: "sim:"}`.
    #[schemars(extend("minProperties" = 1))]
    pub(crate) ports: Located<BTreeMap<String, Located<Link>>>,
    /// Its node-ID here, where it is not that of the description.
    #[serde(default, deserialize_with = "located_node")]
    #[schemars(range(min = 1, max = 127))]
    pub(crate) node: Option<Located<u8>>,
    /// Its Modbus address here, where it is not that of the description.
    #[serde(default, deserialize_with = "located_address")]
    #[schemars(range(min = 1, max = 247))]
    pub(crate) address: Option<Located<u8>>,
    /// The serial number (1018h:04) of the unit that stands here, where each unit has its own.
    #[serde(default)]
    pub(crate) serial_number: Option<Located<u32>>,
    /// The stimuli there are; without this list, those that the links offer by themselves: `sim:` all, others none. On
    /// real links an operator is asked for them, unless there is a `stimulus-command`.
    #[serde(default)]
    pub(crate) stimuli: Option<Vec<StimulusName>>,
    /// What gives the stimuli on real links: a program and its first arguments. It is run with `power on`, `power off`,
    /// `process-value NAME VALUE`, `condition NAME on`, `condition NAME off` or `setting NAME VALUE` after them, and ends
    /// with 0 once that is done.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) stimulus_command: Option<Located<Vec<String>>>,
    /// What cases may do to it beside reading.
    #[serde(default)]
    pub(crate) permits: Vec<Effect>,
}

impl Text for Link {
    const EXPECTED: &'static str = "a link such as \"sim:\" or \"socketcan:can0\"";

    fn parse(text: &str) -> Result<Link, Wrong> {
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        let kind = LinkKind::ALL.into_iter().find(|kind| kind.name() == name);
        let Some(kind) = kind.filter(|_| text.contains(':')) else {
            return Err(no_link(text, name));
        };
        let (target, query) = rest.split_once('?').unwrap_or((rest, ""));
        let mut parameters = LinkParameters::default();
        let target = match target.rsplit_once('@') {
            Some((target, rate)) if kind == LinkKind::Slcan => {
                parameters.bit_rate = Some(bits_a_second(text, rate)?);
                target
            }
            _ => target,
        };
        for parameter in query.split('&').filter(|it| !it.is_empty()) {
            set_parameter(&mut parameters, kind, text, parameter)?;
        }
        check_target(kind, text, target)?;
        Ok(Link {
            kind,
            target: target.to_owned(),
            parameters,
        })
    }

    fn schema() -> Schema {
        json_schema!({
            "description": "What carries the port.",
            "type": "string",
            "pattern": "^(sim:|(socketcan|slcan|serial):.*\\S.*|tcp:.+:[0-9]+(\\?.*)?)$"
        })
    }
}

fn check_target(kind: LinkKind, text: &str, target: &str) -> Result<(), Wrong> {
    let wrong = |message: String, label: &str| Err(Wrong::new(code::LINK, message, label));
    match kind {
        LinkKind::Sim if !target.is_empty() => wrong(
            format!("`{text}` names something behind `sim:`"),
            "expected \"sim:\" alone",
        ),
        LinkKind::Sim => Ok(()),
        LinkKind::Tcp if !is_host_and_port(target) => wrong(
            format!("`{text}` names no host and port"),
            "expected a link such as \"tcp:192.168.0.5:502\"",
        ),
        _ if target.trim().is_empty() => wrong(
            format!("`{text}` does not say which"),
            "expected the interface or its path after the colon",
        ),
        _ => Ok(()),
    }
}

/// The parameters that a kind of link has.
const fn parameters_of(kind: LinkKind) -> &'static [&'static str] {
    match kind {
        LinkKind::Sim => &[],
        LinkKind::SocketCan | LinkKind::Slcan => &["uncertainty"],
        LinkKind::Serial => &["baud", "parity", "stop-bits", "echo", "uncertainty"],
        LinkKind::Tcp => &["framing", "uncertainty"],
    }
}

fn set_parameter(
    parameters: &mut LinkParameters,
    kind: LinkKind,
    text: &str,
    parameter: &str,
) -> Result<(), Wrong> {
    let (name, value) = parameter.split_once('=').unwrap_or((parameter, ""));
    let known = parameters_of(kind);
    if !known.contains(&name) {
        let message = format!("`{}:` has no parameter `{name}`", kind.name());
        let wrong = Wrong::new(code::LINK, message, "in this link");
        return Err(match (nearest(name, known), known) {
            (Some(name), _) => wrong.help(format!("did you mean `{name}`?")),
            (None, []) => wrong,
            (None, known) => wrong.help(format!("it has {}", known.join(", "))),
        });
    }
    let not_among = |names: &[&str]| {
        let message = format!("`{value}` is no `{name}`");
        Wrong::new(
            code::LINK,
            message,
            format!("expected {}", names.join(" or ")),
        )
    };
    match name {
        "baud" => parameters.baud = Some(bits_a_second(text, value)?),
        "parity" => {
            parameters.parity = Some(match value {
                "none" => Parity::None,
                "even" => Parity::Even,
                "odd" => Parity::Odd,
                _ => return Err(not_among(&["none", "even", "odd"])),
            });
        }
        "stop-bits" => {
            parameters.stop_bits = Some(match value {
                "1" => 1,
                "2" => 2,
                _ => return Err(not_among(&["1", "2"])),
            });
        }
        "echo" => {
            parameters.echo = Some(match value {
                "auto" => Echo::Auto,
                "yes" => Echo::Yes,
                "no" => Echo::No,
                _ => return Err(not_among(&["auto", "yes", "no"])),
            });
        }
        "framing" => {
            parameters.framing = Some(match value {
                "tcp" => Framing::Tcp,
                "rtu" => Framing::Rtu,
                _ => return Err(not_among(&["tcp", "rtu"])),
            });
        }
        _ => parameters.uncertainty = Some(Time::parse(&spaced(value))?.0),
    }
    Ok(())
}

/// `5ms` as the language writes it: `5 ms`.
fn spaced(duration: &str) -> String {
    let unit = duration.find(|it: char| it.is_alphabetic());
    let (number, unit) = duration.split_at(unit.unwrap_or(duration.len()));
    format!("{} {unit}", number.trim_end())
}

fn bits_a_second(text: &str, value: &str) -> Result<u32, Wrong> {
    match value.parse::<u32>() {
        Ok(rate) if rate > 0 => Ok(rate),
        _ => Err(Wrong::new(
            code::LINK,
            format!("`{value}` in `{text}` is no rate"),
            "expected bits a second, such as 250000",
        )),
    }
}

read_as_text!(Link);

fn no_link(text: &str, name: &str) -> Wrong {
    let names = LinkKind::ALL.map(LinkKind::name);
    let wrong = Wrong::new(
        code::LINK,
        format!("`{text}` is not a link"),
        "expected \"sim:\", or `socketcan:`, `slcan:`, `serial:` or `tcp:` and what it is connected to",
    );
    match nearest(name, &names) {
        Some(name) => wrong.help(format!("did you mean `{name}:`?")),
        None => wrong,
    }
}

fn is_host_and_port(target: &str) -> bool {
    target
        .rsplit_once(':')
        .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|it| it > 0))
}
