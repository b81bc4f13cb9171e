//! How what a bond does changes with a few inputs: the law over numbers with slopes.

use super::breakage::{Breakage, Loaded, TakeRule};
use super::damping::{Damping, DampingLoad, TakeDamping};
use super::{Coefficients, Elastic, Law, Motion, Pair, Rows};
use crate::dual::Dual;
use crate::number::Vector;

/// What one bond does, with slopes.
#[derive(Clone, Copy, Debug)]
pub struct Sloped {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<Dual>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<Dual>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<Dual>,
    /// The state to remember.
    pub rows: Rows<Dual>,
}

impl Law {
    /// What one bond does, with slopes; nothing where it breaks.
    pub fn react_with_slopes(&self, law: &Coefficients<Dual>, pair: &Pair<Dual>, rows: &Rows<Dual>) -> Option<Sloped> {
        let (motion, elastic) = (self.one_bond().respond_with_slopes)(law, pair, rows);
        let loaded = elastic.loaded(&motion);
        if self.breakage.iter().any(|rule| rule.visit(Judge(&loaded))) {
            return None;
        }
        let mut found =
            Sloped { force: elastic.force, torque_i: elastic.torque_i, torque_j: elastic.torque_j, rows: elastic.rows };
        if let Some(damping) = &self.damping {
            let load = damping.visit(Damp { law, pair, motion: &motion.settled(), elastic: &elastic });
            found.force += load.force;
            found.torque_i += load.torque_i;
            found.torque_j += load.torque_j;
        }
        Some(found)
    }
}

/// One bond to be damped.
struct Damp<'a> {
    /// The law at this step.
    law: &'a Coefficients<Dual>,
    /// Its bodies.
    pair: &'a Pair<Dual>,
    /// How they move.
    motion: &'a Motion<Dual>,
    /// What the formulation answers.
    elastic: &'a Elastic<Dual>,
}

impl TakeDamping for Damp<'_> {
    type Output = DampingLoad<Dual>;
    fn take<D: Damping>(self, damping: D) -> DampingLoad<Dual> {
        damping.damp(self.law, self.pair, self.motion, self.elastic).load(self.pair, self.motion)
    }
}

/// One bond that a rule looks at.
struct Judge<'a>(&'a Loaded<Dual>);

impl TakeRule for Judge<'_> {
    type Output = bool;
    fn take<B: Breakage>(self, rule: B, _before: f64) -> bool {
        rule.judge(self.0).value > 0.0
    }
}
