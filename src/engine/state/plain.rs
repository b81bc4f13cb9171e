//! Lists of numbers as bytes, at the speed of a copy: what a snapshot mostly consists of.
//!
//! For `#[serde(with = "plain")]`. The bytes are those of the memory.

use bytemuck::Pod;
use serde::de::{Error, Visitor};
use serde::{Deserializer, Serializer};
use std::fmt;
use std::marker::PhantomData;

const _: () = assert!(cfg!(target_endian = "little"), "a saved state holds numbers as little-endian machines do");

/// Writes a list as bytes.
pub(super) fn serialize<T: Pod, S: Serializer>(list: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(bytemuck::cast_slice(list))
}

/// Reads it back.
pub(super) fn deserialize<'a, T: Pod, D: Deserializer<'a>>(deserializer: D) -> Result<Vec<T>, D::Error> {
    deserializer.deserialize_bytes(Bytes(PhantomData))
}

/// Takes the bytes of a list.
struct Bytes<T>(PhantomData<T>);

impl<T: Pod> Visitor<'_> for Bytes<T> {
    type Value = Vec<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "bytes, {} for each item: {}", size_of::<T>(), std::any::type_name::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        Ok(bytemuck::pod_collect_to_vec(bytes))
    }
}

/// Lists of lists, each as bytes. For `#[serde(with = "plain::lists")]`.
pub(super) mod lists {
    use bytemuck::Pod;
    use serde::ser::SerializeSeq;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// One of the lists, to be written.
    struct Written<'a, T>(&'a [T]);

    impl<T: Pod> Serialize for Written<'_, T> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            super::serialize(self.0, serializer)
        }
    }

    /// One of the lists, read.
    struct Read<T>(Vec<T>);

    impl<'a, T: Pod> Deserialize<'a> for Read<T> {
        fn deserialize<D: Deserializer<'a>>(deserializer: D) -> Result<Self, D::Error> {
            super::deserialize(deserializer).map(Self)
        }
    }

    /// Writes the lists.
    pub(in crate::engine::state) fn serialize<T: Pod, S: Serializer>(
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
    pub(in crate::engine::state) fn deserialize<'a, T: Pod, D: Deserializer<'a>>(
        deserializer: D,
    ) -> Result<Vec<Vec<T>>, D::Error> {
        let lists = Vec::<Read<T>>::deserialize(deserializer)?;
        Ok(lists.into_iter().map(|Read(list)| list).collect())
    }
}
