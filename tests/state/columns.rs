//! A column that is declared once is sorted, given to images, saved, restored, checked, written to frames, read from them and taken over.

use crate::support::Files;
use cograin::column::Column;
use cograin::contact::Material;
use cograin::results::{Checkpoint, write_checkpoint};
use cograin::run::FrameWriter;
use cograin::scene::{Models, Scene, Source};
use cograin::simulation::{Description, Simulation};
use cograin::state::{IMAGE, State};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A column that a scene with a contact law asks for.
static DYE: Column = Column {
    name: "dye",
    unit: "mol/m3",
    about: "concentration of a dye",
    aliases: &["f_dye"],
    takes: |value| value >= 0.0,
    expected: "a number of 0 or above",
    start: None,
    shared: Some(|material: &Material, mass: f64| mass / material.density),
    asked_by: &["contact.*"],
};

/// A column with a value of its own for particles that say nothing.
static AGE: Column = Column {
    name: "age",
    unit: "s",
    about: "age",
    aliases: &[],
    takes: |_| true,
    expected: "a number",
    start: Some(-1.0),
    shared: None,
    asked_by: &["contact.*"],
};

/// A gas of spheres in a periodic cell, sheared, so that lists are made anew, and clumps among them.
const GAS: &str = r#"
[run]
step = 1e-5
[material.a]
density = 2000.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.9
friction = 0.3
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.gas]
material = "a"
file = "gas.csv"
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 1e-3 }, { position = [1e-3, 0.0, 0.0], radius = 1e-3 }]
[particles.pairs]
material = "a"
clump = "pair"
list = [
  { position = [5e-3, 5e-3, 17e-3], velocity = [1.0, 0.3, 0.0], dye = 7.5 },
  { position = [12e-3, 5e-3, 17e-3], velocity = [-1.0, 0.0, 0.2] },
]
dye = 8.5
[cell]
edges = [[20e-3, 0.0, 0.0], [0.0, 20e-3, 0.0], [0.0, 0.0, 20e-3]]
"#;

/// The dye of the sphere with this number.
fn dye(number: u32) -> f64 {
    f64::from(number * number) + 0.1
}

/// The file of the gas.
fn gas() -> Files {
    let mut text = "id,x,y,z,radius,vx,vy,vz,dye\n".to_owned();
    for number in 1..=48_u32 {
        let place = [number % 4, number / 4 % 4, number / 16].map(|part| 2.5e-3 + 5e-3 * f64::from(part));
        let velocity = [number % 7, number % 5, number % 3].map(|part| 0.7 * f64::from(part) - 1.0);
        let [x, y, z] = place;
        let [u, v, w] = velocity;
        text += &format!("{number},{x},{y},{z},1.2e-3,{u},{v},{w},{}\n", dye(number));
    }
    BTreeMap::from([("gas.csv".to_owned(), text.into_bytes())])
}

/// The scene of a text that may name both columns, or why it is refused.
fn read(text: &str, files: Files) -> Result<Arc<Scene>, String> {
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files };
    let models = Models::standard().with_column(&DYE).with_column(&AGE);
    models.scene(&source, &[]).map(Arc::new).map_err(|errors| errors.to_string())
}

/// The same, which is right.
#[track_caller]
fn scene(text: &str, files: Files) -> Arc<Scene> {
    read(text, files).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// The values of a column by the number of each particle that is there.
fn values(simulation: &Simulation, column: &str) -> BTreeMap<u32, f64> {
    let place = simulation.scene().column(column).expect("the scene has it");
    let particles = &simulation.state().particles;
    let value = |slot: usize| (simulation.number(particles.id[slot]), particles.declared[place][slot]);
    particles.slots().map(value).collect()
}

/// A folder of this test alone.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("cograin_columns_{name}_{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

/// A simulation of the gas, some lists later.
fn moved() -> Simulation {
    let mut simulation = Simulation::new(scene(GAS, gas())).expect("it starts");
    simulation.advance(0.02).expect("it runs");
    assert!(simulation.state().clock.rebuilds > 5, "lists were made anew");
    simulation
}

/// What the gas begins with.
fn begun() -> BTreeMap<u32, f64> {
    let pairs = [(49, 7.5), (50, 7.5), (51, 8.5), (52, 8.5)];
    (1..=48).map(|number| (number, dye(number))).chain(pairs).collect()
}

#[test]
fn values_follow_particles_and_images_through_new_lists() {
    let simulation = moved();
    assert_eq!(values(&simulation, "dye"), begun());
    assert!(values(&simulation, "age").values().all(|age| *age == -1.0));
    let particles = &simulation.state().particles;
    let images: Vec<usize> = (0..particles.len()).filter(|&slot| particles.owner[slot] == IMAGE).collect();
    assert!(!images.is_empty());
    for slot in images {
        let original = particles.slot[particles.id[slot] as usize] as usize;
        assert_eq!(particles.declared[0][slot], particles.declared[0][original]);
    }
    assert_ne!(particles.id[..10], [0, 1, 2, 3, 4, 5, 6, 7, 8, 9], "they were sorted");
}

#[test]
fn images_follow_a_value_that_changes() {
    let mut state = moved().state().clone();
    let age = &mut state.particles.declared[1];
    age.iter_mut().zip(&state.particles.id).for_each(|(age, &index)| *age = f64::from(index));
    let mut simulation = Simulation::resume(scene(GAS, gas()), state).expect("it is a state of the scene");
    simulation.advance(0.01).expect("it runs");
    let particles = &simulation.state().particles;
    assert!(particles.declared[1].iter().zip(&particles.id).all(|(&age, &index)| age == f64::from(index)));
}

#[test]
fn values_are_saved_and_restored() {
    let mut simulation = moved();
    let bytes = simulation.state().to_bytes(simulation.scene().fingerprint);
    let read = State::from_bytes(&bytes, simulation.scene().fingerprint).expect("it is a state");
    assert_eq!(read, *simulation.state());
    let mut resumed = Simulation::resume(scene(GAS, gas()), read).expect("it is one of the scene");
    for one in [&mut simulation, &mut resumed] {
        one.advance(0.005).expect("it runs");
    }
    assert_eq!(resumed.state().fingerprint(), simulation.state().fingerprint());
}

#[test]
fn states_whose_values_cannot_be_are_refused() {
    let simulation = moved();
    let right = simulation.state();
    let of_clump = right.particles.slot[50] as usize;
    let refused = |change: &dyn Fn(&mut Vec<Vec<f64>>), part: &str| {
        let mut state = right.clone();
        change(&mut state.particles.declared);
        let fault = simulation.check(&state).expect_err(part);
        assert!(fault.to_string().contains(part), "{fault}");
    };
    simulation.check(right).expect("it is sound");
    refused(&|columns| columns[1][3] = f64::NAN, "finite numbers");
    refused(&|columns| columns[0][3] = -1.0, "a number of 0 or above");
    refused(&|columns| columns[1].truncate(9), "one for each particle");
    refused(&|columns| columns.truncate(1), "as many as the scene has");
    refused(&|columns| columns[0][of_clump] = 3.0, "one value for all particles of a group or clump");
}

#[test]
fn frames_have_the_values_and_scenes_read_them_back() {
    let spheres = GAS.split("[clump.pair]").next().expect("a beginning");
    let frame = |kind: &str, scene_text: &str| {
        let folder = folder(kind);
        let text = scene_text.replace("[run]", "[output]\nframe_interval = 0.02\n[run]");
        let simulation = Simulation::new(scene(&text, gas())).expect("it starts");
        drop(FrameWriter::open(&folder, &simulation, 0.0, 0.0).expect("it writes"));
        let files = std::fs::read_dir(&folder).expect("a folder").map(|file| file.expect("a file").path());
        let is_it = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind));
        let mut files: Vec<PathBuf> =
            files.filter(is_it).filter(|it| it.extension().is_some_and(|it| it == "vtu")).collect();
        let frame = std::fs::read(files.pop().expect("a frame")).expect("it is read");
        std::fs::remove_dir_all(folder).expect("it is removed");
        frame
    };
    let files = BTreeMap::from([("frame.vtu".to_owned(), frame("particles", spheres))]);
    let read = spheres.replace("gas.csv", "frame.vtu");
    let read = read
        .replace("material = \"a\"\nfile", "materials = { 0 = \"a\" }\nfile")
        .replace("[run]", "[run]\nmax_overlap = 3.0");
    let again = scene(&read, files);
    let start: BTreeMap<u32, f64> =
        again.particles.iter().zip(&again.columns[0].particles).map(|(it, &value)| (it.id.0, value)).collect();
    assert_eq!(start, begun().into_iter().filter(|(number, _)| *number <= 48).collect());
    let clumps = String::from_utf8_lossy(&frame("clumps", GAS)).into_owned();
    assert!(clumps.contains("\"dye\"") && !clumps.contains("\"age\""), "a shared column is one of the clumps");
}

#[test]
fn a_later_scene_takes_the_values_over() {
    let first = moved();
    let folder = folder("taken");
    let path = folder.join("reached.cograin");
    write_checkpoint(&path, first.state(), first.scene(), "first.toml").expect("it is written");
    let checkpoint = || Checkpoint::read(&path).expect("it is read");
    let next = scene(&GAS.replace("friction = 0.3", "friction = 0.4"), gas());
    let taken = checkpoint().taken_over(&next).expect("it is taken over");
    assert_eq!(values(&taken.simulation, "dye"), begun());
    assert_eq!(taken.left_behind, Vec::<String>::new());
    // A scene without columns says that they stay behind, and one whose columns are new that they begin.
    let plain = GAS.replace(", dye = 7.5", "").replace("dye = 8.5\n", "");
    let plain = Arc::new(crate::support::read_with(&plain, gas()).expect("it is right"));
    let taken = checkpoint().taken_over(&plain).expect("it is taken over");
    assert!(taken.left_behind.iter().any(|left| left.contains("dye stays behind")), "{:?}", taken.left_behind);
    let from = Description::of(&plain, "plain.toml", taken.simulation.time());
    let (anew, left) = Simulation::taken_over(next, taken.simulation.state(), &from).expect("it is taken over");
    assert_eq!(values(&anew, "dye"), begun());
    assert!(left.iter().any(|left| left.contains("dye is not in the other state")), "{left:?}");
    std::fs::remove_dir_all(folder).expect("it is removed");
}

/// Two spheres of which a later scene makes a group.
const TWO: &str = r#"
[run]
step = 1e-5
[material.a]
density = 1000.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[material.b]
density = 3000.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.9
[pair.a.b]
restitution = 0.9
[pair.b.b]
restitution = 0.9
[contact.all.normal.hertz]
[particles.one]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 1e-3, dye = 1.0 }]
[particles.other]
material = "b"
list = [{ position = [0.0, 0.0, 4e-3], radius = 2e-3, dye = 10.0 }]
"#;

/// The group.
const GROUP: &str = "[boundary.both]\nparticles = { sets = [\"one\", \"other\"] }\n";

#[test]
fn a_group_begins_with_one_value_and_takes_the_mean_of_its_particles_over() {
    let refused = read(&format!("{TWO}{GROUP}"), Files::new()).unwrap_err();
    assert!(
        refused.contains("expected one dye of all its particles, found particles of dye 1.0 and 10.0"),
        "{refused}"
    );
    let first = Simulation::new(scene(TWO, Files::new())).expect("it starts");
    let group = scene(&format!("{TWO}{GROUP}").replace("dye = 10.0", "dye = 1.0"), Files::new());
    let from = Description::of(first.scene(), "first.toml", 0.0);
    let (taken, left) = Simulation::taken_over(group, first.state(), &from).expect("it is taken over");
    // Volumes are as 1 to 8.
    let mean = (1.0 + 8.0 * 10.0) / 9.0;
    for (number, value) in values(&taken, "dye") {
        assert!((value / mean - 1.0).abs() < 1e-15, "particle {number}: {value}, expected {mean}");
    }
    assert!(left.iter().any(|left| left.contains("the particles of [boundary.both] take the mean dye")), "{left:?}");
}

/// Spheres that come and go.
const FLOW: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2e-5
[material.a]
density = 2000.0
youngs_modulus = 1e6
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
[contact.all.normal.hertz]
[region.mouth]
box = [[0.0, 0.0, 0.05], [0.02, 0.02, 0.06]]
[insertion.rain]
region = "mouth"
material = "a"
sizes = { radius = 1e-3 }
count_rate = 500.0
dye = 2.5
[outlet.drain]
beyond = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
"#;

#[test]
fn what_comes_has_the_value_of_its_insertion() {
    let mut simulation = Simulation::new(scene(FLOW, Files::new())).expect("it starts");
    simulation.advance(0.2).expect("it runs");
    let exchange = simulation.state().exchange.as_ref().expect("particles come and go");
    assert!(exchange.outlets[0].count > 10, "some went");
    let dyes = values(&simulation, "dye");
    assert!(dyes.len() > 10 && dyes.values().all(|dye| *dye == 2.5), "{dyes:?}");
    assert!(values(&simulation, "age").values().all(|age| *age == -1.0));
}

#[test]
fn wrong_and_missing_values_are_refused_in_words() {
    let refused = |text: &str, part: &str| {
        let found = read(text, gas()).expect_err(part);
        assert!(found.contains(part), "{found}");
    };
    let missing = "concentration of a dye [mol/m3]: this scene asks for it";
    refused(&GAS.replace("dye = 8.5\n", ""), missing);
    refused(&FLOW.replace("dye = 2.5\n", ""), missing);
    refused(&TWO.replace(", dye = 10.0", ""), missing);
    refused(&GAS.replace("dye = 8.5", "dye = -8.5"), "expected a number of 0 or above, found -8.5");
    refused(&GAS.replace("dye = 7.5", "dye = \"red\""), "list.1.dye");
    refused(&FLOW.replace("dye = 2.5", "dye = nan"), "expected a finite number");
    refused(&GAS.replace("dye = 8.5", "dyes = 8.5"), "dye");
    let mut files = gas();
    let text = files.get_mut("gas.csv").expect("the file");
    *text = String::from_utf8(text.clone()).expect("text").replace("2304.1", "-2304.1").into_bytes();
    let found = read(GAS, files).expect_err("a value below 0");
    assert!(found.contains("gas.csv, line 49") && found.contains("found -2304.1"), "{found}");
}

#[test]
fn a_file_may_have_another_name_for_it_and_a_value_of_the_set_beside_it_is_remarked_upon() {
    let mut files = gas();
    let text = files.get_mut("gas.csv").expect("the file");
    *text = String::from_utf8(text.clone()).expect("text").replace(",dye\n", ",f_dye\n").into_bytes();
    let text = GAS.replace("file = \"gas.csv\"", "file = \"gas.csv\"\ndye = 4.0");
    let scene = scene(&text, files);
    assert_eq!(scene.columns[0].particles[47], dye(48));
    assert_eq!(scene.unread, ["[particles.gas] dye: nothing reads it; each of its particles has its own"]);
}

#[test]
fn values_that_a_scene_does_not_ask_for_are_remarked_upon_and_cost_nothing() {
    static IDLE: Column = Column { name: "idle", asked_by: &["contact.*.cohesion"], ..DYE };
    let source = Source { name: "scene.toml".to_owned(), text: TWO.replace("dye", "idle"), files: Files::new() };
    let scene = Models::standard().with_column(&IDLE).scene(&source, &[]).expect("it is right");
    assert!(scene.unread[0].starts_with("[particles.one] idle: nothing reads it; this scene does not ask for it"));
    let simulation = Simulation::new(Arc::new(scene)).expect("it starts");
    assert_eq!(simulation.state().particles.declared, Vec::<Vec<f64>>::new());
}
