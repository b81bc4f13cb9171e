//! STL, binary and ASCII. Stored normals are not read: the order of the corners says the same.

use super::read::{MOST, MeshError, Soup, numbers, text};

/// Bytes before the first face of a binary file: a title, and the number of faces.
const HEAD: usize = 84;
/// Bytes of a face: a normal and three corners of three 32-bit numbers each, and two bytes.
const FACE: usize = 50;

/// Reads an STL file. That it begins with `solid` does not make it ASCII: its size decides.
pub(super) fn read(bytes: &[u8]) -> Result<Soup, MeshError> {
    let declared =
        bytes.get(80..HEAD).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    match declared {
        Some(count) if HEAD + FACE * count == bytes.len() => binary(&bytes[HEAD..], count),
        _ if bytes.trim_ascii_start().starts_with(b"solid") || bytes.trim_ascii_start().starts_with(b"SOLID") => {
            ascii(text(bytes)?)
        }
        Some(count) => Err(MeshError::whole(
            format!("{} bytes of an STL file that declares {count} faces", bytes.len()),
            format!("{} bytes", HEAD + FACE * count),
        )),
        None => Err(MeshError::whole(format!("{} bytes", bytes.len()), "an STL file")),
    }
}

/// The faces of a binary file.
fn binary(bytes: &[u8], count: usize) -> Result<Soup, MeshError> {
    if count > MOST {
        return Err(MeshError::whole(format!("{count} faces"), format!("at most {MOST}")));
    }
    let mut soup = Soup::default();
    for (face, record) in (1..).zip(bytes.chunks_exact(FACE)) {
        let first = soup.vertices.len() as u32;
        for corner in record[12..48].chunks_exact(12) {
            let number = |axis: usize| {
                let part = &corner[4 * axis..4 * axis + 4];
                f64::from(f32::from_le_bytes([part[0], part[1], part[2], part[3]]))
            };
            let vertex = [number(0), number(1), number(2)];
            if vertex.iter().any(|part| !part.is_finite()) {
                return Err(MeshError::at_face(face, format!("a corner at {vertex:?}"), "finite numbers"));
            }
            soup.vertices.push(vertex);
        }
        soup.polygon(&[first, first + 1, first + 2], face)?;
    }
    Ok(soup)
}

/// The faces of an ASCII file: corners between `outer loop` and `endloop`, in upper or lower case, in one or more solids.
fn ascii(text: &str) -> Result<Soup, MeshError> {
    let mut soup = Soup::default();
    let mut corners: Vec<u32> = Vec::new();
    let mut open = None;
    for (line, content) in (1..).zip(text.lines()) {
        let mut words = content.split_whitespace();
        match words.next().unwrap_or_default().to_ascii_lowercase().as_str() {
            "facet" => {
                open = Some(line);
                corners.clear();
            }
            "vertex" if open.is_some() => {
                corners.push(soup.vertices.len() as u32);
                soup.vertices.push(numbers(words, line)?);
            }
            "endfacet" if open.is_some() => {
                if corners.len() != 3 {
                    let found = format!("a facet of {} corners", corners.len());
                    return Err(MeshError::at_line(line, found, "three"));
                }
                let face = soup.triangles.len() + 1;
                soup.polygon(&corners, face)?;
                open = None;
            }
            "" | "solid" | "endsolid" | "outer" | "endloop" => {}
            word => return Err(MeshError::at_line(line, format!("{word:?}"), "a line of an STL file")),
        }
    }
    match open {
        Some(line) => Err(MeshError::at_line(line, "a facet that does not end", "endfacet")),
        None => Ok(soup),
    }
}
