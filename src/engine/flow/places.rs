//! Where new particles begin: whole in their region, free of everything that is there.

use super::occupied::Occupied;
use super::{WHOLE, book, cost, is_owed};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::engine::bodies::clumps::{self, ClumpBodies};
use crate::engine::columns;
use crate::engine::integration::Fields;
use crate::engine::run_error::RunError;
use crate::engine::state::exchange::{Exchange, InsertionProgress, NetExchange};
use crate::engine::state::{InsertedParticle, State};
use crate::scene::exchange::Amount;
use crate::scene::packing::generator::{generator_after, uniform};
use crate::scene::{Clump, Insertion, ParticleShape, Scene};

/// Places that are tried for one before its region counts as full.
const TRIES: usize = 200;

/// What comes.
enum Newcomer {
    /// A sphere: rows of position and velocity.
    Sphere([f64; 4], [f64; 4]),
    /// A clump.
    Clump(Clump),
}

/// Lets what is due of an insertion come, as far as there is room: by its index, and whether particles have an orientation.
/// Returns whether any came.
pub(super) fn feed(
    scene: &Scene,
    (fields, bodies): (&Fields, Option<&ClumpBodies>),
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
    let newcomers = newcomers(scene, state, insertion, &mut feed, &mut next);
    feed.draws = draws;
    (feed.tried, feed.travel) = (state.clock.steps, 0.0);
    let came = !newcomers.is_empty();
    let since = state.clock.time - 0.5 * step;
    let material = insertion.material.0;
    let declared = columns::of_insertion(scene, index);
    for newcomer in newcomers {
        let (time, exchange) = (state.clock.time, state.exchange.as_mut().expect("an insertion has an exchange"));
        let (position, velocity, spheres) = match newcomer {
            Newcomer::Sphere(position, velocity) => {
                let number = number(exchange, time)?;
                let inertia = ParticleShape::Sphere.inertia(velocity[3], position[3]);
                let sphere = InsertedParticle { position, velocity, inertia, material, number, declared: &declared };
                state.add_particle(&sphere, 0, turning);
                (position, velocity, None)
            }
            Newcomer::Clump(clump) => {
                let shape = &scene.clump_shapes[clump.shape as usize];
                let mut spheres = Vec::with_capacity(shape.spheres.len());
                for (sphere, (_, radius)) in shape.spheres.iter().enumerate() {
                    let radius = clump.scale * radius;
                    let [[x, y, z], [u, v, w]] = clump.placed(shape, sphere);
                    spheres.push(InsertedParticle {
                        position: [x, y, z, radius],
                        // Laws see the mass of the clump.
                        velocity: [u, v, w, clump.mass],
                        inertia: ParticleShape::Sphere.inertia(clump.mass, radius),
                        material,
                        number: number(exchange, time)?,
                        declared: &declared,
                    });
                }
                let (rows, next) = (clumps::rows(scene, &clump), exchange.next_clump);
                exchange.next_clump += 1;
                state.add_clump(&rows, next, &spheres, turning);
                (rows.position, rows.velocity, Some(spheres.len()))
            }
        };
        let mut net = NetExchange::default();
        book(&mut net, velocity, 1.0, since);
        net.potential = -Vector::from(fields.weight(velocity[3])).dot(position.into());
        if let Some(exchange) = &mut state.exchange {
            exchange.net.add(&net);
        }
        feed.came.add(spheres, velocity[3]);
    }
    if let Some(bodies) = bodies.filter(|_| came) {
        bodies.place(state);
    }
    if let Some(kept) = state.exchange.as_mut().and_then(|exchange| exchange.feeds.get_mut(index)) {
        *kept = feed;
    }
    Ok(came)
}

/// The number of the next particle.
fn number(exchange: &mut Exchange, time: f64) -> Result<u32, RunError> {
    let number = exchange.next;
    exchange.next = number.checked_add(1).ok_or(RunError::NoNumberLeft { time })?;
    Ok(number)
}

/// What comes.
fn newcomers(
    scene: &Scene,
    state: &State,
    insertion: &Insertion,
    feed: &mut InsertionProgress,
    next: &mut dyn FnMut() -> f64,
) -> Vec<Newcomer> {
    let region = &scene.regions[insertion.region];
    let shift = region.follows.map_or(Vector::zero(), |it| state.boundaries[it.index()].displacement.into());
    let [low, high] = region.shape.bounds().map(|corner| (Vector::from(corner) + shift).to_array());
    let [_, largest] = insertion.radii();
    let mut occupied = Occupied::around([low, high], largest, scene, state);
    let mut newcomers = Vec::new();
    feed.full = false;
    loop {
        // What has been drawn is kept until it finds room, so that large ones are not passed over.
        if feed.radius == 0.0 {
            (feed.kind, feed.radius) = insertion.draw(next);
            if let Some(clump) = &insertion.kinds[feed.kind as usize].clump {
                feed.orientation = insertion.orientation.turn(&clump.shape, next).to_row();
            }
        }
        if !is_owed(insertion, feed) {
            return newcomers;
        }
        let place = |next: &mut dyn FnMut() -> f64| region.shape.place(feed.radius, next).map(|place| place + shift);
        let Some((centre, spheres)) = free_place(&mut occupied, (insertion, feed), next, &place) else {
            feed.full = true;
            drop_rest(insertion, feed);
            return newcomers;
        };
        spheres.into_iter().for_each(|sphere| occupied.add(sphere));
        let velocity = insertion.velocity.map(|part| part + insertion.scatter * (2.0 * next() - 1.0));
        let kind = &insertion.kinds[feed.kind as usize];
        newcomers.push(match &kind.clump {
            Some(clump) => {
                let place = (centre.to_array(), Quaternion::from_row(feed.orientation));
                Newcomer::Clump(clump.of(feed.radius, place, velocity))
            }
            None => {
                let moving = Vector::from(velocity).row_with(kind.mass(feed.radius));
                Newcomer::Sphere(centre.row_with(feed.radius), moving)
            }
        });
        feed.owed = (feed.owed - cost(insertion, feed)).max(0.0);
        feed.radius = 0.0;
    }
}

/// A place for what comes next that meets nothing, and its spheres there, if one is found.
fn free_place(
    occupied: &mut Occupied,
    (insertion, feed): (&Insertion, &InsertionProgress),
    next: &mut dyn FnMut() -> f64,
    place: &dyn Fn(&mut dyn FnMut() -> f64) -> Option<Vector>,
) -> Option<(Vector, Vec<[f64; 4]>)> {
    let clump = insertion.kinds[feed.kind as usize].clump.as_ref();
    for _ in 0..TRIES {
        let centre = place(next)?;
        let spheres = match clump {
            None => vec![centre.row_with(feed.radius)],
            Some(clump) => {
                let turn = Quaternion::from_row(feed.orientation);
                clump.of(feed.radius, (centre.to_array(), turn), [0.0; 3]).spheres(&clump.shape)
            }
        };
        if !spheres.iter().any(|&sphere| occupied.meets(sphere)) {
            return Some((centre, spheres));
        }
    }
    None
}

/// What a rate asked for and found no room is not made up for, but for the one that waits.
fn drop_rest(insertion: &Insertion, feed: &mut InsertionProgress) {
    let next = cost(insertion, feed);
    let rest = feed.owed - next;
    if !matches!(insertion.amount, Amount::Mass(_)) && rest > WHOLE * next {
        feed.owed -= rest;
        feed.dropped += rest;
    }
}
