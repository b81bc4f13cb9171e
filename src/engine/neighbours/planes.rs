//! Particles near planes.

use super::order::{BEYOND, Order};
use super::pairs::Laws;
use crate::base::lanes::{self, Kernel, Lane};
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Columns, History, IMAGE, Particles, WallContacts};

/// A plane of the scene.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    /// Which boundary it is.
    pub boundary: u32,
    /// Its material.
    pub material: u32,
    /// A point on it at time 0 \[m\].
    pub point: [f64; 3],
    /// Unit normal towards the particles.
    pub normal: [f64; 3],
}

/// What is near: particles no further than the skin in front of a plane, or behind it.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a> {
    /// Where the particles are.
    pub columns: &'a Columns,
    /// A point on the plane where it stands now \[m\].
    pub point: [f64; 3],
    /// Its normal.
    pub normal: [f64; 3],
    /// How far beyond touch \[m\].
    pub skin: f64,
}

/// Makes the list of a plane and a law that remembers so many rows anew: `mark` has room for a number of each particle.
pub(crate) fn replace(
    list: &mut WallContacts,
    plane: &Plane,
    (side, history): (Side, usize),
    (particles, laws): (&Particles, &Laws),
    mark: &mut Vec<u32>,
    (order, context): (&Order, &Context),
) {
    let pieces = context.collect(particles.len().div_ceil(CHUNK), |piece| {
        let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(particles.len()));
        let mut near = [0; CHUNK + BEYOND];
        let mut count = 0;
        lanes::run(context.width, Near { side, from, to, near: &mut near, count: &mut count });
        let mut near = near[..count].to_vec();
        near.retain(|&slot| {
            laws.between(particles.material[slot as usize], plane.material) == Some(list.law)
                && ![plane.boundary + 1, IMAGE].contains(&particles.owner[slot as usize])
        });
        near
    });
    let old = std::mem::take(list);
    list.boundary = old.boundary;
    list.law = old.law;
    list.particle = pieces.concat();
    list.flags = vec![0; list.particle.len()];
    list.history = History::of(history, list.particle.len());
    carry(&old, list, mark, order);
}

/// Brings flags and history from the old list.
fn carry(old: &WallContacts, new: &mut WallContacts, mark: &mut Vec<u32>, order: &Order) {
    mark.resize(order.slots.len(), 0);
    for (place, &slot) in new.particle.iter().enumerate() {
        mark[slot as usize] = place as u32;
    }
    for (entry, &slot) in old.particle.iter().enumerate().filter(|&(entry, _)| old.flags[entry] != 0) {
        let slot = order.new_slot[slot as usize];
        // A mark may be another list's: it holds only if the list agrees.
        let place = mark[slot as usize] as usize;
        if new.particle.get(place) == Some(&slot) {
            new.flags[place] = old.flags[entry];
            for (new, old) in new.history.get_mut(place).iter_mut().zip(old.history.get(entry)) {
                *new = *old;
            }
        }
    }
}

/// The search in one piece.
struct Near<'a, 'b> {
    /// What is near.
    side: Side<'a>,
    /// First particle.
    from: usize,
    /// Behind the last one.
    to: usize,
    /// Where the particles go.
    near: &'b mut [u32; CHUNK + BEYOND],
    /// How many there are.
    count: &'b mut usize,
}

impl Kernel for Near<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { side: Side { columns, point, normal, skin }, from, to, near, count } = self;
        let splat = |[x, y, z]: [f64; 3]| Vector::new(N::splat(x), N::splat(y), N::splat(z));
        let (point, normal, skin) = (splat(point), splat(normal), N::splat(skin));
        let Columns { x, y, z, radius } = columns;
        let mut slot = from;
        while slot < to {
            // SAFETY: columns reach a register beyond the last particle; no more are found than are looked at, and
            // there is room for a register more.
            unsafe {
                let load = |column: &Vec<f64>| N::load(column.as_ptr().add(slot));
                let distance = (Vector::new(load(x), load(y), load(z)) - point).dot(normal);
                let apart = N::bits(distance.greater(load(radius) + skin));
                let inside = if to - slot < N::WIDTH { (1 << (to - slot)) - 1 } else { (1 << N::WIDTH) - 1 };
                *count += N::compress(!apart & inside, slot as u32, near.as_mut_ptr().add(*count));
            }
            slot += N::WIDTH;
        }
    }
}
