//! Particles near planes.

use super::order::Order;
use super::pairs::Laws;
use crate::number::Vector;
use crate::state::contacts::TOUCHING;
use crate::state::{Particles, Row, WallContacts};
use crate::step::lanes::{self, Kernel, Lane, vector};
use crate::step::pass::{CHUNK, Context};

/// A plane of the scene.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    /// Which boundary it is.
    pub boundary: u32,
    /// Its material.
    pub material: u32,
    /// A point on it at time 0 \[m\].
    pub point: [f64; 3],
    /// Unit normal towards the particles.
    pub normal: [f64; 3],
}

/// Makes the list of a plane and a law anew: `point` is on the plane where it stands now, `mark` has room for a
/// number of each particle.
pub(super) fn replace(
    list: &mut WallContacts,
    (plane, point): (&Plane, [f64; 3]),
    (particles, laws, skin): (&Particles, &Laws, f64),
    mark: &mut Vec<u32>,
    (order, context): (&Order, &Context),
) {
    let pieces = context.collect(particles.len().div_ceil(CHUNK), |piece| {
        let mut near = Vec::new();
        let position = &particles.position[..];
        let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(position.len()));
        let normal = plane.normal;
        lanes::run(context.width, Near { position, from, to, point, normal, skin, near: &mut near });
        near.retain(|&slot| {
            laws.between(particles.material[slot as usize], plane.material) == Some(list.law)
                && particles.owner[slot as usize] != plane.boundary + 1
        });
        near
    });
    let old = std::mem::take(list);
    list.boundary = old.boundary;
    list.law = old.law;
    list.particle = pieces.concat();
    list.flags = vec![0; list.particle.len()];
    list.spring = vec![[0.0; 4]; list.particle.len()];
    carry(&old, list, mark, order);
}

/// Brings flags and springs from the old list.
fn carry(old: &WallContacts, new: &mut WallContacts, mark: &mut Vec<u32>, order: &Order) {
    mark.resize(order.slots.len(), 0);
    for (place, &slot) in new.particle.iter().enumerate() {
        mark[slot as usize] = place as u32;
    }
    for (entry, &slot) in old.particle.iter().enumerate().filter(|&(entry, _)| old.flags[entry] & TOUCHING != 0) {
        let slot = order.new_slot[slot as usize];
        // A mark may be another list's: it holds only if the list agrees.
        let place = mark[slot as usize] as usize;
        if new.particle.get(place) == Some(&slot) {
            new.flags[place] = old.flags[entry];
            if let Some(spring) = old.spring.get(entry) {
                new.spring[place] = *spring;
            }
        }
    }
}

/// The search in one piece.
struct Near<'a, 'b> {
    /// Positions and radii.
    position: &'a [Row],
    /// First particle.
    from: usize,
    /// Behind the last one.
    to: usize,
    /// A point on the plane \[m\].
    point: [f64; 3],
    /// Its normal.
    normal: [f64; 3],
    /// How far beyond touch \[m\].
    skin: f64,
    /// Where the particles go.
    near: &'b mut Vec<u32>,
}

impl Kernel for Near<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { position, from, to, point, normal, skin, near } = self;
        let splat = Vector::new(N::splat(point[0]), N::splat(point[1]), N::splat(point[2]));
        let normal = Vector::new(N::splat(normal[0]), N::splat(normal[1]), N::splat(normal[2]));
        let skin = N::splat(skin);
        let mut slot = from;
        while slot < to {
            let mut index = [0_u32; 8];
            let mut lane = 0;
            while lane < N::WIDTH {
                index[lane] = if slot + lane < to { (slot + lane) as u32 } else { slot as u32 };
                lane += 1;
            }
            // SAFETY: these are slots of particles.
            let rows = unsafe { N::load_rows(position.as_ptr(), index.as_ptr()) };
            let distance = (vector(rows) - splat).dot(normal);
            let apart = N::bits(distance.greater(rows[3] + skin));
            let mut lane = 0;
            while lane < N::WIDTH && slot + lane < to {
                if (apart >> lane) & 1 == 0 {
                    near.push((slot + lane) as u32);
                }
                lane += 1;
            }
            slot += N::WIDTH;
        }
    }
}
