//! Clumps and groups have one temperature each.

use super::{GRAINS, assert_close, conductance, steps, temperature};
use crate::support::start;

/// Two spheres that are one body, and a third that overlaps one of them by 10 µm; nothing moves.
const SPHERES: &str = "[heat]\nfrozen = true\n[particles.other]\nmaterial = \"stone\"\ntemperature = 300.0\n\
                       list = [{ position = [3.99e-3, 0.0, 0.0], radius = 1.0e-3 }]\n";

#[test]
fn a_clump_has_one_temperature_and_the_heat_capacity_of_its_mass() {
    let text = format!(
        "{GRAINS}{SPHERES}[clump.pair]\nmaterial = \"stone\"\nmass = 2.0e-5\nspheres = [\n\
         {{ position = [-1.0e-3, 0.0, 0.0], radius = 1.0e-3 }},\n{{ position = [1.0e-3, 0.0, 0.0], radius = 1.0e-3 }},\n]\n\
         [particles.clumps]\nclump = \"pair\"\ntemperature = 400.0\nlist = [{{ position = [1.0e-3, 0.0, 0.0] }}]\n"
    );
    let mut simulation = start(&text);
    steps(&mut simulation, 1);
    let given = 1e-4 * 100.0 * conductance(1e-5);
    let heat = simulation.state().heat.as_ref().unwrap();
    assert!(heat.energy().abs() < 1e-13 * given, "{:e} J", heat.energy());
    let clump = simulation.scene().particles.iter().position(|particle| particle.position[0] < 3e-3).unwrap();
    assert_close(400.0 - temperature(&simulation, clump), given / (2.0e-5 * 500.0), 1e-9);
    let column = simulation.scene().column("temperature").unwrap();
    let particles = &simulation.state().particles;
    let of = |index: usize| particles.declared[column][particles.slot[index] as usize];
    assert_eq!(of(clump), of(clump + 1));
}

#[test]
fn a_group_without_a_temperature_of_its_own_takes_up_heat_as_its_particles_do() {
    let text = format!(
        "{GRAINS}{SPHERES}[particles.pair]\nmaterial = \"stone\"\ntemperature = 400.0\nlist = [\n\
         {{ position = [0.0, 0.0, 0.0], radius = 1.0e-3 }},\n{{ position = [2.0e-3, 0.0, 0.0], radius = 1.0e-3 }},\n]\n\
         [boundary.group]\nparticles = {{ set = \"pair\" }}\n"
    );
    let mut simulation = start(&text);
    steps(&mut simulation, 1);
    let given = 1e-4 * 100.0 * conductance(1e-5);
    let group = simulation.state().heat.as_ref().unwrap().boundaries[0];
    assert_close(group.heat(), -given, 1e-9);
    assert_close(-group.rise, given / (2.0 * super::capacity()), 1e-9);
}
