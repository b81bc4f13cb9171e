//! How contacts with surfaces change with a few inputs.

use super::plane::Plane;
use super::{AtSurface, Touched};
use crate::batches::ContactGeometry;
use crate::contact::{MOST_HISTORY, Reaction};
use crate::dual::{Dual, Slopes};
use crate::interactions::slopes::{Touching, beyond, needed, part, react};
use crate::lanes::{Kernel, Lane, run};
use crate::number::{Number, Vector};
use crate::state::State;
use crate::tangent::{AddSlopes, Tangent};

/// A row of a particle as a boundary sees it whose own part has these slopes.
#[inline(always)]
fn seen<N: Lane>(mut row: [Dual<N>; 4], own: &[Slopes; 3]) -> [Dual<N>; 4] {
    for (number, own) in row.iter_mut().zip(own) {
        *number = *number - Dual::new(0.0, own);
    }
    row
}

impl AtSurface {
    /// Adds the slopes of its forces to those of the particles and of its boundary.
    pub(super) fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        match &self.touched {
            Touched::Plane(plane) => {
                let boundary = &state.boundaries[self.list(state).boundary as usize];
                let plane = plane.at(boundary);
                if self.law.needs.torque {
                    run(tangent.width, AddSlopes { pass: Touching::<_, true>((self, plane)), state, tangent, step });
                } else {
                    run(tangent.width, AddSlopes { pass: Touching::<_, false>((self, plane)), state, tangent, step });
                }
            }
            // Scenes with others are refused before.
            Touched::Features(_) | Touched::Nodes(_) => {}
        }
    }
}

/// A plane where it stands.
impl<const TURNING: bool> Kernel for AddSlopes<'_, Touching<(&AtSurface, Plane), TURNING>> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass: Touching((surface, plane)), state, tangent, step } = self;
        let (list, particles, law) = (surface.list(state), &state.particles, &surface.law.law);
        let (step, mut rows) = (Dual::<N>::new(step.value, &step.slopes), [[Dual::zero(); 4]; MOST_HISTORY]);
        let Tangent { particles: moved, walls, boundaries, .. } = tangent;
        let (slopes, boundary) = (&mut walls[surface.index], &mut boundaries[list.boundary as usize]);
        let pivot = surface.reference + state.boundaries[list.boundary as usize].displacement.into();
        let moves = boundary.is_moved();
        for (entry, &slot) in list.particle.iter().enumerate() {
            let slot = slot as usize;
            if !moves && !moved.reached[slot] {
                continue;
            }
            let constant = list.pair_constant.get(entry).copied().unwrap_or(0.0);
            let reach = particles.position[slot][3] + beyond(law, list.flags[entry], constant).unwrap_or(0.0);
            if plane.distance(particles.position[slot]) > reach {
                part(slopes, entry);
                continue;
            }
            let [position, velocity] = moved.body::<N>(particles, slot);
            let spin = if TURNING { moved.spin(particles, slot) } else { [Dual::zero(); 4] };
            let (position, velocity) = (seen(position, &boundary.displacement), seen(velocity, &boundary.velocity));
            let at = [plane.distance(position), position[3]];
            let geometry = plane.meet(at, [velocity, spin], Dual::splat(constant));
            let body = [particles.position[slot], particles.velocity[slot]];
            let at = [plane.distance(body[0]), body[0][3]];
            let values = plane.meet(at, [body[1], [0.0; 4]], constant).contact;
            let ContactGeometry { mut contact, first_arm, .. } =
                needed::<N, TURNING>(geometry, &values, surface.law.needs);
            let row = surface.row(state, slot as u32);
            let Reaction { force, couple, rolling, .. } =
                react::<N, TURNING>(law, row, &mut contact, (&list.history, slopes, entry), (&mut rows, step));
            if TURNING {
                moved.load(slot, force, -(couple * first_arm) - rolling);
            } else {
                moved.press(slot, force);
            }
            let away = Vector::from(particles.position[slot]) - pivot;
            let [x, y, z, _] = position;
            let away = Vector {
                x: Dual { value: away.x, ..x },
                y: Dual { value: away.y, ..y },
                z: Dual { value: away.z, ..z },
            };
            let moment = (away - contact.normal * first_arm).cross(force) - rolling;
            boundary.add_load(&(-force).slopes(), &(-moment).slopes());
        }
    }
}
