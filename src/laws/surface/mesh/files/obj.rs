//! Wavefront OBJ: vertices and faces; other lines are skipped.

use super::{Triangles, Wrong, add_polygon};

/// The triangles of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, Wrong> {
    // Names and comments may be written in any encoding.
    let text = String::from_utf8_lossy(bytes);
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let mut triangles = Triangles::new();
    let mut face = 0;
    for (line, content) in (1..).zip(text.lines()) {
        let words: Vec<&str> = content.split('#').next().unwrap_or_default().split_whitespace().collect();
        match words[..] {
            ["v", ref numbers @ ..] => {
                let numbers: Vec<f64> = numbers.iter().take(3).map_while(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else {
                    return Err((format!("line {line}: {}", words.join(" ")), "v and three numbers".to_owned()));
                };
                vertices.push([x, y, z]);
            }
            ["f", ref corners @ ..] => {
                face += 1;
                let corner = |word: &&str| {
                    let wrong =
                        || (format!("line {line}: {word:?}"), format!("one of {} vertices above", vertices.len()));
                    place(word, vertices.len()).map(|place| vertices[place]).ok_or_else(wrong)
                };
                let corners = corners.iter().map(corner).collect::<Result<Vec<_>, Wrong>>()?;
                add_polygon(&corners, face, &mut triangles)?;
            }
            _ => {}
        }
    }
    Ok(triangles)
}

/// The vertex that a corner names, as `7`, `7/1/2`, or counted back from the last one, `-1`.
fn place(word: &str, count: usize) -> Option<usize> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let place = if number > 0 { number - 1 } else { i64::try_from(count).ok()?.checked_add(number)? };
    usize::try_from(place).ok().filter(|place| number != 0 && *place < count)
}
