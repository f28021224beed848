//! A serde deserializer over the positioned tree: it replaces placeholders on the way, and gives every mistake its
//! place.
//!
//! A scalar has no type of its own here: `100`, `0x64` and `64h` are one number to a field that wants a number, and
//! `4.10` is a section to a field that wants a text.

mod access;

use std::borrow::Cow;

use access::{EntriesAccess, EntryAccess, ListAccess, LocatedAccess};
use serde::de::value::StrDeserializer;
use serde::de::{Deserializer, Error as _, Unexpected, Visitor};

use crate::expand::{Notation, Scope, show_at_cell, whole};
use crate::node::{Entry, Kind, Node};
use crate::problem::{Problem, ReadError};
use crate::scalar::whole_number;
use crate::{Position, code};

/// Names by which a type asks for something serde has no word for.
pub(crate) mod ask {
    /// A text.
    pub(crate) const TEXT: &str = "$text";
    /// A text in which the node-ID is written as two hexadecimal digits.
    pub(crate) const HEX: &str = "$hex";
    /// A text that may be `{name}` of a saved value.
    pub(crate) const SAVEABLE: &str = "$saveable";
    /// A map goes to `visit_map`, anything else to `visit_newtype_struct`.
    pub(crate) const TWO_FORMS: &str = "$two-forms";
    /// A list goes to `visit_seq`, anything else to `visit_newtype_struct`.
    pub(crate) const ONE_OR_MANY: &str = "$one-or-many";
    /// A tuple of the place and the thing.
    pub(crate) const LOCATED: &str = "$located";
}

/// Reads one node.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    node: &'a Node,
    scope: &'a Scope<'a>,
    /// The key this is the value of; where a missing key is shown.
    head: Position,
    /// The placeholder in the case, when `node` is in a row of its table.
    template: Option<Position>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(node: &'a Node, scope: &'a Scope<'a>, head: Position) -> Reader<'a> {
        match scope.cell(node) {
            Some(cell) => Reader {
                node: cell,
                scope,
                head: cell.at,
                template: Some(node.at),
            },
            None => Reader {
                node,
                scope,
                head,
                template: None,
            },
        }
    }

    /// A part of this node.
    fn inside(&self, node: &'a Node, head: Position) -> Reader<'a> {
        match self.template {
            Some(_) => Reader {
                node,
                head,
                ..*self
            },
            None => Reader::new(node, self.scope, head),
        }
    }

    fn in_cell(&self) -> bool {
        self.template.is_some()
    }

    /// Gives a problem the place of this node, unless it has one.
    fn placed<T>(&self, result: Result<T, ReadError>) -> Result<T, ReadError> {
        result.map_err(|mut error| {
            let problem = &mut error.0;
            if problem.at.is_none() {
                let text = self.node.text().unwrap_or_default();
                problem.at = Some(self.node.at);
                problem.template = self.template;
                if !self.in_cell()
                    && problem.code != code::UNKNOWN_PLACEHOLDER
                    && let Some(cell) = self.scope.first_cell(text)
                {
                    show_at_cell(problem, cell.at, self.node.at);
                }
                if problem.code == code::MISSING_KEY {
                    problem.at = Some(self.head);
                }
            }
            error
        })
    }

    fn text(&self, notation: Notation) -> Result<Cow<'a, str>, ReadError> {
        match &self.node.kind {
            Kind::Text(text) => Ok(self.scope.replace(text, notation, self.in_cell())?),
            _ => Err(ReadError::invalid_type(self.unexpected(), &"a text")),
        }
    }

    fn saveable_text(&self) -> Result<Cow<'a, str>, ReadError> {
        let text = self.node.text().unwrap_or_default();
        match whole(text) {
            Some(name) if self.scope.saved.contains(name) => Ok(Cow::Borrowed(text)),
            _ => self.text(Notation::Text),
        }
    }

    fn unexpected(&self) -> Unexpected<'a> {
        match &self.node.kind {
            Kind::Empty => Unexpected::Unit,
            Kind::Text(text) => Unexpected::Str(text),
            Kind::List(_) => Unexpected::Seq,
            Kind::Map(_) => Unexpected::Map,
        }
    }

    /// Something else was expected here.
    fn mismatch<T>(&self, expected: &dyn serde::de::Expected) -> Result<T, ReadError> {
        let error = ReadError::invalid_type(self.unexpected(), expected);
        self.placed(Err(self.suspect_placeholder(error)))
    }

    /// `{name}` without quotes is a map with one key to YAML.
    fn suspect_placeholder(&self, mut error: ReadError) -> ReadError {
        if let [Entry { key, value }] = self.node.entries()
            && value.kind == Kind::Empty
            && key.at.column > self.node.at.column
        {
            let help = format!("a placeholder must stand in quotes: \"{{{}}}\"", key.text);
            error.0.help = Some(help);
        }
        error
    }

    fn visit_text<'de, V: Visitor<'de>>(
        &self,
        text: Result<Cow<'a, str>, ReadError>,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        if self.node.text().is_none() {
            return self.mismatch(&visitor);
        }
        self.placed(text.and_then(|text| visitor.visit_str(&text)))
    }

    fn whole_number(&self, low: i128, high: i128) -> Result<i128, ReadError> {
        if self.node.text().is_none() {
            return self.mismatch(&"a whole number");
        }
        let read = self.text(Notation::Text).and_then(|text| {
            let number = whole_number(&text).ok_or_else(|| {
                Problem::new(
                    code::NUMBER,
                    format!("`{text}` is not a whole number"),
                    "expected a number such as 100, 0x64 or 64h",
                )
            })?;
            if (low..=high).contains(&number) {
                return Ok(number);
            }
            Err(ReadError(Problem::new(
                code::NUMBER,
                format!("{number} is out of range"),
                format!("expected {low} to {high}"),
            )))
        });
        self.placed(read)
    }
}

macro_rules! numbers {
    ($($method:ident $visit:ident $type:ident;)+) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
            let number = self.whole_number($type::MIN.into(), $type::MAX.into())?;
            self.placed(visitor.$visit(number as $type))
        })+
    };
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = ReadError;

    numbers! {
        deserialize_i8 visit_i8 i8;
        deserialize_i16 visit_i16 i16;
        deserialize_i32 visit_i32 i32;
        deserialize_i64 visit_i64 i64;
        deserialize_u8 visit_u8 u8;
        deserialize_u16 visit_u16 u16;
        deserialize_u32 visit_u32 u32;
        deserialize_u64 visit_u64 u64;
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.node.kind {
            Kind::Empty => self.placed(visitor.visit_unit()),
            Kind::Text(_) => self.visit_text(self.text(Notation::Text), visitor),
            Kind::List(_) => self.deserialize_seq(visitor),
            Kind::Map(_) => self.deserialize_map(visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        if self.node.text().is_none() {
            return self.mismatch(&visitor);
        }
        let read = self
            .text(Notation::Text)
            .and_then(|text| match text.as_ref() {
                "true" => visitor.visit_bool(true),
                "false" => visitor.visit_bool(false),
                other => Err(ReadError::unknown_variant(other, &["true", "false"])),
            });
        self.placed(read)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit_text(self.text(Notation::Text), visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.node.kind {
            Kind::Empty => self.placed(visitor.visit_none()),
            _ => self.placed(visitor.visit_some(self)),
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.node.kind {
            Kind::Empty => self.placed(visitor.visit_unit()),
            _ => self.mismatch(&"nothing"),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match (name, &self.node.kind) {
            (ask::TEXT, _) => self.visit_text(self.text(Notation::Text), visitor),
            (ask::HEX, _) => self.visit_text(self.text(Notation::Hex), visitor),
            (ask::SAVEABLE, _) => self.visit_text(self.saveable_text(), visitor),
            (ask::TWO_FORMS, Kind::Map(_)) => self.deserialize_map(visitor),
            (ask::ONE_OR_MANY, Kind::List(_)) => self.deserialize_seq(visitor),
            _ => self.placed(visitor.visit_newtype_struct(self)),
        }
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _len: usize,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        if name == ask::LOCATED {
            return self.placed(visitor.visit_seq(LocatedAccess {
                reader: self,
                done: 0,
            }));
        }
        self.deserialize_seq(visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let Kind::List(elements) = &self.node.kind else {
            return self.mismatch(&visitor);
        };
        self.placed(visitor.visit_seq(ListAccess {
            list: self,
            elements: elements.iter(),
        }))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let Kind::Map(entries) = &self.node.kind else {
            return self.mismatch(&visitor);
        };
        self.placed(visitor.visit_map(EntriesAccess {
            map: self,
            entries: entries.iter(),
            value: None,
        }))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match self.node.kind {
            Kind::Map(_) => self.deserialize_map(visitor),
            _ => self.mismatch(&"a map"),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match &self.node.kind {
            Kind::Text(_) => self.placed(self.text(Notation::Text).and_then(|word| {
                visitor
                    .visit_enum(StrDeserializer::<ReadError>::new(&word))
                    .map_err(|error| {
                        // A word that is right and lacks what stands under it.
                        if variants.contains(&word.as_ref()) && error.0.code == code::WRONG_SHAPE {
                            return ReadError(Problem::new(
                                code::WRONG_SHAPE,
                                format!("`{word}` does not stand alone"),
                                format!("expected `{{{word}: ...}}`"),
                            ));
                        }
                        error
                    })
            })),
            Kind::Map(entries) => match entries.as_slice() {
                [entry] => self
                    .placed(visitor.visit_enum(EntryAccess { map: self, entry }))
                    .map_err(|error| self.suspect_placeholder(error)),
                _ => self.mismatch(&"a map with one key"),
            },
            _ => self.mismatch(&"a word"),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_unit()
    }

    serde::forward_to_deserialize_any! {
        i128 u128 f32 f64 char bytes byte_buf unit_struct tuple
    }
}
