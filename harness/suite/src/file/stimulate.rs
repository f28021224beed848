//! What the bench does to the device, by the key that says what.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::code;
use crate::model::{CompanionStimulus, PowerAction, Stimulate};
use crate::problem::Wrong;
use crate::read_with::optional_time;
use crate::scalar::Time;

/// A stimulus: `{power: off}`, `{process-value: .., to: ..}`, `{condition: .., active: ..}` or `{setting: .., to: ..}`;
/// with `companion` the first two of them, done to what the tester plays on that port.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Stimulate")]
pub(crate) struct StimulateFile {
    /// The port whose companion this is done to, and not the device: the inverter behind a gateway.
    #[serde(default)]
    companion: Option<String>,
    /// Power off and on.
    #[serde(default)]
    power: Option<PowerAction>,
    /// A value that the device measures, by name.
    #[serde(default)]
    process_value: Option<String>,
    /// A condition of the device, by name; ended after the case.
    #[serde(default)]
    condition: Option<String>,
    /// A switch of the device, by name.
    #[serde(default)]
    setting: Option<String>,
    /// The value of a process value or a setting.
    #[serde(default)]
    to: Option<i64>,
    /// Whether the condition holds from now on.
    #[serde(default)]
    active: Option<bool>,
    /// How long giving a process value may take, where what comes next depends on it.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
}

impl TryFrom<StimulateFile> for Stimulate {
    type Error = Wrong;

    fn try_from(file: StimulateFile) -> Result<Stimulate, Wrong> {
        let StimulateFile {
            companion,
            power,
            process_value,
            condition,
            setting,
            to,
            active,
            within,
        } = file;
        if within.is_some() && (process_value.is_none() || companion.is_some()) {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "`within` belongs to a process value",
                "expected it beside `process-value`",
            ));
        }
        if let Some(port) = companion {
            let stimulus = match (power, process_value, condition, setting, to, active) {
                (Some(action), None, None, None, None, None) => CompanionStimulus::Power(action),
                (None, Some(name), None, None, Some(to), None) => {
                    CompanionStimulus::ProcessValue { name, to }
                }
                _ => {
                    return Err(Wrong::new(
                        code::KEYS_TOGETHER,
                        "this is not one stimulus of a companion",
                        "expected `power`, or `process-value` with `to`",
                    ));
                }
            };
            return Ok(Stimulate::Companion { port, stimulus });
        }
        match (power, process_value, condition, setting, to, active) {
            (Some(action), None, None, None, None, None) => Ok(Stimulate::Power(action)),
            (None, Some(name), None, None, Some(to), None) => {
                Ok(Stimulate::ProcessValue { name, to, within })
            }
            (None, None, Some(name), None, None, Some(active)) => {
                Ok(Stimulate::Condition { name, active })
            }
            (None, None, None, Some(name), Some(to), None) => Ok(Stimulate::Setting { name, to }),
            _ => Err(Wrong::new(
                code::KEYS_TOGETHER,
                "this is not one stimulus",
                "expected `power`, `process-value` with `to`, `condition` with `active`, or `setting` with `to`",
            )),
        }
    }
}
