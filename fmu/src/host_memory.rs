//! Memory of the host. It is read and written through raw pointers: what a host promises holds for the call alone, and
//! arrays may lie over each other.

use crate::refusal::Refusal;
use crate::types::{Reference, Text};
use std::ffi::{CStr, CString};

/// Memory of the host that results go to.
pub(crate) struct Target<T> {
    /// Where it begins.
    start: *mut T,
    /// How many items have room.
    length: usize,
}

impl<T: Copy> Target<T> {
    /// An array, which may be null if it has no items.
    ///
    /// # Safety
    /// `length` items may be written at `start`, if it is not null, while this lives.
    pub(crate) unsafe fn array(argument: &'static str, start: *mut T, length: usize) -> Result<Self, Refusal> {
        fits::<T>(argument, start.is_null(), length)?;
        Ok(Self { start, length })
    }

    /// One item.
    ///
    /// # Safety
    /// An item stands at `start`, if it is not null, and may be written while this lives.
    pub(crate) unsafe fn one(argument: &'static str, start: *mut T) -> Result<Self, Refusal> {
        // SAFETY: the caller's promise.
        unsafe { Self::array(argument, start, 1) }
    }

    /// How many items have room.
    pub(crate) fn len(&self) -> usize {
        self.length
    }

    /// Writes an item.
    pub(crate) fn put(&self, place: usize, item: T) {
        assert!(place < self.length, "an item beyond the host's array");
        // SAFETY: inside what may be written.
        unsafe { self.start.add(place).write_unaligned(item) };
    }

    /// Writes items from the first place on.
    pub(crate) fn put_all(&self, items: &[T]) {
        assert!(items.len() <= self.length, "items beyond the host's array");
        // SAFETY: inside what may be written; `copy` allows that both lie over each other.
        unsafe { self.start.cast::<u8>().copy_from(items.as_ptr().cast(), size_of_val(items)) };
    }

    /// Reads the first item, which the host has written.
    ///
    /// # Safety
    /// There is one.
    pub(crate) unsafe fn first(&self) -> T {
        // SAFETY: the caller's promise.
        unsafe { self.start.read_unaligned() }
    }
}

/// An array of the host that is read.
#[derive(Clone, Copy)]
pub(crate) struct Items<T> {
    /// Where it begins.
    start: *const T,
    /// How many items it has.
    length: usize,
}

impl<T: Copy> Items<T> {
    /// An array, which may be null if it has no items.
    ///
    /// # Safety
    /// `length` items stand at `start`, if it is not null, while this lives.
    pub(crate) unsafe fn new(argument: &'static str, start: *const T, length: usize) -> Result<Self, Refusal> {
        fits::<T>(argument, start.is_null(), length)?;
        Ok(Self { start, length })
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.length
    }

    /// The items.
    pub(crate) fn iter(self) -> impl Iterator<Item = T> + Clone {
        // SAFETY: inside what may be read.
        (0..self.length).map(move |place| unsafe { self.start.add(place).read_unaligned() })
    }
}

impl Items<Reference> {
    /// The references of FMI 2.0, which are the places of variables in the table.
    pub(crate) fn indices(self) -> impl Iterator<Item = usize> + Clone {
        self.iter().map(|reference| reference as usize)
    }
}

impl Items<u8> {
    /// The first so many, or all if there are fewer.
    pub(crate) fn first(self, most: usize) -> Vec<u8> {
        Self { length: self.length.min(most), ..self }.to_vec()
    }

    /// The bytes, copied.
    pub(crate) fn to_vec(self) -> Vec<u8> {
        let mut bytes = vec![0; self.length];
        // SAFETY: inside what may be read; the copy is new.
        unsafe { bytes.as_mut_ptr().copy_from(self.start, self.length) };
        bytes
    }
}

/// Elements of an array of more than one byte each: there are no more references.
const MOST: usize = u32::MAX as usize;

/// Whether an array can be.
fn fits<T>(argument: &'static str, is_null: bool, length: usize) -> Result<(), Refusal> {
    if length > 0 && is_null {
        return Err(Refusal::Null { argument });
    }
    let most = if size_of::<T>() > 1 { MOST } else { isize::MAX.unsigned_abs() };
    if length > most {
        return Err(Refusal::Length { argument, length });
    }
    Ok(())
}

/// A C string, copied; none if it is null.
///
/// # Safety
/// A string that ends in a zero stands at `text` if it is not null.
pub(crate) unsafe fn text(text: Text) -> Option<CString> {
    // SAFETY: the caller's promise.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_owned())
}

/// What can be read of a C string.
pub(crate) fn readable(text: CString) -> String {
    text.to_string_lossy().into_owned()
}

/// A C string that is UTF-8, as FMI 2.0 has it.
pub(crate) fn utf8(argument: &'static str, text: Option<CString>) -> Result<CString, Refusal> {
    let text = text.ok_or(Refusal::Null { argument })?;
    if text.to_str().is_ok() { Ok(text) } else { Err(Refusal::Utf8 { argument, text: readable(text) }) }
}
