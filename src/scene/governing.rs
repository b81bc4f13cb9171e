//! Which contact law governs two materials, and what is kept of the contacts of a law.

use super::SceneDraft;
use crate::laws::bond::creation::ContactPolicy;
use crate::laws::contact::{HistoryRow, Law, OFFSET};
use crate::laws::wear::WearModel;
use crate::scene::{GridOutput, Probed};

/// The contact law of each two materials: the only place that says which law governs a contact.
#[derive(Clone, Debug)]
pub struct GoverningLaws {
    /// Of each two materials, row by row.
    of: Vec<Option<u32>>,
    /// How many materials there are.
    materials: usize,
}

impl GoverningLaws {
    /// The law that governs contacts of these two materials, if one does: its index in the scene.
    pub fn between(&self, one: u32, other: u32) -> Option<u32> {
        self.of[one as usize * self.materials + other as usize]
    }

    /// The law of each two materials, row by row.
    pub fn rows(&self) -> &[Option<u32>] {
        &self.of
    }
}

impl SceneDraft {
    /// Which contact law governs each two materials.
    pub fn governing_laws(&self) -> GoverningLaws {
        let materials = self.materials.len();
        let law = |entry: usize| self.contacts.iter().position(|law| law.between[entry]).map(|law| law as u32);
        GoverningLaws { of: (0..materials * materials).map(law).collect(), materials }
    }

    /// Whether bonds of the scene suppress contacts.
    pub fn suppresses_contacts(&self) -> bool {
        self.bonds.iter().any(|bond| bond.keys.contact != ContactPolicy::Parallel)
    }

    /// A law, with what the outputs of the scene ask to be remembered of contacts.
    pub fn law(&self, law: usize) -> Law {
        let law = Law::of(&self.contacts[law].choice);
        let law = if self.records_contacts() { law.recorded() } else { law };
        let law = if self.output.losses { law.booked().warming(self.heat.from_losses) } else { law };
        if self.follows_impacts() { law.followed() } else { law }
    }

    /// Whether anything is summed up of what contacts leave behind.
    pub(crate) fn has_traces(&self) -> bool {
        self.output.impacts.is_some() || self.boundaries.iter().any(|boundary| !boundary.wear.is_empty())
    }

    /// Whether contacts remember how they began and what they lost.
    fn follows_impacts(&self) -> bool {
        let looks = |boundary: &crate::scene::Boundary| boundary.wear.iter().any(WearModel::looks_at_touch);
        self.output.impacts.is_some() || self.boundaries.iter().any(looks)
    }

    /// Whether an output takes forces of single contacts.
    fn records_contacts(&self) -> bool {
        let probed = || self.probes.iter().any(|probe| matches!(probe.of, Probed::Contact(_)));
        let stress = || self.grids.iter().any(|grid| grid.tells(GridOutput::Stress));
        self.output.contacts || self.output.boundaries || !self.regions.is_empty() || stress() || probed()
    }

    /// Rows that are kept of each contact of a law: those that the law remembers and, where bonds suppress contacts,
    /// [`OFFSET`] behind them.
    pub fn kept_rows(&self, law: usize) -> Vec<HistoryRow> {
        let mut rows = self.law(law).history().to_vec();
        rows.extend(self.suppresses_contacts().then_some(OFFSET));
        rows
    }
}
