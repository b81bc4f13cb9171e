//! Which bodies there are, which act on each other, and which may be displaced at once.

use crate::engine::simulation::{Displacement, Probe, ProbeBody};

/// Instead of a place: a particle that does not move by the forces on it, or that nothing holds.
const NONE: u32 = u32::MAX;

/// The bodies that are free to move.
pub(super) struct Network {
    /// Slots of the particles that are solved for.
    pub(super) slots: Vec<u32>,
    /// Their radii, which scale rotations \[m\].
    pub(super) radii: Vec<f64>,
    /// How many freedoms each has: 3, or 6 where anything turns them.
    pub(super) each: usize,
    /// For each of them: itself and those that it acts on, ascending.
    pub(super) near: Vec<Vec<u32>>,
    /// How many things each of them touches, or is bonded to.
    pub(super) touches: Vec<u32>,
    /// Sets of bodies of which no two act on a common one.
    pub(super) sets: Vec<Vec<u32>>,
    /// Particles that nothing holds: numbers in the scene's order.
    pub(super) rattlers: Vec<u32>,
    /// Number of each of the bodies in the scene's order.
    pub(super) ids: Vec<u32>,
}

impl Network {
    /// That of a simulation.
    pub(super) fn of(probe: &Probe) -> Self {
        let (particles, neighbours) = (&probe.rest().particles, probe.neighbours());
        let mut touches = vec![0_u32; particles.len()];
        for &(first, second) in &neighbours {
            touches[first as usize] += 1;
            if let Some(second) = second {
                touches[second as usize] += 1;
            }
        }
        let free = || (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
        let slots: Vec<u32> = free().filter(|&slot| touches[slot] > 0).map(|slot| slot as u32).collect();
        let mut rattlers: Vec<u32> = free().filter(|&slot| touches[slot] == 0).map(|slot| particles.id[slot]).collect();
        rattlers.sort_unstable();
        let mut place = vec![NONE; particles.len()];
        for (body, &slot) in slots.iter().enumerate() {
            place[slot as usize] = body as u32;
        }
        let mut near: Vec<Vec<u32>> = (0..slots.len() as u32).map(|body| vec![body]).collect();
        for (first, second) in neighbours {
            let (one, other) = (place[first as usize], second.map_or(NONE, |second| place[second as usize]));
            if one != NONE && other != NONE {
                near[one as usize].push(other);
                near[other as usize].push(one);
            }
        }
        for list in &mut near {
            list.sort_unstable();
            list.dedup();
        }
        Self {
            radii: slots.iter().map(|&slot| particles.position[slot as usize][3]).collect(),
            each: if probe.turns() { 6 } else { 3 },
            sets: apart(&near),
            touches: slots.iter().map(|&slot| touches[slot as usize]).collect(),
            ids: slots.iter().map(|&slot| particles.id[slot as usize]).collect(),
            slots,
            near,
            rattlers,
        }
    }

    /// A freedom of a body, displaced by this much \[m\]; a rotation at the body's radius.
    pub(super) fn displacement(&self, body: u32, axis: usize, amount: f64) -> Displacement {
        let amount = if axis < 3 { amount } else { amount / self.radii[body as usize] };
        Displacement { body: ProbeBody::Particle(self.slots[body as usize]), axis, amount }
    }

    /// All freedoms, displaced by these shares of an amount \[m\].
    pub(super) fn displacements<'a>(
        &'a self,
        shares: &'a [f64],
        amount: f64,
    ) -> impl Iterator<Item = Displacement> + 'a {
        let freedoms = shares.iter().enumerate();
        freedoms.map(move |(freedom, share)| {
            self.displacement((freedom / self.each) as u32, freedom % self.each, share * amount)
        })
    }
}

/// Sets of bodies of which no two act on a common one, found one after the other.
fn apart(near: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let (mut set_of, mut sets) = (vec![NONE; near.len()], Vec::<Vec<u32>>::new());
    let mut taken: Vec<u32> = Vec::new();
    for (body, list) in near.iter().enumerate() {
        for other in list.iter().flat_map(|&other| &near[other as usize]) {
            if let Some(mark) = taken.get_mut(set_of[*other as usize] as usize) {
                *mark = body as u32;
            }
        }
        let set = taken.iter().position(|&mark| mark != body as u32).unwrap_or(taken.len());
        if set == taken.len() {
            taken.push(NONE);
            sets.push(Vec::new());
        }
        set_of[body] = set as u32;
        sets[set].push(body as u32);
    }
    sets
}
