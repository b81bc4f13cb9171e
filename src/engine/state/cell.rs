//! The periodic cell: how far it is deformed, and which particles are images of others.

use super::check::{MOST, StateFault, all_finite, demand, demand_all};
use super::in_place::clone_in_place;
use super::{IMAGE, Particles, Row, plain};
use crate::base::geometry::lattice::displacement;
use serde::{Deserialize, Serialize};

/// A number for each component of the deformation, in the order of [`STRAINS`](crate::base::geometry::lattice::STRAINS).
pub type Strains = [f64; 6];

/// Three rows of three numbers.
pub type Square = [[f64; 3]; 3];

/// A periodic cell, its images and what deforms it.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellState {
    /// The corner that stays where it is \[m\].
    pub origin: [f64; 3],
    /// Edges without strain; where the cell was brought back by whole edges, what it was brought back to \[m\].
    pub reference: Square,
    /// Edges at the present time \[m\].
    pub edges: Square,
    /// Strains at the present time.
    pub strain: Strains,
    /// Gradient of the streaming velocity in the present time step: rows are components of the velocity \[1/s\].
    pub gradient: Square,
    /// The largest rates in the present communication step \[1/s\].
    pub rate: Strains,
    /// Where it began: strains of driven components, target stresses of servos \[Pa\].
    pub start: Strains,
    /// Where it is to end.
    pub end: Strains,
    /// The last values given: strains, stresses \[Pa\].
    pub target: Strains,
    /// Their rates; 0 where none was given.
    pub target_rate: Strains,
    /// How stiff the cell is to each component, as it was found last; 0 where nothing resists \[Pa\].
    pub stiffness: Strains,
    /// Mean mass of the particles over the third root of the volume for each, as it was found last \[kg/m\].
    pub inertia: f64,
    /// The rates that servos hold beside what they answer to a missing stress \[1/s\].
    pub held_rate: Strains,
    /// By how many edges each of the scene's particles has been brought back into the cell.
    #[serde(with = "plain")]
    pub edges_away: Vec<[i64; 3]>,
    /// Images: particles (slots) that another moves. They stand behind the cell, as near as pairs reach.
    #[serde(with = "plain")]
    pub images: Vec<u32>,
    /// The particle (slot) of each.
    #[serde(with = "plain")]
    pub originals: Vec<u32>,
    /// By how many edges each is displaced from its particle.
    #[serde(with = "plain")]
    pub displaced: Vec<[i64; 3]>,
    /// Sum over contacts and bonds of particles: force times vector from the other body, rows are components of the force \[J\].
    pub virial: Square,
    /// Sum over particles: mass times velocity times velocity at the middle of the last time step \[J\].
    pub kinetic: Square,
    /// Sum over time steps of this communication step: work for each unit of strain, times the time step \[J s\].
    pub action: Strains,
    /// Sum over time steps of this communication step: Cauchy stress times the time step \[Pa s\].
    pub stress_sum: Strains,
    /// Volume when the present communication step began \[m³\].
    pub volume_before: f64,
    /// Mean of the Cauchy stress over the last communication step \[Pa\].
    pub mean_stress: Strains,
    /// Mean over the last communication step of what is conjugate to the strains: work over strain and volume at its start \[Pa\].
    pub conjugate_stress: Strains,
    /// Work done on the particles since time 0 \[J\].
    pub work: f64,
    /// Impulse of the streaming motion on the particles since time 0 \[N s\].
    pub impulse: [f64; 3],
}

clone_in_place!(CellState {
    origin,
    reference,
    edges,
    strain,
    gradient,
    rate,
    start,
    end,
    target,
    target_rate,
    stiffness,
    inertia,
    held_rate,
    edges_away,
    images,
    originals,
    displaced,
    virial,
    kinetic,
    action,
    stress_sum,
    volume_before,
    mean_stress,
    conjugate_stress,
    work,
    impulse
});

impl CellState {
    /// Counts work from here.
    pub(super) fn begin_counting(&mut self) {
        (self.work, self.impulse) = (0.0, [0.0; 3]);
    }

    /// Takes over where another has come to, as the state without strain.
    pub(crate) fn stay(&mut self, ended: Self) {
        (self.reference, self.edges) = (ended.edges, ended.edges);
        (self.stiffness, self.inertia) = (ended.stiffness, ended.inertia);
        (self.edges_away, self.images) = (ended.edges_away, ended.images);
        (self.originals, self.displaced) = (ended.originals, ended.displaced);
    }

    /// Streaming velocity at a place \[m/s\].
    #[inline]
    pub(crate) fn streaming_at(&self, position: Row) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|axis| position[axis] - self.origin[axis]);
        self.gradient.map(|[along_x, along_y, along_z]| along_x * x + along_y * y + along_z * z)
    }

    /// A particle that comes, by its index, is where it is.
    pub(crate) fn begin_at(&mut self, index: u32) {
        let index = index as usize;
        if index == self.edges_away.len() {
            self.edges_away.push([0; 3]);
        } else {
            self.edges_away[index] = [0; 3];
        }
    }

    /// By how much a particle, by its index, has been brought back into the cell \[m\].
    pub(crate) fn displacement(&self, index: u32) -> [f64; 3] {
        displacement(&self.edges, self.edges_away[index as usize])
    }

    /// Whether the cell is being deformed.
    pub(crate) fn streams(&self) -> bool {
        self.gradient != Square::default()
    }
}

impl CellState {
    /// Whether it can be one of these particles, which have been checked.
    pub(super) fn check(&self, particles: &Particles) -> Result<(), StateFault> {
        let edges = [self.reference, self.edges];
        let triangular = edges.iter().all(|[a, b, c]| {
            a[0] > 0.0 && b[1] > 0.0 && c[2] > 0.0 && [a[1], a[2], b[2]].iter().all(|part| *part == 0.0)
        });
        demand(triangular, "cell", 0, "edges [ax, 0, 0], [bx, by, 0], [cx, cy, cz] with ax, by, cz above 0")?;
        let squares = [self.reference, self.edges, self.gradient, self.virial, self.kinetic];
        all_finite(squares.as_flattened().as_flattened(), "cell")?;
        let sixes = [self.strain, self.rate, self.start, self.end, self.target, self.target_rate];
        all_finite(sixes.as_flattened(), "cell")?;
        let means = [self.stress_sum, self.mean_stress, self.conjugate_stress];
        all_finite(means.as_flattened(), "cell")?;
        all_finite([self.stiffness, self.held_rate, self.action].as_flattened(), "cell")?;
        all_finite(&self.impulse, "cell")?;
        all_finite(&[self.inertia, self.volume_before, self.work], "cell")?;
        let count = self.images.len();
        let columns = self.originals.len() == count && self.displaced.len() == count;
        demand(columns && count == particles.images(), "images", count, "an entry for each image")?;
        let away = self.edges_away.len();
        demand(away == particles.slot.len(), "edges_away", away, "one for each particle")?;
        let counts = self.edges_away.iter().chain(&self.displaced).flatten();
        demand_all(counts.map(|edges| edges.unsigned_abs() < MOST), "edges_away", "counts that can be reached")?;
        let mut seen = vec![false; particles.len()];
        let sound = self.images.iter().zip(&self.originals).map(|(&image, &original)| {
            let (image, original) = (image as usize, original as usize);
            let is_image = particles.owner.get(image) == Some(&IMAGE) && !std::mem::replace(&mut seen[image], true);
            is_image
                && particles.owner.get(original).is_some_and(|&it| it != IMAGE)
                && particles.id[image] == particles.id[original]
        });
        demand_all(sound, "images", "an image of the particle of its number, each once")
    }
}
