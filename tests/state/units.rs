//! No length, time, mass or force is built in: a scene in units of powers of two gives the same bits.
//!
//! With lengths and times times 2^k and masses times 2^(3k), speeds, densities and pressures keep their numbers, and all else is times
//! a power of two. The automatic step has no absolute bound, and odd roots are those of numbers without units. Every number of a
//! scene has its unit here ([`exponent`]): a scene with a new key asks for it.

use crate::contacts::every_law::{bond_laws, contact_laws};
use crate::support::{Files, start_with};
use crate::surfaces::every_surface::text_of;
use cograin::interface::{Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use toml::{Table, Value as Toml};

/// The scales, as powers of two, odd ones among them.
const SCALES: &[i32] = &[-30, -19, 7, 20];

/// Those at which an automatic step has the same bits as well: it takes roots of masses, which are those of the numbers alone at even
/// powers.
const EVEN: &[i32] = &[-30, -20, 6, 20];

/// 2 to this power, exactly.
fn power(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

/// How often a number of a scene takes the factor of the scale: that of kilograms three times, of metres and seconds once. `path` is
/// where it stands, `normal` the normal model of the scene.
fn exponent(path: &[&str], normal: &str) -> i32 {
    let key = path.last().copied().unwrap_or_default();
    match (path[0], key) {
        ("gravity", _) => -1,
        ("run", "step" | "end") | ("output", "history_interval") => 1,
        ("run" | "output", _) => 0,
        ("material", _) => 0,
        ("pair", "normal_stiffness" | "tangential_stiffness") => i32::from(normal == "hooke_stiffness"),
        ("pair", "normal_damping" | "tangential_damping") => {
            if normal == "hooke_stiffness" {
                -1
            } else {
                -2
            }
        }
        ("pair", "damping_coefficient") => -2,
        ("pair", "fluid_viscosity" | "surface_energy") => 1,
        ("pair", "pull_off_force") => 2,
        ("pair", _) | ("contact", _) => 0,
        ("bond", "create_distance" | "max_distance") => 1,
        ("bond", "normal_stiffness" | "tangential_stiffness") => -1,
        ("bond", _) if path.contains(&"relaxation") => 1,
        ("bond", _) => 0,
        ("particles", "velocity" | "count" | "counts" | "solid_fraction") => 0,
        ("particles", "angular_velocity") => -1,
        ("particles", _) => 1,
        ("damping", _) => 0,
        ("region" | "domain" | "flow_meter", _) => 1,
        ("insertion", "mass_rate") => 2,
        ("insertion", "count_rate") => -1,
        ("insertion", "velocity" | "scatter") => 0,
        ("insertion", _) => 1,
        ("boundary", _) => of_boundary(path, key),
        _ => panic!("say the unit of {path:?}"),
    }
}

/// The same of a number of a boundary.
fn of_boundary(path: &[&str], key: &str) -> i32 {
    let turns = path.iter().any(|part| part.starts_with("rotation."));
    let within = |part: &str| path.contains(&part);
    match key {
        "point" | "centre" | "from" | "to" | "corner" | "edges" | "radius" | "radii" | "origin" | "profile"
        | "offset" => 1,
        "normal" | "axis" | "rotation" | "sides" => 0,
        "mass" => 3,
        "inertia" => 5,
        _ if within("stiffness") => {
            if turns {
                3
            } else {
                1
            }
        }
        _ if within("damping") => {
            if turns {
                4
            } else {
                2
            }
        }
        _ if within("loaded") => {
            if turns {
                3
            } else {
                2
            }
        }
        "target" => 2,
        "frequency" => -1,
        "amplitude" | "distance" => {
            if turns {
                0
            } else {
                1
            }
        }
        "speed" => {
            if turns {
                -1
            } else {
                0
            }
        }
        "acceleration" => {
            if turns {
                -2
            } else {
                -1
            }
        }
        "start" => 1,
        _ if within("prescribed") || within("conveying") => {
            if turns {
                -1
            } else {
                0
            }
        }
        _ => panic!("say the unit of {path:?}"),
    }
}

/// Multiplies every number of a part of a scene.
fn scale(part: &mut Toml, path: &mut Vec<String>, normal: &str, scale_power: i32) {
    match part {
        Toml::Table(table) => {
            for (key, value) in table.iter_mut() {
                path.push(key.to_owned());
                scale(value, path, normal, scale_power);
                path.pop();
            }
        }
        Toml::Array(items) => items.iter_mut().for_each(|item| scale(item, path, normal, scale_power)),
        Toml::Float(_) | Toml::Integer(_) => {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            let factor = power(scale_power * exponent(&path, normal));
            match *part {
                Toml::Float(number) => *part = Toml::Float(number * factor),
                Toml::Integer(number) if factor != 1.0 => *part = Toml::Float(number as f64 * factor),
                _ => {}
            }
        }
        _ => {}
    }
}

/// The text of a scene in other units.
fn scaled(text: &str, scale_power: i32) -> String {
    let mut table: Table = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
    let normal = (table.get("contact").and_then(Toml::as_table).into_iter().flat_map(|laws| laws.values()))
        .find_map(|law| law.get("normal")?.as_table()?.keys().next().cloned())
        .unwrap_or_default();
    for (key, value) in table.iter_mut() {
        scale(value, &mut vec![key.to_owned()], &normal, scale_power);
    }
    toml::to_string(&table).expect("it was read")
}

/// Files in other units: tables of a time and a way, corners of meshes.
fn scaled_files(files: &Files, scale_power: i32) -> Files {
    let number =
        |word: &str| word.parse::<f64>().map_or(word.to_owned(), |it| format!("{:?}", it * power(scale_power)));
    let line = |line: &str| match line.split_once(' ') {
        Some(("v", places)) => format!("v {}", places.split(' ').map(number).collect::<Vec<_>>().join(" ")),
        Some(_) => line.to_owned(),
        None => line.split(',').map(number).collect::<Vec<_>>().join(","),
    };
    let text = |bytes: &[u8]| -> Vec<u8> {
        let text = std::str::from_utf8(bytes).expect("it is text");
        text.lines().map(|it| line(it) + "\n").collect::<String>().into_bytes()
    };
    files.iter().map(|(name, bytes)| (name.clone(), text(bytes))).collect()
}

/// What is known of a simulation in the units of the scene as it is written, each number with its name.
fn told(simulation: &Simulation, scale_power: i32) -> Vec<(String, f64)> {
    let mut told = Vec::new();
    let mut tell = |name: String, number: f64, exponent: i32| {
        // What is not bounded is told as the largest number.
        let number = if number >= f64::MAX { f64::INFINITY } else { number };
        told.push((name, number * power(-scale_power * exponent)));
    };
    let clock = &simulation.state().clock;
    for (name, number) in
        [("time", clock.time), ("step", clock.step), ("last step", clock.last_step), ("stable", clock.stable)]
    {
        tell(name.to_owned(), number, 1);
    }
    tell("steps".to_owned(), clock.steps as f64, 0);
    tell("rebuilds".to_owned(), clock.rebuilds as f64, 0);
    let particles = &simulation.state().particles;
    for slot in 0..particles.len() {
        let rows = [
            ("position", particles.position[slot], [1, 1, 1, 1]),
            ("velocity", particles.velocity[slot], [0, 0, 0, 3]),
            ("angular velocity", particles.angular_velocity[slot], [-1, -1, -1, 5]),
            ("force", particles.force[slot], [2, 2, 2, 2]),
            ("torque", particles.torque[slot], [3, 3, 3, 3]),
        ];
        for (name, row, exponents) in rows {
            for axis in 0..4 {
                tell(format!("{name} {axis} of {slot}"), row[axis], exponents[axis]);
            }
        }
    }
    let interface = Interface::of(simulation.scene());
    for (index, variable) in interface.outputs() {
        let units = variable.quantity.base_units();
        if let Value::Real(number) = interface.value(simulation, index) {
            tell(variable.name.clone(), number, 3 * units.kilogram + units.metre + units.second);
        }
    }
    told
}

/// Runs a scene in units of these scales. `drive` gives inputs before each communication step of this length \[s\] by its number and a scale.
fn holds(
    name: &str,
    (text, files): (&str, &Files),
    (count, interval, scales): (u32, f64, &[i32]),
    drive: impl Fn(&mut Simulation, u32, i32),
) {
    let run = |scale_power: i32| {
        let mut simulation = start_with(&scaled(text, scale_power), scaled_files(files, scale_power));
        for number in 0..count {
            drive(&mut simulation, number, scale_power);
            let moved = simulation.advance(interval * power(scale_power));
            moved.unwrap_or_else(|error| panic!("{name} at 2^{scale_power}: {error}"));
        }
        told(&simulation, scale_power)
    };
    let expected = run(0);
    for &scale_power in scales {
        let found = run(scale_power);
        assert_eq!(found.len(), expected.len(), "{name} at 2^{scale_power}");
        let differs = |((_, a), (_, b)): &(&(String, f64), &(String, f64))| {
            a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan())
        };
        let others: Vec<_> = found.iter().zip(&expected).filter(differs).collect();
        let first =
            others.first().map(|((what, found), (_, expected))| format!("{what}: {found:e}, {expected:e} expected"));
        assert!(others.is_empty(), "{name} at 2^{scale_power}: {} of {} numbers, {first:?}", others.len(), found.len());
    }
}

/// No inputs.
fn still(_: &mut Simulation, _: u32, _: i32) {}

#[test]
fn every_contact_law_gives_the_same_bits() {
    for (name, text) in contact_laws() {
        holds(&name, (&text, &Files::new()), (1, 1.5e-4, SCALES), still);
    }
}

#[test]
fn every_contact_law_has_the_same_automatic_step() {
    for (name, text) in contact_laws() {
        let text = text.replace("step = 1.0e-5\nallow_unstable = true\n", "");
        holds(&name, (&text, &Files::new()), (1, 1.0e-5, &EVEN[..1]), still);
    }
}

#[test]
fn every_bond_law_gives_the_same_bits() {
    // What the engine has as numbers of metres is the engine's (`engine_exact`, `smooth`).
    for (name, text) in
        bond_laws().into_iter().filter(|(name, _)| !name.contains("engine_exact") && !name.contains("smooth"))
    {
        holds(&name, (&text, &Files::new()), (4, 2.0e-6, SCALES), still);
    }
}

#[test]
fn every_surface_gives_the_same_bits() {
    let (text, files) = text_of(1, |motion| motion);
    for (step, scales) in [("step = 2e-5\n", SCALES), ("", EVEN)] {
        let text = text.replace("step = 2e-5\n", step);
        holds("surfaces", (&text, &files), (4, 6e-4, scales), |simulation, number, scale_power| {
            let swing = f64::from(number % 4) - 1.5;
            for (boundary, axis, share, exponent) in [
                (0, 2, 0.05, 2),
                (0, 3, 1e-4, 3),
                (1, 2, 1e-4, 1),
                (3, 2, 0.05, 0),
                (3, 4, 2.0, -1),
                (5, 0, 1e-4, 1),
                (5, 3, 5e-3, 0),
                (7, 2, 0.2, 2),
                (8, 2, -1.0, 2),
                (11, 4, 1e-4, 0),
            ] {
                simulation.set_input(BoundaryIndex(boundary), axis, share * swing * power(scale_power * exponent));
            }
            for node in 0..49 {
                let way = 1e-4 * swing * (node % 3) as f64 * power(scale_power);
                simulation.set_node(BoundaryIndex(9), (node, 2), way);
            }
        });
    }
}

/// A box with what a scene can have: packings, bonds, a group that forces move, a shaking mesh, a piston, a servo, global damping, regions, an insertion, a flow
/// meter, both books of energy, an automatic step.
const RICH: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.06
threads = 1
seed = 7
[material.g]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.25
[pair.g.g]
restitution = 0.6
friction = 0.5
rolling_friction = 0.1
rolling_viscous_damping = 0.3
cohesion_energy_density = 2.0e4
surface_energy = 1.0
damping_coefficient = 2.0e3
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 3.0
pull_off_force = 1.0e-4
LAW
[particles.p]
material = "g"
velocity = [0.1, 0.0, -0.3]
angular_velocity = [3.0, -2.0, 1.0]
packing = { box = [[0.001, 0.001, 0.012], [0.039, 0.039, 0.05]], count = 60, radius = [0.002, 0.004] }
[particles.b]
material = "g"
lattice = { kind = "simple_cubic", radius = 0.0015, origin = [0.012, 0.02, 0.056], counts = [5, 1, 1] }
[particles.q]
material = "g"
angular_velocity = [5.0, 0.0, 0.0]
list = [
    { position = [0.01, 0.01, 0.066], radius = 0.002 },
    { position = [0.0139, 0.01, 0.066], radius = 0.002 },
    { position = [0.012, 0.0133, 0.066], radius = 0.002 },
]
[bond.glue]
between = ["b", "b"]
create_distance = 3.1e-3
normal_stiffness = 2.0e10
tangential_stiffness = 8.0e9
damping.viscous = { normal_force = 0.1, tangential_force = 0.1, normal_torque = 0.1, tangential_torque = 0.1 }
breakage = { max_normal_stress = 2.0e6, max_shear_stress = 2.0e6 }
[boundary.clump]
particles = { set = "q" }
motion = { free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }
[boundary.left]
plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "g"
[boundary.right]
plane = { point = [0.04, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
material = "g"
[boundary.front]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }
material = "g"
[boundary.back]
plane = { point = [0.0, 0.04, 0.0], normal = [0.0, -1.0, 0.0] }
material = "g"
[boundary.floor]
material = "g"
mesh = { file = "floor.obj" }
motion = { prescribed = { z = { sine = { amplitude = 0.0002, frequency = 50.0 } }, "rotation.z" = 0.5 } }
[boundary.piston]
material = "g"
disc = { centre = [0.02, 0.02, 0.075], normal = [0.0, 0.0, -1.0], radius = 0.03 }
mass = 0.01
motion = { loaded = { z = -0.3 } }
[boundary.press]
material = "g"
rectangle = { corner = [0.0385, -0.01, -0.01], edges = [[0.0, 0.06, 0.0], [0.0, 0.0, 0.1]] }
motion = { servo = { x = { target = 0.05, speed = 0.1 } } }
[damping.d]
linear = 0.05
angular = 0.05
gravity_damped = false
particles = { sets = ["p", "b"] }
[region.mid]
box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.02]]
[region.feed]
box = [[0.005, 0.005, 0.055], [0.035, 0.035, 0.063]]
[insertion.rain]
region = "feed"
material = "g"
sizes = { uniform = [0.001, 0.0015] }
mass_rate = 0.005
velocity = [0.0, 0.0, -0.2]
scatter = 0.05
[flow_meter.m]
polygon = [[0.0, 0.0, 0.03], [0.0, 0.04, 0.03], [0.04, 0.04, 0.03], [0.04, 0.0, 0.03]]
[output]
history_interval = 0.002
energy = true
losses = true
"#;

/// A floor with a ridge.
const FLOOR: &str = "v -0.02 -0.02 0.0\nv 0.06 -0.02 0.0\nv 0.06 0.02 0.004\nv -0.02 0.02 0.004\nv 0.06 0.06 0.0\nv -0.02 0.06 0.0\n\
                     f 1 2 3\nf 1 3 4\nf 4 3 5\nf 4 5 6\n";

#[test]
fn a_rich_scene_gives_the_same_bits() {
    let files = Files::from([("floor.obj".to_owned(), FLOOR.into())]);
    for law in [
        "[contact.c.normal.hertz]\n[contact.c.tangential.history]\n[contact.c.rolling.epsd]",
        "[contact.c.normal.hertz]\n[contact.c.tangential.turned_history]\n[contact.c.rolling.cdt]\n[contact.c.cohesion.sjkr2]",
        "[contact.c.normal.jkr]\ntear_off = \"whole_branch\"\n[contact.c.tangential.turned_history]",
        "[contact.c.normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 2\n[contact.c.tangential.turned_history]\nbackward_spring = false",
        "[contact.c.normal.hooke]\ncharacteristic_velocity = 1.0\n[contact.c.tangential.rescaled]\n[contact.c.rolling.epsd2]",
    ] {
        let text = RICH.replace("LAW", law);
        holds(law, (&text, &files), (15, 0.002, &[-30, 20]), still);
        let given = text.replace("end = 0.06", "end = 0.06\nstep = 2e-6\nallow_unstable = true");
        holds(law, (&given, &files), (2, 2e-4, &[7]), still);
    }
}

#[test]
fn where_nothing_is_stiff_the_step_follows_motion_alone() {
    let text = "gravity = [0.0, 0.0, -9.81]\n[run]\n[material.g]\ndensity = 2500.0\n[particles.p]\nmaterial = \"g\"\n\
                list = [{ position = [0.0, 0.0, 0.0], radius = 0.01, velocity = [3.0, 0.0, 0.0] }]\n";
    holds("alone", (text, &Files::new()), (3, 0.1, SCALES), still);
}
