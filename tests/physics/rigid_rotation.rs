//! Bonded bodies that turn rigidly under load keep their forces and their energy through a thousand turns.

use crate::physics::chain::{AXIAL, LENGTH, MASS, chain};
use crate::physics::stage::assert_close;
use crate::support::start;
use cograin::simulation::{PlacedBond, PlacedParticle, Placement, Simulation};
use std::f64::consts::{PI, TAU};

/// Angle of a time step \[rad\].
const ANGLE: f64 = TAU / 400.0;

/// Turns to go.
const TURNS: usize = 1000;

/// What a bond carries: normal force, shear force, torsion and bending torque, elastic energy; and the kinetic energy.
fn loads(simulation: &Simulation) -> Vec<f64> {
    let length = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    let mut loads = vec![simulation.kinetic_energy()];
    for bond in simulation.bonds() {
        let carried = bond.carried;
        loads.extend([carried.normal, length(carried.shear), length(carried.bending), carried.energy]);
    }
    loads
}

/// Fails if a load changes by more than 1e-9 of itself from turn to turn. Loads below this one are none \[N, N m, J\].
fn turn_and_compare(simulation: &mut Simulation, interval: f64, least: f64, what: &str) {
    let start = loads(simulation);
    for turn in 1..=TURNS {
        simulation.advance(interval).unwrap();
        for (number, (found, expected)) in loads(simulation).into_iter().zip(&start).enumerate() {
            if expected.abs() > least {
                assert_close(found, *expected, 1e-9, &format!("{what}, turn {turn}, load {number}"));
            }
        }
    }
}

#[test]
fn a_stretched_pair_turns_under_the_force_that_holds_it() {
    let step = 0.3 * (MASS / AXIAL).sqrt();
    // Each body goes round by ANGLE in a step where the bond pulls with m r (2 sin(ANGLE/2)/Δt)².
    let pull = MASS * (2.0 * (0.5 * ANGLE).sin() / step).powi(2);
    let stretched = LENGTH / (1.0 - 0.5 * pull / AXIAL);
    let unloaded = start(&chain("finite_rotation", step, &[[[0.0; 3]; 2]; 2], ""));
    let rows = &unloaded.state().bonds[0].rows;
    let bond = PlacedBond { law: 0, bodies: [0, 1], rows: [rows[0][0], rows[1][0], rows[2][0]] };
    // About an axis across the bond that is none of the scene's.
    let axis = [0.0, 0.6, -0.8];
    let body = |side: f64| {
        let (arm, speed) = (0.5 * side * stretched, 0.5 * side * stretched * ANGLE.sin() / step);
        PlacedParticle {
            position: [0.5 * LENGTH + arm, 0.0, 0.0],
            velocity: [0.0, axis[2] * speed, -axis[1] * speed],
            angular_velocity: axis.map(|part| part * ANGLE / step),
            force: [-side * 0.5 * pull * stretched, 0.0, 0.0],
            torque: [0.0; 3],
        }
    };
    let placement =
        Placement { steps: 0, particles: vec![body(-1.0), body(1.0)], springs: Vec::new(), bonds: vec![bond] };
    let mut turning = Simulation::placed(unloaded.scene().clone(), &placement).unwrap();
    assert_close(turning.bonds()[0].carried.normal, -0.5 * pull * stretched, 1e-10, "the force at the start");
    turn_and_compare(&mut turning, TAU / ANGLE * step, 1e-3, "a pair");
}

#[test]
fn a_bent_chain_that_has_come_to_rest_in_its_turning_stays_so() {
    for formulation in ["finite_rotation", "incremental"] {
        let step = 0.5 * (MASS / AXIAL).sqrt();
        let spin = ANGLE / step;
        let (x, y) = (LENGTH * (PI / 6.0).cos(), LENGTH * (PI / 6.0).sin());
        let bodies: String = [[-x, -y / 3.0], [0.0, 2.0 * y / 3.0], [x, -y / 3.0]]
            .map(|[x, y]| {
                let velocity = [-spin * y, spin * x, 0.0];
                format!(
                    "{{ position = [{x:?}, {y:?}, 0.0], radius = {:?}, velocity = {velocity:?}, angular_velocity = [0.0, 0.0, {spin:?}] }},\n",
                    0.5 * LENGTH
                )
            })
            .concat();
        let mut chain = start(&format!(
            r#"
[run]
step = {step:?}
threads = 1
[material.glass]
density = 2500.0
[particles.chain]
material = "glass"
list = [
{bodies}]
[bond.chain]
formulation = "{formulation}"
between = ["chain", "chain"]
create_distance = {:?}
normal_stiffness = 1e12
tangential_stiffness = 4e11
[bond.chain.damping.viscous]
normal_force = 0.3
tangential_force = 0.3
normal_torque = 0.3
tangential_torque = 0.3
"#,
            1.05 * LENGTH
        ));
        let turn = TAU / ANGLE * step;
        chain.advance(30.0 * turn).unwrap();
        turn_and_compare(&mut chain, turn, 1e-9, formulation);
    }
}
