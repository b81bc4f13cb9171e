//! Slopes of particles go on their way as the particles do.

use super::rows::add_times;
use super::{ParticleSlopes, Tangent, slopes_of, with_slopes};
use crate::geometry::Quaternion;
use crate::lanes::{self, Kernel, Lane, columns_from, rows_from};
use crate::number::{Number, Vector};
use crate::state::{Particles, State};

impl Tangent {
    /// Half a kick and the drift of free particles, by the loads and motions before it. Loads begin anew.
    pub(crate) fn drift_particles(&mut self, state: &State, step: f64) {
        lanes::run_seldom(self.width, Drift { slopes: &mut self.particles, particles: &state.particles, step });
    }

    /// The second half of the kick of free particles.
    pub(crate) fn kick_particles(&mut self, step: f64) {
        lanes::run_seldom(self.width, Kick { slopes: &mut self.particles, half: 0.5 * step });
    }
}

impl ParticleSlopes {
    /// Half a kick of the particles, of this length \[s\].
    #[inline(always)]
    fn kick(&mut self, half: f64) {
        let (reached, inverse) = (&self.is_reached, &self.inverse);
        add_times(&mut self.velocity, &self.force, reached, inverse.iter().map(|[per_mass, _]| half * per_mass));
        if self.turning {
            let factors = inverse.iter().map(|[_, per_inertia]| half * per_inertia);
            add_times(&mut self.spin, &self.torque, reached, factors);
        }
    }

    /// Turns orientations as the drift does; the angular velocity has had its half kick, that of the state not yet.
    #[inline(always)]
    fn turn<N: Lane>(&mut self, particles: &Particles, first: usize, step: f64) {
        let mut spin = columns_from::<N>(&particles.angular_velocity, first);
        if particles.owner[first] == 0 {
            let torque = columns_from::<N>(&particles.torque, first);
            let factor = N::splat(0.5 * step) / spin[3];
            for axis in 0..3 {
                spin[axis] = spin[axis] + factor * torque[axis];
            }
        }
        let spin = with_slopes::<N>(spin, columns_from(&self.spin, first));
        let orientation = columns_from(&particles.orientation, first);
        let orientation = with_slopes::<N>(orientation, columns_from(&self.orientation, first));
        let turned = Quaternion::from_row(orientation).turned(Vector::of_row(spin), Number::splat(step));
        rows_from(slopes_of::<N>(turned.to_row()), &mut self.orientation, first);
    }
}

/// Half a kick and the drift of particles.
struct Drift<'a> {
    /// What changes.
    slopes: &'a mut ParticleSlopes,
    /// The particles.
    particles: &'a Particles,
    /// Length of the time step \[s\].
    step: f64,
}

impl Kernel for Drift<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, step } = self;
        slopes.all_reached = !slopes.is_reached.contains(&false);
        // Those of boundaries are put where they belong later.
        slopes.kick(0.5 * step);
        add_times(&mut slopes.position, &slopes.velocity, &slopes.is_reached, std::iter::repeat(step));
        slopes.force.fill([0.0; 4]);
        let mut first = 0;
        while first < slopes.orientation.len() {
            let whole = are_free::<N>(particles, first);
            let some = first..first + if whole { N::WIDTH } else { 1 };
            first = some.end;
            if !slopes.is_reached[some.clone()].contains(&true) {
                continue;
            }
            if whole {
                slopes.turn::<N>(particles, some.start, step);
            } else {
                slopes.turn::<f64>(particles, some.start, step);
            }
        }
        if slopes.turning {
            slopes.torque.fill([0.0; 4]);
        }
    }
}

/// Half a kick of particles.
struct Kick<'a> {
    /// What changes.
    slopes: &'a mut ParticleSlopes,
    /// Its length \[s\].
    half: f64,
}

impl Kernel for Kick<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        self.slopes.kick(self.half);
    }
}

/// Whether there is a register's worth of particles from one on, all of them free.
#[inline(always)]
fn are_free<N: Lane>(particles: &Particles, first: usize) -> bool {
    particles.owner.get(first..first + N::WIDTH).is_some_and(|owners| owners.iter().all(|&owner| owner == 0))
}
