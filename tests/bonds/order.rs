//! Who is called i and who j, and in which order bodies are listed, changes nothing.

use crate::support::start;
use cograin::simulation::Simulation;
use std::collections::BTreeMap;

/// Position, velocity and angular velocity of the particle with this number.
fn body(simulation: &Simulation, id: u32) -> [[f64; 4]; 3] {
    let index = simulation.scene().particles.iter().position(|particle| particle.id.0 == id).expect("it is there");
    let particles = &simulation.state().particles;
    let slot = particles.slot[index] as usize;
    [particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]]
}

/// Two unequal spheres in any motion, with these numbers.
fn pair(formulation: &str, more: &str, [one, other]: [u32; 2]) -> Simulation {
    start(&format!(
        r#"
[run]
step = 2e-7
[material.ice]
density = 1000.0
[particles.pair]
material = "ice"
list = [
    {{ id = {one}, position = [0.0, 0.1e-3, 0.0], radius = 1.0e-3, velocity = [0.3, 0.2, -0.1], angular_velocity = [30.0, 0.0, 90.0] }},
    {{ id = {other}, position = [1.0e-3, 1.2e-3, 0.9e-3], radius = 0.8e-3, velocity = [0.2, -0.3, 0.2], angular_velocity = [0.0, -70.0, 20.0] }},
]
[bond.glue]
formulation = "{formulation}"
between = ["pair", "pair"]
create_distance = 2.2e-3
normal_stiffness = 1e10
tangential_stiffness = 4e9
{more}
"#
    ))
}

#[test]
fn a_pair_exchanged_does_the_same_in_every_formulation() {
    let parts = "{ normal_force = 0.2, tangential_force = 0.2, normal_torque = 0.2, tangential_torque = 0.2 }";
    let relaxation =
        "relaxation = { normal_force = 1e-4, tangential_force = 1e-4, normal_torque = 1e-4, tangential_torque = 1e-4 }";
    for formulation in ["finite_rotation", "incremental", "engine_exact"] {
        for damping in ["", "sign", "smooth", "opposing", "viscous"] {
            if formulation == "engine_exact" && ["opposing", "viscous"].contains(&damping) {
                continue;
            }
            let damping =
                if damping.is_empty() { relaxation.to_owned() } else { format!("damping = {{ {damping} = {parts} }}") };
            let [mut one, mut other] = [[1, 2], [2, 1]].map(|ids| pair(formulation, &damping, ids));
            // Not longer: bending of the engine lets rounding grow in space.
            for _ in 0..50 {
                one.advance(2e-7).expect("it runs");
                other.advance(2e-7).expect("it runs");
            }
            for (id, exchanged) in [(1, 2), (2, 1)] {
                let (a, b) = (body(&one, id), body(&other, exchanged));
                for (quantity, scale) in [1e-3, 0.4, 100.0].into_iter().enumerate() {
                    for axis in 0..3 {
                        let apart = (a[quantity][axis] - b[quantity][axis]).abs() / scale;
                        assert!(apart < 1e-12, "{formulation}, {damping}: {apart:e}");
                    }
                }
            }
        }
    }
}

/// Numbers of grains along each axis of a block.
const COUNTS: [usize; 3] = [13, 13, 12];

/// A block of unequal grains whose upper half is thrown sideways, listed in this order; number k is the k-th grain of the block
/// whatever the order.
fn block(threads: usize, order: &[usize]) -> Simulation {
    let grain = |number: usize| {
        let [i, j, k] = [number % COUNTS[0], number / COUNTS[0] % COUNTS[1], number / (COUNTS[0] * COUNTS[1])];
        // Irregular, so that no two bonds are loaded alike.
        let shift = |seed: usize| ((number * 37 + seed * 11) % 17) as f64 * 4e-6;
        let position: Vec<String> = [i, j, k]
            .into_iter()
            .enumerate()
            .map(|(axis, place)| format!("{:?}", 2e-3 * place as f64 + shift(axis)))
            .collect();
        let fast = if k >= COUNTS[2] / 2 { "[2.0, 1.0, 0.3]" } else { "[0.0, 0.0, 0.0]" };
        let radius = 0.95e-3 + shift(5) * 0.5;
        let id = number + 1;
        format!("{{ id = {id}, position = [{}], radius = {radius:?}, velocity = {fast} }},", position.join(", "))
    };
    let list: String = order.iter().map(|&number| grain(number)).collect();
    start(&format!(
        r#"
[run]
step = 2e-7
threads = {threads}
[material.ice]
youngs_modulus = 1.0e8
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "ice"
list = [{list}]
[bond.glue]
between = ["block", "block"]
create_distance = 2.2e-3
normal_stiffness = 1e11
tangential_stiffness = 4e10
contact = "without_normal"
breakage = {{ max_normal_stress = 3.0e5, max_shear_stress = 3.0e5 }}
"#
    ))
}

/// When each bond broke, and with which energy, by the numbers of its grains.
fn breaks(mut simulation: Simulation) -> BTreeMap<[u32; 2], (f64, f64)> {
    let mut found = BTreeMap::new();
    for _ in 0..200 {
        simulation.advance(4e-7).expect("it runs");
        let id = |index: u32| simulation.scene().particles[index as usize].id.0;
        for broken in &simulation.state().breaks {
            let (one, other) = (id(broken.first), id(broken.second.expect("a particle")));
            let twice = found.insert([one.min(other), one.max(other)], (broken.time, broken.energy));
            assert_eq!(twice, None);
        }
    }
    found
}

#[test]
fn what_breaks_when_does_not_depend_on_the_order_of_the_grains_or_on_threads() {
    let count = COUNTS.iter().product();
    let listed: Vec<usize> = (0..count).collect();
    let backwards: Vec<usize> = (0..count).rev().collect();
    // 29 has no factor in common with the number of grains.
    let shuffled: Vec<usize> = (0..count).map(|place| place * 29 % count).collect();
    let expected = breaks(block(1, &listed));
    assert!(expected.len() > 20, "{} bonds broke", expected.len());
    for (order, threads) in [(&backwards, 1), (&shuffled, 3)] {
        let block = block(threads, order);
        assert_eq!(block.threads(), threads, "enough grains for them");
        let found = breaks(block);
        assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
        for (pair, (time, energy)) in &found {
            let (expected_time, expected_energy) = expected[pair];
            assert_eq!(*time, expected_time, "{pair:?}");
            assert!((energy / expected_energy - 1.0).abs() < 1e-9, "{pair:?}: {energy:e} J, {expected_energy:e} J");
        }
    }
}
