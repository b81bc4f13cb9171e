//! STL files, ASCII and binary. Stored normals are not looked at.

use super::Triangles;

/// Length of the head of a binary file.
const HEAD: usize = 84;

/// Length of a triangle in a binary file.
const RECORD: usize = 50;

/// The triangles of a file, or what is wrong with it: what was found and what was expected.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, (String, String)> {
    // "solid" at the start says nothing: many binary files have it.
    let declared = bytes.get(80..HEAD).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let declared = declared.map(|count| count as usize);
    if declared.and_then(|count| count.checked_mul(RECORD)).and_then(|length| length.checked_add(HEAD))
        == Some(bytes.len())
    {
        return Ok(bytes[HEAD..].chunks_exact(RECORD).map(binary).collect());
    }
    // The name of a solid may be written in any encoding.
    let text = String::from_utf8_lossy(bytes);
    let is_text = !bytes.contains(&0) && text.to_ascii_lowercase().contains("vertex");
    match (Some(text).filter(|_| is_text), declared) {
        (Some(text), _) => ascii(&text),
        (None, Some(count)) => Err((
            format!("{} bytes with {count} triangles declared", bytes.len()),
            format!("{HEAD} bytes and {RECORD} for each triangle"),
        )),
        (None, None) => Err((format!("{} bytes", bytes.len()), "an STL file".to_owned())),
    }
}

/// A triangle of a binary file.
fn binary(record: &[u8]) -> [[f64; 3]; 3] {
    let number = |place: usize| {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(&record[place..place + 4]);
        f64::from(f32::from_le_bytes(bytes))
    };
    [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| number(12 + 12 * corner + 4 * axis)))
}

/// The triangles of a text.
fn ascii(text: &str) -> Result<Triangles, (String, String)> {
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut triangles = Triangles::new();
    for (line, words) in (1..).zip(text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>())) {
        let word = words.first().map(|word| word.to_ascii_lowercase());
        match word.as_deref() {
            Some("vertex") => {
                let numbers: Vec<f64> = words[1..].iter().filter_map(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else {
                    let found = format!("line {line}: {}", words.join(" "));
                    return Err((found, "vertex and three numbers".to_owned()));
                };
                corners.push([x, y, z]);
            }
            Some("endloop") => {
                let [a, b, c] = corners[..] else {
                    return Err((
                        format!("line {line}: a loop of {} vertices", corners.len()),
                        "loops of three".to_owned(),
                    ));
                };
                triangles.push([a, b, c]);
                corners.clear();
            }
            _ => {}
        }
    }
    if !corners.is_empty() {
        return Err((format!("a last facet of {} vertices without its end", corners.len()), "a whole file".to_owned()));
    }
    Ok(triangles)
}
