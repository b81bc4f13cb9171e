//! Coefficients follow from names and properties.

use super::*;
use crate::base::number::{Row, Vector};
use crate::laws::contact::fixtures::{contact, corners, every_law, properties, with_pair};
use crate::laws::contact::property;
use crate::laws::contact::tangential::turned_history;
use crate::laws::contact::{
    Contact, Law, NoKeys, Offset, Reaction, TangentialModel, cohesion, normal, rolling, tangential,
};

/// The law and its coefficients at this restitution.
fn law_of(choice: &LawChoice, restitution: f64) -> (Law, Vec<f64>) {
    let properties = properties().with(&property::RESTITUTION, restitution);
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
                let reaction = law.react(&row, &mut contact.clone(), &mut history, 0.5);
                let found = numbers(&reaction, &history);
                assert!(found.iter().all(|number| number.is_finite()), "{found:?} of {choice:?} at {contact:?}");
            }
        }
    }
}

#[test]
fn what_a_bond_suppresses_comes_back_without_a_jump_in_every_law() {
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
            let open = law.react(&row, &mut contact.clone(), &mut remembered, 0.5);
            let (found, after) = beyond(&contact, whole);
            let claim = "without an offset nothing is suppressed";
            assert_eq!(numbers(&found, &after), numbers(&open, &remembered), "{claim}");
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
        ("normal", normal::STANDARD.iter().map(|row| row.name()).collect::<Vec<_>>()),
        ("tangential", tangential::STANDARD.iter().map(|row| row.name()).collect()),
        ("rolling", rolling::STANDARD.iter().map(|row| row.name()).collect()),
        ("cohesion", cohesion::STANDARD.iter().map(|row| row.name()).collect()),
    ];
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/laws/contact");
    for (axis, names) in axes {
        for name in names {
            assert!(folder.join(axis).join(name).with_extension("rs").is_file(), "{axis}/{name}");
        }
    }
}

#[test]
fn says_which_property_is_missing_and_where() {
    let bare = properties().without(&property::FRICTION);
    let choice =
        LawChoice { tangential: TangentialModel::of::<tangential::history::History>(NoKeys {}), ..every_law()[0] };
    let missing = with_pair(&bare, |pair| choice.coefficients(pair)).unwrap_err();
    assert_eq!(missing, [Missing { table: "pair.soft.soft".into(), key: "friction" }]);
}

#[test]
fn a_dashpot_stretches_its_spring_backwards_unless_it_acts_in_full_at_touch_or_the_scene_says_no() {
    let stretches = |eepa: bool, backward_spring: Option<bool>| {
        let choice = every_law().into_iter().find(|choice| (choice.normal.name() == "eepa") == eepa).unwrap();
        let keys = turned_history::Keys { backward_spring, ..Default::default() };
        let tangential = TangentialModel::of::<tangential::turned_history::TurnedHistory>(keys);
        let choice = LawChoice { tangential, switches: Switches::of(false, true), ..choice };
        let undamped = LawChoice { switches: Switches::of(false, false), ..choice };
        assert!(!undamped.stretches_backwards());
        assert_eq!(undamped.objection(), None);
        (choice.stretches_backwards(), choice.objection().map(|objection| objection.key))
    };
    assert_eq!(stretches(false, None), (true, None));
    assert_eq!(stretches(false, Some(false)), (false, None));
    assert_eq!(stretches(true, None), (false, None));
    assert_eq!(stretches(true, Some(true)), (true, Some("backward_spring")));
}
