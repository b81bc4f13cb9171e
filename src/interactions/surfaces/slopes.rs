//! How contacts with surfaces change with a few inputs.

use super::plane::Plane;
use super::sphere::{SphereAt, lanes};
use super::{AtSurface, SurfacePass, Touched};
use crate::coefficients::in_lanes;
use crate::contact::{Evaluated, MOST_HISTORY, Reaction};
use crate::dual::Dual;
use crate::interactions::slopes::{Touching, beyond, constants, materials, needed, part, react};
use crate::lanes::{Kernel, Lane, columns_at};
use crate::number::{Number, Vector};
use crate::state::State;
use crate::tangent::{AddSlopes, Alone, FollowPass, Group, InLanes, Inputs, Moving, Tangent, Waiting, spread};

/// Rows of particles as a boundary sees them whose own part has these slopes.
#[inline(always)]
fn seen<I: Inputs, N: Lane>(mut row: [InLanes<I, N>; 4], own: &[I::Each; 3]) -> [InLanes<I, N>; 4] {
    for (number, own) in row.iter_mut().zip(own) {
        *number = *number - spread::<I, N>(Dual::new(0.0, *own));
    }
    row
}

impl<I: Inputs> FollowPass<I> for SurfacePass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent<I>, step: Alone<I>) {
        for surface in &self.surfaces {
            match &surface.touched {
                Touched::Plane(plane) => {
                    let plane = plane.at(&state.boundaries[surface.list(state).boundary as usize]);
                    let pass = (surface, plane);
                    if surface.law.needs.torque {
                        I::run(tangent.width, AddSlopes { pass: Touching::<_, true>(pass), state, tangent, step });
                    } else {
                        I::run(tangent.width, AddSlopes { pass: Touching::<_, false>(pass), state, tangent, step });
                    }
                }
                // Scenes with others are refused before.
                Touched::Features(_) | Touched::Nodes(_) => {}
            }
        }
    }
}

/// A plane where it stands.
impl<const TURNING: bool, I: Inputs> Kernel for AddSlopes<'_, Touching<(&AtSurface, Plane), TURNING>, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass: Touching((surface, plane)), state, tangent, step } = self;
        let (list, particles, law) = (surface.list(state), &state.particles, &surface.law.law);
        let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
        let (step, table) = (spread::<I, N>(step), &surface.table);
        let uniform = table.uniform_with(surface.material).map(in_lanes::<I::Values<N>>);
        let Tangent { particles: moved, walls, boundaries, .. } = tangent;
        let (slopes, boundary) = (&mut walls[surface.index], &mut boundaries[list.boundary as usize]);
        let pivot = surface.reference + state.boundaries[list.boundary as usize].displacement.into();
        let (moves, mut waiting) = (boundary.is_moved(), Waiting::of([&list.particle]));
        let acting = Evaluated::acting(law);
        let mut rows = [[Dual::zero(); 4]; MOST_HISTORY];
        while let Some(mut group) = waiting.look::<I::Values<N>>() {
            let Group { entries, bodies: [slots], count } = group;
            let wanted = if moves { (1 << count) - 1 } else { moved.reached(slots.first(count)) };
            let mut touching = 0;
            if wanted != 0 {
                let position = columns_at::<I::Values<N>>(&particles.position, &slots);
                let mut reach = position[3];
                if let Some(beyond) = beyond(law, &list.flags, &list.pair_constant, &entries) {
                    reach = reach + beyond;
                }
                touching = wanted & !I::Values::<N>::bits(plane.distance(position).greater(reach));
                part(slopes, &entries, wanted & !touching);
            }
            if I::Values::<N>::WIDTH > 1 {
                waiting.wait(&group, touching);
                let Some(filled) = waiting.take::<I::Values<N>>() else { continue };
                group = filled;
            } else if touching == 0 {
                continue;
            }
            let Group { entries, bodies: [slots], count } = group;
            let [position, velocity] = moved.bodies::<N>(&moving, &slots);
            let spin = if TURNING { moved.spins(&moving, &slots) } else { [Dual::zero(); 4] };
            let (place, speed) = (Dual::values_of(position), Dual::values_of(velocity));
            let (position, velocity) =
                (seen::<I, N>(position, &boundary.displacement), seen::<I, N>(velocity, &boundary.velocity));
            let constant = constants::<I::Values<N>>(&list.pair_constant, &entries);
            let at = [plane.distance(position), position[3]];
            let geometry = plane.meet(at, [velocity, spin], Dual::constant(constant));
            let values = plane.meet([plane.distance(place), place[3]], [speed, [Number::zero(); 4]], constant).contact;
            let mut geometry = needed::<I, N, TURNING>(geometry, &values, surface.law.needs);
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
                react::<I, N, TURNING>(law, &mut geometry.contact, remembered, (&mut rows, step));
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
            I::sum::<N>((-force).slopes(), &mut boundary.force, count);
            I::sum::<N>((-moment).slopes(), &mut boundary.moment, count);
        }
    }
}
