//! What the scalars have in common: each is parsed from one text.

use std::fmt;
use std::marker::PhantomData;

use schemars::Schema;
use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::problem::Wrong;
use crate::read::ask;

/// Parsed from one text.
pub(crate) trait Text: Sized {
    /// In which of its ways the reader gives the text.
    const ASK: &'static str = ask::TEXT;
    /// `a duration such as 50 ms`
    const EXPECTED: &'static str;

    fn parse(text: &str) -> Result<Self, Wrong>;

    fn schema() -> Schema;
}

/// Reads a [`Text`].
pub(crate) struct OneText<T>(pub(crate) T);

impl<'de, T: Text> Deserialize<'de> for OneText<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer
            .deserialize_newtype_struct(T::ASK, TextVisitor(PhantomData))
            .map(OneText)
    }
}

struct TextVisitor<T>(PhantomData<T>);

impl<T: Text> Visitor<'_> for TextVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        T::parse(text).map_err(E::custom)
    }
}

/// `Deserialize` and `JsonSchema` for a [`Text`].
macro_rules! read_as_text {
    ($($type:ty),+ $(,)?) => {
        $(impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::scalar::OneText::deserialize(deserializer).map(|read| read.0)
            }
        }

        impl schemars::JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                <$type as $crate::scalar::Text>::schema()
            }
        })+
    };
}
pub(crate) use read_as_text;
