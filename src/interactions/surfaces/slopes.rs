//! How contacts with surfaces change with a few inputs.

use super::plane::Plane;
use super::sphere::{SphereAt, lanes};
use super::{AtSurface, SurfacePass, Touched};
use crate::coefficients::in_lanes;
use crate::contact::{Evaluated, MOST_HISTORY, Reaction};
use crate::dual::Dual;
use crate::interactions::slopes::{Touching, beyond, constants, materials, needed, part, react};
use crate::lanes::{Kernel, Lane, columns_at, run_seldom};
use crate::number::{Number, Vector};
use crate::state::State;
use crate::tangent::{AddSlopes, FollowPass, Group, Moving, Tangent, Waiting, spread, sum, vector_slopes};

/// Rows of particles as a boundary sees them whose own part has these slopes.
#[inline(always)]
fn seen<N: Lane>(mut row: [Dual<N>; 4], own: &[[f64; 1]; 3]) -> [Dual<N>; 4] {
    for (number, own) in row.iter_mut().zip(own) {
        *number = *number - spread::<N>(Dual::new(0.0, *own));
    }
    row
}

impl FollowPass for SurfacePass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        for surface in &self.surfaces {
            match &surface.touched {
                Touched::Plane(plane) => {
                    let plane = plane.at(&state.boundaries[surface.list(state).boundary as usize]);
                    let pass = (surface, plane);
                    if surface.law.needs.torque {
                        run_seldom(tangent.width, AddSlopes { pass: Touching::<_, true>(pass), state, tangent, step });
                    } else {
                        run_seldom(tangent.width, AddSlopes { pass: Touching::<_, false>(pass), state, tangent, step });
                    }
                }
                // Scenes with others are refused before.
                Touched::Features(_) | Touched::Nodes(_) => {}
            }
        }
    }
}

/// A plane where it stands.
impl<const TURNING: bool> Kernel for AddSlopes<'_, Touching<(&AtSurface, Plane), TURNING>> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass: Touching((surface, plane)), state, tangent, step } = self;
        let (list, particles, law) = (surface.list(state), &state.particles, &surface.law.law);
        let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
        let (step, table) = (spread::<N>(step), &surface.table);
        let uniform = table.uniform_with(surface.material).map(in_lanes::<N>);
        let Tangent { particles: moved, walls, boundaries, .. } = tangent;
        let (slopes, boundary) = (&mut walls[surface.index], &mut boundaries[list.boundary as usize]);
        let pivot = surface.reference + state.boundaries[list.boundary as usize].displacement.into();
        let (moves, mut waiting) = (boundary.is_moved(), Waiting::of([&list.particle]));
        let acting = Evaluated::acting(law);
        let mut rows = [[Dual::zero(); 4]; MOST_HISTORY];
        while let Some(mut group) = waiting.look::<N>() {
            let Group { entries, bodies: [slots], count } = group;
            let wanted = if moves { (1 << count) - 1 } else { moved.reached(slots.first(count)) };
            let mut touching = 0;
            if wanted != 0 {
                let position = columns_at::<N>(&particles.position, &slots);
                let mut reach = position[3];
                if let Some(beyond) = beyond(law, &list.flags, &list.pair_constant, &entries) {
                    reach = reach + beyond;
                }
                touching = wanted & !N::bits(plane.distance(position).greater(reach));
                part(slopes, &entries, wanted & !touching);
            }
            if N::WIDTH > 1 {
                waiting.wait(&group, touching);
                let Some(filled) = waiting.take::<N>() else { continue };
                group = filled;
            } else if touching == 0 {
                continue;
            }
            let Group { entries, bodies: [slots], count } = group;
            let [position, velocity] = moved.bodies::<N>(&moving, &slots);
            let spin = if TURNING { moved.spins(&moving, &slots) } else { [Dual::zero(); 4] };
            let (place, speed) = (Dual::values_of(position), Dual::values_of(velocity));
            let (position, velocity) =
                (seen::<N>(position, &boundary.displacement), seen::<N>(velocity, &boundary.velocity));
            let constant = constants::<N>(&list.pair_constant, &entries);
            let at = [plane.distance(position), position[3]];
            let geometry = plane.meet(at, [velocity, spin], Dual::constant(constant));
            let values = plane.meet([plane.distance(place), place[3]], [speed, [Number::zero(); 4]], constant).contact;
            let mut geometry = needed::<N, TURNING>(geometry, &values, surface.law.needs);
            if surface.law.needs.section {
                let [distance, radius] = at;
                geometry.contact.section_area =
                    SphereAt { normal: geometry.contact.normal, distance, radius }.section();
            }
            let gathered;
            let row = match &uniform {
                Some(row) => row,
                None => {
                    gathered = table.lanes(materials(&particles.material, &slots), [surface.material; 8]);
                    &gathered
                }
            };
            let (law, remembered) = ((law, &acting, &row[..]), (&*list.history, &mut *slopes, &entries));
            let Reaction { force, couple, rolling, .. } =
                react::<N, TURNING>(law, &mut geometry.contact, remembered, (&mut rows, step));
            moved.press(&slots, count, force);
            if TURNING {
                moved.twist(&slots, count, -(couple * geometry.first_arm) - rolling);
            }
            let away = Vector::of_row(place) - lanes(pivot);
            let [x, y, z, _] = position;
            let away = Vector {
                x: Dual { value: away.x, ..x },
                y: Dual { value: away.y, ..y },
                z: Dual { value: away.z, ..z },
            };
            let moment = (away - geometry.contact.normal * geometry.first_arm).cross(force) - rolling;
            sum(vector_slopes(-force), &mut boundary.force, count);
            sum(vector_slopes(-moment), &mut boundary.moment, count);
        }
    }
}
