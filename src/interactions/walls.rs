//! Contacts of particles with planes: one pass for each plane and contact law that meet.
//!
//! Planes are worked on together, pieces of the particles side by side: a particle gets the loads of all planes from one
//! thread, in the order of the planes. Loads on a plane are summed piece by piece, in order.

use super::ahead::{Ahead, Link};
use super::batch::{self, BatchLaw, Batches, Bodies, ContactGeometry, Entries, FOUND, Touching};
use super::coefficients::{CoefficientTable, Partners};
use super::listed::{self, Kept, Listed, Met};
use super::pass::Pass;
use super::records::{ContactRecord, Motion};
use crate::contact::{Contact, Law, Needs, Response};
use crate::lanes::{Lane, Shared, vector};
use crate::number::{Number, Vector};
use crate::run_error::{Cause, RunError};
use crate::state::ledger::Source;
use crate::state::{BoundaryState, Row, State, StateFault, WallContacts};
use crate::threads::{CHUNK, Context};
use std::f64::consts::PI;
use std::ops::Range;

/// The pass of one plane and one contact law.
pub(crate) struct WallPass {
    /// Which list of the state is its own.
    pub index: usize,
    /// Rows that are kept of each contact.
    pub kept_rows: usize,
    /// Name of the plane.
    pub name: String,
    /// The plane at time 0.
    pub plane: Plane,
    /// Index of the plane's material.
    pub material: u32,
    /// Point about which the moment is taken, at time 0 \[m\].
    pub reference: Vector,
    /// Coefficients of the law.
    pub table: CoefficientTable,
    /// The law.
    pub law: BatchLaw,
}

/// Where a plane stands and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane<N = f64> {
    /// A point on it \[m\].
    pub point: Vector<N>,
    /// Unit normal towards the particles.
    pub normal: Vector<N>,
    /// Its velocity \[m/s\].
    pub velocity: Vector<N>,
}

impl<N: Number> Plane<N> {
    /// How far in front of the plane a centre is \[m\].
    #[inline(always)]
    pub(crate) fn distance(&self, position: [N; 4]) -> N {
        (vector(position) - self.point).dot(self.normal)
    }

    /// Geometry and relative motion of a sphere at the plane.
    #[inline(always)]
    pub(crate) fn meet(
        &self,
        position: [N; 4],
        velocity: [N; 4],
        spin: [N; 4],
        pair_constant: N,
    ) -> ContactGeometry<N> {
        self.meet_at([self.distance(position), position[3]], velocity, spin, pair_constant)
    }

    /// The same at this distance, with this radius.
    #[inline(always)]
    fn meet_at(
        &self,
        [distance, radius]: [N; 2],
        velocity: [N; 4],
        spin: [N; 4],
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let overlap = radius - distance;
        let arm = radius - N::splat(0.5) * overlap;
        let relative = vector(velocity) - self.velocity;
        let normal_velocity = relative.dot(self.normal);
        let slip = relative - self.normal * normal_velocity - (vector(spin) * arm).cross(self.normal);
        let contact = Contact {
            overlap,
            radius,
            mass: velocity[3],
            section_area: N::splat(PI) * overlap * (radius + radius - overlap),
            section_radius: radius,
            normal: self.normal,
            normal_velocity,
            slip,
            relative_spin: vector(spin),
            spin_sum: vector(spin),
            per_reach: N::zero(),
            rolling_inertia: velocity[3] * radius * radius,
            pair_constant,
        };
        ContactGeometry { contact, first_arm: arm, second_arm: N::zero() }
    }
}

impl Plane {
    /// The same plane in lanes.
    #[inline(always)]
    fn lanes<N: Number>(&self) -> Plane<N> {
        let splat = |v: Vector| Vector::new(N::splat(v.x), N::splat(v.y), N::splat(v.z));
        Plane { point: splat(self.point), normal: splat(self.normal), velocity: splat(self.velocity) }
    }
}

impl WallPass {
    /// The plane where it stands in this state.
    pub(crate) fn plane(&self, state: &State) -> Plane {
        self.plane_at(&state.boundaries[state.walls[self.index].boundary as usize])
    }

    /// The plane where its boundary stands.
    fn plane_at(&self, boundary: &BoundaryState) -> Plane {
        Plane {
            point: self.plane.point + boundary.displacement.into(),
            normal: self.plane.normal,
            velocity: boundary.velocity.into(),
        }
    }
}

impl Listed for WallPass {
    fn law(&self) -> &Law {
        &self.law.law
    }

    fn kept<'a>(&self, state: &'a State) -> Kept<'a> {
        let WallContacts { flags, history, pair_constant, .. } = &state.walls[self.index];
        Kept { flags, history, pair_constant }
    }

    fn bodies(&self, state: &State, entry: usize) -> listed::Bodies {
        let list = &state.walls[self.index];
        (list.particle[entry], None, Some(list.boundary))
    }

    fn meet(&self, state: &State, entry: usize, gap: f64, motion: Motion) -> Option<Met<'_>> {
        let (plane, kept, slot) = (self.plane(state), self.kept(state), state.walls[self.index].particle[entry]);
        let position = state.particles.position[slot as usize];
        if plane.distance(position) > position[3] + kept.reach(self.law(), entry, gap) {
            return None;
        }
        let (velocity, spin) = motion.of(state, slot);
        let geometry = plane.meet(position, velocity, spin, kept.constant(entry));
        let row = self.table.row(state.particles.material[slot as usize], self.material);
        Some(Met { contact: geometry.contact, arms: [geometry.first_arm, 0.0], row })
    }

    fn deepest(&self, state: &State, ahead: &Ahead, _entry: usize, met: &Met) -> Option<Contact> {
        let speed = self.plane(state).velocity.length();
        ahead.at_boundary(self.law(), met.row, &met.contact, speed, state.walls[self.index].boundary)
    }
}

/// Particles in one piece of work. Planes are worked on together, piece by piece of the particles: a plane alone has too
/// few for several threads, and what a piece needs is where the contacts of its particles were worked on.
const PIECE: usize = 2 * CHUNK;

/// The pass of a plane as one of several.
pub(crate) trait PlanePass {
    /// Which list of the state is its own.
    fn list(&self) -> usize;

    /// What is to be done with the listed particles in a range of slots. Ranges worked on at the same time do not overlap.
    fn work<'a>(
        &'a self,
        list: &'a mut WallContacts,
        boundary: &BoundaryState,
        particles: Loaded<'a>,
        context: &Context,
    ) -> Box<dyn Fn(Range<usize>) -> Load + Sync + 'a>;

    /// Adds to the plane what the pieces do to it, in order.
    fn finish(&self, state: &mut State, loads: &mut dyn Iterator<Item = Load>) -> Result<(), RunError>;
}

/// The particles, while loads are added to them from several sides.
#[derive(Clone, Copy)]
pub(crate) struct Loaded<'a> {
    /// Positions and radii.
    position: &'a [Row],
    /// Velocities and masses.
    velocity: &'a [Row],
    /// Angular velocities.
    angular_velocity: &'a [Row],
    /// Materials.
    material: &'a [u32],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
}

/// Does the passes of planes that stand first in the list, all of them together.
pub(crate) fn apply(passes: &[Box<dyn Pass>], state: &mut State, context: &Context) -> Result<(), RunError> {
    let planes: Vec<&dyn PlanePass> = passes.iter().map_while(|pass| pass.at_plane()).collect();
    let particles = &mut state.particles;
    let count = particles.len();
    let loaded = Loaded {
        position: &particles.position,
        velocity: &particles.velocity,
        angular_velocity: &particles.angular_velocity,
        material: &particles.material,
        force: Shared::new(&mut particles.force),
        torque: Shared::new(&mut particles.torque),
    };
    let boundaries = &state.boundaries;
    // Lists stand in the order of the passes, and other surfaces may stand before these.
    let first = planes.first().map_or(0, |plane| plane.list());
    let works = planes.iter().zip(&mut state.walls[first..]).map(|(plane, list)| {
        let boundary = &boundaries[list.boundary as usize];
        plane.work(list, boundary, loaded, context)
    });
    let works: Vec<_> = works.collect();
    let pieces = context.collect(count.div_ceil(PIECE), |piece| {
        let slots = piece * PIECE..((piece + 1) * PIECE).min(count);
        works.iter().map(|work| work(slots.clone())).collect::<Vec<Load>>()
    });
    drop(works);
    let mut result = Ok(());
    for (place, plane) in planes.iter().enumerate() {
        let mut loads = pieces.iter().map(|loads| loads[place]);
        result = result.and(plane.finish(state, &mut loads));
    }
    result
}

impl PlanePass for WallPass {
    fn list(&self) -> usize {
        self.index
    }

    fn work<'a>(
        &'a self,
        list: &'a mut WallContacts,
        boundary: &BoundaryState,
        particles: Loaded<'a>,
        context: &Context,
    ) -> Box<dyn Fn(Range<usize>) -> Load + Sync + 'a> {
        let Loaded { position, velocity, angular_velocity, material, force, torque } = particles;
        let particle = &list.particle[..];
        let batches = Batches {
            bodies: AtPlane {
                plane: self.plane_at(boundary),
                reference: self.reference + boundary.displacement.into(),
                particle,
                wall_material: self.material,
                position,
                velocity,
                angular_velocity,
                material,
                force,
                torque,
            },
            entries: Entries::of(&mut list.flags, &mut list.history, &list.pair_constant),
            law: &self.law,
            table: &self.table,
            uniform: self.table.uniform_with(self.material),
            step: context.step,
            width: context.width,
        };
        Box::new(move |slots| {
            let [from, to] =
                [slots.start, slots.end].map(|end| particle.partition_point(|&slot| (slot as usize) < end));
            batches.run(from, to, 0..0)
        })
    }

    fn finish(&self, state: &mut State, loads: &mut dyn Iterator<Item = Load>) -> Result<(), RunError> {
        let boundary = &mut state.boundaries[state.walls[self.index].boundary as usize];
        let mut behind = None;
        for load in loads {
            for axis in 0..3 {
                boundary.force[axis] += load.force[axis];
                boundary.moment[axis] += load.moment[axis];
            }
            behind = behind.or(load.behind);
        }
        match behind {
            None => Ok(()),
            Some(slot) => Err(RunError::Behind {
                id: state.particles.id[slot as usize],
                boundary: self.name.clone(),
                time: state.clock.time,
                cause: Cause::Unknown,
            }),
        }
    }
}

impl Pass for WallPass {
    /// All planes are done together, by [`apply`].
    fn apply(&self, _state: &mut State, _context: &Context) -> Result<(), RunError> {
        Ok(())
    }

    fn at_plane(&self) -> Option<&dyn PlanePass> {
        Some(self)
    }

    fn check(&self, state: &State) -> Result<(), StateFault> {
        state.walls[self.index].check_columns(self.kept_rows, self.law.law.has_pair_constant())
    }

    fn has_torque(&self) -> bool {
        self.law.needs.torque
    }

    fn source(&self) -> Source {
        Source::Walls
    }

    fn take_coefficients(&mut self, state: &State) {
        self.table.take(&state.coefficients[state.walls[self.index].law as usize]);
    }

    fn prepare(&self, state: &mut State) {
        let list = &mut state.walls[self.index];
        let law = &self.law.law;
        list.pair_constant.clear();
        if law.has_pair_constant() {
            let particles = &state.particles;
            list.pair_constant.extend(list.particle.iter().map(|&slot| {
                let slot = slot as usize;
                let row = self.table.row(particles.material[slot], self.material);
                law.pair_constant(row, particles.position[slot][3], particles.velocity[slot][3])
            }));
        }
    }

    fn stiffness(&self, state: &State, ahead: &Ahead, tell: &mut dyn FnMut(Link)) {
        listed::stiffness(self, state, ahead, tell);
    }

    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Option<Response> {
        // Against a plane the effective radius and mass are the particle's own, twice those of an equal pair.
        self.table.stiffest(&self.law.law, Partners::Boundary(self.material), 2.0 * radius, 2.0 * mass, speed)
    }

    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        listed::records(self, state, step, tell);
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        listed::elastic_energy(self, state)
    }
}

/// What a piece of a list does to the plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Load {
    /// Force on the plane \[N\].
    force: [f64; 3],
    /// Moment about the moved reference point \[N m\].
    moment: [f64; 3],
    /// A particle whose centre is behind the plane.
    behind: Option<u32>,
}

/// Particles at a plane.
#[derive(Clone, Copy)]
struct AtPlane<'a> {
    /// The plane, where it stands.
    plane: Plane,
    /// The moved reference point.
    reference: Vector,
    /// Listed particles.
    particle: &'a [u32],
    /// The plane's material.
    wall_material: u32,
    /// Positions and radii.
    position: &'a [Row],
    /// Velocities and masses.
    velocity: &'a [Row],
    /// Angular velocities.
    angular_velocity: &'a [Row],
    /// Materials.
    material: &'a [u32],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
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
        let position = unsafe { N::load_rows(self.position.as_ptr(), first) };
        let distance = self.plane.lanes::<N>().distance(position);
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
        let (velocity, spin) = unsafe {
            let spin = if TORQUE { N::load_rows(self.angular_velocity.as_ptr(), first) } else { [N::zero(); 4] };
            (N::load_rows(self.velocity.as_ptr(), first), spin)
        };
        self.plane.lanes::<N>().meet_at([distance, radius], velocity, spin, N::zero())
    }

    fn row(&self, table: &CoefficientTable, first: u32, _second: u32) -> u32 {
        table.entry(self.material[first as usize], self.wall_material)
    }

    #[inline(always)]
    fn spread(&self, touching: &Touching, needs: Needs, load: &mut Load) {
        let Touching { first, force, rolling, first_arm, .. } = *touching;
        for place in 0..first.len() {
            let slot = first[place] as usize;
            // SAFETY: a particle stands once in a list.
            unsafe {
                batch::add(self.force.at(slot), &force[place]);
                if needs.torque {
                    let [mut torque, _] = touching.torques(place);
                    if needs.spin {
                        batch::subtract(&mut torque, &rolling[place]);
                    }
                    batch::add(self.torque.at(slot), &torque);
                }
            }
            let point = Vector::from(self.position[slot]) - self.plane.normal * first_arm[place];
            let mut moment = (point - self.reference).cross(force[place].into());
            if needs.spin {
                moment = moment - rolling[place].into();
            }
            for (axis, part) in moment.to_array().into_iter().enumerate() {
                load.force[axis] -= force[place][axis];
                load.moment[axis] -= part;
            }
        }
    }
}
