//! Which particles a table chooses, and whose they are.

use super::particles::ReadParticles;
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::scene::file::tables::Selection;
use crate::scene::import::REPORTED;

/// The particles that a selection chooses, ascending; reports a selection of none.
pub(super) fn members(selection: &Selection, born: &ReadParticles, table: &str, faults: &mut Faults) -> Vec<u32> {
    let before = faults.count();
    let mut sets: Option<Vec<usize>> = None;
    for name in selection.set.iter().chain(selection.sets.iter().flatten()) {
        match born.sets.iter().position(|set| set == name) {
            Some(index) => sets.get_or_insert_default().push(index),
            None => {
                let (found, known) = (name.clone(), born.sets.clone());
                let key = if selection.set.as_ref() == Some(name) { "particles.set" } else { "particles.sets" };
                faults.add(table, key, Mistake::UnknownName { found, kind: "particle set", known });
            }
        }
    }
    let ids = selection.ids.as_ref().map(|ids| {
        let mut ids = ids.clone();
        ids.sort_unstable();
        let known = |id: &&u32| born.particles.binary_search_by_key(id, |particle| &particle.id.0).is_ok();
        for id in ids.iter().filter(|id| !known(id)).take(REPORTED) {
            let (found, expected) = (id.to_string(), "the number of a particle of this scene".to_owned());
            faults.add(table, "particles.ids", Mistake::Unexpected { found, expected });
        }
        ids
    });
    let chosen = |particle: &crate::scene::Particle| {
        let in_box = |corners: [[f64; 3]; 2]| {
            (0..3).all(|axis| (corners[0][axis]..=corners[1][axis]).contains(&particle.position[axis]))
        };
        sets.as_ref().is_none_or(|sets| sets.contains(&particle.set.index()))
            && ids.as_ref().is_none_or(|ids| ids.binary_search(&particle.id.0).is_ok())
            && selection.r#box.is_none_or(|corners| in_box(corners.0))
    };
    let members: Vec<u32> =
        (0..).zip(&born.particles).filter(|(_, particle)| chosen(particle)).map(|(i, _)| i).collect();
    if members.is_empty() && faults.count() == before {
        faults.add(table, "particles", Mistake::EmptySelection { expected: extent(born) });
    }
    members
}

/// Where the centres of the particles are.
fn extent(born: &ReadParticles) -> String {
    let Some(first) = born.particles.first() else { return "the scene has no particles".to_owned() };
    let (mut lower, mut upper) = (first.position, first.position);
    for particle in &born.particles {
        for axis in 0..3 {
            lower[axis] = lower[axis].min(particle.position[axis]);
            upper[axis] = upper[axis].max(particle.position[axis]);
        }
    }
    format!("all centres are between {lower:?} and {upper:?} m")
}

/// Whose the particles are.
pub(super) struct ParticleOwners {
    /// The tables that have some.
    tables: Vec<String>,
    /// Index into the tables, of each particle.
    of: Vec<Option<u32>>,
}

impl ParticleOwners {
    /// Nobody's yet.
    pub(super) fn of(born: &ReadParticles) -> Self {
        Self { tables: Vec::new(), of: vec![None; born.particles.len()] }
    }

    /// Notes the owner of the members; reports a member that already has an owner.
    pub(super) fn claim(&mut self, members: &[u32], table: &str, born: &ReadParticles, faults: &mut Faults) {
        let taken = members.iter().find_map(|member| self.of[*member as usize].map(|owner| (*member, owner)));
        if let Some((member, owner)) = taken {
            let (id, other) = (born.particles[member as usize].id.0, format!("[{}]", self.tables[owner as usize]));
            faults.add(table, "particles", Mistake::AlreadyTaken { id, other });
        }
        for member in members {
            self.of[*member as usize].get_or_insert(self.tables.len() as u32);
        }
        self.tables.push(table.to_owned());
    }
}
