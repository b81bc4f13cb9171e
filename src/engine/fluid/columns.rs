//! Particles in a fluid, numbers of one kind side by side, so that loops over them become vector instructions.

use super::half_kick::{Exchanged, Gained};
use super::particles::{Booking, WITH_GRADIENT, Work};
use super::stream::gain;
use super::sums::Given;
use super::{Here, Medium};
use crate::base::number::{Vector, add};
use crate::engine::state::fluid::Booked;
use crate::laws::region::Weights;
use std::ops::Range;

/// How many particles are worked on at once: their columns stay in the first-level cache.
const MOST: usize = 32;

/// A number of each particle.
type Numbers = [f64; MOST];

/// A vector of each particle, along each axis.
type Vectors = [Numbers; 3];

/// The vector of one particle.
#[inline(always)]
pub(super) fn vector([x, y, z]: &Vectors, place: usize) -> Vector {
    Vector::new(x[place], y[place], z[place])
}

/// The sum of so many numbers: of eight sums of each eighth, whatever the width of registers.
#[inline(always)]
fn total(numbers: &Numbers, count: usize) -> f64 {
    let mut sums = [0.0; 8];
    for (first, eight) in numbers.as_chunks::<8>().0.iter().enumerate() {
        for (lane, (sum, number)) in sums.iter_mut().zip(eight).enumerate() {
            *sum += if 8 * first + lane < count { *number } else { 0.0 };
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// Writes the vector of one particle.
#[inline(always)]
pub(super) fn put([x, y, z]: &mut Vectors, place: usize, vector: Vector) {
    (x[place], y[place], z[place]) = (vector.x, vector.y, vector.z);
}

/// Some particles in the fluid.
pub(super) struct Columns {
    /// How many.
    pub(super) count: usize,
    /// Their slots.
    pub(super) slots: [u32; MOST],
    /// The cells around each.
    pub(super) weights: [Weights; MOST],
    /// Diameter \[m\].
    pub(super) diameter: Numbers,
    /// Mass, the added one among it \[kg\].
    pub(super) mass: Numbers,
    /// Length of the half kick \[s\]; 0 of one that is held.
    pub(super) half: Numbers,
    /// Velocity \[m/s\].
    pub(super) velocity: Vectors,
    /// Force of everything but the fluid \[N\].
    pub(super) other: Vectors,
    /// Velocity of the fluid \[m/s\].
    pub(super) flow: Vectors,
    /// Porosity.
    pub(super) porosity: Numbers,
    /// Force of the pressure gradient on each volume \[N/m³\].
    pub(super) push: Vectors,
    /// Reynolds number, and then the factor of the drag law.
    factor: Numbers,
    /// Force of the fluid \[N\].
    pub(super) force: Vectors,
    /// Drag over the velocity \[kg/s\].
    pub(super) drag: Numbers,
    /// What cells are given, row by row.
    given: [Vectors; WITH_GRADIENT],
    /// What stands behind the first of these rows.
    resistance: Numbers,
    /// Work, what drag takes and work on what is free, of the half kick that ends the step and of that which comes \[J\].
    booked: [[Numbers; 3]; 2],
    /// Impulse on what is free, in each of them \[N s\].
    moved: Vectors,
    /// Added mass \[kg\].
    pub(super) added: Numbers,
    /// Mass over that with the added one; 1 of what is held.
    pub(super) share: Numbers,
    /// What acts beside drag and the force of the pressure \[N\].
    pub(super) beside: Vectors,
    /// Vorticity of the fluid \[1/s\].
    pub(super) vorticity: Vectors,
}

/// What a motion gains in the half kick that comes, if it gains this in the one before, with the same load.
#[inline(always)]
fn again(gained: Gained) -> Gained {
    Gained { before: gained.now, ..gained }
}

impl Columns {
    /// Empty ones.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let (numbers, vectors) = ([0.0; MOST], [[0.0; MOST]; 3]);
        Self {
            count: 0,
            slots: [0; MOST],
            weights: [[(0, 0.0); 8]; MOST],
            diameter: numbers,
            mass: numbers,
            half: numbers,
            velocity: vectors,
            other: vectors,
            flow: vectors,
            porosity: numbers,
            push: vectors,
            factor: numbers,
            force: vectors,
            drag: numbers,
            given: [vectors; WITH_GRADIENT],
            resistance: numbers,
            booked: [vectors; 2],
            moved: vectors,
            added: numbers,
            share: numbers,
            beside: vectors,
            vorticity: vectors,
        }
    }

    /// Fills them with the first of these particles that are in the fluid, as many as have room. Returns the first that is left.
    #[inline(always)]
    pub(super) fn gather(&mut self, work: &Work, some: Range<usize>) -> usize {
        let (mut count, mut slot) = (0, some.start);
        while slot < some.end && count < MOST {
            // SAFETY: parts do not overlap, and each is worked on by one thread.
            let body = unsafe { work.rows.body(slot) };
            slot += 1;
            if body.owner > work.boundaries {
                continue;
            }
            let Some((here, weights)) = work.stream.at(Vector::from(*body.position)) else { continue };
            let mass = body.velocity[3];
            let other = Vector::from(work.fields.loads(mass, work.ids[body.slot])) + Vector::from(*body.force);
            self.slots[count] = body.slot as u32;
            self.weights[count] = weights;
            self.diameter[count] = 2.0 * body.position[3];
            self.mass[count] = mass;
            self.half[count] = if body.owner == 0 { 0.5 * work.step } else { 0.0 };
            self.porosity[count] = here.porosity;
            put(&mut self.velocity, count, Vector::from(*body.velocity));
            put(&mut self.other, count, other);
            put(&mut self.flow, count, here.velocity);
            put(&mut self.push, count, here.push);
            count += 1;
        }
        self.count = count;
        slot
    }

    /// How the fluid flows at one of them.
    #[inline(always)]
    pub(super) fn here<'a>(&self, medium: &'a Medium, place: usize) -> Here<'a> {
        let (velocity, push) = (vector(&self.flow, place), vector(&self.push, place));
        Here { medium, velocity, porosity: self.porosity[place], push }
    }

    /// Finds drag and force of the fluid: with the factor at the velocity half a step later, as [`Here::on`] does.
    #[inline(always)]
    pub(super) fn find_drag(&mut self, work: &Work) {
        let (medium, count) = (work.medium, self.count.min(MOST));
        for place in 0..count {
            let slip = vector(&self.flow, place) - vector(&self.velocity, place);
            self.factor[place] = medium.reynolds(self.diameter[place], self.porosity[place], slip);
        }
        medium.law.factors(&self.porosity[..count], &mut self.factor[..count], work.width);
        for place in 0..count {
            let (diameter, porosity) = (self.diameter[place], self.porosity[place]);
            let here = self.here(medium, place);
            let slip = here.velocity - vector(&self.velocity, place);
            let drag = medium.drag(diameter, porosity, self.factor[place]);
            let other = vector(&self.other, place) + here.push(diameter);
            let gained = gain(slip, drag, (self.mass[place], other), self.half[place]);
            self.factor[place] = medium.reynolds(diameter, porosity, slip - gained);
        }
        medium.law.factors(&self.porosity[..count], &mut self.factor[..count], work.width);
        for place in 0..count {
            let (diameter, here) = (self.diameter[place], self.here(medium, place));
            let slip = here.velocity - vector(&self.velocity, place);
            let drag = medium.drag(diameter, here.porosity, self.factor[place]);
            put(&mut self.force, place, slip * drag + here.push(diameter));
            self.drag[place] = drag;
        }
    }

    /// Finds what the half kicks around the end of the step exchange, where more than drag and the force of the pressure acts or not.
    #[inline(always)]
    pub(super) fn find_books<const BESIDE: bool>(&mut self, work: &Work) {
        let volume = work.medium.grid.map_or(1.0, |grid| grid.cell_volume());
        let [now, coming] = work.kicks();
        for place in 0..self.count.min(MOST) {
            let (here, diameter) = (self.here(work.medium, place), self.diameter[place]);
            let (velocity, mass) = (vector(&self.velocity, place), self.mass[place]);
            let load = (vector(&self.other, place) + vector(&self.force, place)).row_with(self.drag[place]);
            let motion = velocity.row_with(mass);
            let (is_free, gained) = (self.half[place] > 0.0, now.gained(&motion, &load));
            let gained = Gained { is_free, now: Vector::select(is_free, gained.now, Vector::zero()), ..gained };
            let later = (velocity + gained.now).row_with(mass);
            let (kicks, motions) = ([now, coming], [motion, later]);
            let mut now = now.shift((&here, diameter), &motion, &load, gained);
            let mut coming = coming.shift((&here, diameter), &later, &load, again(gained));
            if BESIDE {
                let beside = self.beside_of(place);
                now = kicks[0].beside(now, &motions[0], gained, &beside);
                coming = kicks[1].beside(coming, &motions[1], gained, &beside);
            }
            let [drag, pushed, way] = now.on_fluid(volume);
            let [.., next] = coming.on_fluid(volume);
            self.resistance[place] = drag[3];
            // One by one: a loop over rows would be one of calls.
            put(&mut self.given[0], place, drag.into());
            put(&mut self.given[1], place, pushed.into());
            put(&mut self.given[2], place, way.into());
            put(&mut self.given[3], place, next.into());
            let [(now, moved), (coming, _)] = [now, coming].map(Exchanged::columns);
            put(&mut self.booked[0], place, now);
            put(&mut self.booked[1], place, coming);
            put(&mut self.moved, place, moved);
        }
    }

    /// Gives cells what they exchange, and adds up what is booked.
    #[inline(always)]
    pub(super) fn hand_out<const ROWS: usize>(&self, given: &mut Given, found: &mut Booking) {
        for place in 0..self.count.min(MOST) {
            let mut rows = [[0.0; 4]; ROWS];
            for (row, columns) in rows.iter_mut().zip(&self.given) {
                *row = vector(columns, place).row_with(0.0);
            }
            if let Some(first) = rows.first_mut() {
                first[3] = self.resistance[place];
            }
            given.share::<ROWS>(&self.weights[place], rows);
        }
        if ROWS == 0 {
            let [x, y, z] = self.given[0].each_ref().map(|column| total(column, self.count));
            add(&mut found.drag, &[x, y, z, total(&self.resistance, self.count)]);
        }
        let moved = self.moved.each_ref().map(|column| total(column, self.count));
        let [now, coming] = self.booked.each_ref().map(|columns| {
            let [work, taken, on_free] = columns.each_ref().map(|column| total(column, self.count));
            Booked { work, taken, on_free, moved }
        });
        (found.now, found.coming) = (found.now.plus(now), found.coming.plus(coming));
    }

    /// Adds the force of the fluid to the loads, and the torque where it brakes rotation.
    #[inline(always)]
    pub(super) fn write(&self, work: &Work, found: &mut Booking) {
        for place in 0..self.count.min(MOST) {
            // SAFETY: parts do not overlap, and each is worked on by one thread.
            let body = unsafe { work.rows.body(self.slots[place] as usize) };
            *body.force = (Vector::from(*body.force) + vector(&self.force, place)).row_with(self.drag[place]);
        }
        if work.medium.torque {
            self.brake(work, found);
        }
    }

    /// Adds the torque of the fluid to the loads, and books it.
    fn brake(&self, work: &Work, found: &mut Booking) {
        let [now, coming] = work.kicks();
        for place in 0..self.count {
            // SAFETY: parts do not overlap, and each is worked on by one thread.
            let body = unsafe { work.rows.body(self.slots[place] as usize) };
            let (spin, turning) = (Vector::from(*body.spin), work.medium.turning(self.diameter[place]));
            *body.torque = (Vector::from(*body.torque) + spin * -turning).row_with(turning);
            if work.books {
                let gained = if body.owner == 0 { now.gained(body.spin, body.torque) } else { Gained::default() };
                let later = (spin + gained.now).row_with(body.spin[3]);
                found.now = found.now.plus(now.turn(body.spin, body.torque, gained).booked());
                found.coming = found.coming.plus(coming.turn(&later, body.torque, again(gained)).booked());
            }
        }
    }
}
