//! Dump files of LIGGGHTS and LAMMPS in text form: one or more snapshots of named columns.

use super::fault::{crossed, non_spherical};
use super::file_box::Bounds;
use super::rows::{DIGITS, largest};
use super::{FileBox, FileFault, REPORTED, Request, Rows};
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;

/// A line of text and its number.
type Line<'a> = (usize, &'a str);

/// One snapshot, not yet read.
#[derive(Default)]
struct Snapshot<'a> {
    /// Its time step.
    timestep: Option<u64>,
    /// How many lines of atoms it announces.
    announced: Option<usize>,
    /// What follows `BOX BOUNDS`.
    faces: Line<'a>,
    /// Lines of the box.
    bounds: Vec<Line<'a>>,
    /// Names of the columns.
    columns: Line<'a>,
    /// Lines of the atoms.
    atoms: Vec<Line<'a>>,
    /// Where its last `ITEM:` stands.
    last: Option<usize>,
}

/// Reads the text of a dump file, and the units it states.
pub(crate) fn read(text: &str, request: &Request) -> Result<(Rows, Option<String>), Vec<FileFault>> {
    let (snapshots, units) = snapshots(text);
    let chosen = match request.timestep {
        None => snapshots.last(),
        Some(timestep) => snapshots.iter().find(|snapshot| snapshot.timestep == Some(timestep)),
    };
    let Some(chosen) = chosen else {
        let steps: Vec<String> =
            snapshots.iter().filter_map(|snapshot| snapshot.timestep.map(|step| step.to_string())).collect();
        let found =
            request.timestep.filter(|_| !steps.is_empty()).map_or("no snapshot".to_owned(), |step| step.to_string());
        let expected = if steps.is_empty() {
            "a dump file".to_owned()
        } else {
            format!("one of the time steps {}", steps.join(", "))
        };
        return Err(vec![FileFault::whole(Mistake::Unexpected { found, expected })]);
    };
    chosen.read(request).map(|rows| (rows, units))
}

/// Finds the snapshots, and the units that the file states once.
fn snapshots(text: &str) -> (Vec<Snapshot<'_>>, Option<String>) {
    let mut snapshots: Vec<Snapshot> = Vec::new();
    let mut units = None;
    let mut item = "";
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(name) = line.strip_prefix("ITEM:") {
            item = name.trim();
            if item == "TIMESTEP" {
                snapshots.push(Snapshot::default());
            }
            if let Some(snapshot) = snapshots.last_mut() {
                snapshot.last = Some(number);
                if let Some(faces) = item.strip_prefix("BOX BOUNDS") {
                    snapshot.faces = (number, faces);
                } else if let Some(columns) = item.strip_prefix("ATOMS") {
                    snapshot.columns = (number, columns);
                }
            }
            continue;
        }
        if item == "UNITS" {
            units = Some(line.trim().to_owned());
        }
        let Some(snapshot) = snapshots.last_mut() else { continue };
        match item {
            "TIMESTEP" => snapshot.timestep = line.trim().parse().ok(),
            "NUMBER OF ATOMS" => snapshot.announced = line.trim().parse().ok(),
            _ if item.starts_with("BOX BOUNDS") => snapshot.bounds.push((number, line)),
            _ if item.starts_with("ATOMS") && !line.trim().is_empty() => snapshot.atoms.push((number, line)),
            _ => {}
        }
    }
    (snapshots, units)
}

/// Columns that name the material of an atom, in the order in which one of them is chosen.
const LABELS: [&str; 3] = ["type", "typelabel", "element"];

/// The name here of a column there; `None` for one that is not read as a number.
fn known<'a>(column: &'a str, request: &Request) -> Option<&'a str> {
    match column {
        "xu" | "xs" | "xsu" => Some("x"),
        "yu" | "ys" | "ysu" => Some("y"),
        "zu" | "zs" | "zsu" => Some("z"),
        "omegax" => Some("wx"),
        "omegay" => Some("wy"),
        "omegaz" => Some("wz"),
        "diameter" | "ix" | "iy" | "iz" => Some(column),
        _ => request.reads(column).then_some(column),
    }
}

/// Columns that say how often an atom crossed the faces of the box.
const FLAGS: [&str; 3] = ["ix", "iy", "iz"];

/// Whether a column holds places in the box.
fn is_wrapped(column: &str) -> bool {
    ["x", "y", "z", "xs", "ys", "zs"].contains(&column)
}

/// Whether a column holds shares of the box.
fn is_scaled(column: &str) -> bool {
    ["xs", "ys", "zs", "xsu", "ysu", "zsu"].contains(&column)
}

impl Snapshot<'_> {
    /// Reads the atoms.
    fn read(&self, request: &Request) -> Result<Rows, Vec<FileFault>> {
        let (line, columns) = self.columns;
        let columns: Vec<&str> = columns.split_whitespace().collect();
        if columns.iter().any(|column| ["shapex", "quatw", "blockiness1"].contains(column)) {
            return Err(non_spherical(line));
        }
        if self.announced != Some(self.atoms.len()) {
            let found = self.announced.map_or("none before the atoms".to_owned(), |_| self.atoms.len().to_string());
            let expected = self
                .announced
                .map_or("ITEM: NUMBER OF ATOMS".to_owned(), |count| format!("{count} lines of atoms, as announced"));
            let line = Some(line).filter(|line| *line > 0).or(self.last);
            return Err(vec![FileFault {
                line,
                column: String::new(),
                mistake: Mistake::Unexpected { found, expected },
            }]);
        }
        let names: Vec<Option<&str>> = columns.iter().map(|column| known(column, request)).collect();
        let mut present: Vec<String> = names.iter().flatten().map(|name| (*name).to_owned()).collect();
        if present.iter().any(|name| name == "diameter") {
            present.push("radius".to_owned());
        }
        let line = Some(line).filter(|line| *line > 0).or(self.last);
        request.needed(&present, line).map_err(|missing| found_columns(missing, &columns))?;
        let left_out = columns
            .iter()
            .zip(&names)
            .filter(|(column, name)| name.is_none() && !LABELS.contains(*column) && request.misses(column));
        let label = LABELS.into_iter().find(|label| columns.contains(label));
        let mut rows = Rows {
            count: self.atoms.len(),
            label_column: label.unwrap_or_default().to_owned(),
            lines: self.atoms.iter().map(|(line, _)| *line as u32).collect(),
            left_out: left_out.map(|(column, _)| (*column).to_owned()).collect(),
            ..Rows::default()
        };
        let mut numbers = self.numbers(&columns, &names, &mut rows)?;
        self.unscale(&columns, &mut numbers)?;
        rows.around = self.around()?;
        let flagged = self.unwrap(&columns, &mut numbers, rows.around.as_ref())?;
        let unwrapped = axes(&columns, ["u", "su"]);
        let lattice = rows.around.filter(|around| !flagged && around.is_periodic()).map(|around| around.lattice);
        if let Some(lattice) = lattice {
            self.expect_images(&columns, &numbers, unwrapped, &lattice)?;
        }
        // Where nothing says how often a particle crossed, its place in the box is another one than that without the box.
        let is_other = |column: &str| {
            let axis = ["x", "y", "z"].iter().position(|axis| column.starts_with(axis));
            lattice.is_some() && is_wrapped(column) && axis.is_some_and(|axis| unwrapped[axis].is_some())
        };
        // Places as such are taken before those made of shares of the box, which have fewer digits.
        for scaled in [false, true] {
            for ((column, name), numbers) in columns.iter().zip(&names).zip(&mut numbers) {
                if let Some(name) = name.filter(|_| is_scaled(column) == scaled && !is_other(column)) {
                    self.take(name, column, std::mem::take(numbers), &mut rows)?;
                }
            }
        }
        rows.expect_labels()?;
        Ok(rows)
    }

    /// Takes the numbers of a column.
    fn take(&self, name: &str, column: &str, numbers: Vec<f64>, rows: &mut Rows) -> Result<(), Vec<FileFault>> {
        if FLAGS.contains(&name) {
            return Ok(());
        }
        // Shares have as many digits of the box as places have of themselves.
        let box_size = if is_scaled(column) {
            self.edges().map_or(0.0, |(low, edges)| largest(&low) + largest(edges.as_flattened()))
        } else {
            0.0
        };
        rows.insert_again(name, column, numbers, DIGITS * box_size)
    }

    /// Reads the numbers of each column, and the labels.
    fn numbers(
        &self,
        columns: &[&str],
        names: &[Option<&str>],
        rows: &mut Rows,
    ) -> Result<Vec<Vec<f64>>, Vec<FileFault>> {
        let mut numbers = vec![Vec::new(); names.len()];
        let mut faults = Vec::new();
        for (line, text) in &self.atoms {
            let mut label = None;
            let mut count = 0;
            for ((word, name), (column, numbers)) in
                text.split_whitespace().zip(names).zip(columns.iter().zip(&mut numbers))
            {
                count += 1;
                if *column == rows.label_column {
                    match label {
                        None => rows.push_label(word),
                        Some(first) if first != word => {
                            let found = format!("{first} and {word} in two columns of this name");
                            let expected = "the same in both".to_owned();
                            faults.push(FileFault::at(*line, column, Mistake::Unexpected { found, expected }));
                        }
                        Some(_) => {}
                    }
                    label = Some(word);
                } else if name.is_some() {
                    match word.parse::<f64>() {
                        Ok(value) if value.is_finite() => numbers.push(value),
                        _ => faults.push(FileFault::number(*line, column, word)),
                    }
                }
            }
            if count != names.len() || text.split_whitespace().count() != count {
                let (found, expected) =
                    (text.split_whitespace().count().to_string(), format!("{} numbers", names.len()));
                faults.push(FileFault::at(*line, "", Mistake::Unexpected { found, expected }));
            }
            if faults.len() >= REPORTED {
                break;
            }
        }
        if faults.is_empty() { Ok(numbers) } else { Err(faults) }
    }

    /// The box and along which edges it repeats; none where it has no bounds or does not repeat.
    fn around(&self) -> Result<Option<FileBox>, Vec<FileFault>> {
        let line = self.faces.0;
        let mut faces = self.faces.1.split_whitespace().rev();
        let mut repeats = || faces.next() == Some("pp");
        let [z, y, x] = [(); 3].map(|()| repeats());
        if [x, y, z] == [false; 3] {
            return Ok(None);
        }
        let Some((low, edges)) = self.edges() else {
            let (found, expected) = ("no bounds of the box".to_owned(), "a lower and an upper one".to_owned());
            return Err(vec![FileFault::at(line, "", Mistake::Unexpected { found, expected })]);
        };
        let lattice = Bounds { low, edges }.lattice(Some(line))?;
        let lattice = Lattice { periodic: [x, y, z], ..lattice };
        Ok(Some(FileBox { lattice, is_told: true, line: Some(line), is_crossed: false }))
    }

    /// From places in the box to those where atoms are that crossed its faces. Returns whether the file says which did.
    fn unwrap(
        &self,
        columns: &[&str],
        numbers: &mut [Vec<f64>],
        around: Option<&FileBox>,
    ) -> Result<bool, Vec<FileFault>> {
        let flags = FLAGS.map(|flag| columns.iter().position(|column| *column == flag));
        let flags = match flags {
            [None, None, None] => return Ok(false),
            [Some(x), Some(y), Some(z)] => [x, y, z].map(|column| numbers[column].clone()),
            _ => {
                let named = |there: bool| {
                    let names = FLAGS.iter().zip(flags).filter(|(_, flag)| flag.is_some() == there);
                    names.map(|(name, _)| *name).collect::<Vec<_>>().join(" and ")
                };
                let found = format!("{} without {}", named(true), named(false));
                let mistake = Mistake::Unexpected { found, expected: "all three, or none".to_owned() };
                return Err(vec![FileFault::at(self.columns.0, "", mistake)]);
            }
        };
        for row in 0..self.atoms.len() {
            let count = [0, 1, 2].map(|axis| flags[axis][row] as i64);
            if count == [0; 3] {
                continue;
            }
            let lattice = around.map(|around| around.lattice);
            let repeats = lattice.map_or([false; 3], |lattice| lattice.periodic);
            let Some(lattice) = lattice.filter(|_| (0..3).all(|axis| count[axis] == 0 || repeats[axis])) else {
                return Err(crossed(self.atoms[row].0));
            };
            let shift = lattice.displacement(count);
            for (column, numbers) in columns.iter().zip(&mut *numbers).filter(|(column, _)| is_wrapped(column)) {
                let axis = ["x", "y", "z"].iter().position(|axis| column.starts_with(axis)).unwrap_or(0);
                numbers[row] += shift[axis];
            }
        }
        Ok(true)
    }

    /// Refuses places in a box that are no images of those without it, and images of which a part is not told.
    fn expect_images(
        &self,
        columns: &[&str],
        numbers: &[Vec<f64>],
        unwrapped: [Option<usize>; 3],
        lattice: &Lattice,
    ) -> Result<(), Vec<FileFault>> {
        let refuse = |line: usize, found: String, expected: &str| {
            Err(vec![FileFault::at(line, "", Mistake::Unexpected { found, expected: expected.to_owned() })])
        };
        let [Some(x), Some(y), Some(z)] = unwrapped else {
            // An edge that leans leads along several axes at once.
            let leans = lattice.edges[1][0] != 0.0 || lattice.edges[2][0] != 0.0 || lattice.edges[2][1] != 0.0;
            return if leans && unwrapped != [None; 3] {
                refuse(
                    self.columns.0,
                    "one or two of them".to_owned(),
                    "all of xu, yu, zu of a box that leans, or none",
                )
            } else {
                Ok(())
            };
        };
        let [Some(u), Some(v), Some(w)] = axes(columns, ["", "s"]) else { return Ok(()) };
        let all = [x, y, z, u, v, w].iter().map(|&column| largest(&numbers[column])).fold(0.0, f64::max);
        let tolerance = DIGITS * (all + largest(&lattice.origin) + largest(lattice.edges.as_flattened()));
        for (row, (line, _)) in self.atoms.iter().enumerate() {
            let (free, inside) =
                ([x, y, z].map(|column| numbers[column][row]), [u, v, w].map(|column| numbers[column][row]));
            if lattice.nearest(free, inside).iter().any(|part| part.abs() > tolerance) {
                let found = format!("{free:?} without the faces and {inside:?} in the box");
                return refuse(*line, found, "places that are whole edges of the box apart");
            }
        }
        Ok(())
    }

    /// The box of these shares: where it begins, and its three edges.
    fn edges(&self) -> Option<([f64; 3], [[f64; 3]; 3])> {
        let bound = |axis: usize, place: usize| -> Option<f64> {
            self.bounds.get(axis)?.1.split_whitespace().nth(place)?.parse().ok().filter(|bound: &f64| bound.is_finite())
        };
        if self.faces.1.contains("abc") {
            let row = |axis: usize| Some([bound(axis, 0)?, bound(axis, 1)?, bound(axis, 2)?, bound(axis, 3)?]);
            let rows = [row(0)?, row(1)?, row(2)?];
            return Some((rows.map(|row| row[3]), rows.map(|[x, y, z, _]| [x, y, z])));
        }
        let bounds = [0, 1, 2].map(|axis| Some([bound(axis, 0)?, bound(axis, 1)?]));
        let [Some(x), Some(y), Some(z)] = bounds else { return None };
        // Bounds of a tilted box are those of the smallest upright one around it.
        let tilted = self.faces.1.contains("xy");
        let tilt = |axis| if tilted { bound(axis, 2) } else { Some(0.0) };
        let (xy, xz, yz) = (tilt(0)?, tilt(1)?, tilt(2)?);
        let low = [x[0] - 0.0_f64.min(xy).min(xz).min(xy + xz), y[0] - 0.0_f64.min(yz), z[0]];
        let high = [x[1] - 0.0_f64.max(xy).max(xz).max(xy + xz), y[1] - 0.0_f64.max(yz), z[1]];
        Some((low, [[high[0] - low[0], 0.0, 0.0], [xy, high[1] - low[1], 0.0], [xz, yz, high[2] - low[2]]]))
    }

    /// From shares of the box to positions.
    fn unscale(&self, columns: &[&str], numbers: &mut [Vec<f64>]) -> Result<(), Vec<FileFault>> {
        if !columns.iter().any(|column| is_scaled(column)) {
            return Ok(());
        }
        let refuse = |found: &str, expected: &str| {
            let mistake = Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() };
            Err(vec![FileFault::at(self.faces.0.max(1), "", mistake)])
        };
        let Some((low, edges)) = self.edges() else {
            return refuse("no bounds of the box", "a lower and an upper one");
        };
        let tilted = edges[1][0] != 0.0 || edges[2][0] != 0.0 || edges[2][1] != 0.0;
        for shares in ["s", "su"].map(|end| axes(columns, [end; 2])) {
            let [Some(x), Some(y), Some(z)] = shares else {
                if tilted && shares != [None; 3] {
                    return refuse("a tilted box without all of xs, ys, zs", "all three, or x y z");
                }
                for (axis, column) in shares.into_iter().enumerate() {
                    let Some(column) = column else { continue };
                    numbers[column].iter_mut().for_each(|share| *share = low[axis] + *share * edges[axis][axis]);
                }
                continue;
            };
            for row in 0..self.atoms.len() {
                let share = [x, y, z].map(|column| numbers[column][row]);
                for (axis, column) in [x, y, z].into_iter().enumerate() {
                    // Shares of the axis itself come first: an upright box gives the same bits as one axis alone.
                    let own = low[axis] + share[axis] * edges[axis][axis];
                    let tilts = (axis + 1..3).map(|edge| share[edge] * edges[edge][axis]);
                    numbers[column][row] = tilts.fold(own, |sum, tilt| sum + tilt);
                }
            }
        }
        Ok(())
    }
}

/// Where the columns of the three axes stand that end in one of these ways.
fn axes(columns: &[&str], ends: [&str; 2]) -> [Option<usize>; 3] {
    ["x", "y", "z"]
        .map(|axis| columns.iter().position(|column| column.strip_prefix(axis).is_some_and(|end| ends.contains(&end))))
}

/// Names the columns as the file does.
fn found_columns(missing: Vec<FileFault>, columns: &[&str]) -> Vec<FileFault> {
    let found: Vec<String> = columns.iter().map(|&column| column.to_owned()).collect();
    let renamed = |fault: FileFault| match fault.mistake {
        Mistake::Column { column, .. } => FileFault::missing(fault.line, &column, &found),
        mistake => FileFault { mistake, ..fault },
    };
    missing.into_iter().map(renamed).collect()
}
