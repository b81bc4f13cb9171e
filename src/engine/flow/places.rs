//! Where new particles begin: whole in their region, free of everything that is there.

use super::occupied::Occupied;
use super::{book, cost, is_owed};
use crate::base::number::Vector;
use crate::engine::integration::Fields;
use crate::engine::run_error::RunError;
use crate::engine::state::exchange::{InsertionProgress, NetExchange};
use crate::engine::state::{InsertedParticle, State};
use crate::scene::exchange::Amount;
use crate::scene::packing::generator::{generator_after, uniform};
use crate::scene::{Insertion, ParticleShape, Scene};

/// Places that are tried for a sphere before its region counts as full.
const TRIES: usize = 200;

/// Lets what is due of an insertion come, as far as there is room: by its index, and whether particles have an orientation.
/// Returns whether any came.
pub(super) fn feed(
    scene: &Scene,
    fields: &Fields,
    state: &mut State,
    (index, turning): (usize, bool),
    step: f64,
) -> Result<bool, RunError> {
    let insertion = &scene.insertions[index];
    let Some(mut feed) = state.exchange.as_ref().and_then(|exchange| exchange.feeds.get(index)).copied() else {
        return Ok(false);
    };
    let name = format!("insertion.{}", insertion.name);
    let mut random = generator_after(scene.run.seed, &name, feed.draws);
    let mut draws = feed.draws;
    let mut next = || {
        draws += 1;
        uniform(&mut random)
    };
    let spheres = spheres(scene, state, insertion, &mut feed, &mut next);
    feed.draws = draws;
    (feed.tried, feed.travel) = (state.clock.steps, 0.0);
    let came = !spheres.is_empty();
    let since = state.clock.time - 0.5 * step;
    for (position, velocity) in spheres {
        let exchange = state.exchange.as_mut().expect("a scene with an insertion has an exchange");
        let number = exchange.next;
        exchange.next = number.checked_add(1).ok_or(RunError::NoNumberLeft { time: state.clock.time })?;
        let mut net = NetExchange::default();
        book(&mut net, (position, velocity), 1.0, since);
        net.potential = -Vector::from(fields.weight(velocity[3])).dot(position.into());
        exchange.net.add(&net);
        feed.came.add(velocity[3]);
        let (material, inertia) = (insertion.material.0, ParticleShape::Sphere.inertia(velocity[3], position[3]));
        let index = state.particles.add(&InsertedParticle { position, velocity, inertia, material, number }, turning);
        if let Some(cell) = &mut state.cell {
            cell.begin_at(index);
        }
    }
    if let Some(kept) = state.exchange.as_mut().and_then(|exchange| exchange.feeds.get_mut(index)) {
        *kept = feed;
    }
    Ok(came)
}

/// Rows of position and velocity of the spheres that come.
fn spheres(
    scene: &Scene,
    state: &State,
    insertion: &Insertion,
    feed: &mut InsertionProgress,
    next: &mut dyn FnMut() -> f64,
) -> Vec<([f64; 4], [f64; 4])> {
    let region = &scene.regions[insertion.region];
    let shift = region.follows.map_or(Vector::zero(), |it| state.boundaries[it.index()].displacement.into());
    let [low, high] = region.shape.bounds().map(|corner| (Vector::from(corner) + shift).to_array());
    let [_, largest] = insertion.sizes.bounds();
    let mut occupied = Occupied::around([low, high], largest, scene, state);
    let mut spheres = Vec::new();
    feed.full = false;
    loop {
        // A radius once drawn is kept until it finds room, so that large ones are not passed over.
        if feed.radius == 0.0 {
            feed.radius = insertion.sizes.draw(next);
        }
        if !is_owed(insertion, feed, feed.radius) {
            return spheres;
        }
        let Some(position) = free_place(&mut occupied, feed.radius, next, &|next| {
            region.shape.place(feed.radius, next).map(|place| place + shift)
        }) else {
            feed.full = true;
            drop_rest(insertion, feed);
            return spheres;
        };
        occupied.add(position);
        let [u, v, w] = insertion.velocity.map(|part| part + insertion.scatter * (2.0 * next() - 1.0));
        spheres.push((position, [u, v, w, insertion.mass(feed.radius)]));
        feed.owed = (feed.owed - cost(insertion, feed.radius)).max(0.0);
        feed.radius = 0.0;
    }
}

/// A place for a sphere of this radius \[m\] that meets nothing, if one is found.
fn free_place(
    occupied: &mut Occupied,
    radius: f64,
    next: &mut dyn FnMut() -> f64,
    place: &dyn Fn(&mut dyn FnMut() -> f64) -> Option<Vector>,
) -> Option<[f64; 4]> {
    for _ in 0..TRIES {
        let sphere = place(next)?.row_with(radius);
        if !occupied.meets(sphere) {
            return Some(sphere);
        }
    }
    None
}

/// What a rate asked for and found no room is not made up for, but for the sphere that waits.
fn drop_rest(insertion: &Insertion, feed: &mut InsertionProgress) {
    if !matches!(insertion.amount, Amount::Mass(_)) {
        let rest = (feed.owed - cost(insertion, feed.radius)).max(0.0);
        feed.owed -= rest;
        feed.dropped += rest;
    }
}
