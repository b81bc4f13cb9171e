//! The names of four sub-models, as a scene writes them, and the coefficients that follow from them.

use super::cohesion::{CohesionChoice, TakeCohesion};
use super::normal::{NormalChoice, TakeNormal};
use super::rolling::{RollingChoice, TakeRolling};
use super::tangential::{TakeTangential, TangentialChoice};
use super::{
    Adhesion, Coefficients, Cohesion, CohesionForm, FrictionNeeds, HistoryRow, MaterialPair, Missing, Normal,
    NormalForm, Objection, Rolling, Scheme, Switches, Tangential,
};

/// The sub-models and switches of one law, as the scene names them.
#[derive(Clone, Copy, Debug)]
pub struct LawChoice {
    /// Normal sub-model.
    pub normal: NormalChoice,
    /// Tangential sub-model.
    pub tangential: TangentialChoice,
    /// Rolling sub-model.
    pub rolling: RollingChoice,
    /// Cohesion sub-model.
    pub cohesion: CohesionChoice,
    /// Switches of every law.
    pub switches: Switches,
    /// How springs and dashpots go on in time.
    pub scheme: Scheme,
}

/// What each sub-model and scheme of the program remembers of a contact, as text: name and signs of its row.
pub fn remembered() -> String {
    let kinds = [NormalChoice::MEMORIES, TangentialChoice::MEMORIES, RollingChoice::MEMORIES, CohesionChoice::MEMORIES];
    let rows = kinds.into_iter().flatten().filter_map(|(model, row)| Some((model, row.as_ref()?)));
    let own = Scheme::ALL.iter().filter_map(|scheme| Some((scheme.name(), scheme.memory().row()?)));
    let line = |model: &str, row: &HistoryRow| format!("{model}: {} {:?} {}\n", row.name, row.odd, row.fourth_is_free);
    rows.map(|(model, row)| line(model, row)).chain(own.map(|(scheme, row)| line(scheme, &row))).collect()
}

impl LawChoice {
    /// The coefficients of two materials: those of the normal model and the switches, then those of the tangential,
    /// the rolling and the cohesion model. Otherwise every property that is missing.
    pub fn coefficients(&self, pair: &MaterialPair) -> Result<Vec<f64>, Vec<Missing>> {
        let friction = self.tangential.visit(Parts);
        let needs = FrictionNeeds {
            stiffness: friction.has_spring || self.rolling.visit(Parts).takes_tangential_stiffness,
            damping: friction.has_dashpot && self.switches.damps_slip(),
        };
        let ask = Ask(pair, needs, self.normal.visit(DampedAtTouch));
        let mut row = Vec::new();
        let mut missing = Vec::new();
        let mut take = |found: Result<Vec<f64>, Missing>| match found {
            Ok(numbers) => row.extend(numbers),
            Err(one) => missing.push(one),
        };
        take(self.normal.visit(ask));
        take(Ok(numbers(&self.switches)));
        take(self.tangential.visit(ask));
        take(self.rolling.visit(ask));
        take(self.cohesion.visit(ask));
        if missing.is_empty() { Ok(row) } else { Err(missing) }
    }

    /// What speaks against the combination, if anything.
    pub fn objection(&self) -> Option<Objection> {
        if let Some(objection) = self.normal.visit(OfKeys) {
            return Some(objection);
        }
        let (friction, adhesion) = (self.tangential.visit(Parts), self.normal.visit(Parts));
        if adhesion == Adhesion::BeyondTouch && self.cohesion.visit(Parts) {
            return Some(Objection {
                table: "cohesion",
                key: "",
                reason: "expected none beside a normal model that pulls beyond touch by itself, found an attraction \
                         by the overlap",
            });
        }
        if adhesion == Adhesion::BeyondTouch && self.rolling.visit(Parts).takes_overlap {
            return Some(Objection {
                table: "rolling",
                key: "",
                reason: "expected epsd, epsd2 or none, found a torque by the overlap, which is below 0 while the \
                         normal model pulls beyond touch",
            });
        }
        if self.scheme.carries() {
            let found = [("normal", self.normal.visit(OfEngine)), ("rolling", self.rolling.visit(OfEngine))];
            if let Some((table, _)) = found.into_iter().find(|(_, of_engine)| *of_engine) {
                return Some(Objection {
                    table,
                    key: "engine_exact",
                    reason: "expected false, or [run] scheme = \"engine\", found true, which is the engine's in its \
                             own scheme",
                });
            }
        }
        if self.normal.visit(Sticks) && self.switches.limits_force() {
            return Some(Objection {
                table: "",
                key: "limit_force",
                reason: "expected false, found true, which would cut the pull that the normal model is for",
            });
        }
        if !friction.active && self.cohesion.visit(Reduces) {
            return Some(Objection {
                table: "cohesion",
                key: "tangential_reduce",
                reason: "expected false, or a tangential model, found true without one, where there is no friction to \
                         reduce",
            });
        }
        if !friction.has_spring && !self.switches.damps_slip() {
            return Some(Objection {
                table: "",
                key: "tangential_damping",
                reason: "expected true, or tangential model none without this key, found false, which leaves \
                         nothing tangential without a tangential spring",
            });
        }
        if self.normal.visit(DampedAtTouch) && self.stretches_backwards() {
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
        let damped_at_touch = self.normal.visit(DampedAtTouch);
        self.switches.damps_slip() && self.tangential.visit(StretchesBackwards { damped_at_touch })
    }
}

/// Coefficients as a row.
fn numbers<T: Coefficients>(coefficients: &T) -> Vec<f64> {
    let mut row = Vec::with_capacity(T::COUNT);
    coefficients.write(&mut row);
    row
}

/// Asks a sub-model what it is made of.
struct Parts;

impl TakeNormal for Parts {
    type Output = Adhesion;
    fn take<M: Normal>(self, _keys: &M::Keys) -> Adhesion {
        M::Form::ADHESION
    }
}

impl TakeCohesion for Parts {
    type Output = bool;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> bool {
        M::Form::ACTIVE
    }
}

/// What a rolling model takes from a contact.
struct RollingParts {
    /// Whether it takes k_n δ for the force that presses.
    takes_overlap: bool,
    /// Whether it takes k_t.
    takes_tangential_stiffness: bool,
}

impl TakeRolling for Parts {
    type Output = RollingParts;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> RollingParts {
        RollingParts { takes_overlap: M::TAKES_OVERLAP, takes_tangential_stiffness: M::TAKES_TANGENTIAL_STIFFNESS }
    }
}

/// Asks a normal model whether `limit_force` contradicts it.
struct Sticks;

impl TakeNormal for Sticks {
    type Output = bool;
    fn take<M: Normal>(self, _keys: &M::Keys) -> bool {
        M::Form::ADHESION != Adhesion::None && !M::Form::LIMITS_ITSELF
    }
}

/// Asks a normal model whether its tangential dashpot acts in full at first touch.
struct DampedAtTouch;

impl TakeNormal for DampedAtTouch {
    type Output = bool;
    fn take<M: Normal>(self, _keys: &M::Keys) -> bool {
        M::DAMPED_AT_TOUCH
    }
}

/// Asks a normal model what speaks against its keys.
struct OfKeys;

impl TakeNormal for OfKeys {
    type Output = Option<Objection>;
    fn take<M: Normal>(self, keys: &M::Keys) -> Option<Objection> {
        M::objection(keys)
    }
}

/// Asks a sub-model whether its keys follow an engine where schemes differ.
struct OfEngine;

impl TakeNormal for OfEngine {
    type Output = bool;
    fn take<M: Normal>(self, keys: &M::Keys) -> bool {
        M::has_undeformed_arms(keys)
    }
}

impl TakeRolling for OfEngine {
    type Output = bool;
    fn take<M: Rolling>(self, keys: &M::Keys) -> bool {
        M::is_engine_exact(keys)
    }
}

/// What a tangential model is made of.
struct FrictionParts {
    /// Whether there is a force at all.
    active: bool,
    /// Whether there is a spring.
    has_spring: bool,
    /// Whether there is a dashpot.
    has_dashpot: bool,
}

impl TakeTangential for Parts {
    type Output = FrictionParts;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> FrictionParts {
        FrictionParts { active: M::ACTIVE, has_spring: M::HAS_SPRING, has_dashpot: M::HAS_DASHPOT }
    }
}

/// Asks a tangential model whether its dashpot stretches its spring backwards.
struct StretchesBackwards {
    /// [`Normal::DAMPED_AT_TOUCH`].
    damped_at_touch: bool,
}

impl TakeTangential for StretchesBackwards {
    type Output = bool;
    fn take<M: Tangential>(self, keys: &M::Keys) -> bool {
        M::stretches_backwards(keys, self.damped_at_touch)
    }
}

/// Asks a cohesion model whether friction sees the attraction.
struct Reduces;

impl TakeCohesion for Reduces {
    type Output = bool;
    fn take<M: Cohesion>(self, keys: &M::Keys) -> bool {
        M::reduces_friction(keys)
    }
}

/// Asks a sub-model for its coefficients between these materials, beside friction and a normal model
/// ([`Normal::DAMPED_AT_TOUCH`]) as said.
#[derive(Clone, Copy)]
struct Ask<'a>(&'a MaterialPair<'a>, FrictionNeeds, bool);

impl TakeNormal for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Normal>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys, self.1)?))
    }
}

impl TakeTangential for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Tangential>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys, self.2)?))
    }
}

impl TakeRolling for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Rolling>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys)?))
    }
}

impl TakeCohesion for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Cohesion>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys)?))
    }
}

#[cfg(test)]
mod tests;
