//! The parts of lists, maps and enums, one by one.

use serde::de::value::{SeqDeserializer, StrDeserializer};
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, MapAccess, SeqAccess,
    VariantAccess, Visitor,
};

use super::Reader;
use crate::node::{Entry, Node};
use crate::problem::ReadError;

pub(super) struct ListAccess<'a> {
    pub(super) list: Reader<'a>,
    pub(super) elements: std::slice::Iter<'a, Node>,
}

impl<'de> SeqAccess<'de> for ListAccess<'_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, ReadError> {
        let Some(node) = self.elements.next() else {
            return Ok(None);
        };
        let reader = self.list.inside(node, node.at);
        reader.placed(self.list.scope.spend(1).map_err(ReadError))?;
        reader.placed(seed.deserialize(reader)).map(Some)
    }
}

pub(super) struct LocatedAccess<'a> {
    pub(super) reader: Reader<'a>,
    pub(super) done: u8,
}

impl<'de> SeqAccess<'de> for LocatedAccess<'_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, ReadError> {
        self.done += 1;
        let at = self.reader.node.at;
        match self.done {
            1 => {
                let numbers = [at.line, at.column, at.end_column];
                seed.deserialize(SeqDeserializer::new(numbers.into_iter()))
                    .map(Some)
            }
            2 => seed.deserialize(self.reader).map(Some),
            _ => Ok(None),
        }
    }
}

pub(super) struct EntriesAccess<'a> {
    pub(super) map: Reader<'a>,
    pub(super) entries: std::slice::Iter<'a, Entry>,
    pub(super) value: Option<&'a Entry>,
}

impl<'de> MapAccess<'de> for EntriesAccess<'_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, ReadError> {
        let Some(entry) = self.entries.next() else {
            return Ok(None);
        };
        self.value = Some(entry);
        read_key(self.map, entry, seed).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        match self.value.take() {
            Some(entry) => {
                let reader = self.map.inside(&entry.value, entry.key.at);
                reader.placed(self.map.scope.spend(1).map_err(ReadError))?;
                reader.placed(seed.deserialize(reader))
            }
            None => Err(ReadError::custom("a value without a key")),
        }
    }
}

fn read_key<'de, K: DeserializeSeed<'de>>(
    map: Reader<'_>,
    entry: &Entry,
    seed: K,
) -> Result<K::Value, ReadError> {
    let key: StrDeserializer<'_, ReadError> = entry.key.text.as_ref().into_deserializer();
    seed.deserialize(key).map_err(|mut error| {
        if error.0.at.is_none() {
            error.0.at = Some(entry.key.at);
            error.0.template = map.template;
        }
        error
    })
}

pub(super) struct EntryAccess<'a> {
    pub(super) map: Reader<'a>,
    pub(super) entry: &'a Entry,
}

impl<'de, 'a> EnumAccess<'de> for EntryAccess<'a> {
    type Error = ReadError;
    type Variant = Reader<'a>;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Reader<'a>), ReadError> {
        let variant = read_key(self.map, self.entry, seed)?;
        let reader = self.map.inside(&self.entry.value, self.entry.key.at);
        Ok((variant, reader))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        serde::Deserialize::deserialize(self)
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, ReadError> {
        self.placed(seed.deserialize(self))
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        _len: usize,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        self.deserialize_seq(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        self.deserialize_struct("", fields, visitor)
    }
}
