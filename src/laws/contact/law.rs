//! Four sub-models as one law: the functions of each, called one after another on one contact.

#[cfg(test)]
use super::pressing_force;
use super::{
    Adhesion, Booked, Carry, CoefficientPlaces, Coefficients, CohesionFunctions, Contact, HistoryPlaces, HistoryRow,
    LawChoice, LossKind, Needs, NormalForce, NormalFunctions, Onset, Reaction, Response, RollingFunctions,
    RollingResponse, Scheme, SchemeMemory, Switches, TangentialFunctions, Warming, foresee_normal,
};
use crate::base::number::{Row, Vector};

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

/// What records of contacts remember where dashpots see what cannot be found from the state: the velocity along the normal \[m/s\],
/// the weight of the dashpot across it, and 1.
const SEEN: HistoryRow = HistoryRow { name: "dashpots seen", odd: [false; 4], fourth_is_free: false };

/// The same where springs are carried: the velocity along the normal and the slip.
const SEEN_CARRIED: HistoryRow = HistoryRow { odd: [false, true, true, true], ..SEEN };

/// What a book of losses remembers of a contact: k_t \[N/m\] and the force of both dashpots on the first body \[N\] in the last
/// evaluation.
const LOADS: HistoryRow = HistoryRow { name: "dashpots before", odd: [false, true, true, true], fourth_is_free: false };

/// What it remembers where there is more: the normal force that is neither spring nor dashpot \[N\] and the rolling torque \[N m\].
const OTHER_LOADS: HistoryRow =
    HistoryRow { name: "other loads before", odd: [false, true, true, true], fourth_is_free: false };

/// What is remembered where losses warm the bodies: what the contact holds of them, along the normal and against rolling, as often as its
/// forces count \[J\].
const HELD: HistoryRow = HistoryRow { name: "energy held", odd: [false; 4], fourth_is_free: false };

/// What is remembered of an impact: loss along the normal and across it \[J\], largest normal force \[N\], duration so far \[s\].
const IMPACT: HistoryRow = HistoryRow { name: "impact", odd: [false; 4], fourth_is_free: false };

/// How it began: speeds along the normal and across it \[m/s\], and whether it has begun.
const TOUCH: HistoryRow = HistoryRow { name: "touch", ..IMPACT };

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
    /// The same law, of whose contacts a book of losses remembers more: the rows stand behind all others.
    pub fn booked(mut self) -> Self {
        self.history_places.loads = Some(self.history.len());
        self.history.push(LOADS);
        if self.has_rolling() || self.has_other_force() {
            self.history_places.other_loads = Some(self.history.len());
            self.history.push(OTHER_LOADS);
        }
        self
    }

    /// The same law, of which these losses warm the bodies: work against attraction does not, for it comes back.
    pub fn warming(mut self, mut warming: Warming) -> Self {
        warming[LossKind::Other as usize] &= self.is_plastic();
        self.warming = warming;
        if self.holds().contains(&true) {
            self.history_places.held = Some(self.history.len());
            self.history.push(HELD);
        }
        self
    }

    /// Whether its plastic normal force, and whether its rolling spring, holds part of what warms the bodies.
    fn holds(&self) -> [bool; 2] {
        let rolls = self.choice.rolling.row().history().is_some();
        [self.warming[LossKind::Other as usize], self.warming[LossKind::Rolling as usize] && rolls]
    }

    /// What a contact holds of losses that warm the bodies, along the normal and against rolling \[J\].
    pub(crate) fn held(&self, row: &[f64], contact: &Contact, history: &[Row]) -> [f64; 2] {
        let [plastic, rolling] = self.holds();
        let plastic = if plastic { self.normal_energy(row, contact, 0.0, history) } else { 0.0 };
        [plastic, if rolling { self.rolling_energy(row, contact, history) } else { 0.0 }]
    }

    /// The same law, of whose contacts records show exactly what the last evaluation saw.
    pub fn recorded(mut self) -> Self {
        let carries = self.scheme().carries();
        if carries || self.history_places.normal_velocity.is_some() {
            self.history_places.seen = Some(self.history.len());
            self.history.push(if carries { SEEN_CARRIED } else { SEEN });
        }
        self
    }

    /// The same law, whose contacts are followed one by one from touch to parting.
    pub fn followed(mut self) -> Self {
        self.history_places.impact = Some(self.history.len());
        self.history.extend([IMPACT, TOUCH]);
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

    /// What a book of losses has to know of it.
    pub(crate) fn booking(&self) -> Booked {
        let (friction, carries) = (self.tangential(), self.scheme().carries());
        Booked {
            friction: self.has_friction(),
            spring: friction.has_spring,
            keeps_stiffness: friction.keeps_stiffness,
            limits_dashpot: friction.limits_dashpot,
            projects: friction.projects && !carries,
            rolling: self.has_rolling(),
            presses: self.presses(),
            other: self.has_other_force(),
            carries,
            predicts_normal_alone: self.history_places.normal_velocity.is_some(),
            least_force: self.choice.normal.row().count,
            warming: self.warming,
            follows: self.history_places.impact.is_some(),
        }
    }

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

    /// Force and torque of one contact; `history`, as many rows as [`Law::history`], is advanced by `step` \[s\]. The velocities
    /// of `contact` become those that its dashpots see.
    pub fn react(&self, row: &[f64], contact: &mut Contact, history: &mut [Row], step: f64) -> Reaction {
        let (carry, weight) = self.carry(contact, history, step);
        let normal = self.press(row, contact, history, (step, weight));
        if self.is_apart(contact.overlap) {
            self.history_places.of_touch().for_each(|place| history[place] = [0.0; 4]);
            let nothing = Vector::zero();
            return Reaction {
                force: contact.normal * normal.force,
                couple: nothing,
                rolling: nothing,
                sliding: false,
            };
        }
        let along = (&normal, normal.force);
        let (force, couple, sliding) = self.friction(row, contact, along, history, (step, &carry));
        let rolling = self.roll(row, contact, &normal, history, (step, &carry));
        Reaction { force, couple, rolling, sliding }
    }

    /// The normal force of one contact that was carried, with this weight of γ_t.
    fn press(&self, row: &[f64], contact: &Contact, history: &mut [Row], (step, weight): (f64, f64)) -> NormalForce {
        let HistoryPlaces { normal: own, cohesion, .. } = self.history_places;
        let mut none = [0.0; 4];
        let remembered = own.map_or(&mut none, |place| &mut history[place]);
        let mut normal = (self.normal().force)(row, contact, remembered, step);
        normal.response.tangential_damping *= weight;
        if self.has_cohesion() {
            let mut none = [0.0; 4];
            let remembered = cohesion.map_or(&mut none, |place| &mut history[place]);
            (self.cohesion().pull)(&row[self.places.cohesion..], contact, remembered, step, &mut normal);
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
        let (response, switches) = ((self.normal().response)(row, contact), self.switches(row));
        let mut normal = pressing_force(response, switches, offset.pressing, contact.normal_velocity);
        normal.response.tangential_damping *= weight;
        if self.has_cohesion() {
            let (row, cohesion) = (&row[self.places.cohesion..], self.cohesion());
            let pull = (cohesion.force)(row, contact) - (cohesion.force)(row, &offset.contact);
            (cohesion.add)(row, pull, &mut normal);
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
    fn carry(&self, contact: &mut Contact, history: &mut [Row], step: f64) -> (Option<Carry>, f64) {
        if self.undeformed_arms() {
            *contact = contact.with_undeformed_arms();
        }
        if let Some(place) = self.history_places.normal_velocity {
            let foreseen = foresee_normal(contact, history[place][3], self.onset(), step);
            history[place][3] = foreseen.middle;
            if let Some(place) = self.history_places.seen {
                history[place] = [contact.normal_velocity, foreseen.weight, 1.0, 0.0];
            }
            return (None, foreseen.weight);
        }
        if !self.scheme().carries() {
            return (None, 1.0);
        }
        let carry = Carry::of(contact, step, !self.pulls_beyond_touch());
        let mut rates = [contact.normal_velocity, 0.0];
        if let Some(place) = self.history_places.rates {
            let before = history[place][0];
            history[place] = carry.foresee(contact, history[place], step);
            rates = [history[place][0], before];
        }
        carry.weigh(contact, self.onset(), step, rates);
        if let Some(place) = self.history_places.seen {
            let Vector { x, y, z } = contact.slip;
            history[place] = [contact.normal_velocity, x, y, z];
        }
        (Some(carry), 1.0)
    }

    /// Force on i of a normal force \[N\] and the friction beside it, n × F_t, and whether friction is at its limit.
    fn friction(
        &self,
        row: &[f64],
        contact: &Contact,
        (normal, along): (&NormalForce, f64),
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> (Vector, Vector, bool) {
        let force = contact.normal * along;
        if !self.has_friction() {
            return (force, Vector::zero(), false);
        }
        let mut none = [0.0; 4];
        let remembered = self.history_places.tangential.map_or(&mut none, |place| &mut history[place]);
        if let Some(carry) = carry.as_ref().filter(|_| self.tangential().has_spring) {
            (*remembered, step) = (carry.spring(contact.normal, *remembered), 0.0);
        }
        let row = &row[self.places.tangential..];
        let (friction, sliding) = (self.tangential().force)(row, contact, normal, remembered, step);
        (force + friction, contact.normal.cross(friction), sliding)
    }

    /// Rolling torque from i to j.
    fn roll(
        &self,
        row: &[f64],
        contact: &Contact,
        normal: &NormalForce,
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> Vector {
        if !self.has_rolling() {
            return Vector::zero();
        }
        let place = self.history_places.rolling;
        let mut none = [0.0; 4];
        let remembered = place.map_or(&mut none, |place| &mut history[place]);
        let (mut contact, mut pressed) = (*contact, *normal);
        let carry = carry.as_ref().filter(|_| place.is_some());
        if let Some(carry) = carry {
            pressed = carry.mean_stiffness(normal, remembered[3]);
            *remembered = carry.torque(contact.normal, *remembered);
            (contact.relative_spin, step) = (carry.to_end(contact.normal, contact.relative_spin), step * carry.share);
        }
        let torque = (self.rolling().torque)(&row[self.places.rolling..], &contact, &pressed, remembered, step);
        if carry.is_some() {
            remembered[3] = normal.response.normal_stiffness;
        }
        torque
    }

    /// Stiffnesses and damping coefficients of the normal model: none where bodies are apart.
    fn response(&self, row: &[f64], contact: &Contact) -> Response {
        if self.is_apart(contact.overlap) { Response::NONE } else { (self.normal().response)(row, contact) }
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] and of the tangential and the rolling
    /// spring, where there are \[J\].
    pub fn elastic_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        let of = |place: Option<usize>| place.and_then(|place| history.get(place).copied());
        let mut energy = self.normal_energy(row, contact, offset, history);
        if let Some(spring) = of(self.spring()).map(Vector::from) {
            let from_normal_model = self.response(row, contact).tangential_stiffness;
            let stiffness = (self.tangential().stiffness)(&row[self.places.tangential..], from_normal_model);
            energy += 0.5 * stiffness * spring.dot(spring);
        }
        energy + self.rolling_energy(row, contact, history)
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] \[J\].
    pub fn normal_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        if self.is_apart(contact.overlap) {
            return 0.0;
        }
        let own = self.history_places.normal.and_then(|place| history.get(place).copied());
        (self.normal().elastic_energy)(row, contact, offset, own.unwrap_or_default())
    }

    /// Elastic energy of the rolling spring, where there is one \[J\].
    pub fn rolling_energy(&self, row: &[f64], contact: &Contact, history: &[Row]) -> f64 {
        let Some(&torque) = self.history_places.rolling.and_then(|place| history.get(place)) else { return 0.0 };
        let response = self.response(row, contact);
        (self.rolling().elastic_energy)(&row[self.places.rolling..], contact, &response, torque)
    }

    /// Springs and dashpots against rolling and twisting.
    pub fn rolling_response(&self, row: &[f64], contact: &Contact) -> RollingResponse {
        let response = self.response(row, contact);
        (self.rolling().response)(&row[self.places.rolling..], contact, &response)
    }

    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\], for the stable time step:
    /// the coefficients as the scheme makes them count.
    pub fn stiffness(&self, row: &[f64], contact: &Contact) -> Response {
        let mut response = self.response(row, contact);
        if !self.is_apart(contact.overlap) {
            response.normal_stiffness = (self.normal().tangent_stiffness)(row, contact);
        }
        response.tangential_stiffness = match self.tangential().has_spring {
            true => (self.tangential().stiffness)(&row[self.places.tangential..], response.tangential_stiffness),
            false => 0.0,
        };
        if !self.tangential().has_dashpot || !self.switches(row).damps_slip() {
            response.tangential_damping = 0.0;
        }
        let own = &row[self.places.tangential..];
        response.tangential_damping = (self.tangential().damping)(own, response.tangential_damping);
        let [normal, tangential] = self.scheme().damping_factors();
        response.normal_damping *= normal;
        response.tangential_damping *= tangential;
        response
    }
}

#[cfg(test)]
mod tests;
