//! The ways of writing that serde has no word for: a thing with its place, one or many, a short form beside a map.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{
    Deserialize, DeserializeOwned, Deserializer, Error, MapAccess, SeqAccess, Visitor,
};

use crate::Position;
use crate::model::Located;
use crate::read::ask;

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple_struct(ask::LOCATED, 2, LocatedVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Located<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

struct LocatedVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for LocatedVisitor<T> {
    type Value = Located<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value with its place")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Located<T>, A::Error> {
        let place: Option<(u32, u32, u32)> = access.next_element()?;
        let (line, column, end_column) = place.unwrap_or_default();
        let Some(value) = access.next_element()? else {
            return Err(A::Error::custom("a place without a value"));
        };
        let at = Position {
            line,
            column,
            end_column,
        };
        Ok(Located { value, at })
    }
}

/// One thing, or a list of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OneOrMany<T>(pub(crate) Vec<T>);

impl<T> Default for OneOrMany<T> {
    fn default() -> OneOrMany<T> {
        OneOrMany(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(ask::ONE_OR_MANY, OneOrManyVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("OneOrMany_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        json_schema!({"anyOf": [one, {"type": "array", "items": one}]})
    }
}

struct OneOrManyVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrManyVisitor<T> {
    type Value = OneOrMany<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("one value or a list")
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, one: D) -> Result<OneOrMany<T>, D::Error> {
        T::deserialize(one).map(|one| OneOrMany(vec![one]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<OneOrMany<T>, A::Error> {
        let mut many = Vec::new();
        while let Some(one) = access.next_element()? {
            many.push(one);
        }
        Ok(OneOrMany(many))
    }
}

/// Has a short form, which is not a map, beside its map.
pub(crate) trait TwoForms: Sized {
    /// What stands for it when there is no need for a map.
    type Short: DeserializeOwned + JsonSchema;
    /// The map.
    type Full: DeserializeOwned + JsonSchema;

    fn from_short(short: Self::Short) -> Self;
    fn from_full(full: Self::Full) -> Self;
}

/// Reads either form. For `deserialize_with`.
pub(crate) fn either<'de, D: Deserializer<'de>, T: TwoForms>(
    deserializer: D,
) -> Result<T, D::Error> {
    Either::deserialize(deserializer).map(|either| either.0)
}

/// The schema of either form. For `schema_with`.
pub(crate) fn either_schema<T: TwoForms>(generator: &mut SchemaGenerator) -> Schema {
    Either::<T>::json_schema(generator)
}

/// Something that is read in either form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Either<T>(pub(crate) T);

impl<'de, T: TwoForms> Deserialize<'de> for Either<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(ask::TWO_FORMS, EitherVisitor(PhantomData))
    }
}

impl<T: TwoForms> JsonSchema for Either<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Either_{}", T::Full::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let short = generator.subschema_for::<T::Short>();
        let full = generator.subschema_for::<T::Full>();
        json_schema!({"anyOf": [short, full]})
    }
}

struct EitherVisitor<T>(PhantomData<T>);

impl<'de, T: TwoForms> Visitor<'de> for EitherVisitor<T> {
    type Value = Either<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value or a map")
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, short: D) -> Result<Either<T>, D::Error> {
        T::Short::deserialize(short).map(|short| Either(T::from_short(short)))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Either<T>, A::Error> {
        let full = T::Full::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Either(T::from_full(full)))
    }
}

/// The schema of a type that is read from another, which is what a file holds.
macro_rules! schema_of {
    ($($type:ty: $file:ty),+ $(,)?) => {
        $(impl schemars::JsonSchema for $type {
            fn inline_schema() -> bool {
                <$file>::inline_schema()
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                <$file>::schema_name()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                <$file>::json_schema(generator)
            }
        })+
    };
}
pub(crate) use schema_of;
