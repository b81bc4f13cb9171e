//! Arrays as bytes: plain or as base64, whole or in blocks that zlib or lz4 have packed (VTK's book of file formats, "VTK
//! XML formats" and "Data compression").

use super::Order;
use crate::base::memory;
use base64::Engine;
use base64::prelude::BASE64_STANDARD as STANDARD;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// Bytes that one byte packed by zlib can stand for at most; for lz4 it is 255.
const DENSEST: usize = 1032;

/// How blocks are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    /// By zlib.
    Zlib,
    /// By lz4.
    Lz4,
}

/// How a file stores its arrays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Storage {
    /// Bytes of a number in the head of an array.
    pub(super) word: usize,
    /// Order of bytes.
    pub(super) order: Order,
    /// How blocks are packed, if they are.
    pub(super) packing: Option<Packing>,
}

/// Bytes of a file that are read one after another.
pub(super) enum Stream<'a> {
    /// As they are.
    Raw(&'a [u8]),
    /// As base64, and what is decoded but not yet read. Parts that were encoded one by one may follow each other.
    Base64(&'a [u8], Vec<u8>),
}

impl<'a> Stream<'a> {
    /// The next so many bytes, if there are as many.
    fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        match self {
            Self::Raw(bytes) => {
                let (taken, rest) = bytes.split_at_checked(count)?;
                *bytes = rest;
                Some(taken.to_vec())
            }
            Self::Base64(text, ahead) => {
                if count > ahead.len() + text.len() {
                    return None;
                }
                while ahead.len() < count {
                    *text = decode(text, ahead)?;
                }
                let rest = ahead.split_off(count);
                Some(std::mem::replace(ahead, rest))
            }
        }
    }

    /// The stream from so many bytes of the file on.
    pub(super) fn from(&self, offset: usize) -> Option<Stream<'a>> {
        match self {
            Self::Raw(bytes) => bytes.get(offset..).map(Self::Raw),
            Self::Base64(text, _) => text.get(offset..).map(|text| Self::Base64(text, Vec::new())),
        }
    }

    /// How many bytes can follow at most.
    fn longest(&self) -> usize {
        match self {
            Self::Raw(bytes) => bytes.len(),
            Self::Base64(text, ahead) => text.len() + ahead.len(),
        }
    }
}

/// Decodes the next four letters of base64; hands out the text behind them.
fn decode<'a>(mut text: &'a [u8], into: &mut Vec<u8>) -> Option<&'a [u8]> {
    let (mut letters, mut bytes, mut count) = ([0; 4], [0; 3], 0);
    while count < letters.len() {
        let (letter, rest) = text.split_first()?;
        text = rest;
        if !letter.is_ascii_whitespace() {
            letters[count] = *letter;
            count += 1;
        }
    }
    let decoded = STANDARD.decode_slice(letters, &mut bytes).ok()?;
    into.extend_from_slice(&bytes[..decoded]);
    Some(text)
}

impl Storage {
    /// The bytes of an array, unpacked.
    pub(super) fn unpack(&self, stream: &mut Stream, name: &str) -> Result<Vec<u8>, String> {
        let short = || format!("an array {name} that is cut short or damaged");
        let number = |stream: &mut Stream| {
            let bytes = stream.take(self.word).ok_or_else(short)?;
            usize::try_from(self.order.word(&bytes)).map_err(|_| short())
        };
        let Some(packing) = self.packing else {
            let count = number(stream)?;
            return stream.take(count).ok_or_else(short);
        };
        let [blocks, size, last] = [number(stream)?, number(stream)?, number(stream)?];
        let stated = || format!("an array {name} that states {blocks} blocks of {size} bytes");
        if blocks.checked_mul(self.word).is_none_or(|length| length > stream.longest()) {
            return Err(stated());
        }
        // The last block is a whole one where its size is not stated.
        let size_of_last = if last > 0 { last } else { size };
        let whole = match blocks {
            0 => Some(0),
            _ => (blocks - 1).checked_mul(size).and_then(|before| before.checked_add(size_of_last)),
        };
        let whole = whole.filter(|whole| *whole <= DENSEST.saturating_mul(stream.longest()));
        memory_for(whole.ok_or_else(stated)?, name)?;
        let packed = (0..blocks).map(|_| number(stream)).collect::<Result<Vec<usize>, String>>()?;
        let mut unpacked = Vec::new();
        for (block, length) in packed.into_iter().enumerate() {
            let expected = if block + 1 == blocks { size_of_last } else { size };
            if expected > size {
                return Err(stated());
            }
            let bytes = stream.take(length).ok_or_else(short)?;
            let before = unpacked.len();
            match packing {
                Packing::Zlib => {
                    let mut reader = ZlibDecoder::new(&bytes[..]).take(expected as u64);
                    reader.read_to_end(&mut unpacked).map_err(|_| short())?;
                }
                Packing::Lz4 => unpacked.extend(lz4_flex::block::decompress(&bytes, expected).map_err(|_| short())?),
            }
            // vtkio puts a block of nothing behind the last whole one.
            let is_nothing = unpacked.len() == before && block + 1 == blocks && last == 0;
            if unpacked.len() - before != expected && !is_nothing {
                return Err(short());
            }
        }
        Ok(unpacked)
    }
}

/// Refuses an array of so many bytes if there is no memory for it and its numbers.
pub(super) fn memory_for(bytes: usize, name: &str) -> Result<(), String> {
    // Whole numbers of one byte become eight.
    let needed = 9_u64.saturating_mul(bytes as u64);
    memory::lacking(needed).map_or(Ok(()), |right| {
        Err(format!("an array {name} that needs about {:.2} GB of memory instead of {right}", needed as f64 / 1e9))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How files are stored here.
    const PACKED: Storage = Storage { word: 8, order: Order::Little, packing: Some(Packing::Zlib) };

    #[test]
    fn parts_of_base64_encoded_one_by_one_are_read_as_one() {
        let mut stream = Stream::Base64(b"AQ== \n AgMEBQ==", Vec::new());
        assert_eq!(stream.take(2), Some(vec![1, 2]));
        assert_eq!(stream.take(3), Some(vec![3, 4, 5]));
        assert_eq!(stream.take(1), None);
    }

    #[test]
    fn an_array_of_no_blocks_is_empty() {
        let storage = Storage { word: 4, ..PACKED };
        assert_eq!(storage.unpack(&mut Stream::Base64(b"AAAAAACAAAAAAAAA", Vec::new()), "offsets"), Ok(Vec::new()));
    }

    #[test]
    fn more_than_any_file_of_the_size_can_hold_is_refused() {
        // 2^40 blocks of 32768 bytes.
        let mut stream = Stream::Base64(b"AAAAAAABAAAAgAAAAAAAADAAAAAAAAAA", Vec::new());
        let found = PACKED.unpack(&mut stream, "radius").unwrap_err();
        assert!(found.starts_with("an array radius that states"), "{found}");
    }
}
