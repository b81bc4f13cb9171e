//! Which particles go, and why.

use super::passed::PassedParticle;
use super::removes_outside;
use crate::base::number::Vector;
use crate::engine::cell::near::{self, Place};
use crate::engine::run_error::RunError;
use crate::engine::state::State;
use crate::engine::state::exchange::{Exchange, ParticleCount};
use crate::scene::{OutletPlace, Scene};

/// Particles that go.
pub(crate) struct RemovedParticles {
    /// Whether the particle of each slot goes.
    pub(crate) goes: Vec<bool>,
    /// How many go by each outlet, because they are outside the domain, and through each boundary.
    tallies: Vec<ParticleCount>,
    /// Those that came through a boundary.
    passed: Vec<PassedParticle>,
}

impl RemovedParticles {
    /// Adds them to what went.
    pub(super) fn tell(&self, scene: &Scene, exchange: &mut Exchange) {
        let Exchange { outlets, outside, passed, .. } = exchange;
        let told = outlets.iter_mut().take(scene.outlets.len()).chain([outside]).chain(passed);
        for (sum, tally) in told.zip(&self.tallies) {
            sum.count += tally.count;
            sum.clumps += tally.clumps;
            sum.mass += tally.mass;
        }
    }

    /// Puts what came through a boundary back to where it was before, so that its contact gives what it held.
    pub(crate) fn put_back(&self, state: &mut State) {
        for passed in self.passed.iter().filter(|passed| self.goes[passed.slot]) {
            let row = &mut state.particles.position[passed.slot];
            *row = passed.before.row_with(row[3]);
        }
    }
}

/// The particles whose centres are where an outlet takes them away, if there are any: of clumps all spheres go when their mass centre is
/// there, or one of them came through a boundary. The first outlet that has one takes it.
pub(super) fn find(
    scene: &Scene,
    state: &State,
    passed: &[PassedParticle],
) -> Result<Option<RemovedParticles>, RunError> {
    let particles = &state.particles;
    let outside = scene.domain.filter(|_| removes_outside(scene));
    let (mut any, mut goes) = (false, vec![false; particles.len()]);
    let first = scene.outlets.len() + 1;
    let mut tallies = vec![ParticleCount::default(); first + scene.boundaries.len()];
    let shifts: Vec<Vector> = scene.outlets.iter().map(|outlet| shift(scene, state, outlet.place)).collect();
    let places: Vec<Option<Place>> =
        scene.outlets.iter().zip(&shifts).map(|(outlet, shift)| place(scene, state, (outlet.place, *shift))).collect();
    let place_of = |centre: Vector| {
        let by = scene.outlets.iter().zip(&shifts).zip(&places).position(|((outlet, shift), place)| {
            let mut taken = false;
            let mut look = |centre: Vector| taken |= takes(scene, outlet.place, centre - *shift);
            match place {
                Some(place) => place.meets(centre, 0.0, look),
                None => look(centre),
            }
            taken
        });
        by.or_else(|| outside.filter(|corners| is_outside(centre, corners)).map(|_| scene.outlets.len()))
    };
    let through = |slot: usize| passed.iter().find(|it| it.slot == slot).map(|it| first + it.boundary);
    for slot in near::particles(state).filter(|&slot| state.clump(slot).is_none()) {
        let by = place_of(particles.position[slot].into()).or_else(|| through(slot));
        let Some(by) = by else { continue };
        if let Some(group) = particles.group(slot) {
            return Err(RunError::GroupLeaves {
                id: particles.id[slot],
                boundary: scene.boundaries[group].name.clone(),
                by: words(scene, by),
                time: state.clock.time,
            });
        }
        (any, goes[slot]) = (true, true);
        tallies[by].add(None, particles.velocity[slot][3]);
    }
    for (clump, centre) in state.clumps.position.iter().enumerate() {
        let spheres = state.clumps.spheres_of(clump);
        let mut slots = spheres.iter().map(|&sphere| particles.slot[sphere as usize] as usize);
        let by = place_of(Vector::from(*centre)).or_else(|| slots.clone().find_map(through));
        let Some(by) = by else { continue };
        any = true;
        slots.by_ref().for_each(|slot| goes[slot] = true);
        tallies[by].add(Some(spheres.len()), state.clumps.velocity[clump][3]);
    }
    Ok(any.then(|| RemovedParticles { goes, tallies, passed: passed.to_vec() }))
}

/// What takes particles away, by its place in the tallies.
fn words(scene: &Scene, by: usize) -> String {
    match (scene.outlets.get(by), by.checked_sub(scene.outlets.len() + 1)) {
        (Some(outlet), _) => format!("[outlet.{}]", outlet.name),
        (None, Some(boundary)) => format!("[boundary.{}]", scene.boundaries[boundary].name),
        (None, None) => "[domain]".to_owned(),
    }
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

/// Where particles meet an outlet that is a region, displaced by so much \[m\].
fn place(scene: &Scene, state: &State, (place, shift): (OutletPlace, Vector)) -> Option<Place> {
    let OutletPlace::Region(region) = place else { return None };
    let corners = scene.regions[region].shape.bounds().map(|corner| (Vector::from(corner) + shift).to_array());
    Some(Place::of(scene, state, corners))
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
