//! Single values of a text: numbers, and what is said of a value that is not of the type which is wanted.

use serde::de::{self, Unexpected};
use std::fmt;
use std::ops::Range;
use toml::de::DeValue;

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
    pub(super) fn at(mut self, span: Range<usize>) -> Self {
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

/// A number of the text.
pub(super) enum Number {
    /// A whole one.
    Integer(i64),
    /// A whole one above the largest signed one.
    Large(u64),
    /// A whole one beyond 64 bits: no key takes it.
    Huge(i128),
    /// Any other.
    Real(f64),
}

/// The number that a value is.
pub(super) fn number(value: &DeValue) -> Result<Number, Error> {
    let overflow = |kind: &str| de::Error::custom(format!("{kind} number overflowed"));
    match value {
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

/// What is said of a value that is not of the type which is wanted.
#[cold]
pub(super) fn of_another_type(value: &DeValue, wanted: &dyn de::Expected) -> Error {
    let found = match value {
        DeValue::String(text) => Unexpected::Str(text),
        DeValue::Integer(_) | DeValue::Float(_) => match number(value) {
            Ok(Number::Integer(number)) => Unexpected::Signed(number),
            Ok(Number::Large(number)) => Unexpected::Unsigned(number),
            Ok(Number::Huge(number)) => {
                let found = format!("integer `{number}` as i128");
                return de::Error::invalid_type(Unexpected::Other(&found), wanted);
            }
            Ok(Number::Real(number)) => Unexpected::Float(number),
            Err(error) => return error,
        },
        DeValue::Boolean(is_true) => Unexpected::Bool(*is_true),
        DeValue::Datetime(_) => Unexpected::Other("a date"),
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::Table(_) => Unexpected::Map,
    };
    de::Error::invalid_type(found, wanted)
}
