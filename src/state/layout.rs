//! The layout of a type, as text: the names of its fields and what each holds.
//!
//! A type is asked to read itself from a reader that writes down what it is asked for. So the text changes with any field,
//! and no list of them has to be kept beside the type.

use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, EnumAccess, SeqAccess, VariantAccess, Visitor};
use std::fmt::{self, Display, Write};

/// The layout of a type.
pub(super) fn of<'a, T: Deserialize<'a>>() -> String {
    let mut text = String::new();
    // what cannot be described ends the text, which is then as good a mark as any
    if let Err(Unreadable(reason)) = T::deserialize(Writer(&mut text)) {
        text += &reason;
    }
    text
}

/// Why a type was not described.
#[derive(Debug)]
struct Unreadable(String);

impl Display for Unreadable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Unreadable {}

impl de::Error for Unreadable {
    fn custom<T: Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

/// Hands out zeros, one of each list, and writes down what it was asked for.
struct Writer<'a>(&'a mut String);

/// Hands out a number.
macro_rules! numbers {
    ($($ask:ident $give:ident $zero:expr;)*) => {
        $(fn $ask<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
            self.0.push_str(concat!(stringify!($give), " "));
            visitor.$give($zero)
        })*
    };
}

impl<'de> Deserializer<'de> for Writer<'_> {
    type Error = Unreadable;

    numbers! {
        deserialize_bool visit_bool false;
        deserialize_i8 visit_i8 0;
        deserialize_i16 visit_i16 0;
        deserialize_i32 visit_i32 0;
        deserialize_i64 visit_i64 0;
        deserialize_u8 visit_u8 0;
        deserialize_u16 visit_u16 0;
        deserialize_u32 visit_u32 0;
        deserialize_u64 visit_u64 0;
        deserialize_f32 visit_f32 0.0;
        deserialize_f64 visit_f64 0.0;
        deserialize_char visit_char '0';
        deserialize_str visit_str "";
        deserialize_string visit_str "";
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Unreadable> {
        Err(de::Error::custom("anything"))
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        let _ = write!(self.0, "({}) ", &visitor as &dyn de::Expected);
        visitor.visit_bytes(&[])
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        self.deserialize_bytes(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        self.0.push_str("option ");
        visitor.visit_some(self)
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        visitor.visit_unit()
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Unreadable> {
        self.0.push_str(name);
        visitor.visit_unit()
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        self.0.push_str(name);
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        self.0.push_str("list of ");
        visitor.visit_seq(Items { text: self.0, names: &[], next: 0, count: 1 })
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Unreadable> {
        let _ = write!(self.0, "{length} of ");
        visitor.visit_seq(Items { text: self.0, names: &[], next: 0, count: length })
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        self.0.push_str(name);
        self.deserialize_tuple(length, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Unreadable> {
        Err(de::Error::custom("a map"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        let _ = write!(self.0, "{name} {{ ");
        let value = visitor.visit_seq(Items { text: self.0, names: fields, next: 0, count: fields.len() });
        self.0.push_str("} ");
        value
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        let _ = write!(self.0, "{name} {variants:?} ");
        visitor.visit_enum(First(self.0))
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        visitor.visit_u64(0)
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unreadable> {
        visitor.visit_unit()
    }
}

/// The fields of a struct, or the items of a list.
struct Items<'a> {
    /// Where it is written down.
    text: &'a mut String,
    /// Names of the fields; none in a list.
    names: &'static [&'static str],
    /// Which is next.
    next: usize,
    /// How many there are.
    count: usize,
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Unreadable;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Unreadable> {
        if self.next == self.count {
            return Ok(None);
        }
        if let Some(name) = self.names.get(self.next) {
            let _ = write!(self.text, "{name}: ");
        }
        self.next += 1;
        seed.deserialize(Writer(self.text)).map(Some)
    }
}

/// The first variant of an enumeration.
struct First<'a>(&'a mut String);

impl<'de, 'a> EnumAccess<'de> for First<'a> {
    type Error = Unreadable;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Unreadable> {
        let value = seed.deserialize(de::value::U32Deserializer::<Unreadable>::new(0))?;
        Ok((value, self))
    }
}

impl<'de> VariantAccess<'de> for First<'_> {
    type Error = Unreadable;

    fn unit_variant(self) -> Result<(), Unreadable> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Unreadable> {
        seed.deserialize(Writer(self.0))
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Unreadable> {
        Writer(self.0).deserialize_tuple(length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unreadable> {
        Writer(self.0).deserialize_struct("", fields, visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::of;
    use crate::state::State;
    use serde::Deserialize;

    #[test]
    fn the_whole_state_is_described_to_its_last_field() {
        let text = of::<State>();
        for part in
            ["clock: Clock { time: visit_f64", "position: (bytes, 32 for each item: [f64; 4])", "near: NearParts {"]
        {
            assert!(text.contains(part), "{part} is missing in {text}");
        }
        assert!(
            text.contains("second: option visit_u32")
                && text.contains("history: History { of_each: visit_u32 all: (bytes, 32 for each"),
            "{text}"
        );
        assert!(text.ends_with("turnover: visit_f64 } } } "), "{text}");
    }

    #[test]
    fn another_field_name_type_or_order_is_another_layout() {
        macro_rules! layout {
            ($($name:ident: $type:ty),*) => {{
                #[derive(Deserialize)]
                #[expect(dead_code, reason = "only its layout is looked at")]
                struct Trial { $($name: $type),* }
                of::<Trial>()
            }};
        }
        let texts = [
            layout!(a: f64, b: u32),
            layout!(a: f64, c: u32),
            layout!(b: u32, a: f64),
            layout!(a: f64, b: u64),
            layout!(a: f64, b: Option<u32>),
            layout!(a: f64, b: Vec<u32>),
            layout!(a: f64),
        ];
        for (place, text) in texts.iter().enumerate() {
            assert!(!texts[..place].contains(text), "{text}");
        }
    }
}
