//! The deepest contact of a run: of all its time steps, with when and whom.

use cograin::run::remarks;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::sync::Arc;

/// A sphere between two plates, of which one presses and goes back.
const SQUEEZE: &str = r#"
[run]
step = 2e-5
end = 0.4
[material.g]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.g.g]
restitution = 0.5
friction = 0.5
[contact.c.normal.hertz]
[particles.p]
material = "g"
list = [{ position = [0.0, 0.0, 0.01], radius = 0.01 }]
[boundary.low]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "g"
[boundary.high]
SHAPE
material = "g"
motion = { prescribed = { z = { sine = { amplitude = -0.008, frequency = 1.25 } } } }
"#;

fn start(text: &str) -> Simulation {
    let source = Source { name: "scene.toml".into(), text: text.to_owned(), files: Default::default() };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(scene)).unwrap()
}

#[test]
fn the_deepest_contact_is_that_of_all_time_steps_at_any_kind_of_surface() {
    for shape in [
        "plane = { point = [0.0, 0.0, 0.0201], normal = [0.0, 0.0, -1.0] }",
        "disc = { centre = [0.0, 0.0, 0.0201], normal = [0.0, 0.0, -1.0], radius = 0.05 }",
    ] {
        let mut simulation = start(&SQUEEZE.replace("SHAPE", shape));
        assert_eq!(simulation.state().deepest.overlap, 0.0);
        let mut largest = (0.0, 0.0);
        for _ in 0..400 {
            simulation.advance(1e-3).unwrap();
            let overlap = simulation.largest_overlap();
            if overlap > largest.0 {
                largest = (overlap, simulation.time());
            }
        }
        let deepest = simulation.state().deepest;
        assert!(simulation.largest_overlap() < 1e-3 && largest.0 > 0.3, "{largest:?}");
        assert!(deepest.overlap >= largest.0 && deepest.overlap < largest.0 * 1.001, "{deepest:?} {largest:?}");
        assert!((deepest.time - largest.1).abs() < 1.1e-3 && deepest.partner.is_none(), "{deepest:?} {largest:?}");
        let told = remarks(simulation.scene(), &simulation).into_iter().find(|told| told.contains("overlap")).unwrap();
        let expected =
            format!("the largest overlap is {:.3} of a radius, of particle 1 and [boundary.", deepest.overlap);
        assert!(told.starts_with(&expected) && told.contains("] at t = "), "{told}");
    }
}

#[test]
fn the_deepest_contact_of_particles_is_over_the_smaller_radius_and_the_same_for_any_threads() {
    let text = |threads: usize| {
        let mut list = String::new();
        for place in 0..600 {
            let at = [place % 10, place / 10 % 10, place / 100].map(|at| 0.0201 * f64::from(at) + 0.01);
            let radius = if place % 7 == 0 { 0.005 } else { 0.01 };
            let speed = if at[0] < 0.1 { 0.4 } else { -0.7 };
            list += &format!("{{ position = {at:?}, radius = {radius:?}, velocity = [{speed:?}, 0.1, 0.0] }},\n");
        }
        format!(
            "[run]\nstep = 2e-5\nend = 0.1\nthreads = {threads}\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 1e6\npoissons_ratio = 0.25\n\
             [pair.g.g]\nrestitution = 0.5\nfriction = 0.5\n[contact.c.normal.hertz]\n[contact.c.tangential.history]\n\
             [particles.p]\nmaterial = \"g\"\nlist = [\n{list}]\n"
        )
    };
    let run = |threads: usize| {
        let (mut simulation, mut largest) = (start(&text(threads)), 0.0_f64);
        for _ in 0..1000 {
            simulation.advance(2e-5).unwrap();
            largest = largest.max(simulation.largest_overlap());
        }
        let deepest = simulation.state().deepest;
        assert!((deepest.overlap / largest - 1.0).abs() < 1e-12 && largest > 0.02, "{deepest:?} {largest}");
        deepest
    };
    let first = run(1);
    assert_eq!(first, run(3));
    assert!(first.partner.is_some() && first.boundary.is_none(), "{first:?}");
}
