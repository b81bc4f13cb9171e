//! Which contacts bonds hide: entered when a bond is made, told when it breaks, given back when nothing is hidden
//! any more.

use super::records::PlacedSpring;
use crate::bond::creation::{ContactPolicy, Moment};
use crate::contact::{HistoryRow, Law, MOST_HISTORY};
use crate::number::Vector;
use crate::scene::{Bond, Scene};
use crate::state::contacts::{SLIDING, TOUCHING};
use crate::state::hidden::{FRESH, Hidden, HiddenContact, LASTING, SILENT};
use crate::state::{Row, State};

/// What the scene says of hidden contacts.
pub(crate) struct Hiding {
    /// Of each bond law: the flags of the contacts that it hides, if it hides any.
    laws: Vec<Option<u8>>,
    /// Plane of each bond law.
    planes: Vec<Option<u32>>,
    /// The contact law of each two materials, row by row.
    law_of: Vec<Option<u32>>,
    /// Number of materials.
    materials: usize,
    /// What each contact law remembers of a contact.
    histories: Vec<Vec<HistoryRow>>,
    /// Of each boundary that is a plane: material, point at time 0, normal.
    surfaces: Vec<Option<(u32, Vector, Vector)>>,
}

/// Where a hidden contact stands: whether at a plane, which list, and its bodies.
#[derive(Clone, Copy)]
struct Place {
    /// Whether it is one at a plane.
    at_plane: bool,
    /// Which list.
    list: usize,
    /// The first body.
    first: u32,
    /// The second body, unless it is a plane.
    second: Option<u32>,
}

impl Place {
    /// The list.
    fn list_of<'a>(&self, hidden: &'a mut Hidden) -> &'a mut Vec<HiddenContact> {
        if self.at_plane { &mut hidden.planes[self.list] } else { &mut hidden.pairs[self.list] }
    }

    /// The entry, if there is one.
    fn entry<'a>(&self, hidden: &'a mut Hidden) -> Option<&'a mut HiddenContact> {
        let list = self.list_of(hidden);
        let place = Hidden::find(list, self.first, self.second).ok()?;
        list.get_mut(place)
    }

    /// The entry, made where there is none.
    fn enter<'a>(&self, hidden: &'a mut Hidden) -> &'a mut HiddenContact {
        let list = self.list_of(hidden);
        let place = Hidden::find(list, self.first, self.second).unwrap_or_else(|place| {
            list.insert(place, HiddenContact { first: self.first, second: self.second, ..HiddenContact::default() });
            place
        });
        &mut list[place]
    }
}

/// The flags of the contacts that a bond law hides; none where contact and bond act side by side.
fn flags_of(bond: &Bond) -> Option<u8> {
    let lasting = if bond.keys.formulation.is_engine() { LASTING } else { 0 };
    match bond.keys.contact {
        ContactPolicy::Parallel => None,
        ContactPolicy::WithoutNormal => Some(lasting),
        ContactPolicy::None => Some(lasting | SILENT),
    }
}

impl Hiding {
    /// Reads what concerns hidden contacts from the scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let materials = scene.materials.len();
        let law_of = (0..materials * materials)
            .map(|entry| scene.contacts.iter().position(|law| law.between[entry]).map(|law| law as u32));
        let surfaces = scene.boundaries.iter().map(|boundary| {
            boundary.shifting_plane().map(|plane| (plane.material.0, plane.point.into(), plane.normal.into()))
        });
        Self {
            laws: scene.bonds.iter().map(flags_of).collect(),
            planes: scene.bonds.iter().map(|bond| bond.plane.map(|plane| plane.0)).collect(),
            law_of: law_of.collect(),
            materials,
            histories: scene.contacts.iter().map(|law| Law::of(&law.choice()).history().to_vec()).collect(),
            surfaces: surfaces.collect(),
        }
    }

    /// Whether any bond hides contacts.
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

    /// Where the contact of the bodies of a bond stands; none where no contact law governs it.
    fn place(&self, state: &State, law: usize, first: u32, second: Option<u32>) -> Option<Place> {
        let material = |index: u32| state.particles.material[state.particles.slot[index as usize] as usize] as usize;
        let owner = |index: u32| state.particles.owner[state.particles.slot[index as usize] as usize];
        let contact = |other: usize| self.law_of[material(first) * self.materials + other];
        if let Some(second) = second {
            let list = contact(material(second))? as usize;
            let rigid = owner(first) != 0 && owner(first) == owner(second);
            let (first, second) = (first.min(second), Some(first.max(second)));
            return (!rigid).then_some(Place { at_plane: false, list, first, second });
        }
        let boundary = self.planes[law]?;
        let (other, ..) = self.surfaces[boundary as usize]?;
        let governing = contact(other as usize)?;
        let list = state.walls.iter().position(|list| (list.boundary, list.law) == (boundary, governing))?;
        Some(Place { at_plane: true, list, first, second: None })
    }

    /// Enters the contacts of the bonds that were made since each law had this many.
    pub(crate) fn made(&self, state: &mut State, before: &[usize], moment: &Moment) {
        if !self.any() {
            return;
        }
        state.hidden.pairs.resize(state.contacts.len(), Vec::new());
        state.hidden.planes.resize(state.walls.len(), Vec::new());
        for (law, flags) in self.laws.iter().enumerate() {
            let Some(flags) = *flags else { continue };
            for bond in before[law]..state.bonds[law].first.len() {
                let list = &state.bonds[law];
                let id = |slot: u32| state.particles.id[slot as usize];
                let (first, second) = (id(list.first[bond]), list.second.get(bond).copied().map(id));
                let Some(place) = self.place(state, law, first, second) else { continue };
                let overlap = self.overlap(state, law, &place);
                let entry = place.enter(&mut state.hidden);
                entry.flags = (entry.flags & (TOUCHING | SLIDING)) | flags;
                entry.bonds += 1;
                if moment.number == 0 {
                    entry.offset = overlap;
                } else {
                    entry.flags |= FRESH;
                }
            }
        }
        state.hidden.find_active();
        state.hidden.settling = moment.number > 0;
    }

    /// Enters the contacts of bonds that were put into place, and those of which an offset is remembered.
    pub(crate) fn placed(&self, scene: &Scene, state: &mut State, springs: &[PlacedSpring]) {
        let start = Moment { number: 0, from: 0.0, to: 0.0 };
        self.made(state, &vec![0; self.laws.len()], &start);
        if !self.any() {
            return;
        }
        for spring in springs {
            let [first, second] = spring.bodies;
            let [a, b] = spring.bodies.map(|body| scene.particles[body as usize].set);
            let hides = |law: &usize| {
                let between = scene.bonds[*law].between;
                self.planes[*law].is_none() && self.laws[*law].is_some() && (between == [a, b] || between == [b, a])
            };
            let Some(law) = (0..self.laws.len()).find(hides) else { continue };
            let Some(place) = self.place(state, law, first, Some(second)) else { continue };
            if spring.offset > 0.0 || place.entry(&mut state.hidden).is_some() {
                let entry = place.enter(&mut state.hidden);
                entry.offset = spring.offset;
                entry.flags |= self.laws[law].unwrap_or(0) & LASTING;
            }
        }
        state.hidden.find_active();
    }

    /// Overlap of the bodies of an entry, 0 where they do not touch \[m\].
    fn overlap(&self, state: &State, law: usize, place: &Place) -> f64 {
        let position = |index: u32| state.particles.position[state.particles.slot[index as usize] as usize];
        let first = position(place.first);
        let overlap = match place.second.map(position) {
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
        let mut changed = state.hidden.settling;
        for number in told..state.breaks.len() {
            let broken = state.breaks[number];
            let law = broken.law as usize;
            if self.laws[law].is_none() {
                continue;
            }
            let Some(place) = self.place(state, law, broken.first, broken.second) else { continue };
            let overlap = self.overlap(state, law, &place);
            let Some(entry) = place.entry(&mut state.hidden) else { continue };
            if entry.is_resting() && !place.at_plane {
                entry.offset = overlap;
                entry.history = [[0.0; 4]; MOST_HISTORY];
                entry.flags = if overlap > 0.0 { entry.flags | TOUCHING } else { entry.flags & !TOUCHING } & !SLIDING;
            }
            entry.bonds = entry.bonds.saturating_sub(1);
            if entry.bonds == 0 {
                entry.flags &= !SILENT;
            }
            changed = true;
        }
        if changed {
            state.hidden.find_active();
        }
    }

    /// Takes the hidden contacts out of newly made lists, and gives back those that are hidden no more. What was
    /// remembered of a contact goes with it.
    pub(crate) fn sort_out(&self, state: &mut State) {
        let State { hidden, contacts, walls, particles, .. } = state;
        for ((entries, list), rows) in hidden.pairs.iter_mut().zip(contacts).zip(&self.histories) {
            let mut dead = vec![false; list.first.len()];
            entries.retain_mut(|entry| {
                let slot = |index: u32| particles.slot[index as usize];
                let (one, other) = (slot(entry.first), slot(entry.second.unwrap_or(entry.first)));
                let key = (one.min(other), one.max(other));
                let exchange = Exchange { rows, reversed: one > other };
                let before = list.first.partition_point(|&first| first < key.0);
                let here = list.first[before..].partition_point(|&first| first == key.0);
                let found = list.second[before..before + here].binary_search(&key.1);
                let listed = found.ok().map(|found| before + found);
                let kept = exchange.exchange(entry, listed, &mut list.flags, &mut list.history);
                if let (Some(pair), true) = (listed, kept) {
                    dead[pair] = true;
                }
                kept
            });
            if !entries.is_empty() {
                list.remove(&dead);
            }
        }
        hidden.find_active();
        for (entries, list) in hidden.planes.iter_mut().zip(walls) {
            let mut dead = vec![false; list.particle.len()];
            let exchange = Exchange { rows: &self.histories[list.law as usize], reversed: false };
            entries.retain_mut(|entry| {
                let listed = list.particle.binary_search(&particles.slot[entry.first as usize]).ok();
                let kept = exchange.exchange(entry, listed, &mut list.flags, &mut list.history);
                if let (Some(place), true) = (listed, kept) {
                    dead[place] = true;
                }
                kept
            });
            if !entries.is_empty() {
                list.remove(&dead);
            }
        }
    }
}

/// Gives the hidden contact of two bodies that touch its spring. Returns whether they have one.
pub(crate) fn put_spring(scene: &Scene, state: &mut State, placed: &PlacedSpring) -> bool {
    let [a, b] = placed.bodies;
    let sign = if a < b { 1.0 } else { -1.0 };
    let (first, second) = (a.min(b), Some(a.max(b)));
    for (law, list) in state.hidden.pairs.iter_mut().enumerate() {
        if let Ok(place) = Hidden::find(list, first, second) {
            let entry = &mut list[place];
            let [x, y, z] = placed.spring.map(|part| sign * part);
            if let Some(spring) = Law::of(&scene.contacts[law].choice()).spring() {
                entry.history[spring] = [x, y, z, 0.0];
            }
            entry.flags |= TOUCHING;
            return true;
        }
    }
    false
}

/// How what is remembered of a contact goes between an entry and its place in a list.
struct Exchange<'a> {
    /// What its law remembers.
    rows: &'a [HistoryRow],
    /// Whether the list has the bodies in the other order.
    reversed: bool,
}

impl Exchange<'_> {
    /// A row as the other side sees it.
    fn seen(&self, place: usize, row: Row) -> Row {
        if self.reversed { self.rows[place].reversed(row) } else { row }
    }

    /// Moves what is remembered to where the contact stands; returns whether the entry stays.
    fn exchange(
        &self,
        entry: &mut HiddenContact,
        listed: Option<usize>,
        flags: &mut [u8],
        history: &mut [Vec<Row>],
    ) -> bool {
        let Some(place) = listed else { return !entry.is_over() };
        if entry.is_over() {
            flags[place] = entry.flags & (TOUCHING | SLIDING);
            for (row, list) in history.iter_mut().enumerate() {
                list[place] = self.seen(row, entry.history[row]);
            }
            return false;
        }
        if flags[place] & TOUCHING != 0 && entry.flags & TOUCHING == 0 {
            entry.flags |= flags[place] & (TOUCHING | SLIDING);
            for (row, list) in history.iter().enumerate() {
                entry.history[row] = self.seen(row, list[place]);
            }
        }
        true
    }
}
