//! `bonds.csv`: pairs that interact, with what they remember.

use super::case::Case;
use super::error::VerifyError;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A pair of particles at one step; vectors are those on the first of the two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PairRow {
    /// Places in the scene, ascending.
    pub(super) bodies: [u32; 2],
    /// Whether a bond holds them.
    pub(super) bonded: bool,
    /// Force of contact and bond \[N\].
    pub(super) force: [f64; 3],
    /// Distance at which the bond bears no normal force \[m\].
    pub(super) rest: f64,
    /// Shear force \[N\].
    pub(super) shear: [f64; 3],
    /// Torsion \[N m\].
    pub(super) torsion: [f64; 3],
    /// Bending torque \[N m\].
    pub(super) bending: [f64; 3],
    /// Tangential spring of the contact \[m\].
    pub(super) spring: [f64; 3],
    /// Overlap from which the contact presses \[m\].
    pub(super) offset: f64,
}

/// The interacting pairs at each sampled step.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    /// By step.
    steps: BTreeMap<u64, Vec<PairRow>>,
}

/// Columns that must be there, in this order here: pairs of numbers, then vectors by their first component.
const COLUMNS: [&str; 11] =
    ["step", "id1", "id2", "bonded", "d0", "fx", "ftx", "tnx", "ttx", "shearx", "overlap_offset"];

/// How many of them must be there.
const NEEDED: usize = 9;

impl History {
    /// Reads the bonds of a case, if there are any.
    pub(super) fn read(path: &Path, case: &Case) -> Result<Option<Self>, VerifyError> {
        if !case.bonds() || !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(path).map_err(|cause| VerifyError::file(path, &cause))?;
        let wrong = |line, message| VerifyError::Samples { path: path.to_path_buf(), line, message };
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let header: Vec<&str> = lines.next().map_or("", |(_, line)| line).split(',').map(str::trim).collect();
        let places = COLUMNS.map(|column| header.iter().position(|name| *name == column));
        if let Some(missing) = (0..NEEDED).find(|column| places[*column].is_none()) {
            return Err(wrong(1, format!("no column \"{}\"", COLUMNS[missing])));
        }
        let index_of: BTreeMap<u32, u32> =
            case.by_id().into_iter().map(|particle| case.particles[particle].id).zip(0..).collect();
        let mut steps: BTreeMap<u64, Vec<PairRow>> = BTreeMap::new();
        for (line, text) in lines {
            let (step, row) = parse(text, &places, &index_of).map_err(|message| wrong(line, message))?;
            steps.entry(step).or_default().push(row);
        }
        Ok(Some(Self { steps }))
    }

    /// The pairs at a step; a pair that is not there does not interact.
    pub(super) fn at(&self, step: u64) -> &[PairRow] {
        self.steps.get(&step).map_or(&[], Vec::as_slice)
    }

    /// All pairs of all steps.
    pub(super) fn all(&self) -> impl Iterator<Item = &PairRow> {
        self.steps.values().flatten()
    }
}

/// Step and pair of one line.
fn parse(
    line: &str,
    places: &[Option<usize>; COLUMNS.len()],
    index_of: &BTreeMap<u32, u32>,
) -> Result<(u64, PairRow), String> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let number = |column: usize, offset: usize| match places[column] {
        None => Ok(0.0),
        Some(place) => {
            let text = fields.get(place + offset).copied().unwrap_or_default();
            let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| format!("{}: expected a finite number, found \"{text}\"", COLUMNS[column]))
        }
    };
    let body = |column: usize| {
        let id = number(column, 0)?;
        let index = index_of.get(&(id as u32)).copied();
        index.ok_or_else(|| format!("{} {id} is not a particle of the case", COLUMNS[column]))
    };
    let (one, other) = (body(1)?, body(2)?);
    if one == other {
        return Err("a pair of a particle with itself".into());
    }
    let sign = if one < other { 1.0 } else { -1.0 };
    let vector =
        |column| Ok::<_, String>([sign * number(column, 0)?, sign * number(column, 1)?, sign * number(column, 2)?]);
    let bonded = number(3, 0)? > 0.5;
    let mut row = PairRow {
        bodies: [one.min(other), one.max(other)],
        bonded,
        force: vector(5)?,
        spring: vector(9)?,
        offset: number(10, 0)?,
        ..PairRow::default()
    };
    if bonded {
        (row.rest, row.shear, row.torsion, row.bending) = (number(4, 0)?, vector(6)?, vector(7)?, vector(8)?);
    }
    Ok((number(0, 0)? as u64, row))
}
