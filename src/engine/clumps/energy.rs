//! Energies of clumps, and the entries of the energy books for them.

use super::loads::{applied, of_spheres};
use super::motion_after;
use crate::base::number::Vector;
use crate::engine::integration::{Fields, Load};
use crate::engine::state::ledger::Source;
use crate::engine::state::{Clumps, Loss, Row, State};

/// Kinetic energy of all clumps \[J\].
pub(crate) fn kinetic(clumps: &Clumps) -> f64 {
    let rows = clumps.velocity.iter().zip(clumps.angular_momentum.iter().zip(&clumps.angular_velocity));
    rows.map(|(v, (l, w))| {
        let (moving, turning) = (Vector::from(*v), Vector::from(*w).dot(Vector::from(*l)));
        0.5 * v[3] * moving.dot(moving) + 0.5 * turning
    })
    .sum()
}

/// Notes the loads on the spheres of clumps so far, of which the last are of this kind.
pub(crate) fn note_loads(state: &mut State, source: Source) {
    let State { particles, clumps, ledger: Some(ledger), .. } = state else { return };
    let of = |clump: usize| {
        let [force, moment] = of_spheres(clumps, clump, particles);
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    };
    let on_clumps = &mut ledger.on_clumps[source as usize];
    on_clumps.clear();
    on_clumps.extend((0..clumps.len()).map(of));
}

/// Mean of the motion of a clump before and after the half kick that is about to be made, times its length \[m, rad\].
fn way(clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
    let before = [Vector::from(clumps.velocity[clump]), Vector::from(clumps.angular_velocity[clump])];
    let after = motion_after(clumps, clump, step);
    [0, 1].map(|part| (before[part] + after[part]) * (0.25 * step))
}

/// Work of a load on such a way \[J\].
fn work(load: Load, way: [Vector; 2]) -> f64 {
    load[0].dot(way[0]) + load[1].dot(way[1])
}

/// Work of weight, applied forces and damping on a clump.
fn of_fields(state: &State, clump: usize, fields: &Fields, way: [Vector; 2]) -> [f64; 3] {
    let (clumps, particles) = (&state.clumps, &state.particles);
    let weight = [Vector::from(fields.weight(clumps.velocity[clump][3])), Vector::zero()];
    let applied = applied(clumps, clump, (fields, particles));
    let braking = clumps.braking.get(clump).map_or([Vector::zero(); 2], |load: &[Row; 2]| load.map(Vector::from));
    [weight, applied, braking].map(|load| work(load, way))
}

/// Books what forces do to clumps in the half kick that is about to be made.
pub(crate) fn book_work(state: &mut State, fields: &Fields, step: f64) {
    if state.clumps.is_empty() {
        return;
    }
    let Some(mut ledger) = state.ledger.take() else { return };
    for clump in 0..state.clumps.len() {
        let way = way(&state.clumps, clump, step);
        let mut works = [0.0; Source::COUNT];
        let mut before = 0.0;
        for (work_of, loads) in works.iter_mut().zip(&ledger.on_clumps) {
            let Some(&[x, y, z, a, b, c]) = loads.get(clump) else { continue };
            let so_far = work([Vector::new(x, y, z), Vector::new(a, b, c)], way);
            *work_of = so_far - before;
            before = so_far;
        }
        let [weight, applied, braking] = of_fields(state, clump, fields, way);
        works[Source::Gravity as usize] = weight;
        works[Source::Applied as usize] = applied;
        works[Source::Damping as usize] = braking;
        for (sum, work) in ledger.work.iter_mut().zip(works) {
            *sum += work;
            ledger.turnover += work.abs();
        }
    }
    state.ledger = Some(ledger);
}

/// Books what global damping takes from clumps in the half kick that is about to be made.
pub(crate) fn book_losses(state: &mut State, fields: &Fields, step: f64) {
    if state.clumps.is_empty() {
        return;
    }
    let Some(mut losses) = state.losses.take() else { return };
    for clump in 0..state.clumps.len() {
        let way = way(&state.clumps, clump, step);
        let [_, _, braking] = of_fields(state, clump, fields, way);
        losses.add(Loss::GlobalDamping, -braking);
    }
    state.losses = Some(losses);
}
