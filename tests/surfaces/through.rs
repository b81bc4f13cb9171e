//! Particles that touch each other through a thin surface are told of.

use cograin::run::remarks;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::sync::Arc;

/// Two grains that a boundary is between, or not: the lower one stands aside by so much \[m\].
fn scene(boundary: &str, aside: f64, material: &str) -> Simulation {
    let text = format!(
        "[run]\nstep = 1e-6\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 5e6\npoissons_ratio = 0.25\n\
         [material.other]\ndensity = 2500.0\nyoungs_modulus = 5e6\npoissons_ratio = 0.25\n\
         [pair.g.g]\nrestitution = 0.9\nfriction = 0.0\n[pair.g.other]\nrestitution = 0.9\nfriction = 0.0\n\
         [contact.c]\nbetween = [[\"g\", \"g\"], [\"g\", \"other\"]]\n[contact.c.normal.hertz]\n\
         [particles.up]\nmaterial = \"g\"\nlist = [{{ position = [0.0, 0.0, 0.00501], radius = 0.005, velocity = [0.0, 0.0, -0.3] }}]\n\
         [particles.low]\nmaterial = \"{material}\"\nlist = [{{ position = [{aside:?}, 0.0, -0.00501], radius = 0.005, velocity = [0.0, 0.0, 0.3] }}]\n\
         [boundary.plate]\n{boundary}\nmaterial = \"g\"\n"
    );
    let source = Source { name: "scene.toml".into(), text, files: Default::default() };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(scene)).unwrap()
}

/// What is told of it.
fn told(simulation: &Simulation) -> Option<String> {
    remarks(simulation.scene(), simulation).into_iter().find(|told| told.starts_with("[boundary.plate]: particles"))
}

const SHEETS: [&str; 2] = [
    "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.2 }",
    "cylinder = { from = [-0.3, 0.0, -0.2], to = [0.3, 0.0, -0.2], radius = 0.2 }",
];

#[test]
fn particles_that_touch_through_a_thin_surface_are_told_with_when_and_whom() {
    for sheet in SHEETS {
        let mut simulation = scene(sheet, 0.0, "g");
        let before = told(&simulation).unwrap();
        let expected =
            "[boundary.plate]: particles 1 and 2 are near each other on both sides of it and may touch through it";
        assert!(before.starts_with(expected), "{before}");
        for _ in 0..60 {
            simulation.advance(1e-4).unwrap();
        }
        let after = told(&simulation).unwrap();
        assert!(
            after.starts_with("[boundary.plate]: particles 1 and 2 touched each other through it at t = "),
            "{after}"
        );
        let time = simulation.state().through.first.unwrap().time;
        // The gap of 20 µm closes at 0.6 m/s.
        assert!((time - 2e-5 / 0.6).abs() < 2e-6, "{time} s");
    }
}

#[test]
fn particles_beside_each_other_or_beyond_the_rim_or_without_a_law_are_not_told() {
    let small = "disc = { centre = [-0.01, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.00995 }";
    for (sheet, aside, material) in [(SHEETS[0], 0.02, "g"), (small, 0.0, "g")] {
        let mut simulation = scene(sheet, aside, material);
        for _ in 0..60 {
            simulation.advance(1e-4).unwrap();
        }
        assert_eq!(told(&simulation), None, "{sheet}, {aside}");
    }
    let [disc, _] = SHEETS;
    let simulation = scene(disc, 0.0, "other");
    assert!(told(&simulation).is_some(), "both have a law");
}

#[test]
fn what_touched_through_a_surface_is_saved_with_the_state() {
    let mut simulation = scene(SHEETS[0], 0.0, "g");
    let saved = simulation.state().clone();
    simulation.advance(1e-3).unwrap();
    let first = simulation.state().through.first;
    assert!(first.is_some());
    simulation.restore(&saved).unwrap();
    assert!(simulation.state().through.first.is_none());
    simulation.advance(1e-3).unwrap();
    assert_eq!(simulation.state().through.first, first);
}
