//! Four sub-models as one law.

use super::{
    Beyond, Coefficients, Cohesion, CohesionForm, Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm,
    Reaction, Response, Rolling, Roots, Tangential, coefficients,
};
use crate::number::{Number, Vector};

coefficients! {
    /// Switches that every normal model takes, as numbers so that the loop has no branch.
    pub struct Switches {
        /// Lower bound of the normal force \[N\]: −∞, or 0 with `limit_force`.
        least_force,
        /// Factor on γ_t: 1, or 0 without `tangential_damping`.
        tangential_damping_factor,
    }
}

impl Switches {
    /// With or without an attractive end of contact, with or without tangential damping.
    pub fn of(limit_force: bool, tangential_damping: bool) -> Self {
        Self::new(if limit_force { 0.0 } else { f64::NEG_INFINITY }, if tangential_damping { 1.0 } else { 0.0 })
    }

    /// Whether γ_t acts.
    pub fn damps_slip(&self) -> bool {
        self.tangential_damping_factor != 0.0
    }
}

/// Why sub-models and switches do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The table of the key below `[contact.<law>]`: empty, or the kind of sub-model.
    pub table: &'static str,
    /// The key to change.
    pub key: &'static str,
    /// What was found and what would be right.
    pub reason: &'static str,
}

/// A contact law, whole: what the pass in the time step is generic over.
pub trait Law: Send + Sync + 'static {
    /// How many coefficients a pair of materials has.
    const COUNT: usize;
    /// Whether a pair constant is kept for each near pair.
    const HAS_PAIR_CONSTANT: bool;
    /// Whether [`Law::roots`] says anything.
    const HAS_ROOTS: bool;
    /// Whether bodies feel torque from it.
    const HAS_TORQUE: bool;
    /// Whether bodies feel rolling torque from it.
    const HAS_ROLLING: bool;
    /// Whether a tangential spring is carried.
    const HAS_SPRING: bool;
    /// Whether [`Contact::section_area`] and [`Contact::section_radius`] are looked at.
    const HAS_SECTION: bool;
    /// What speaks against this law, if anything.
    fn objection(&self) -> Option<Objection>;
    /// The coefficients of two materials, [`Law::COUNT`] of them.
    fn row(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing>;
    /// The pair constant of [`NormalForm::pair_constant`].
    fn pair_constant(row: &[f64], radius: f64, mass: f64) -> f64;
    /// What the loop finds ahead: [`NormalForm::roots`].
    fn roots<N: Number>(overlap: N, radius: N, mass: N) -> Roots<N>;
    /// Force and torque of one contact whose roots are known.
    fn react_at<N: Number>(row: &[N], contact: &Contact<N>, roots: Roots<N>, spring: Vector<N>, step: N)
    -> Reaction<N>;
    /// Force and torque of one contact.
    #[inline(always)]
    fn react<N: Number>(row: &[N], contact: &Contact<N>, spring: Vector<N>, step: N) -> Reaction<N> {
        let roots = Self::roots(contact.overlap, contact.radius, contact.mass);
        Self::react_at(row, contact, roots, spring, step)
    }
    /// The same of a contact that a bond hides, or has hidden. The elastic force is taken from the overlap beyond the
    /// offset, and attraction is what the offset's does not hold already, so that neither jumps when the bond is
    /// gone; stiffness and damping are those of the whole overlap. Where the normal force does not act, friction
    /// alone does.
    fn react_beyond(row: &[f64], contact: &Contact, beyond: &Beyond, spring: Vector, step: f64) -> Reaction;
    /// Elastic energy of the normal force beyond an offset of the overlap \[m\] and of the tangential spring \[m\],
    /// where there is one \[J\].
    fn elastic_energy(row: &[f64], contact: &Contact, offset: f64, spring: Vector) -> f64;
    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\].
    fn stiffness(row: &[f64], contact: &Contact) -> Response;
}

/// What makes the coefficients of a normal model for two materials.
type MakeNormal<A> = Box<dyn Fn(&MaterialPair, FrictionNeeds) -> Result<A, Missing> + Send + Sync>;

/// What makes the coefficients of a cohesion model for two materials.
type MakeCohesion<D> = Box<dyn Fn(&MaterialPair) -> Result<D, Missing> + Send + Sync>;

/// The law that the scene composed of four sub-models. It is generic over what the loop computes; which models the
/// coefficients come from is asked once for each two materials.
pub struct Composed<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm> {
    /// Normal sub-model.
    normal: MakeNormal<A>,
    /// Tangential sub-model's keys.
    tangential: B::Keys,
    /// Rolling sub-model's keys.
    rolling: C::Keys,
    /// Cohesion sub-model.
    cohesion: MakeCohesion<D>,
    /// Whether friction sees the attraction.
    reduces_friction: bool,
    /// Switches of every law.
    switches: Switches,
}

impl<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm> Composed<A, B, C, D> {
    /// The law of these models, by their keys.
    pub fn of<M: Normal<Form = A>, K: Cohesion<Form = D>>(
        normal: M::Keys,
        tangential: B::Keys,
        rolling: C::Keys,
        cohesion: K::Keys,
        switches: Switches,
    ) -> Self {
        Self {
            normal: Box::new(move |pair, needs| M::between(pair, &normal, needs)),
            tangential,
            rolling,
            cohesion: Box::new(move |pair| K::between(pair, &cohesion)),
            reduces_friction: K::reduces_friction(&cohesion),
            switches,
        }
    }

    /// What friction takes from the normal model.
    fn friction_needs(&self) -> FrictionNeeds {
        FrictionNeeds { stiffness: B::HAS_SPRING, damping: B::HAS_DASHPOT && self.switches.damps_slip() }
    }
}

impl<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm> Law for Composed<A, B, C, D> {
    const COUNT: usize = A::COUNT + B::COUNT + C::COUNT + D::COUNT + Switches::COUNT;
    const HAS_PAIR_CONSTANT: bool = A::HAS_PAIR_CONSTANT;
    const HAS_ROOTS: bool = A::HAS_ROOTS;
    const HAS_TORQUE: bool = B::ACTIVE || C::ACTIVE;
    const HAS_ROLLING: bool = C::ACTIVE;
    const HAS_SPRING: bool = B::HAS_SPRING;
    const HAS_SECTION: bool = D::ACTIVE;

    fn objection(&self) -> Option<Objection> {
        if !B::ACTIVE && self.reduces_friction {
            return Some(Objection {
                table: "cohesion",
                key: "tangential_reduce",
                reason: "true found, but without a tangential model there is no friction to reduce; \
                         false, or a tangential model, is right",
            });
        }
        if !B::HAS_SPRING && !self.switches.damps_slip() {
            return Some(Objection {
                table: "",
                key: "tangential_damping",
                reason: "false found, but without a tangential spring nothing tangential is left; \
                         true, or tangential model none without this key, is right",
            });
        }
        None
    }

    fn row(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        let mut row = Vec::with_capacity(Self::COUNT);
        (self.normal)(pair, self.friction_needs())?.write(&mut row);
        B::between(pair, &self.tangential)?.write(&mut row);
        C::between(pair, &self.rolling)?.write(&mut row);
        (self.cohesion)(pair)?.write(&mut row);
        self.switches.write(&mut row);
        Ok(row)
    }

    fn pair_constant(row: &[f64], radius: f64, mass: f64) -> f64 {
        A::read(row).pair_constant(radius, mass)
    }

    #[inline(always)]
    fn roots<N: Number>(overlap: N, radius: N, mass: N) -> Roots<N> {
        A::roots(overlap, radius, mass)
    }

    #[inline(always)]
    fn react_at<N: Number>(
        row: &[N],
        contact: &Contact<N>,
        roots: Roots<N>,
        spring: Vector<N>,
        step: N,
    ) -> Reaction<N> {
        let (normal, row) = (A::lanes(row), &row[A::COUNT..]);
        let (tangential, row) = (B::lanes(row), &row[B::COUNT..]);
        let (rolling, row) = (C::lanes(row), &row[C::COUNT..]);
        let (cohesion, row) = (D::lanes(row), &row[D::COUNT..]);
        let switches = Switches::lanes(row);

        let mut response = A::response_at(normal, contact, roots);
        response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
        let elastic = response.normal_stiffness * contact.overlap;
        let push = (elastic - response.normal_damping * contact.normal_velocity).max(switches.least_force);
        let mut along = push;
        let mut seen = push;
        if D::ACTIVE {
            let pull = D::force(cohesion, contact);
            along = along + pull;
            seen = seen + D::seen_by_friction(cohesion, pull);
        }
        let mut force = contact.normal * along;
        let never = N::zero().greater(N::zero());
        let mut reaction = Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), spring, sliding: never };
        if B::ACTIVE {
            let (friction, spring, sliding) = B::force(tangential, contact, &response, seen.abs(), spring, step);
            force += friction;
            reaction.force = force;
            reaction.couple = contact.normal.cross(friction);
            reaction.spring = spring;
            reaction.sliding = sliding;
        }
        if C::ACTIVE {
            reaction.rolling = C::torque(rolling, contact, &response);
        }
        reaction
    }

    fn react_beyond(row: &[f64], contact: &Contact, beyond: &Beyond, spring: Vector, step: f64) -> Reaction {
        let (normal, row) = (A::lanes(row), &row[A::COUNT..]);
        let (tangential, row) = (B::lanes(row), &row[B::COUNT..]);
        let (rolling, row) = (C::lanes(row), &row[C::COUNT..]);
        let (cohesion, row) = (D::lanes(row), &row[D::COUNT..]);
        let switches = Switches::lanes(row);

        let mut response = A::response(normal, contact);
        response.tangential_damping *= switches.tangential_damping_factor;
        let elastic = response.normal_stiffness * beyond.pressing;
        let push = (elastic - response.normal_damping * contact.normal_velocity).max(switches.least_force);
        let (mut along, mut seen) = (push, push);
        if D::ACTIVE {
            let pull = D::force(cohesion, contact) - D::force(cohesion, &beyond.offset);
            along += pull;
            seen += D::seen_by_friction(cohesion, pull);
        }
        let force = contact.normal * if beyond.acts { along } else { 0.0 };
        let mut reaction = Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), spring, sliding: false };
        if B::ACTIVE {
            let (friction, spring, sliding) = B::force(tangential, contact, &response, seen.abs(), spring, step);
            reaction.force += friction;
            reaction.couple = contact.normal.cross(friction);
            reaction.spring = spring;
            reaction.sliding = sliding;
        }
        if C::ACTIVE && beyond.acts {
            let pressed = Contact { overlap: beyond.pressing, ..*contact };
            reaction.rolling = C::torque(rolling, &pressed, &response);
        }
        reaction
    }

    fn elastic_energy(row: &[f64], contact: &Contact, offset: f64, spring: Vector) -> f64 {
        let mut energy = A::read(row).elastic_energy(contact, offset);
        if B::HAS_SPRING {
            let stiffness = A::response(A::lanes(row), contact).tangential_stiffness;
            energy += 0.5 * stiffness * spring.dot(spring);
        }
        energy
    }

    fn stiffness(row: &[f64], contact: &Contact) -> Response {
        let mut response = A::response(A::lanes(row), contact);
        response.normal_stiffness = A::read(row).tangent_stiffness(contact);
        let switches = Switches::read(&row[Self::COUNT - Switches::COUNT..]);
        if !B::HAS_SPRING {
            response.tangential_stiffness = 0.0;
        }
        if !B::HAS_DASHPOT || !switches.damps_slip() {
            response.tangential_damping = 0.0;
        }
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::cohesion::{attraction, none, sjkr};
    use crate::contact::fixtures::{assert_close, contact, properties, with_pair};
    use crate::contact::normal::hooke_stiffness;
    use crate::contact::rolling::{cdt, none as free};
    use crate::contact::tangential::{history, no_history, none as smooth};
    use crate::contact::{NoKeys, PairProperties};
    use crate::quantity::NonNegative;

    /// Hooke with everything: k_n δ = 100/16384 N, γ_n v_n = −12 N (m* g_n = 24 kg/s, v_n = −½ m/s), c A = 21 N.
    type Whole<B> = Composed<hooke_stiffness::HookeStiffness, B, cdt::Cdt, attraction::Attraction>;

    /// That law with these switches.
    fn whole<B: Tangential<Keys = NoKeys>>(switches: Switches, tangential_reduce: bool) -> Whole<B> {
        let (normal, cohesion) = (hooke_stiffness::Keys::default(), sjkr::Keys { tangential_reduce });
        Composed::of::<hooke_stiffness::HookeStiffness, sjkr::Sjkr>(normal, NoKeys {}, NoKeys {}, cohesion, switches)
    }

    /// What it does to the fixture's contact at this normal velocity.
    fn react<B: Tangential<Keys = NoKeys>>(law: Whole<B>, normal_velocity: f64) -> Reaction {
        let row = with_pair(&properties(), |pair| law.row(pair)).unwrap();
        Whole::<B>::react(&row, &Contact { normal_velocity, ..contact() }, Vector::zero(), 0.0)
    }

    /// k_n δ of the fixture's contact.
    const ELASTIC: f64 = 100.0 / 16384.0;

    #[test]
    fn pushes_i_along_the_normal_by_spring_and_dashpot_less_the_cohesion() {
        let reaction = react(whole::<no_history::NoHistory>(Switches::of(false, true), false), -0.5);
        assert_close(reaction.force.z, ELASTIC + 12.0 - 21.0, 1e-15);
    }

    #[test]
    fn turns_both_bodies_by_the_couple_of_friction() {
        let reaction = react(whole::<no_history::NoHistory>(Switches::of(false, true), false), -0.5);
        let friction = Vector::new(reaction.force.x, reaction.force.y, 0.0);
        assert_eq!(reaction.couple, Vector::new(-friction.y, friction.x, 0.0));
    }

    #[test]
    fn friction_sees_the_normal_force_without_cohesion_and_with_it_when_reduced() {
        // slip of 5 m/s is above the limit: γ_t = 12 kg/s
        let limit = |reduce, velocity| {
            let force = react(whole::<no_history::NoHistory>(Switches::of(false, true), reduce), velocity).force;
            Vector::new(force.x, force.y, 0.0).length()
        };
        assert_close(limit(false, -0.5), 0.25 * (ELASTIC + 12.0), 1e-15);
        assert_close(limit(true, -0.5), 0.25 * (21.0 - 12.0 - ELASTIC), 1e-14);
        assert_close(limit(false, 0.5), 0.25 * (12.0 - ELASTIC), 1e-15);
    }

    #[test]
    fn limited_force_is_cut_before_friction_and_cohesion() {
        let reaction = react(whole::<no_history::NoHistory>(Switches::of(true, true), false), 0.5);
        assert_eq!(reaction.force.to_array().map(f64::abs), [0.0, 0.0, 21.0]);
    }

    #[test]
    fn rolling_sees_the_spring_alone() {
        let reaction = react(whole::<no_history::NoHistory>(Switches::of(true, true), true), 0.5);
        assert_close(reaction.rolling.y, 0.125 * ELASTIC * 0.25, 1e-15);
    }

    #[test]
    fn tangential_damping_can_be_switched_off() {
        let reaction = react(whole::<no_history::NoHistory>(Switches::of(false, false), false), -0.5);
        assert_eq!([reaction.force.x.abs(), reaction.force.y.abs()], [0.0, 0.0]);
    }

    #[test]
    fn asks_only_for_properties_that_are_used() {
        let bare = PairProperties {
            normal_stiffness: NonNegative::new(1.0),
            normal_damping: NonNegative::new(1.0),
            ..PairProperties::default()
        };
        let law = Composed::<_, smooth::None, free::None, _>::of::<hooke_stiffness::HookeStiffness, none::None>(
            hooke_stiffness::Keys::default(),
            NoKeys {},
            NoKeys {},
            NoKeys {},
            Switches::of(false, true),
        );
        assert!(with_pair(&bare, |pair| law.row(pair)).is_ok());
    }

    #[test]
    fn objects_to_reduced_friction_without_friction() {
        let objection = whole::<smooth::None>(Switches::of(false, true), true).objection().unwrap();
        assert_eq!((objection.table, objection.key), ("cohesion", "tangential_reduce"));
        assert_eq!(whole::<smooth::None>(Switches::of(false, true), false).objection(), None);
        assert_eq!(whole::<no_history::NoHistory>(Switches::of(false, true), true).objection(), None);
    }

    #[test]
    fn objects_to_undamped_slip_without_a_spring() {
        let undamped = Switches::of(false, false);
        assert_eq!(whole::<no_history::NoHistory>(undamped, false).objection().unwrap().key, "tangential_damping");
        assert_eq!(whole::<history::History>(undamped, false).objection(), None);
    }

    #[test]
    fn stiffness_leaves_out_what_does_not_act() {
        let law = whole::<history::History>(Switches::of(false, false), false);
        let row = with_pair(&properties(), |pair| law.row(pair)).unwrap();
        let spring = Whole::<history::History>::stiffness(&row, &contact());
        assert_eq!([spring.tangential_stiffness, spring.tangential_damping], [50.0, 0.0]);
        let law = whole::<no_history::NoHistory>(Switches::of(false, true), false);
        let row = with_pair(&properties(), |pair| law.row(pair)).unwrap();
        let dashpot = Whole::<no_history::NoHistory>::stiffness(&row, &contact());
        assert_eq!([dashpot.tangential_stiffness, dashpot.tangential_damping], [0.0, 12.0]);
    }
}
