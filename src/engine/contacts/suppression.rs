//! Which contacts bonds suppress: flags and offsets of the lists of near contacts follow the bonds that are made and that
//! break.

use super::records::PlacedSpring;
use crate::base::number::Vector;
use crate::engine::neighbours::bonds::is_bonded;
use crate::engine::state::contacts::{
    BONDED, FRESH, LASTING, RELEASED, SILENT, SLIDING, TOUCHING, is_resting, is_suppressed,
};
use crate::engine::state::{Row, State};
use crate::laws::bond::creation::ContactPolicy;
use crate::scene::{Bond, GoverningLaws, Scene};

/// What the scene says of suppressed contacts.
pub(crate) struct Suppression {
    /// Of each bond law: the flags of the contacts that it suppresses, if it suppresses any.
    laws: Vec<Option<u8>>,
    /// Plane of each bond law.
    planes: Vec<Option<u32>>,
    /// Which contact law governs two materials.
    governing: GoverningLaws,
    /// Of each boundary that is a plane: material, point at time 0, normal.
    surfaces: Vec<Option<(u32, Vector, Vector)>>,
    /// Of each contact law: which row of a contact has what it holds of losses that warm the bodies, if it holds any.
    held: Vec<Option<usize>>,
    /// Whether a bond that suppresses was made in the present time step.
    fresh: bool,
}

/// Where a contact stands in the lists: at a plane or not, which list, which entry.
#[derive(Clone, Copy)]
struct Place {
    /// Whether it is one at a plane.
    at_plane: bool,
    /// Which list.
    list: usize,
    /// Which entry.
    entry: usize,
}

impl Place {
    /// The flags of the contact.
    fn flags<'a>(&self, state: &'a mut State) -> &'a mut u8 {
        match self.at_plane {
            true => &mut state.walls[self.list].flags[self.entry],
            false => &mut state.contacts[self.list].flags[self.entry],
        }
    }

    /// What is kept of the contact.
    fn kept<'a>(&self, state: &'a mut State) -> &'a mut [Row] {
        match self.at_plane {
            true => state.walls[self.list].history.get_mut(self.entry),
            false => state.contacts[self.list].history.get_mut(self.entry),
        }
    }

    /// The row with the offset.
    fn offset<'a>(&self, state: &'a mut State) -> Option<&'a mut Row> {
        self.kept(state).last_mut()
    }
}

/// The flags of the contacts that a bond law suppresses; none where contact and bond act side by side.
fn flags_of(bond: &Bond) -> Option<u8> {
    let lasting = if bond.keys.formulation.is_engine() { LASTING } else { 0 };
    match bond.keys.contact {
        ContactPolicy::Parallel => None,
        ContactPolicy::WithoutNormal => Some(lasting),
        ContactPolicy::None => Some(lasting | SILENT),
    }
}

impl Suppression {
    /// Reads what concerns suppressed contacts from the scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let surfaces = scene.boundaries.iter().map(|boundary| {
            boundary.shifting_plane().map(|plane| (plane.material.0, plane.point.into(), plane.normal.into()))
        });
        Self {
            laws: scene.bonds.iter().map(flags_of).collect(),
            planes: scene.bonds.iter().map(|bond| bond.plane.map(|plane| plane.0)).collect(),
            governing: scene.governing_laws(),
            surfaces: surfaces.collect(),
            held: (0..scene.contacts.len()).map(|law| scene.law(law).history_places().held).collect(),
            fresh: false,
        }
    }

    /// Whether any bond suppresses contacts.
    pub(crate) fn any(&self) -> bool {
        self.laws.iter().any(Option::is_some)
    }

    /// Notes how many bonds each law has.
    pub(crate) fn count_bonds(&self, state: &State, counts: &mut Vec<usize>) {
        counts.clear();
        if self.any() {
            counts.extend(state.bonds.iter().map(|list| list.first.len()));
        }
    }

    /// Where the contact of two particles, or of one with the plane of a bond law, stands, if it is listed.
    fn place(&self, state: &State, law: usize, first: u32, second: Option<u32>) -> Option<Place> {
        let material = |slot: u32| state.particles.material[slot as usize];
        let Some(second) = second else {
            let boundary = self.planes[law]?;
            let (other, ..) = self.surfaces[boundary as usize]?;
            let governing = self.governing.between(material(first), other)?;
            let list = state.walls.iter().position(|list| (list.boundary, list.law) == (boundary, governing))?;
            let entry = state.walls[list].particle.binary_search(&first).ok()?;
            return Some(Place { at_plane: true, list, entry });
        };
        let list = self.governing.between(material(first), material(second))? as usize;
        let (one, other) = (first.min(second), first.max(second));
        let pairs = &state.contacts[list];
        let before = pairs.first.partition_point(|&slot| slot < one);
        let here = pairs.first[before..].partition_point(|&slot| slot == one);
        let found = pairs.second[before..before + here].binary_search(&other).ok()?;
        Some(Place { at_plane: false, list, entry: before + found })
    }

    /// The contact that a listed bond suppresses, if its bodies are near.
    fn place_of_bond(&self, state: &State, law: usize, bond: usize) -> Option<Place> {
        let list = &state.bonds[law];
        self.place(state, law, list.first[bond], list.second.get(bond).copied())
    }

    /// Notes the contacts of the bonds that were made in this time step, from so many on in each law: they still act as they
    /// did before.
    pub(crate) fn made(&mut self, state: &mut State, before: &[usize]) {
        for (law, flags) in self.laws.iter().enumerate() {
            let Some(flags) = *flags else { continue };
            for bond in before[law]..state.bonds[law].first.len() {
                let Some(place) = self.place_of_bond(state, law, bond) else { continue };
                *place.flags(state) |= flags | FRESH;
                self.fresh = true;
            }
        }
    }

    /// Flags the contacts of all living bonds in newly made lists. Bonds and contacts stand in the same order.
    pub(crate) fn flag(&self, state: &mut State) {
        for (law, flags) in self.laws.iter().enumerate() {
            let Some(flags) = *flags else { continue };
            let mut rows = vec![0; state.contacts.len()];
            for bond in 0..state.bonds[law].first.len() {
                let place = match self.planes[law] {
                    Some(_) => self.place_of_bond(state, law, bond),
                    None => self.next_place(state, law, bond, &mut rows),
                };
                let Some(place) = place else { continue };
                let here = place.flags(state);
                *here |= flags;
                if *here & FRESH == 0 {
                    *here = (*here | BONDED) & !RELEASED;
                }
            }
        }
    }

    /// Where the contact of a bond between particles stands, if the row of its first particle is no earlier than that of the
    /// bond before: `rows` has the place in each list.
    fn next_place(&self, state: &State, law: usize, bond: usize, rows: &mut [usize]) -> Option<Place> {
        let (a, b) = (state.bonds[law].first[bond], state.bonds[law].second[bond]);
        let material = |slot: u32| state.particles.material[slot as usize];
        let list = self.governing.between(material(a), material(b))? as usize;
        let (one, other) = (a.min(b), a.max(b));
        let (pairs, row) = (&state.contacts[list], &mut rows[list]);
        while pairs.first.get(*row).is_some_and(|&first| first < one) {
            *row += 1;
        }
        let behind = pairs.first[*row..].iter().zip(&pairs.second[*row..]);
        let before = behind.take_while(|&(&first, &second)| first == one && second < other).count();
        let entry = *row + before;
        let found = pairs.first.get(entry) == Some(&one) && pairs.second.get(entry) == Some(&other);
        found.then_some(Place { at_plane: false, list, entry })
    }

    /// Lets the offsets of all suppressed contacts begin with the overlaps that there are.
    pub(crate) fn begin_offsets(&self, state: &mut State) {
        self.each_suppressed(state, |state, place, overlap| {
            if let (true, Some(row)) = (overlap > 0.0, place.offset(state)) {
                row[3] = overlap;
            }
        });
    }

    /// Lets the bonds that were made in this time step suppress, when forces have been evaluated.
    pub(crate) fn settle(&mut self, state: &mut State) {
        if !std::mem::take(&mut self.fresh) {
            return;
        }
        let State { contacts, walls, heat, .. } = state;
        let pairs = contacts.iter_mut().zip(&self.held);
        let pairs = pairs.map(|(list, held)| (&mut list.flags, &mut list.history, [&list.first, &list.second], held));
        let walls = walls.iter_mut().map(|list| {
            let (flags, history, particle) = (&mut list.flags, &mut list.history, &list.particle);
            (flags, history, [particle; 2], &self.held[list.law as usize])
        });
        for (flags, history, bodies, held) in pairs.chain(walls) {
            for (entry, flags) in flags.iter_mut().enumerate().filter(|(_, flags)| **flags & FRESH != 0) {
                *flags = (*flags | BONDED) & !(FRESH | RELEASED);
                if let (Some(held), Some(heat), true) = (*held, heat.as_mut(), is_suppressed(*flags)) {
                    let [along, about, ..] = std::mem::take(&mut history.get_mut(entry)[held]);
                    bodies.iter().for_each(|slots| heat.of_losses[slots[entry] as usize] += 0.5 * (along + about));
                }
                if is_resting(*flags) {
                    *flags &= !(TOUCHING | SLIDING);
                    history.get_mut(entry).fill([0.0; 4]);
                }
            }
        }
    }

    /// Does something with each contact that a living bond suppresses, and its overlap (0 where the bodies do not touch) \[m\].
    fn each_suppressed(&self, state: &mut State, mut work: impl FnMut(&mut State, Place, f64)) {
        for (law, _) in self.laws.iter().enumerate().filter(|(_, flags)| flags.is_some()) {
            for bond in 0..state.bonds[law].first.len() {
                let Some(place) = self.place_of_bond(state, law, bond) else { continue };
                let list = &state.bonds[law];
                let overlap = self.overlap(state, law, list.first[bond], list.second.get(bond).copied());
                work(state, place, overlap);
            }
        }
    }

    /// Overlap of two bodies, 0 where they do not touch \[m\].
    fn overlap(&self, state: &State, law: usize, first: u32, second: Option<u32>) -> f64 {
        let position = |slot: u32| state.particles.position[slot as usize];
        let first = position(first);
        let overlap = match second.map(position) {
            Some(second) => first[3] + second[3] - (Vector::from(first) - Vector::from(second)).length(),
            None => {
                let Some(boundary) = self.planes[law].map(|plane| plane as usize) else { return 0.0 };
                let Some((_, point, normal)) = self.surfaces[boundary] else { return 0.0 };
                let point = point + Vector::from(state.boundaries[boundary].displacement);
                first[3] - (Vector::from(first) - point).dot(normal)
            }
        };
        overlap.max(0.0)
    }

    /// Takes notice of the bonds that broke in the evaluation just made: those from this one on.
    pub(crate) fn broken(&self, state: &mut State, told: usize) {
        for number in told..state.breaks.len() {
            let broken = state.breaks[number];
            let law = broken.law as usize;
            if self.laws[law].is_none() {
                continue;
            }
            let slot = |index: u32| state.particles.slot[index as usize];
            let (first, second) = (slot(broken.first), broken.second.map(slot));
            let Some(place) = self.place(state, law, first, second) else { continue };
            match self.still(state, law, first, second) {
                Some(flags) => {
                    let here = place.flags(state);
                    *here = *here & !SILENT | flags;
                }
                None => {
                    let overlap = self.overlap(state, law, first, second);
                    release(state, place, overlap);
                }
            }
        }
    }

    /// The flags of the contact of these bodies by the bonds that they still have; none without one that suppresses.
    fn still(&self, state: &State, law: usize, first: u32, second: Option<u32>) -> Option<u8> {
        let has = |other: &usize| match second {
            Some(second) => self.planes[*other].is_none() && is_bonded(&state.bonds[*other], first, second),
            None => self.planes[*other] == self.planes[law] && state.bonds[*other].first.contains(&first),
        };
        let bonded = (0..self.laws.len()).filter(|other| self.laws[*other].is_some()).filter(has);
        bonded.filter_map(|other| self.laws[other]).reduce(|all, flags| all | flags)
    }

    /// Gives a contact that was put into place the offset that is remembered of it, where a bond law may have left it.
    pub(crate) fn put_offset(&self, scene: &Scene, state: &mut State, placed: &PlacedSpring) {
        let [a, b] = placed.bodies.map(|body| scene.particles[body as usize].set);
        let suppresses = |law: &usize| {
            let between = scene.bonds[*law].between;
            self.planes[*law].is_none() && self.laws[*law].is_some() && (between == [a, b] || between == [b, a])
        };
        let Some(law) = (0..self.laws.len()).find(suppresses) else { return };
        let [first, second] = placed.bodies.map(|body| state.particles.slot[body as usize]);
        let Some(place) = self.place(state, law, first, Some(second)) else { return };
        let flags = place.flags(state);
        *flags |= self.laws[law].unwrap_or(0) & LASTING;
        if *flags & BONDED == 0 && placed.offset > 0.0 {
            *flags |= RELEASED;
        }
        if let Some(row) = place.offset(state) {
            row[3] = placed.offset;
        }
    }
}

/// Lets a contact go whose last bond that suppressed it has broken, at this overlap \[m\].
fn release(state: &mut State, place: Place, overlap: f64) {
    if is_resting(*place.flags(state)) {
        place.kept(state).fill([0.0; 4]);
        if let Some(row) = place.offset(state) {
            row[3] = overlap;
        }
        let flags = place.flags(state);
        *flags = if overlap > 0.0 { *flags | TOUCHING } else { *flags & !TOUCHING } & !SLIDING;
    }
    let offset = place.offset(state).map_or(0.0, |row| row[3]);
    let flags = place.flags(state);
    *flags &= !(BONDED | SILENT | FRESH);
    if offset > 0.0 {
        *flags |= RELEASED;
    }
}
