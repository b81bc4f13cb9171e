//! From the names of four sub-models to the type of the law they compose.

use super::cohesion::{CohesionChoice, TakeCohesion};
use super::normal::{NormalChoice, TakeNormal};
use super::rolling::{RollingChoice, TakeRolling};
use super::tangential::{TakeTangential, TangentialChoice};
use super::{Cohesion, Composed, Law, MaterialPair, Missing, Normal, Objection, Rolling, Switches, Tangential};

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
}

/// What to do with the law once its type is known.
pub trait TakeLaw {
    /// What comes of it.
    type Output;
    /// Called once, with the law that the scene composed.
    fn take<L: Law>(self, law: L) -> Self::Output;
}

impl LawChoice {
    /// Goes from the names in the scene to the type in the program.
    pub fn visit<V: TakeLaw>(&self, visitor: V) -> V::Output {
        self.normal.visit(WithChoice { choice: self, visitor })
    }

    /// What speaks against the combination, if anything.
    pub fn objection(&self) -> Option<Objection> {
        self.visit(TakeObjection)
    }

    /// The property that the law needs of two materials and the scene does not give, if any.
    pub fn missing(&self, pair: &MaterialPair) -> Option<Missing> {
        self.visit(TakeMissing(pair))
    }
}

/// Asks a law for its objection.
struct TakeObjection;

impl TakeLaw for TakeObjection {
    type Output = Option<Objection>;
    fn take<L: Law>(self, law: L) -> Self::Output {
        law.objection()
    }
}

/// Asks a law for what it misses.
struct TakeMissing<'a>(&'a MaterialPair<'a>);

impl TakeLaw for TakeMissing<'_> {
    type Output = Option<Missing>;
    fn take<L: Law>(self, law: L) -> Self::Output {
        law.row(self.0).err()
    }
}

/// No sub-model known yet.
struct WithChoice<'a, V> {
    /// All the names.
    choice: &'a LawChoice,
    /// Who takes the law.
    visitor: V,
}

/// Normal sub-model known.
struct WithNormal<'a, V, A: Normal> {
    /// All the names.
    choice: &'a LawChoice,
    /// Who takes the law.
    visitor: V,
    /// Normal sub-model's keys.
    normal: A::Keys,
}

/// Normal and tangential sub-models known.
struct WithTangential<'a, V, A: Normal, B: Tangential> {
    /// All the names.
    choice: &'a LawChoice,
    /// Who takes the law.
    visitor: V,
    /// Normal sub-model's keys.
    normal: A::Keys,
    /// Tangential sub-model's keys.
    tangential: B::Keys,
}

/// All but the cohesion sub-model known.
struct WithRolling<'a, V, A: Normal, B: Tangential, C: Rolling> {
    /// All the names.
    choice: &'a LawChoice,
    /// Who takes the law.
    visitor: V,
    /// Normal sub-model's keys.
    normal: A::Keys,
    /// Tangential sub-model's keys.
    tangential: B::Keys,
    /// Rolling sub-model's keys.
    rolling: C::Keys,
}

impl<V: TakeLaw> TakeNormal for WithChoice<'_, V> {
    type Output = V::Output;
    fn take<A: Normal>(self, keys: &A::Keys) -> V::Output {
        let Self { choice, visitor } = self;
        choice.tangential.visit(WithNormal::<V, A> { choice, visitor, normal: *keys })
    }
}

impl<V: TakeLaw, A: Normal> TakeTangential for WithNormal<'_, V, A> {
    type Output = V::Output;
    fn take<B: Tangential>(self, keys: &B::Keys) -> V::Output {
        let Self { choice, visitor, normal } = self;
        choice.rolling.visit(WithTangential::<V, A, B> { choice, visitor, normal, tangential: *keys })
    }
}

impl<V: TakeLaw, A: Normal, B: Tangential> TakeRolling for WithTangential<'_, V, A, B> {
    type Output = V::Output;
    fn take<C: Rolling>(self, keys: &C::Keys) -> V::Output {
        let Self { choice, visitor, normal, tangential } = self;
        choice.cohesion.visit(WithRolling::<V, A, B, C> { choice, visitor, normal, tangential, rolling: *keys })
    }
}

impl<V: TakeLaw, A: Normal, B: Tangential, C: Rolling> TakeCohesion for WithRolling<'_, V, A, B, C> {
    type Output = V::Output;
    fn take<D: Cohesion>(self, keys: &D::Keys) -> V::Output {
        let Self { choice, visitor, normal, tangential, rolling } = self;
        let switches = choice.switches;
        let law = Composed::<A::Form, B, C, D::Form>::of::<A, D>(normal, tangential, rolling, *keys, switches);
        visitor.take(law)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::fixtures::{contact, properties, with_pair};
    use crate::contact::normal::{hooke, hooke_stiffness};
    use crate::contact::{Beyond, Contact, NoKeys, PairProperties, Reaction, cohesion};
    use crate::number::{Number, Vector};
    use crate::quantity::{Positive, Restitution};
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// Every combination of sub-models.
    fn all() -> Vec<LawChoice> {
        let speed = hooke::Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
        let reduce = cohesion::sjkr::Keys { tangential_reduce: true };
        let mut all = Vec::new();
        for normal in [
            NormalChoice::Hertz(NoKeys {}),
            NormalChoice::HertzStiffness(NoKeys {}),
            NormalChoice::Hooke(speed),
            NormalChoice::HookeStiffness(hooke_stiffness::Keys::default()),
            NormalChoice::HookeViscous(speed),
        ] {
            for tangential in [
                TangentialChoice::None(NoKeys {}),
                TangentialChoice::History(NoKeys {}),
                TangentialChoice::NoHistory(NoKeys {}),
            ] {
                for rolling in [RollingChoice::None(NoKeys {}), RollingChoice::Cdt(NoKeys {})] {
                    for cohesion in [
                        CohesionChoice::None(NoKeys {}),
                        CohesionChoice::Sjkr(reduce),
                        CohesionChoice::Sjkr2(cohesion::sjkr::Keys::default()),
                    ] {
                        all.push(LawChoice {
                            normal,
                            tangential,
                            rolling,
                            cohesion,
                            switches: Switches::of(false, true),
                        });
                    }
                }
            }
        }
        all
    }

    /// Two numbers side by side: the least that has lanes.
    #[derive(Clone, Copy)]
    struct Two([f64; 2]);

    /// Implements an operator lane by lane.
    macro_rules! lane_by_lane {
        ($($operator:ident $name:ident),+) => {$(
            impl $operator for Two {
                type Output = Self;
                fn $name(self, other: Self) -> Self {
                    Self([self.0[0].$name(other.0[0]), self.0[1].$name(other.0[1])])
                }
            }
        )+};
    }
    lane_by_lane!(Add add, Sub sub, Mul mul, Div div);

    impl Neg for Two {
        type Output = Self;
        fn neg(self) -> Self {
            Self(self.0.map(|lane| -lane))
        }
    }

    impl Number for Two {
        type Mask = [bool; 2];
        fn splat(value: f64) -> Self {
            Self([value; 2])
        }
        fn sqrt(self) -> Self {
            Self(self.0.map(f64::sqrt))
        }
        fn abs(self) -> Self {
            Self(self.0.map(f64::abs))
        }
        fn max(self, other: Self) -> Self {
            Self([Number::max(self.0[0], other.0[0]), Number::max(self.0[1], other.0[1])])
        }
        fn min(self, other: Self) -> Self {
            Self([Number::min(self.0[0], other.0[0]), Number::min(self.0[1], other.0[1])])
        }
        fn greater(self, other: Self) -> [bool; 2] {
            [self.0[0] > other.0[0], self.0[1] > other.0[1]]
        }
        fn select(mask: [bool; 2], yes: Self, no: Self) -> Self {
            Self([f64::select(mask[0], yes.0[0], no.0[0]), f64::select(mask[1], yes.0[1], no.0[1])])
        }
        fn both(one: [bool; 2], other: [bool; 2]) -> [bool; 2] {
            [one[0] && other[0], one[1] && other[1]]
        }
        fn either(one: [bool; 2], other: [bool; 2]) -> [bool; 2] {
            [one[0] || other[0], one[1] || other[1]]
        }
        fn any(mask: [bool; 2]) -> bool {
            mask[0] || mask[1]
        }
    }

    /// Contacts at the corners of what can be: no motion, no spin, no overlap, receding.
    fn corners() -> Vec<Contact> {
        let still = Contact {
            normal_velocity: 0.0,
            slip: Vector::zero(),
            relative_spin: Vector::zero(),
            pair_constant: 5.0,
            ..contact()
        };
        vec![
            Contact { pair_constant: 5.0, ..contact() },
            Contact { normal_velocity: 0.25, pair_constant: 5.0, ..contact() },
            still,
            Contact { overlap: 0.0, section_area: 0.0, ..still },
            Contact { pair_constant: 0.0, ..still },
        ]
    }

    /// Runs a law on contacts, one by one and in lanes, and looks at what comes.
    struct Try;

    impl TakeLaw for Try {
        type Output = ();
        fn take<L: Law>(self, law: L) {
            for row in [row_of::<L>(&law, 0.5), row_of::<L>(&law, 1.0), vec![0.0; L::COUNT]] {
                for (one, two) in corners().iter().flat_map(|a| corners().into_iter().map(move |b| (*a, b))) {
                    let spring = Vector::new(0.125, 0.0, 0.0);
                    let alone = [one, two].map(|contact| numbers(&L::react(&row, &contact, spring, 0.5)));
                    let lanes: Vec<Two> = row.iter().map(|value| Two([*value; 2])).collect();
                    let spring = Vector::new(Two([0.125; 2]), Two([0.0; 2]), Two([0.0; 2]));
                    let together = numbers(&L::react(&lanes, &pack(&one, &two), spring, Two([0.5; 2])));
                    for (at, both) in together.iter().enumerate() {
                        assert!(both.0.iter().all(|value| value.is_finite()), "number {at} of {:?}", both.0);
                        assert_eq!(both.0.map(f64::to_bits), [alone[0][at].to_bits(), alone[1][at].to_bits()]);
                    }
                }
            }
        }
    }

    /// The law's coefficients at this restitution.
    fn row_of<L: Law>(law: &L, restitution: f64) -> Vec<f64> {
        let restitution = Restitution::new(restitution);
        with_pair(&PairProperties { restitution, ..properties() }, |pair| law.row(pair)).unwrap()
    }

    /// All that a law says of a contact.
    fn numbers<N: Number>(reaction: &Reaction<N>) -> [N; 12] {
        let [a, b, c, d] = [reaction.force, reaction.couple, reaction.rolling, reaction.spring];
        [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z]
    }

    /// Two contacts side by side.
    fn pack(a: &Contact, b: &Contact) -> Contact<Two> {
        let vector = |a: Vector, b: Vector| Vector::new(Two([a.x, b.x]), Two([a.y, b.y]), Two([a.z, b.z]));
        Contact {
            overlap: Two([a.overlap, b.overlap]),
            radius: Two([a.radius, b.radius]),
            mass: Two([a.mass, b.mass]),
            section_area: Two([a.section_area, b.section_area]),
            section_radius: Two([a.section_radius, b.section_radius]),
            normal: vector(a.normal, b.normal),
            normal_velocity: Two([a.normal_velocity, b.normal_velocity]),
            slip: vector(a.slip, b.slip),
            relative_spin: vector(a.relative_spin, b.relative_spin),
            pair_constant: Two([a.pair_constant, b.pair_constant]),
        }
    }

    #[test]
    fn every_law_is_finite_at_the_corners_and_has_the_same_bits_in_lanes() {
        for choice in all() {
            choice.visit(Try);
        }
    }

    /// Runs a law on contacts that a bond hides or has hidden.
    struct Hide;

    impl TakeLaw for Hide {
        type Output = ();
        fn take<L: Law>(self, law: L) {
            let row = row_of::<L>(&law, 0.5);
            let spring = Vector::new(0.125, 0.0, 0.0);
            for contact in corners() {
                let nothing = Contact { overlap: 0.0, section_area: 0.0, ..contact };
                let whole = Beyond { pressing: contact.overlap, acts: true, offset: nothing };
                let open = L::react(&row, &contact, spring, 0.5);
                let found = L::react_beyond(&row, &contact, &whole, spring, 0.5);
                assert_eq!(numbers(&found), numbers(&open), "without an offset nothing is hidden");
                let bonded = Beyond { pressing: 0.0, acts: false, offset: contact };
                let found = L::react_beyond(&row, &contact, &bonded, spring, 0.5);
                assert_eq!((found.force.dot(contact.normal), found.rolling), (0.0, Vector::zero()));
                let still = Contact { normal_velocity: 0.0, ..contact };
                let broken = Beyond { pressing: 0.0, acts: true, offset: still };
                let found = L::react_beyond(&row, &still, &broken, spring, 0.5);
                assert_eq!(found.force.dot(contact.normal), 0.0, "no force at the overlap that is left");
                assert_eq!(found.rolling, Vector::zero());
            }
            force_is_the_slope_of_the_energy::<L>(&row);
        }
    }

    /// The elastic force beyond an offset against the difference of the energies a little to both sides.
    fn force_is_the_slope_of_the_energy<L: Law>(row: &[f64]) {
        let at = |overlap: f64| Contact { overlap, pair_constant: 5.0, normal_velocity: 0.0, ..contact() };
        let (overlap, spring) = (contact().overlap, Vector::new(0.125, 0.0, 0.0));
        for offset in [0.0, 0.25 * overlap] {
            let energy = |overlap: f64| L::elastic_energy(row, &at(overlap), offset, Vector::zero());
            // Attraction is the same with and without the pressing part: the difference is the elastic force.
            let push = |pressing| {
                let beyond = Beyond { pressing, acts: true, offset: at(offset) };
                let found = L::react_beyond(row, &at(overlap), &beyond, Vector::zero(), 0.0);
                found.force.dot(contact().normal)
            };
            let (nudge, force) = (1e-4 * overlap, push(overlap - offset) - push(0.0));
            let slope = (energy(overlap + nudge) - energy(overlap - nudge)) / (2.0 * nudge);
            assert!((slope / force - 1.0).abs() < 1e-7, "{slope:e} J/m for {force:e} N");
            assert!(energy(offset).abs() < 1e-15 * energy(2.0 * overlap));
        }
        let sheared = L::elastic_energy(row, &at(overlap), overlap, spring);
        let stiffness = L::stiffness(row, &at(overlap)).tangential_stiffness;
        assert!((sheared - 0.5 * stiffness * 0.125 * 0.125).abs() <= 1e-15 * sheared, "{sheared:e} J");
    }

    #[test]
    fn what_a_bond_hides_comes_back_without_a_jump_in_every_law() {
        for choice in all() {
            choice.visit(Hide);
        }
    }

    #[test]
    fn names_are_those_of_the_files() {
        let axes = [
            ("normal", NormalChoice::NAMES),
            ("tangential", TangentialChoice::NAMES),
            ("rolling", RollingChoice::NAMES),
            ("cohesion", CohesionChoice::NAMES),
        ];
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/contact");
        for (axis, names) in axes {
            for name in names {
                assert!(folder.join(axis).join(name).with_extension("rs").is_file(), "{axis}/{name}");
            }
        }
    }

    #[test]
    fn says_which_property_is_missing_and_where() {
        let bare = PairProperties { friction: None, ..properties() };
        let choice = LawChoice { tangential: TangentialChoice::History(NoKeys {}), ..all()[0] };
        let missing = with_pair(&bare, |pair| choice.missing(pair)).unwrap();
        assert_eq!((missing.table.as_str(), missing.key), ("pair.soft.soft", "friction"));
    }
}
