//! Heat that flows for minutes and hours while nothing moves, in time steps that follow its error.

use super::{GRAINS, assert_close, capacity, conductance, row, temperature};
use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::f64::consts::PI;

/// A scene in which nothing moves, whose spheres overlap by 10 µm along x: temperatures \[K\], and further tables.
fn resting(temperatures: impl IntoIterator<Item = f64>, tables: &str) -> String {
    let list = row(temperatures.into_iter().enumerate().map(|(place, it)| (place as f64 * 1.99e-3, it)));
    let grains = GRAINS.replace("step = 1.0e-4\nallow_unstable = true\n", "");
    format!("{grains}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n{tables}")
}

/// A sphere that belongs to a boundary with this temperature.
fn held(name: &str, id: u32, temperature: &str) -> String {
    format!("[boundary.{name}]\nparticles = {{ ids = [{id}] }}\ntemperature = {temperature}\n")
}

/// The root of the slowest mode of ten spheres whose ends are held \[1/s\].
fn slowest() -> f64 {
    4.0 * conductance(1e-5) / capacity() * libm::pow(libm::sin(PI / 18.0), 2.0)
}

/// Ten spheres whose ends are held at 300 K, with the slowest mode between them.
fn chain() -> String {
    let mode = (0..10).map(|place| 300.0 + 50.0 * libm::sin(f64::from(place) * PI / 9.0));
    resting(mode, &(held("left", 1, "300.0") + &held("right", 10, "300.0")))
}

#[test]
fn the_method_is_of_second_order_beside_the_exact_exponential_of_a_chain() {
    let (time, place) = (60.0, 4);
    let exact = 50.0 * libm::exp(-slowest() * time) * libm::sin(f64::from(place) * PI / 9.0);
    let error = |interval: f64| {
        let mut simulation = start(&chain());
        // The first time steps are chosen below the communication step until the error is known.
        simulation.advance(1.0).unwrap();
        let begun = temperature(&simulation, place as usize) - 300.0;
        let exact_since = exact / (50.0 * libm::exp(-slowest()) * libm::sin(f64::from(place) * PI / 9.0));
        let steps = simulation.state().clock.steps;
        let count = ((time - 1.0) / interval).round() as u64;
        (0..count).for_each(|_| simulation.advance(interval).unwrap());
        assert_eq!(simulation.state().clock.steps - steps, count, "a communication step is one time step");
        temperature(&simulation, place as usize) - 300.0 - begun * exact_since
    };
    let [coarse, fine] = [error(1.0), error(0.5)];
    assert!(fine.abs() > 1e-6, "{fine:e} K is rounding");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse:e} K with 1 s, {fine:e} K with 0.5 s");
}

#[test]
fn a_chain_whose_ends_are_held_follows_its_closed_modes_in_one_communication_step() {
    let temperatures = [400.0].into_iter().chain([300.0; 9]);
    let mut simulation = start(&resting(temperatures, &(held("warm", 1, "400.0") + &held("cold", 10, "300.0"))));
    simulation.advance(50.0).unwrap();
    let line = |place: f64| 400.0 - 100.0 * place / 9.0;
    for place in 1..=8 {
        let mut expected = line(f64::from(place));
        for mode in 1..=8 {
            let sine = |place: u32| libm::sin(f64::from(mode * place) * PI / 9.0);
            let amplitude: f64 = (1..=8).map(|place| (300.0 - line(f64::from(place))) * sine(place)).sum();
            let half = libm::sin(f64::from(mode) * PI / 18.0);
            let rate = 4.0 * conductance(1e-5) / capacity() * half * half;
            expected += 2.0 / 9.0 * amplitude * libm::exp(-50.0 * rate) * sine(place as u32);
        }
        let found = temperature(&simulation, place as usize);
        assert!((found - expected).abs() < 5e-3, "sphere {place}: {found} K found, {expected} K expected");
    }
}

#[test]
fn what_equalises_at_once_and_what_takes_an_hour_are_both_right() {
    let air =
        "[heat_source.air]\nparticles = { set = \"all\" }\nambient = { temperature = 290.0, conductance = 1.0e-6 }\n";
    let mut simulation = start(&resting([400.0, 300.0], air));
    simulation.advance(1.0).unwrap();
    let apart = 100.0 * libm::exp(-(2.0 * conductance(1e-5) + 1e-6) / capacity());
    let found = temperature(&simulation, 0) - temperature(&simulation, 1);
    assert!((found - apart).abs() < 1e-3, "{found} K found, {apart} K expected");
    simulation.advance(3599.0).unwrap();
    let left = 60.0 * libm::exp(-3600.0 * 1e-6 / capacity());
    let mean = 0.5 * (temperature(&simulation, 0) + temperature(&simulation, 1)) - 290.0;
    assert!((mean - left).abs() < 1e-3, "{mean} K found, {left} K expected");
    let steps = simulation.state().clock.steps;
    assert!(steps < 500, "{steps} time steps");
}

#[test]
fn a_power_alone_warms_exactly() {
    let mut simulation =
        start(&resting([300.0], "[heat_source.wire]\nparticles = { set = \"all\" }\npower = 1.0e-3\n"));
    (0..3).for_each(|_| simulation.advance(700.0).unwrap());
    assert_close(simulation.state().heat.as_ref().unwrap().gained[0], 2.1, 1e-14);
}

/// A boundary of each kind in one row, surroundings and a power.
fn everything() -> String {
    let ends = held("body", 1, "350.0\nheat_capacity = 0.01\napplied_heat = 0.02")
        + &held("driven", 8, "{ driven = 320.0 }")
        + "[boundary.group]\nparticles = { ids = [4, 5] }\n"
        + "[heat_source.air]\nparticles = { ids = [2, 3] }\nambient = { temperature = 290.0, conductance = 1.0e-4 }\n"
        + "[heat_source.wire]\nparticles = { ids = [6] }\npower = 1.0e-3\n";
    resting([300.0, 307.0, 328.0, 314.0, 314.0, 300.0, 321.0, 328.0], &ends)
}

#[test]
fn heat_is_kept_to_rounding_whatever_the_stages() {
    let mut simulation = start(&everything());
    let mut moved = 0.0;
    for (end, interval) in [(400.0, 300.0), (310.0, 20.0), (310.0, 3600.0)] {
        simulation.set_heat(BoundaryIndex(1), end);
        simulation.advance(interval).unwrap();
        let heat = simulation.state().heat.as_ref().unwrap();
        assert_close(heat.boundaries[1].temperature(), end, 1e-15);
        assert_close(heat.boundaries[0].rise * 0.01, heat.boundaries[0].heat() + heat.boundaries[0].applied, 1e-13);
        assert_close(heat.boundaries[1].mean_flow * interval, heat.boundaries[1].present, 1e-15);
        moved += heat.boundaries.iter().map(|boundary| boundary.present.abs()).sum::<f64>();
    }
    let heat = simulation.state().heat.as_ref().unwrap();
    let boundaries: f64 = heat.boundaries.iter().map(|boundary| boundary.heat()).sum();
    let residual = heat.energy() + boundaries - heat.given;
    assert!(residual.abs() < 1e-12 * moved, "{residual:e} J of {moved:e} J");
    assert_close(heat.boundaries[0].applied, 0.02 * 3920.0, 1e-13);
}

#[test]
fn threads_and_a_restored_state_change_no_bit() {
    let run = |threads: usize, restored: bool| {
        let text = everything().replace("[run]\n", &format!("[run]\nthreads = {threads}\n"));
        let mut simulation: Simulation = start(&text);
        for (number, end) in [400.0, 310.0, 330.0].into_iter().enumerate() {
            if restored {
                let bytes = simulation.state().to_bytes(0);
                simulation = start(&text);
                simulation.restore(&State::from_bytes(&bytes, 0).unwrap()).unwrap();
            }
            simulation.set_heat(BoundaryIndex(1), end);
            simulation.advance(10.0 * (number + 1) as f64).unwrap();
        }
        simulation.state().clone()
    };
    let once = run(1, false);
    assert!(once == run(2, false), "two threads");
    assert!(once == run(1, true), "restored before each communication step");
}

#[test]
fn parts_of_a_communication_step_change_no_bit() {
    let (mut whole, mut parts) = (start(&everything()), start(&everything()));
    whole.advance(50.0).unwrap();
    while !parts.advance_part(50.0, 3).unwrap() {
        let bytes = parts.state().to_bytes(0);
        parts = start(&everything());
        parts.restore(&State::from_bytes(&bytes, 0).unwrap()).unwrap();
    }
    assert!(whole.state() == parts.state());
}
