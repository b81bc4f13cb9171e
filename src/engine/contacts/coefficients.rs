//! Coefficients of a contact law for each two materials of a scene.

use crate::base::number::Vector;
use crate::laws::contact::batch::CoefficientRows;
use crate::laws::contact::{Contact, Law, MOST_HISTORY, MaterialPair, Response};
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
    /// How many particles of the scene are of each material.
    particles: Vec<usize>,
}

/// Bodies that may meet under a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Partners {
    /// Two particles.
    Particles,
    /// A particle and a boundary of this material.
    Boundary(u32),
}

impl CoefficientTable {
    /// The table of a law with the coefficients that the scene gives it; those of a state are taken over by
    /// [`CoefficientTable::take`].
    pub(crate) fn of(law: &ContactLaw, scene: &Scene) -> Self {
        let (count, materials) = (Law::of(&law.choice).places().count, scene.materials.len());
        let now = scene.particles.iter().map(|particle| particle.material.0);
        let mut present = now.chain(scene.insertions.iter().map(|insertion| insertion.material.0));
        let single = present.next().filter(|&first| present.all(|other| other == first));
        let mut particles = vec![0; materials];
        for particle in &scene.particles {
            particles[particle.material.index()] += 1;
        }
        for insertion in &scene.insertions {
            particles[insertion.material.index()] += 2;
        }
        Self { rows: rows(law, scene), count, materials, single, governed: law.between.clone(), particles }
    }

    /// Takes over the coefficients of a state.
    pub(crate) fn take(&mut self, rows: &[f64]) {
        self.rows.copy_from_slice(rows);
    }

    /// A table of these rows for so many materials, for tests.
    #[cfg(test)]
    pub(crate) fn of_rows(rows: Vec<f64>, materials: usize) -> Self {
        let count = rows.len() / (materials * materials);
        let (governed, particles) = (vec![true; materials * materials], vec![2; materials]);
        Self { rows, count, materials, single: None, governed, particles }
    }

    /// The one row that all particles have with each other, if it is one.
    #[inline(always)]
    pub(crate) fn uniform(&self) -> Option<&[f64]> {
        self.uniform_with(self.single?)
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

    /// The stiffest response of an impact between bodies that the scene has.
    pub(crate) fn stiffest(
        &self,
        law: &Law,
        partners: Partners,
        radius: f64,
        mass: f64,
        speed: f64,
    ) -> Option<Response> {
        let meet = |entry: usize| {
            let (a, b) = (entry / self.materials, entry % self.materials);
            let there = match partners {
                Partners::Particles if a == b => self.particles[a] > 1,
                Partners::Particles => self.particles[a] > 0 && self.particles[b] > 0,
                Partners::Boundary(material) => a == material as usize && self.particles[b] > 0,
            };
            there && self.governed[entry]
        };
        let rows = self.rows.chunks_exact(self.count.max(1)).enumerate().filter(|(entry, _)| meet(*entry));
        let responses = rows.map(|(_, row)| impact(law, row, radius, mass, speed));
        responses.max_by(|a, b| a.normal_stiffness.total_cmp(&b.normal_stiffness))
    }

    /// The coefficients for two materials.
    pub(crate) fn row(&self, a: u32, b: u32) -> &[f64] {
        let entry = a as usize * self.materials + b as usize;
        &self.rows[entry * self.count..(entry + 1) * self.count]
    }
}

/// Stiffness at the deepest point of a head-on impact: where the spring has taken up the kinetic energy.
fn impact(law: &Law, row: &[f64], radius: f64, mass: f64, speed: f64) -> Response {
    let contact = Contact {
        overlap: 0.0,
        radius,
        mass,
        section_area: 0.0,
        section_radius: radius,
        normal: Vector::new(1.0, 0.0, 0.0),
        normal_velocity: 0.0,
        slip: Vector::zero(),
        relative_spin: Vector::zero(),
        spin_sum: Vector::zero(),
        turning: Vector::zero(),
        per_distance: 0.0,
        per_reach: 0.0,
        rolling_inertia: mass * radius * radius,
        pair_constant: law.pair_constant(row, radius, mass),
    };
    let overlap = overlap_of(law, row, &contact, 0.5 * mass * speed * speed, radius);
    law.stiffness(row, &Contact { overlap: overlap.max(LEAST_OVERLAP * radius), ..contact })
}

/// The overlap at which the normal force of a contact holds this energy \[J\], at most `most` \[m\].
pub(crate) fn overlap_of(law: &Law, row: &[f64], contact: &Contact, energy: f64, most: f64) -> f64 {
    let held = |overlap: f64| law.elastic_energy(row, &Contact { overlap, ..*contact }, 0.0, &[[0.0; 4]; MOST_HISTORY]);
    let mut overlap = most;
    for _ in 0..ITERATIONS {
        let ratio = energy / held(overlap);
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
