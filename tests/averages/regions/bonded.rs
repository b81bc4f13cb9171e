//! Regions of bonded blocks.

use super::scenes::{ALL, apart, walls_and_inertia};
use crate::support::start;
use cograin::averages;

#[test]
fn a_bonded_block_that_tumbles_and_breaks_carries_its_inertia() {
    let damped = |model: &str| format!("[bond.glue.damping.{model}]\nnormal_force = 0.2\ntangential_force = 0.1\n");
    for (formulation, damping) in [
        ("incremental", String::new()),
        ("incremental", damped("opposing")),
        ("incremental", damped("viscous")),
        ("finite_rotation", String::new()),
        ("finite_rotation", damped("viscous")),
    ] {
        let text = format!(
            r#"
[run]
step = 1.0e-6
threads = 1
[material.rock]
density = 2500.0
[particles.block]
material = "rock"
lattice = {{ kind = "face_centred_cubic", radius = 0.005, box = [[0.0, 0.0, 0.0], [0.05, 0.04, 0.04]] }}
[bond.glue]
formulation = {formulation:?}
between = ["block", "block"]
create_distance = 0.0101
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
{damping}
[force.pull]
particles = {{ box = [[0.0, 0.0, 0.0], [0.012, 0.04, 0.04]] }}
force = [-2.0, 3.0, 1.0]
{ALL}
"#
        );
        let mut simulation = start(&text);
        for _ in 0..5 {
            simulation.advance(2e-4).expect("it runs");
            let found = averages::carried(&simulation)[0];
            let mut expected = walls_and_inertia(&simulation, |place| place);
            let force = &simulation.scene().forces[0];
            let particles = &simulation.state().particles;
            for &member in &force.members {
                let [x, y, z, _] = particles.position[particles.slot[member as usize] as usize];
                expected.add([x, y, z], force.force);
            }
            let error = apart(&found, &expected.tensor, expected.turnover);
            assert!(error < 1e-12, "{formulation} {damping}{error:e}: {found:?}, {:?} expected", expected.tensor);
        }
    }
}

#[test]
fn a_bonded_block_that_hits_a_floor_carries_what_the_floor_says_whatever_its_bonds_do_to_contacts() {
    for formulation in ["incremental", "finite_rotation"] {
        for contact in ["parallel", "without_normal", "none"] {
            let text = format!(
                r#"
[run]
step = 1.0e-6
threads = 1
[material.rock]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.rock.rock]
restitution = 0.6
friction = 0.4
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "rock"
lattice = {{ kind = "face_centred_cubic", radius = 0.005, spacing = 0.00995, box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.03]] }}
velocity = [0.3, 0.1, -1.0]
[bond.glue]
formulation = {formulation:?}
contact = {contact:?}
between = ["block", "block"]
create_distance = 0.0101
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
[bond.glue.breakage]
max_normal_stress = 1.0e4
max_shear_stress = 1.0e4
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "rock"
{ALL}
"#
            );
            let mut simulation = start(&text);
            let made: u64 = simulation.state().bonds.iter().map(|list| list.made).sum();
            for _ in 0..5 {
                simulation.advance(1e-4).expect("it runs");
                let found = averages::carried(&simulation)[0];
                let expected = walls_and_inertia(&simulation, |place| place);
                let error = apart(&found, &expected.tensor, expected.turnover);
                assert!(error < 1e-12, "{formulation}, {contact}: {error:e}: {found:?}, {:?}", expected.tensor);
            }
            let broken: u64 = simulation.state().bonds.iter().map(|list| list.broken).sum();
            assert!(0 < broken && broken < made, "{formulation}, {contact}: {broken} of {made} bonds broke");
        }
    }
}
