//! Groups, tops and paddles.

use cograin::quantity::BoundaryIndex;
use cograin::scene::AxisMotion;
use cograin::simulation::Simulation;
use cograin::state::{BoundaryState, State};

/// The first boundary.
pub(super) const FIRST: BoundaryIndex = BoundaryIndex(0);

/// The first boundary of a simulation.
pub(super) fn group(simulation: &Simulation) -> BoundaryState {
    simulation.state().boundaries[0]
}

/// Length of a difference.
pub(super) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Three spheres of unequal size that no axis goes through, as a group; nothing touches them.
pub(super) fn top(step: f64, motion: &str, more: &str) -> String {
    format!(
        r#"
[run]
step = {step:?}
[material.a]
density = 1000.0
[particles.top]
material = "a"
list = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.1 }},
    {{ position = [0.3, 0.1, 0.0], radius = 0.08 }},
    {{ position = [0.0, 0.5, 0.2], radius = 0.12 }},
]
[boundary.top]
particles = {{ set = "top" }}
motion = {motion}
{more}
"#
    )
}

/// All axes free.
pub(super) const FREE: &str = r#"{ free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }"#;

/// Angular momentum of all particles about a point \[kg m²/s\].
pub(super) fn angular_momentum(state: &State, about: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let particles = &state.particles;
    for (slot, [vx, vy, vz, mass]) in particles.velocity.iter().enumerate() {
        let [x, y, z, _] = particles.position[slot];
        let [x, y, z] = [x - about[0], y - about[1], z - about[2]];
        let spin = particles.angular_velocity[slot];
        let orbital = [y * vz - z * vy, z * vx - x * vz, x * vy - y * vx];
        for axis in 0..3 {
            sum[axis] += mass * orbital[axis] + spin[3] * spin[axis];
        }
    }
    sum
}

/// A sphere that falls, spinning, onto an inclined floor and a fixed neighbour.
pub(super) const FALLING: &str = r#"
gravity = [0.3, -0.2, -9.81]
[run]
step = 1.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[particles.ball]
material = "a"
list = [{ position = [0.001, 0.002, 0.0103], radius = 0.01, velocity = [0.4, 0.1, -0.5], angular_velocity = [20.0, -30.0, 10.0] }]
[particles.rest]
material = "a"
list = [
    { position = [0.022, 0.001, 0.011], radius = 0.01 },
    { position = [0.019, 0.021, 0.012], radius = 0.01 },
]
[force.push]
particles = { set = "ball" }
force = [0.01, 0.0, 0.002]
[damping.all]
linear = 0.1
angular = 0.2
gravity_damped = true
applied_forces_damped = false
[output]
energy = true
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 0.99498743710662] }
material = "a"
"#;

/// A paddle of three spheres in a bed of loose ones.
pub(super) fn paddle(motion: &str, input: &str) -> String {
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", radius = 0.005, counts = [5, 5, 2], origin = [-0.02, -0.02, 0.005] }}
velocity = [0.1, -0.05, 0.0]
[particles.paddle]
material = "a"
list = [
    {{ position = [-0.01, 0.0, 0.0249], radius = 0.005 }},
    {{ position = [0.0, 0.001, 0.0249], radius = 0.005 }},
    {{ position = [0.009, 0.0, 0.0259], radius = 0.006 }},
]
[force.push]
particles = {{ set = "paddle" }}
force = [0.01, 0.02, -0.03]
[damping.some]
particles = {{ set = "paddle" }}
linear = 0.1
angular = 0.3
gravity_damped = false
applied_forces_damped = true
[output]
energy = true
[boundary.paddle]
particles = {{ set = "paddle" }}
motion = {motion}
{input}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#
    )
}

/// Momentum of what moves freely along x, y, z \[N s\].
pub(super) fn momentum(simulation: &Simulation) -> [f64; 3] {
    let (scene, state) = (simulation.scene(), simulation.state());
    [0, 1, 2].map(|axis| {
        let particles = state.particles.velocity.iter().zip(&state.particles.owner);
        let free: f64 = particles.filter(|(_, owner)| **owner == 0).map(|(row, _)| row[3] * row[axis]).sum();
        let group_mass: f64 = scene.particles.iter().filter(|it| it.set.0 == 1).map(|it| it.mass()).sum();
        let is_free = scene.boundaries[0].axes[axis] == AxisMotion::Free;
        free + if is_free { group_mass * state.boundaries[0].velocity[axis] } else { 0.0 }
    })
}

/// Six bonded spheres in a bent row; nothing damps them.
pub(super) fn row(more: &str) -> String {
    format!(
        r#"
[run]
step = 2.0e-7
[material.a]
density = 2500.0
[particles.row]
material = "a"
list = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.002, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.004, 0.0001, 0.0], radius = 0.001 }},
    {{ position = [0.006, 0.0, 0.0002], radius = 0.001 }},
    {{ position = [0.008, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.010, 0.0005, 0.0], radius = 0.001 }},
]
angular_velocity = [400.0, 6000.0, -10000.0]
velocity = [0.0, 1.0, -0.5]
[bond.glue]
between = ["row", "row"]
create_distance = 2.2e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[output]
energy = true
{more}
"#
    )
}

/// Orientation of the first boundary, which its spheres share.
pub(super) fn group_orientation(simulation: &Simulation) -> [f64; 4] {
    let orientation = group(simulation).orientation.0;
    let particles = &simulation.state().particles;
    assert_eq!(particles.orientation[particles.slot[5] as usize], orientation);
    orientation
}
