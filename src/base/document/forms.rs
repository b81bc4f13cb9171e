//! Values that a scene may write in several forms: as a number, a word, a list or a table.

use serde::Deserializer;
use serde::de::{Error, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt::{self, Debug, Formatter};
use std::marker::PhantomData;

/// A value of several forms. A form that it does not declare is refused.
pub(crate) trait Forms: Sized {
    /// What is expected, in words.
    const EXPECTED: &'static str;

    /// What a number means, as it is written.
    fn number<E: Error>(_number: f64, written: Unexpected) -> Result<Self, E> {
        Err(E::invalid_type(written, &Self::EXPECTED))
    }

    /// What a word means.
    fn word<E: Error>(word: &str) -> Result<Self, E> {
        Err(E::invalid_type(Unexpected::Str(word), &Self::EXPECTED))
    }

    /// What a list means.
    fn list<'de, A: SeqAccess<'de>>(_list: A) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Seq, &Self::EXPECTED))
    }

    /// What a table means.
    fn table<'de, A: MapAccess<'de>>(_table: A) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Map, &Self::EXPECTED))
    }

    /// Why something of a form that it has is refused.
    fn refused<E: Error>(found: impl Debug) -> E {
        E::custom(format!("expected {}, found {found:?}", Self::EXPECTED))
    }
}

/// Takes each form.
struct AnyForm<T>(PhantomData<T>);

impl<'de, T: Forms> Visitor<'de> for AnyForm<T> {
    type Value = T;

    fn expecting(&self, formatter: &mut Formatter) -> fmt::Result {
        formatter.write_str(T::EXPECTED)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        T::number(value, Unexpected::Float(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        T::number(value as f64, Unexpected::Signed(value))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<T, E> {
        T::word(word)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<T, A::Error> {
        T::list(list)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<T, A::Error> {
        T::table(table)
    }
}

/// Reads a value of several forms.
pub(crate) fn any_form<'de, T: Forms, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    deserializer.deserialize_any(AnyForm(PhantomData))
}

/// Lets a type with [`Forms`] be that of a key.
macro_rules! several_forms {
    ($type:ty) => {
        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::base::document::any_form(deserializer)
            }
        }
    };
}
pub(crate) use several_forms;
