//! Scenes that are accepted, and scenes that are refused with the very message they hold after `#!`.

use cograin::bond::breakage::stress::StressLimits;
use cograin::contact::Scheme;
use cograin::contact::property::FRICTION;
use cograin::quantity::{MaterialIndex, Positive};
use cograin::scene::{AxisMotion, InputCourse, Scene, SceneDraft, Source, Step};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the test scenes.
fn folder(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(kind)
}

/// The scenes of a folder, by name.
fn scenes(kind: &str) -> Vec<PathBuf> {
    let mut scenes: Vec<PathBuf> = fs::read_dir(folder(kind))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    scenes.sort();
    scenes
}

/// A good scene.
fn good(name: &str) -> Scene {
    Scene::read(&folder("good").join(name)).map_err(|errors| errors.to_string()).unwrap().0
}

#[test]
fn every_bad_scene_gives_its_message() {
    let mut faults = Vec::new();
    for path in scenes("bad") {
        let text = fs::read_to_string(&path).unwrap();
        let expected: Vec<&str> =
            text.lines().filter_map(|line| line.strip_prefix("#!")).map(str::trim_start).collect();
        let found = match Scene::read(&path) {
            Ok(_) => "accepted".to_owned(),
            Err(errors) => errors.to_string(),
        };
        if found != expected.join("\n") {
            let name = path.file_name().unwrap().to_string_lossy();
            faults.push(format!("{name}:\nexpected\n{}\nfound\n{found}\n", expected.join("\n")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_good_scene_is_accepted_from_its_file_and_from_its_source_alone() {
    for path in scenes("good") {
        let (scene, source) = Scene::read(&path).map_err(|errors| errors.to_string()).unwrap();
        let again = Scene::from_source(&source).map_err(|errors| errors.to_string()).unwrap();
        assert_eq!(scene.particles, again.particles, "{}", path.display());
        assert_eq!(scene.fingerprint, again.fingerprint);
        assert_ne!(scene.fingerprint, 0);
    }
}

#[test]
fn an_empty_scene_has_the_defaults() {
    let scene = Scene::from_source(&Source::default()).unwrap();
    assert_eq!(scene.run.step, Step::Following);
    assert_eq!((scene.run.seed, scene.run.threads, scene.run.skin), (1, None, None));
    assert_eq!(scene.run.max_overlap, 0.05);
    assert_eq!(scene.gravity, [0.0; 3]);
    assert!(scene.particles.is_empty() && scene.contacts.is_empty() && scene.domain.is_none());
}

#[test]
fn a_scene_that_is_not_there_is_refused() {
    let errors = Scene::read(&folder("bad").join("nowhere.toml")).unwrap_err();
    assert_eq!(errors.to_string(), "nowhere.toml: the scene cannot be read: there is no such file");
}

#[test]
fn everything_written_arrives() {
    let scene = good("everything.toml");
    assert_eq!(scene.run.step, Step::Given(1e-6));
    assert_eq!((scene.run.end, scene.run.threads, scene.run.seed), (Some(0.5), Some(2), 7));
    assert_eq!((scene.run.skin, scene.run.max_overlap), (Some(1e-4), 0.1));
    assert_eq!(scene.gravity, [0.0, 0.0, -9.81]);
    let names: Vec<&str> = scene.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["glass", "steel"]);
    assert_eq!(scene.pairs[1], scene.pairs[2]);
    assert_eq!(scene.pairs[1].get(&FRICTION), Some(0.2));
    assert_eq!(scene.pairs[3].get(&FRICTION), None);
    assert_eq!(scene.contacts[0].between, [true, false, false, false]);
    assert_eq!(scene.contacts[1].between, [false, true, true, false]);
    assert_eq!(scene.contacts[0].choice.switches.least_force, 0.0);
    assert_eq!(scene.contacts[1].choice.switches.least_force, f64::NEG_INFINITY);
    assert_eq!(scene.contacts[0].choice.switches.tangential_damping_factor, 1.0);
    assert_eq!(scene.contacts[1].choice.switches.tangential_damping_factor, 0.0);
    assert_eq!(scene.domain, Some([[-1.0; 3], [1.0; 3]]));
    assert_eq!(scene.output.frame_interval, Some(1e-2));
    assert!(scene.output.contacts && scene.output.energy);
}

#[test]
fn particles_without_a_number_are_numbered_above_those_with_one() {
    let scene = good("everything.toml");
    let ids: Vec<u32> = scene.particles.iter().map(|particle| particle.id.0).collect();
    assert_eq!(ids, [12, 13, 14, 15, 16]);
    assert_eq!(scene.particles[0].density, 2600.0);
    assert_eq!(scene.particles[1].velocity, [0.0, 0.0, -1.0]);
    assert_eq!(scene.particles[1].density, 2500.0);
    assert_eq!(scene.particles[2].angular_velocity, [1.0, 2.0, 3.0]);
    assert_eq!(scene.sets, ["few", "held"]);
}

#[test]
fn boundaries_move_along_the_axes_named() {
    let scene = good("everything.toml");
    let (floor, grip) = (&scene.boundaries[0], &scene.boundaries[1]);
    use AxisMotion::{Driven, Fixed, Prescribed};
    assert_eq!(floor.axes, [Prescribed(0.1), Fixed, Driven, Fixed, Fixed, Fixed]);
    assert_eq!(floor.input, InputCourse::Smooth);
    assert_eq!(floor.shape.plane().unwrap().normal, [0.0, 0.0, 1.0]);
    assert_eq!(grip.shape.members(), [3, 4]);
    assert_eq!(grip.axes, [const { Fixed }; 6]);
    assert_eq!(grip.reference, [0.0, 0.109, 0.02]);
}

#[test]
fn damping_and_forces_are_per_particle() {
    let scene = good("everything.toml");
    let damping = &scene.damping[0];
    assert_eq!(damping.linear, [0.35, 0.35, 0.35, 0.0, 0.0]);
    assert_eq!(damping.angular, [0.25, 0.25, 0.25, 0.0, 0.0]);
    assert!(damping.gravity_damped && !damping.applied_forces_damped);
    assert_eq!(scene.forces[0].members, [0, 1]);
}

/// The two grains that each of the files of grains holds.
fn expect_the_grains(name: &str) -> Scene {
    let scene = good(name);
    let [steel, glass] = &scene.particles[..] else { panic!("{name}: {} particles", scene.particles.len()) };
    assert_eq!((steel.id.0, steel.material.0, steel.radius), (3, 1, 0.02), "{name}");
    assert_eq!((glass.id.0, glass.material.0, glass.radius), (7, 0, 0.01), "{name}");
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-15 * b.abs();
    assert!(near(steel.density, 7900.0) && near(glass.density, 2600.0), "{name}");
    assert_eq!((steel.position, glass.position), ([0.1, 0.0, 0.0], [0.0; 3]), "{name}");
    assert_eq!((steel.velocity, steel.angular_velocity), ([0.0; 3], [0.0; 3]), "{name}");
    assert_eq!((glass.velocity, glass.angular_velocity), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]), "{name}");
    scene
}

#[test]
fn every_file_format_gives_the_same_grains() {
    for name in ["from_csv.toml", "from_gz.toml", "from_vtu.toml", "from_data.toml", "from_dump.toml"] {
        expect_the_grains(name);
    }
}

#[test]
fn damping_is_scaled_by_a_column_of_the_file() {
    for name in ["from_csv.toml", "from_dump.toml"] {
        let scene = good(name);
        assert_eq!(scene.damping[0].linear, [1.0, 0.25], "{name}");
        assert_eq!(scene.damping[0].angular, [0.5, 0.125], "{name}");
    }
}

#[test]
fn generated_sets_hold_as_many_as_they_say() {
    let scene = good("generated.toml");
    let mut counts = vec![0; scene.sets.len()];
    for particle in &scene.particles {
        counts[particle.set.index()] += 1;
    }
    // 2 × 2 × 1; 8 cells of 2; 8 cells of 4; 6 cells of 4; the packing.
    assert_eq!(counts, [4, 16, 32, 24, 300]);
    assert!(scene.particles.iter().all(|particle| (particle.set.0 == 3) == (particle.velocity[2] == -1.0)));
}

#[test]
fn a_changed_file_changes_the_fingerprint() {
    let (scene, mut source) = Scene::read(&folder("good").join("from_csv.toml")).unwrap();
    source.files.values_mut().for_each(|bytes| bytes.push(b'\n'));
    assert_ne!(Scene::from_source(&source).unwrap().fingerprint, scene.fingerprint);
}

#[test]
fn a_file_that_was_not_handed_over_is_named() {
    let (_, mut source) = Scene::read(&folder("good").join("from_csv.toml")).unwrap();
    source.files.clear();
    let message = Scene::from_source(&source).unwrap_err().to_string();
    assert_eq!(
        message,
        "from_csv.toml, line 8, [particles.grains] file: ../files/grains.csv cannot be read: \
         it was not handed over with the scene"
    );
}

#[test]
fn a_value_that_no_key_takes_is_refused_in_a_draft() {
    /// What is changed, the table and the key that are named for it.
    type Case = (fn(&mut SceneDraft), &'static str, &'static str);
    let cases: [Case; 12] = [
        (|draft| draft.particles[1].radius = f64::NAN, "particles", "radius"),
        (|draft| draft.particles[1].position[2] = f64::INFINITY, "particles", "position"),
        (|draft| draft.particles[0].material = MaterialIndex(99), "particles", "material"),
        (|draft| draft.particles[1].id = draft.particles[0].id, "particles", "id"),
        (|draft| draft.materials[0].density = -1.0, "material.glass", "density"),
        (|draft| draft.materials[0].name = "two words".into(), "material.two words", ""),
        (|draft| draft.pairs.clear(), "pair", ""),
        (|draft| draft.gravity[1] = f64::NAN, "", "gravity"),
        (|draft| draft.run.step = Step::Given(0.0), "run", "step"),
        (|draft| draft.run.threads = Some(0), "run", "threads"),
        (|draft| draft.contacts[0].between[1] ^= true, "contact.grains", "between"),
        (|draft| draft.boundaries[0].reference[0] = f64::NAN, "boundary.floor", "reference"),
    ];
    for (number, (spoil, table, key)) in cases.iter().enumerate() {
        let mut draft = good("everything.toml").into_draft();
        spoil(&mut draft);
        let errors = draft.build().expect_err(&format!("case {number} is refused"));
        assert_eq!((&*errors.list[0].table, &*errors.list[0].key), (*table, *key), "case {number}: {errors}");
    }
}

#[test]
fn a_draft_that_says_two_things_is_refused() {
    let refused = |scene: &str, spoil: fn(&mut SceneDraft)| {
        let mut draft = good(scene).into_draft();
        spoil(&mut draft);
        let error = draft.build().expect_err("it says two things").list.remove(0);
        format!("{} {}", error.table, error.key)
    };
    let scheme = |draft: &mut SceneDraft| draft.run.scheme = Scheme::Engine;
    assert_eq!(refused("everything.toml", scheme), "contact.grains scheme");
    let bonded = |spoil| refused("bonded.toml", spoil);
    assert_eq!(bonded(|draft| draft.bonds[0].keys.between[0] = "nobody".into()), "bond.beam between");
    assert_eq!(bonded(|draft| draft.bonds[0].pairs = vec![[0, 1]]), "bond.beam create");
    assert_eq!(bonded(|draft| draft.bonds[1].pairs.swap(0, 1)), "bond.chain create.pairs");
    assert_eq!(bonded(|draft| draft.bonds[1].pairs.clear()), "bond.chain create.pairs");
}

#[test]
fn the_numbers_of_a_bond_are_those_of_its_keys() {
    let mut draft = good("bonded.toml").into_draft();
    draft.bonds[0].keys.normal_stiffness = Positive::new(3e9).unwrap();
    assert_eq!(draft.build().unwrap().bond_law(0).elasticity.tension, 3e9);
}

#[test]
fn a_scene_built_in_code_is_checked_too() {
    let mut scene = good("everything.toml").into_draft();
    assert!(scene.clone().build().is_ok());
    scene.particles[0].position = scene.particles[1].position;
    scene.domain = Some([[0.5; 3], [1.0; 3]]);
    let message = scene.build().unwrap_err().to_string();
    assert_eq!(
        message,
        "[domain] box: expected a box that holds every centre, found particle 12 outside at [0.0, 0.0, 0.02] m, and \
         4 more particles\n[particles.few]: expected overlaps of at most 0.1 of the smaller radius ([run] \
         max_overlap), found 2.000 between particles 12 and 13"
    );
}

/// Tables that an example of the documentation leaves out because they are not its matter.
const AROUND: [(&str, &str); 4] = [
    ("[material.glass]", "density = 2500.0\nyoungs_modulus = 1e9\npoissons_ratio = 0.25"),
    ("[material.steel]", "density = 7800.0\nyoungs_modulus = 2e11\npoissons_ratio = 0.3"),
    (
        "[particles.near]",
        "material = \"glass\"\nlattice = { kind = \"simple_cubic\", counts = [2, 2, 2], radius = 1e-3 }",
    ),
    ("[boundary.wall]", "plane = { point = [0, 0, -0.5], normal = [0, 0, 1] }\nmaterial = \"steel\""),
];

/// An example of the documentation as a whole scene, with the files it names.
fn example(text: &str) -> Source {
    let mut whole = text.to_owned();
    for (header, keys) in AROUND {
        let kind = header.split('.').next().unwrap();
        // No wall stands beside a cell that is deformed.
        if kind == "[boundary" && text.contains("[cell]") {
            continue;
        }
        if !text.contains(header) && (kind == "[material" || !text.contains(kind)) {
            whole = format!("{whole}\n{header}\n{keys}\n");
        }
    }
    let files = fs::read_dir(folder("files")).unwrap().map(|entry| entry.unwrap().path());
    let files = files.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()));
    Source { name: "docs/scene.md".to_owned(), text: whole, files: files.collect() }
}

#[test]
fn every_example_of_the_documentation_is_accepted() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md")).unwrap();
    let examples: Vec<&str> = text.split("```toml\n").skip(1).map(|rest| rest.split_once("\n```").unwrap().0).collect();
    assert!(examples.len() > 10);
    for text in examples {
        let source = example(text);
        if let Err(errors) = Scene::from_source(&source) {
            panic!("{errors}\nin\n{}", source.text);
        }
    }
}

#[test]
fn every_model_is_accepted() {
    let models = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("models")).unwrap();
    for path in models.map(|entry| entry.unwrap().path().join("scene.toml")).filter(|path| path.exists()) {
        if let Err(errors) = Scene::read(&path) {
            panic!("{}: {errors}", path.display());
        }
    }
}

/// The text with a few characters lost, doubled or swapped for those of its own.
fn damaged(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..1 + random.next_u32() % 4 {
        if bytes.is_empty() {
            break;
        }
        let mut place = || random.next_u32() as usize % bytes.len();
        let (here, there) = (place(), place());
        match random.next_u32() % 4 {
            0 => drop(bytes.remove(here)),
            1 => bytes.insert(here, bytes[there]),
            2 => bytes[here] = bytes[there],
            _ => bytes.truncate(bytes.len() - there % 8),
        }
    }
    bytes
}

/// Reads so many damaged copies of each good scene; how many were refused.
fn refused_of_damaged(copies: usize, seed: u64) -> usize {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut refused = 0;
    for path in scenes("good") {
        let (_, whole) = Scene::read(&path).unwrap();
        for _ in 0..copies {
            let mut source = whole.clone();
            if let Some(bytes) = source.files.values_mut().next().filter(|_| random.next_u32() % 2 == 0) {
                *bytes = damaged(bytes, &mut random);
            } else {
                source.text = String::from_utf8_lossy(&damaged(source.text.as_bytes(), &mut random)).into_owned();
            }
            if let Err(errors) = Scene::from_source(&source) {
                refused += 1;
                assert!(!errors.list.is_empty() && errors.list.iter().all(|error| !error.file.is_empty()));
            }
        }
    }
    refused
}

#[test]
fn a_damaged_scene_or_file_is_accepted_or_refused_and_never_panics() {
    let refused = refused_of_damaged(200, 11);
    assert!(refused > 500, "only {refused} refused");
}

/// `cargo test --test library scenes:: -- --ignored`
#[test]
#[ignore = "takes a minute"]
fn twenty_thousand_damaged_scenes_end_in_words() {
    let refused = refused_of_damaged(20_000 / scenes("good").len() + 1, 12);
    assert!(refused > 5_000, "only {refused} refused");
}

#[test]
fn thousands_of_mistakes_are_found_in_linear_time_and_twenty_are_printed() {
    let entry = "{ position = [0, 0, 0], radius = 1, colour = 1 },\n";
    let text =
        format!("[material.a]\ndensity = 1\n[particles.p]\nmaterial = \"a\"\nlist = [\n{}]\n", entry.repeat(20_000));
    let source = Source { name: "scene.toml".to_owned(), text, ..Source::default() };
    let errors = Scene::from_source(&source).unwrap_err();
    assert_eq!(errors.list.len(), 20_000);
    assert_eq!(errors.list[19_999].line, Some(20_005));
    let printed = errors.to_string();
    assert_eq!(printed.lines().count(), 21);
    assert!(printed.ends_with("\nand 19980 more mistakes"), "{printed}");
}

#[test]
fn a_table_or_a_script_given_as_a_scene_is_one_mistake() {
    let table = format!("x,y,z,radius\n{}", "0.0,0.0,0.0,0.1\n".repeat(3000));
    let source = Source { name: "bed.csv".to_owned(), text: table, ..Source::default() };
    assert_eq!(
        Scene::from_source(&source).unwrap_err().to_string(),
        "bed.csv: expected a scene in TOML whose [particles.<name>] names this file, found a table of numbers"
    );
}

#[test]
fn thousands_of_materials_are_refused_before_memory_is_asked_for() {
    let text: String = (0..5000).map(|material| format!("[material.m{material}]\ndensity = 1\n")).collect();
    let source = Source { name: "scene.toml".to_owned(), text, ..Source::default() };
    assert_eq!(
        Scene::from_source(&source).unwrap_err().to_string(),
        "scene.toml, line 1, [material]: expected at most 256 materials, found 5000"
    );
}

#[test]
fn damaged_data_of_a_vtk_file_are_told_in_words() {
    let (_, mut source) = Scene::read(&folder("good").join("from_vtu.toml")).unwrap();
    let whole = source.files.values().next().unwrap().clone();
    let file = String::from_utf8(whole).unwrap().replacen("format=\"ascii\">", "format=\"binary\">AAAA", 1);
    *source.files.values_mut().next().unwrap() = file.into_bytes();
    let message = Scene::from_source(&source).unwrap_err().to_string();
    assert!(message.ends_with("found an array of points that is cut short or damaged"), "{message}");
}

#[test]
fn bonds_arrive_by_distance_and_by_list() {
    let scene = good("bonded.toml");
    let (beam, chain) = (&scene.bonds[0], &scene.bonds[1]);
    assert_eq!((beam.name.as_str(), beam.create_distance()), ("beam", Some(1.6e-3)));
    assert_eq!(beam.between.map(|set| set.0), [0, 0]);
    let ids: Vec<[u32; 2]> =
        chain.pairs.iter().map(|pair| pair.map(|index| scene.particles[index as usize].id.0)).collect();
    assert_eq!(ids, [[20, 10], [30, 10]]);
    let [rule] = &scene.bond_law(1).breakage[..] else { panic!("one rule") };
    assert_eq!(rule.numbers::<StressLimits>().map(|limits| limits.compression_strength), Some(1e7));
}
