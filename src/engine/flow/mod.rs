//! Particles come and go while a scene runs.
//!
//! All changes of number happen inside of a time step, after positions have been moved on and before neighbour lists are looked
//! at: velocities are those of the middle of the step, of which each half kick has been booked as a whole, so that books close to
//! rounding. Who has changed anything lets lists be made anew. A scene that names no insertion, outlet or flow meter has no
//! [`Flow`], and nothing of this runs.

mod check;
mod meters;
mod occupied;
mod outlets;
mod passed;
mod places;

use crate::base::number::Vector;
use crate::engine::bodies::ClumpBodies;
use crate::engine::boundaries::passing::Passing;
use crate::engine::integration::Fields;
use crate::engine::run_error::RunError;
use crate::engine::state::State;
use crate::engine::state::exchange::{Exchange, InsertionProgress, NetExchange};
use crate::scene::exchange::{Amount, Outside};
use crate::scene::{OutletPlace, Scene};
pub(crate) use check::{check, is_made};
pub(crate) use outlets::RemovedParticles;

/// Time steps between two times at which an insertion is tried.
const WAIT: u64 = 50;

/// How many are due of a rate before that: time steps may be long where nothing touches.
const MOST_DUE: f64 = 10.0;

/// The same over the number of particles: a try looks at all of them.
const MOST_DUE_SHARE: f64 = 0.01;

/// Way over the smallest radius after which outlets are looked at again, and a full region is.
const LOOK: f64 = 0.5;

/// How near to a whole number what is due counts as that.
const WHOLE: f64 = 1e-9;

/// What lets particles come and go: what it knows of the scene, and its working space.
pub(crate) struct Flow {
    /// Radius of the smallest particle \[m\].
    smallest: f64,
    /// Whether particles have an orientation.
    turning: bool,
    /// Whether particles go.
    removes: bool,
    /// Whether every time step looks for them: behind a boundary they would otherwise be lost.
    looks_always: bool,
    /// How particles came to where they are, where those go that came through a boundary.
    passing: Option<Passing>,
}

impl Flow {
    /// What a scene asks for, if it asks for anything. `turning`: whether particles have an orientation.
    pub(crate) fn of(scene: &Scene, turning: bool) -> Option<Self> {
        let smallest = scene.radii().fold(f64::INFINITY, f64::min);
        let any = scene.changes_number() || !scene.meters.is_empty();
        let behind = scene.outlets.iter().any(|outlet| matches!(outlet.place, OutletPlace::Behind(_)));
        let through = scene.boundaries.iter().any(|boundary| boundary.outside == Outside::Remove);
        let (passing, looks_always) = (through.then(|| Passing::of(scene)), behind || through);
        any.then(|| Self { smallest, turning, removes: scene.removes(), looks_always, passing })
    }

    /// Begins a communication step of this length \[s\].
    pub(crate) fn begin(&self, state: &mut State, interval: f64) {
        let Some(exchange) = &mut state.exchange else { return };
        for feed in &mut exchange.feeds {
            feed.present = (feed.rate + 0.5 * interval * feed.rate_of_rate).max(0.0);
        }
        for passed in &mut exchange.meters {
            passed.mass_before = passed.mass;
        }
    }

    /// Ends it, after so long \[s\].
    pub(crate) fn end(&self, state: &mut State, elapsed: f64) {
        let Some(exchange) = state.exchange.as_mut().filter(|_| elapsed > 0.0) else { return };
        for passed in &mut exchange.meters {
            passed.mass_flow = (passed.mass - passed.mass_before) / elapsed;
        }
    }

    /// Takes notice of a time step of this length \[s\] in which nothing moved further than `way` \[m\].
    pub(crate) fn pass(&self, scene: &Scene, state: &mut State, way: f64, step: f64) {
        meters::count(scene, state, step);
        let Some(exchange) = &mut state.exchange else { return };
        exchange.travel += way;
        for feed in &mut exchange.feeds {
            feed.travel += way;
            feed.owed += step * feed.present;
        }
    }

    /// The particles that go now, in a time step of this length \[s\], if it is time to look and there are any.
    pub(crate) fn leaving(
        &self,
        scene: &Scene,
        state: &mut State,
        step: f64,
    ) -> Result<Option<RemovedParticles>, RunError> {
        let Some(exchange) = state.exchange.as_mut().filter(|_| self.removes) else { return Ok(None) };
        if exchange.travel <= LOOK * self.smallest && !self.looks_always {
            return Ok(None);
        }
        exchange.travel = 0.0;
        let passed = self.passing.as_ref().map(|passing| passed::find(scene, state, passing, step));
        outlets::find(scene, state, &passed.unwrap_or_default())
    }

    /// Takes them away, in a time step of this length \[s\].
    pub(crate) fn remove(
        &self,
        scene: &Scene,
        fields: &Fields,
        state: &mut State,
        leaving: &RemovedParticles,
        step: f64,
    ) {
        let since = state.clock.time - 0.5 * step;
        let particles = &state.particles;
        let mut net = NetExchange::default();
        for slot in (0..leaving.goes.len()).filter(|&slot| leaving.goes[slot]) {
            let id = particles.id[slot];
            let applied = fields.applied(id);
            let mut load = Vector::from(applied);
            if state.clump(slot).is_none() {
                let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
                book(&mut net, velocity, -1.0, since);
                book_turning(&mut net, 0.5 * spin[3] * Vector::from(spin).dot(spin.into()));
                load = Vector::from(fields.loads(velocity[3], id));
            }
            net.potential += load.dot(state.unwrapped(slot).into());
            for axis in 0..3 {
                net.applied[axis] -= applied[axis];
                net.applied_time[axis] -= applied[axis] * since;
            }
        }
        let clumps = &state.clumps;
        let of_clump = |clump: usize| particles.slot[clumps.spheres_of(clump)[0] as usize] as usize;
        for clump in (0..clumps.len()).filter(|&clump| leaving.goes[of_clump(clump)]) {
            book(&mut net, clumps.velocity[clump], -1.0, since);
            let (spin, momentum) = (clumps.angular_velocity[clump], clumps.angular_momentum[clump]);
            book_turning(&mut net, 0.5 * Vector::from(spin).dot(momentum.into()));
            let weight = Vector::from(fields.weight(clumps.velocity[clump][3]));
            net.potential += weight.dot(state.unwrapped_clump(clump).into());
        }
        if let Some(exchange) = &mut state.exchange {
            exchange.net.add(&net);
            leaving.tell(scene, exchange);
        }
        state.remove(&leaving.goes);
    }

    /// Books energies that contacts held which are no longer there \[J\]: elastic ones, and those that causes of loss hold and may
    /// give back.
    pub(crate) fn book_contacts(&self, state: &mut State, elastic: f64, held: [f64; 3]) {
        if let Some(exchange) = &mut state.exchange {
            exchange.net.elastic -= elastic;
        }
        if let Some(losses) = &mut state.losses {
            losses.initial_held.iter_mut().zip(held).for_each(|(begun, held)| *begun -= held);
        }
    }

    /// Whether a particle is due and may be tried.
    pub(crate) fn is_due(&self, scene: &Scene, state: &State) -> bool {
        let Some(exchange) = &state.exchange else { return false };
        let feeds = exchange.feeds.iter().zip(&scene.insertions);
        feeds.into_iter().any(|(feed, insertion)| self.may_come(feed, insertion, state))
    }

    /// Whether a mass is still to come of which not all found room when it was tried last.
    pub(crate) fn is_filling(&self, scene: &Scene, state: &State) -> bool {
        let Some(exchange) = &state.exchange else { return false };
        let mut feeds = exchange.feeds.iter().zip(&scene.insertions);
        feeds.any(|(feed, insertion)| {
            matches!(insertion.amount, Amount::Mass(_)) && !feed.full && is_owed(insertion, feed)
        })
    }

    /// Whether a particle of an insertion is due and may be tried.
    fn may_come(&self, feed: &InsertionProgress, insertion: &crate::scene::Insertion, state: &State) -> bool {
        let most = MOST_DUE.max(MOST_DUE_SHARE * state.particles.len() as f64);
        let is_late = !matches!(insertion.amount, Amount::Mass(_)) && feed.owed >= most * cost(insertion, feed);
        let waited = state.clock.steps >= feed.tried + WAIT || feed.tried == 0 || is_late;
        waited && is_owed(insertion, feed) && (!feed.full || feed.travel > LOOK * self.smallest)
    }

    /// Lets particles come that are due, in a time step of this length \[s\]. Returns whether any came.
    pub(crate) fn insert(
        &self,
        scene: &Scene,
        (fields, clumps): (&Fields, Option<&ClumpBodies>),
        state: &mut State,
        step: f64,
    ) -> Result<bool, RunError> {
        let mut came = false;
        for (index, insertion) in scene.insertions.iter().enumerate() {
            let due = state.exchange.as_ref().is_some_and(|exchange| {
                exchange.feeds.get(index).is_some_and(|feed| self.may_come(feed, insertion, state))
            });
            if due {
                came |= places::feed(scene, (fields, clumps), state, (index, self.turning), step)?;
            }
        }
        Ok(came)
    }
}

/// Whether what comes next is due.
fn is_owed(insertion: &crate::scene::Insertion, feed: &InsertionProgress) -> bool {
    feed.owed >= cost(insertion, feed) * (1.0 - WHOLE)
}

/// What the next one takes of what is due: its mass \[kg\], the least where it has not been drawn, or 1 where they are counted.
fn cost(insertion: &crate::scene::Insertion, feed: &InsertionProgress) -> f64 {
    match insertion.amount {
        Amount::MassRate(_) | Amount::Mass(_) if feed.radius > 0.0 => {
            insertion.kinds[feed.kind as usize].mass(feed.radius)
        }
        _ => insertion.least_amount(),
    }
}

/// Books the energy with which a body that goes turns \[J\].
fn book_turning(net: &mut NetExchange, turning: f64) {
    (net.kinetic, net.turnover) = (net.kinetic - turning, net.turnover + turning);
}

/// Books the velocity row of a body that comes (`sign` 1) or goes (−1) and is there from, or up to, this time \[s\];
/// not what acts on it.
fn book(net: &mut NetExchange, velocity: [f64; 4], sign: f64, since: f64) {
    let mass = sign * velocity[3];
    net.mass += mass;
    net.mass_time += mass * since;
    let moving = 0.5 * velocity[3] * Vector::from(velocity).dot(velocity.into());
    net.kinetic += sign * moving;
    net.turnover += moving;
    for axis in 0..3 {
        net.momentum[axis] += mass * velocity[axis];
    }
}

impl NetExchange {
    /// Adds what came and went.
    fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.mass_time += other.mass_time;
        for axis in 0..3 {
            self.momentum[axis] += other.momentum[axis];
            self.applied[axis] += other.applied[axis];
            self.applied_time[axis] += other.applied_time[axis];
        }
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.potential += other.potential;
        self.turnover += other.turnover;
    }
}

/// What is known at time 0 of particles that come and go; none where their number stays and nothing is metered.
pub(crate) fn begun(scene: &Scene) -> Option<Exchange> {
    if !scene.changes_number() && scene.meters.is_empty() {
        return None;
    }
    let feed = |insertion: &crate::scene::Insertion| InsertionProgress {
        rate: insertion.rate().unwrap_or(0.0),
        owed: match insertion.amount {
            Amount::Mass(mass) => mass,
            Amount::MassRate(_) | Amount::CountRate(_) => 0.0,
        },
        orientation: [1.0, 0.0, 0.0, 0.0],
        ..InsertionProgress::default()
    };
    Some(Exchange {
        // What is in an outlet at the beginning goes in the first time step.
        travel: scene.radii().fold(0.0, f64::max),
        next: scene.particles.last().map_or(1, |last| last.id.0.saturating_add(1)),
        next_clump: scene.clumps.len() as u32,
        feeds: scene.insertions.iter().map(feed).collect(),
        outlets: vec![Default::default(); scene.outlets.len()],
        passed: vec![Default::default(); scene.boundaries.len()],
        meters: vec![Default::default(); scene.meters.len()],
        ..Exchange::default()
    })
}

/// Whether the scene takes away what leaves its domain.
pub(crate) fn removes_outside(scene: &Scene) -> bool {
    scene.outside == Outside::Remove
}

/// Begins anew in a scene with what another scene of the same insertions has reached: rates are this scene's.
pub(crate) fn begin_anew(scene: &Scene, exchange: &mut Exchange) {
    exchange.travel = scene.radii().fold(0.0, f64::max);
    for (feed, insertion) in exchange.feeds.iter_mut().zip(&scene.insertions) {
        (feed.rate, feed.rate_of_rate, feed.tried) = (insertion.rate().unwrap_or(0.0), 0.0, 0);
    }
}
