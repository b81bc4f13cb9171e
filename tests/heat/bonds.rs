//! Heat of what bonds lose.

use super::held::{ALL, assert_booked, unheated, with_step};
use super::losses::{heat, lost};
use super::{GRAINS, assert_close};
use crate::exchange::bonds::{DAMPED, torn};
use crate::support::start;
use cograin::state::Loss;

/// Two bonded spheres that fly apart, on a floor that a third one is bonded to.
fn bonded(contact: &str) -> String {
    with_step(GRAINS, "5.0e-7")
        + ALL
        + &format!(
            "[particles.all]\nmaterial = \"stone\"\nlist = [\n\
             {{ position = [0.0, 0.0, 4.0e-3], radius = 1.0e-3, temperature = 300.0, velocity = [-0.2, 0.1, 0.0] }},\n\
             {{ position = [1.99e-3, 0.0, 4.0e-3], radius = 1.0e-3, temperature = 400.0, velocity = [0.2, 0.0, 0.0] }},\n\
             {{ position = [8.0e-3, 0.0, 0.999e-3], radius = 1.0e-3, temperature = 350.0, velocity = [0.05, 0.0, 0.2] }},\n]\n\
             [boundary.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n\
             temperature = 300.0\nheat_capacity = 1.0\n\
             [bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\ncontact = \"{contact}\"\n\
             normal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
             [bond.glue.damping.viscous]\nnormal_force = 0.1\ntangential_force = 0.1\n\
             [bond.foot]\nbetween = [\"all\", \"floor\"]\ncreate_distance = 2.1e-3\ncontact = \"{contact}\"\n\
             normal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
             [bond.foot.damping.viscous]\nnormal_force = 0.1\ntangential_force = 0.1\n"
        )
}

#[test]
fn bonds_warm_their_bodies_by_what_damping_takes() {
    for contact in ["parallel", "without_normal", "none"] {
        let mut simulation = start(&bonded(contact));
        let before = simulation.kinetic_energy() + simulation.elastic_energy();
        for _ in 0..20 {
            simulation.advance(2e-5).unwrap();
            assert_booked(&simulation, before);
        }
        let damped = lost(&simulation, &[Loss::BondDamping]);
        assert!(damped > 0.1 * before, "{contact}: {damped:e} J of {before:e} J");
        let now = simulation.kinetic_energy() + simulation.elastic_energy();
        let residual = simulation.physical_residual().unwrap();
        assert_close(heat(&simulation), before - now + residual - unheated(&simulation), 1e-9);
        assert!(residual.abs() < 0.02 * before, "{contact}: {residual:e} J of {before:e} J");
    }
}

#[test]
fn a_bond_at_a_boundary_warms_both() {
    let only = bonded("none").replace(ALL, "[heat]\nfrom_losses = [\"bond_damping\"]\n");
    let text = only.replace("[contact.touch.heat.constriction]\n", "");
    let mut simulation = start(&text);
    simulation.advance(2e-4).unwrap();
    let heat = simulation.state().heat.as_ref().unwrap();
    let floor = heat.boundaries[0].heat();
    assert!(floor > 0.0);
    assert_close(heat.gained[2], floor, 1e-12);
    assert_close(heat.gained[0], heat.gained[1], 1e-12);
}

#[test]
fn bonds_that_break_warm_their_bodies_by_what_they_held() {
    let breaking = "[bond.glue.breakage]\nmax_distance = 1.9905e-3\n[bond.foot.breakage]\nmax_distance = 0.99905e-3\n";
    let text = bonded("none").replace("_force = 0.1", "_force = 0.0") + breaking;
    let mut simulation = start(&text);
    let before = simulation.kinetic_energy();
    for _ in 0..20 {
        simulation.advance(2e-5).unwrap();
        assert_booked(&simulation, before);
    }
    let released = lost(&simulation, &[Loss::BondRelease]);
    assert!(released > 0.0);
    assert_eq!(simulation.state().bonds.iter().map(|list| list.broken).collect::<Vec<_>>(), [1, 1]);
    assert!(simulation.state().heat.as_ref().unwrap().boundaries[0].heat() > 0.0);
}

#[test]
fn what_remains_of_bonds_is_warmed_where_their_bodies_go() {
    for contact in ["without_normal", "none"] {
        let text = torn("finite_rotation", contact, DAMPED, ALL)
            .replace("poissons_ratio = 0.25", "poissons_ratio = 0.25\nspecific_heat = 500.0")
            .replace("[particles.block]\n", "[particles.block]\ntemperature = 300.0\n")
            .replace("[particles.rod]\n", "[particles.rod]\ntemperature = 300.0\n")
            .replace("[boundary.floor]\n", "[boundary.floor]\ntemperature = 300.0\n")
            .replace("[boundary.end]\n", "[boundary.end]\ntemperature = 300.0\nheat_capacity = 1.0\n");
        let mut simulation = start(&text);
        let before = simulation.kinetic_energy();
        for _ in 0..15 {
            simulation.advance(1e-4).unwrap();
            assert_booked(&simulation, before);
        }
        assert!(simulation.state().bonds.iter().any(|list| list.removed > 20));
    }
}
