//! How fields whose types serde knows in another way are read: for `deserialize_with`.

use std::fmt::Display;
use std::time::Duration;

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny};

use crate::code;
use crate::file::{DecodeFile, ModbusException};
use crate::forms::OneOrMany;
use crate::model::{Decode, Located};
use crate::problem::Wrong;
use crate::scalar::{BitRate, Bytes, CanId, Time};

pub(crate) fn time<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Duration, D::Error> {
    Time::deserialize(deserializer).map(|time| time.0)
}

pub(crate) fn optional_time<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Duration>, D::Error> {
    let time = Option::<Time>::deserialize(deserializer)?;
    Ok(time.map(|time| time.0))
}

pub(crate) fn one_or_many<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Vec<T>, D::Error> {
    OneOrMany::deserialize(deserializer).map(|many| many.0)
}

pub(crate) fn bit_rate<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    BitRate::deserialize(deserializer).map(|rate| rate.0)
}

pub(crate) fn can_ids<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u16>, D::Error> {
    let ids = OneOrMany::<CanId>::deserialize(deserializer)?;
    Ok(ids.0.into_iter().map(|id| id.0).collect())
}

pub(crate) fn exceptions<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
    let exceptions = OneOrMany::<ModbusException>::deserialize(deserializer)?;
    Ok(exceptions.0.into_iter().map(|code| code.0).collect())
}

/// Of Modbus bytes, high byte first unless it says otherwise.
pub(crate) fn decode_big_endian<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<Decode>, D::Error> {
    let decode = OneOrMany::<DecodeFile>::deserialize(deserializer)?;
    Ok(decode.0.into_iter().map(|one| one.lower(true)).collect())
}

pub(crate) fn optional_pdo_number<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<u8>, D::Error> {
    let number = Option::<u8>::deserialize(deserializer)?;
    number.map(|number| within(number, 1, 4)).transpose()
}

pub(crate) fn optional_pdo_data<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Bytes>, D::Error> {
    let bytes = match Option::<Bytes>::deserialize(deserializer)? {
        Some(bytes) if bytes.0.len() > 8 => bytes,
        few => return Ok(few),
    };
    Err(D::Error::custom(Wrong::new(
        code::BYTES,
        format!("{} bytes, and a PDO has at most 8", bytes.0.len()),
        "expected at most 8 bytes",
    )))
}

pub(crate) fn node<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    within(u8::deserialize(deserializer)?, 1, 127)
}

pub(crate) fn address<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    within(u8::deserialize(deserializer)?, 1, 247)
}

pub(crate) fn located_node<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Located<u8>>, D::Error> {
    located_within(deserializer, 1, 127)
}

pub(crate) fn located_address<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Located<u8>>, D::Error> {
    located_within(deserializer, 1, 247)
}

fn located_within<'de, D: Deserializer<'de>>(
    deserializer: D,
    low: u8,
    high: u8,
) -> Result<Option<Located<u8>>, D::Error> {
    let number = Option::<Located<u8>>::deserialize(deserializer)?;
    number
        .map(|Located { value, at }| {
            Ok(Located {
                value: within(value, low, high)?,
                at,
            })
        })
        .transpose()
}

pub(crate) fn optional_node<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<u8>, D::Error> {
    let node = Option::<u8>::deserialize(deserializer)?;
    node.map(|node| within(node, 1, 127)).transpose()
}

pub(crate) fn optional_address<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<u8>, D::Error> {
    let address = Option::<u8>::deserialize(deserializer)?;
    address.map(|address| within(address, 1, 247)).transpose()
}

/// How many registers are alike.
pub(crate) fn ten_thousand<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<u16>, D::Error> {
    let count = Option::<u16>::deserialize(deserializer)?;
    count.map(|count| within(count, 1, 10_000)).transpose()
}

/// How often a `repeat` is played.
pub(crate) fn times<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    within(u32::deserialize(deserializer)?, 1, 1_000_000)
}

pub(crate) fn flood_frames<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    within(u32::deserialize(deserializer)?, 1, 10_000)
}

/// A list whose elements are read one by one elsewhere; here only that it is there.
pub(crate) fn read_later<'de, D: Deserializer<'de>, T>(
    deserializer: D,
) -> Result<Vec<T>, D::Error> {
    IgnoredAny::deserialize(deserializer).map(|_| Vec::new())
}

fn within<N: Copy + PartialOrd + Display, E: Error>(number: N, low: N, high: N) -> Result<N, E> {
    if (low..=high).contains(&number) {
        return Ok(number);
    }
    Err(E::custom(Wrong::new(
        code::NUMBER,
        format!("{number} is out of range"),
        format!("expected {low} to {high}"),
    )))
}

/// How many heartbeats or PDOs are measured where the case does not say.
pub(crate) fn ten() -> u32 {
    10
}
