//! Every contact law and every bond law gives the same bits: in any lane width, and whatever the platform's own
//! functions are.
//!
//! Hashes are of the whole state, at the end of scenes in which contacts are made, slide and part, at planes too, and
//! in which bonds between particles and to a plane are loaded in every way and break. Threads share a pass by slabs,
//! whatever the law; `same_bits.rs` and `bonded_block.rs` look at them.

use cograin::lanes::Width;
use cograin::scene::{Models, Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A cloud that meets another one, a moving floor and a wall: two materials, properties for every law.
const CONTACTS: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
step = 1.0e-5
allow_unstable = true
threads = 1
max_overlap = 0.2
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[material.b]
youngs_modulus = 2.0e7
poissons_ratio = 0.25
density = 1500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
cohesion_energy_density = 2.0e3
fluid_viscosity = 1.0e-3
critical_stokes_number = 10.0
maximum_restitution = 0.9
rolling_viscous_damping = 0.3
surface_energy = 2.0
damping_coefficient = 1.0e4
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 3.0
pull_off_force = 1.0e-3
STIFFNESS
[pair.a.b]
restitution = 0.6
friction = 0.3
rolling_friction = 0.05
cohesion_energy_density = 1.0e3
fluid_viscosity = 1.0e-3
critical_stokes_number = 20.0
maximum_restitution = 0.8
rolling_viscous_damping = 0.1
surface_energy = 1.0
damping_coefficient = 2.0e4
tangential_damping_ratio = 1.0
unloading_stiffness_ratio = 2.0
pull_off_force = 0.0
STIFFNESS
[pair.b.b]
restitution = 0.4
friction = 0.2
rolling_friction = 0.02
cohesion_energy_density = 0.0
fluid_viscosity = 2.0e-3
critical_stokes_number = 15.0
maximum_restitution = 0.7
rolling_viscous_damping = 0.0
surface_energy = 0.0
damping_coefficient = 1.0e4
tangential_damping_ratio = 0.0
unloading_stiffness_ratio = 5.0
pull_off_force = 0.0
STIFFNESS
LAW
[particles.heavy]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [5, 5, 3], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
[particles.light]
material = "b"
lattice = { kind = "simple_cubic", origin = [0.006, 0.005, 0.028], counts = [5, 5, 3], spacing = 8.1e-3, radius = 4.0e-3 }
velocity = [-3.0, 2.0, -5.0]
angular_velocity = [50.0, -20.0, 30.0]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
motion = { prescribed = { x = 0.5, z = 0.2 } }
[boundary.west]
plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "b"
[output]
energy = true
"#;

/// Sub-models with the keys that change what they do.
pub(crate) mod laws {
    use cograin::scene::Models;

    /// Normal models, each with its keys in every form.
    pub(crate) fn normal(models: &Models) -> Vec<(&'static str, &'static str)> {
        let keys = |name: &str| -> &[&str] {
            match name {
                "hooke" | "hooke_viscous" => &["characteristic_velocity = 1.0"],
                "hooke_stiffness" => &["", "absolute_damping = false"],
                "jkr" => &["", "tear_off = \"whole_branch\"", "engine_exact = true"],
                "dmt" => &["", "engine_exact = true"],
                "eepa" => &[
                    "overlap_exponent = 1.5\nadhesion_exponent = 2",
                    "overlap_exponent = 1.5\nadhesion_exponent = 2\nengine_exact = true",
                    "overlap_exponent = 1\nadhesion_exponent = 1",
                ],
                _ => &[""],
            }
        };
        models.normal_names().into_iter().flat_map(|name| keys(name).iter().map(move |keys| (name, *keys))).collect()
    }

    /// Rolling models, each with its keys in every form and a share of critical damping.
    pub(crate) fn rolling(models: &Models) -> Vec<(&'static str, &'static str, f64)> {
        let forms = |name: &str| -> &[(&str, f64)] {
            match name {
                "epsd" => {
                    &[("", 0.0), ("", 0.1), ("", 0.5), ("", 3.0), ("torsion = true", 1.0), ("engine_exact = true", 1.0)]
                }
                "epsd2" => &[("", 0.0), ("torsion = true", 0.0), ("engine_exact = true", 0.0)],
                // Its torque does not grow with spin: there is no linear law.
                "cdt" => &[],
                _ => &[("", 0.0)],
            }
        };
        let of = |name: &'static str| forms(name).iter().map(move |(keys, damping)| (name, *keys, *damping));
        models.rolling_names().into_iter().flat_map(of).collect()
    }
}

/// Every contact law there is: name, and scene.
pub(crate) fn contact_laws() -> BTreeMap<String, String> {
    let mut scenes = BTreeMap::new();
    let models = Models::standard();
    for normal in models.normal_names() {
        for tangential in models.tangential_names() {
            for rolling in models.rolling_names() {
                for cohesion in models.cohesion_names() {
                    // A torque, or an attraction, by the overlap does not go with a pull beyond touch.
                    if normal == "jkr" && (rolling == "cdt" || cohesion != "none") {
                        continue;
                    }
                    let speed = match normal {
                        "hooke" | "hooke_viscous" => "characteristic_velocity = 1.0",
                        "eepa" => "overlap_exponent = 1.5\nadhesion_exponent = 2",
                        _ => "",
                    };
                    let law = format!(
                        "[contact.touch.normal.{normal}]\n{speed}\n[contact.touch.tangential.{tangential}]\n\
                         [contact.touch.rolling.{rolling}]\n[contact.touch.cohesion.{cohesion}]"
                    );
                    // Of a pair; in this one law for each root of a length.
                    let (stiffness, damping) =
                        if normal == "hertz_stiffness" { ("1.0e7", "1.0e5") } else { ("5.0e3", "100.0") };
                    let stiffness = format!(
                        "normal_stiffness = {stiffness}\ntangential_stiffness = {stiffness}\n\
                         normal_damping = {damping}\ntangential_damping = {damping}"
                    );
                    let text = CONTACTS.replace("STIFFNESS", &stiffness).replace("LAW", &law);
                    scenes.insert([normal, tangential, rolling, cohesion].join(" "), text);
                }
            }
        }
    }
    scenes
}

/// A block whose upper half is torn off, glued to a plane that leaves it.
const BONDS: &str = r#"
[run]
step = 2.0e-7
threads = 1
max_overlap = 0.2
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.slow]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [4, 3, 2], spacing = 2.0e-3, radius = 1.01e-3 }
velocity = [1.0, 0.3, 0.0]
[particles.fast]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.004], counts = [4, 3, 2], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [40.0, -10.0, 15.0]
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
motion = { prescribed = { x = 3.0, z = -8.0 } }
[bond.slow]
between = ["slow", "slow"]
contact = "none"
LAW
[bond.fast]
between = ["slow", "fast"]
contact = "without_normal"
LAW
[bond.glue]
between = ["slow", "floor"]
LAW
[output]
energy = true
"#;

/// Every formulation, damping, relaxation and breakage of bonds: name, and scene.
pub(crate) fn bond_laws() -> BTreeMap<String, String> {
    let mut scenes = BTreeMap::new();
    let parts = |number: &str| {
        let part = |name| format!("{name} = {number}");
        let names = ["normal_force", "tangential_force", "normal_torque", "tangential_torque"];
        names.map(part).join(", ")
    };
    for formulation in ["finite_rotation", "incremental", "engine_exact"] {
        for damping in ["", "opposing", "viscous", "sign", "smooth"] {
            if formulation == "engine_exact" && matches!(damping, "opposing" | "viscous") {
                continue;
            }
            for relaxation in ["", "relaxation"] {
                for (breakage, limits) in [
                    (
                        "stress",
                        "max_normal_stress = 4.0e6, max_shear_stress = 4.0e6, tension_ratio = 0.8, friction_angle = 0.4",
                    ),
                    ("distance", "max_distance = 2.005e-3"),
                    (
                        "mohr_coulomb",
                        "mohr_coulomb = { cohesion = 3.0e6, friction_angle = 0.5, tensile_strength = 3.0e6 }",
                    ),
                ] {
                    if formulation == "engine_exact" && breakage == "mohr_coulomb" {
                        continue;
                    }
                    let mut law = format!(
                        "formulation = \"{formulation}\"\ncreate_distance = 2.1e-3\nnormal_stiffness = 1.0e12\n\
                         tangential_stiffness = 4.0e11\nbreakage = {{ {limits} }}\n"
                    );
                    if !damping.is_empty() {
                        law += &format!("damping.{damping} = {{ {} }}\n", parts("0.2"));
                    }
                    if !relaxation.is_empty() {
                        law += &format!("relaxation = {{ {} }}\n", parts("1.0e-4"));
                    }
                    scenes.insert([formulation, damping, relaxation, breakage].join(" "), BONDS.replace("LAW", &law));
                }
            }
        }
    }
    scenes
}

/// What else there is: bodies that turn freely and meet a plane, random packings, an automatic time step.
const OTHERS: &str = r#"
gravity = [0.0, 0.5, -9.81]
[run]
threads = 1
seed = 5
[material.stone]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.stone.stone]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hooke]
characteristic_velocity = 1.0
[contact.touch.tangential.history]
[particles.top]
material = "stone"
list = [
    { position = [0.05, 0.05, 0.012], radius = 0.01 },
    { position = [0.065, 0.052, 0.012], radius = 0.008 },
    { position = [0.05, 0.07, 0.02], radius = 0.012 },
]
[particles.loose]
material = "stone"
packing = { box = [[0.0, 0.0, 0.04], [0.1, 0.1, 0.1]], count = 300, radius = [0.004, 0.006] }
velocity = [0.5, 0.0, -3.0]
[boundary.top]
particles = { set = "top" }
motion = { free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 1.0] }
material = "stone"
[damping.all]
particles = { sets = ["loose"] }
linear = 0.1
angular = 0.05
gravity_damped = false
[output]
energy = true
"#;

/// A scene at time 0.
fn simulation(name: &str, text: &str) -> Simulation {
    let source = Source { name: name.into(), text: text.into(), files: Default::default() };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{name}: {errors}"));
    Simulation::new(Arc::new(scene)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Runs some communication steps in this lane width. Returns the hash of the state, and how many bonds broke.
fn run(name: &str, text: &str, width: Width, [count, interval]: [f64; 2]) -> (u64, u64) {
    let mut simulation = simulation(name, text);
    simulation.set_width(width);
    for _ in 0..count as u64 {
        simulation.advance(interval).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    (simulation.state().fingerprint(), simulation.state().bonds.iter().map(|list| list.broken).sum())
}

/// Communication steps of the scenes: how many, and how long \[s\].
const CONTACT_STEPS: [f64; 2] = [3.0, 2.0e-4];
/// The same of bonds \[s\].
const BOND_STEPS: [f64; 2] = [6.0, 2.0e-6];
/// The same of what else there is \[s\].
const OTHER_STEPS: [f64; 2] = [5.0, 2.0e-3];

/// Name and hash of every scene in this lane width.
fn hashes(width: Width) -> BTreeMap<String, u64> {
    let mut hashes = BTreeMap::new();
    for (name, text) in contact_laws() {
        let (hash, _) = run(&name, &text, width, CONTACT_STEPS);
        hashes.insert(name, hash);
    }
    for (name, text) in bond_laws() {
        let (hash, broken) = run(&name, &text, width, BOND_STEPS);
        assert!(broken > 10, "{name}: {broken} bonds broke");
        hashes.insert(name, hash);
    }
    hashes.insert("others".into(), run("others", OTHERS, width, OTHER_STEPS).0);
    let models = Models::standard();
    let axes = [models.normal_names(), models.tangential_names(), models.rolling_names(), models.cohesion_names()];
    let bonds = (2 * 5 * 3 + 3 * 2) * 2;
    let refused = axes[1].len() * (axes[2].len() * axes[3].len() - 3);
    let laws = axes.iter().map(|names| names.len()).product::<usize>() - refused;
    assert_eq!(hashes.len(), laws + bonds + 1);
    hashes
}

#[test]
fn the_scenes_show_what_the_laws_differ_in() {
    let all = hashes(Width::widest());
    let values: std::collections::BTreeSet<_> = all.values().collect();
    assert_eq!(values.len(), all.len(), "two laws that do the same are not both tried");
    let text = contact_laws().remove("hertz history cdt sjkr").expect("it is a law");
    let mut simulation = simulation("contacts", &text);
    let mut met = 0;
    for _ in 0..3 {
        simulation.advance(CONTACT_STEPS[1]).expect("it runs");
        let contacts = simulation.contacts();
        assert!(contacts.iter().any(|contact| contact.sliding) && contacts.iter().any(|contact| !contact.sliding));
        met += contacts.iter().filter(|contact| contact.boundary.is_some()).count();
    }
    assert!(met > 20 && simulation.contact_count() > 100, "{met} contacts at planes");
}

#[test]
fn every_law_gives_the_same_bits_in_any_lane_width() {
    let expected = hashes(Width::widest());
    for width in Width::ALL.into_iter().filter(|width| width.offered() && *width != Width::widest()) {
        assert_eq!(hashes(width), expected, "{width:?}");
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "the process that started this one reads it")]
fn hashes_are_told_to_another_process() {
    for (name, hash) in hashes(Width::widest()) {
        println!("hash {name} = {hash:016x}");
    }
}

/// A number that depends on which variants of its own functions the platform has chosen for this processor.
#[test]
#[allow(clippy::print_stdout, reason = "the process that started this one reads it")]
fn what_the_platforms_own_functions_make_is_told_to_another_process() {
    let made = (1..20_000).fold(0_u64, |bits, n| {
        let x = f64::from(n) * 0.731;
        bits.rotate_left(1) ^ x.sin().to_bits() ^ x.exp().to_bits() ^ x.powf(0.3).to_bits()
    });
    println!("hash own = {made:016x}");
}

/// The name of a test of this file, as the program of the tests knows it.
fn named(test: &str) -> String {
    let module = module_path!().split_once("::").map_or("", |(_, module)| module);
    format!("{module}::{test}")
}

/// What a test of this file tells in a process of its own, where the C library is asked not to use some features of
/// the processor. It reads that when a process starts.
fn told(test: &str, hidden: &str) -> BTreeMap<String, String> {
    let output = std::process::Command::new(std::env::current_exe().expect("a test is a file"))
        .args(["--exact", &named(test), "--nocapture"])
        .env("GLIBC_TUNABLES", format!("glibc.cpu.hwcaps={hidden}"))
        .output()
        .expect("a process starts");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{hidden}: {text}");
    let told = |line: &str| {
        line.split_once("hash ").and_then(|(_, rest)| rest.split_once(" = ")).map(|(a, b)| (a.into(), b.into()))
    };
    text.lines().filter_map(told).collect()
}

#[test]
fn the_platforms_own_functions_do_not_matter() {
    let here: BTreeMap<_, _> =
        hashes(Width::widest()).into_iter().map(|(name, hash)| (name, format!("{hash:016x}"))).collect();
    for hidden in ["-AVX2,-FMA", "-AVX2,-FMA,-AVX512F,-AVX512VL,-AVX512DQ,-AVX,-ERMS"] {
        assert_eq!(told("hashes_are_told_to_another_process", hidden), here, "{hidden}");
    }
}

/// Looks at the test above: with glibc, on a processor with fused operations, hiding them does change what the
/// platform's own functions make, so that a law which called one of them would be seen.
#[test]
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
fn a_law_that_called_the_platforms_own_functions_would_be_seen() {
    if !std::arch::is_x86_feature_detected!("fma") {
        return;
    }
    let test = "what_the_platforms_own_functions_make_is_told_to_another_process";
    let (whole, plain) = (told(test, ""), told(test, "-AVX2,-FMA,-FMA4"));
    assert_eq!((whole.len(), plain.len()), (1, 1));
    assert_ne!(whole, plain);
}
