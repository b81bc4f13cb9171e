//! Whole time steps on the dense packing: nanoseconds per contact and step, for every lane width.
//!
//! `cargo bench --bench whole_step -- PARTICLES.csv.gz [STEPS] [THREADS]`

use cograin::contact::cohesion::CohesionChoice;
use cograin::contact::normal::NormalChoice;
use cograin::contact::rolling::RollingChoice;
use cograin::contact::tangential::TangentialChoice;
use cograin::contact::{Material, PairProperties, Switches};
use cograin::quantity::{MaterialIndex, NonNegative, ParticleId, Restitution, SetIndex};
use cograin::scene::{AxisMotion, Boundary, ContactLaw, InputCourse, Output, Particle, Run, Scene, Shape, Step};
use cograin::step::Simulation;
use cograin::step::lanes::Width;
use std::io::Read;
use std::sync::Arc;

/// User CPU time of this process \[s\].
fn user_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().nth(11)?.parse::<f64>().ok());
    ticks.unwrap_or(0.0) / 100.0
}

/// The scene `s1_20k` of the common scenes, from its packing.
fn scene(path: &str, threads: usize) -> Scene {
    let mut text = String::new();
    let file = std::fs::File::open(path).expect("the packing can be read");
    flate2::read::GzDecoder::new(file).read_to_string(&mut text).expect("the packing is text");
    let particles = text.lines().skip(1).map(|line| {
        let n: Vec<f64> = line.split(',').map(|part| part.parse().expect("a number")).collect();
        Particle {
            id: ParticleId(n[0] as u32),
            set: SetIndex(0),
            material: MaterialIndex(0),
            radius: n[4],
            density: n[5],
            position: [n[1], n[2], n[3]],
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        }
    });
    let particles: Vec<Particle> = particles.collect();
    let width = particles.iter().fold(0.0_f64, |most, p| most.max(p.position[0] + p.radius));
    let width = (width / 0.2448).round().max(1.0) * 0.2448;
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3]| Boundary {
        name: name.into(),
        shape: Shape::Plane { material: MaterialIndex(0), point, normal },
        axes: [AxisMotion::Fixed; 6],
        input: InputCourse::Ramp,
        reference: point,
    };
    Scene {
        run: Run { step: Step::Given(1.548_071_586_785_98e-5), threads: Some(threads), ..Run::default() },
        gravity: [0.0, 0.0, -9.81],
        materials: vec![Material {
            name: "glass".into(),
            density: 2500.0,
            youngs_modulus: Some(5e7),
            poissons_ratio: Some(0.3),
        }],
        pairs: vec![PairProperties {
            restitution: Restitution::new(0.5),
            friction: NonNegative::new(0.5),
            ..PairProperties::default()
        }],
        contacts: vec![ContactLaw {
            name: "grains".into(),
            between: vec![true],
            normal: NormalChoice::Hertz(Default::default()),
            tangential: TangentialChoice::History(Default::default()),
            rolling: RollingChoice::None(Default::default()),
            cohesion: CohesionChoice::None(Default::default()),
            switches: Switches::of(false, true),
        }],
        bonds: Vec::new(),
        sets: vec!["bed".into()],
        particles,
        boundaries: vec![
            plane("x_low", [0.0; 3], [1.0, 0.0, 0.0]),
            plane("x_high", [width, 0.0, 0.0], [-1.0, 0.0, 0.0]),
            plane("y_low", [0.0; 3], [0.0, 1.0, 0.0]),
            plane("y_high", [0.0, 0.2448, 0.0], [0.0, -1.0, 0.0]),
            plane("floor", [0.0; 3], [0.0, 0.0, 1.0]),
            plane("lid", [0.0, 0.0, 0.4], [0.0, 0.0, -1.0]),
        ],
        damping: Vec::new(),
        forces: Vec::new(),
        domain: None,
        output: Output::default(),
        fingerprint: 0,
    }
}

#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let path = arguments.first().map_or("models/loaded_beam/dense_20k.csv.gz", String::as_str);
    let number = |place: usize, other: usize| arguments.get(place).and_then(|n| n.parse().ok()).unwrap_or(other);
    let (steps, threads) = (number(1, 500), number(2, 1));
    let scene = Arc::new(scene(path, threads));
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        let mut simulation = Simulation::new(scene.clone()).expect("the scene starts");
        simulation.set_width(width);
        let step = simulation.state().clock.step;
        simulation.advance(20.0 * step).expect("it runs");
        let (wall, user) = (std::time::Instant::now(), user_time());
        simulation.advance(steps as f64 * step).expect("it runs");
        let (wall, user) = (wall.elapsed().as_secs_f64(), user_time() - user);
        let work = (steps * simulation.contact_count()) as f64 * 1e-9;
        println!(
            "{width:?}: {:.1} ns user, {:.1} ns wall per contact and step; {} contacts, {} rebuilds, state {:016x}, energy {:.6e} J",
            user / work,
            wall / work,
            simulation.contact_count(),
            simulation.state().clock.rebuilds,
            simulation.state().fingerprint(),
            simulation.kinetic_energy(),
        );
    }
}
