//! Clumps: rigid bodies whose spheres stand among the particles.

use super::check::{FINITE, StateFault, all_finite, demand, demand_all, finite};
use super::in_place::clone_in_place;
use super::number::keep;
use super::{GONE, IMAGE, InsertedParticle, Particles, Row, State, plain};
use crate::base::number::Vector;
use serde::{Deserialize, Serialize};

/// Clumps by ascending number, rows of 32 bytes.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clumps {
    /// Mass centre, and the distance of the sphere centre furthest from it \[m\].
    #[serde(with = "plain")]
    pub position: Vec<Row>,
    /// Moments of inertia about the principal axes \[kg m²\], and the radius of the smallest sphere \[m\].
    #[serde(with = "plain")]
    pub moments: Vec<Row>,
    /// Velocity \[m/s\] and mass \[kg\].
    #[serde(with = "plain")]
    pub velocity: Vec<Row>,
    /// Principal axes as a unit quaternion: scalar, x, y, z.
    #[serde(with = "plain")]
    pub orientation: Vec<Row>,
    /// Angular momentum about the mass centre \[kg m²/s\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub angular_momentum: Vec<Row>,
    /// Angular velocity \[rad/s\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub angular_velocity: Vec<Row>,
    /// Force \[N\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub force: Vec<Row>,
    /// Moment about the mass centre \[N m\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub moment: Vec<Row>,
    /// Force and moment of global damping, which are among these; empty where nothing is damped.
    #[serde(with = "plain")]
    pub braking: Vec<[Row; 2]>,
    /// All lengths over those of the shape.
    #[serde(with = "plain")]
    pub scale: Vec<f64>,
    /// Index of the shape.
    #[serde(with = "plain")]
    pub shape: Vec<u32>,
    /// Number in outputs: of the scene's own their index there, of those that come later the next one. None is used twice.
    #[serde(with = "plain")]
    pub number: Vec<u32>,
    /// Indices of the spheres among the particles, clump by clump in the order of the shape.
    #[serde(with = "plain")]
    pub spheres: Vec<u32>,
    /// Where those of each clump end.
    #[serde(with = "plain")]
    pub ends: Vec<u32>,
}

/// A clump to be added: a row of each kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClumpRows {
    /// Mass centre, and the distance of the sphere centre furthest from it \[m\].
    pub position: Row,
    /// Moments of inertia about the principal axes \[kg m²\], and the radius of the smallest sphere \[m\].
    pub moments: Row,
    /// Velocity \[m/s\] and mass \[kg\].
    pub velocity: Row,
    /// Principal axes as a unit quaternion.
    pub orientation: Row,
    /// Angular momentum \[kg m²/s\].
    pub angular_momentum: Row,
    /// Angular velocity \[rad/s\].
    pub angular_velocity: Row,
    /// All lengths over those of the shape.
    pub scale: f64,
    /// Index of the shape.
    pub shape: u32,
}

clone_in_place!(Clumps {
    position,
    moments,
    velocity,
    orientation,
    angular_momentum,
    angular_velocity,
    force,
    moment,
    braking,
    scale,
    shape,
    number,
    spheres,
    ends
});

impl Clumps {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Indices of the spheres of a clump among the particles.
    #[inline(always)]
    pub fn spheres_of(&self, clump: usize) -> &[u32] {
        let start = if clump == 0 { 0 } else { self.ends[clump - 1] };
        &self.spheres[start as usize..self.ends[clump] as usize]
    }

    /// The rows of a clump.
    pub(crate) fn rows(&self, clump: usize) -> ClumpRows {
        ClumpRows {
            position: self.position[clump],
            moments: self.moments[clump],
            velocity: self.velocity[clump],
            orientation: self.orientation[clump],
            angular_momentum: self.angular_momentum[clump],
            angular_velocity: self.angular_velocity[clump],
            scale: self.scale[clump],
            shape: self.shape[clump],
        }
    }

    /// Appends a clump of this number, whose spheres are to be added.
    pub(crate) fn add(&mut self, rows: &ClumpRows, number: u32) {
        self.position.push(rows.position);
        self.moments.push(rows.moments);
        self.velocity.push(rows.velocity);
        self.orientation.push(rows.orientation);
        self.angular_momentum.push(rows.angular_momentum);
        self.angular_velocity.push(rows.angular_velocity);
        self.force.push([0.0; 4]);
        self.moment.push([0.0; 4]);
        if !self.braking.is_empty() {
            self.braking.push([[0.0; 4]; 2]);
        }
        self.scale.push(rows.scale);
        self.shape.push(rows.shape);
        self.number.push(number);
        self.ends.push(self.spheres.len() as u32);
    }

    /// Adds spheres (indices of particles) to the last clump.
    pub(crate) fn add_spheres(&mut self, spheres: impl IntoIterator<Item = u32>) {
        self.spheres.extend(spheres);
        if let Some(end) = self.ends.last_mut() {
            *end = self.spheres.len() as u32;
        }
    }

    /// Keeps the clumps for which this holds, in their order.
    fn keep(&mut self, stays: &[bool]) {
        let (mut spheres, mut ends) = (Vec::new(), Vec::new());
        for clump in (0..stays.len()).filter(|&clump| stays[clump]) {
            spheres.extend_from_slice(self.spheres_of(clump));
            ends.push(spheres.len() as u32);
        }
        (self.spheres, self.ends) = (spheres, ends);
        let Self { position, moments, velocity, orientation, angular_momentum, .. } = self;
        for rows in [position, moments, velocity, orientation, angular_momentum] {
            keep(rows, |clump| stays[clump]);
        }
        for rows in [&mut self.angular_velocity, &mut self.force, &mut self.moment] {
            keep(rows, |clump| stays[clump]);
        }
        keep(&mut self.braking, |clump| stays[clump]);
        keep(&mut self.scale, |clump| stays[clump]);
        for numbers in [&mut self.shape, &mut self.number] {
            keep(numbers, |clump| stays[clump]);
        }
    }
}

/// What counts as one: a particle that is of no clump, or a clump.
pub(crate) struct Grain<'a> {
    /// Centre, of clumps of mass \[m\].
    pub(crate) position: &'a Row,
    /// Velocity \[m/s\] and mass \[kg\].
    pub(crate) velocity: &'a Row,
    /// Force on it \[N\].
    pub(crate) force: &'a Row,
    /// Index of the particle, or of the first sphere.
    pub(crate) index: u32,
}

impl State {
    /// What counts as one: particles by ascending index, then clumps.
    pub(crate) fn grains(&self) -> impl Iterator<Item = Grain<'_>> {
        let Self { particles, clumps, .. } = self;
        let loose = particles.slots().filter(|&slot| self.clump(slot).is_none()).map(|slot| Grain {
            position: &particles.position[slot],
            velocity: &particles.velocity[slot],
            force: &particles.force[slot],
            index: particles.id[slot],
        });
        loose.chain((0..clumps.len()).map(|clump| Grain {
            position: &clumps.position[clump],
            velocity: &clumps.velocity[clump],
            force: &clumps.force[clump],
            index: clumps.spheres_of(clump)[0],
        }))
    }

    /// Where a grain has come to without being brought back into a periodic cell; elsewhere where it is \[m\].
    pub(crate) fn unwrapped_grain(&self, grain: &Grain) -> [f64; 3] {
        let [x, y, z, _] = *grain.position;
        let Some(cell) = &self.cell else { return [x, y, z] };
        let [u, v, w] = cell.displacement(grain.index);
        [x + u, y + v, z + w]
    }

    /// Velocity \[m/s\] and mass \[kg\] of the grain of which the particle in a slot is.
    pub(crate) fn velocity_of_grain(&self, slot: usize) -> Row {
        self.clump(slot).map_or(self.particles.velocity[slot], |clump| self.clumps.velocity[clump])
    }

    /// The way from the centre of the sphere of a clump in a slot to the mass centre \[m\].
    pub(crate) fn inward(&self, slot: usize) -> Option<Vector> {
        let clump = self.clump(slot)?;
        Some(Vector::from(self.clumps.position[clump]) - self.particles.position[slot].into())
    }

    /// Appends a clump of this number and its spheres. `turning`: whether particles have an orientation.
    pub(crate) fn add_clump(&mut self, rows: &ClumpRows, number: u32, spheres: &[InsertedParticle], turning: bool) {
        let owner = (self.boundaries.len() + self.clumps.len()) as u32 + 1;
        self.clumps.add(rows, number);
        for sphere in spheres {
            let index = self.add_particle(sphere, owner, turning);
            self.clumps.add_spheres([index]);
        }
    }

    /// Removes the clumps whose spheres are no longer there.
    pub(super) fn remove_clumps(&mut self) {
        let Self { particles: Particles { slot, owner, .. }, clumps, boundaries, .. } = self;
        let stays: Vec<bool> =
            (0..clumps.len()).map(|clump| slot[clumps.spheres_of(clump)[0] as usize] != GONE).collect();
        if !stays.contains(&false) {
            return;
        }
        clumps.keep(&stays);
        for clump in 0..clumps.len() {
            for &sphere in clumps.spheres_of(clump) {
                owner[slot[sphere as usize] as usize] = (boundaries.len() + clump) as u32 + 1;
            }
        }
    }
}

impl Clumps {
    /// Whether these can be clumps of these particles, which have been checked, behind so many boundaries.
    pub(super) fn check(&self, particles: &Particles, boundaries: usize) -> Result<(), StateFault> {
        self.check_rows()?;
        let mut start = 0;
        for (clump, &end) in self.ends.iter().enumerate() {
            let spheres = self.spheres.get(start..end as usize).unwrap_or_default();
            let is_member = |&sphere: &u32| {
                let slot = particles.slot_of(sphere);
                slot.is_some_and(|slot| particles.owner[slot] as usize == boundaries + 1 + clump)
            };
            demand(!spheres.is_empty() && spheres.iter().all(is_member), "clumps", clump, "spheres of its own")?;
            start = end as usize;
        }
        let owned = |owner: &&u32| **owner as usize > boundaries && **owner != IMAGE;
        let whole = start == self.spheres.len() && particles.owner.iter().filter(owned).count() == start;
        demand(whole, "clumps", 0, "each sphere once")?;
        demand(self.number.windows(2).all(|two| two[0] < two[1]), "clumps", 0, "ascending numbers")
    }

    /// Whether the rows are of one length, and of finite numbers.
    pub(super) fn check_rows(&self) -> Result<(), StateFault> {
        let Self { position, moments, velocity, orientation, .. } = self;
        let Self { angular_momentum, angular_velocity, force, moment, braking, .. } = self;
        let rows = [position, moments, velocity, orientation, angular_momentum, angular_velocity, force, moment];
        let lengths = rows.iter().map(|rows| rows.len() == self.len());
        demand_all(lengths, "clumps", "columns of one length")?;
        let more = [self.scale.len(), self.shape.len(), self.number.len(), self.ends.len()];
        demand_all(more.iter().map(|length| *length == self.len()), "clumps", "columns of one length")?;
        all_finite(&self.scale, "clumps")?;
        rows.into_iter().try_for_each(|rows| finite(rows, "clumps"))?;
        let braked = braking.is_empty() || braking.len() == self.len();
        demand(
            braked && braking.as_flattened().as_flattened().iter().all(|part| part.is_finite()),
            "clumps",
            0,
            FINITE,
        )?;
        let length = |row: &Row| row.iter().map(|part| part * part).sum::<f64>();
        demand_all(orientation.iter().map(|row| (length(row) - 1.0).abs() < 1e-6), "clumps", "unit quaternions")?;
        let energies = velocity.iter().zip(angular_momentum.iter().zip(angular_velocity));
        let energies =
            energies.map(|(v, (l, w))| v[3] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + length(l) + length(w));
        demand_all(energies.map(f64::is_finite), "clumps", "a kinetic energy that is a number")
    }
}
