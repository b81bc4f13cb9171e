//! Contacts with planes, with slopes.

use super::plane::{AtPlane, Plane};
use super::sphere::{Loaded, SphereAt, lanes};
use super::{AtSurface, SurfacePass, Touched};
use crate::batches::{Batches, Buffer, ContactGeometry, Entries, FOUND};
use crate::contact::{Needs, Reaction};
use crate::dual::Dual;
use crate::interactions::followed::{Followed, Register, Sides};
use crate::lanes::{Lane, Places, columns_at, numbers_at};
use crate::number::{Number, Vector};
use crate::state::State;
use crate::tangent::{FollowPass, ListSlopes, Moving, Tangent, spread, sum, vector_slopes};
use std::sync::Mutex;

/// Particles at a plane whose slopes are followed.
#[derive(Clone, Copy)]
pub(super) struct PlaneSlopes<'a> {
    /// Which list of the state is theirs.
    index: usize,
    /// Whose plane it is.
    boundary: usize,
    /// The plane where it stands.
    plane: Plane,
    /// The moved reference point.
    pivot: Vector,
    /// The plane's material.
    material: u32,
    /// How the particles move.
    moving: Moving<'a>,
    /// Their materials.
    materials: &'a [u32],
}

impl<'a> PlaneSlopes<'a> {
    /// Those at a plane of this boundary.
    pub(super) fn of(surface: &AtSurface, bodies: &AtPlane<'a>, boundary: u32) -> Self {
        let AtPlane { plane, pivot, material, particles, .. } = *bodies;
        let (index, boundary) = (surface.index, boundary as usize);
        Self { index, boundary, plane, pivot, material, moving: particles.moving(), materials: particles.material }
    }
}

/// Rows of particles as a boundary sees them whose own part has these slopes.
#[inline(always)]
fn seen<N: Lane>(mut row: [Dual<N>; 4], own: &[[f64; 1]; 3]) -> [Dual<N>; 4] {
    for (number, own) in row.iter_mut().zip(own) {
        *number = *number - spread::<N>(Dual::new(0.0, *own));
    }
    row
}

impl Sides for PlaneSlopes<'_> {
    const AT_BOUNDARY: bool = true;

    #[inline(always)]
    fn list<'a>(&self, tangent: &'a mut Tangent) -> &'a mut ListSlopes {
        &mut tangent.walls[self.index]
    }

    fn reaches(&self, tangent: &Tangent, buffer: &Buffer) -> bool {
        let slots = &buffer.first[..buffer.ready];
        !slots.is_empty() && (tangent.boundaries[self.boundary].is_moved() || tangent.particles.reaches(slots))
    }

    #[inline(always)]
    fn reached(&self, tangent: &Tangent, [slots, _]: &[Places; 2], count: usize) -> u32 {
        if tangent.boundaries[self.boundary].is_moved() {
            return (1 << count) - 1;
        }
        tangent.particles.reached(slots.first(count))
    }

    #[inline(always)]
    fn roots<N: Lane>(&self, _found: &[N; FOUND]) -> [N; 2] {
        [N::zero(); 2]
    }

    #[inline(always)]
    fn meet<N: Lane, const TURNING: bool>(
        &self,
        tangent: &Tangent,
        contacts: &Register<N>,
        needs: Needs,
    ) -> ContactGeometry<Dual<N>> {
        let (particles, boundary) = (&tangent.particles, &tangent.boundaries[self.boundary]);
        let Register { slots: [slots, _], found, constant, .. } = contacts;
        let [position, velocity] = particles.bodies::<N>(&self.moving, slots);
        let spin = if TURNING { particles.spins(&self.moving, slots) } else { [Dual::zero(); 4] };
        let (position, velocity) =
            (seen::<N>(position, &boundary.displacement), seen::<N>(velocity, &boundary.velocity));
        let distance = Dual { value: found[0], ..self.plane.distance(position) };
        let mut geometry = self.plane.meet([distance, position[3]], [velocity, spin], Dual::constant(*constant));
        if needs.section {
            let sphere = SphereAt { normal: geometry.contact.normal, distance, radius: position[3] };
            geometry.contact.section_area = sphere.section();
        }
        geometry
    }

    fn materials(&self, [slots, _]: &[Places; 2]) -> [[u32; 8]; 2] {
        [numbers_at(self.materials, slots), [self.material; 8]]
    }

    #[inline(always)]
    fn load<N: Lane, const TURNING: bool>(
        &self,
        tangent: &mut Tangent,
        (contacts, reached): (&Register<N>, u32),
        geometry: &ContactGeometry<Dual<N>>,
        reaction: &Reaction<Dual<N>>,
    ) {
        let Register { slots: [slots, _], count, .. } = contacts;
        let Reaction { force, couple, rolling, .. } = *reaction;
        let (particles, boundary) = (&mut tangent.particles, &mut tangent.boundaries[self.boundary]);
        particles.press(slots, (*count, reached), force);
        if TURNING {
            particles.twist(slots, *count, -(couple * geometry.first_arm) - rolling);
        }
        let place = Vector::of_row(columns_at::<N>(self.moving.position, slots)) - lanes(self.pivot);
        let [dx, dy, dz, _] = columns_at::<N>(&particles.position, slots);
        let [own_x, own_y, own_z] = boundary.displacement.map(|[own]| N::splat(own));
        let away = Dual::vector(place, [[dx - own_x], [dy - own_y], [dz - own_z]]);
        let moment = (away - geometry.contact.normal * geometry.first_arm).cross(force) - rolling;
        sum(vector_slopes(-force), &mut boundary.force, *count);
        sum(vector_slopes(-moment), &mut boundary.moment, *count);
    }
}

impl AtSurface {
    /// How slopes go along with the contacts of this plane, where it stands.
    pub(super) fn followed<'a, 'b>(
        &'a self,
        sides: PlaneSlopes<'a>,
        tangents: &'a Mutex<&'b mut [Tangent]>,
        step: Dual,
    ) -> Followed<'a, 'b, PlaneSlopes<'a>> {
        let (law, table, uniform) = (&self.law, &self.table, self.table.uniform_with(self.material));
        Followed { sides, law, table, uniform, tangents, step, looks: false }
    }
}

impl FollowPass for SurfacePass {
    /// Looks at the contacts alone, in copies of the lists.
    fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        let width = tangent.width;
        let tangents = Mutex::new(std::slice::from_mut(tangent));
        for surface in &self.surfaces {
            // Scenes with others are refused before.
            let Touched::Plane(plane) = &surface.touched else { continue };
            let (list, mut kept) = (surface.list(state), surface.list(state).clone());
            let particles = Loaded::looking(&state.particles);
            let bodies = surface.at_plane(plane, (list, &state.boundaries), particles);
            let sides = PlaneSlopes::of(surface, &bodies, list.boundary);
            let followed = Followed { looks: true, ..surface.followed(sides, &tangents, step) };
            let entries = Entries::of(&mut kept.flags, &mut kept.history, &mut kept.pair_constant);
            let batches = surface.batches(bodies, entries, (0.0, width));
            Batches { along: Some(&followed), ..batches }.run(0, bodies.particle.len(), 0..0);
        }
    }
}
