//! The bytes of a file: whether there is room for them, what they are packed by, the text that they are.

use super::FileFault;
use crate::base::document::Mistake;
use crate::base::memory;
use flate2::read::MultiGzDecoder;
use std::borrow::Cow;
use std::io::Read;

/// Refuses more particles than there is memory for, where each needs so much \[bytes\].
pub(super) fn has_room(count: usize, each: u64) -> Result<(), Vec<FileFault>> {
    let needed = each.saturating_mul(count as u64);
    memory::lacking(needed).map_or(Ok(()), |expected| {
        let found = format!("{count} particles, which need about {:.2} GB of memory", needed as f64 / 1e9);
        Err(vec![FileFault::whole(Mistake::Unexpected { found, expected })])
    })
}

/// The bytes of a file that may be packed by gzip.
pub(super) fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, Vec<FileFault>> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(Cow::Borrowed(bytes));
    }
    // A list that grows is copied into one twice as long.
    let most = memory::available().map_or(u64::MAX, |free| free / 3);
    let mut unpacked = Vec::new();
    match MultiGzDecoder::new(bytes).take(most).read_to_end(&mut unpacked) {
        Ok(length) if length as u64 == most => Err(vec![FileFault::whole(Mistake::Unexpected {
            found: format!("a gzip file that holds more than {:.2} GB", most as f64 / 1e9),
            expected: "what fits into a third of the memory that is free".to_owned(),
        })]),
        Ok(_) => Ok(Cow::Owned(unpacked)),
        Err(error) => Err(vec![FileFault::whole(Mistake::Unexpected {
            found: format!("a damaged gzip file ({error})"),
            expected: "a whole one".to_owned(),
        })]),
    }
}

/// The text of a file.
pub(super) fn text(bytes: &[u8]) -> Result<&str, Vec<FileFault>> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        let mistake =
            Mistake::Unexpected { found: "bytes that are not UTF-8".to_owned(), expected: "a text file".to_owned() };
        vec![FileFault { line: Some(line), column: String::new(), mistake }]
    })
}
