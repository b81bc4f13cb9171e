//! Coefficients of contact laws, which may change while a scene runs.

use super::Simulation;
use crate::contact::{MaterialPair, Missing, PairProperties};
use crate::quantity::MaterialIndex;
use crate::scene::Step;
use crate::state::ledger::Source;

impl Simulation {
    /// Gives two materials other properties from now on, between communication steps: what contact laws make of them is
    /// part of the state, and is saved and restored with it. What contacts remember stays, and forces change in the
    /// next time step. Says what the laws need and do not find, and then leaves all as it was.
    pub fn set_pair_properties(
        &mut self,
        [a, b]: [MaterialIndex; 2],
        properties: &PairProperties,
    ) -> Result<(), Vec<Missing>> {
        let (a, b, count) = (a.index(), b.index(), self.scene.materials.len());
        let pair = MaterialPair { a: &self.scene.materials[a], b: &self.scene.materials[b], properties };
        let governing = self.scene.contacts.iter().enumerate().filter(|(_, law)| law.between[a * count + b]);
        let rows = governing.map(|(index, law)| Ok((index, law.choice().coefficients(&pair)?)));
        let rows: Vec<(usize, Vec<f64>)> = rows.collect::<Result<_, Vec<Missing>>>()?;
        self.way_back.forget();
        for (law, row) in rows {
            for entry in [a * count + b, b * count + a] {
                self.state.coefficients[law][entry * row.len()..][..row.len()].copy_from_slice(&row);
            }
        }
        let reach = self.search.reach();
        self.take_coefficients();
        if self.search.reach() > reach {
            self.renew_lists();
        }
        for pass in self.passes.iter().filter(|pass| pass.source() != Source::Bonds) {
            pass.prepare(&mut self.state);
        }
        if let Step::Automatic { safety } = self.scene.run.step {
            self.state.clock.stable = self.limit().safe;
            self.state.clock.step = self.state.clock.step.min(safety * self.state.clock.stable);
        }
        Ok(())
    }

    /// Takes over the coefficients of the state.
    pub(super) fn take_coefficients(&mut self) {
        for pass in &mut self.passes {
            pass.take_coefficients(&self.state);
        }
        self.search.take_coefficients(&self.scene, &self.state);
    }
}
