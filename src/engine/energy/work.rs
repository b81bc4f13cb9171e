//! The algorithmic energy book: work of each kind of force, as the integrator makes it.
//!
//! Each half kick of a particle does the work F_k · (v + ¼ Δt a) ½ Δt, where v is its velocity before and a its acceleration. The
//! second half kick of a step and the first one of the next have the same forces. One pass over the particles therefore finds
//! for both the powers Σ F_k · v and how fast they grow, Σ F_k · a.

use super::between::PendingWork;
use super::{dot, multiply, plus, row};
use crate::base::lanes::{self, Kernel, Lane};
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::{RigidBody, book};
use crate::engine::integration::{Fields, mobility};
use crate::engine::state::ledger::Source;
use crate::engine::state::{Particles, Row, State};

/// Books the half kick of a step of this length \[s\] that begins it.
pub(crate) fn book_first(state: &mut State, fields: &Fields, bodies: &[Option<RigidBody>], step: f64) {
    let Some(ledger) = &mut state.ledger else { return };
    let half = 0.5 * step;
    for source in 0..Source::COUNT {
        ledger.work[source] += half * (ledger.power[source] + 0.5 * half * ledger.growth[source]);
    }
    ledger.turnover += half * ledger.power_turned_over;
    book::book_work(state, fields, bodies, step);
}

/// Books the half kick that ends a step, about to be made with the present loads and with gravity \[m/s²\] where
/// that is not yet among them. At time 0 its length is 0: the powers are found.
pub(crate) fn book_second(
    state: &mut State,
    between: &mut PendingWork,
    (fields, gravity): (&Fields, Option<[f64; 3]>),
    bodies: &[Option<RigidBody>],
    context: &Context,
) {
    book_particles(state, between, (fields, gravity), context);
    book::book_work(state, fields, bodies, context.step);
}

/// Books the second half kick of the particles.
fn book_particles(
    state: &mut State,
    between: &mut PendingWork,
    (fields, gravity): (&Fields, Option<[f64; 3]>),
    context: &Context,
) {
    let State { particles, walls, ledger: Some(ledger), .. } = state else { return };
    let particles = &*particles;
    let half = 0.5 * context.step;
    let of_walls = between.of_walls(particles, walls, gravity, (half, context.width));
    let between = &*between;
    let on_piece = |piece: usize| {
        let mut sums = Sums::default();
        lanes::run(context.width, OnPiece { particles, between, fields, gravity, half, piece, sums: &mut sums });
        sums.powers(between, fields)
    };
    let add = |(mut sum, turned_over): (Powers, f64), part: Powers| {
        sum.add(&part);
        (sum, turned_over + part.magnitude(half))
    };
    let pieces = particles.len().div_ceil(CHUNK);
    let (mut powers, turned_over) = context.fold(pieces, on_piece, (Powers::default(), 0.0), add);
    if let Some(walls) = of_walls {
        powers.tell_walls(between, walls.map(|sums| sums[0] + sums[1] + sums[2]));
    }
    for source in 0..Source::COUNT {
        let (now, growth) = (powers.now[source], powers.growth[source]);
        ledger.work[source] += half * (now + 0.5 * half * growth);
        (ledger.power[source], ledger.growth[source]) = (now + half * growth, growth);
    }
    ledger.power_turned_over = turned_over;
    ledger.turnover += half * turned_over;
}

/// Powers of each kind of force on particles, and how fast they grow.
#[derive(Clone, Copy, Debug, Default)]
struct Powers {
    /// Powers \[W\].
    now: [f64; Source::COUNT],
    /// How fast they grow in a kick \[W/s\].
    growth: [f64; Source::COUNT],
}

impl Powers {
    /// Adds others.
    fn add(&mut self, other: &Self) {
        self.now.iter_mut().zip(other.now).for_each(|(sum, part)| *sum += part);
        self.growth.iter_mut().zip(other.growth).for_each(|(sum, part)| *sum += part);
    }

    /// Sum of their magnitudes after this time \[s\].
    fn magnitude(&self, time: f64) -> f64 {
        self.now.iter().zip(self.growth).map(|(now, growth)| (now + time * growth).abs()).sum()
    }

    /// Takes what surfaces do from the kind before them, to which it was counted.
    fn tell_walls(&mut self, between: &PendingWork, walls: [f64; 2]) {
        let Some(last) = between.last else { return };
        for (powers, walls) in [&mut self.now, &mut self.growth].into_iter().zip(walls) {
            powers[Source::Walls as usize] = walls;
            powers[last as usize] -= walls;
        }
    }
}

/// Sums over some particles of products with velocities and accelerations, number by number of the rows.
#[derive(Default)]
struct Sums {
    /// Of the loads before bonds.
    bonds: [Row; 2],
    /// Of the loads before fields.
    passes: [Row; 2],
    /// Of all loads.
    all: [Row; 2],
    /// Momentum \[N s\] and force \[N\].
    momentum: [Row; 2],
    /// Of applied forces.
    applied: [f64; 2],
}

impl Sums {
    /// The powers; what surfaces do counts to the kind before them.
    fn powers(&self, between: &PendingWork, fields: &Fields) -> Powers {
        let gravity = row(fields.weight(1.0));
        let of = |part: usize| {
            let mut power = [0.0; Source::COUNT];
            let whole = |rows: &[Row; 2]| rows[part][0] + rows[part][1] + rows[part][2];
            let passes = whole(&self.passes);
            if let Some(last) = between.last {
                power[last as usize] = passes;
            }
            if between.bonds.stored {
                let contacts = whole(&self.bonds);
                power[Source::Contacts as usize] += contacts;
                power[Source::Bonds as usize] -= contacts;
            }
            let (weight, applied) = (dot(&gravity, &self.momentum[part]), self.applied[part]);
            power[Source::Gravity as usize] = weight;
            power[Source::Applied as usize] = applied;
            if fields.damps() {
                power[Source::Damping as usize] = whole(&self.all) - passes - weight - applied;
            }
            power
        };
        Powers { now: of(0), growth: of(1) }
    }
}

/// The sums over one piece of the particles.
struct OnPiece<'a, 'b> {
    /// The particles.
    particles: &'a Particles,
    /// The loads between kinds of force.
    between: &'a PendingWork,
    /// Gravity and applied forces.
    fields: &'a Fields,
    /// Gravity that is not yet among the forces \[m/s²\].
    gravity: Option<[f64; 3]>,
    /// Length of the half kick \[s\].
    half: f64,
    /// Which piece.
    piece: usize,
    /// What is found.
    sums: &'b mut Sums,
}

impl Kernel for OnPiece<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { particles, between, fields, gravity, half, piece, sums } = self;
        let (mut found, gravity) = (Sums::default(), row(gravity.unwrap_or_default()));
        let (bonds, passes) = (between.bonds.rows(), between.fields.rows());
        let (applies, damps) = (fields.applies(), fields.damps());
        let slots = piece * CHUNK..((piece + 1) * CHUNK).min(particles.len());
        // Side by side, so that no place is looked for in each of the lists.
        let motions = particles.velocity[slots.clone()].iter().zip(&particles.angular_velocity[slots.clone()]);
        let loads = particles.force[slots.clone()].iter().zip(&particles.torque[slots.clone()]);
        let owners = &particles.owner[slots.clone()];
        for (slot, (((velocity, spin), (force, torque)), owner)) in slots.zip(motions.zip(loads).zip(owners)) {
            if *owner != 0 {
                continue;
            }
            let acceleration = plus(&gravity, force, mobility(velocity, force, half));
            let turning = plus(&[0.0; 4], torque, mobility(spin, torque, half));
            let motion = [[velocity, spin], [&acceleration, &turning]];
            let passed = passes.map_or([force, torque], |[forces, torques]| [&forces[slot], &torques[slot]]);
            multiply(&mut found.passes, passed, motion);
            if let Some([forces, torques]) = bonds {
                multiply(&mut found.bonds, [&forces[slot], &torques[slot]], motion);
            }
            if damps {
                multiply(&mut found.all, [force, torque], motion);
            }
            for (sum, [along, _]) in found.momentum.iter_mut().zip(motion) {
                *sum = plus(sum, along, velocity[3]);
            }
            if applies {
                let applied = row(fields.applied(particles.id[slot]));
                for (sum, [along, _]) in found.applied.iter_mut().zip(motion) {
                    *sum += dot(&applied, along);
                }
            }
        }
        *sums = found;
    }
}
