//! Springs of contacts and bonds, from the lists of one scene to those of another.

use super::{Description, Numbers};
use crate::engine::cell::images::{ImageSlots, whereabouts};
use crate::engine::simulation::Simulation;
use crate::engine::state::contacts::{BONDED, RELEASED, SILENT};
use crate::engine::state::{BondList, History, Row, State, WallContacts};
use crate::laws::bond::Law;
use crate::laws::contact::HistoryRow;
use crate::scene::Scene;

/// What both scenes keep of the contacts of their laws.
pub(super) struct Memories {
    /// Of each law here: its rows.
    here: Vec<Vec<HistoryRow>>,
    /// Of each law here and each of the other scene: which row of the latter each of its rows is.
    rows: Vec<Vec<Vec<Option<usize>>>>,
    /// Of each law here: in which of its rows a scheme uses the free fourth number.
    numbers: Vec<Option<usize>>,
}

impl Memories {
    /// Compares what is remembered, by name.
    pub(super) fn of(scene: &Scene, from: &Description) -> Self {
        let here: Vec<_> = (0..scene.contacts.len()).map(|law| scene.kept_rows(law)).collect();
        let find = |row: &HistoryRow, there: &[String]| there.iter().position(|name| name == row.name);
        let all = |rows: &[HistoryRow]| {
            let laws = from.contacts().iter();
            laws.map(|(_, there)| rows.iter().map(|row| find(row, there)).collect()).collect()
        };
        let numbers = (0..scene.contacts.len()).map(|law| scene.law(law).history_places().normal_velocity).collect();
        Self { rows: here.iter().map(|rows| all(rows)).collect(), here, numbers }
    }

    /// Adds what a law here remembers of a contact of a law there; as the other body sees it, if they have changed places.
    fn push(&self, history: &mut History, (here, there, swapped): (usize, usize, bool), old: &[Row]) {
        // A list that is new knows not yet how many rows there are.
        if history.all().is_empty() {
            history.clear(self.here[here].len());
        }
        let rows = self.here[here].iter().zip(&self.rows[here][there]).enumerate();
        history.push(rows.map(|(number, (kept, place))| {
            let Some(place) = place else { return Row::default() };
            let mut row = if swapped { kept.reversed(old[*place]) } else { old[*place] };
            // What another scheme left there would be older at each step.
            if kept.fourth_is_free && self.numbers[here] != Some(number) {
                row[3] = 0.0;
            }
            row
        }));
    }
}

/// Gives the contacts of a state the rows that the outputs of this scene ask for, and takes away those that only the outputs of its
/// own scene, which differs from this one in nothing else, asked for.
pub(super) fn fit_outputs(scene: &Scene, state: &mut State, from: &Description) {
    for (law, (_, there)) in from.contacts().iter().enumerate().take(scene.contacts.len()) {
        let here = scene.kept_rows(law);
        let places: Vec<_> = here.iter().map(|row| there.iter().position(|name| name == row.name)).collect();
        let fit = |history: &mut History, count: usize| {
            // Others are refused when the state is looked through.
            if history.rows() == there.len() && history.all().len() == there.len() * count {
                let mut new = History::of(here.len(), 0);
                for entry in 0..count {
                    let old = history.get(entry);
                    new.push(places.iter().map(|place| place.map_or(Row::default(), |place| old[place])));
                }
                *history = new;
            }
        };
        if let Some(list) = state.contacts.get_mut(law) {
            fit(&mut list.history, list.first.len());
        }
        for list in state.walls.iter_mut().filter(|list| list.law as usize == law) {
            fit(&mut list.history, list.particle.len());
        }
    }
}

/// Flags of a contact whose bonds are left behind: those that are here flag it again.
fn unbonded(flags: u8) -> u8 {
    let released = if flags & BONDED != 0 { RELEASED } else { 0 };
    (flags | released) & !(BONDED | SILENT)
}

/// Puts what is remembered of touching bodies into the lists of the laws that govern them here. Slots are those of the
/// scene, `rows` those here of the slots there.
pub(super) fn put_contacts(
    scene: &Scene,
    state: &mut State,
    reached: &State,
    known: (&Description, &Numbers),
    rows: &[Option<u32>],
) {
    let (from, numbers) = known;
    let (memories, governing) = (Memories::of(scene, from), scene.governing_laws());
    let here = |slot: u32| rows[slot as usize];
    for (there, list) in reached.contacts.iter().enumerate() {
        for (pair, _) in list.flags.iter().enumerate().filter(|(_, flags)| **flags != 0) {
            let (Some(a), Some(b)) = (here(list.first[pair]), here(list.second[pair])) else { continue };
            let [one, other] = [a, b].map(|index| state.particles.material[index as usize]);
            let Some(law) = governing.between(one, other).map(|law| law as usize) else { continue };
            let new = &mut state.contacts[law];
            new.first.push(a.min(b));
            new.second.push(a.max(b));
            new.flags.push(unbonded(list.flags[pair]));
            memories.push(&mut new.history, (law, there, a > b), list.history.get(pair));
        }
    }
    put_wall_contacts(scene, state, reached, (from, numbers, &memories));
}

/// The same of contacts at surfaces.
fn put_wall_contacts(
    scene: &Scene,
    state: &mut State,
    reached: &State,
    (from, numbers, memories): (&Description, &Numbers, &Memories),
) {
    let (here, governing) = (|slot: u32| numbers.at(reached.particles.id[slot as usize]), scene.governing_laws());
    for list in &reached.walls {
        let Some((boundary, material)) = plane(scene, from, list.boundary) else { continue };
        let flagged = list.flags.iter().enumerate().filter(|(_, flags)| **flags != 0);
        let mut flagged: Vec<(u32, usize)> =
            flagged.filter_map(|(entry, _)| Some((here(list.particle[entry])?, entry))).collect();
        flagged.sort_unstable();
        let surface = &scene.boundaries[boundary as usize];
        let features = surface.shape.features().filter(|_| surface.shifting_plane().is_none());
        let features = features.map(|features| features.counts()[1]);
        for (index, entry) in flagged {
            // A mesh of the same name may have fewer triangles here; a plane is touched once.
            let feature = list.feature.get(entry).copied().filter(|_| features.is_some());
            let fits = |count: usize| feature.is_some_and(|feature| (feature as usize) < count);
            let once = |list: &WallContacts| features.is_some() || list.particle.last() != Some(&index);
            let law = governing.between(state.particles.material[index as usize], material);
            let Some(law) = law.map(|law| law as usize) else { continue };
            let governs = |list: &&mut WallContacts| (list.boundary, list.law) == (boundary, law as u32);
            let Some(new) = state.walls.iter_mut().find(governs) else { continue };
            if !features.is_none_or(fits) || !once(new) {
                continue;
            }
            new.particle.push(index);
            new.flags.push(unbonded(list.flags[entry]));
            new.feature.extend(feature);
            memories.push(&mut new.history, (law, list.law as usize, false), list.history.get(entry));
        }
    }
}

/// The surface here that a boundary of the other scene is: its place and material.
fn plane(scene: &Scene, from: &Description, boundary: u32) -> Option<(u32, u32)> {
    let (name, _) = from.boundary_at(boundary as usize)?;
    let place = scene.boundaries.iter().position(|it| it.name == *name && from.boundary(it).is_some())?;
    Some((place as u32, scene.boundaries[place].shape.material()?.0))
}

impl Simulation {
    /// Puts bonds of laws of the same name in the place of those that were made anew. Returns what stays behind, in words.
    pub(super) fn put_bonds(&mut self, reached: &State, from: &Description, numbers: &Numbers) -> Vec<String> {
        let (mut left, mut taken) = (Vec::new(), vec![false; self.scene.bonds.len()]);
        let mut images = ImageSlots::of(&self.state);
        for ((name, formulation, plane), list) in from.bonds().iter().zip(&reached.bonds) {
            let same = |bond: &crate::scene::Bond| {
                let here = bond.plane.map(|plane| self.scene.boundaries[plane.index()].name.clone());
                bond.name == *name && format!("{:?}", bond.keys.formulation) == *formulation && here == *plane
            };
            match self.scene.bonds.iter().position(same) {
                Some(law) => {
                    let here = self.bonds_here(list, (reached, numbers), &self.scene.bond_law(law), &mut images);
                    self.state.bonds[law] = here;
                    taken[law] = true;
                    let missing = list.first.len() - self.state.bonds[law].first.len();
                    if missing > 0 {
                        left.push(format!("{missing} bonds of [bond.{name}] stay behind with their particles"));
                    }
                }
                None if list.first.is_empty() => {}
                None => left.push(format!(
                    "{} bonds of [bond.{name}] stay behind: this scene has no law of that name and formulation",
                    list.first.len()
                )),
            }
        }
        images.make(&mut self.state);
        self.count_bonds(reached, numbers, &taken);
        left
    }

    /// The bonds of a list between particles that are here, in the present order of the particles.
    fn bonds_here(
        &self,
        list: &BondList,
        (reached, numbers): (&State, &Numbers),
        law: &Law,
        images: &mut ImageSlots,
    ) -> BondList {
        let away = reached.cell.as_ref().map(|cell| whereabouts(cell, &reached.particles));
        let index = |old: u32| numbers.at(reached.particles.id[old as usize]);
        // Where the other law remembered no rates, they begin with 0, which the first time step forgets.
        let damping = vec![Vec::new(); law.damping_rows()];
        let mut new = BondList { rows: vec![Vec::new(); list.rows.len()], damping, ..BondList::default() };
        for bond in 0..list.first.len() {
            let there = (list.first[bond], list.second.get(bond).copied());
            let (Some(first), second) = (index(there.0), there.1.map(index)) else { continue };
            let slot = |index: u32| self.state.particles.slot[index as usize];
            match (second, &away, there.1) {
                (Some(None), ..) => continue,
                (Some(Some(second)), Some(away), Some(other)) => {
                    let [first, second] = images.pair(&self.state, [first, second], [there.0, other], away);
                    new.first.push(first);
                    new.second.push(second);
                }
                (second, ..) => {
                    new.first.push(slot(first));
                    new.second.extend(second.flatten().map(slot));
                }
            }
            new.foot.extend(list.foot.get(bond));
            for (column, row) in new.rows.iter_mut().zip(&list.rows) {
                column.push(row[bond]);
            }
            if law.dissipates() {
                new.lost.push(list.lost.get(bond).copied().unwrap_or(0.0));
            }
            for (place, column) in new.damping.iter_mut().enumerate() {
                column.push(list.damping.get(place).and_then(|rows| rows.get(bond)).copied().unwrap_or_default());
            }
        }
        new.made = new.first.len() as u64;
        new
    }

    /// Counts the bonds of each particle: those it had, and those made anew.
    fn count_bonds(&mut self, reached: &State, numbers: &Numbers, taken: &[bool]) {
        let particles = &mut self.state.particles;
        particles.bonds.fill([0; 2]);
        for (there, counts) in reached.particles.bonds.iter().enumerate() {
            let here = numbers.at(there as u32).and_then(|here| particles.bonds.get_mut(here as usize));
            if let Some(here) = here {
                *here = *counts;
            }
        }
        for (list, _) in self.state.bonds.iter().zip(taken).filter(|(_, taken)| !**taken) {
            let bodies: Vec<u32> =
                list.first.iter().chain(&list.second).map(|&slot| particles.id[slot as usize]).collect();
            particles.count_bond(bodies);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_fourth_number_is_taken_only_where_the_scheme_uses_it() {
        let spring = HistoryRow { name: "spring", odd: [true, true, true, false], fourth_is_free: true };
        let taken = |number: Option<usize>| {
            let memories =
                Memories { here: vec![vec![spring]], rows: vec![vec![vec![Some(0)]]], numbers: vec![number] };
            let mut history = History::default();
            memories.push(&mut history, (0, 0, true), &[[1.0, 2.0, 3.0, 4.0]]);
            history
        };
        assert_eq!(taken(Some(0)).get(0), [[-1.0, -2.0, -3.0, 4.0]]);
        assert_eq!(taken(None).get(0), [[-1.0, -2.0, -3.0, 0.0]]);
    }
}
