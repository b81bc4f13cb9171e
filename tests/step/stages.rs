//! The stages of a time step: which a scene has, that each writes no more than it says, and that the docs list them.

use crate::support::start;
use cograin::simulation::{Part, Phase, Simulation, all_stages};
use cograin::state::State;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// Materials and laws.
const LAWS: &str = r#"
[run]
step = 1e-5
seed = 7
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
conductivity = 1.0
specific_heat = 800.0
[pair.a.a]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[contact.all.heat.constriction]
[heat]
from_losses = ["normal_damping", "tangential_damping", "sliding"]
[output]
energy = true
losses = true
impacts = {}
"#;

/// Everything that stands in no cell: what is there, what comes and goes, and what moves it.
const OPEN: &str = r#"
gravity = [0.0, 0.0, -9.81]
LAWS
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]
[particles.clumps]
material = "a"
temperature = 300.0
clump = "pair"
list = [{ position = [0.0, 0.02, 0.00195], velocity = [0.1, 0.0, 0.0] }]
[particles.loose]
material = "a"
temperature = 300.0
list = [{ position = [0.0056, 0.02, 0.00195], radius = 0.002 }]
[particles.rods]
material = "a"
temperature = 300.0
list = [
    { position = [0.0, 0.0, 0.00195], radius = 0.002, velocity = [0.0, 0.0, -0.2] },
    { position = [0.004, 0.0, 0.00195], radius = 0.002 },
    { position = [0.008, 0.0, 0.00195], radius = 0.002, velocity = [0.4, 0.0, 0.0] },
]
[particles.stone]
material = "a"
temperature = 350.0
list = [
    { position = [0.02, 0.0, 0.00195], radius = 0.002, velocity = [0.0, 0.1, -0.1] },
    { position = [0.02, 0.004, 0.00195], radius = 0.002 },
]
[bond.glue]
between = ["rods", "rods"]
create_distance = 0.0041
normal_stiffness = 1e8
tangential_stiffness = 4e7
contact = "none"
[bond.glue.breakage]
max_distance = 0.00405
[damping.rods]
particles = { set = "rods" }
linear = 0.1
angular = 0.1
gravity_damped = false
applied_forces_damped = false
[force.wind]
particles = { set = "rods" }
force = [1e-4, 0.0, 0.0]
[boundary.stone]
particles = { set = "stone" }
motion = { free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[boundary.plate]
plane = { point = [0.0, 0.0, 0.02], normal = [0.0, 0.0, -1.0] }
material = "a"
motion = { servo = { z = { target = 1.0, speed = 0.1 } } }
[region.mouth]
box = [[-0.02, -0.02, 0.006], [-0.01, -0.01, 0.014]]
[region.bin]
box = [[0.009, -0.05, 0.0], [0.012, 0.05, 0.01]]
[insertion.feed]
region = "mouth"
material = "a"
temperature = 400.0
sizes = { radius = 0.001 }
count_rate = 20000.0
[outlet.bottom]
region = "bin"
"#;

/// A periodic cell that is deformed, with bonds and a clump in it.
const CELL: &str = r#"
LAWS
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]
[particles.clumps]
material = "a"
temperature = 300.0
clump = "pair"
list = [{ position = [0.004, 0.008, 0.004], velocity = [0.1, 0.0, 0.2] }]
[particles.balls]
material = "a"
temperature = 300.0
list = [
    { position = [0.002, 0.002, 0.002], radius = 0.002, velocity = [0.3, 0.0, 0.0] },
    { position = [0.0064, 0.002, 0.002], radius = 0.002 },
    { position = [0.001, 0.008, 0.0095], radius = 0.002 },
    { position = [0.00905, 0.008, 0.0095], radius = 0.002 },
]
[bond.glue]
between = ["balls", "balls"]
create = "always"
create_distance = 0.0041
normal_stiffness = 1e9
tangential_stiffness = 4e8
[cell]
edges = [[0.012, 0.0, 0.0], [0.0, 0.012, 0.0], [0.0, 0.0, 0.012]]
motion = { driven = ["xy"], servo = { zz = { stress = -1e3, max_rate = 1.0 } } }
"#;

/// Grains and a clump in a fluid to and fro.
const WATER: &str = r#"
gravity = [0.0, 0.0, -9.81]
LAWS
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]
[particles.clumps]
material = "a"
temperature = 300.0
clump = "pair"
list = [{ position = [0.02, 0.0, 0.004], velocity = [0.1, 0.0, 0.2] }]
[particles.loose]
material = "a"
temperature = 300.0
list = [{ position = [0.0, 0.0, 0.002], radius = 0.002 }, { position = [0.0, 0.0, 0.00595], radius = 0.002 }]
[fluid.water]
density = 1000.0
viscosity = 1e-3
velocity = { prescribed = { x = { sine = { amplitude = 0.01, frequency = 10.0 } } } }
temperature = 290.0
conductivity = 0.6
specific_heat = 4186.0
added_mass = 0.5
[fluid.water.drag.stokes]
[fluid.water.lift.magnus]
[fluid.water.heat.ranz_marshall]
"#;

/// A scene with the laws.
fn with_laws(scene: &str) -> Simulation {
    start(&scene.replace("LAWS", LAWS))
}

/// Whether a part of two states is the same.
fn is_same(part: Part, a: &State, b: &State) -> bool {
    let (p, q) = (&a.particles, &b.particles);
    match part {
        Part::Places => p.position == q.position && p.orientation == q.orientation,
        Part::Motions => p.velocity == q.velocity && p.angular_velocity == q.angular_velocity,
        Part::Loads => p.force == q.force && p.torque == q.torque,
        Part::Particles => {
            p.id == q.id
                && p.slot == q.slot
                && p.owner == q.owner
                && p.material == q.material
                && p.declared == q.declared
                && a.exchange == b.exchange
        }
        Part::Lists => a.neighbours == b.neighbours,
        Part::Contacts => a.contacts == b.contacts && a.walls == b.walls,
        Part::Bonds => a.bonds == b.bonds && a.breaks == b.breaks && p.bonds == q.bonds,
        Part::Boundaries => a.boundaries == b.boundaries && a.nodes == b.nodes,
        Part::Clumps => a.clumps == b.clumps,
        Part::Cell => a.cell == b.cell,
        Part::Books => {
            a.ledger == b.ledger
                && a.losses == b.losses
                && a.damping_force == b.damping_force
                && a.damping_impulse == b.damping_impulse
        }
        Part::Heat => a.heat == b.heat,
        Part::Fluid => a.fluid == b.fluid,
        Part::Traces => a.traces == b.traces,
        Part::Speed => a.clock.speed == b.clock.speed && a.foresight == b.foresight,
    }
}

/// What stages wrote in some time steps: name and part, in words.
fn written(mut simulation: Simulation, steps: u32) -> BTreeSet<(&'static str, String)> {
    let found = Arc::new(Mutex::new(BTreeSet::new()));
    let (told, mut before) = (Arc::clone(&found), None::<State>);
    simulation.watch(Box::new(move |name, state| {
        if let Some(before) = before.as_ref().filter(|_| name != "between time steps") {
            for part in Part::ALL.into_iter().filter(|part| !is_same(*part, before, state)) {
                told.lock().expect("one thread tells").insert((name, format!("{part:?}")));
            }
        }
        before = Some(state.clone());
    }));
    simulation.advance(f64::from(steps) * 1e-5).expect("it runs");
    drop(simulation);
    Arc::into_inner(found).expect("nobody watches any more").into_inner().expect("one thread told")
}

/// The names of the stages of a scene.
fn names(simulation: &Simulation) -> Vec<&'static str> {
    simulation.stages().map(|(_, stage)| stage.name).collect()
}

#[test]
fn bare_spheres_have_five_stages() {
    let simulation = start(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1e-5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
[contact.all.normal.hertz]
[particles.a]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.0, 0.0, 0.005], radius = 0.002 }]
"#,
    );
    let few = ["first half kick and drift", "way", "lists", "contacts", "second half kick"];
    assert_eq!(names(&simulation), few);
}

#[test]
fn scenes_in_the_open_in_a_cell_and_in_water_have_every_stage() {
    let scenes = [OPEN, CELL, WATER].map(with_laws);
    let all: BTreeSet<_> = scenes.iter().flat_map(names).collect();
    let missing: Vec<_> = all_stages().map(|(_, stage)| stage.name).filter(|name| !all.contains(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn a_stage_writes_nothing_that_it_does_not_say() {
    let mut found = written(with_laws(OPEN), 600);
    found.extend(written(with_laws(CELL), 200));
    found.extend(written(with_laws(WATER), 20));
    let said: BTreeSet<_> = all_stages()
        .flat_map(|(_, stage)| stage.writes.iter().map(move |part| (stage.name, format!("{part:?}"))))
        .collect();
    let unsaid: Vec<_> = found.difference(&said).collect();
    assert!(unsaid.is_empty(), "written without a word: {unsaid:?}");
    let wrote = |name: &str| found.iter().any(|(stage, _)| *stage == name);
    // What the first stage of a step writes is not looked at.
    let silent: Vec<_> =
        all_stages().skip(1).map(|(_, stage)| stage).filter(|stage| !stage.writes.is_empty()).collect();
    let silent: Vec<_> = silent.into_iter().map(|stage| stage.name).filter(|name| !wrote(name)).collect();
    assert!(silent.is_empty(), "never at work: {silent:?}");
}

/// The list of the stages as a table of the docs.
fn table() -> String {
    let words = |parts: &[Part]| {
        let words: Vec<String> = parts.iter().map(|part| format!("{part:?}").to_lowercase()).collect();
        if words.is_empty() { "–".to_owned() } else { words.join(", ") }
    };
    let mut text = String::from("| phase | stage | scenes with | reads | writes |\n|---|---|---|---|---|\n");
    let mut last = None;
    for (phase, stage) in all_stages() {
        let name = match phase {
            _ if last == Some(phase) => "",
            Phase::Motion => "motion",
            Phase::Forces => "forces",
            Phase::Kick => "kick",
        };
        last = Some(phase);
        let (reads, writes) = (words(stage.reads), words(stage.writes));
        let _ = writeln!(text, "| {name} | {} | {} | {reads} | {writes} |", stage.name, stage.scenes);
    }
    text
}

#[test]
fn the_docs_list_the_stages_as_the_program_does() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md");
    let text = std::fs::read_to_string(page).expect("the page is there").replace("\r\n", "\n");
    assert!(text.contains(&table()), "expected in docs/architecture.md:\n{}", table());
}
