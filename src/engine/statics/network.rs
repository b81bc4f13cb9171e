//! Which bodies there are, which act on each other, and which may be displaced at once.

use crate::base::quantity::BoundaryIndex;
use crate::engine::simulation::{Displacement, Probe, ProbeBody};
use crate::engine::state::State;

/// Instead of a place: a particle that does not move by the forces on it, or that nothing holds.
const NONE: u32 = u32::MAX;

/// The bodies that are free to move.
pub(super) struct Network {
    /// Particles, and groups and clumps that forces move.
    pub(super) bodies: Vec<ProbeBody>,
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
    /// Freedoms of each that stay: of groups those that forces do not move; along the axes that of one body of each part that holds
    /// itself across the faces of a cell, and may stand anywhere.
    pub(super) pinned: Vec<[bool; 6]>,
    /// Particles that nothing holds: numbers in the scene's order.
    pub(super) rattlers: Vec<u32>,
    /// Number of each of the bodies in the scene's order, of groups and clumps that of their first particle.
    pub(super) ids: Vec<u32>,
    /// The largest number among those by whose difference forces come about \[m\].
    pub(super) reach: f64,
}

/// A particle and by how many edges of the cell it is displaced.
type Place = (usize, [i64; 3]);

impl Network {
    /// That of a simulation.
    pub(super) fn of(probe: &Probe) -> Self {
        let (state, neighbours) = (probe.rest(), probe.neighbours());
        let particles = &state.particles;
        let places = places(state);
        let mut touches = vec![0_u32; particles.len()];
        for slot in neighbours.iter().flat_map(|(first, second)| [Some(*first), *second]).flatten() {
            touches[places[slot as usize].0] += 1;
        }
        let links: Vec<(Place, Option<Place>)> = neighbours
            .iter()
            .map(|(first, second)| (places[*first as usize], second.map(|second| places[second as usize])))
            .collect();
        // A group or clump that forces move stands in the place of its first particle.
        let mut stands_for: Vec<usize> = (0..particles.len()).collect();
        let mut group_at = vec![None; particles.len()];
        for (index, body) in probe.bodies().iter().enumerate() {
            let Some(body) = body.as_ref().filter(|body| body.is_free() && !body.is_surface()) else { continue };
            let slots = || body.members.iter().map(|&member| particles.slot[member as usize] as usize);
            let first = slots().next().unwrap_or_default();
            slots().for_each(|slot| stands_for[slot] = first);
            group_at[first] = Some((BoundaryIndex(index as u32), body));
        }
        let mut clump_at = vec![None; particles.len()];
        for clump in 0..state.clumps.len() {
            let slots = state.clumps.spheres_of(clump).iter().map(|&sphere| particles.slot[sphere as usize] as usize);
            let first = slots.clone().next().unwrap_or_default();
            slots.skip(1).for_each(|slot| {
                stands_for[slot] = first;
                touches[first] += touches[slot];
            });
            clump_at[first] = Some(clump);
        }
        let of_body = |(slot, shift): Place| (stands_for[slot], shift);
        let links: Vec<(Place, Option<Place>)> =
            links.into_iter().map(|(first, second)| (of_body(first), second.map(of_body))).collect();
        let is_loose = |slot: usize| particles.owner[slot] == 0 || clump_at[slot].is_some();
        let moves = |slot: usize| is_loose(slot) || group_at[slot].is_some();
        let stays = |slot: usize| {
            group_at[slot].is_some_and(|(_, body)| body.freedoms() != [true; 6] || body.springs() != [0.0; 6])
        };
        let Held { held, floating } = held((0..particles.len()).map(stays).collect(), &moves, &links);
        let slots: Vec<usize> =
            (0..particles.len()).filter(|&slot| moves(slot) && (held[slot] || group_at[slot].is_some())).collect();
        let mut rattlers: Vec<u32> =
            (0..particles.len()).filter(|&slot| is_loose(slot) && !held[slot]).map(|slot| particles.id[slot]).collect();
        rattlers.sort_unstable();
        let mut place = vec![NONE; particles.len()];
        for (body, &slot) in slots.iter().enumerate() {
            place[slot] = body as u32;
        }
        let spins = group_at.iter().flatten().any(|(_, body)| body.spins()) || !state.clumps.is_empty();
        let (mut bodies, mut radii, mut pinned) = (Vec::new(), Vec::new(), Vec::new());
        for &slot in &slots {
            let radius = particles.position[slot][3];
            match group_at[slot] {
                Some((boundary, body)) => {
                    bodies.push(ProbeBody::Boundary(boundary));
                    radii.push(radius.max(body.farthest));
                    pinned.push(body.freedoms().map(|is_free| !is_free));
                }
                None => {
                    let (shifts, clump) = (!floating.contains(&slot), clump_at[slot]);
                    let turns = clump.is_some() || probe.turns();
                    bodies.push(clump.map_or(ProbeBody::Particle(slot as u32), |it| ProbeBody::Clump(it as u32)));
                    radii.push(clump.map_or(radius, |it| radius.max(state.clumps.position[it][3])));
                    pinned.push([!shifts, !shifts, !shifts, !turns, !turns, !turns]);
                }
            }
        }
        let mut near: Vec<Vec<u32>> = (0..slots.len() as u32).map(|body| vec![body]).collect();
        for ((first, _), second) in &links {
            let (one, other) = (place[*first], second.map_or(NONE, |(second, _)| place[second]));
            if one != NONE && other != NONE {
                near[one as usize].push(other);
                near[other as usize].push(one);
            }
        }
        for list in &mut near {
            list.sort_unstable();
            list.dedup();
        }
        // Places of particles are compared with each other, which costs no digits, or with those of surfaces and faces.
        let alone = state.cell.is_none()
            && group_at.iter().all(Option::is_none)
            && state.clumps.is_empty()
            && links.iter().all(|(_, second)| second.is_some());
        let reach = match alone {
            true => 4.0 * radii.iter().copied().fold(0.0, f64::max),
            false => particles.position.iter().flat_map(|row| &row[..3]).fold(0.0, |most: f64, x| most.max(x.abs())),
        };
        Self {
            bodies,
            radii,
            each: if probe.turns() || spins { 6 } else { 3 },
            sets: apart(&near),
            touches: slots.iter().map(|&slot| if group_at[slot].is_some() { NONE } else { touches[slot] }).collect(),
            ids: slots.iter().map(|&slot| particles.id[slot]).collect(),
            pinned,
            near,
            rattlers,
            reach,
        }
    }

    /// A freedom of a body, displaced by this much \[m\]; a rotation at the body's radius.
    pub(super) fn displacement(&self, body: u32, axis: usize, amount: f64) -> Displacement {
        let amount = if axis < 3 { amount } else { amount / self.radii[body as usize] };
        Displacement { body: self.bodies[body as usize], axis, amount }
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

/// Whose image each row is, and by how many edges it is displaced from it.
fn places(state: &State) -> Vec<Place> {
    let mut places: Vec<Place> = (0..state.particles.len()).map(|slot| (slot, [0; 3])).collect();
    if let Some(cell) = &state.cell {
        for ((&image, &original), &shift) in cell.images.iter().zip(&cell.originals).zip(&cell.displaced) {
            places[image as usize] = (original as usize, shift);
        }
    }
    places
}

/// What is held.
struct Held {
    /// Whether each row is.
    held: Vec<bool>,
    /// One body of each part that only a way through the cell holds.
    floating: Vec<usize>,
}

/// Which bodies are held: by links, one after the other, to something that is `grounded` or does not move by forces, or by a way through
/// the cell back to themselves.
fn held(mut grounded: Vec<bool>, moves: &dyn Fn(usize) -> bool, links: &[(Place, Option<Place>)]) -> Held {
    let count = grounded.len();
    let mut held = vec![false; count];
    let mut ways: Vec<Vec<Place>> = vec![Vec::new(); count];
    for &((first, away), second) in links {
        match second {
            Some((second, further)) if moves(first) && moves(second) => {
                let [there, back] = [1, -1].map(|sign| [0, 1, 2].map(|edge| sign * (further[edge] - away[edge])));
                ways[first].push((second, there));
                ways[second].push((first, back));
            }
            _ => {
                for (slot, _) in [Some((first, away)), second].into_iter().flatten() {
                    grounded[slot] = true;
                }
            }
        }
    }
    let (mut stands, mut floating) = (vec![None; count], Vec::new());
    for begin in (0..count).filter(|&slot| moves(slot)) {
        if stands[begin].is_some() {
            continue;
        }
        stands[begin] = Some([0_i64; 3]);
        let (mut part, mut next, mut winds, mut is_grounded) = (vec![begin], 0, false, false);
        while let Some(&slot) = part.get(next) {
            next += 1;
            is_grounded |= grounded[slot];
            let from = stands[slot].unwrap_or_default();
            for &(other, step) in &ways[slot] {
                let to = [0, 1, 2].map(|edge| from[edge] + step[edge]);
                match stands[other] {
                    None => {
                        stands[other] = Some(to);
                        part.push(other);
                    }
                    Some(place) => winds |= place != to,
                }
            }
        }
        part.iter().for_each(|&slot| held[slot] = is_grounded || winds);
        if winds && !is_grounded {
            floating.push(begin);
        }
    }
    Held { held, floating }
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
