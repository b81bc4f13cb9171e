//! The names of four sub-models, as a scene writes them, and the coefficients that follow from them.

use super::cohesion::{CohesionChoice, TakeCohesion};
use super::normal::{NormalChoice, TakeNormal};
use super::rolling::{RollingChoice, TakeRolling};
use super::tangential::{TakeTangential, TangentialChoice};
use super::{
    Adhesion, Coefficients, Cohesion, CohesionForm, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm,
    Objection, Rolling, Switches, Tangential,
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
}

/// What each sub-model of the program remembers of a contact, as text: name and signs of its row.
pub fn remembered() -> String {
    let kinds = [NormalChoice::MEMORIES, TangentialChoice::MEMORIES, RollingChoice::MEMORIES, CohesionChoice::MEMORIES];
    let rows = kinds.into_iter().flatten().filter_map(|(model, row)| Some((model, row.as_ref()?)));
    rows.map(|(model, row)| format!("{model}: {} {:?}\n", row.name, row.odd)).collect()
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
        let ask = Ask(pair, needs);
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
                reason: "an attraction by the overlap found beside a normal model that pulls beyond touch by itself; \
                         none is right",
            });
        }
        if adhesion == Adhesion::BeyondTouch && self.rolling.visit(Parts).takes_overlap {
            return Some(Objection {
                table: "rolling",
                key: "",
                reason: "a torque by the overlap found, which is below 0 while the normal model pulls beyond touch; \
                         epsd, epsd2 or none is right",
            });
        }
        if self.normal.visit(Sticks) && self.switches.limits_force() {
            return Some(Objection {
                table: "",
                key: "limit_force",
                reason: "true found, which would cut the pull that the normal model is for; false is right",
            });
        }
        if !friction.active && self.cohesion.visit(Reduces) {
            return Some(Objection {
                table: "cohesion",
                key: "tangential_reduce",
                reason: "true found, but without a tangential model there is no friction to reduce; \
                         false, or a tangential model, is right",
            });
        }
        if !friction.has_spring && !self.switches.damps_slip() {
            return Some(Objection {
                table: "",
                key: "tangential_damping",
                reason: "false found, but without a tangential spring nothing tangential is left; \
                         true, or tangential model none without this key, is right",
            });
        }
        None
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

/// Asks a normal model what speaks against its keys.
struct OfKeys;

impl TakeNormal for OfKeys {
    type Output = Option<Objection>;
    fn take<M: Normal>(self, keys: &M::Keys) -> Option<Objection> {
        M::objection(keys)
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

/// Asks a cohesion model whether friction sees the attraction.
struct Reduces;

impl TakeCohesion for Reduces {
    type Output = bool;
    fn take<M: Cohesion>(self, keys: &M::Keys) -> bool {
        M::reduces_friction(keys)
    }
}

/// Asks a sub-model for its coefficients.
#[derive(Clone, Copy)]
struct Ask<'a>(&'a MaterialPair<'a>, FrictionNeeds);

impl TakeNormal for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Normal>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys, self.1)?))
    }
}

impl TakeTangential for Ask<'_> {
    type Output = Result<Vec<f64>, Missing>;
    fn take<M: Tangential>(self, keys: &M::Keys) -> Self::Output {
        Ok(numbers(&M::between(self.0, keys)?))
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
mod tests {
    use super::*;
    use crate::contact::fixtures::{contact, corners, every_law, properties, with_pair};
    use crate::contact::{Contact, Law, NoKeys, Offset, PairProperties, Reaction};
    use crate::number::{Row, Vector};
    use crate::quantity::Restitution;

    /// The law and its coefficients at this restitution.
    fn law_of(choice: &LawChoice, restitution: f64) -> (Law, Vec<f64>) {
        let properties = PairProperties { restitution: Restitution::new(restitution), ..properties() };
        (Law::of(choice), with_pair(&properties, |pair| choice.coefficients(pair)).unwrap())
    }

    /// What a law remembers, with the tangential spring where there is one.
    fn history(law: &Law, spring: Row) -> Vec<Row> {
        let mut history = vec![[0.0; 4]; law.history().len()];
        if let Some(place) = law.spring() {
            history[place] = spring;
        }
        history
    }

    /// All that a law says of a contact.
    fn numbers(reaction: &Reaction, history: &[Row]) -> Vec<f64> {
        let [a, b, c] = [reaction.force, reaction.couple, reaction.rolling].map(Vector::to_array);
        [&a[..], &b, &c, history.as_flattened()].concat()
    }

    /// A spring to begin with.
    const SPRING: Row = [0.125, 0.0, 0.0, 0.0];

    #[test]
    fn every_law_is_finite_at_the_corners() {
        for choice in every_law() {
            let (law, row) = law_of(&choice, 0.5);
            // Coefficients of 0 are those of materials without a law; what adheres divides by stiffness.
            let nothing = law.takes_offset().then(|| vec![0.0; law.places().count]);
            for row in [row, law_of(&choice, 1.0).1].into_iter().chain(nothing) {
                for contact in corners() {
                    let mut history = history(&law, SPRING);
                    let reaction = law.react(&row, &contact, &mut history, 0.5);
                    let found = numbers(&reaction, &history);
                    assert!(found.iter().all(|number| number.is_finite()), "{found:?} of {choice:?} at {contact:?}");
                }
            }
        }
    }

    #[test]
    fn what_a_bond_hides_comes_back_without_a_jump_in_every_law() {
        for choice in every_law().into_iter().filter(|choice| Law::of(choice).takes_offset()) {
            let (law, row) = law_of(&choice, 0.5);
            for contact in corners() {
                let beyond = |contact: &Contact, offset: Offset| {
                    let mut history = history(&law, SPRING);
                    (law.react_beyond(&row, contact, &offset, &mut history, 0.5), history)
                };
                let nothing = Contact { overlap: 0.0, section_area: 0.0, ..contact };
                let whole = Offset { pressing: contact.overlap, acts: true, contact: nothing };
                let mut remembered = history(&law, SPRING);
                let open = law.react(&row, &contact, &mut remembered, 0.5);
                let (found, after) = beyond(&contact, whole);
                assert_eq!(numbers(&found, &after), numbers(&open, &remembered), "without an offset nothing is hidden");
                let (found, _) = beyond(&contact, Offset { pressing: 0.0, acts: false, contact });
                assert_eq!((found.force.dot(contact.normal), found.rolling), (0.0, Vector::zero()));
                let still = Contact { normal_velocity: 0.0, ..contact };
                let (found, _) = beyond(&still, Offset { pressing: 0.0, acts: true, contact: still });
                assert_eq!(found.force.dot(contact.normal), 0.0, "no force at the overlap that is left");
                assert_eq!(found.rolling, Vector::zero());
            }
            force_is_the_slope_of_the_energy(&law, &row);
        }
    }

    /// The elastic force beyond an offset against the difference of the energies a little to both sides.
    fn force_is_the_slope_of_the_energy(law: &Law, row: &[f64]) {
        let at = |overlap: f64| Contact { overlap, pair_constant: 5.0, normal_velocity: 0.0, ..contact() };
        let overlap = contact().overlap;
        let slack = history(law, [0.0; 4]);
        for offset in [0.0, 0.25 * overlap] {
            let energy = |overlap: f64| law.elastic_energy(row, &at(overlap), offset, &slack);
            // Attraction is the same with and without the pressing part: the difference is the elastic force.
            let push = |pressing| {
                let beyond = Offset { pressing, acts: true, contact: at(offset) };
                let found = law.react_beyond(row, &at(overlap), &beyond, &mut slack.clone(), 0.0);
                found.force.dot(contact().normal)
            };
            let (nudge, force) = (1e-4 * overlap, push(overlap - offset) - push(0.0));
            let slope = (energy(overlap + nudge) - energy(overlap - nudge)) / (2.0 * nudge);
            assert!((slope / force - 1.0).abs() < 1e-7, "{slope:e} J/m for {force:e} N");
            assert!(energy(offset).abs() < 1e-15 * energy(2.0 * overlap));
        }
        let sheared = law.elastic_energy(row, &at(overlap), overlap, &history(law, SPRING));
        let stiffness = law.stiffness(row, &at(overlap)).tangential_stiffness;
        assert!((sheared - 0.5 * stiffness * 0.125 * 0.125).abs() <= 1e-15 * sheared, "{sheared:e} J");
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
        let choice = LawChoice { tangential: TangentialChoice::History(NoKeys {}), ..every_law()[0] };
        let missing = with_pair(&bare, |pair| choice.coefficients(pair)).unwrap_err();
        assert_eq!(missing, [Missing { table: "pair.soft.soft".into(), key: "friction" }]);
    }
}
