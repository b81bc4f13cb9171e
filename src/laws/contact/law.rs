//! Four sub-models as one law: what it is made of, and what it asks of a contact.

mod reaction;
mod remembered;
mod response;
#[cfg(test)]
mod tests;

#[cfg(test)]
pub use reaction::Offset;
pub use remembered::OFFSET;

use super::{
    Adhesion, CoefficientPlaces, Coefficients, CohesionFunctions, HistoryPlaces, HistoryRow, LawChoice, LossKind,
    Needs, NormalFunctions, Onset, RollingFunctions, Scheme, SchemeMemory, Switches, TangentialFunctions, Warming,
};

/// A contact law: what the four sub-models that the scene named do to one contact.
#[derive(Clone)]
pub struct Law {
    /// What it remembers of a contact.
    history: Vec<HistoryRow>,
    /// Whose each of those rows is.
    history_places: HistoryPlaces,
    /// Where coefficients stand.
    places: CoefficientPlaces,
    /// Whether its cohesion model acts beyond touch.
    parts: bool,
    /// Which losses warm the bodies.
    warming: Warming,
    /// What the scene named.
    choice: LawChoice,
}

impl Law {
    /// The law of these sub-models.
    pub fn of(choice: &LawChoice) -> Self {
        let LawChoice { normal, tangential, rolling, cohesion, scheme, .. } = *choice;
        let mut history: Vec<HistoryRow> = Vec::new();
        let mut place = |row: Option<HistoryRow>| {
            row.map(|row| {
                history.push(row);
                history.len() - 1
            })
        };
        let mut history_places = HistoryPlaces {
            normal: place(normal.row().history),
            tangential: place(tangential.row().history),
            rolling: place(rolling.row().history),
            ..HistoryPlaces::default()
        };
        match scheme.memory() {
            SchemeMemory::Nothing => {}
            SchemeMemory::Row(row) => history_places.rates = place(Some(row)),
            SchemeMemory::FourthNumber(row) => {
                let free = history.iter().position(|row| row.fourth_is_free);
                history_places.normal_velocity = Some(free.unwrap_or(history.len()));
                history.extend(free.is_none().then_some(row));
            }
        }
        if let Some(row) = cohesion.row().history {
            history_places.cohesion = Some(history.len());
            history.push(row);
        }
        let after_normal = normal.row().count + Switches::COUNT;
        let after_tangential = after_normal + tangential.row().count;
        let after_rolling = after_tangential + rolling.row().count;
        let places = CoefficientPlaces {
            tangential: after_normal,
            rolling: after_tangential,
            cohesion: after_rolling,
            count: after_rolling + cohesion.row().count,
        };
        let parts = cohesion.row().does.beyond_touch;
        Self { history, history_places, places, parts, warming: [false; LossKind::COUNT], choice: *choice }
    }

    /// What the scene named.
    pub fn choice(&self) -> &LawChoice {
        &self.choice
    }

    /// What the normal sub-model does.
    fn normal(&self) -> &'static NormalFunctions {
        &self.choice.normal.row().does
    }

    /// What the tangential sub-model does.
    fn tangential(&self) -> &'static TangentialFunctions {
        &self.choice.tangential.row().does
    }

    /// What the rolling sub-model does.
    fn rolling(&self) -> &'static RollingFunctions {
        &self.choice.rolling.row().does
    }

    /// What the cohesion sub-model does.
    fn cohesion(&self) -> &'static CohesionFunctions {
        &self.choice.cohesion.row().does
    }

    /// Whether part of the normal force is neither the spring nor the dashpot of a pressed contact.
    pub fn has_other_force(&self) -> bool {
        self.has_cohesion() || !self.presses()
    }

    /// Whether the normal model is a spring k_n δ that does not remember, and a dashpot.
    pub fn presses(&self) -> bool {
        self.normal().adhesion == Adhesion::None && !self.is_plastic()
    }

    /// Whether normal forces depend on what was before.
    pub fn is_plastic(&self) -> bool {
        self.choice.normal.row().history.is_some()
    }

    /// Where the coefficients of each sub-model stand in a row of them.
    pub fn places(&self) -> CoefficientPlaces {
        self.places
    }

    /// What it remembers of a contact: rows of four numbers, normal model first, then tangential and rolling model, scheme and cohesion model.
    pub fn history(&self) -> &[HistoryRow] {
        &self.history
    }

    /// Whose each row of the history is.
    pub fn history_places(&self) -> HistoryPlaces {
        self.history_places
    }

    /// Which row of the history is the tangential spring, if there is one.
    pub fn spring(&self) -> Option<usize> {
        self.history_places.tangential.filter(|_| self.tangential().has_spring)
    }

    /// Whether the limit of friction is put to spring and dashpot together.
    pub fn limits_dashpot(&self) -> bool {
        self.tangential().limits_dashpot
    }

    /// Whether a number is kept of each near pair.
    pub fn has_pair_constant(&self) -> bool {
        self.normal().has_pair_constant || self.parts
    }

    /// Whether bodies feel friction from it.
    pub fn has_friction(&self) -> bool {
        self.choice.tangential.row().is_active()
    }

    /// Whether bodies feel rolling torque from it.
    pub fn has_rolling(&self) -> bool {
        self.choice.rolling.row().is_active()
    }

    /// Whether there is an attraction beside the normal model's own.
    pub fn has_cohesion(&self) -> bool {
        self.choice.cohesion.row().is_active()
    }

    /// What of a contact its sub-models look at.
    pub fn needs(&self) -> Needs {
        let LawChoice { normal, tangential, rolling, cohesion, scheme, .. } = &self.choice;
        let arms = self.undeformed_arms();
        let arms = Needs { bodies: arms, spin_sum: arms, ..Needs::NONE };
        let carry = Needs { carry: scheme.carries(), ..Needs::NONE };
        let normal = normal.row().needs.and(tangential.row().needs);
        normal.and(rolling.row().needs).and(cohesion.row().needs).and(arms).and(carry)
    }

    /// How springs and dashpots go on in time.
    pub fn scheme(&self) -> Scheme {
        self.choice.scheme
    }

    /// How dashpots begin.
    pub(crate) fn onset(&self) -> Onset {
        self.choice.normal.onset()
    }

    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms.
    pub fn undeformed_arms(&self) -> bool {
        self.choice.normal.has_undeformed_arms() && (self.has_friction() || self.has_rolling())
    }

    /// Whether bodies that have touched hold together beyond touch: as far as their pair constant says.
    pub fn holds_beyond_touch(&self) -> bool {
        self.pulls_beyond_touch() || self.parts
    }

    /// Whether the normal model does that: its dashpot acts beyond touch, too.
    pub(crate) fn pulls_beyond_touch(&self) -> bool {
        self.normal().adhesion == Adhesion::BeyondTouch
    }

    /// Whether the cohesion model does that, which beyond touch acts alone.
    pub(crate) fn parts(&self) -> bool {
        self.parts
    }

    /// Whether bodies of such an overlap \[m\] are apart, and the cohesion model acts alone.
    fn is_apart(&self, overlap: f64) -> bool {
        self.parts && overlap < 0.0
    }

    /// Whether its force can be taken from the overlap beyond an offset, as contacts need that a bond suppresses: where it is a
    /// spring's that does not remember, and nothing else remembers or acts beyond touch.
    pub fn takes_offset(&self) -> bool {
        self.presses() && !self.parts && self.history_places.cohesion.is_none()
    }

    /// How far beyond touch bodies of this effective radius hold together \[m\].
    pub fn reach(&self, row: &[f64], radius: f64) -> f64 {
        if self.parts {
            return (self.cohesion().reach)(&row[self.places.cohesion..], radius);
        }
        (self.normal().reach)(row, radius)
    }

    /// What is kept of each near pair: how far it holds together beyond touch, or what the normal model wants to know.
    pub fn pair_constant(&self, row: &[f64], radius: f64, mass: f64) -> f64 {
        if self.parts { self.reach(row, radius) } else { (self.normal().pair_constant)(row, radius, mass) }
    }

    /// Switches in a row of coefficients.
    fn switches(&self, row: &[f64]) -> Switches {
        Switches::read(&row[self.choice.normal.row().count..])
    }
}
