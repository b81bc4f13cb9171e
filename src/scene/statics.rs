//! What has no static stiffness.

use super::SceneDraft;
use crate::laws::bond::damping::DampingChoice;

impl SceneDraft {
    /// What depends on speed or time, however slow, or moves by itself, if anything; and what was expected.
    pub fn without_statics(&self) -> Option<(String, &'static str)> {
        if let Some(law) = self.contacts.iter().find(|law| law.choice.rolling.name() == "cdt") {
            return Some((format!("[contact.{}] rolling.cdt", law.name), "another rolling model, or none"));
        }
        for bond in &self.bonds {
            if bond.keys.formulation.is_engine() {
                return Some((format!("[bond.{}] formulation engine_exact", bond.name), "another formulation"));
            }
            if bond.keys.relaxation.is_some() {
                return Some((format!("[bond.{}] relaxation", bond.name), "a bond that keeps its load"));
            }
            if bond.keys.damping.is_some_and(|damping| !matches!(damping, DampingChoice::Viscous(_))) {
                let what = format!("[bond.{}] damping by a share of the load", bond.name);
                return Some((what, "damping.viscous, or none"));
            }
        }
        if self.cell.is_some() {
            return Some(("[cell]".to_owned(), "a scene without a periodic cell"));
        }
        if let Some(clump) = self.clumps.first() {
            let name = &self.clump_shapes[clump.shape as usize].name;
            return Some((format!("[clump.{name}]"), "a scene without clumps"));
        }
        let moves = self.boundaries.iter().find(|it| it.axes.iter().any(|axis| axis.is_free()))?;
        Some((format!("[boundary.{}] moved by forces", moves.name), "a boundary that is led or fixed"))
    }

    /// What speaks against the stiffness that is asked for as an output: what was found, and what was expected.
    pub(crate) fn stiffness_objection(&self) -> Option<[String; 2]> {
        let (what, expected) = self.without_statics().filter(|_| self.output.stiffness)?;
        Some([
            format!("true beside {what}, which has no static stiffness"),
            format!("{expected}, or stiffness = false"),
        ])
    }
}
