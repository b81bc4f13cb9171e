//! Lists of numbers as bytes, at the speed of a copy: what a snapshot mostly consists of.
//!
//! For `#[serde(with = "plain")]`. Numbers are little-endian whatever the machine.

use super::Row;
use serde::de::{Error, Visitor};
use serde::{Deserializer, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// Something of fixed length in bytes, which in memory stands as little-endian machines write it.
pub(super) trait Plain: bytemuck::Pod {
    /// How many bytes.
    const SIZE: usize;

    /// Writes them.
    fn put(&self, bytes: &mut [u8]);

    /// Reads them.
    fn take(bytes: &[u8]) -> Self;
}

/// A number of the language.
macro_rules! number {
    ($($type:ty),*) => {
        $(impl Plain for $type {
            const SIZE: usize = size_of::<$type>();

            #[inline(always)]
            fn put(&self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_le_bytes());
            }

            #[inline(always)]
            fn take(bytes: &[u8]) -> Self {
                let mut number = [0; size_of::<$type>()];
                number.copy_from_slice(bytes);
                Self::from_le_bytes(number)
            }
        })*
    };
}

number!(u8, u32, f64);

impl Plain for Row {
    const SIZE: usize = 32;

    #[inline(always)]
    fn put(&self, bytes: &mut [u8]) {
        for (number, bytes) in self.iter().zip(bytes.chunks_exact_mut(8)) {
            number.put(bytes);
        }
    }

    #[inline(always)]
    fn take(bytes: &[u8]) -> Self {
        let mut row = [0.0; 4];
        for (number, bytes) in row.iter_mut().zip(bytes.chunks_exact(8)) {
            *number = f64::take(bytes);
        }
        row
    }
}

impl Plain for [u32; 2] {
    const SIZE: usize = 8;

    #[inline(always)]
    fn put(&self, bytes: &mut [u8]) {
        self[0].put(&mut bytes[..4]);
        self[1].put(&mut bytes[4..]);
    }

    #[inline(always)]
    fn take(bytes: &[u8]) -> Self {
        [u32::take(&bytes[..4]), u32::take(&bytes[4..])]
    }
}

/// Writes a list as bytes; where its memory has them already, without a copy.
pub(super) fn serialize<T: Plain, S: Serializer>(list: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    if cfg!(target_endian = "little") {
        return serializer.serialize_bytes(bytemuck::cast_slice(list));
    }
    let mut bytes = vec![0; list.len() * T::SIZE];
    for (item, bytes) in list.iter().zip(bytes.chunks_exact_mut(T::SIZE)) {
        item.put(bytes);
    }
    serializer.serialize_bytes(&bytes)
}

/// Reads it back.
pub(super) fn deserialize<'a, T: Plain, D: Deserializer<'a>>(deserializer: D) -> Result<Vec<T>, D::Error> {
    deserializer.deserialize_bytes(Bytes(PhantomData))
}

/// Takes the bytes of a list.
struct Bytes<T>(PhantomData<T>);

impl<T: Plain> Visitor<'_> for Bytes<T> {
    type Value = Vec<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "bytes, {} for each item: {}", T::SIZE, std::any::type_name::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(T::SIZE) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        if cfg!(target_endian = "little") {
            return Ok(bytemuck::pod_collect_to_vec(bytes));
        }
        Ok(bytes.chunks_exact(T::SIZE).map(T::take).collect())
    }
}

/// Lists of lists, each as bytes. For `#[serde(with = "plain::lists")]`.
pub(super) mod lists {
    use super::Plain;
    use serde::ser::SerializeSeq;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// One of the lists, to be written.
    struct Written<'a, T>(&'a [T]);

    impl<T: Plain> Serialize for Written<'_, T> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            super::serialize(self.0, serializer)
        }
    }

    /// One of the lists, read.
    struct Read<T>(Vec<T>);

    impl<'a, T: Plain> Deserialize<'a> for Read<T> {
        fn deserialize<D: Deserializer<'a>>(deserializer: D) -> Result<Self, D::Error> {
            super::deserialize(deserializer).map(Self)
        }
    }

    /// Writes the lists.
    pub(in crate::engine::state) fn serialize<T: Plain, S: Serializer>(
        lists: &[Vec<T>],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut sequence = serializer.serialize_seq(Some(lists.len()))?;
        for list in lists {
            sequence.serialize_element(&Written(list))?;
        }
        sequence.end()
    }

    /// Reads them back.
    pub(in crate::engine::state) fn deserialize<'a, T: Plain, D: Deserializer<'a>>(
        deserializer: D,
    ) -> Result<Vec<Vec<T>>, D::Error> {
        let lists = Vec::<Read<T>>::deserialize(deserializer)?;
        Ok(lists.into_iter().map(|Read(list)| list).collect())
    }
}
