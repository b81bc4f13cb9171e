//! Dump files of LIGGGHTS and LAMMPS in text form: one or more snapshots of named columns.

use super::{FileFault, POSSIBLE, REPORTED, Request, Rows, needed, non_spherical, periodic};
use crate::document::Mistake;
use std::collections::BTreeMap;

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
        let right = if steps.is_empty() {
            "a dump file".to_owned()
        } else {
            format!("one of the time steps {}", steps.join(", "))
        };
        return Err(vec![FileFault::whole(Mistake::Wrong { found, right })]);
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

/// The name here of a column there; `None` for one that is not read.
fn known(column: &str, extra: &[String]) -> Option<String> {
    let name = match column {
        "xu" | "xs" | "xsu" => "x",
        "yu" | "ys" | "ysu" => "y",
        "zu" | "zs" | "zsu" => "z",
        "omegax" => "wx",
        "omegay" => "wy",
        "omegaz" => "wz",
        "x" | "y" | "z" | "radius" | "diameter" | "mass" | "ix" | "iy" | "iz" => column,
        _ if POSSIBLE.contains(&column) || extra.iter().any(|name| name == column) => column,
        _ => return None,
    };
    Some(name.to_owned())
}

impl Snapshot<'_> {
    /// Reads the atoms.
    fn read(&self, request: &Request) -> Result<Rows, Vec<FileFault>> {
        let (line, columns) = self.columns;
        let columns: Vec<&str> = columns.split_whitespace().collect();
        if self.faces.1.contains("pp") || self.faces.1.contains("xy") {
            return Err(periodic(self.faces.0));
        }
        if columns.iter().any(|column| ["shapex", "quatw", "blockiness1", "id_multisphere"].contains(column)) {
            return Err(non_spherical(line));
        }
        if self.announced != Some(self.atoms.len()) {
            let found = self.announced.map_or("none before the atoms".to_owned(), |_| self.atoms.len().to_string());
            let right = self
                .announced
                .map_or("ITEM: NUMBER OF ATOMS".to_owned(), |count| format!("{count} lines of atoms, as announced"));
            let line = Some(line).filter(|line| *line > 0).or(self.last);
            return Err(vec![FileFault { line, column: String::new(), mistake: Mistake::Wrong { found, right } }]);
        }
        let names: Vec<Option<String>> = columns.iter().map(|column| known(column, request.extra)).collect();
        let mut present: Vec<String> = names.iter().flatten().cloned().collect();
        if present.iter().any(|name| name == "diameter") {
            present.push("radius".to_owned());
        }
        let line = Some(line).filter(|line| *line > 0).or(self.last);
        needed(&present, line).map_err(|missing| found_columns(missing, &columns))?;
        let mut rows = self.atoms(&columns, &names)?;
        self.unscale(&columns, &mut rows)?;
        density_of_mass(&mut rows);
        Ok(rows)
    }

    /// Reads the numbers.
    fn atoms(&self, columns: &[&str], names: &[Option<String>]) -> Result<Rows, Vec<FileFault>> {
        let mut rows = Rows { count: self.atoms.len(), label_column: "type".to_owned(), ..Rows::default() };
        let mut numbers = vec![Vec::new(); names.len()];
        let mut faults = Vec::new();
        for (line, text) in &self.atoms {
            rows.lines.push(*line as u32);
            let mut count = 0;
            for ((word, name), (column, numbers)) in
                text.split_whitespace().zip(names).zip(columns.iter().zip(&mut numbers))
            {
                count += 1;
                match (*column, name) {
                    ("type", _) => rows.push_label(word),
                    (_, None) => {}
                    (column, Some(_)) => match word.parse::<f64>() {
                        Ok(value) if value.is_finite() => numbers.push(value),
                        _ => faults.push(FileFault::number(*line, column, word)),
                    },
                }
            }
            if count != names.len() {
                let (found, right) = (format!("{count}"), format!("{} numbers", names.len()));
                faults.push(FileFault::at(*line, "", Mistake::Wrong { found, right }));
            }
            if faults.len() >= REPORTED {
                break;
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let read: BTreeMap<&str, Vec<f64>> =
            names.iter().zip(numbers).filter_map(|(name, numbers)| Some((name.as_deref()?, numbers))).collect();
        for (name, column) in read {
            if ["ix", "iy", "iz"].contains(&name) {
                if let Some(row) = column.iter().position(|image| *image != 0.0) {
                    return Err(periodic(self.atoms[row].0));
                }
            } else if name != "type" {
                rows.insert(name, column);
            }
        }
        Ok(rows)
    }

    /// From shares of the box to positions.
    fn unscale(&self, columns: &[&str], rows: &mut Rows) -> Result<(), Vec<FileFault>> {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            if !columns.iter().any(|column| [format!("{name}s"), format!("{name}su")].contains(&(*column).to_owned())) {
                continue;
            }
            let bounds = self.bounds.get(axis).map_or(Vec::new(), |(_, line)| {
                line.split_whitespace().map_while(|word| word.parse::<f64>().ok()).collect()
            });
            let [lower, upper] = bounds[..] else {
                let (found, right) = ("no bounds of the box".to_owned(), "a lower and an upper one".to_owned());
                return Err(vec![FileFault::at(self.faces.0, "", Mistake::Wrong { found, right })]);
            };
            if let Some(column) = rows.columns.get_mut(name) {
                column.iter_mut().for_each(|value| *value = lower + *value * (upper - lower));
            }
        }
        Ok(())
    }
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

/// Density of full spheres, where the file has masses instead.
fn density_of_mass(rows: &mut Rows) {
    let Some(mass) = rows.columns.remove("mass") else { return };
    if rows.columns.contains_key("density") {
        return;
    }
    let Some(radius) = rows.columns.get("radius") else { return };
    let volume = |radius: &f64| 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let density = mass.iter().zip(radius).map(|(mass, radius)| mass / volume(radius)).collect();
    rows.insert("density", density);
}
