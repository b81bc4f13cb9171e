//! VTK files through vtkio: its panics print nothing here, and it gets no more memory than a file can fill.

use crate::memory;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use cograin_vtk::model::Vtk;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is expected and caught.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Memory that a byte of a file takes as it is read: the text, and the numbers in it, which grow from two bytes to eight.
const PARSED: u64 = 6;

/// Reads a VTK file, XML or legacy; otherwise what was found instead of a readable one.
pub(crate) fn read(bytes: &[u8]) -> Result<Vtk, String> {
    let unpacked = unpacked(bytes)?;
    let needed = (PARSED * bytes.len() as u64).saturating_add(unpacked.saturating_mul(2));
    if let Some(right) = memory::lacking(needed) {
        return Err(format!("data that need about {:.2} GB of memory instead of {right}", needed as f64 / 1e9));
    }
    let found = match silently(|| cograin_vtk::read(bytes)) {
        Ok(Ok(file)) => return Ok(file),
        Ok(Err(_)) if holds(bytes, b"encoding=\"raw\"") => "raw appended data (encoding=\"raw\")",
        Ok(Err(_)) if holds(bytes, b"vtkLZMADataCompressor") => "data packed by lzma",
        Ok(Err(_)) => "a file that is no VTK file, or a damaged one,",
        Err(Panicked) => "a file with damaged data arrays",
    };
    Err(found.to_owned())
}

/// The work panicked.
struct Panicked;

/// Does the work; a panic in it prints nothing. Panics of other threads are printed as ever.
fn silently<T>(work: impl FnOnce() -> T) -> Result<T, Panicked> {
    /// The hook that knows which panics are expected is set once and hands the others on.
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let otherwise = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !EXPECTED.get() {
                otherwise(panic);
            }
        }));
    });
    EXPECTED.set(true);
    // Nothing of vtkio's state outlives the call.
    let done = catch_unwind(AssertUnwindSafe(work));
    EXPECTED.set(false);
    done.map_err(|_| Panicked)
}

/// Whether the file holds these bytes.
fn holds(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}

/// Bytes of all packed arrays of a file when unpacked, as it states them; otherwise the array that states more than the file can hold.
///
/// A packed array begins with the number of its blocks, the size of each and that of the last one (VTK's book of file formats, "Data
/// Compression"). vtkio asks for as much memory as they say.
fn unpacked(bytes: &[u8]) -> Result<u64, String> {
    /// Bytes that one byte packed by zlib can stand for at most; for lz4 it is 255.
    const DENSEST: u64 = 1032;
    /// Blocks that no array of a file of this program's sizes has, where the file is small: what is left for rounding.
    const SPARE: u64 = 1 << 16;
    let text = String::from_utf8_lossy(bytes);
    let after = |part: &str, until: char| text.split_once(part).and_then(|(_, after)| after.split_once(until));
    let head = after("<VTKFile", '>').map_or("", |(head, _)| head);
    if attribute(head, "compressor").is_none() {
        return Ok(0);
    }
    let word = if attribute(head, "header_type") == Some("UInt64") { 8 } else { 4 };
    let big = attribute(head, "byte_order") == Some("BigEndian");
    let appended = after("<AppendedData", '_').map_or("", |(_, data)| data);
    let (mut sum, most) = (0_u64, DENSEST * text.len() as u64 + SPARE);
    for (tag, inside) in text.split("<DataArray").skip(1).filter_map(|array| array.split_once('>')) {
        let offset = attribute(tag, "offset").and_then(|offset| offset.parse::<usize>().ok()).unwrap_or(0);
        let data = match attribute(tag, "format") {
            Some("binary") => inside,
            Some("appended") => appended.get(offset..).unwrap_or_default(),
            _ => continue,
        };
        // What cannot be read is left to the reader.
        let Some([blocks, size, last]) = packed_head(data, word, big) else { continue };
        let total = blocks.checked_mul(size).and_then(|total| total.checked_add(last));
        let Some(total) = total.filter(|total| blocks <= most && *total <= most) else {
            let name = attribute(tag, "Name").unwrap_or("of points");
            return Err(format!("an array {name} that states {blocks} blocks of {size} bytes"));
        };
        sum = sum.saturating_add(total);
    }
    Ok(sum)
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let after = tag.split(name).skip(1).find_map(|after| after.trim_start().strip_prefix('='))?.trim_start();
    let quote = after.chars().next().filter(|quote| ['"', '\''].contains(quote))?;
    after[1..].split(quote).next()
}

/// The first three words of a packed array: the number of its blocks, the size of each and that of the last when unpacked \[bytes\].
fn packed_head(data: &str, word: usize, big: bool) -> Option<[u64; 3]> {
    let letters: Vec<u8> = data.bytes().filter(|letter| !letter.is_ascii_whitespace()).take(4 * word).collect();
    let bytes = BASE64_STANDARD.decode(letters).ok().filter(|bytes| bytes.len() == 3 * word)?;
    let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
    Some([0, 1, 2].map(|place| {
        let part = bytes[place * word..(place + 1) * word].iter();
        if big { part.fold(0, join) } else { part.rev().fold(0, join) }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one array that begins so, after another one that cannot be read.
    fn file(data: &str) -> String {
        format!(
            "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
             <DataArray type=\"Float64\" Name=\"other\" format=\"binary\">!</DataArray>\
             <DataArray type=\"Float64\" Name=\"radius\" format=\"binary\">{data}</DataArray></VTKFile>"
        )
    }

    #[test]
    fn sizes_are_read_from_the_head_of_an_array() {
        // One block of 32768 bytes, the last of 48.
        let data = "AQAAAAAAAAAAgAAAAAAAADAAAAAAAAAA";
        assert_eq!(packed_head(data, 8, false), Some([1, 32768, 48]));
        // (1 block + the last one): what is asked for at most.
        assert_eq!(unpacked(file(data).as_bytes()), Ok(32768 + 48));
    }

    #[test]
    fn more_than_any_file_of_the_size_can_hold_is_refused() {
        // 2^40 blocks of 32768 bytes.
        let file = file("AAAAAAABAAAAgAAAAAAAADAAAAAAAAAA");
        let found = unpacked(file.as_bytes()).unwrap_err();
        assert!(found.starts_with("an array radius that states"), "{found}");
        // A byte that is no text hides nothing.
        let found = unpacked(&[b"\xff", file.as_bytes()].concat()).unwrap_err();
        assert!(found.starts_with("an array radius that states"), "{found}");
    }
}
