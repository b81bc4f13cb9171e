//! A law does what its sub-models do, one after another.

use super::*;
use crate::base::number::Vector;
use crate::laws::contact::cohesion::sjkr;
use crate::laws::contact::fixtures::{assert_close, contact, every_law, properties, with_pair};
use crate::laws::contact::normal::hooke_stiffness;
use crate::laws::contact::property;
use crate::laws::contact::{
    CohesionModel, Contact, NoKeys, NormalModel, Properties, Reaction, RollingModel, TangentialModel, cohesion, normal,
    rolling, tangential,
};

/// Friction without memory.
const NO_HISTORY: TangentialModel = TangentialModel::fixed::<tangential::no_history::NoHistory>(&NoKeys {});
/// Friction with a spring.
const HISTORY: TangentialModel = TangentialModel::fixed::<tangential::history::History>(&NoKeys {});
/// No friction.
const SMOOTH: TangentialModel = TangentialModel::fixed::<tangential::none::None>(&NoKeys {});

/// Hooke with everything: k_n δ = 100/16384 N, γ_n v_n = −12 N (m* g_n = 24 kg/s, v_n = −½ m/s), c A = 21 N.
fn whole(tangential: TangentialModel, switches: Switches, tangential_reduce: bool) -> LawChoice {
    LawChoice {
        normal: NormalModel::of::<normal::hooke_stiffness::HookeStiffness>(hooke_stiffness::Keys::default()),
        tangential,
        rolling: RollingModel::of::<rolling::cdt::Cdt>(NoKeys {}),
        cohesion: CohesionModel::of::<cohesion::sjkr::Sjkr>(sjkr::Keys { tangential_reduce }),
        switches,
        scheme: Scheme::Engine,
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
    law.react(&row, &mut Contact { normal_velocity, ..contact() }, &mut history, 0.0)
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
    let bare = Properties::default().with(&property::NORMAL_STIFFNESS, 1.0).with(&property::NORMAL_DAMPING, 1.0);
    let choice = LawChoice {
        rolling: RollingModel::of::<rolling::none::None>(NoKeys {}),
        cohesion: CohesionModel::of::<cohesion::none::None>(NoKeys {}),
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

#[test]
fn a_free_fourth_number_is_handed_on_and_holds_the_velocity_of_the_middle() {
    let (mut shared, mut own) = (0, 0);
    for choice in every_law().into_iter().filter(|choice| choice.scheme == Scheme::PredictedNormal) {
        let (law, row) = law(choice);
        let place = law.history_places().normal_velocity.expect("the scheme remembers it");
        let of_sub_model = [law.history_places().normal, law.history_places().tangential].contains(&Some(place));
        *(if of_sub_model { &mut shared } else { &mut own }) += 1;
        let mut history = vec![[0.0; 4]; law.history().len()];
        law.react(&row, &mut contact(), &mut history, 1e-3);
        assert_eq!(history[place][3], contact().normal_velocity, "{choice:?}");
        law.react(&row, &mut Contact { normal_velocity: -2.0, ..contact() }, &mut history, 0.0);
        assert_eq!(history[place][3], contact().normal_velocity, "{choice:?}, no step");
    }
    assert!(shared > 10 && own > 10, "{shared} laws share a row, {own} have their own");
}
