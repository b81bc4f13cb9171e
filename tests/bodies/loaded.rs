//! Boundaries of any shape that forces move: against theory, at a mass far below that of what they touch, and their books.

use crate::support::{scene, start};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::state::ledger::Source as Kind;

/// The boundary that forces move: boundaries stand in the order of the text.
const PLATE: BoundaryIndex = BoundaryIndex(0);

/// Spheres of radius 5 mm in columns between four walls, with a plate on top.
fn bed(run: &str, law: &str, plate: &str, more: &str) -> String {
    let walls = [("x_low", [0.0, 0.0], [1.0, 0.0]), ("x_high", [0.04, 0.0], [-1.0, 0.0])].into_iter();
    let walls = walls.chain([("y_low", [0.0, 0.0], [0.0, 1.0]), ("y_high", [0.0, 0.04], [0.0, -1.0])]);
    let walls: String = walls
        .map(|(name, [x, y], [a, b])| {
            format!(
                "[boundary.{name}]\nmaterial = \"a\"\nplane = {{ point = [{x:?}, {y:?}, 0.0], normal = [{a:?}, {b:?}, 0.0] }}\n"
            )
        })
        .collect();
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
{run}
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.005, 0.005, 0.005], counts = [4, 4, 4], spacing = 1.0e-2, radius = 5.0e-3 }}
[boundary.a_plate]
material = "a"
{plate}
[boundary.floor]
material = "a"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
{walls}
[output]
energy = true
{more}
"#
    )
}

/// Hertz's law with friction.
const ROUGH: &str = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]";

/// The same without rolling resistance, whose torque of constant size never comes to rest.
const RESTING: &str = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";

/// Mass of the bed \[kg\].
fn bed_mass() -> f64 {
    64.0 * 4.0 / 3.0 * std::f64::consts::PI * 5e-3_f64.powi(3) * 2500.0
}

/// A plane on the bed that moves along z, of this share of its mass.
fn plate(share: f64, more: &str) -> String {
    let mass = share * bed_mass();
    format!(
        "plane = {{ point = [0.02, 0.02, 0.04], normal = [0.0, 0.0, -1.0] }}\nmass = {mass:?}\nmotion = {{ loaded = [\"z\"] }}\n{more}"
    )
}

/// Cundall's damping.
const DAMPED: &str = "[damping.all]\nlinear = 0.6\nangular = 0.6\ngravity_damped = true\n";

#[test]
fn a_plate_of_any_mass_rests_with_its_weight_and_load() {
    for share in [1.0, 1e-2, 1e-3] {
        let mut simulation = start(&bed("step = \"auto\"", RESTING, &plate(share, "damping = { z = 30.0 }"), DAMPED));
        simulation.set_input(PLATE, 2, -2.0);
        simulation.advance(0.15).unwrap_or_else(|error| panic!("{error}"));
        let moved = simulation.state().boundaries[0];
        let load = 2.0 + share * bed_mass() * 9.81;
        assert!((moved.force[2] / load - 1.0).abs() < 1e-6, "{} N, not {load} N", moved.force[2]);
    }
}

#[test]
fn the_books_of_bed_and_plate_close() {
    let more = "stiffness = { z = 300.0 }\ndamping = { z = 0.5 }";
    let mut simulation = start(&bed("step = \"auto\"", ROUGH, &plate(1e-3, more), ""));
    for number in 0..40 {
        simulation.set_input(PLATE, 2, if number % 2 == 0 { -3.0 } else { 0.5 });
        simulation.set_input_rate(PLATE, 2, 20.0);
        simulation.advance(1.1e-3).unwrap_or_else(|error| panic!("{error}"));
    }
    let ledger = simulation.state().ledger.as_ref().expect("a book is kept");
    let residual = simulation.energy_residual().expect("a book is kept");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
    assert!(ledger.work_of(Kind::Support).abs() > 0.0);
    // The plate by itself: what it lost or got along z.
    let moved = &simulation.state().boundaries[0];
    let inertial = &moved.inertial;
    let mass = 1e-3 * bed_mass();
    let time = simulation.time();
    let terms = [
        -mass * moved.velocity[2],
        -9.81 * mass * time,
        inertial.applied_impulse[2],
        inertial.support_impulse[2],
        plate_impulse(&simulation),
    ];
    let turnover: f64 = terms.iter().map(|term| term.abs()).sum();
    let rest: f64 = terms.iter().sum();
    assert!(rest.abs() < 1e-12 * turnover, "{rest:e} N s of {turnover:e} N s: {terms:?}");
}

/// Impulse of the particles on the plate since the start along z \[N s\]: what they lost but for gravity and the others.
fn plate_impulse(simulation: &Simulation) -> f64 {
    let state = simulation.state();
    let momentum: f64 = state.particles.velocity.iter().map(|row| row[3] * row[2]).sum();
    let others: f64 = state.boundaries[1..].iter().map(|moved| moved.total_impulse[2]).sum();
    -(momentum + bed_mass() * 9.81 * state.clock.time + others)
}

/// A block of two by two columns of five spheres, glued to the floor and to a plate.
fn block(run: &str, plate: &str) -> String {
    format!(
        r#"
[run]
{run}
threads = 1
[material.a]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 2500.0
[particles.block]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.001, 0.001, 0.001], counts = [2, 2, 5], spacing = 2.0e-3, radius = 1.0e-3 }}
[bond.inside]
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.below]
between = ["block", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.above]
between = ["block", "a_plate"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[boundary.a_plate]
material = "a"
plane = {{ point = [0.0, 0.0, 0.01], normal = [0.0, 0.0, -1.0] }}
{plate}
[boundary.floor]
material = "a"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
"#
    )
}

/// Cundall's damping of the block.
const STILL: &str = "[damping.all]\nlinear = 0.4\nangular = 0.4\n[boundary.a_plate]";

#[test]
fn light_plates_are_stable_up_to_the_stable_step_itself() {
    for mass in [1e-5, 1e-7] {
        let plate = format!("mass = {mass:?}\nmotion = {{ loaded = {{ z = -0.01 }} }}");
        let mut simulation = start(&block("step = \"auto\"\nsafety = 0.97", &plate));
        let mut energies = Vec::new();
        for _ in 0..200 {
            simulation.advance(1e-4).unwrap_or_else(|error| panic!("{mass}: {error}"));
            energies.push(simulation.kinetic_energy() + simulation.elastic_energy());
        }
        // An unstable mode would grow without end in these 15,000 steps and more.
        assert!(simulation.state().clock.steps > 15_000, "{} steps", simulation.state().clock.steps);
        let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let (first, second) = (most(&energies[..100]), most(&energies[100..]));
        assert!(first > 0.0 && second < 1.5 * first, "{mass}: {first:e} J, later {second:e} J");
    }
}

#[test]
fn on_a_damped_bonded_block_the_displacement_is_force_over_stiffness() {
    let still = |plate: &str| block("step = \"auto\"", plate).replace("[boundary.a_plate]", STILL);
    // What a driven plate needs for a small way.
    let mut driven = start(&still("motion = { driven = [\"z\"] }"));
    driven.set_input(PLATE, 2, -1e-9);
    for _ in 0..4 {
        driven.advance(1e-3).expect("it runs");
    }
    let stiffness = driven.state().boundaries[0].force[2] / 1e-9;
    for mass in [1e-3, 1e-6] {
        let mut loaded = start(&still(&format!(
            "mass = {mass:?}\ndamping = {{ z = 40.0 }}\nmotion = {{ loaded = {{ z = -0.01 }} }}"
        )));
        for _ in 0..8 {
            loaded.advance(1e-3).expect("it runs");
        }
        let way = loaded.state().boundaries[0].displacement[2];
        let expected = -0.01 / stiffness;
        assert!((way / expected - 1.0).abs() < 1e-6, "{way:e} m, not {expected:e} m, of a plate of {mass} kg");
    }
}

/// A disc that forces move along z and turn, on a bed, not in its middle.
const DISC: &str = "disc = { centre = [0.022, 0.019, 0.0402], normal = [0.0, 0.0, 1.0], radius = 0.014 }\nmass = 1e-5\n\
                    inertia = [6e-10, 6e-10, 1.2e-9]\n\
                    motion = { loaded = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }";

#[test]
fn a_light_disc_with_six_freedoms_rests_on_a_bed_and_its_books_close() {
    let mut simulation = start(&bed("step = \"auto\"", ROUGH, DISC, ""));
    simulation.set_input(PLATE, 2, -0.1);
    for _ in 0..30 {
        simulation.advance(5e-3).unwrap_or_else(|error| panic!("{error}"));
    }
    let ledger = simulation.state().ledger.as_ref().expect("a book is kept");
    let residual = simulation.energy_residual().expect("a book is kept");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
    let moved = simulation.state().boundaries[0];
    assert!((moved.force[2] / 0.1 - 1.0).abs() < 0.01, "{} N", moved.force[2]);
    assert!(moved.rotation.iter().all(|angle| angle.abs() < 0.05), "{:?}", moved.rotation);
}

#[test]
fn a_disc_that_nothing_touches_falls_and_turns_as_theory_says() {
    let disc = DISC.replace("0.0402", "0.5");
    let mut simulation = start(&bed("step = 1e-5", ROUGH, &disc, ""));
    simulation.set_input(PLATE, 0, 2e-5);
    simulation.set_input(PLATE, 5, 2.4e-9);
    simulation.advance(0.1).expect("it runs");
    let moved = simulation.state().boundaries[0];
    // ½ a t² with a = 2 m/s² and 2 rad/s²; Verlet is exact.
    assert!((moved.displacement[0] - 0.01).abs() < 1e-13, "{:?}", moved.displacement);
    assert!((moved.displacement[2] + 0.5 * 9.81 * 0.01).abs() < 1e-13, "{:?}", moved.displacement);
    assert!((moved.rotation[2] - 0.01).abs() < 1e-13, "{:?}", moved.rotation);
    assert!((moved.angular_velocity[2] - 0.2).abs() < 1e-12, "{:?}", moved.angular_velocity);
}

#[test]
fn a_body_on_a_spring_swings_with_its_period() {
    let text = "[run]\nstep = 1e-5\n[material.a]\ndensity = 2500.0\n\
                [particles.far]\nmaterial = \"a\"\nlist = [{ position = [0.0, 0.0, 1.0], radius = 0.01 }]\n\
                [boundary.a_plate]\nmaterial = \"a\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
                mass = 0.2\nstiffness = { z = 80.0 }\nmotion = { loaded = { z = 0.4 } }\n";
    let mut simulation = start(text);
    // u = F/k (1 − cos ωt), ω = 20 1/s.
    let time = 0.31;
    simulation.advance(time).expect("it runs");
    let expected = 0.4 / 80.0 * (1.0 - (20.0_f64 * time).cos());
    let found = simulation.state().boundaries[0].displacement[2];
    assert!((found - expected).abs() < 1e-8, "{found}, not {expected}");
}

#[test]
fn a_group_takes_an_applied_force_beside_its_weight() {
    let text = "gravity = [0.0, 0.0, -10.0]\n[run]\nstep = 1e-4\n[material.a]\ndensity = 1000.0\n\
                [particles.two]\nmaterial = \"a\"\nlist = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, \
                { position = [0.1, 0.0, 0.0], radius = 0.01 }]\n\
                [boundary.a_pair]\nparticles = { set = \"two\" }\nmotion = { loaded = [\"z\"] }\n";
    let mut simulation = start(text);
    let mass: f64 = simulation.scene().particles.iter().map(cograin::scene::Particle::mass).sum();
    simulation.set_input(PLATE, 2, mass * 14.0);
    simulation.advance(0.1).expect("it runs");
    let moved = simulation.state().boundaries[0];
    assert!((moved.displacement[2] - 0.02).abs() < 1e-14, "{:?}", moved.displacement);
}

#[test]
fn loaded_bodies_go_on_from_a_saved_state_with_the_same_bits() {
    let text = bed("step = \"auto\"", ROUGH, DISC, "");
    let mut first = start(&text);
    let go = |simulation: &mut Simulation, number: u32| {
        simulation.set_input(PLATE, 2, -0.1 * f64::from(number % 3));
        simulation.set_input_rate(PLATE, 4, 1e-4);
        simulation.advance(3e-3).expect("it runs");
    };
    (0..4).for_each(|number| go(&mut first, number));
    let bytes = first.state().to_bytes(0);
    let state = State::from_bytes(&bytes, 0).expect("its own bytes");
    let mut second = Simulation::resume(scene(&text), state).expect("its own state");
    for number in 4..8 {
        go(&mut first, number);
        go(&mut second, number);
    }
    assert!(first.state() == second.state(), "the same state");
}
