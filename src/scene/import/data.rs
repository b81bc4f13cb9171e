//! Data files of LIGGGHTS and LAMMPS (`read_data`, `write_data`) with spheres.

use super::fault::non_spherical;
use super::file_box::Bounds;
use super::{FileBox, FileFault, REPORTED, Request, Rows};
use crate::base::document::Mistake;
use std::collections::BTreeMap;

/// Columns of a line of atoms, by the atom style that its section names.
const STYLES: [(&str, &[&str]); 3] = [
    ("sphere", &["id", "type", "diameter", "density", "x", "y", "z"]),
    ("granular", &["id", "type", "diameter", "density", "x", "y", "z"]),
    ("bpm/sphere", &["id", "molecule", "type", "diameter", "density", "x", "y", "z"]),
];

/// Columns of a line of velocities.
const VELOCITIES: [&str; 7] = ["id", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Columns that particles get from the file, beside their type.
const NAMES: [&str; 13] = ["id", "molecule", "diameter", "density", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Last words of lines that say something of the box.
const OF_A_BOX: [&str; 8] = ["xhi", "yhi", "zhi", "yz", "avec", "bvec", "cvec", "origin"];

/// What has been read so far.
#[derive(Default)]
struct Reader {
    /// Lines, labels.
    rows: Rows,
    /// Numbers by column.
    columns: BTreeMap<&'static str, Vec<f64>>,
    /// Mistakes.
    faults: Vec<FileFault>,
    /// How many atoms the head announces, and where.
    announced: Option<(usize, usize)>,
    /// Lower and upper bounds of the box along each axis.
    bounds: [Option<[f64; 2]>; 3],
    /// The tilts xy, xz, yz.
    tilts: Option<[f64; 3]>,
    /// Edges written as vectors, and the corner.
    vectors: [Option<[f64; 3]>; 4],
    /// The last line that says something of the box.
    box_line: usize,
    /// How often each atom crossed the faces; empty where none did.
    crossed: Vec<[i64; 3]>,
    /// The line of the first that did.
    crossed_at: Option<usize>,
}

/// Reads the text of a data file, and the units it states.
pub(crate) fn read(text: &str, _request: &Request) -> Result<(Rows, Option<String>), Vec<FileFault>> {
    let mut reader = Reader::default();
    let title = text.lines().next().unwrap_or_default();
    let units = title.split_once("units = ").map(|(_, units)| units.trim().to_owned());
    let mut section = ("", "");
    // Velocities may stand before the atoms.
    let mut velocities = Vec::new();
    for (number, line) in (1..).zip(text.lines()).skip(1) {
        let (content, comment) = line.split_once('#').unwrap_or((line, ""));
        let content = content.trim();
        if content.is_empty() {
            continue;
        }
        if content.starts_with(|first: char| first.is_ascii_alphabetic()) {
            section = (content, comment.trim());
            if ["Ellipsoids", "Bodies", "Lines", "Triangles"].contains(&content) {
                return Err(non_spherical(number));
            }
            continue;
        }
        match section.0 {
            "" => reader.head(number, content)?,
            "Atoms" => reader.atom(number, content, section.1)?,
            "Velocities" => velocities.push((number, content)),
            other => {
                let name = format!("section {other}");
                if !reader.rows.left_out.contains(&name) {
                    reader.rows.left_out.push(name);
                }
            }
        }
        if reader.faults.len() >= REPORTED {
            break;
        }
    }
    reader.velocities(&velocities);
    reader.finish().map(|rows| (rows, units))
}

impl Reader {
    /// A line before the first section.
    fn head(&mut self, number: usize, content: &str) -> Result<(), Vec<FileFault>> {
        let words: Vec<&str> = content.split_whitespace().collect();
        match words[..] {
            [count, "atoms"] => match count.parse() {
                Ok(count) => self.announced = Some((count, number)),
                Err(_) => {
                    let (found, expected) = (format!("{count:?} atoms"), "a whole number of atoms".to_owned());
                    return Err(vec![FileFault::at(number, "", Mistake::Unexpected { found, expected })]);
                }
            },
            [count, "ellipsoids" | "bodies" | "lines" | "triangles"] if count != "0" => {
                return Err(non_spherical(number));
            }
            [low, high, "xlo", "xhi"] => self.bounds[0] = Some(self.of_box([low, high], number)?),
            [low, high, "ylo", "yhi"] => self.bounds[1] = Some(self.of_box([low, high], number)?),
            [low, high, "zlo", "zhi"] => self.bounds[2] = Some(self.of_box([low, high], number)?),
            [x, y, z, "xy", "xz", "yz"] => self.tilts = Some(self.of_box([x, y, z], number)?),
            [x, y, z, "avec"] => self.vectors[0] = Some(self.of_box([x, y, z], number)?),
            [x, y, z, "bvec"] => self.vectors[1] = Some(self.of_box([x, y, z], number)?),
            [x, y, z, "cvec"] => self.vectors[2] = Some(self.of_box([x, y, z], number)?),
            [x, y, z, "abc", "origin"] => self.vectors[3] = Some(self.of_box([x, y, z], number)?),
            [.., name] if OF_A_BOX.contains(&name) => {
                let (found, expected) = (format!("{content:?}"), "a line of a box: 0 1 xlo xhi, or 0 0 0 xy xz yz");
                let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                return Err(vec![FileFault::at(number, "", mistake)]);
            }
            _ => {}
        }
        Ok(())
    }

    /// Numbers of a line that says something of the box.
    fn of_box<const N: usize>(&mut self, words: [&str; N], line: usize) -> Result<[f64; N], Vec<FileFault>> {
        self.box_line = line;
        bounds(words, line)
    }

    /// The box, if the head says one; a part of one is refused.
    fn around(&self) -> Result<Option<Bounds>, Vec<FileFault>> {
        let (bounded, tilted) = (self.bounds.iter().any(Option::is_some), self.tilts.is_some());
        match (self.vectors, self.bounds) {
            ([None, None, None, None], [None, None, None]) if !tilted => Ok(None),
            ([Some(a), Some(b), Some(c), Some(low)], [None, None, None]) if !tilted => {
                Ok(Some(Bounds { low, edges: [a, b, c] }))
            }
            ([None, None, None, None], [Some(x), Some(y), Some(z)]) => {
                let [xy, xz, yz] = self.tilts.unwrap_or_default();
                let edges = [[x[1] - x[0], 0.0, 0.0], [xy, y[1] - y[0], 0.0], [xz, yz, z[1] - z[0]]];
                Ok(Some(Bounds { low: [x[0], y[0], z[0]], edges }))
            }
            _ => {
                let general = self.vectors.iter().any(Option::is_some);
                let found = if general && (bounded || tilted) { "parts of two boxes" } else { "a part of a box" };
                let expected = "all of xlo xhi, ylo yhi, zlo zhi, or all of avec, bvec, cvec, abc origin".to_owned();
                let mistake = Mistake::Unexpected { found: found.to_owned(), expected };
                Err(vec![FileFault::at(self.box_line, "", mistake)])
            }
        }
    }

    /// A line of the section Atoms.
    fn atom(&mut self, number: usize, content: &str, style: &str) -> Result<(), Vec<FileFault>> {
        let words: Vec<&str> = content.split_whitespace().collect();
        let wanted = if style.is_empty() { "sphere" } else { style };
        if ["ellipsoid", "superquadric", "body", "line", "tri"].iter().any(|other| style.contains(other)) {
            return Err(non_spherical(number));
        }
        let Some((_, columns)) = STYLES.iter().find(|(known, _)| *known == wanted) else {
            let (found, expected) = (format!("atom style {style}"), "sphere, granular or bpm/sphere".to_owned());
            return Err(vec![FileFault::at(number, "", Mistake::Unexpected { found, expected })]);
        };
        if words.len() != columns.len() && words.len() != columns.len() + 3 {
            let found = format!("{} numbers", words.len());
            let expected = format!("{}, and perhaps ix iy iz, of atom style {wanted}", columns.join(" "));
            return Err(vec![FileFault::at(number, "", Mistake::Unexpected { found, expected })]);
        }
        let mut crossed = [0; 3];
        for (count, word) in crossed.iter_mut().zip(&words[columns.len()..]) {
            match word.parse::<i32>() {
                Ok(flag) => *count = i64::from(flag),
                Err(_) => {
                    let (found, expected) = (format!("{word:?}"), "a whole number".to_owned());
                    self.faults.push(FileFault::at(number, "ix iy iz", Mistake::Unexpected { found, expected }));
                }
            }
        }
        if crossed != [0; 3] {
            self.crossed_at.get_or_insert(number);
        }
        if self.crossed_at.is_some() {
            self.crossed.resize(self.rows.lines.len(), [0; 3]);
            self.crossed.push(crossed);
        }
        for (word, column) in words.iter().zip(*columns) {
            match *column {
                "type" => self.rows.push_label(word),
                column => self.number(number, column, word),
            }
        }
        self.rows.lines.push(number as u32);
        Ok(())
    }

    /// Notes a number.
    fn number(&mut self, line: usize, column: &'static str, word: &str) {
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => self.columns.entry(column).or_default().push(value),
            _ => self.faults.push(FileFault::number(line, column, word)),
        }
    }

    /// The lines of the section Velocities.
    fn velocities(&mut self, lines: &[(usize, &str)]) {
        if lines.is_empty() || !self.faults.is_empty() {
            return;
        }
        let count = self.rows.lines.len();
        let ids = self.columns.get("id").map_or(&[][..], Vec::as_slice);
        let row_of: BTreeMap<u64, usize> = ids.iter().map(|id| *id as u64).zip(0..).collect();
        let mut columns = [const { Vec::new() }; 6];
        columns.iter_mut().for_each(|column| column.resize(count, 0.0));
        for (number, content) in lines {
            let words: Vec<&str> = content.split_whitespace().collect();
            let row = words.first().and_then(|id| id.parse().ok()).and_then(|id: u64| row_of.get(&id).copied());
            let Some(row) = row.filter(|_| words.len() == 4 || words.len() == VELOCITIES.len()) else {
                let found = format!("{content:?}");
                let expected = "the number of an atom of this file, and vx vy vz wx wy wz".to_owned();
                self.faults.push(FileFault::at(*number, "", Mistake::Unexpected { found, expected }));
                continue;
            };
            for ((word, name), column) in words[1..].iter().zip(&VELOCITIES[1..]).zip(&mut columns) {
                match word.parse::<f64>() {
                    Ok(value) if value.is_finite() => column[row] = value,
                    _ => self.faults.push(FileFault::number(*number, name, word)),
                }
            }
            if self.faults.len() >= REPORTED {
                return;
            }
        }
        self.columns.extend(VELOCITIES[1..].iter().copied().zip(columns));
    }

    /// All rows.
    fn finish(mut self) -> Result<Rows, Vec<FileFault>> {
        let count = self.rows.lines.len();
        match self.announced {
            Some((announced, line)) if announced != count && self.faults.is_empty() => {
                let (found, expected) = (count.to_string(), format!("{announced} atoms, as announced"));
                self.faults.push(FileFault::at(line, "", Mistake::Unexpected { found, expected }));
            }
            None if count == 0 => {
                let expected = "\"<number> atoms\" and a section Atoms of a data file".to_owned();
                self.faults.push(FileFault::whole(Mistake::Unexpected { found: "no atoms".to_owned(), expected }));
            }
            _ => {}
        }
        if !self.faults.is_empty() {
            return Err(self.faults);
        }
        let bounds = self.around()?;
        let mut rows = Rows { count, label_column: "type".to_owned(), ..self.rows };
        if let Some(line) = self.crossed_at {
            let Some(bounds) = bounds else {
                let (found, expected) =
                    ("a particle that crossed a face".to_owned(), "a box: xlo xhi, ylo yhi, zlo zhi");
                let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                return Err(vec![FileFault { line: Some(line), column: String::new(), mistake }]);
            };
            let lattice = bounds.lattice(Some(self.box_line))?;
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let places = self.columns.entry(name).or_default().iter_mut();
                places.zip(&self.crossed).for_each(|(place, count)| *place += lattice.displacement(*count)[axis]);
            }
            rows.around = Some(FileBox { lattice, is_told: false, line: Some(line), is_crossed: true });
        } else if let Some(bounds) = bounds {
            let line = Some(self.box_line);
            rows.around = Some(FileBox { lattice: bounds.lattice(line)?, is_told: false, line, is_crossed: false });
        }
        for name in NAMES {
            if let Some(column) = self.columns.remove(name) {
                rows.insert(name, column);
            }
        }
        Ok(rows)
    }
}

/// The numbers of a box in a line.
fn bounds<const N: usize>(words: [&str; N], line: usize) -> Result<[f64; N], Vec<FileFault>> {
    let mut numbers = [0.0; N];
    for (number, word) in numbers.iter_mut().zip(words) {
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => *number = value,
            _ => return Err(vec![FileFault::number(line, "", word)]),
        }
    }
    Ok(numbers)
}
