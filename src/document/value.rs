//! From parsed TOML to typed values.
//!
//! Values are read by reference. The `toml` crate's own reader takes them apart, and what the compiler makes of that for each
//! type costs a tenth of the time in which the program is built.

use serde::de::{
    self, DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// Why a value is not of the type that is wanted.
#[derive(Debug)]
pub(crate) struct Error {
    /// What serde says of it.
    message: String,
    /// Where it stands in the text \[bytes\].
    span: Option<Range<usize>>,
}

impl Error {
    /// What serde says of it.
    pub(super) fn message(&self) -> &str {
        &self.message
    }

    /// Where it stands in the text \[bytes\].
    pub(super) fn span(&self) -> Option<Range<usize>> {
        self.span.clone()
    }

    /// The same at this place, unless its place is known already: the innermost counts.
    #[cold]
    fn at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

impl de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None }
    }
}

/// Reads a value into a type.
pub(super) fn read<T: DeserializeOwned>(value: &Spanned<DeValue>) -> Result<T, Error> {
    T::deserialize(Value(value))
}

/// A value and its place.
#[derive(Clone, Copy)]
struct Value<'de>(&'de Spanned<DeValue<'de>>);

impl<'de> Value<'de> {
    /// The number that stands there.
    fn number(self) -> Result<Number, Error> {
        let overflow = |kind: &str| de::Error::custom(format!("{kind} number overflowed"));
        match self.0.get_ref() {
            DeValue::Integer(digits) => {
                let whole = i128::from_str_radix(digits.as_str(), digits.radix()).map_err(|_| overflow("integer"))?;
                let large = |_| u64::try_from(whole).map_or(Number::Huge(whole), Number::Large);
                Ok(i64::try_from(whole).map_or_else(large, Number::Integer))
            }
            DeValue::Float(digits) => {
                let number = digits.as_str().parse().unwrap_or(f64::INFINITY);
                let is_named = digits.as_str().ends_with("inf");
                if f64::is_infinite(number) && !is_named {
                    Err(overflow("floating-point"))
                } else {
                    Ok(Number::Real(number))
                }
            }
            _ => Err(de::Error::custom("wanted a number")),
        }
    }
}

/// A number of the text.
enum Number {
    /// A whole one.
    Integer(i64),
    /// A whole one above the largest signed one.
    Large(u64),
    /// A whole one beyond 64 bits: no key takes it.
    Huge(i128),
    /// Any other.
    Real(f64),
}

impl<'de> Deserializer<'de> for Value<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let read = match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(_) | DeValue::Float(_) => self.number().and_then(|number| match number {
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
        bool u8 u16 u32 u64 u128 i8 i16 i32 i64 i128 f32 f64 char str string seq bytes byte_buf map unit struct ignored_any
        unit_struct tuple_struct tuple identifier
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
        self.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }
}
