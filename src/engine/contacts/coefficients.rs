//! Coefficients of a contact law for each two materials of a scene.

use super::ahead::{Frame, Meeting, frames};
use crate::laws::contact::batch::CoefficientRows;
use crate::laws::contact::{Contact, Law, MOST_HISTORY, MaterialPair};
use crate::scene::{ContactLaw, Scene};

/// The coefficients that the scene gives a law for all pairs of materials it governs, row by row; others get zeros.
pub(crate) fn rows(law: &ContactLaw, scene: &Scene) -> Vec<f64> {
    let (choice, materials) = (law.choice, scene.materials.len());
    let count = Law::of(&choice).places().count;
    let row = |entry: usize| {
        let (a, b) = (&scene.materials[entry / materials], &scene.materials[entry % materials]);
        let pair = MaterialPair { a, b, properties: &scene.pairs[entry] };
        let row = if law.between[entry] { choice.coefficients(&pair).ok() } else { None };
        row.unwrap_or_else(|| vec![0.0; count])
    };
    (0..materials * materials).flat_map(row).collect()
}

/// Most iterations for the overlap at which a contact holds a given energy. The error of its logarithm shrinks to a
/// quarter in each for Hertz's law; for a linear spring the first is exact.
const ITERATIONS: usize = 12;

/// Relative change of the overlap below which they end; what is left of the error is added.
const SAME: f64 = 2e-3;

/// Overlap over the effective radius below which no impact is thought: what touches has a stiffness.
const LEAST_OVERLAP: f64 = 1e-12;

/// A law and its coefficients for two materials.
#[derive(Clone, Copy)]
pub(crate) struct MaterialRow<'a> {
    /// Index of the law, and those of the materials, ascending.
    pub key: (u32, [u32; 2]),
    /// The law.
    pub law: &'a Law,
    /// The coefficients.
    pub row: &'a [f64],
}

/// Coefficients of a law for each two materials of the scene.
#[derive(Clone, Debug)]
pub(crate) struct CoefficientTable {
    /// A row of coefficients for each two materials.
    rows: Vec<f64>,
    /// How many coefficients a row has.
    count: usize,
    /// How many materials there are.
    materials: usize,
    /// The one material that all particles of the scene are made of, if it is one.
    single: Option<u32>,
    /// Whether the law governs these two materials.
    governed: Vec<bool>,
}

impl CoefficientTable {
    /// The table of a law with the coefficients that the scene gives it; those of a state are taken over by
    /// [`CoefficientTable::take`].
    pub(crate) fn of(law: &ContactLaw, scene: &Scene) -> Self {
        let (count, materials) = (Law::of(&law.choice).places().count, scene.materials.len());
        let now = scene.particles.iter().map(|particle| particle.material.0);
        let mut present = now.chain(scene.insertions.iter().map(|insertion| insertion.material.0));
        let single = present.next().filter(|&first| present.all(|other| other == first));
        Self { rows: rows(law, scene), count, materials, single, governed: law.between.clone() }
    }

    /// Takes over the coefficients of a state.
    pub(crate) fn take(&mut self, rows: &[f64]) {
        self.rows.copy_from_slice(rows);
    }

    /// A table of these rows for so many materials, for tests.
    #[cfg(test)]
    pub(crate) fn of_rows(rows: Vec<f64>, materials: usize) -> Self {
        let count = rows.len() / (materials * materials);
        let governed = vec![true; materials * materials];
        Self { rows, count, materials, single: None, governed }
    }

    /// The one row that all particles have with each other, if it is one.
    #[inline(always)]
    pub(crate) fn uniform(&self) -> Option<&[f64]> {
        self.uniform_with(self.single?)
    }

    /// The number of the one row that all particles have with each other, if it is one.
    pub(crate) fn uniform_entry(&self) -> Option<u32> {
        self.uniform_entry_with(self.single?)
    }

    /// The same with this material.
    pub(crate) fn uniform_entry_with(&self, material: u32) -> Option<u32> {
        Some(self.entry(self.single?, material))
    }

    /// The one row that all particles have with this material, if it is one.
    #[inline(always)]
    pub(crate) fn uniform_with(&self, material: u32) -> Option<&[f64]> {
        Some(self.row(self.single?, material))
    }

    /// The number of the row of two materials.
    #[inline(always)]
    pub(crate) fn entry(&self, a: u32, b: u32) -> u32 {
        a * self.materials as u32 + b
    }

    /// Its rows.
    pub(crate) fn rows(&self) -> CoefficientRows<'_> {
        CoefficientRows { numbers: &self.rows, count: self.count }
    }

    /// Springs and dashpots at the deepest point of a head-on impact of bodies of these materials, where the spring has taken up the
    /// kinetic energy; none where the law does not govern them.
    pub(crate) fn impact(&self, law: &Law, [a, b]: [u32; 2], meeting: &Meeting) -> Option<[Frame; 2]> {
        if !self.governed[self.entry(a, b) as usize] {
            return None;
        }
        let row = self.row(a, b);
        let radius = meeting.contact.radius;
        let contact = Contact { pair_constant: law.pair_constant(row, radius, meeting.mass), ..meeting.contact };
        let overlap = overlap_of((law, row, &contact), [meeting.energy, 0.0], radius).max(LEAST_OVERLAP * radius);
        Some(frames(law, row, &Contact { overlap, ..contact }))
    }

    /// The coefficients of a law of this index for two materials, where it governs them.
    pub(crate) fn material_row<'a>(&'a self, index: u32, law: &'a Law, [a, b]: [u32; 2]) -> Option<MaterialRow<'a>> {
        let governed = self.governed[self.entry(a, b) as usize];
        governed.then(|| MaterialRow { key: (index, [a.min(b), a.max(b)]), law, row: self.row(a, b) })
    }

    /// The coefficients for two materials.
    pub(crate) fn row(&self, a: u32, b: u32) -> &[f64] {
        let entry = a as usize * self.materials + b as usize;
        &self.rows[entry * self.count..(entry + 1) * self.count]
    }
}

/// The overlap at which the normal force of a contact holds this energy \[J\] and the work that a load \[N\] does on the way there from
/// the overlap that it has, or from touch; at most `most` \[m\].
pub(crate) fn overlap_of((law, row, contact): (&Law, &[f64], &Contact), [energy, load]: [f64; 2], most: f64) -> f64 {
    let held = |overlap: f64| law.elastic_energy(row, &Contact { overlap, ..*contact }, 0.0, &[[0.0; 4]; MOST_HISTORY]);
    let (from, mut overlap) = (contact.overlap.max(0.0), most);
    for _ in 0..ITERATIONS {
        let ratio = (energy + load * (overlap - from).max(0.0)) / held(overlap);
        // Not a number where there is neither energy nor stiffness.
        if !ratio.is_finite() || (overlap >= most && ratio >= 1.0) {
            return most;
        }
        let next = overlap * ratio.sqrt();
        let change = (next - overlap).abs();
        overlap = next;
        if change <= SAME * overlap {
            break;
        }
    }
    ((1.0 + SAME) * overlap).min(most)
}
