//! Many frames, drawn by chance.

use std::time::Duration;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::code;
use crate::forms::OneOrMany;
use crate::model::{Flood, IdRange};
use crate::problem::Wrong;
use crate::read::ask;
use crate::read_with::{flood_frames, optional_time};
use crate::scalar::{BytePatternText, PatternText, Text, Time, read_as_text};

/// What may never be hit: it changes every device on the bus.
const UNTOUCHED: [(u32, &str); 2] = [(0x000, "NMT"), (0x7E5, "LSS")];

/// Sends many frames drawn by chance, the same for the same seed.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Flood")]
pub(crate) struct FloodFile {
    /// How many, 1 to 10,000.
    #[serde(deserialize_with = "flood_frames")]
    #[schemars(range(min = 1, max = 10_000))]
    frames: u32,
    /// Their identifiers, three digits or eight: `080-6FF`, `00000000-1FFFFFFF`.
    ids: OneOrMany<IdRange>,
    /// The identifiers that are left out.
    #[serde(default)]
    except: OneOrMany<IdRange>,
    /// Whether they are remote frames.
    #[serde(default)]
    remote: bool,
    /// What their data are like, one of these: `E? ?? ??`; without it, anything of 0 to 8 bytes.
    #[serde(default)]
    data: OneOrMany<BytePatternText>,
    /// From one to the next; without it, as fast as the bus carries them.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    period: Option<Duration>,
    /// What chance begins with; 1 where nothing is said.
    #[serde(default)]
    seed: Option<u64>,
    /// What the device may answer, as often as it likes.
    #[serde(default)]
    answers: OneOrMany<PatternText>,
}

impl TryFrom<FloodFile> for Flood {
    type Error = Wrong;

    fn try_from(file: FloodFile) -> Result<Flood, Wrong> {
        let mut ids = file.ids.0;
        for except in file.except.0 {
            ids = ids.into_iter().flat_map(|it| it.without(except)).collect();
        }
        if ids.is_empty() {
            return Err(Wrong::new(
                code::EMPTY,
                "no identifier is left",
                "needs one",
            ));
        }
        let hit = |(id, _): &&(u32, &str)| ids.iter().any(|range| range.has_standard(*id));
        if let Some((id, name)) = UNTOUCHED.iter().find(hit).filter(|_| !file.remote) {
            let message = format!("a flood on {id:03X}h would be {name}, to every device");
            let wrong = Wrong::new(code::FRAME, message, "chance must not decide that");
            return Err(wrong.help(format!("leave it out: `except: \"{id:03X}\"`")));
        }
        if file.remote && !file.data.0.is_empty() {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "a remote frame has no data",
                "expected `remote` or `data`",
            ));
        }
        if file.data.0.iter().any(|data| data.0.len() > 8) {
            return Err(Wrong::new(
                code::BYTES,
                "a frame has at most 8 bytes",
                "expected at most 8 bytes",
            ));
        }
        Ok(Flood {
            frames: file.frames,
            ids,
            remote: file.remote,
            data: file.data.0,
            period: file.period,
            seed: file.seed.unwrap_or(1),
            answers: file.answers.0,
        })
    }
}

impl Text for IdRange {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "identifiers such as 080-6FF";

    fn parse(text: &str) -> Result<IdRange, Wrong> {
        let id = |digits: &str| {
            let highest = match digits.len() {
                3 => 0x7FF,
                8 => 0x1FFF_FFFF,
                _ => return None,
            };
            let hexadecimal = digits.chars().all(|it| it.is_ascii_hexdigit());
            let id = u32::from_str_radix(digits, 16).ok();
            id.filter(|id| hexadecimal && *id <= highest)
        };
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        match (id(first), id(last)) {
            (Some(from), Some(to)) if from <= to && first.len() == last.len() => Ok(IdRange {
                from,
                to,
                extended: first.len() == 8,
            }),
            _ => Err(Wrong::new(
                code::FRAME,
                format!("`{text}` is not identifiers"),
                "expected one or two of three hexadecimal digits up to 7FF, or of eight",
            )),
        }
    }

    fn schema() -> Schema {
        json_schema!({
            "type": ["string", "integer"],
            "pattern": "^([0-7][0-9A-Fa-f]{2}(-[0-7][0-9A-Fa-f]{2})?|[01][0-9A-Fa-f]{7}(-[01][0-9A-Fa-f]{7})?)$"
        })
    }
}

read_as_text!(IdRange);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_of_one_kind_and_in_order() {
        let range = |from, to, extended| Ok(IdRange { from, to, extended });
        assert_eq!(IdRange::parse("080-6FF"), range(0x080, 0x6FF, false));
        assert_eq!(IdRange::parse("60A"), range(0x60A, 0x60A, false));
        let extended = "00000000-1FFFFFFF";
        assert_eq!(IdRange::parse(extended), range(0, 0x1FFF_FFFF, true));
        for text in [
            "6FF-080",
            "000-800",
            "0-1",
            "080-00000700",
            "20000000",
            "+80",
            "",
            "-",
        ] {
            assert_eq!(
                IdRange::parse(text).map_err(|it| it.code),
                Err(code::FRAME),
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_excepted_splits_a_range() {
        let range = |text: &str| IdRange::parse(text).unwrap();
        for (whole, except, left) in [
            ("100-200", "180", vec!["100-17F", "181-200"]),
            ("100-200", "0FF-100", vec!["101-200"]),
            ("100-200", "100-7FF", vec![]),
            ("100-200", "201-7FF", vec!["100-200"]),
            ("100-200", "00000100-00000200", vec!["100-200"]),
        ] {
            let without: Vec<IdRange> = range(whole).without(range(except)).collect();
            let left: Vec<IdRange> = left.into_iter().map(range).collect();
            assert_eq!(without, left, "{whole} without {except}");
        }
    }
}
