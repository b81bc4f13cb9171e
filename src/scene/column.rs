//! What particles begin with in declared columns.

use super::SceneDraft;
use crate::base::document::Mistake;
use crate::laws::column::Column;

/// A declared column that a scene asks for, and what it begins with.
#[derive(Clone, Debug)]
pub struct ColumnStart {
    /// Its declaration.
    pub column: &'static Column,
    /// The value of each particle of the scene.
    pub particles: Vec<f64>,
    /// The value of what comes by each insertion.
    pub insertions: Vec<f64>,
}

impl SceneDraft {
    /// The place of the column of this name among those that it asks for.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|start| start.column.name == name)
    }

    /// Particles that have one value of each shared column: groups by the name of their table, and clumps.
    pub(crate) fn shared_by(&self) -> impl Iterator<Item = (String, Vec<u32>)> + '_ {
        let groups = self.boundaries.iter().map(|it| (format!("boundary.{}", it.name), it.shape.members().to_vec()));
        let clumps = self.clumps.iter().map(|clump| {
            let name = &self.clump_shapes[clump.shape as usize].name;
            (format!("clump.{name}"), self.spheres_of(clump).map(|sphere| sphere as u32).collect())
        });
        groups.chain(clumps)
    }
}

/// Bodies whose particles begin with several values of what they share.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<(String, &'static str, Mistake)> {
    let mut found = Vec::new();
    for ColumnStart { column, particles, .. } in scene.columns.iter().filter(|start| start.column.shared.is_some()) {
        for (table, members) in scene.shared_by() {
            let mut values = members.iter().map(|&member| particles[member as usize]);
            let Some(first) = values.next() else { continue };
            if let Some(other) = values.find(|value| *value != first) {
                let found_values = format!("particles of {} {first:?} and {other:?} {}", column.name, column.unit);
                let expected = format!("one {} of all its particles", column.name);
                found.push((table, "", Mistake::Unexpected { found: found_values, expected }));
            }
        }
    }
    found
}
