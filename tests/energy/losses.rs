//! The physical energy book: what each kind of loss takes, by itself, against theory and against the energy that is gone.

use crate::support::{assert_near, start, velocity_of_first};
use cograin::interface::Interface;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::Loss;

/// What a loss took \[J\].
fn lost(simulation: &Simulation, loss: Loss) -> f64 {
    simulation.losses().expect("the scene books losses")[loss as usize]
}

/// All losses together \[J\].
fn sum(simulation: &Simulation) -> f64 {
    simulation.losses().expect("the scene books losses").iter().sum()
}

/// Radius \[m\] of the sphere of [`on_plane`].
const RADIUS: f64 = 5.0e-3;
/// Its density \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Its mass \[kg\].
const MASS: f64 = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * RADIUS * RADIUS * RADIUS;

/// A sphere above a plane through the origin.
fn on_plane(head: &str, law: &str, height: f64, velocity: [f64; 3]) -> Simulation {
    start(&format!(
        r#"
{head}
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = {DENSITY:?}
[pair.a.a]
restitution = 0.5
friction = 0.3
rolling_friction = 0.01
surface_energy = 0.5
damping_coefficient = 0.0
{law}
[particles.ball]
material = "a"
list = [{{ id = 1, position = [0.0, 0.0, {height:?}], radius = {RADIUS:?}, velocity = {velocity:?} }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[output]
losses = true
"#
    ))
}

#[test]
fn an_impact_loses_in_its_dashpot_what_restitution_says() {
    let law = "[contact.touch.normal.hertz]";
    let mut simulation = on_plane("[run]\nstep = 2.0e-7", law, RADIUS + 1e-6, [0.0, 0.0, -0.2]);
    simulation.advance(2e-3).expect("it runs");
    let rebound = velocity_of_first(&simulation)[2];
    assert!(rebound > 0.0, "it has left");
    // What is gone, and what the coefficient of restitution says is gone.
    let damped = lost(&simulation, Loss::NormalDamping);
    assert_near(damped, 0.5 * MASS * (0.04 - rebound * rebound), 1e-5);
    assert_near(damped, 0.5 * MASS * 0.04 * (1.0 - 0.25), 5e-3);
    assert_eq!(damped, sum(&simulation), "nothing else takes energy");
}

#[test]
fn a_sphere_that_slides_until_it_rolls_loses_two_sevenths_of_its_energy() {
    // Friction on the arm c = R − δ/2 brakes and spins it until v = c ω: with k = m c²/(2/5 m R²) what is gone is
    // ½ m v₀²/(1 + k), 2/7 where nothing is dented.
    let law =
        "[contact.touch]\ntangential_damping = false\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let head = "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 2.0e-6\nscheme = \"midway\"";
    // As deep as it rests: 4/3 E* √R δ^(3/2) = m g, E* = E/(2 (1 − ν²)).
    let stiffness = 4.0 / 3.0 * 1.0e7 / (2.0 * 0.91) * RADIUS.sqrt();
    let overlap = (MASS * 9.81 / stiffness).powf(2.0 / 3.0);
    let mut simulation = on_plane(head, law, RADIUS - overlap, [1.0, 0.0, 0.0]);
    simulation.advance(0.2).expect("it runs");
    let part = 1.0 / (1.0 + 2.5 * (1.0 - 0.5 * overlap / RADIUS).powi(2));
    assert_near(part, 2.0 / 7.0, 2e-3);
    // The spring that µ m g has stretched swings on: velocities by µ g over its frequency.
    assert_near(velocity_of_first(&simulation)[0], 1.0 - part, 1e-3);
    assert_near(lost(&simulation, Loss::Sliding), 0.5 * MASS * part, 2e-4);
    assert_near(sum(&simulation), 0.5 * MASS * part, 2e-4);
}

#[test]
fn a_rolling_sphere_loses_torque_times_angle() {
    // T = µ_r k_n δ R: over a way x the angle is x/R, and µ_r m g x is gone.
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]";
    let stiffness = 4.0 / 3.0 * 1.0e7 / (2.0 * 0.91) * RADIUS.sqrt();
    let overlap = (MASS * 9.81 / stiffness).powf(2.0 / 3.0);
    let mut simulation =
        on_plane("gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 5.0e-6", law, RADIUS - overlap, [1.0, 0.0, 0.0]);
    simulation.advance(0.2).expect("it runs and rolls");
    let (before, place) =
        (lost(&simulation, Loss::Rolling), |simulation: &Simulation| simulation.state().particles.position[0][0]);
    let from = place(&simulation);
    simulation.advance(0.2).expect("it rolls");
    let way = place(&simulation) - from;
    assert!(way > 0.1, "it rolls on: {way} m");
    assert_near(lost(&simulation, Loss::Rolling) - before, 0.01 * MASS * 9.81 * way, 2e-3);
}

#[test]
fn global_damping_takes_its_part_of_the_weight_times_the_way() {
    let head = "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 1.0e-4\n[damping.all]\nlinear = 0.3\nangular = 0.3\n\
                gravity_damped = true\napplied_forces_damped = true";
    let mut simulation = on_plane(head, "[contact.touch.normal.hertz]", 1.0, [0.0, 0.0, 0.0]);
    for _ in 0..20 {
        simulation.advance(1e-2 + 0.3e-4).expect("it falls");
    }
    let way = 1.0 - simulation.state().particles.position[0][2];
    assert_near(way, 0.5 * 0.7 * 9.81 * simulation.time().powi(2), 1e-12);
    assert_near(lost(&simulation, Loss::GlobalDamping), 0.3 * MASS * 9.81 * way, 1e-12);
    assert!(simulation.physical_residual().expect("a book").abs() < 1e-12 * MASS * 9.81 * way);
}

#[test]
fn sticky_spheres_lose_as_they_part_what_their_neck_holds() {
    // Without dashpots an impact loses what the neck of jkr holds where it breaks, less what touch gives at once.
    let law = "[contact.touch.normal.jkr]";
    let mut simulation = on_plane("[run]\nstep = 1.0e-7", law, RADIUS + 1e-7, [0.0, 0.0, -0.3]);
    simulation.advance(3e-3).expect("it runs");
    let rebound = velocity_of_first(&simulation)[2];
    assert!(rebound > 0.0, "it has left");
    let gone = 0.5 * MASS * (0.09 - rebound * rebound);
    assert!(gone > 0.0);
    assert_near(lost(&simulation, Loss::Cohesion), gone, 1e-2);
}

#[test]
fn a_bond_that_breaks_loses_what_it_held() {
    // Two spheres drawn apart: A k_n u²/2 where the bond is as long as it may get.
    let text = r#"
[run]
step = 1.0e-7
[material.a]
density = 2500.0
[particles.pair]
material = "a"
list = [
    { id = 1, position = [0.0, 0.0, 0.0], radius = 1.0e-3, velocity = [-0.05, 0.0, 0.0] },
    { id = 2, position = [2.0e-3, 0.0, 0.0], radius = 1.0e-3, velocity = [0.05, 0.0, 0.0] },
]
[bond.glue]
formulation = "finite_rotation"
between = ["pair", "pair"]
create_distance = 2.1e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
breakage = { max_normal_stress = 2.0e3 }
[output]
losses = true
"#;
    let mut simulation = start(text);
    simulation.advance(1e-3).expect("it runs");
    let list = &simulation.state().bonds[0];
    assert_eq!((list.broken, list.first.len()), (1, 0));
    // σ = k_n u = 2e3 Pa, A = π R²
    let held = 0.5 * std::f64::consts::PI * 1e-6 * 2.0e3 * 2.0e3 / 1e9;
    assert_near(lost(&simulation, Loss::BondRelease), held, 5e-3);
    assert_eq!(lost(&simulation, Loss::BondRelease) + lost(&simulation, Loss::BondDamping), list.dissipated());
    let given = sum(&simulation);
    assert!(
        simulation.physical_residual().expect("a book").abs() < 1e-3 * given,
        "{:?}",
        simulation.physical_residual()
    );
}

/// Laws of contacts, and how far from the stable step they are followed.
const LAWS: [(&str, f64); 13] = [
    ("[contact.touch.normal.hertz]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.rescaled]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.turned_history]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.turned_history]\nbackward_spring = false", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.no_history]", 1.0),
    (
        "[contact.touch]\nlimit_force = true\n[contact.touch.normal.hooke]\ncharacteristic_velocity = 1.0\n\
         [contact.touch.tangential.history]",
        1.0,
    ),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.epsd]", 1.0),
    ("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.cohesion.sjkr]", 1.0),
    ("[contact.touch.normal.jkr]\n[contact.touch.tangential.history]", 1.0),
    ("[contact.touch.normal.dmt]\n[contact.touch.tangential.history]", 1.0),
    (
        "[contact.touch.normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 1.5\n[contact.touch.tangential.history]",
        0.1,
    ),
];

/// Grains that spin and fall on each other and on planes.
fn grains(step: f64, scheme: &str, law: &str, output: &str) -> Simulation {
    start(&format!(
        r#"
gravity = [0.5, -0.2, -9.81]
[run]
step = {step:?}
scheme = "{scheme}"
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
rolling_viscous_damping = 0.3
cohesion_energy_density = 2.0e3
surface_energy = 0.05
damping_coefficient = 50.0
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 4.0
pull_off_force = 0.0
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "face_centred_cubic", origin = [0.005, 0.005, 0.006], counts = [3, 3, 3], spacing = 1.0e-2, radius = 4.98e-3 }}
velocity = [0.1, 0.05, -0.5]
angular_velocity = [3.0, 10.0, -5.0]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 0.99498743710662] }}
material = "a"
motion = {{ driven = ["x", "z"] }}
[boundary.west]
plane = {{ point = [-0.002, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}
material = "a"
[output]
{output}
"#
    ))
}

/// Grains after a while on a floor that moves.
fn shaken(step: f64, scheme: &str, law: &str) -> Simulation {
    let mut simulation = grains(step, scheme, law, "losses = true");
    for turn in 0..4 {
        simulation.set_input(BoundaryIndex(0), 0, 2e-4 * f64::from(turn % 3));
        simulation.set_input(BoundaryIndex(0), 2, 1e-4 * f64::from(turn % 2));
        simulation.advance(4e-3).expect("it runs");
    }
    simulation
}

#[test]
fn losses_are_the_energy_that_is_gone() {
    for ((law, part), scheme) in
        LAWS.into_iter().flat_map(|law| ["engine", "predicted_normal"].map(|scheme| (law, scheme)))
    {
        let simulation = shaken(4e-6 * part, scheme, law);
        let (residual, sum) = (simulation.physical_residual().expect("a book"), sum(&simulation));

        assert!(sum > 1e-3, "{law}, {scheme}: {sum:e} J");
        assert!(residual.abs() < 1e-3 * sum, "{law}, {scheme}: {residual:e} J of {sum:e} J");
    }
}

#[test]
fn what_losses_leave_unaccounted_is_of_the_second_order_where_springs_are_carried_at_mid_step() {
    for (law, part) in LAWS.into_iter().filter(|(law, _)| !law.contains("cdt") && !law.contains("eepa")) {
        let of = |step: f64| {
            let simulation = shaken(step * part, "midway", law);
            simulation.physical_residual().expect("a book").abs() / sum(&simulation)
        };
        let residuals = [of(8e-6), of(4e-6), of(2e-6)];
        println!("{}: {:.1e} {:.1e} {:.1e}", law.replace('\n', " "), residuals[0], residuals[1], residuals[2]);
        assert!(residuals[2] < 1e-5, "{law}: {residuals:?}");
        assert!(residuals[0] > 11.0 * residuals[2], "{law}: {residuals:?}, second order divides by 16");
    }
}

#[test]
fn booking_changes_no_bit_of_the_motion() {
    for ((law, part), scheme) in
        LAWS.into_iter().flat_map(|law| ["engine", "predicted_normal"].map(|scheme| (law, scheme)))
    {
        let rows = |output: &str| {
            let mut simulation = grains(4e-6 * part, scheme, law, output);
            simulation.advance(4e-3).expect("it runs");
            let particles = &simulation.state().particles;
            (particles.position.clone(), particles.velocity.clone(), particles.angular_velocity.clone())
        };
        assert!(rows("losses = true") == rows(""), "{law}, {scheme}");
    }
}

#[test]
fn what_is_lost_has_the_same_bits_in_every_lane_width_and_after_restoring() {
    use cograin::lanes::Width;
    let law = LAWS[7].0;
    let of = |scheme: &str, width: Width, halfway: bool| {
        let mut simulation = grains(4e-6, scheme, law, "losses = true");
        simulation.set_width(width);
        simulation.advance(4e-3).expect("it runs");
        if halfway {
            let saved = simulation.state().clone();
            simulation.advance(4e-3).expect("it runs");
            simulation.restore(&saved).expect("it is its own state");
        }
        simulation.advance(4e-3).expect("it runs");
        simulation.losses().expect("a book").map(f64::to_bits)
    };
    for scheme in ["predicted_normal", "predicted"] {
        let first = of(scheme, Width::Least, false);
        assert_eq!(of(scheme, Width::widest(), false), first, "{scheme}");
        assert_eq!(of(scheme, Width::widest(), true), first, "{scheme}");
    }
}

#[test]
fn a_closed_box_of_grains_that_lose_nothing_keeps_its_energy_for_a_million_steps() {
    let text = r#"
[run]
step = 2.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 1.0
[contact.touch.normal.hertz]
[particles.few]
material = "a"
list = [
    { id = 1, position = [6.0e-3, 6.0e-3, 6.0e-3], radius = 5.0e-3, velocity = [0.02, 0.05, -0.03] },
    { id = 2, position = [15.95e-3, 6.2e-3, 6.1e-3], radius = 5.0e-3, velocity = [-0.04, 0.03, 0.01] },
]
WALLS
[output]
losses = true
"#;
    let wall = |name: &str, point: f64, normal: [f64; 3]| {
        let place = normal.map(|part: f64| if part < 0.0 { point } else { 0.0 });
        format!("[boundary.{name}]\nplane = {{ point = {place:?}, normal = {normal:?} }}\nmaterial = \"a\"\n")
    };
    let walls = [
        wall("west", 0.0, [1.0, 0.0, 0.0]),
        wall("east", 21.9e-3, [-1.0, 0.0, 0.0]),
        wall("south", 0.0, [0.0, 1.0, 0.0]),
        wall("north", 12e-3, [0.0, -1.0, 0.0]),
        wall("floor", 0.0, [0.0, 0.0, 1.0]),
        wall("roof", 12e-3, [0.0, 0.0, -1.0]),
    ];
    let mut simulation = start(&text.replace("WALLS", &walls.concat()));
    let start = simulation.kinetic_energy() + simulation.elastic_energy();
    let mut largest = 0.0_f64;
    for _ in 0..100 {
        simulation.advance(0.2).expect("it runs");
        largest = largest.max(simulation.physical_residual().expect("a book").abs());
    }
    assert_eq!(simulation.state().clock.steps, 1_000_000);

    assert!(largest < 1e-2 * start, "{largest:e} J of {start:e} J");
    assert!(sum(&simulation).abs() < 1e-12 * start, "{:e} J", sum(&simulation));
}

#[test]
fn a_scene_has_the_outputs_of_the_losses_that_it_can_have() {
    let names = |output: &str| {
        let simulation = grains(4e-6, "engine", LAWS[1].0, output);
        let interface = Interface::of(simulation.scene());
        let names = interface.variables().iter().map(|variable| variable.name.clone());
        names.filter(|name| name.starts_with("energy.lost") || name.ends_with("physical_residual")).collect::<Vec<_>>()
    };
    let expected = ["normal_damping", "tangential_damping", "sliding", "tangential_stiffness", "projection", "parting"];
    let mut expected = expected.map(|name| format!("energy.lost.{name}")).to_vec();
    expected.push("energy.physical_residual".to_owned());
    assert_eq!(names("losses = true"), expected);
    assert!(names("energy = true").is_empty());
}

#[test]
fn energy_out_of_nothing_stops_a_run_of_a_cohesive_scene_too() {
    let mut simulation = grains(4e-6, "engine", LAWS[8].0, "losses = true");
    simulation.advance(8e-3).expect("it runs");
    let mut state = simulation.state().clone();
    for [x, y, z, _] in &mut state.particles.velocity {
        (*x, *y, *z) = (3.0 * *x, 3.0 * *y, 3.0 * *z);
    }
    simulation.restore(&state).expect("it may be");
    let stopped = (0..100).find_map(|_| simulation.advance(4e-4).err()).expect("it is stopped").to_string();
    assert!(stopped.starts_with("contacts and bonds gave "), "{stopped}");
}
