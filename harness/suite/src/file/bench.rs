//! A bench.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::bench::{Link, LinkKind, RTU};
use crate::code;
use crate::model::{Effect, Located, StimulusName};
use crate::problem::{Wrong, nearest};
use crate::read_with::{located_address, located_node};
use crate::scalar::{Text, read_as_text};

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
    /// The stimuli there are; without this list, those that the links offer by themselves: `sim:` all, others none.
    #[serde(default)]
    pub(crate) stimuli: Option<Vec<StimulusName>>,
    /// What cases may do to it beside reading.
    #[serde(default)]
    pub(crate) permits: Vec<Effect>,
}

impl Text for Link {
    const EXPECTED: &'static str = "a link such as \"sim:\" or \"socketcan:can0\"";

    fn parse(text: &str) -> Result<Link, Wrong> {
        let (name, target) = text.split_once(':').unwrap_or((text, ""));
        let kind = LinkKind::ALL.into_iter().find(|kind| kind.name() == name);
        let Some(kind) = kind.filter(|_| text.contains(':')) else {
            return Err(no_link(text, name));
        };
        let wrong = |message: String, label: &str| Err(Wrong::new(code::LINK, message, label));
        match kind {
            LinkKind::Sim if !target.is_empty() => wrong(
                format!("`{text}` names something behind `sim:`"),
                "expected \"sim:\" alone",
            ),
            LinkKind::Sim => Ok(Link {
                kind,
                target: String::new(),
            }),
            LinkKind::Tcp if !is_host_and_port(target.strip_suffix(RTU).unwrap_or(target)) => {
                wrong(
                    format!("`{text}` names no host and port"),
                    "expected a link such as \"tcp:192.168.0.5:502\"",
                )
            }
            _ if target.trim().is_empty() => wrong(
                format!("`{text}` does not say which"),
                "expected the interface or its path after the colon",
            ),
            _ => Ok(Link {
                kind,
                target: target.to_owned(),
            }),
        }
    }

    fn schema() -> Schema {
        json_schema!({
            "description": "What carries the port.",
            "type": "string",
            "pattern": "^(sim:|(socketcan|slcan|serial):.*\\S.*|tcp:.+:[0-9]+(\\?framing=rtu)?)$"
        })
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
