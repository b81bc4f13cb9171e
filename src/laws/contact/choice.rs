//! Four sub-models, as a scene names them, and the coefficients that follow from them.

use super::{
    Adhesion, CohesionModel, FrictionNeeds, HistoryRow, MaterialPair, Missing, NormalModel, Objection, RollingModel,
    Scheme, Switches, TangentialModel, cohesion, model, normal, rolling, tangential,
};

/// The sub-models and switches of one law, as the scene names them.
#[derive(Clone, Copy, Debug)]
pub struct LawChoice {
    /// Normal sub-model.
    pub normal: NormalModel,
    /// Tangential sub-model.
    pub tangential: TangentialModel,
    /// Rolling sub-model.
    pub rolling: RollingModel,
    /// Cohesion sub-model.
    pub cohesion: CohesionModel,
    /// Switches of every law.
    pub switches: Switches,
    /// How springs and dashpots go on in time.
    pub scheme: Scheme,
}

/// What each sub-model and scheme of the program remembers of a contact, as text: name and signs of its row.
pub fn remembered() -> String {
    let normal = normal::STANDARD.iter().map(|row| (row.name(), row.history()));
    let tangential = tangential::STANDARD.iter().map(|row| (row.name(), row.history()));
    let rolling = rolling::STANDARD.iter().map(|row| (row.name(), row.history()));
    let cohesion = cohesion::STANDARD.iter().map(|row| (row.name(), row.history()));
    let rows = normal.chain(tangential).chain(rolling).chain(cohesion);
    let rows = rows.filter_map(|(model, row)| Some((model, *row?)));
    let own = Scheme::ALL.iter().filter_map(|scheme| Some((scheme.name(), scheme.memory().row()?)));
    let line = |model: &str, row: &HistoryRow| format!("{model}: {} {:?} {}\n", row.name, row.odd, row.fourth_is_free);
    rows.chain(own).map(|(model, row)| line(model, &row)).collect()
}

impl LawChoice {
    /// The coefficients of two materials: those of the normal model and the switches, then those of the tangential,
    /// the rolling and the cohesion model. Otherwise every property that is missing.
    pub fn coefficients(&self, pair: &MaterialPair) -> Result<Vec<f64>, Vec<Missing>> {
        let (friction, rolling) = (&self.tangential.row().does, &self.rolling.row().does);
        let needs = FrictionNeeds {
            stiffness: friction.has_spring || rolling.takes_tangential_stiffness,
            damping: friction.has_dashpot && self.switches.damps_slip(),
        };
        let found = [
            self.normal.between(pair, needs),
            Ok(model::numbers(&self.switches)),
            self.tangential.between(pair, self.is_damped_at_touch()),
            self.rolling.between(pair),
            self.cohesion.between(pair),
        ];
        let (mut row, mut missing) = (Vec::new(), Vec::new());
        for part in found {
            match part {
                Ok(numbers) => row.extend(numbers),
                Err(one) => missing.push(one),
            }
        }
        if missing.is_empty() { Ok(row) } else { Err(missing) }
    }

    /// [`super::Normal::DAMPED_AT_TOUCH`] of the normal model.
    fn is_damped_at_touch(&self) -> bool {
        self.normal.row().does.damped_at_touch
    }

    /// What speaks against the combination, if anything.
    pub fn objection(&self) -> Option<Objection> {
        if let Some(objection) = self.normal.objection().or_else(|| self.rolling.objection()) {
            return Some(objection);
        }
        let (normal, friction) = (&self.normal.row().does, self.tangential.row());
        let (adhesion, cohesion) = (normal.adhesion, self.cohesion.row());
        if adhesion == Adhesion::BeyondTouch && cohesion.is_active() {
            return Some(Objection {
                table: "cohesion",
                key: "",
                reason: "expected none beside a normal model that pulls beyond touch by itself, found an attraction \
                         by the overlap",
            });
        }
        if cohesion.does.beyond_touch && normal.has_pair_constant {
            return Some(Objection {
                table: "cohesion",
                key: "",
                reason: "expected the normal model hertz, hertz_stiffness or hooke_stiffness beside an attraction beyond touch, \
                         found one that keeps a number of each pair, where the reach of the attraction is kept",
            });
        }
        if adhesion == Adhesion::BeyondTouch && self.rolling.row().does.takes_overlap {
            return Some(Objection {
                table: "rolling",
                key: "",
                reason: "expected epsd, epsd2 or none, found a torque by the overlap, which is below 0 while the \
                         normal model pulls beyond touch",
            });
        }
        if self.scheme.carries() {
            let found = [("normal", self.normal.has_undeformed_arms()), ("rolling", self.rolling.is_engine_exact())];
            if let Some((table, _)) = found.into_iter().find(|(_, of_engine)| *of_engine) {
                return Some(Objection {
                    table,
                    key: "engine_exact",
                    reason: "expected false, or [run] scheme = \"engine\", found true, which is the engine's in its \
                             own scheme",
                });
            }
        }
        if adhesion != Adhesion::None && !normal.limits_itself && self.switches.limits_force() {
            return Some(Objection {
                table: "",
                key: "limit_force",
                reason: "expected false, found true, which would cut the pull that the normal model is for",
            });
        }
        if !friction.is_active() && self.cohesion.reduces_friction() {
            return Some(Objection {
                table: "cohesion",
                key: "tangential_reduce",
                reason: "expected false, or a tangential model, found true without one, where there is no friction to \
                         reduce",
            });
        }
        if !friction.does.has_spring && !self.switches.damps_slip() {
            let is_by_itself = friction.is_active() && !friction.does.has_dashpot;
            return Some(Objection {
                table: "",
                key: "tangential_damping",
                reason: if is_by_itself {
                    "expected no such key, found false, which changes nothing: the tangential model takes no damping \
                     of the normal model"
                } else {
                    "expected true, or tangential model none without this key, found false, which leaves \
                     nothing tangential without a tangential spring"
                },
            });
        }
        if self.is_damped_at_touch() && self.stretches_backwards() {
            return Some(Objection {
                table: "tangential",
                key: "backward_spring",
                reason: "expected false, another tangential model, or tangential_damping = false, found true, with \
                         a normal model whose dashpot acts in full at first touch, before the spring has a \
                         stiffness: it would stretch the spring without bound",
            });
        }
        None
    }

    /// Whether a dashpot beyond the limit of friction stretches the tangential spring backwards.
    pub fn stretches_backwards(&self) -> bool {
        self.switches.damps_slip() && self.tangential.stretches_backwards(self.is_damped_at_touch())
    }
}

#[cfg(test)]
mod tests;
