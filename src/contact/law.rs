//! Four sub-models as one law: the functions of each, called one after another on one contact.

use super::{
    Adhesion, CohesionForm, Contact, Friction, HistoryRow, Needs, NormalForce, NormalForm, Reaction, Response, Rolling,
    RollingStiffness, Switches, Tangential,
};
use super::{Coefficients, LawChoice};
use crate::contact::cohesion::TakeCohesion;
use crate::contact::normal::TakeNormal;
use crate::contact::rolling::TakeRolling;
use crate::contact::tangential::TakeTangential;
use crate::contact::{Cohesion, Normal};
use crate::number::{Row, Vector};

/// How much of a contact is left where a bond hides it, or has hidden it.
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Overlap beyond the offset: what the elastic force is taken from \[m\].
    pub pressing: f64,
    /// Whether the normal force acts. Friction sees it in either case.
    pub acts: bool,
    /// The contact of these bodies at an overlap of the offset alone.
    pub contact: Contact,
}

/// Normal force of coefficients, switches, contact, history and step, and what is to be remembered.
type NormalFunction = fn(&[f64], Switches, &Contact, Row, f64) -> (NormalForce, Row);

/// Rolling torque of coefficients, contact, normal force, history and step, and what is to be remembered.
type RollingFunction = fn(&[f64], &Contact, &NormalForce, Row, f64) -> (Vector, Row);

/// A normal model as functions of its coefficients.
#[derive(Clone, Copy)]
struct NormalModel {
    /// How many coefficients it has.
    count: usize,
    /// What it remembers.
    history: Option<HistoryRow>,
    /// What of a contact it looks at.
    needs: Needs,
    /// Whether it pulls.
    adhesion: Adhesion,
    /// Whether slip is that of the undeformed bodies.
    undeformed_arms: bool,
    /// Whether it keeps a number of each pair.
    has_pair_constant: bool,
    /// [`NormalForm::force`].
    force: NormalFunction,
    /// [`NormalForm::response`].
    response: fn(&[f64], &Contact) -> Response,
    /// [`NormalForm::pair_constant`].
    pair_constant: fn(&[f64], f64, f64) -> f64,
    /// [`NormalForm::elastic_energy`].
    elastic_energy: fn(&[f64], &Contact, f64, Row) -> f64,
    /// [`NormalForm::reach`].
    reach: fn(&[f64], f64) -> f64,
    /// [`NormalForm::tangent_stiffness`].
    tangent_stiffness: fn(&[f64], &Contact) -> f64,
}

impl NormalModel {
    /// That of a form.
    fn of<A: NormalForm>(undeformed_arms: bool) -> Self {
        Self {
            count: A::COUNT,
            history: A::HISTORY,
            needs: A::NEEDS,
            adhesion: A::ADHESION,
            undeformed_arms,
            has_pair_constant: A::HAS_PAIR_CONSTANT,
            force: |row, switches, contact, history, step| {
                let roots = A::roots(contact.overlap, contact.radius, contact.mass);
                A::force(A::lanes(row), switches, contact, roots, history, step)
            },
            response: |row, contact| A::response(A::lanes(row), contact),
            pair_constant: |row, radius, mass| A::read(row).pair_constant(radius, mass),
            elastic_energy: |row, contact, offset, history| A::read(row).elastic_energy(contact, offset, history),
            reach: |row, radius| A::read(row).reach(radius),
            tangent_stiffness: |row, contact| A::read(row).tangent_stiffness(contact),
        }
    }
}

/// A tangential model as functions of its coefficients.
#[derive(Clone, Copy)]
struct TangentialModel {
    /// How many coefficients it has.
    count: usize,
    /// Whether there is a force at all.
    active: bool,
    /// What it remembers.
    history: Option<HistoryRow>,
    /// Whether there is a spring.
    has_spring: bool,
    /// Whether there is a dashpot.
    has_dashpot: bool,
    /// [`Tangential::stiffness`].
    stiffness: fn(&[f64], f64) -> f64,
    /// [`Tangential::force`].
    force: fn(&[f64], &Contact, &NormalForce, Row, f64) -> Friction,
}

impl TangentialModel {
    /// That of a model.
    fn of<B: Tangential>() -> Self {
        Self {
            count: B::COUNT,
            active: B::ACTIVE,
            history: B::HISTORY,
            has_spring: B::HAS_SPRING,
            has_dashpot: B::HAS_DASHPOT,
            stiffness: |row, from_normal_model| B::read(row).stiffness(from_normal_model),
            force: |row, contact, normal, history, step| B::force(B::lanes(row), contact, normal, history, step),
        }
    }
}

/// A rolling model as functions of its coefficients.
#[derive(Clone, Copy)]
struct RollingModel {
    /// How many coefficients it has.
    count: usize,
    /// Whether there is a torque at all.
    active: bool,
    /// What it remembers.
    history: Option<HistoryRow>,
    /// What of a contact it looks at.
    needs: Needs,
    /// [`Rolling::stiffness`].
    stiffness: fn(&[f64], &Contact, &Response) -> RollingStiffness,
    /// [`Rolling::elastic_energy`].
    elastic_energy: fn(&[f64], &Contact, &Response, Row) -> f64,
    /// [`Rolling::torque`].
    torque: RollingFunction,
}

impl RollingModel {
    /// That of a model.
    fn of<C: Rolling>() -> Self {
        Self {
            count: C::COUNT,
            active: C::ACTIVE,
            history: C::HISTORY,
            needs: C::NEEDS,
            stiffness: |row, contact, response| C::read(row).stiffness(contact, response),
            elastic_energy: |row, contact, response, history| C::read(row).elastic_energy(contact, response, history),
            torque: |row, contact, normal, history, step| C::torque(C::lanes(row), contact, normal, history, step),
        }
    }
}

/// A cohesion model as functions of its coefficients.
#[derive(Clone, Copy)]
struct CohesionModel {
    /// How many coefficients it has.
    count: usize,
    /// Whether there is a force at all.
    active: bool,
    /// What of a contact it looks at.
    needs: Needs,
    /// [`CohesionForm::force`].
    force: fn(&[f64], &Contact) -> f64,
    /// [`CohesionForm::add`].
    add: fn(&[f64], f64, &mut NormalForce),
}

impl CohesionModel {
    /// That of a form.
    fn of<D: CohesionForm>() -> Self {
        Self {
            count: D::COUNT,
            active: D::ACTIVE,
            needs: D::NEEDS,
            force: |row, contact| D::force(D::lanes(row), contact),
            add: |row, pull, normal| D::add(D::lanes(row), pull, normal),
        }
    }
}

/// Goes from the name of a sub-model to its functions.
#[derive(Clone, Copy)]
struct Functions;

impl TakeNormal for Functions {
    type Output = NormalModel;
    fn take<M: Normal>(self, keys: &M::Keys) -> NormalModel {
        NormalModel::of::<M::Form>(M::has_undeformed_arms(keys))
    }
}

impl TakeTangential for Functions {
    type Output = TangentialModel;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> TangentialModel {
        TangentialModel::of::<M>()
    }
}

impl TakeRolling for Functions {
    type Output = RollingModel;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> RollingModel {
        RollingModel::of::<M>()
    }
}

impl TakeCohesion for Functions {
    type Output = CohesionModel;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> CohesionModel {
        CohesionModel::of::<M::Form>()
    }
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
}

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
}

impl Law {
    /// The law of these sub-models.
    pub fn of(choice: &LawChoice) -> Self {
        let (normal, tangential) = (choice.normal.visit(Functions), choice.tangential.visit(Functions));
        let (rolling, cohesion) = (choice.rolling.visit(Functions), choice.cohesion.visit(Functions));
        let mut history = Vec::new();
        let mut place = |row: Option<HistoryRow>| {
            row.map(|row| {
                history.push(row);
                history.len() - 1
            })
        };
        let history_places = HistoryPlaces {
            normal: place(normal.history),
            tangential: place(tangential.history),
            rolling: place(rolling.history),
        };
        let after_normal = normal.count + Switches::COUNT;
        let places = CoefficientPlaces {
            tangential: after_normal,
            rolling: after_normal + tangential.count,
            cohesion: after_normal + tangential.count + rolling.count,
            count: after_normal + tangential.count + rolling.count + cohesion.count,
        };
        Self { normal, tangential, rolling, cohesion, history, history_places, places }
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
        self.normal.needs.and(friction).and(self.rolling.needs).and(self.cohesion.needs).and(arms)
    }

    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms.
    pub fn undeformed_arms(&self) -> bool {
        self.normal.undeformed_arms && (self.tangential.active || self.rolling.active)
    }

    /// Whether bodies that have touched hold together beyond touch: as far as their pair constant says.
    pub fn holds_beyond_touch(&self) -> bool {
        self.normal.adhesion == Adhesion::BeyondTouch
    }

    /// Whether its force can be taken from the overlap beyond an offset, as contacts need that a bond hides: where it is a
    /// spring's that does not remember.
    pub fn takes_offset(&self) -> bool {
        self.normal.adhesion == Adhesion::None && self.normal.history.is_none()
    }

    /// How far beyond touch bodies of this effective radius hold together \[m\].
    pub fn reach(&self, row: &[f64], radius: f64) -> f64 {
        (self.normal.reach)(row, radius)
    }

    /// What is kept of each near pair ([`NormalForm::pair_constant`]).
    pub fn pair_constant(&self, row: &[f64], radius: f64, mass: f64) -> f64 {
        (self.normal.pair_constant)(row, radius, mass)
    }

    /// Switches in a row of coefficients.
    fn switches(&self, row: &[f64]) -> Switches {
        Switches::read(&row[self.normal.count..])
    }

    /// Force and torque of one contact; `history`, as many rows as [`Law::history`], is advanced by `step` \[s\].
    pub fn react(&self, row: &[f64], contact: &Contact, history: &mut [Row], step: f64) -> Reaction {
        let contact = &if self.undeformed_arms() { contact.with_undeformed_arms() } else { *contact };
        let (mut normal, remembered) = match self.history_places.normal {
            Some(place) => (self.normal.force)(row, self.switches(row), contact, history[place], step),
            None => (self.normal.force)(row, self.switches(row), contact, [0.0; 4], step),
        };
        if let Some(place) = self.history_places.normal {
            history[place] = remembered;
        }
        if self.cohesion.active {
            let row = &row[self.places.cohesion..];
            (self.cohesion.add)(row, (self.cohesion.force)(row, contact), &mut normal);
        }
        let (force, couple, sliding) = self.friction(row, contact, &normal, normal.force, history, step);
        let rolling = self.roll(row, contact, &normal, history, step);
        Reaction { force, couple, rolling, sliding }
    }

    /// The same of a contact that a bond hides, or has hidden. The elastic force is taken from the overlap beyond the
    /// offset, and attraction is what the offset's does not hold already, so that neither jumps when the bond is
    /// gone; stiffness and damping are those of the whole overlap. Where the normal force does not act, friction
    /// alone does.
    pub fn react_beyond(
        &self,
        row: &[f64],
        contact: &Contact,
        offset: &Offset,
        history: &mut [Row],
        step: f64,
    ) -> Reaction {
        let (mut response, switches) = ((self.normal.response)(row, contact), self.switches(row));
        response.tangential_damping *= switches.tangential_damping_factor;
        let elastic = response.normal_stiffness * offset.pressing;
        let force = (elastic - response.normal_damping * contact.normal_velocity).max(switches.least_force);
        let mut normal = NormalForce { response, force, seen: force };
        if self.cohesion.active {
            let row = &row[self.places.cohesion..];
            let pull = (self.cohesion.force)(row, contact) - (self.cohesion.force)(row, &offset.contact);
            (self.cohesion.add)(row, pull, &mut normal);
        }
        let along = if offset.acts { normal.force } else { 0.0 };
        let (force, couple, sliding) = self.friction(row, contact, &normal, along, history, step);
        let pressed = Contact { overlap: offset.pressing, ..*contact };
        let rolling = if offset.acts { self.roll(row, &pressed, &normal, history, step) } else { Vector::zero() };
        Reaction { force, couple, rolling, sliding }
    }

    /// Force on i of a normal force \[N\] and the friction beside it, n × F_t, and whether friction is at its limit.
    fn friction(
        &self,
        row: &[f64],
        contact: &Contact,
        normal: &NormalForce,
        along: f64,
        history: &mut [Row],
        step: f64,
    ) -> (Vector, Vector, bool) {
        let force = contact.normal * along;
        if !self.tangential.active {
            return (force, Vector::zero(), false);
        }
        let place = self.history_places.tangential;
        let before = place.map_or([0.0; 4], |place| history[place]);
        let friction = (self.tangential.force)(&row[self.places.tangential..], contact, normal, before, step);
        if let Some(place) = place {
            history[place] = friction.history;
        }
        (force + friction.force, contact.normal.cross(friction.force), friction.sliding)
    }

    /// Rolling torque from i to j.
    fn roll(&self, row: &[f64], contact: &Contact, normal: &NormalForce, history: &mut [Row], step: f64) -> Vector {
        if !self.rolling.active {
            return Vector::zero();
        }
        let place = self.history_places.rolling;
        let before = place.map_or([0.0; 4], |place| history[place]);
        let (torque, after) = (self.rolling.torque)(&row[self.places.rolling..], contact, normal, before, step);
        if let Some(place) = place {
            history[place] = after;
        }
        torque
    }

    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] and of the tangential and the rolling
    /// spring, where there are \[J\].
    pub fn elastic_energy(&self, row: &[f64], contact: &Contact, offset: f64, history: &[Row]) -> f64 {
        let of = |place: Option<usize>| place.and_then(|place| history.get(place).copied());
        let HistoryPlaces { normal, rolling, .. } = self.history_places;
        let mut energy = (self.normal.elastic_energy)(row, contact, offset, of(normal).unwrap_or_default());
        let response = (self.normal.response)(row, contact);
        if let Some(spring) = of(self.spring()).map(Vector::from) {
            let stiffness = (self.tangential.stiffness)(&row[self.places.tangential..], response.tangential_stiffness);
            energy += 0.5 * stiffness * spring.dot(spring);
        }
        if let Some(torque) = of(rolling) {
            energy += (self.rolling.elastic_energy)(&row[self.places.rolling..], contact, &response, torque);
        }
        energy
    }

    /// Stiffness of the rolling spring \[N m\].
    pub fn rolling_stiffness(&self, row: &[f64], contact: &Contact) -> RollingStiffness {
        let response = (self.normal.response)(row, contact);
        (self.rolling.stiffness)(&row[self.places.rolling..], contact, &response)
    }

    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\].
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
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::cohesion::{CohesionChoice, sjkr};
    use crate::contact::fixtures::{assert_close, contact, properties, with_pair};
    use crate::contact::normal::{NormalChoice, hooke_stiffness};
    use crate::contact::rolling::RollingChoice;
    use crate::contact::tangential::TangentialChoice;
    use crate::contact::{NoKeys, PairProperties};
    use crate::quantity::NonNegative;

    /// Friction without memory.
    const NO_HISTORY: TangentialChoice = TangentialChoice::NoHistory(NoKeys {});
    /// Friction with a spring.
    const HISTORY: TangentialChoice = TangentialChoice::History(NoKeys {});
    /// No friction.
    const SMOOTH: TangentialChoice = TangentialChoice::None(NoKeys {});

    /// Hooke with everything: k_n δ = 100/16384 N, γ_n v_n = −12 N (m* g_n = 24 kg/s, v_n = −½ m/s), c A = 21 N.
    fn whole(tangential: TangentialChoice, switches: Switches, tangential_reduce: bool) -> LawChoice {
        LawChoice {
            normal: NormalChoice::HookeStiffness(hooke_stiffness::Keys::default()),
            tangential,
            rolling: RollingChoice::Cdt(NoKeys {}),
            cohesion: CohesionChoice::Sjkr(sjkr::Keys { tangential_reduce }),
            switches,
        }
    }

    /// The law and its coefficients for the fixture's materials.
    fn law(choice: LawChoice) -> (Law, Vec<f64>) {
        (Law::of(&choice), with_pair(&properties(), |pair| choice.coefficients(pair)).unwrap())
    }

    /// What it does to the fixture's contact at this normal velocity.
    fn react(choice: LawChoice, normal_velocity: f64) -> Reaction {
        let (law, row) = law(choice);
        let mut history = vec![[0.0; 4]; law.history().len()];
        law.react(&row, &Contact { normal_velocity, ..contact() }, &mut history, 0.0)
    }

    /// k_n δ of the fixture's contact.
    const ELASTIC: f64 = 100.0 / 16384.0;

    #[test]
    fn pushes_i_along_the_normal_by_spring_and_dashpot_less_the_cohesion() {
        let reaction = react(whole(NO_HISTORY, Switches::of(false, true), false), -0.5);
        assert_close(reaction.force.z, ELASTIC + 12.0 - 21.0, 1e-15);
    }

    #[test]
    fn turns_both_bodies_by_the_couple_of_friction() {
        let reaction = react(whole(NO_HISTORY, Switches::of(false, true), false), -0.5);
        let friction = Vector::new(reaction.force.x, reaction.force.y, 0.0);
        assert_eq!(reaction.couple, Vector::new(-friction.y, friction.x, 0.0));
    }

    #[test]
    fn friction_sees_the_normal_force_without_cohesion_and_with_it_when_reduced() {
        // slip of 5 m/s is above the limit: γ_t = 12 kg/s
        let limit = |reduce, velocity| {
            let force = react(whole(NO_HISTORY, Switches::of(false, true), reduce), velocity).force;
            Vector::new(force.x, force.y, 0.0).length()
        };
        assert_close(limit(false, -0.5), 0.25 * (ELASTIC + 12.0), 1e-15);
        assert_close(limit(true, -0.5), 0.25 * (21.0 - 12.0 - ELASTIC), 1e-14);
        assert_close(limit(false, 0.5), 0.25 * (12.0 - ELASTIC), 1e-15);
    }

    #[test]
    fn limited_force_is_cut_before_friction_and_cohesion() {
        let reaction = react(whole(NO_HISTORY, Switches::of(true, true), false), 0.5);
        assert_eq!(reaction.force.to_array().map(f64::abs), [0.0, 0.0, 21.0]);
    }

    #[test]
    fn rolling_sees_the_spring_alone() {
        let reaction = react(whole(NO_HISTORY, Switches::of(true, true), true), 0.5);
        assert_close(reaction.rolling.y, 0.125 * ELASTIC * 0.25, 1e-15);
    }

    #[test]
    fn tangential_damping_can_be_switched_off() {
        let reaction = react(whole(NO_HISTORY, Switches::of(false, false), false), -0.5);
        assert_eq!([reaction.force.x.abs(), reaction.force.y.abs()], [0.0, 0.0]);
    }

    #[test]
    fn asks_only_for_properties_that_are_used() {
        let bare = PairProperties {
            normal_stiffness: NonNegative::new(1.0),
            normal_damping: NonNegative::new(1.0),
            ..PairProperties::default()
        };
        let choice = LawChoice {
            rolling: RollingChoice::None(NoKeys {}),
            cohesion: CohesionChoice::None(NoKeys {}),
            ..whole(SMOOTH, Switches::of(false, true), false)
        };
        assert!(with_pair(&bare, |pair| choice.coefficients(pair)).is_ok());
    }

    #[test]
    fn objects_to_reduced_friction_without_friction() {
        let objection = whole(SMOOTH, Switches::of(false, true), true).objection().unwrap();
        assert_eq!((objection.table, objection.key), ("cohesion", "tangential_reduce"));
        assert_eq!(whole(SMOOTH, Switches::of(false, true), false).objection(), None);
        assert_eq!(whole(NO_HISTORY, Switches::of(false, true), true).objection(), None);
    }

    #[test]
    fn objects_to_undamped_slip_without_a_spring() {
        let undamped = Switches::of(false, false);
        assert_eq!(whole(NO_HISTORY, undamped, false).objection().unwrap().key, "tangential_damping");
        assert_eq!(whole(HISTORY, undamped, false).objection(), None);
    }

    #[test]
    fn stiffness_leaves_out_what_does_not_act() {
        let (spring, row) = law(whole(HISTORY, Switches::of(false, false), false));
        let response = spring.stiffness(&row, &contact());
        assert_eq!([response.tangential_stiffness, response.tangential_damping], [50.0, 0.0]);
        let (dashpot, row) = law(whole(NO_HISTORY, Switches::of(false, true), false));
        let response = dashpot.stiffness(&row, &contact());
        assert_eq!([response.tangential_stiffness, response.tangential_damping], [0.0, 12.0]);
    }
}
