//! A plane that does not turn: its particles are a static list, and touch is a distance.

use super::AtSurface;
use super::sphere::{Load, ParticleLoads, SphereAt, lanes};
use crate::base::lanes::{Lane, vector};
use crate::base::number::{Number, Vector};
use crate::engine::contacts::ahead::SearchLimits;
use crate::engine::contacts::batches::{Bodies, ContactGeometry, FOUND, Touching};
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::contacts::listed::{self, ContactEntries, CurrentContact, ListColumns};
use crate::engine::contacts::records::Motion;
use crate::engine::state::heat::Level;
use crate::engine::state::{BoundaryState, State, WallContacts};
use crate::laws::contact::{Contact, Law, Needs};

/// Where a plane stands and how it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// How its surface runs in itself \[m/s\].
    pub(super) conveying: Vector,
    /// A point on it \[m\].
    pub(super) point: Vector,
    /// Unit normal towards the particles.
    pub(super) normal: Vector,
    /// The velocity of its surface \[m/s\].
    pub(super) velocity: Vector,
    /// By how much a force along the normal accelerates it, where forces move it \[1/kg\].
    pub(super) mobility: Option<f64>,
}

impl Plane {
    /// The plane where its boundary stands.
    pub(super) fn at(self, boundary: &BoundaryState) -> Self {
        Self {
            point: self.point + boundary.displacement.into(),
            velocity: self.conveying + boundary.velocity.into(),
            ..self
        }
    }

    /// How far in front of the plane a centre is \[m\].
    #[inline(always)]
    pub(super) fn distance<N: Number>(&self, position: [N; 4]) -> N {
        (vector(position) - lanes(self.point)).dot(lanes(self.normal))
    }

    /// Geometry and relative motion of a sphere at this distance, with this radius.
    #[inline(always)]
    pub(super) fn meet<N: Number>(
        &self,
        [distance, radius]: [N; 2],
        motion: [[N; 4]; 2],
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let sphere = SphereAt { normal: lanes(self.normal), distance, radius };
        let surface = (lanes(self.velocity), vector(motion[1]));
        sphere.meet(motion, surface, self.mobility.map(N::splat), pair_constant)
    }
}

/// Particles at a plane.
#[derive(Clone, Copy)]
pub(super) struct AtPlane<'a> {
    /// The plane, where it stands.
    pub(super) plane: Plane,
    /// The moved reference point.
    pub(super) pivot: Vector,
    /// Listed particles.
    pub(super) particle: &'a [u32],
    /// The plane's material.
    pub(super) material: u32,
    /// Which share of the heat of losses the surface takes.
    pub(super) share_of_heat: f64,
    /// Its temperature.
    pub(super) level: Level,
    /// The particles.
    pub(super) particles: ParticleLoads<'a>,
}

impl Bodies for AtPlane<'_> {
    type Sum = Load;
    const FOUND: usize = 2;

    fn first(&self) -> &[u32] {
        self.particle
    }

    fn second(&self) -> &[u32] {
        self.particle
    }

    #[inline(always)]
    unsafe fn touch<N: Lane>(
        &self,
        first: *const u32,
        _second: *const u32,
        beyond: Option<N>,
        load: &mut Load,
    ) -> (u32, [N; FOUND]) {
        // SAFETY: a list holds slots of particles, below their number.
        let position = unsafe { N::load_rows(self.particles.position.as_ptr(), first) };
        let distance = self.plane.distance(position);
        let behind = N::bits(N::zero().greater(distance));
        if behind != 0 && load.behind.is_none() {
            // SAFETY: there are as many slots as lanes.
            load.behind = Some(unsafe { *first.add(behind.trailing_zeros() as usize) });
        }
        let zero = N::zero();
        let mut reach = position[3];
        if let Some(beyond) = beyond {
            reach = reach + beyond;
        }
        (!N::bits(distance.greater(reach)), [distance, position[3], zero, zero, zero])
    }

    #[inline(always)]
    fn roots<N: Lane>(_found: &[N; FOUND]) -> [N; 2] {
        [N::zero(); 2]
    }

    #[inline(always)]
    unsafe fn meet<N: Lane, const TORQUE: bool>(
        &self,
        first: *const u32,
        _second: *const u32,
        [distance, radius, ..]: [N; FOUND],
        _roots: [N; 2],
    ) -> ContactGeometry<N> {
        // SAFETY: a list holds slots of particles, below their number.
        let motion = unsafe { self.particles.motion::<N, TORQUE>(first) };
        self.plane.meet([distance, radius], motion, N::zero())
    }

    fn row(&self, table: &CoefficientTable, first: u32, _second: u32) -> u32 {
        table.entry(self.particles.material[first as usize], self.material)
    }

    fn warm(&self, first: u32, _second: u32, heat: f64, load: &mut Load) {
        // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
        unsafe { self.particles.warm(first, heat, self.share_of_heat, load) };
    }

    fn conduct(&self, [first, _]: [&[u32]; 2], conductance: &[f64], load: &mut Load) {
        for (&slot, &conductance) in first.iter().zip(conductance) {
            // SAFETY: as above.
            unsafe { self.particles.conduct(slot, self.level, conductance, load) };
        }
    }

    #[inline(always)]
    fn spread(&self, touching: &Touching, needs: Needs, load: &mut Load) {
        let Touching { first, force, couple, rolling, first_arm, .. } = *touching;
        for place in 0..first.len() {
            let (slot, loads) = (first[place] as usize, [force[place], couple[place], rolling[place]]);
            let at = (self.plane.normal, first_arm[place]);
            // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
            unsafe { self.particles.add(slot, at, &loads, needs, (self.pivot, &mut *load)) };
        }
    }
}

/// The contacts of a surface that is a plane, to be told.
pub(super) struct PlaneList<'a> {
    /// The surface and its law.
    pub(super) surface: &'a AtSurface,
    /// The plane where it stands.
    pub(super) plane: Plane,
}

impl ContactEntries for PlaneList<'_> {
    fn law(&self) -> &Law {
        &self.surface.law.law
    }

    fn kept<'a>(&self, state: &'a State) -> ListColumns<'a> {
        let WallContacts { flags, history, pair_constant, .. } = self.surface.list(state);
        ListColumns { flags, history, pair_constant }
    }

    fn bodies(&self, state: &State, entry: usize) -> listed::Bodies {
        let list = self.surface.list(state);
        (list.particle[entry], None, Some(list.boundary))
    }

    fn meet(&self, state: &State, entry: usize, gap: f64, motion: Motion) -> Option<CurrentContact<'_>> {
        let (kept, slot) = (self.kept(state), self.surface.list(state).particle[entry]);
        let position = state.particles.position[slot as usize];
        let distance = self.plane.distance(position);
        if distance > position[3] + kept.reach(self.law(), entry, gap) {
            return None;
        }
        let (velocity, spin) = motion.of(state, slot);
        let [kick, _] = motion.kick_of(&state.boundaries[self.surface.list(state).boundary as usize]);
        let plane = Plane { velocity: self.plane.velocity - kick, ..self.plane };
        let geometry = plane.meet([distance, position[3]], [velocity, spin], kept.constant(entry));
        let row = self.surface.row(state, slot);
        Some(CurrentContact { contact: geometry.contact, arms: [geometry.first_arm, 0.0], row })
    }

    fn deepest(&self, state: &State, ahead: &SearchLimits, entry: usize, met: &CurrentContact) -> Option<Contact> {
        let (list, speed) = (self.surface.list(state), (self.plane.velocity - self.plane.conveying).length());
        let particle = Vector::from(state.particles.velocity[list.particle[entry] as usize]);
        ahead.at_boundary((self.law(), met.row, &met.contact), (particle, speed), list.boundary)
    }
}
