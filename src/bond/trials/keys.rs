//! The bond table as text.

use crate::bond::creation::{ContactPolicy, Creation};
use crate::bond::keys::{FormulationChoice, Keys, TakeLaw};
use crate::bond::{BondLaw, Law};

/// The keys of a table, or the message that refuses it.
fn read(text: &str) -> Result<Keys, String> {
    toml::from_str(text).map_err(|error| error.message().to_owned())
}

/// The least that a table needs, with this added.
fn with(more: &str) -> Keys {
    let least = "between = [\"beam\", \"beam\"]\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    read(&format!("{least}create_distance = 2e-3\n{more}")).unwrap()
}

/// The law that keys mean.
fn law(more: &str) -> Law {
    with(more).law().unwrap()
}

/// Keys of the contradictions.
fn wrong(more: &str) -> Vec<&'static str> {
    with(more).law().unwrap_err().into_iter().map(|error| error.key).collect()
}

#[test]
fn the_least_table_is_a_conservative_bond() {
    let keys = with("");
    assert_eq!(keys.formulation, FormulationChoice::FiniteRotation);
    assert_eq!((keys.create.clone(), keys.contact), (Creation::Start, ContactPolicy::Parallel));
    assert_eq!(keys.law().unwrap(), Law::elastic(1.0, 1e12, 4e11));
}

#[test]
fn parts_that_a_bond_does_not_bear_have_no_stiffness() {
    let law = law("tension = false\nshear = false\ntorsion = false\nbending = false");
    assert_eq!([law.tension, law.compression, law.shear, law.torsion, law.bending], [0.0, 1e12, 0.0, 0.0, 0.0]);
    assert_eq!(law.coefficients::<f64>(0.0).normal_stiffness(-1e-6), 0.0);
    assert_eq!(law.coefficients::<f64>(0.0).normal_stiffness(1e-6), 1e12);
}

#[test]
fn every_creation_is_written_as_documented() {
    let create = |text: &str| with(&format!("create = {text}")).create;
    assert_eq!(create("\"start\""), Creation::Start);
    assert_eq!(create("\"always\""), Creation::Always);
    assert_eq!(create("{ step = 7 }"), Creation::Step(7));
    assert!(matches!(create("{ time = 0.5 }"), Creation::Time(time) if time.get() == 0.5));
    assert_eq!(create("{ pairs = [[1, 2], [2, 3]] }"), Creation::Pairs(vec![[1, 2], [2, 3]]));
    assert_eq!(create("{ file = \"bonds.csv\" }"), Creation::File("bonds.csv".to_owned()));
}

#[test]
fn breakage_means_the_documents_limits() {
    let law =
        law("[breakage]\nmax_normal_stress = 2e7\nmax_shear_stress = 3e7\ntension_ratio = 0.25\nfriction_angle = 0.5");
    assert_eq!((law.compression_strength, law.tension_strength, law.shear_strength), (2e7, 5e6, 3e7));
    assert!((law.friction - libm::tan(0.5)).abs() < 1e-15);
    assert_eq!(law.compression_share, -1.0, "compression relieves by default");
    assert_eq!(self::law("[breakage]\nmax_normal_stress = 2e7\ncompression_breaks = true").compression_share, 1.0);
    let engine = self::law("formulation = \"engine_exact\"\n[breakage]\nmax_normal_stress = 2e7");
    assert_eq!(engine.compression_share, 1.0, "and always breaks in engine_exact");
}

#[test]
fn damping_and_relaxation_reach_their_parts() {
    let law = law("[damping.viscous]\nnormal_force = 0.1\ntangential_torque = 1.5\n[relaxation]\nnormal_torque = 0.5");
    assert_eq!(law.damping, [0.1, 0.0, 0.0, 1.5]);
    assert_eq!(law.relaxation_rate, [0.0, 0.0, 2.0, 0.0]);
    assert_eq!(law.coefficients::<f64>(0.1).relaxed, [0.0, 0.0, 0.2, 0.0]);
    let smooth = self::law("[damping.smooth]\nnormal_force = 0.1");
    assert_eq!((smooth.threshold, smooth.threshold_by_force), (1e-5, 0.01));
}

#[test]
fn contradictions_name_their_key() {
    assert_eq!(wrong("create = { step = 0 }"), ["create"]);
    assert_eq!(wrong("[breakage]"), ["breakage"]);
    assert_eq!(wrong("[breakage]\nmax_distance = 1.0\ntension_ratio = 0.5"), ["breakage.tension_ratio"]);
    assert_eq!(wrong("[breakage]\nmax_normal_stress = 1.0\nfriction_angle = 0.5"), ["breakage.friction_angle"]);
    assert_eq!(wrong("[breakage]\nmax_shear_stress = 1.0\nfriction_angle = 30.0"), ["breakage.friction_angle"]);
    assert_eq!(wrong("[breakage]\nmax_distance = 1.0\ncompression_breaks = true"), ["breakage.compression_breaks"]);
    let exact = |more: &str| wrong(&format!("formulation = \"engine_exact\"\n{more}"));
    assert_eq!(exact("[damping.viscous]\nnormal_force = 0.1"), ["damping"]);
    assert_eq!(exact("[damping.opposing]\nnormal_force = 0.1"), ["damping"]);
    assert_eq!(exact("[breakage]\nmax_distance = 1.0\nmax_shear_stress = 1.0"), ["breakage.max_distance"]);
    assert_eq!(
        exact("[breakage]\nmax_normal_stress = 1.0\ncompression_breaks = false"),
        ["breakage.compression_breaks"]
    );
    let mut keys = with("");
    keys.create_distance = None;
    assert_eq!(keys.law().unwrap_err()[0].key, "create_distance");
    keys.create = Creation::Pairs(vec![[1, 2]]);
    assert!(keys.law().is_ok());
}

#[test]
fn what_the_document_leaves_open_is_refused_with_that_reason() {
    let message = read("temperature_break = true").unwrap_err();
    assert!(message.contains("not implemented"), "{message}");
    let least = "between = [\"a\", \"b\"]\nnormal_stiffness = 1.0\ntangential_stiffness = 1.0\n";
    let message = read(&format!("{least}stiffness = 1.0")).unwrap_err();
    assert!(message.contains("unknown field"), "{message}");
    let message = read(&format!("{least}[damping.opposing]\nnormal_force = 1.5")).unwrap_err();
    assert!(message.contains("from 0 to 1"), "{message}");
}

#[test]
fn laws_that_look_at_the_step_say_so() {
    assert_eq!(with("").needs_given_step(), None);
    assert!(with("formulation = \"engine_exact\"").needs_given_step().is_some());
    assert!(with("create = { step = 1 }").needs_given_step().is_some());
    assert!(with("[relaxation]\nnormal_force = 2e-3\nnormal_torque = 1e-3").needs_given_step().is_some());
    assert!(with("[damping.smooth]\nnormal_force = 0.1").needs_given_step().is_some());
    assert_eq!(with("[relaxation]\nnormal_force = 2e-3\nnormal_torque = 1e-3").shortest_relaxation(), Some(1e-3));
}

/// Takes the constants of a law.
struct Constants;

impl TakeLaw for Constants {
    type Output = (usize, usize, bool, bool);
    fn take<L: BondLaw>(self) -> Self::Output {
        (L::ROWS, L::FIXED_ROWS, L::NEEDS_ATTITUDES, L::NEEDS_MASSES)
    }
}

#[test]
fn a_bond_pays_for_what_it_names() {
    let constants = |more: &str| with(more).visit(Constants);
    assert_eq!(constants(""), (3, 2, true, false));
    assert_eq!(constants("[relaxation]\nnormal_force = 1.0"), (3, 0, true, false));
    assert_eq!(constants("formulation = \"incremental\""), (2, 0, false, false));
    assert_eq!(constants("formulation = \"incremental\"\n[damping.viscous]\nnormal_force = 0.1"), (2, 0, false, true));
    assert_eq!(constants("formulation = \"engine_exact\"\n[damping.sign]\nnormal_force = 0.1"), (3, 0, false, false));
}
