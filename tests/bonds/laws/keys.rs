//! The bond table as text.

use cograin::bond::breakage::distance::Distance;
use cograin::bond::breakage::stress::StressLimits;
use cograin::bond::creation::{ContactPolicy, Creation};
use cograin::bond::damping::{Damping, TakeDamping};
use cograin::bond::keys::{FormulationChoice, Keys};
use cograin::bond::{Elasticity, Law};
use cograin::scene::{Scene, SceneErrors};

/// The keys of a table, or the message that refuses it.
fn read(text: &str) -> Result<Keys, String> {
    toml::from_str(text).map_err(|error| error.message().to_owned())
}

/// The least that a table needs, with this added.
fn with(more: &str) -> Keys {
    let least = "between = [\"beam\", \"beam\"]\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    read(&format!("{least}create_distance = 2e-3\n{more}")).unwrap()
}

/// A scene with that table for two particles.
fn scene(more: &str) -> Result<Scene, SceneErrors> {
    let more = format!("\n{more}").replace("\n[", "\n[bond.b.");
    let text = format!(
        "[run]\nstep = 1e-9\n[material.glass]\ndensity = 2500.0\n\
         [particles.beam]\nmaterial = \"glass\"\nlist = [{{ position = [0, 0, 0], radius = 1e-3 }}, \
         {{ position = [1.9e-3, 0, 0], radius = 1e-3 }}]\n\
         [bond.b]\nbetween = [\"beam\", \"beam\"]\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n\
         create_distance = 2e-3{more}"
    );
    text.parse()
}

/// The law that keys mean.
fn law(more: &str) -> Law {
    scene(more).unwrap().bond_law(0)
}

/// Keys of the contradictions.
fn wrong(more: &str) -> Vec<String> {
    scene(more).unwrap_err().list.into_iter().map(|error| error.key).collect()
}

#[test]
fn the_least_table_is_a_conservative_bond() {
    let keys = with("");
    assert_eq!(keys.formulation, FormulationChoice::FiniteRotation);
    assert_eq!((keys.create.clone(), keys.contact), (Creation::Start, ContactPolicy::Parallel));
    let elasticity = Elasticity::of(1.0, 1e12, 4e11);
    let elastic = Law::elastic(FormulationChoice::FiniteRotation, elasticity);
    assert_eq!(format!("{:?}", keys.law(false).unwrap()), format!("{elastic:?}"));
}

#[test]
fn parts_that_a_bond_does_not_bear_have_no_stiffness() {
    let law = law("tension = false\nshear = false\ntorsion = false\nbending = false").elasticity;
    assert_eq!([law.tension, law.compression, law.shear, law.torsion, law.bending], [0.0, 1e12, 0.0, 0.0, 0.0]);
    assert_eq!(law.at_step::<f64>(0.0).normal_stiffness(-1e-6), 0.0);
    assert_eq!(law.at_step::<f64>(0.0).normal_stiffness(1e-6), 1e12);
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

/// The limits on stresses that keys mean.
fn by_stress(more: &str) -> StressLimits {
    match &law(more).breakage[..] {
        [rule] => *rule.numbers().unwrap(),
        others => panic!("{others:?}"),
    }
}

#[test]
fn breakage_means_the_documents_limits() {
    let rule = by_stress(
        "[breakage]\nmax_normal_stress = 2e7\nmax_shear_stress = 3e7\ntension_ratio = 0.25\nfriction_angle = 0.5",
    );
    assert_eq!((rule.compression_strength, rule.tension_strength, rule.shear_strength), (2e7, 5e6, 3e7));
    assert!((rule.friction - libm::tan(0.5)).abs() < 1e-15);
    assert_eq!(rule.compression_share, -1.0, "compression relieves by default");
    assert_eq!(by_stress("[breakage]\nmax_normal_stress = 2e7\ncompression_breaks = true").compression_share, 1.0);
    let engine = by_stress("formulation = \"engine_exact\"\n[breakage]\nmax_normal_stress = 2e7");
    assert_eq!(engine.compression_share, 1.0, "and always breaks in engine_exact");
    let both = law("[breakage]\nmax_shear_stress = 3e7\nmax_distance = 1.0");
    assert!(both.breakage[0].numbers::<Distance>().is_some() && both.breakage[1].numbers::<StressLimits>().is_some());
    let names: Vec<&str> = (1..20).map_while(|code| both.cause_name(f64::from(code))).collect();
    assert_eq!(names, ["distance", "tension", "compression", "shear", "bending", "torsion"]);
    assert_eq!([0.0, -1.0, 7.0, 1e9].map(|code| both.cause_name(code)), [None; 4]);
}

#[test]
fn strengths_have_names_and_units() {
    let strengths = |more: &str| {
        let rules = scene(more).unwrap().bonds[0].keys.breakage.clone();
        rules.iter().flat_map(|rule| rule.strengths()).collect::<Vec<_>>()
    };
    let flat = strengths("[breakage]\nmax_distance = 3e-3\nmax_shear_stress = 3e7\nfriction_angle = 0.5");
    assert_eq!(flat, [("max_distance".to_owned(), "m"), ("max_shear_stress".to_owned(), "Pa")]);
    let table = "[breakage.mohr_coulomb]\ncohesion = 3.0\nfriction_angle = 0.5\ntensile_strength = 2.0";
    let named = ["mohr_coulomb.cohesion", "mohr_coulomb.tensile_strength"].map(|name| (name.to_owned(), "Pa"));
    assert_eq!(strengths(table), named);
    let missing = scene(&table.replace("friction_angle = 0.5\n", "")).unwrap_err().to_string();
    assert!(missing.contains("[bond.b] breakage.mohr_coulomb.friction_angle: missing"), "{missing}");
}

/// Whether a damping needs masses.
struct NeedsMasses;

impl TakeDamping for NeedsMasses {
    type Output = bool;
    fn take<D: Damping>(self, _: D) -> bool {
        D::NEEDS_MASSES
    }
}

#[test]
fn damping_and_relaxation_reach_their_parts() {
    let law = law("[damping.viscous]\nnormal_force = 0.1\ntangential_torque = 1.5\n[relaxation]\nnormal_torque = 0.5");
    let damping = law.damping.unwrap();
    let cograin::bond::keys::DampingChoice::Viscous(keys) = damping else { panic!("{damping:?}") };
    assert_eq!(keys.parts(cograin::quantity::NonNegative::get), [0.1, 0.0, 0.0, 1.5]);
    assert_eq!(law.elasticity.relaxation_rate, [0.0, 0.0, 2.0, 0.0]);
    assert_eq!(law.elasticity.at_step::<f64>(0.1).relaxed, [0.0, 0.0, 0.2, 0.0]);
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
    assert_eq!(keys.law(false).unwrap_err()[0].key, "create_distance");
    keys.create = Creation::Pairs(vec![[1, 2]]);
    assert!(keys.law(false).is_ok());
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

#[test]
fn a_bond_pays_for_what_it_names() {
    let constants = |more: &str| {
        let law = with(more).law(false).unwrap();
        let one = law.one_bond();
        (
            one.rows,
            one.fixed_rows,
            one.needs_orientations,
            law.damping.is_some_and(|damping| damping.visit(NeedsMasses)),
        )
    };
    assert_eq!(constants(""), (3, 2, true, false));
    assert_eq!(constants("[relaxation]\nnormal_force = 1.0"), (3, 0, true, false));
    assert_eq!(constants("formulation = \"incremental\""), (2, 0, false, false));
    assert_eq!(constants("formulation = \"incremental\"\n[damping.viscous]\nnormal_force = 0.1"), (2, 0, false, true));
    assert_eq!(constants("formulation = \"engine_exact\"\n[damping.sign]\nnormal_force = 0.1"), (3, 0, false, false));
}
