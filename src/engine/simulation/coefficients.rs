//! Numbers of laws that may change while a scene runs: coefficients of contact laws, strengths of bonds.

use super::Simulation;
use crate::base::quantity::MaterialIndex;
use crate::engine::state::ledger::Source;
use crate::laws::bond::keys::KeyError;
use crate::laws::contact::{MaterialPair, Missing, Properties};

/// Why parameters were not changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TuneError {
    /// Strengths that contradict each other.
    #[error("[bond.{bond}] {error}")]
    Bond {
        /// The bond law.
        bond: String,
        /// What contradicts what.
        error: KeyError,
    },
    /// A law lacks a property.
    #[error("[{}] {} is missing", .0.table, .0.key)]
    Missing(Missing),
}

/// Coefficients of contact laws between two materials.
struct PairRows {
    /// The materials.
    pair: [MaterialIndex; 2],
    /// Laws that govern them, each with its row.
    rows: Vec<(usize, Vec<f64>)>,
}

impl Simulation {
    /// Gives tunable parameters, by their places among [`SceneDraft::tunables`](crate::scene::SceneDraft::tunables), other values
    /// from now on, between communication steps: all of them or none. The values are part of the state, and are saved and
    /// restored with it. What contacts and bonds remember stays; forces change in the next time step.
    pub fn tune(&mut self, changes: &[(usize, f64)]) -> Result<(), TuneError> {
        let mut tuned = self.state.tuned.clone();
        let mut pairs = Vec::new();
        for &(place, value) in changes {
            tuned[place] = value;
            let name = self.scene.tunables().nth(place).map(|parameter| parameter.name.clone());
            pairs.extend(name.and_then(|name| self.scene.pair_of(&name)));
        }
        for (law, bond) in self.scene.bonds.iter().enumerate() {
            if let Err(mut errors) = self.scene.tuned_law(law, &tuned) {
                return Err(TuneError::Bond { bond: bond.name.clone(), error: errors.remove(0) });
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut rows = Vec::new();
        for pair in pairs {
            let properties = self.scene.tuned_pair(pair, &tuned).unwrap_or_default();
            rows.push(self.pair_rows(pair, &properties).map_err(|mut missing| TuneError::Missing(missing.remove(0)))?);
        }
        self.state.tuned = tuned;
        self.give(rows);
        Ok(())
    }

    /// Gives two materials other properties from now on, between communication steps: what contact laws make of them is
    /// part of the state, and is saved and restored with it. What contacts remember stays, and forces change in the
    /// next time step. Says what the laws need and do not find, and then leaves all as it was.
    pub fn set_pair_properties(
        &mut self,
        pair: [MaterialIndex; 2],
        properties: &Properties,
    ) -> Result<(), Vec<Missing>> {
        let rows = self.pair_rows(pair, properties)?;
        self.give(vec![rows]);
        Ok(())
    }

    /// What contact laws make of the properties of two materials.
    fn pair_rows(&self, pair: [MaterialIndex; 2], properties: &Properties) -> Result<PairRows, Vec<Missing>> {
        let ([a, b], count) = (pair.map(MaterialIndex::index), self.scene.materials.len());
        let materials = MaterialPair { a: &self.scene.materials[a], b: &self.scene.materials[b], properties };
        let governing = self.scene.contacts.iter().enumerate().filter(|(_, law)| law.between[a * count + b]);
        let rows = governing.map(|(index, law)| Ok((index, law.choice.coefficients(&materials)?)));
        Ok(PairRows { pair, rows: rows.collect::<Result<_, Vec<Missing>>>()? })
    }

    /// Puts rows of coefficients in the place of those that were, and lets everything follow that depends on them.
    fn give(&mut self, pairs: Vec<PairRows>) {
        let count = self.scene.materials.len();
        self.rollback.forget();
        for PairRows { pair, rows } in &pairs {
            let [a, b] = pair.map(MaterialIndex::index);
            for (law, row) in rows {
                for entry in [a * count + b, b * count + a] {
                    self.state.coefficients[*law][entry * row.len()..][..row.len()].copy_from_slice(row);
                }
            }
        }
        let reach = self.search.reach();
        self.take_coefficients();
        if pairs.is_empty() {
            return;
        }
        if self.search.reach() > reach {
            self.renew_lists();
        }
        for pass in self.passes.iter().filter(|pass| pass.source() != Source::Bonds) {
            pass.prepare(&mut self.state);
        }
        if self.scene.run.step.is_automatic() {
            self.state.clock.stable = self.stable_step();
            self.shorten_step();
        }
    }

    /// Takes over the coefficients and strengths of the state.
    pub(super) fn take_coefficients(&mut self) {
        let Self { passes, scene, state, .. } = self;
        for pass in passes {
            pass.take_coefficients(state);
            pass.take_strengths(scene, state);
        }
        self.search.take_coefficients(&self.scene, &self.state);
        self.try_impacts();
    }
}
