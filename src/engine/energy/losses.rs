//! The physical energy book: what is not found contact by contact or bond by bond.

use crate::base::number::Vector;
use crate::engine::bodies::{RigidBody, book};
use crate::engine::integration::Fields;
use crate::engine::state::{Loss, Losses, State};

/// Potential of gravity and applied forces on the grains that move by the forces on them \[J\].
pub(crate) fn potential(state: &State, fields: &Fields) -> f64 {
    let particles = &state.particles;
    let of = |slot: usize| {
        let [x, y, z] = fields.weight(particles.velocity[slot][3]);
        let [a, b, c] = fields.applied(particles.id[slot]);
        -Vector::new(x + a, y + b, z + c).dot(state.unwrapped(slot).into())
    };
    let loose: f64 = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0).map(of).sum();
    let clumps = &state.clumps;
    let of_clump = |clump: usize| {
        let weight = Vector::from(fields.weight(clumps.velocity[clump][3]));
        let applied = clumps.spheres_of(clump).iter().map(|&sphere| {
            let place = state.unwrapped(particles.slot[sphere as usize] as usize);
            Vector::from(fields.applied(sphere)).dot(place.into())
        });
        -weight.dot(state.unwrapped_clump(clump).into()) - applied.sum::<f64>()
    };
    loose + (0..clumps.len()).map(of_clump).sum::<f64>()
}

/// Books what global damping takes in the first half kick of a step of this length \[s\], and the half kick of bodies.
pub(crate) fn begin_step(state: &mut State, fields: &Fields, bodies: &[Option<RigidBody>], step: f64) {
    if let Some(losses) = &mut state.losses {
        let [power, growth] = losses.braking;
        losses.add(Loss::GlobalDamping, step * (power + step * growth));
        book::book_losses(state, fields, bodies, step);
    }
}

/// Energy that causes of loss hold and may give back \[J\]: rolling springs, sticky normal forces, plastic ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StoredEnergy(pub(crate) [f64; 3]);

impl StoredEnergy {
    /// Which causes they are.
    pub(crate) const CAUSES: [Loss; 3] = [Loss::Rolling, Loss::Cohesion, Loss::Plastic];
}

/// What a loss took since the book was opened \[J\]: what it holds now is not lost.
pub(crate) fn lost(state: &State, losses: &Losses, held: &StoredEnergy, loss: Loss) -> f64 {
    let bonds = |of: fn(&crate::engine::state::BondList) -> f64| state.bonds.iter().map(of).sum::<f64>();
    let taken = losses.taken[loss as usize];
    match loss {
        Loss::BondDamping => bonds(|list| list.damped + list.relaxed),
        Loss::BondRelease => bonds(|list| list.released),
        Loss::Removed => state.exchange.as_ref().map_or(0.0, |exchange| -exchange.net.energy()),
        _ => match StoredEnergy::CAUSES.iter().position(|cause| *cause == loss) {
            Some(place) => taken - (held.0[place] - losses.initial_held[place]),
            None => taken,
        },
    }
}
