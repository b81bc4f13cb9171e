//! What contacts lose warms the bodies, and no more than that.

use super::balance::pile;
use super::{GRAINS, assert_close, capacity, row, temperature};
use crate::support::{read, start};
use cograin::simulation::Simulation;
use cograin::state::Loss;

/// All losses that may warm.
const ALL: &str = "[heat]\nfrom_losses = [\"normal_damping\", \"tangential_damping\", \"sliding\"]\n";

/// What these losses took since the start \[J\].
pub(super) fn lost(simulation: &Simulation, causes: &[Loss]) -> f64 {
    let losses = simulation.losses().expect("losses that warm are booked");
    causes.iter().map(|&cause| losses[cause as usize]).sum()
}

/// Heat that particles gained and gave to boundaries since the start \[J\].
pub(super) fn heat(simulation: &Simulation) -> f64 {
    let heat = simulation.state().heat.as_ref().expect("heat flows");
    heat.energy() + heat.boundaries.iter().map(|boundary| boundary.heat()).sum::<f64>()
}

/// Two spheres that meet head on at 2 m/s and conduct nothing.
fn impact(restitution: f64) -> String {
    let list = row([(0.0, 300.0), (2.001e-3, 300.0)]).replacen("300.0 }", "300.0, velocity = [2.0, 0.0, 0.0] }", 1);
    GRAINS
        .replace("step = 1.0e-4", "step = 1.0e-7")
        .replace("restitution = 0.5", &format!("restitution = {restitution:?}"))
        .replace("[contact.touch.heat.constriction]\n", "")
        + &format!("{ALL}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n")
}

#[test]
fn an_impact_warms_both_bodies_by_half_of_what_it_loses() {
    for restitution in [0.3, 0.8] {
        let mut simulation = start(&impact(restitution));
        simulation.advance(1e-3).unwrap();
        let mass = capacity() / 500.0;
        let loss = 0.25 * mass * 2.0 * 2.0 * (1.0 - restitution * restitution);
        let rise = |index| temperature(&simulation, index) - 300.0;
        // As far as the time step reaches the restitution.
        assert_close(heat(&simulation), loss, 1e-3);
        assert_close(heat(&simulation), lost(&simulation, &[Loss::NormalDamping]), 1e-13);
        assert_close(rise(0), rise(1), 1e-9);
        assert_close(rise(0), 0.5 * heat(&simulation) / capacity(), 1e-9);
    }
}

/// A sphere that slides over a floor without turning, for it is one of a clump of three.
fn sled(floor: &str) -> String {
    GRAINS.replace("step = 1.0e-4", "step = 1.0e-5").replace("[run]", "gravity = [0.0, 0.0, -9.81]\n[run]")
        + &format!(
            "{ALL}[clump.sled]\nspheres = [\n{{ position = [0.0, 0.0, 0.0], radius = 1e-3 }},\n\
             {{ position = [8e-3, 0.0, 0.0], radius = 1e-3 }},\n{{ position = [4e-3, 8e-3, 0.0], radius = 1e-3 }},\n]\n\
             [particles.all]\nmaterial = \"stone\"\nclump = \"sled\"\n\
             list = [{{ position = [0.0, 0.0, 0.9999e-3], velocity = [0.5, 0.0, 0.0], temperature = 300.0 }}]\n\
             [boundary.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n{floor}\n"
        )
}

#[test]
fn friction_warms_a_sled_and_the_floor_by_the_motion_that_it_takes() {
    // A heat capacity that no friction warms, so that nothing is conducted which could be told from what friction gives.
    let mut simulation = start(&sled("temperature = 300.0\nheat_capacity = 1.0e9"));
    let before = simulation.kinetic_energy();
    simulation.advance(0.15).unwrap();
    assert!(simulation.kinetic_energy() < 1e-6 * before, "it has come to rest");
    assert_close(heat(&simulation), before, 0.01);
    let causes = [Loss::NormalDamping, Loss::TangentialDamping, Loss::Sliding];
    assert_close(heat(&simulation), lost(&simulation, &causes), 1e-12);
    assert!(lost(&simulation, &[Loss::Sliding]) > 0.9 * before);
    assert!(simulation.state().heat.as_ref().unwrap().boundaries[0].heat() > 0.49 * before);
}

#[test]
fn an_adiabatic_floor_leaves_all_heat_to_the_particles() {
    let mut simulation = start(&sled(""));
    let before = simulation.kinetic_energy();
    simulation.advance(0.15).unwrap();
    let heat = simulation.state().heat.as_ref().unwrap();
    assert_eq!(heat.boundaries[0].heat(), 0.0);
    assert_close(heat.energy(), before, 0.01);
}

/// A pile that falls on a floor and beside a mesh, with heat of all these losses.
fn warmed_pile() -> String {
    pile("temperature = 350.0\nheat_capacity = 1.0", 100.0)
        + "[boundary.side]\nrectangle = { corner = [-1.1e-3, -5e-3, -1e-3], edges = [[0, 20e-3, 0], [0, 0, 20e-3]] }\n\
           material = \"stone\"\ntemperature = 290.0\n"
        + ALL
}

#[test]
fn a_pile_gains_what_its_contacts_lose_to_rounding() {
    for law in ["[contact.touch.tangential.history]", "[contact.touch.tangential.no_history]"] {
        let text = warmed_pile().replace("[contact.touch.tangential.history]", law);
        let mut simulation = start(&text);
        simulation.advance(8e-3).unwrap();
        let causes = [Loss::NormalDamping, Loss::TangentialDamping, Loss::Sliding];
        let (gained, lost) = (heat(&simulation), lost(&simulation, &causes));
        let of_side = simulation.state().heat.as_ref().unwrap().boundaries[1].heat();
        assert!(lost > 0.0 && of_side != 0.0, "{lost:e} J lost, {of_side:e} J to the side");
        assert_close(gained, lost, 1e-11);
    }
}

#[test]
fn a_gas_in_a_periodic_cell_warms_by_the_energy_that_it_loses() {
    let mut list = String::new();
    for place in 0..64_u32 {
        let position = [place % 4, place / 4 % 4, place / 16].map(|part| 1.2e-3 + 2.5e-3 * f64::from(part));
        let velocity = [place % 7, place % 5, place % 3].map(|part| f64::from(part) - 1.5);
        list += &format!(
            "{{ position = {position:?}, radius = 1e-3, velocity = {velocity:?}, temperature = {:?} }},\n",
            300.0 + f64::from(place)
        );
    }
    let text = GRAINS.replace("step = 1.0e-4", "step = 1.0e-6").replace("friction = 0.5", "friction = 0.0")
        + &format!(
            "{ALL}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n[cell]\nedges = [[10e-3, 0, 0], [0, 10e-3, 0], [0, 0, 10e-3]]\n"
        );
    let mut simulation = start(&text);
    let before = simulation.kinetic_energy();
    simulation.advance(5e-3).unwrap();
    let now = simulation.kinetic_energy() + simulation.elastic_energy();
    assert!(now < 0.5 * before, "{now:e} J of {before:e} J are left");
    assert_close(heat(&simulation), before - now, 1e-3);
    assert_close(heat(&simulation), lost(&simulation, &[Loss::NormalDamping, Loss::TangentialDamping]), 1e-11);
}

#[test]
fn heat_of_losses_has_the_same_bits_for_any_threads_and_lanes() {
    let run = |threads: usize, width: cograin::lanes::Width| {
        let mut simulation = start(&warmed_pile().replace("[run]\n", &format!("[run]\nthreads = {threads}\n")));
        simulation.set_width(width);
        simulation.advance(5e-3).unwrap();
        simulation.state().fingerprint()
    };
    let first = run(1, cograin::lanes::Width::Least);
    assert_eq!(run(2, cograin::lanes::Width::widest()), first);
    assert_eq!(run(3, cograin::lanes::Width::Least), first);
}

#[test]
fn losses_that_are_no_heat_at_once_are_refused() {
    let refused = |text: &str, part: &str| {
        let found = read(text).expect_err(part).to_string();
        assert!(found.contains(part), "{found}");
    };
    let right = impact(0.5);
    refused(&right.replace("\"sliding\"", "\"projection\""), "projection");
    refused(&right.replace("[heat]", "[heat]\nfrozen = true"), "nothing moves in a scene with [heat] frozen = true");
}
