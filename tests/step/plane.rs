//! Scenes of one plane: the bits of the run in three dimensions, discs with a mass and an inertia of their own, an end in words where
//! a particle leaves the plane.

use crate::support::read;
use cograin::scene::Scene;
use cograin::simulation::{RunError, Simulation};
use std::sync::Arc;

/// Some spheres of one plane between plates, of which one shakes; a bonded bar that falls among them; a rigid group that is
/// pushed. Its `RUN` is for the tests to fill.
const BED: &str = r#"
gravity = [0.5, 0.0, -9.81]
[run]
RUN
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
cohesion_energy_density = 2.0e3
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.epsd2]
[contact.touch.cohesion.sjkr]
[particles.grains]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.005, 0.25, 0.006], counts = [12, 1, 9], spacing = 8.05e-3, radius = 4.0e-3 }
velocity = [0.4, 0.0, -0.6]
angular_velocity = [0.0, 30.0, 0.0]
[particles.bar]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.02, 0.25, 0.082], counts = [5, 1, 2], spacing = 8.0e-3, radius = 4.0e-3 }
[particles.sledge]
material = "a"
list = [
    { position = [0.070, 0.25, 0.085], radius = 0.005 },
    { position = [0.077, 0.25, 0.086], radius = 0.004 },
]
[bond.glue]
between = ["bar", "bar"]
create_distance = 8.1e-3
normal_stiffness = 3.0e8
tangential_stiffness = 1.0e8
damping.viscous = { normal_force = 0.2, tangential_force = 0.3, normal_torque = 0.1, tangential_torque = 0.4 }
[damping.all]
linear = 0.01
angular = 0.02
gravity_damped = true
applied_forces_damped = true
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
motion = { prescribed = { x = { sine = { amplitude = 1.0e-3, frequency = 40.0 } } } }
[boundary.left]
plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "a"
[boundary.right]
plane = { point = [0.105, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
material = "a"
[boundary.drum]
cylinder = { from = [0.05, -0.1, 0.06], to = [0.05, 0.6, 0.06], radius = 0.08 }
material = "a"
motion = { prescribed = { "rotation.y" = 3.0 } }
[boundary.sledge]
particles = { set = "sledge" }
motion = { free = ["x", "z", "rotation.y"] }
[output]
losses = true
"#;

/// The bed with these lines in `[run]`.
fn bed(run: &str) -> Scene {
    read(&BED.replace("RUN", run)).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The whole state after some communication steps.
fn state_bytes(scene: Scene) -> Vec<u8> {
    let mut simulation = Simulation::new(Arc::new(scene)).expect("it starts");
    let mut touching = 0;
    for interval in [2e-3, 1e-2, 2e-2, 3e-2, 4e-2] {
        simulation.advance(interval).expect("it runs");
        touching += simulation.contacts().len();
    }
    assert!(touching > 100, "{touching} contacts, too few to tell anything");
    simulation.state().to_bytes(0)
}

#[test]
fn a_plane_scene_has_the_bits_of_its_run_in_three_dimensions() {
    let expected = state_bytes(bed("threads = 1"));
    for threads in [1, 2] {
        assert!(state_bytes(bed(&format!("plane = \"xz\"\nthreads = {threads}"))) == expected, "{threads} threads");
    }
}

/// A body of radius 10 cm on an incline of 20°, in axes along it, with so much friction that it rolls.
fn rolling(run: &str) -> String {
    format!(
        r#"
gravity = [3.3553, 0.0, -9.2184]
[run]
{run}
[material.a]
youngs_modulus = 1.0e11
poissons_ratio = 0.3
density = 1200.0
[pair.a.a]
restitution = 0.3
friction = 0.6
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.roller]
material = "a"
list = [{{ position = [0.0, 0.0, 0.1], radius = 0.1 }}]
[boundary.slope]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#
    )
}

#[test]
fn a_disc_rolls_down_a_slope_with_its_own_mass_and_inertia() {
    // a = g sin θ / (1 + I/(m r²)): I/(m r²) is 1/2 of a disc about its axis, 2/5 of a sphere.
    let cases = [("plane_particles = \"discs\"", 0.5, 1.0 / 100.0 * 1200.0), ("", 0.4, 4.0 / 3000.0 * 1200.0)];
    for (word, share, mass) in cases {
        let scene = read(&rolling(&format!("plane = \"xz\"\n{word}"))).unwrap();
        let mut simulation = Simulation::new(Arc::new(scene)).expect("it starts");
        let particles = &simulation.state().particles;
        let [found, inertia] = [particles.velocity[0][3], particles.angular_velocity[0][3]];
        let mass = std::f64::consts::PI * mass;
        assert!((found / mass - 1.0).abs() < 1e-14, "{found} instead of {mass} kg");
        assert!((inertia / (share * mass * 0.01) - 1.0).abs() < 1e-14, "{inertia} kg m²");
        // The second half second: the body no longer bounces then. It is so stiff that its arm is its radius to 1e-5.
        simulation.advance(0.5).expect("it rolls");
        let before = simulation.state().particles.velocity[0][0];
        simulation.advance(0.5).expect("it rolls on");
        let acceleration = (simulation.state().particles.velocity[0][0] - before) / 0.5;
        let expected = 3.3553 / (1.0 + share);
        assert!((acceleration / expected - 1.0).abs() < 1e-4, "{word}: {acceleration} instead of {expected} m/s²");
    }
}

#[test]
fn a_run_stops_where_a_particle_leaves_the_plane() {
    // A wall that is dragged along y takes the roller along.
    let dragged = |axis: &str| {
        let text = rolling("plane = \"xz\"") + &format!("motion = {{ prescribed = {{ {axis} = 0.1 }} }}\n");
        let mut simulation = Simulation::new(Arc::new(read(&text).unwrap())).expect("it starts");
        simulation.advance(0.1)
    };
    assert_eq!(dragged("x"), Ok(()));
    let error = dragged("y").expect_err("it leaves the plane");
    assert!(matches!(error, RunError::LeftPlane { id: 1, .. }), "{error}");
    let text = error.to_string();
    assert!(text.starts_with("particle 1 left the [run] plane at t = 0.0") && text.contains(": its y is "), "{text}");
}
