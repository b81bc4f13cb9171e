//! Bonds in whole scenes: to planes, and what the outside sees of them.

mod block;
mod energies;
pub(crate) mod laws;
mod lists;
mod order;
mod suppressed_contacts;
mod vibrating;

use crate::support::{start, value};
use cograin::simulation::{Placement, Simulation};
use cograin::state::Break;

/// A sphere over a plane that moves, bonded to it.
const BONDED: &str = r#"
[run]
step = 1e-6

[material.glass]
density = 2500.0

[particles.grain]
material = "glass"
list = [{ id = 3, position = [0.0, 0.0, 1.2e-3], radius = 1e-3, velocity = VELOCITY }]

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { prescribed = { x = 0.3, z = -0.2 } }

[bond.glue]
formulation = "FORMULATION"
between = ["grain", "floor"]
create_distance = 2.5e-3
normal_stiffness = 1e10
tangential_stiffness = 4e9
breakage = { max_distance = 1.21e-3 }
"#;

/// That scene with a velocity of the sphere and a formulation.
fn bonded(velocity: &str, formulation: &str) -> Simulation {
    start(&BONDED.replace("VELOCITY", velocity).replace("FORMULATION", formulation))
}

/// The formulations whose bond depends on the step only by a truncation error.
const FORMULATIONS: [&str; 3] = ["finite_rotation", "incremental", "engine_exact"];

#[test]
fn the_foot_of_a_bond_moves_with_its_plane() {
    for formulation in FORMULATIONS {
        let mut simulation = bonded("[0.3, 0.0, -0.2]", formulation);
        simulation.advance(1e-3).unwrap();
        let force = simulation.state().particles.force[0];
        assert!(force.iter().all(|part| part.abs() < 1e-9), "{formulation}: {force:?}");
        assert_eq!(value(&simulation, "bonds.intact"), 1.0);
    }
}

#[test]
fn bodies_are_not_put_beside_a_plane_whose_bonds_would_be_lost() {
    let scene = bonded("[0.0, 0.0, 0.0]", "incremental").scene().clone();
    let refused = Simulation::placed(scene, &Placement::default()).err().map(|cause| cause.to_string());
    assert!(refused.as_ref().is_some_and(|told| told.contains("found boundary floor")), "{refused:?}");
}

/// Two bonded spheres of which one is held and the other turned about an axis across the bond.
const TURNED: &str = r#"
[run]
step = 1e-6
[material.glass]
density = 2500.0
[particles.held]
material = "glass"
list = [{ id = 7, position = [0.0, 0.0, 0.0], radius = 1e-3 }]
[particles.turned]
material = "glass"
list = [{ id = 9, position = [2e-3, 0.0, 0.0], radius = 1e-3 }]
[boundary.held]
particles = { set = "held" }
[boundary.turned]
particles = { set = "turned" }
motion = { prescribed = { "rotation.y" = SPEED } }
[bond.glue]
between = ["held", "turned"]
create_distance = 2.1e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
"#;

/// One body alone that turns past π passes within a step by where the law has no value, and would be found on the other
/// side with its twist a whole turn off.
#[test]
fn a_bond_bent_beyond_half_a_turn_stops_the_run_however_fast_it_is_bent() {
    for speed in [1e2, 1e3, 1e4, 1e5] {
        let mut turned = start(&TURNED.replace("SPEED", &format!("{speed:?}")));
        turned.advance(3.1 / speed).unwrap();
        let refused = turned.advance(0.2 / speed).err().map(|cause| cause.to_string());
        let told = "the bond of particle 7 and particle 9 is bent beyond half a turn";
        assert!(refused.as_ref().is_some_and(|refused| refused.contains(told)), "{speed} rad/s: {refused:?}");
    }
}

#[test]
fn plane_and_sphere_feel_opposite_forces() {
    for formulation in FORMULATIONS {
        let mut simulation = bonded("[0.31, 0.01, -0.22]", formulation);
        simulation.advance(2e-5).unwrap();
        let (force, torque) = (simulation.state().particles.force[0], simulation.state().particles.torque[0]);
        let position = simulation.state().particles.position[0];
        let plane = &simulation.state().boundaries[0];
        assert!(force[0].abs() > 1e-3 && force[2].abs() > 1e-3, "{formulation}: {force:?}");
        for axis in 0..3 {
            assert!((force[axis] + plane.force[axis]).abs() < 1e-12, "{formulation}");
        }
        // The moments of both about the plane's moved reference point vanish together.
        let arm: Vec<f64> = (0..3).map(|axis| position[axis] - plane.displacement[axis]).collect();
        for axis in 0..3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let sum = torque[axis] + arm[j] * force[k] - arm[k] * force[j] + plane.moment[axis];
            assert!(sum.abs() < 1e-15, "{formulation}: {sum}");
        }
        assert!(torque[1].abs() > 1e-9);
    }
}

#[test]
fn a_bond_to_a_plane_breaks_once_and_is_told() {
    let mut simulation = bonded("[0.3, 0.0, 0.8]", "finite_rotation");
    assert_eq!((value(&simulation, "bonds.intact"), value(&simulation, "bonds.broken")), (1.0, 0.0));
    let mut breaks = Vec::new();
    for _ in 0..5 {
        simulation.advance(1e-4).unwrap();
        breaks.extend(simulation.state().breaks.iter().copied());
    }
    assert_eq!((value(&simulation, "bonds.intact"), value(&simulation, "bonds.broken")), (0.0, 1.0));
    assert_eq!(breaks.len(), 1);
    assert_eq!((breaks[0].first, breaks[0].second), (0, None));
    assert!(breaks[0].energy > 0.0);
    assert_eq!(simulation.state().particles.damage(), [1.0]);
    assert!(simulation.state().particles.force[0][2] == 0.0);
}

#[test]
fn damage_is_the_share_of_a_particles_bonds_that_broke() {
    let text = r#"
[run]
step = 1e-6

[material.glass]
density = 2500.0

[particles.chain]
material = "glass"
list = [
    { id = 1, position = [0.0, 0.0, 0.0], radius = 1e-3 },
    { id = 2, position = [2.1e-3, 0.0, 0.0], radius = 1e-3 },
    { id = 3, position = [4.2e-3, 0.0, 0.0], radius = 1e-3, velocity = [9.0, 0.0, 0.0] },
]

[bond.chain]
between = ["chain", "chain"]
create_distance = 2.5e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
breakage = { max_distance = 2.3e-3 }
"#;
    let mut simulation = start(text);
    assert_eq!(simulation.state().particles.damage(), [0.0; 3]);
    simulation.advance(1e-4).unwrap();
    assert_eq!(value(&simulation, "bonds.broken"), 1.0);
    assert_eq!(simulation.state().particles.damage(), [0.0, 0.5, 1.0]);
    let intact = simulation.bonds();
    assert_eq!(intact.len(), 1);
    assert!(intact[0].joins([0, 1]));
}

/// Two spheres of radii 1:2 on a tilted axis, bonded, that move apart along it; no plane.
const PARTING: &str = r#"
[run]
step = 1e-6

[material.glass]
density = 2500.0

[particles.grain]
material = "glass"
list = [
    { id = 3, position = [0.1, 0.2, 0.3], radius = 1e-3, velocity = [-0.6, 0.0, -0.8] },
    { id = 8, position = [0.1018, 0.2, 0.3024], radius = 2e-3 },
]

[bond.glue]
formulation = "incremental"
between = ["grain", "grain"]
create_distance = 3.1e-3
radius_multiplier = 0.5
normal_stiffness = 1.0
tangential_stiffness = 1.0
breakage = { max_distance = 3.1e-3 }
"#;

/// What broke in so long a communication step \[s\].
fn broken(mut simulation: Simulation, interval: f64) -> Break {
    simulation.advance(interval).unwrap();
    let [broken] = simulation.state().breaks[..] else { panic!("{:?}", simulation.state().breaks) };
    broken
}

#[test]
fn a_bond_that_breaks_tells_which_section_parted() {
    let Break { time, position, direction, area, .. } = broken(start(PARTING), 2e-4);
    // The smaller sphere goes away from the other; a third of the distance is its own.
    let distance = 3e-3 + time;
    let first = [0.1 - 0.6 * time, 0.2, 0.3 - 0.8 * time];
    for (axis, towards) in [0.6, 0.0, 0.8].into_iter().enumerate() {
        assert!((direction[axis] + towards).abs() < 1e-9, "{direction:?}");
        let expected = first[axis] + towards * distance / 3.0;
        assert!((position[axis] - expected).abs() < 1e-9, "{position:?}: {expected} along {axis}");
    }
    assert!((area / (std::f64::consts::PI * 0.25e-6) - 1.0).abs() < 1e-14, "{area}");
}

#[test]
fn a_bond_to_a_plane_parts_at_its_foot() {
    let weak = BONDED.replace("1e10", "1.0").replace("4e9", "1.0");
    let text = weak.replace("VELOCITY", "[0.3, 0.0, 0.2]").replace("FORMULATION", "incremental");
    let Break { time, position, direction, area, .. } = broken(start(&text), 1e-4);
    assert!((position[0] - 0.3 * time).abs() < 1e-8 && (position[2] + 0.2 * time).abs() < 1e-8, "{position:?}");
    assert!((direction[2] - 1.0).abs() < 1e-9, "{direction:?}");
    assert!((area / (std::f64::consts::PI * 1e-6) - 1.0).abs() < 1e-14, "{area}");
}
