//! Wavefront OBJ: vertices and faces; everything else is skipped.

use super::read::{MeshError, Soup, numbers};

/// Reads an OBJ file.
pub(super) fn read(text: &str) -> Result<Soup, MeshError> {
    let mut soup = Soup::default();
    let mut face = 0;
    for (line, content) in (1..).zip(text.lines()) {
        let mut words = content.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => soup.vertices.push(numbers(words, line)?),
            Some("f") => {
                face += 1;
                let corners: Result<Vec<u32>, MeshError> =
                    words.map(|word| corner(word, soup.vertices.len(), line)).collect();
                soup.polygon(&corners?, face).map_err(|error| MeshError { line: Some(line), ..error })?;
            }
            _ => {}
        }
    }
    Ok(soup)
}

/// A corner, as `7`, `7/1/2` or counted back from the last vertex, `-1`.
fn corner(word: &str, count: usize, line: usize) -> Result<u32, MeshError> {
    let number = word.split('/').next().unwrap_or_default().parse::<i64>().ok();
    let index = number.and_then(|number| match number {
        1.. => Some(number - 1),
        0 => None,
        _ => count.try_into().ok().and_then(|count: i64| count.checked_add(number)),
    });
    index
        .and_then(|index| usize::try_from(index).ok())
        .filter(|index| *index < count)
        .map(|index| index as u32)
        .ok_or_else(|| MeshError::at_line(line, format!("{word:?}"), format!("one of {count} vertices above")))
}
