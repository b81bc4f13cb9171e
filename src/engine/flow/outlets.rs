//! Which particles go, and why.

use super::removes_outside;
use crate::base::number::Vector;
use crate::engine::run_error::RunError;
use crate::engine::state::State;
use crate::engine::state::exchange::{Exchange, ParticleCount};
use crate::scene::{OutletPlace, Scene};

/// Particles that go.
pub(crate) struct RemovedParticles {
    /// Whether the particle of each slot goes.
    pub(crate) goes: Vec<bool>,
    /// How many go by each outlet and, last, because they are outside the domain.
    tallies: Vec<ParticleCount>,
}

impl RemovedParticles {
    /// Adds them to what went.
    pub(super) fn tell(&self, scene: &Scene, exchange: &mut Exchange) {
        let Exchange { outlets, outside, .. } = exchange;
        let told = outlets.iter_mut().take(scene.outlets.len()).chain([outside]);
        for (sum, tally) in told.zip(&self.tallies) {
            sum.count += tally.count;
            sum.mass += tally.mass;
        }
    }
}

/// The particles whose centres are where an outlet takes them away, if there are any. The first outlet that has one takes it.
pub(super) fn find(scene: &Scene, state: &State) -> Result<Option<RemovedParticles>, RunError> {
    let particles = &state.particles;
    let outside = scene.domain.filter(|_| removes_outside(scene));
    let (mut any, mut goes) = (false, vec![false; particles.len()]);
    let mut tallies = vec![ParticleCount::default(); scene.outlets.len() + 1];
    let shifts: Vec<Vector> = scene.outlets.iter().map(|outlet| shift(scene, state, outlet.place)).collect();
    for slot in 0..goes.len() {
        let centre = Vector::from(particles.position[slot]);
        let taken = |(place, shift): (&crate::scene::Outlet, &Vector)| takes(scene, place.place, centre - *shift);
        let by = scene.outlets.iter().zip(&shifts).position(taken);
        let by = by.or_else(|| outside.filter(|corners| is_outside(centre, corners)).map(|_| scene.outlets.len()));
        let Some(by) = by else { continue };
        if let Some(group) = (particles.owner[slot] as usize).checked_sub(1) {
            return Err(RunError::GroupLeaves {
                id: particles.id[slot],
                boundary: scene.boundaries[group].name.clone(),
                by: scene.outlets.get(by).map_or("[domain]".to_owned(), |outlet| format!("[outlet.{}]", outlet.name)),
                time: state.clock.time,
            });
        }
        (any, goes[slot]) = (true, true);
        tallies[by].add(particles.velocity[slot][3]);
    }
    Ok(any.then_some(RemovedParticles { goes, tallies }))
}

/// How far an outlet has moved with its boundary, or with the one that its region follows \[m\].
fn shift(scene: &Scene, state: &State, place: OutletPlace) -> Vector {
    let follows = match place {
        OutletPlace::Region(region) => scene.regions[region].follows,
        OutletPlace::Beyond(_) => None,
        OutletPlace::Behind(boundary) => Some(boundary),
    };
    follows.map_or(Vector::zero(), |boundary| state.boundaries[boundary.index()].displacement.into())
}

/// Whether an outlet takes away what has its centre there \[m\].
fn takes(scene: &Scene, place: OutletPlace, centre: Vector) -> bool {
    match place {
        OutletPlace::Region(region) => scene.regions[region].shape.holds(centre),
        OutletPlace::Beyond([point, normal]) => is_behind(centre, point, normal),
        OutletPlace::Behind(boundary) => scene.boundaries[boundary.index()]
            .shifting_plane()
            .is_some_and(|plane| is_behind(centre, plane.point, plane.normal)),
    }
}

/// Whether a centre is behind a plane.
fn is_behind(centre: Vector, point: [f64; 3], normal: [f64; 3]) -> bool {
    (centre - point.into()).dot(normal.into()) < 0.0
}

/// Whether a centre is outside of a box.
fn is_outside(centre: Vector, [low, high]: &[[f64; 3]; 2]) -> bool {
    centre.to_array().iter().enumerate().any(|(axis, part)| *part < low[axis] || *part > high[axis])
}
