//! What flows in a network of contacts at rest.

use super::{GRAINS, assert_close, capacity, conductance, row, steps, temperature};
use crate::support::start;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Nothing moves.
const FROZEN: &str = "[heat]\nfrozen = true\n";

/// Two spheres of 1 mm that overlap by 10 µm, at 400 and 300 K.
fn two() -> String {
    let list = row([(0.0, 400.0), (1.99e-3, 300.0)]);
    format!("{GRAINS}{FROZEN}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n")
}

#[test]
fn nothing_has_flowed_before_the_first_step() {
    let simulation = start(&two());
    assert_eq!([temperature(&simulation, 0), temperature(&simulation, 1)], [400.0, 300.0]);
    assert_eq!(simulation.state().heat.as_ref().unwrap().flow, [0.0; 2]);
}

#[test]
fn two_bodies_approach_each_other_as_the_explicit_method_has_it() {
    let mut simulation = start(&two());
    steps(&mut simulation, 1000);
    let shrinks = 1.0 - 1e-4 * conductance(1e-5) * 2.0 / capacity();
    let apart = 100.0 * libm::pow(shrinks, 1000.0);
    assert_close(temperature(&simulation, 0), 350.0 + 0.5 * apart, 1e-12);
    assert_close(temperature(&simulation, 1), 350.0 - 0.5 * apart, 1e-12);
}

#[test]
fn a_chain_between_held_ends_follows_its_closed_modes() {
    let inner = (1..=8).map(|place| (place as f64 * 1.99e-3, 300.0));
    let list = row([(0.0, 300.0)].into_iter().chain(inner).chain([(9.0 * 1.99e-3, 300.0)]));
    let held = |name: &str, id: u32, temperature: f64| {
        format!("[boundary.{name}]\nparticles = {{ ids = [{id}] }}\ntemperature = {temperature:?}\n")
    };
    let ends = held("warm", 1, 400.0) + &held("cold", 10, 300.0);
    let text = format!("{GRAINS}{FROZEN}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n{ends}");
    let mut simulation = start(&text);
    steps(&mut simulation, 5000);
    let line = |place: f64| 400.0 - 100.0 * place / 9.0;
    for place in 1..=8 {
        let mut expected = line(f64::from(place));
        for mode in 1..=8 {
            let sine = |place: u32| libm::sin(f64::from(mode * place) * PI / 9.0);
            let amplitude: f64 = (1..=8).map(|place| (300.0 - line(f64::from(place))) * sine(place)).sum();
            let half = libm::sin(f64::from(mode) * PI / 18.0);
            let rate = 4.0 * conductance(1e-5) / capacity() * half * half;
            expected += 2.0 / 9.0 * amplitude * libm::pow(1.0 - 1e-4 * rate, 5000.0) * sine(place as u32);
        }
        assert_close(temperature(&simulation, place as usize), expected, 1e-11);
    }
}

/// Sites of a cubic cell in half edges.
fn sites(kind: &str) -> &'static [[i32; 3]] {
    match kind {
        "sc" => &[[0, 0, 0]],
        "bcc" => &[[0, 0, 0], [1, 1, 1]],
        _ => &[[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]],
    }
}

/// Effective conductivity of a lattice of spheres of 1 mm that overlap by 10 µm, by what flows through four cells between layers that
/// are held \[W/(m K)\].
fn effective_conductivity(kind: &str) -> f64 {
    let distance = 1.99e-3;
    let edge = distance
        * if kind == "sc" {
            1.0
        } else if kind == "bcc" {
            2.0 / 3.0_f64.sqrt()
        } else {
            2.0_f64.sqrt()
        };
    let (mut list, mut id, mut ends) = (String::new(), 0, [Vec::new(), Vec::new()]);
    for (x, y, z) in (0..27).map(|n| (n % 3, n / 3 % 3, n / 9)).chain((0..9).map(|n| (n % 3, n / 3, 3))) {
        for &[u, v, w] in sites(kind) {
            let [a, b, c] = [2 * x + u, 2 * y + v, 2 * z + w].map(|half| f64::from(half) * 0.5 * edge);
            id += 1;
            let _ = writeln!(
                list,
                "{{ position = [{a:?}, {b:?}, {c:?}], radius = 1e-3, temperature = {:?} }},",
                300.0 + 1000.0 * c
            );
            let top = if kind == "sc" { 6 } else { 7 };
            match 2 * z + w {
                0 => ends[0].push(id),
                half if half == top => ends[1].push(id),
                _ => {}
            }
        }
    }
    let height = f64::from(if kind == "sc" { 6 } else { 7 }) * 0.5 * edge;
    let [cold, warm] = &ends;
    let text = format!(
        "{GRAINS}{FROZEN}[cell]\nedges = [[{l:?}, 0, 0], [0, {l:?}, 0], [0, 0, 1.0]]\nperiodic = [\"x\", \"y\"]\n\
         [particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.cold]\nparticles = {{ ids = {cold:?} }}\ntemperature = 300.0\n\
         [boundary.warm]\nparticles = {{ ids = {warm:?} }}\ntemperature = {:?}\n",
        300.0 + 1000.0 * height,
        l = 3.0 * edge,
    );
    let mut simulation = start(&text);
    steps(&mut simulation, 1);
    let heat = simulation.state().heat.as_ref().unwrap();
    let inner = heat.flow.iter().fold(0.0_f64, |most, flow| most.max(flow.abs()));
    assert!(inner < 1e-12 * heat.boundaries[0].flow, "a straight field is an equilibrium: {inner:e} W");
    assert_close(-heat.boundaries[1].flow, heat.boundaries[0].flow, 1e-11);
    heat.boundaries[0].flow / (9.0 * edge * edge * 1000.0)
}

#[test]
fn lattices_conduct_as_their_closed_forms_say() {
    let distance = 1.99e-3;
    for (kind, factor) in [("sc", 1.0), ("bcc", 3.0_f64.sqrt()), ("fcc", 2.0 * 2.0_f64.sqrt())] {
        assert_close(effective_conductivity(kind), factor * conductance(1e-5) / distance, 1e-10);
    }
}

#[test]
fn bonds_conduct_beside_the_contact_that_they_suppress() {
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1.0e12\n\
                tangential_stiffness = 4.0e11\nconductivity = 7.0\nradius_multiplier = 0.5\n";
    let mut simulation = start(&(two() + bond));
    steps(&mut simulation, 1);
    let both = conductance(1e-5) + 7.0 * PI * 0.25e-6 / 1.99e-3;
    assert_close(-simulation.state().heat.as_ref().unwrap().flow[0], 100.0 * both, 1e-12);
}

/// Two spheres that fly apart at 2 m/s, and one from a floor, which overlap by 10 µm and are bonded until they are 5 nm further apart; this
/// is what their contacts do meanwhile.
fn flying_apart(contact: &str) -> String {
    let bond = |name: &str, others: &str, longest: f64| {
        format!(
            "[bond.{name}]\nbetween = [\"all\", \"{others}\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1.0e10\n\
             tangential_stiffness = 4.0e9\nconductivity = 7.0\nradius_multiplier = 0.5\ncontact = \"{contact}\"\n\
             [bond.{name}.breakage]\nmax_distance = {longest:?}\n"
        )
    };
    GRAINS.replace("step = 1.0e-4", "step = 1.0e-9")
        + "[particles.all]\nmaterial = \"stone\"\nlist = [\n\
           { position = [0.0, 0.0, 3.0e-3], radius = 1.0e-3, temperature = 400.0, velocity = [-1.0, 0.0, 0.0] },\n\
           { position = [1.99e-3, 0.0, 3.0e-3], radius = 1.0e-3, temperature = 300.0, velocity = [1.0, 0.0, 0.0] },\n\
           { position = [9.0e-3, 0.0, 0.99e-3], radius = 1.0e-3, temperature = 400.0, velocity = [0.0, 0.0, 2.0] },\n]\n\
           [boundary.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stone\"\ntemperature = 300.0\n"
        + &bond("glue", "all", 1.99e-3 + 5e-9)
        + &bond("foot", "floor", 0.99e-3 + 5e-9)
}

#[test]
fn a_contact_that_a_bond_suppresses_conducts_once_while_bodies_move_and_when_the_bond_has_broken() {
    for contact in ["parallel", "without_normal", "none"] {
        let mut simulation = start(&flying_apart(contact));
        let mut lived = 0;
        for step in 0..12 {
            let before = [0, 1, 2].map(|index| temperature(&simulation, index));
            simulation.advance(1e-9).unwrap();
            let state = simulation.state();
            let place = |index: usize| state.particles.position[state.particles.slot[index] as usize];
            let (apart, high) = (place(1)[0] - place(0)[0], place(2)[2]);
            let bonded = |law: usize, length: f64| {
                if state.bonds[law].first.is_empty() { 0.0 } else { 7.0 * PI * 0.25e-6 / length }
            };
            let pair = conductance(2e-3 - apart) + bonded(0, apart);
            let wall = 2.0 * 5.0 * (1e-3 * (1e-3 - high)).sqrt() + bonded(1, high);
            let flow = &state.heat.as_ref().unwrap().flow;
            assert_close(flow[1], pair * (before[0] - before[1]), 1e-11);
            assert_close(-flow[2], wall * (before[2] - 300.0), 1e-11);
            lived += u32::from(!state.bonds[0].first.is_empty());
            assert!(step > 0 || lived == 1, "{contact}: they are bonded at first");
        }
        assert!((1..11).contains(&lived), "{contact}: the bond has lived {lived} steps");
        assert!(simulation.state().bonds[1].first.is_empty(), "{contact}");
    }
}

#[test]
fn an_elastic_impact_of_a_hot_and_a_cold_sphere_gives_the_heat_of_the_closed_form() {
    let list = row([(0.0, 400.0), (2.0001e-3, 300.0)]).replacen("400.0 }", "400.0, velocity = [1.0, 0.0, 0.0] }", 1);
    let text = GRAINS.replace("step = 1.0e-4", "step = 1.0e-7").replace("restitution = 0.5", "restitution = 1.0");
    let mut simulation = start(&format!("{text}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n"));
    simulation.advance(2e-4).unwrap();
    assert_eq!(simulation.contact_count(), 0);
    // Hertz: the deepest overlap, and ∫ a dt = 4/5 B(3/5, 1/2) √(R* δ) δ/v; the heat is 2 k ΔT times that.
    let (mass, radius, modulus) = (0.5 * capacity() / 500.0, 0.5e-3_f64, 0.5 * 5.0e7 / (1.0 - 0.0625));
    let deepest = libm::pow(15.0 * mass / (16.0 * radius.sqrt() * modulus), 0.4);
    let expected = 2.0 * 5.0 * 100.0 * 2.21960 * (radius * deepest).sqrt() * deepest;
    assert_close(simulation.state().heat.as_ref().unwrap().gained[1], expected, 1e-4);
}
