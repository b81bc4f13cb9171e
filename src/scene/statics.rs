//! What has no static stiffness.

use super::SceneDraft;
use crate::laws::bond::damping::DampingChoice;

impl SceneDraft {
    /// What has no static stiffness, or moves by itself, if anything; and what was expected.
    pub fn without_statics(&self) -> Option<(String, &'static str)> {
        let moves = self.boundaries.iter().find(|it| it.axes.iter().any(|axis| axis.is_free()));
        self.without_rest().or_else(|| {
            Some((format!("[boundary.{}] moved by forces", moves?.name), "a boundary that is led or fixed"))
        })
    }

    /// What depends on speed or time, however slow, if anything; and what was expected.
    pub(crate) fn without_rest(&self) -> Option<(String, &'static str)> {
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
        None
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
