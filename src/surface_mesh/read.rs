//! Triangles from files, in the order of the files.

use super::{obj, stl, vector, vtk};
use crate::number::Vector;
use std::fmt;

/// Triangles as a file has them: nothing is joined, dropped or turned yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// Vertices, in the file's unit; all finite.
    pub vertices: Vec<[f64; 3]>,
    /// Three vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the file that each triangle is or is part of, counted from 1.
    pub faces: Vec<u32>,
}

/// Why a file is no mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct MeshError {
    /// The line of a text file.
    pub line: Option<usize>,
    /// The face, counted from 1.
    pub face: Option<usize>,
    /// What was found.
    pub found: String,
    /// What would be right.
    pub right: String,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if let Some(face) = self.face {
            write!(f, "face {face}: ")?;
        }
        write!(f, "{} found; {} is right", self.found, self.right)
    }
}

impl MeshError {
    /// In the file as a whole.
    pub(super) fn whole(found: impl Into<String>, right: impl Into<String>) -> Self {
        Self { line: None, face: None, found: found.into(), right: right.into() }
    }

    /// At a line of a text file.
    pub(super) fn at_line(line: usize, found: impl Into<String>, right: impl Into<String>) -> Self {
        Self { line: Some(line), ..Self::whole(found, right) }
    }

    /// At a face.
    pub(super) fn at_face(face: usize, found: impl Into<String>, right: impl Into<String>) -> Self {
        Self { face: Some(face), ..Self::whole(found, right) }
    }
}

/// Most triangles of one mesh.
pub(super) const MOST: usize = 50_000_000;

/// Reads the triangles of a file; its name says what it is: `.stl`, `.obj`, `.vtk`, `.vtp`, `.vtu`.
///
/// # Errors
/// A file of another kind, a damaged one, faces that are no triangles or flat polygons, coordinates that are not finite.
pub fn read(name: &str, bytes: &[u8]) -> Result<Soup, MeshError> {
    let lower = name.to_lowercase();
    let soup = match lower.rsplit('.').next() {
        Some("stl") => stl::read(bytes),
        Some("obj") => obj::read(text(bytes)?),
        Some("vtk" | "vtp" | "vtu") => vtk::read(bytes),
        _ => Err(MeshError::whole("a file of unknown kind", "a name that ends with .stl, .obj, .vtk, .vtp or .vtu")),
    }?;
    match soup.triangles.is_empty() {
        true => Err(MeshError::whole("no face", "a surface of triangles")),
        false => Ok(soup),
    }
}

/// The text of a file.
pub(super) fn text(bytes: &[u8]) -> Result<&str, MeshError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        MeshError::at_line(line, "bytes that are not UTF-8", "a text file")
    })
}

/// Three finite numbers of a line.
pub(super) fn numbers<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<[f64; 3], MeshError> {
    let mut numbers = [0.0; 3];
    let mut words = words;
    for number in &mut numbers {
        let word = words.next().unwrap_or("the end of the line");
        *number = match word.parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            _ => return Err(MeshError::at_line(line, format!("{word:?}"), "three finite numbers")),
        };
    }
    Ok(numbers)
}

impl Soup {
    /// Adds a polygon of these vertices, as a fan; four corners are cut along the shorter diagonal.
    ///
    /// # Errors
    /// A polygon of fewer than three corners, or one that is neither flat nor convex.
    pub(super) fn polygon(&mut self, corners: &[u32], face: usize) -> Result<(), MeshError> {
        if let Some(corner) = corners.iter().find(|corner| **corner as usize >= self.vertices.len()) {
            let right = format!("the number of one of {} vertices", self.vertices.len());
            return Err(MeshError::at_face(face, format!("vertex {}", u64::from(*corner) + 1), right));
        }
        if self.triangles.len() >= MOST {
            return Err(MeshError::at_face(face, "one more triangle", format!("at most {MOST}")));
        }
        let at = |corner: u32| vector(self.vertices[corner as usize]);
        let start = match corners {
            [] | [_] | [_, _] => {
                return Err(MeshError::at_face(face, format!("{} corners", corners.len()), "three or more"));
            }
            [a, b, c, d] if (at(*d) - at(*b)).length() < (at(*c) - at(*a)).length() => 1,
            _ => 0,
        };
        let count = corners.len();
        let corner = |index: usize| corners[(start + index) % count];
        let fan: Vec<[u32; 3]> = (1..count - 1).map(|index| [corner(0), corner(index), corner(index + 1)]).collect();
        if count > 3 {
            let normal = |[a, b, c]: [u32; 3]| (at(b) - at(a)).cross(at(c) - at(a));
            let sum = fan.iter().fold(Vector::zero(), |sum, triangle| sum + normal(*triangle));
            // Cosine of the bend that counts as flat: a tenth of a degree.
            let flat = |normal: Vector| normal.dot(sum) >= (1.0 - 1.5e-6) * normal.length() * sum.length();
            if !fan.iter().all(|triangle| flat(normal(*triangle))) {
                return Err(MeshError::at_face(
                    face,
                    format!("{count} corners"),
                    "a flat and convex face, or triangles",
                ));
            }
        }
        self.faces.extend(fan.iter().map(|_| face as u32));
        self.triangles.extend(fan);
        Ok(())
    }
}
