//! Four sub-models as one law: the functions of each, called one after another on one contact.

mod functions;

#[cfg(test)]
use super::pressing_force;
use super::{
    Adhesion, Booked, Carry, Coefficients, Contact, HistoryRow, LawChoice, Needs, NormalForce, Onset, Reaction,
    Response, RollingStiffness, Scheme, SchemeMemory, Switches, foresee_normal,
};
use crate::number::{Row, Vector};
use functions::{CohesionModel, Functions, NormalModel, RollingModel, TangentialModel};

/// What is kept of a contact beside what its law remembers, where bonds suppress contacts: the force on the first body in
/// the last evaluation, if the contact was then suppressed \[N\], and the overlap from which its normal force is taken \[m\].
pub const OFFSET: HistoryRow = HistoryRow { name: "offset", odd: [true, true, true, false], fourth_is_free: false };

/// How much of a contact is left where a bond suppresses it, or has suppressed it.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Overlap beyond the offset: what the elastic force is taken from \[m\].
    pub pressing: f64,
    /// Whether the normal force acts. Friction sees it in either case.
    pub acts: bool,
    /// The contact of these bodies at an overlap of the offset alone.
    pub contact: Contact,
}

/// Which row of what a law remembers is that of each sub-model, for those that remember anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HistoryPlaces {
    /// The normal model's.
    pub normal: Option<usize>,
    /// The tangential model's.
    pub tangential: Option<usize>,
    /// The rolling model's.
    pub rolling: Option<usize>,
    /// The scheme's: velocities before.
    pub rates: Option<usize>,
    /// Whose fourth number is the scheme's: the velocity along the normal before.
    pub normal_velocity: Option<usize>,
    /// Of records: [`SEEN`].
    pub seen: Option<usize>,
    /// Of a book of losses: [`LOADS`].
    pub loads: Option<usize>,
    /// Of a book of losses: [`OTHER_LOADS`].
    pub other_loads: Option<usize>,
}

/// What records of contacts remember where dashpots see what cannot be found from the state: the velocity along the normal \[m/s\],
/// the weight of the dashpot across it, and 1.
const SEEN: HistoryRow = HistoryRow { name: "dashpots seen", odd: [false; 4], fourth_is_free: false };

/// What a book of losses remembers of a contact: k_t \[N/m\] and the force of both dashpots on the first body \[N\] in the last
/// evaluation.
const LOADS: HistoryRow = HistoryRow { name: "dashpots before", odd: [false, true, true, true], fourth_is_free: false };

/// What it remembers where there is more: the normal force that is neither spring nor dashpot \[N\] and the rolling torque \[N m\].
const OTHER_LOADS: HistoryRow =
    HistoryRow { name: "other loads before", odd: [false, true, true, true], fourth_is_free: false };

/// Where the coefficients of each sub-model begin in a row of a law's; those of the normal model and the switches stand
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoefficientPlaces {
    /// The tangential model's.
    pub tangential: usize,
    /// The rolling model's.
    pub rolling: usize,
    /// The cohesion model's.
    pub cohesion: usize,
    /// How many there are in all.
    pub count: usize,
}

/// A contact law: what the four sub-models that the scene named do to one contact.
#[derive(Clone)]
pub struct Law {
    /// Normal sub-model.
    normal: NormalModel,
    /// Tangential sub-model.
    tangential: TangentialModel,
    /// Rolling sub-model.
    rolling: RollingModel,
    /// Cohesion sub-model.
    cohesion: CohesionModel,
    /// What it remembers of a contact.
    history: Vec<HistoryRow>,
    /// Whose each of those rows is.
    history_places: HistoryPlaces,
    /// Where coefficients stand.
    places: CoefficientPlaces,
    /// How springs and dashpots go on in time.
    scheme: Scheme,
    /// What the scene named.
    choice: LawChoice,
}

impl Law {
    /// The same law, of whose contacts a book of losses remembers more: the rows stand behind all others.
    pub fn booked(mut self) -> Self {
        self.history_places.loads = Some(self.history.len());
        self.history.push(LOADS);
        if self.rolling.active || self.has_other_force() {
            self.history_places.other_loads = Some(self.history.len());
            self.history.push(OTHER_LOADS);
        }
        self
    }

    /// The same law, of whose contacts records show exactly what the last evaluation saw.
    pub fn recorded(mut self) -> Self {
        if self.history_places.normal_velocity.is_some() {
            self.history_places.seen = Some(self.history.len());
            self.history.push(SEEN);
        }
        self
    }

    /// Whether its losses are booked.
    pub fn is_booked(&self) -> bool {
        self.history_places.loads.is_some()
    }

    /// What the scene named.
    pub fn choice(&self) -> &LawChoice {
        &self.choice
    }

    /// Whether part of the normal force is neither the spring nor the dashpot of a pressed contact.
    pub fn has_other_force(&self) -> bool {
        self.cohesion.active || !self.takes_offset()
    }

    /// Whether normal forces depend on what was before.
    pub fn is_plastic(&self) -> bool {
        self.normal.history.is_some()
    }

    /// What a book of losses has to know of it.
    pub(crate) fn booking(&self) -> Booked {
        let carries = self.scheme.carries();
        Booked {
            friction: self.tangential.active,
            spring: self.tangential.has_spring,
            keeps_stiffness: self.tangential.keeps_stiffness,
            limits_dashpot: self.tangential.limits_dashpot,
            projects: self.tangential.projects && !carries,
            rolling: self.rolling.active,
            presses: self.takes_offset(),
            other: self.has_other_force(),
            carries,
            predicts_normal_alone: self.history_places.normal_velocity.is_some(),
            least_force: self.normal.count,
        }
    }

    /// The law of these sub-models.
    pub fn of(choice: &LawChoice) -> Self {
        let (normal, tangential) = (choice.normal.visit(Functions), choice.tangential.visit(Functions));
        let (rolling, cohesion) = (choice.rolling.visit(Functions), choice.cohesion.visit(Functions));
        let mut history: Vec<HistoryRow> = Vec::new();
        let mut place = |row: Option<HistoryRow>| {
            row.map(|row| {
                history.push(row);
                history.len() - 1
            })
        };
        let mut history_places = HistoryPlaces {
            normal: place(normal.history),
            tangential: place(tangential.history),
            rolling: place(rolling.history),
            ..HistoryPlaces::default()
        };
        match choice.scheme.memory() {
            SchemeMemory::Nothing => {}
            SchemeMemory::Row(row) => history_places.rates = place(Some(row)),
            SchemeMemory::FourthNumber(row) => {
                let free = history.iter().position(|row| row.fourth_is_free);
                history_places.normal_velocity = Some(free.unwrap_or(history.len()));
                history.extend(free.is_none().then_some(row));
            }
        }
        let after_normal = normal.count + Switches::COUNT;
        let places = CoefficientPlaces {
            tangential: after_normal,
            rolling: after_normal + tangential.count,
            cohesion: after_normal + tangential.count + rolling.count,
            count: after_normal + tangential.count + rolling.count + cohesion.count,
        };
        Self {
            normal,
            tangential,
            rolling,
            cohesion,
            history,
            history_places,
            places,
            scheme: choice.scheme,
            choice: *choice,
        }
    }

    /// Where the coefficients of each sub-model stand in a row of them.
    pub fn places(&self) -> CoefficientPlaces {
        self.places
    }

    /// What it remembers of a contact: rows of four numbers, normal model first, then tangential and rolling model.
    pub fn history(&self) -> &[HistoryRow] {
        &self.history
    }

    /// Whose each row of the history is.
    pub fn history_places(&self) -> HistoryPlaces {
        self.history_places
    }

    /// Which row of the history is the tangential spring, if there is one.
    pub fn spring(&self) -> Option<usize> {
        self.history_places.tangential.filter(|_| self.tangential.has_spring)
    }

    /// Whether the limit of friction is put to spring and dashpot together.
    pub fn limits_dashpot(&self) -> bool {
        self.tangential.limits_dashpot
    }

    /// Whether a number is kept of each near pair.
    pub fn has_pair_constant(&self) -> bool {
        self.normal.has_pair_constant
    }

    /// Whether bodies feel friction from it.
    pub fn has_friction(&self) -> bool {
        self.tangential.active
    }

    /// Whether bodies feel rolling torque from it.
    pub fn has_rolling(&self) -> bool {
        self.rolling.active
    }

    /// Whether there is an attraction beside the normal model's own.
    pub fn has_cohesion(&self) -> bool {
        self.cohesion.active
    }

    /// What of a contact its sub-models look at.
    pub fn needs(&self) -> Needs {
        let friction = Needs { torque: self.tangential.active, ..Needs::NONE };
        let arms = self.undeformed_arms();
        let arms = Needs { bodies: arms, spin_sum: arms, ..Needs::NONE };
        let carry = Needs { carry: self.scheme.carries(), ..Needs::NONE };
        self.normal.needs.and(friction).and(self.rolling.needs).and(self.cohesion.needs).and(arms).and(carry)
    }

    /// How springs and dashpots go on in time.
    pub fn scheme(&self) -> Scheme {
        self.scheme
    }

    /// How dashpots begin.
    pub(crate) fn onset(&self) -> Onset {
        self.normal.onset
    }

    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms.
    pub fn undeformed_arms(&self) -> bool {
        self.normal.undeformed_arms && (self.tangential.active || self.rolling.active)
    }

    /// Whether bodies that have touched hold together beyond touch: as far as their pair constant says.
    pub fn holds_beyond_touch(&self) -> bool {
        self.normal.adhesion == Adhesion::BeyondTouch
    }

    /// Whether its force can be taken from the overlap beyond an offset, as contacts need that a bond suppresses: where it is a
    /// spring's that does not remember.
    pub fn takes_offset(&self) -> bool {
        self.normal.adhesion == Adhesion::None && self.normal.history.is_none()
    }

    /// How far beyond touch bodies of this effective radius hold together \[m\].
    pub fn reach(&self, row: &[f64], radius: f64) -> f64 {
        (self.normal.reach)(row, radius)
    }

    /// What is kept of each near pair, as the normal sub-model says.
    pub fn pair_constant(&self, row: &[f64], radius: f64, mass: f64) -> f64 {
        (self.normal.pair_constant)(row, radius, mass)
    }

    /// Switches in a row of coefficients.
    fn switches(&self, row: &[f64]) -> Switches {
        Switches::read(&row[self.normal.count..])
    }

    /// Force and torque of one contact; `history`, as many rows as [`Law::history`], is advanced by `step` \[s\]. The velocities
    /// of `contact` become those that its dashpots see.
    #[inline(always)]
    pub fn react(&self, row: &[f64], contact: &mut Contact, history: &mut [Row], step: f64) -> Reaction {
        let (carry, weight) = self.carry(contact, history, step);
        let normal = self.press(row, contact, history, (step, weight));
        let along = (&normal, normal.force);
        let (force, couple, sliding) = self.friction(row, contact, along, history, (step, &carry));
        let rolling = self.roll(row, contact, &normal, history, (step, &carry));
        Reaction { force, couple, rolling, sliding }
    }

    /// The normal force of one contact that was carried, with this weight of γ_t.
    #[inline(always)]
    pub(crate) fn press(
        &self,
        row: &[f64],
        contact: &Contact,
        history: &mut [Row],
        (step, weight): (f64, f64),
    ) -> NormalForce {
        let mut none = [0.0; 4];
        let remembered = match self.history_places.normal {
            Some(place) => &mut history[place],
            None => &mut none,
        };
        let mut normal = (self.normal.force)(row, contact, remembered, step);
        normal.response.tangential_damping *= weight;
        if self.cohesion.active {
            (self.cohesion.pull)(&row[self.places.cohesion..], contact, &mut normal);
        }
        normal
    }

    /// The same of a contact that a bond suppresses, or has suppressed. The elastic force is taken from the overlap beyond the
    /// offset, and attraction is what the offset's does not hold already, so that neither jumps when the bond is
    /// gone; stiffness and damping are those of the whole overlap. Where the normal force does not act, friction
    /// alone does. For tests: what batches of such contacts are compared with.
    #[cfg(test)]
    pub fn react_beyond(
        &self,
        row: &[f64],
        contact: &Contact,
        offset: &Offset,
        history: &mut [Row],
        step: f64,
    ) -> Reaction {
        let mut contact = *contact;
        let (carry, weight) = self.carry(&mut contact, history, step);
        let contact = &contact;
        let (response, switches) = ((self.normal.response)(row, contact), self.switches(row));
        let mut normal = pressing_force(response, switches, offset.pressing, contact.normal_velocity);
        normal.response.tangential_damping *= weight;
        if self.cohesion.active {
            let row = &row[self.places.cohesion..];
            let pull = (self.cohesion.force)(row, contact) - (self.cohesion.force)(row, &offset.contact);
            (self.cohesion.add)(row, pull, &mut normal);
        }
        let along = if offset.acts { normal.force } else { 0.0 };
        let (force, couple, sliding) = self.friction(row, contact, (&normal, along), history, (step, &carry));
        let pressed = Contact { overlap: offset.pressing, ..*contact };
        let rolling =
            if offset.acts { self.roll(row, &pressed, &normal, history, (step, &carry)) } else { Vector::zero() };
        Reaction { force, couple, rolling, sliding }
    }

    /// How a contact was carried, where the scheme asks for it, and a weight of γ_t; it gets the velocities that dashpots see, and the
    /// slip of undeformed bodies where the law takes that.
    #[inline(always)]
    pub(crate) fn carry(&self, contact: &mut Contact, history: &mut [Row], step: f64) -> (Option<Carry>, f64) {
        if self.undeformed_arms() {
            *contact = contact.with_undeformed_arms();
        }
        let one = 1.0;
        if let Some(place) = self.history_places.normal_velocity {
            let foreseen = foresee_normal(contact, history[place][3], self.normal.onset, step);
            history[place][3] = foreseen.middle;
            if let Some(place) = self.history_places.seen {
                history[place] = [contact.normal_velocity, foreseen.weight, one, 0.0];
            }
            return (None, foreseen.weight);
        }
        if !self.scheme.carries() {
            return (None, one);
        }
        let carry = Carry::of(contact, step, !self.holds_beyond_touch());
        let mut rates = [contact.normal_velocity, 0.0];
        if let Some(place) = self.history_places.rates {
            let before = history[place][0];
            history[place] = carry.foresee(contact, history[place], step);
            rates = [history[place][0], before];
        }
        carry.weigh(contact, self.normal.onset, step, rates);
        (Some(carry), one)
    }

    /// Force on i of a normal force \[N\] and the friction beside it, n × F_t, and whether friction is at its limit.
    #[inline(always)]
    fn friction(
        &self,
        row: &[f64],
        contact: &Contact,
        (normal, along): (&NormalForce, f64),
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> (Vector, Vector, bool) {
        let force = contact.normal * along;
        if !self.tangential.active {
            return (force, Vector::zero(), false);
        }
        let mut none = [0.0; 4];
        let remembered = match self.history_places.tangential {
            Some(place) => &mut history[place],
            None => &mut none,
        };
        if let Some(carry) = carry.as_ref().filter(|_| self.tangential.has_spring) {
            (*remembered, step) = (carry.spring(contact.normal, *remembered), 0.0);
        }
        let row = &row[self.places.tangential..];
        let (friction, sliding) = (self.tangential.force)(row, contact, normal, remembered, step);
        (force + friction, contact.normal.cross(friction), sliding)
    }

    /// Rolling torque from i to j.
    #[inline(always)]
    fn roll(
        &self,
        row: &[f64],
        contact: &Contact,
        normal: &NormalForce,
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> Vector {
        if !self.rolling.active {
            return Vector::zero();
        }
        let place = self.history_places.rolling;
        let mut none = [0.0; 4];
        let remembered = match place {
            Some(place) => &mut history[place],
            None => &mut none,
        };
        let (mut contact, mut pressed) = (*contact, *normal);
        let carry = carry.as_ref().filter(|_| place.is_some());
        if let Some(carry) = carry {
            pressed = carry.mean_stiffness(normal, remembered[3]);
            *remembered = carry.torque(contact.normal, *remembered);
            (contact.relative_spin, step) = (carry.to_end(contact.normal, contact.relative_spin), step * carry.share);
        }
        let torque = (self.rolling.torque)(&row[self.places.rolling..], &contact, &pressed, remembered, step);
        if carry.is_some() {
            remembered[3] = normal.response.normal_stiffness;
        }
        torque
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] and of the tangential and the rolling
    /// spring, where there are \[J\].
    pub fn elastic_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        let of = |place: Option<usize>| place.and_then(|place| history.get(place).copied());
        let mut energy = self.normal_energy(row, contact, offset, history);
        let response = (self.normal.response)(row, contact);
        if let Some(spring) = of(self.spring()).map(Vector::from) {
            let stiffness = (self.tangential.stiffness)(&row[self.places.tangential..], response.tangential_stiffness);
            energy += 0.5 * stiffness * spring.dot(spring);
        }
        energy + self.rolling_energy(row, contact, history)
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] \[J\].
    pub fn normal_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        let own = self.history_places.normal.and_then(|place| history.get(place).copied());
        (self.normal.elastic_energy)(row, contact, offset, own.unwrap_or_default())
    }

    /// Elastic energy of the rolling spring, where there is one \[J\].
    pub fn rolling_energy(&self, row: &[f64], contact: &Contact, history: &[Row]) -> f64 {
        let Some(&torque) = self.history_places.rolling.and_then(|place| history.get(place)) else { return 0.0 };
        let response = (self.normal.response)(row, contact);
        (self.rolling.elastic_energy)(&row[self.places.rolling..], contact, &response, torque)
    }

    /// Stiffness of the rolling spring \[N m\].
    pub fn rolling_stiffness(&self, row: &[f64], contact: &Contact) -> RollingStiffness {
        let response = (self.normal.response)(row, contact);
        (self.rolling.stiffness)(&row[self.places.rolling..], contact, &response)
    }

    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\], for the stable time step:
    /// the coefficients as the scheme makes them count.
    pub fn stiffness(&self, row: &[f64], contact: &Contact) -> Response {
        let mut response = (self.normal.response)(row, contact);
        response.normal_stiffness = (self.normal.tangent_stiffness)(row, contact);
        response.tangential_stiffness = match self.tangential.has_spring {
            true => (self.tangential.stiffness)(&row[self.places.tangential..], response.tangential_stiffness),
            false => 0.0,
        };
        if !self.tangential.has_dashpot || !self.switches(row).damps_slip() {
            response.tangential_damping = 0.0;
        }
        let [normal, tangential] = self.scheme.damping_factors();
        response.normal_damping *= normal;
        response.tangential_damping *= tangential;
        response
    }
}

#[cfg(test)]
mod tests;
