//! VTK's legacy files, in text and binary form, up to version 5.1 (VTK's book of file formats, "Simple legacy formats").

use super::packed::memory_for;
use super::{Array, Cell, Number, Order, POLYGON, Piece, TRIANGLE_STRIP, Wanted, cells, points, shortened};

/// The rest of a file.
struct Rest<'a> {
    /// Its bytes.
    bytes: &'a [u8],
    /// Whether numbers are written as text.
    ascii: bool,
}

/// Reads a file.
pub(super) fn read(bytes: &[u8], wanted: &Wanted) -> Result<Piece, String> {
    let mut rest = Rest { bytes, ascii: true };
    let version = String::from_utf8_lossy(rest.line()).into_owned();
    // From 5.1 on, cells are written as offsets and corners.
    let number = version.rsplit(' ').next().and_then(|version| version.trim().parse::<f64>().ok());
    let divided = number.is_some_and(|number| number >= 5.0);
    rest.line();
    rest.ascii = match rest.line().trim_ascii().to_ascii_uppercase().as_slice() {
        b"ASCII" => true,
        b"BINARY" => false,
        _ => return Err("a legacy VTK file that is neither ASCII nor BINARY".to_owned()),
    };
    let mut piece = Piece::default();
    let mut grid: Vec<Vec<usize>> = Vec::new();
    while let Some(keyword) = rest.word() {
        match keyword.to_uppercase().as_str() {
            "DATASET" => {
                let kind = rest.needed("a kind of data")?.to_uppercase();
                if !["POLYDATA", "UNSTRUCTURED_GRID"].contains(&kind.as_str()) {
                    return Err("VTK data of another kind".to_owned());
                }
            }
            "POINTS" => {
                let (count, kind) = (rest.count()?, rest.needed("a type")?);
                piece.points = points(&rest.numbers(count, 3, &kind, "points")?);
            }
            keyword @ ("POLYGONS" | "TRIANGLE_STRIPS" | "VERTICES" | "LINES") => {
                let kind = match keyword {
                    "POLYGONS" => Some(POLYGON),
                    "TRIANGLE_STRIPS" => Some(TRIANGLE_STRIP),
                    _ => None,
                };
                let lists = rest.cells(divided)?;
                piece.cells.extend(lists.into_iter().filter_map(|corners| Some(Cell { kind: kind?, corners })));
            }
            "CELLS" => grid = rest.cells(divided)?,
            "CELL_TYPES" => {
                let count = rest.count()?;
                let types = rest.numbers(count, 1, "int", "cell types")?;
                if types.len() != grid.len() {
                    return Err(format!("{} types of {} cells", types.len(), grid.len()));
                }
                let kinds = types.into_iter().map(|kind| kind as u8);
                piece.cells =
                    kinds.zip(std::mem::take(&mut grid)).map(|(kind, corners)| Cell { kind, corners }).collect();
            }
            "METADATA" => rest.metadata(),
            "FIELD" => {
                rest.needed("a name")?;
                rest.field(&mut |_| false, &mut piece)?;
            }
            "POINT_DATA" => {
                let Wanted::Arrays(accepts) = wanted else { break };
                let count = rest.count()?;
                rest.attributes(count, *accepts, &mut piece)?;
                break;
            }
            "CELL_DATA" => {
                let Wanted::Arrays(_) = wanted else { break };
                let count = rest.count()?;
                rest.attributes(count, &|_| false, &mut Piece::default())?;
            }
            other => return Err(format!("{:?} in a legacy VTK file", shortened(other))),
        }
    }
    if grid.is_empty() { Ok(piece) } else { Err("cells without types".to_owned()) }
}

impl Rest<'_> {
    /// The next line, without its end.
    fn line(&mut self) -> &[u8] {
        let end = self.bytes.iter().position(|byte| *byte == b'\n').unwrap_or(self.bytes.len());
        let (line, rest) = self.bytes.split_at(end);
        self.bytes = rest.get(1..).unwrap_or_default();
        line
    }

    /// The next word, if there is one.
    fn word(&mut self) -> Option<String> {
        let text = self.bytes.trim_ascii_start();
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        self.bytes = rest;
        (!word.is_empty()).then(|| String::from_utf8_lossy(word).into_owned())
    }

    /// The next word, which is needed.
    fn needed(&mut self, what: &str) -> Result<String, String> {
        self.word().ok_or_else(|| format!("a legacy VTK file that ends where {what} should stand"))
    }

    /// The next word as a count.
    fn count(&mut self) -> Result<usize, String> {
        let word = self.needed("a count")?;
        word.parse().map_err(|_| format!("{:?} where a count should stand", shortened(&word)))
    }

    /// Reads `count` groups of numbers; binary ones stand behind the end of the line.
    fn numbers(&mut self, count: usize, each: usize, kind: &str, name: &str) -> Result<Vec<f64>, String> {
        let number = match kind.to_lowercase().as_str() {
            "double" => Number::Real(8),
            "float" => Number::Real(4),
            "char" | "signed_char" => Number::Signed(1),
            "unsigned_char" => Number::Unsigned(1),
            "short" => Number::Signed(2),
            "unsigned_short" => Number::Unsigned(2),
            "int" | "vtkidtype" => Number::Signed(4),
            "unsigned_int" => Number::Unsigned(4),
            "long" | "vtktypeint64" => Number::Signed(8),
            "unsigned_long" | "vtktypeuint64" => Number::Unsigned(8),
            _ => return Err(format!("numbers of type {:?} in {name}", shortened(kind))),
        };
        let short = || format!("fewer numbers of {name} than the {count} that are announced");
        let total = count.checked_mul(each).ok_or_else(short)?;
        // A number takes a letter and a space at least.
        let size = if self.ascii { 2 } else { number.size() };
        let length = total.checked_mul(size).filter(|length| *length <= self.bytes.len() + 1).ok_or_else(short)?;
        memory_for(length, name)?;
        if !self.ascii {
            self.line();
            let (bytes, rest) = self.bytes.split_at_checked(length).ok_or_else(short)?;
            self.bytes = rest;
            return Ok(number.all(bytes, Order::Big));
        }
        let mut numbers = Vec::with_capacity(total);
        for _ in 0..total {
            let word = self.word().ok_or_else(short)?;
            numbers.push(word.parse().map_err(|_| format!("{:?} among the numbers of {name}", shortened(&word)))?);
        }
        Ok(numbers)
    }

    /// The corners of each cell of a list.
    fn cells(&mut self, divided: bool) -> Result<Vec<Vec<usize>>, String> {
        let (count, size) = (self.count()?, self.count()?);
        let name = "corners";
        if divided {
            if count == 0 {
                return Ok(Vec::new());
            }
            let mut list = |keyword: &str, count: usize| {
                let found = self.needed(keyword)?;
                if found != keyword {
                    return Err(format!("{:?} instead of {keyword}", shortened(&found)));
                }
                let kind = self.needed("a type")?;
                self.numbers(count, 1, &kind, name)
            };
            let (ends, corners) = (list("OFFSETS", count)?, list("CONNECTIVITY", size)?);
            return Ok(cells(&corners, &ends[1..], |_| Some(0))?.into_iter().map(|cell| cell.corners).collect());
        }
        let numbers = self.numbers(size, 1, "int", name)?;
        let mut rest = &numbers[..];
        let mut lists = Vec::new();
        for _ in 0..count {
            let corners = rest.split_first().and_then(|(length, after)| after.split_at_checked(*length as usize));
            let (corners, after) = corners.ok_or("a list of corners that is cut short")?;
            lists.push(corners.iter().map(|corner| *corner as usize).collect());
            rest = after;
        }
        Ok(lists)
    }

    /// Passes over what belongs to an array beside its numbers: it ends with an empty line.
    fn metadata(&mut self) {
        self.line();
        while !self.bytes.is_empty() && !self.line().trim_ascii().is_empty() {}
    }

    /// Arrays of points or cells, up to the next kind of them. `count`: how many points or cells there are.
    fn attributes(&mut self, count: usize, accepts: &dyn Fn(&str) -> bool, piece: &mut Piece) -> Result<(), String> {
        loop {
            let before = self.bytes;
            let Some(keyword) = self.word() else { return Ok(()) };
            let keyword = keyword.to_uppercase();
            if keyword == "METADATA" {
                self.metadata();
                continue;
            }
            if keyword == "POINT_DATA" || keyword == "CELL_DATA" {
                self.bytes = before;
                return Ok(());
            }
            let name = readable(&self.needed("a name")?);
            let (components, kind) = match keyword.as_str() {
                "SCALARS" => self.scalars()?,
                "VECTORS" | "NORMALS" => (3, self.needed("a type")?),
                "TENSORS" => (9, self.needed("a type")?),
                "TENSORS6" => (6, self.needed("a type")?),
                "GLOBAL_IDS" | "PEDIGREE_IDS" => (1, self.needed("a type")?),
                "TEXTURE_COORDINATES" => (self.count()?, self.needed("a type")?),
                "COLOR_SCALARS" => (self.count()?, self.color().to_owned()),
                "LOOKUP_TABLE" => {
                    let (rows, kind) = (self.count()?, self.color());
                    self.numbers(rows, 4, kind, &name)?;
                    continue;
                }
                "FIELD" => {
                    self.field(&mut |name| accepts(name), piece)?;
                    continue;
                }
                other => return Err(format!("{:?} in a legacy VTK file", shortened(other))),
            };
            let values = self.numbers(count, components, &kind, &name)?;
            if accepts(&name) {
                piece.arrays.push(Array { name, components, values });
            }
        }
    }

    /// Components and type of scalars, whose lookup table is named behind them.
    fn scalars(&mut self) -> Result<(usize, String), String> {
        let kind = self.needed("a type")?;
        let mut next = self.needed("LOOKUP_TABLE")?;
        let mut components = 1;
        if let Ok(count) = next.parse() {
            components = count;
            next = self.needed("LOOKUP_TABLE")?;
        }
        if next.to_uppercase() != "LOOKUP_TABLE" {
            return Err(format!("{:?} instead of LOOKUP_TABLE", shortened(&next)));
        }
        self.needed("the name of a table")?;
        Ok((components, kind))
    }

    /// The type of colours.
    fn color(&self) -> &'static str {
        if self.ascii { "float" } else { "unsigned_char" }
    }

    /// The arrays of a field.
    fn field(&mut self, accepts: &mut dyn FnMut(&str) -> bool, piece: &mut Piece) -> Result<(), String> {
        let arrays = self.count()?;
        let mut read = 0;
        while read < arrays {
            let name = self.needed("a name")?;
            if name == "METADATA" {
                self.metadata();
                continue;
            }
            let name = readable(&name);
            let (components, count, kind) = (self.count()?, self.count()?, self.needed("a type")?);
            read += 1;
            if kind == "string" {
                self.pass_strings(count.saturating_mul(components), &name)?;
                continue;
            }
            let values = self.numbers(count, components, &kind, &name)?;
            if accepts(&name) {
                piece.arrays.push(Array { name, components, values });
            }
        }
        Ok(())
    }

    /// Passes over so many strings: lines, or bytes behind a length whose first two bits say how long it is itself.
    fn pass_strings(&mut self, count: usize, name: &str) -> Result<(), String> {
        let short = || format!("fewer strings of {name} than the {count} that are announced");
        self.line();
        for _ in 0..count {
            let first = *self.bytes.first().ok_or_else(short)?;
            if self.ascii {
                self.line();
                continue;
            }
            let (head, rest) = self.bytes.split_at_checked(8 >> (first >> 6)).ok_or_else(short)?;
            let all = head[1..].iter().fold(u64::from(first & 0x3F), |length, byte| length << 8 | u64::from(*byte));
            self.bytes = usize::try_from(all).ok().and_then(|length| rest.get(length..)).ok_or_else(short)?;
        }
        Ok(())
    }
}

/// A name without the code that stands for blanks and the like: `%20`.
fn readable(name: &str) -> String {
    let mut parts = name.split('%');
    let mut readable = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.get(..2).and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(code) => {
                readable.push(char::from(code));
                readable.push_str(&part[2..]);
            }
            None => {
                readable.push('%');
                readable.push_str(part);
            }
        }
    }
    readable
}
