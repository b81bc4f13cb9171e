//! Whether compressed arrays of a VTK file can be as large as they say, before memory is asked for them.
//!
//! A compressed array begins with words that say how many blocks it has and how large each is when unpacked
//! (VTK's book of file formats, "Data Compression"). vtkio asks for as much memory as they say.

/// Bytes that one byte packed by zlib can stand for at most; for lz4 it is 255.
const DENSEST: u64 = 1032;

/// Blocks that no array of a file of this program's sizes has, where the file is small: what is left for rounding.
const SPARE: u64 = 1 << 16;

/// Bytes of all compressed arrays when unpacked, as a file states them; otherwise what is wrong with that.
pub(super) fn stated(bytes: &[u8]) -> Result<u64, String> {
    let mut sum = 0_u64;
    let wrong = add_up(bytes, &mut sum);
    wrong.map_or(Ok(sum), Err)
}

/// Adds up what the compressed arrays of a file state. Hands out what is wrong with it, if anything; what cannot be read
/// is left to the reader.
fn add_up(bytes: &[u8], sum: &mut u64) -> Option<String> {
    let text = std::str::from_utf8(bytes).ok()?;
    let head = &text[text.find("<VTKFile")?..];
    let head = &head[..head.find('>')?];
    attribute(head, "compressor")?;
    let word = if attribute(head, "header_type") == Some("UInt64") { 8 } else { 4 };
    let big = attribute(head, "byte_order") == Some("BigEndian");
    let appended = text.find("<AppendedData").and_then(|start| text[start..].split_once('_')).map(|(_, data)| data);
    let most = DENSEST * text.len() as u64 + SPARE;
    for part in text.split("<DataArray").skip(1) {
        let Some((tag, after)) = part.split_once('>') else { break };
        let data = match attribute(tag, "format") {
            Some("binary") => after.trim_start(),
            Some("appended") => {
                let offset = attribute(tag, "offset").and_then(|offset| offset.parse::<usize>().ok()).unwrap_or(0);
                appended.and_then(|data| data.get(offset..)).unwrap_or_default()
            }
            _ => continue,
        };
        let [blocks, size, last] = header(data, word, big)?;
        let total = blocks.checked_mul(size).and_then(|total| total.checked_add(last));
        if blocks > most || total.is_none_or(|total| total > most) {
            let name = attribute(tag, "Name").unwrap_or("of points");
            return Some(format!("an array {name} that states {blocks} blocks of {size} bytes"));
        }
        *sum = sum.saturating_add(total.unwrap_or(u64::MAX));
    }
    None
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let after = tag.split(name).skip(1).find_map(|after| after.trim_start().strip_prefix('='))?.trim_start();
    let quote = after.chars().next().filter(|quote| ['"', '\''].contains(quote))?;
    after[1..].split(quote).next()
}

/// The number of blocks, the size of each and of the last when unpacked.
fn header(data: &str, word: usize, big: bool) -> Option<[u64; 3]> {
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for letter in data.bytes().take(4 * word) {
        let six = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => break,
        };
        bits = bits << 6 | u32::from(six);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    let number = |place: usize| -> Option<u64> {
        let part = bytes.get(place * word..(place + 1) * word)?;
        let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(if big { part.iter().fold(0, join) } else { part.iter().rev().fold(0, join) })
    };
    Some([number(0)?, number(1)?, number(2)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one array that begins so.
    fn file(data: &str) -> String {
        format!(
            "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
             <DataArray type=\"Float64\" Name=\"radius\" format=\"binary\">{data}</DataArray></VTKFile>"
        )
    }

    #[test]
    fn sizes_are_read_from_the_head_of_an_array() {
        // One block of 32768 bytes, the last of 48.
        let data = "AQAAAAAAAAAAgAAAAAAAADAAAAAAAAAA";
        assert_eq!(header(data, 8, false), Some([1, 32768, 48]));
        // (1 block + the last one): what is asked for at most.
        assert_eq!(stated(file(data).as_bytes()), Ok(32768 + 48));
    }

    #[test]
    fn more_than_any_file_of_the_size_can_hold_is_refused() {
        // 2^40 blocks of 32768 bytes.
        let found = stated(file("AAAAAAABAAAAgAAAAAAAADAAAAAAAAAA").as_bytes()).unwrap_err();
        assert!(found.starts_with("an array radius that states"), "{found}");
    }
}
