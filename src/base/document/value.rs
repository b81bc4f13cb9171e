//! From parsed TOML to typed values.
//!
//! Values are read by reference. The `toml` crate's own reader takes them apart, and what the compiler makes of that for each
//! type costs a tenth of the time in which the program is built.

use super::single::{Error, Number, number, of_another_type};
use serde::de::{
    self, DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// Reads a value into a type.
pub(super) fn read<T: DeserializeOwned>(value: &Spanned<DeValue>) -> Result<T, Error> {
    T::deserialize(Value(value))
}

/// A value and its place.
///
/// What is asked for a table, a list or a text gives nothing else: were each of them to take whatever is there, the code of
/// every type would be made for all of these, most of which it refuses.
#[derive(Clone, Copy)]
struct Value<'de>(&'de Spanned<DeValue<'de>>);

impl<'de> Deserializer<'de> for Value<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let read = match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(_) | DeValue::Float(_) => number(self.0.get_ref()).and_then(|number| match number {
                Number::Integer(number) => visitor.visit_i64(number),
                Number::Large(number) => visitor.visit_u64(number),
                Number::Huge(number) => visitor.visit_i128(number),
                Number::Real(number) => visitor.visit_f64(number),
            }),
            DeValue::Boolean(is_true) => visitor.visit_bool(*is_true),
            DeValue::Datetime(_) => Err(de::Error::invalid_type(Unexpected::Other("a date"), &visitor)),
            DeValue::Array(list) => visitor.visit_seq(List(list.iter())),
            DeValue::Table(table) => visitor.visit_map(Table { rest: table.iter(), value: None }),
        };
        read.map_err(|error| error.at(self.0.span()))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0.get_ref() {
            DeValue::Table(table) => visitor.visit_map(Table { rest: table.iter(), value: None }),
            _ => Err(of_another_type(self.0.get_ref(), &visitor)),
        }
        .map_err(|error| error.at(self.0.span()))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_map(visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0.get_ref() {
            DeValue::Array(list) => visitor.visit_seq(List(list.iter())),
            _ => Err(of_another_type(self.0.get_ref(), &visitor)),
        }
        .map_err(|error| error.at(self.0.span()))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Error> {
        // What reads so many entries takes no notice of further ones.
        match self.0.get_ref() {
            DeValue::Array(list) if list.len() != length => {
                let error: Error = de::Error::custom(format!("expected {length} entries, found {}", list.len()));
                Err(error.at(self.0.span()))
            }
            _ => self.deserialize_seq(visitor),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            _ => Err(of_another_type(self.0.get_ref(), &visitor)),
        }
        .map_err(|error| error.at(self.0.span()))
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let refused = |message| Err(de::Error::custom(message));
        let read = match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_enum(text.as_ref().into_deserializer()),
            DeValue::Table(table) => match (table.iter().next(), table.len()) {
                (Some((key, value)), 1) => visitor.visit_enum(Entry { key, value: Self(value) }),
                (None, _) => refused("wanted exactly 1 element, found 0 elements"),
                _ => refused("wanted exactly 1 element, more than 1 element"),
            },
            _ => refused("wanted string or table"),
        };
        read.map_err(|error| error.at(self.0.span()))
    }

    serde::forward_to_deserialize_any! {
        bool u8 u16 u32 u64 u128 i8 i16 i32 i64 i128 f32 f64 char bytes byte_buf unit ignored_any unit_struct tuple_struct
        identifier
    }
}

/// The entries of a list.
struct List<'de>(std::slice::Iter<'de, Spanned<DeValue<'de>>>);

impl<'de> SeqAccess<'de> for List<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.0.next().map(|value| seed.deserialize(Value(value))).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The keys and values of a table.
struct Table<'de> {
    /// Those that are not read yet.
    rest: <&'de DeTable<'de> as IntoIterator>::IntoIter,
    /// The value whose key has been read.
    value: Option<&'de Spanned<DeValue<'de>>>,
}

impl<'de> MapAccess<'de> for Table<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        read_key(key, seed).map(Some)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Error> {
        match self.value.take() {
            Some(value) => seed.deserialize(Value(value)).map_err(|error| error.at(value.span())),
            None => Err(de::Error::custom("a value without a key")),
        }
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// Reads a key.
fn read_key<'de, K: DeserializeSeed<'de>>(key: &'de Spanned<DeString<'de>>, seed: K) -> Result<K::Value, Error> {
    let text: de::value::StrDeserializer<Error> = key.get_ref().as_ref().into_deserializer();
    seed.deserialize(text).map_err(|error| error.at(key.span()))
}

/// The only entry of a table: one of several choices with what belongs to it.
struct Entry<'de> {
    /// The choice.
    key: &'de Spanned<DeString<'de>>,
    /// What belongs to it.
    value: Value<'de>,
}

impl<'de> EnumAccess<'de> for Entry<'de> {
    type Error = Error;
    type Variant = Value<'de>;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Value<'de>), Error> {
        Ok((read_key(self.key, seed)?, self.value))
    }
}

impl<'de> VariantAccess<'de> for Value<'de> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        match self.0.get_ref() {
            DeValue::Table(table) if table.is_empty() => Ok(()),
            DeValue::Table(_) => Err(de::Error::custom("expected empty table")),
            other => Err(de::Error::custom(format!("expected table, found {}", other.type_str()))),
        }
        .map_err(|error: Error| error.at(self.0.span()))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.deserialize_map(visitor)
    }
}
