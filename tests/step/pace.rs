//! The automatic time step follows the moment: impacts of two bodies are as accurate as `[run] accuracy` says, whenever and wherever they
//! come; packings take the stable step.
//!
//! All trials of a communication step are divided alike.

use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use std::fmt::Write;

/// Speed of the impacts \[m/s\].
const SPEED: f64 = 0.7;

/// A scene of spheres of 1 mm without gravity.
fn scene(run: &str, law: &str, restitution: f64, rest: &str) -> String {
    format!(
        "[run]\nthreads = 1\nmax_overlap = 0.2\n{run}\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 5e7\npoissons_ratio = 0.25\n\
         [pair.g.g]\nrestitution = {restitution}\n{law}\n{rest}"
    )
}

/// Normal models.
const LAWS: [&str; 2] = ["[contact.c.normal.hertz]", "[contact.c.normal.hooke]\ncharacteristic_velocity = 0.7"];

/// What a sphere is thrown at that comes from above; it begins this far away \[m\].
fn target(kind: &str, gap: f64) -> String {
    let thrown = |z: f64| format!("{{ position = [0.0, 0.0, {z:?}], radius = 1e-3, velocity = [0.0, 0.0, -{SPEED}] }}");
    let one = |z: f64| format!("[particles.p]\nmaterial = \"g\"\nlist = [{}]\n", thrown(z));
    let held = "[particles.t]\nmaterial = \"g\"\nlist = [\n{ position = [0.0, 0.0, 0.0], radius = 1e-3 },\n\
                { position = [0.0, 0.0, -2e-3], radius = 1e-3 }]\n[boundary.t]\nparticles = { set = \"t\" }\n";
    match kind {
        "plane" => format!(
            "{}[boundary.t]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"g\"\nmotion = \"fixed\"\n",
            one(1e-3 + gap)
        ),
        "rectangle" => format!(
            "{}[boundary.t]\nrectangle = {{ corner = [-0.1, -0.1, 0.0], edges = [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0]] }}\n\
             material = \"g\"\nmotion = \"fixed\"\n",
            one(1e-3 + gap)
        ),
        "sphere" => format!(
            "[particles.p]\nmaterial = \"g\"\nlist = [{}, {{ position = [0.0, 0.0, 0.0], radius = 1e-3 }}]\n",
            thrown(2e-3 + gap)
        ),
        "held group" => format!("{}{held}motion = \"fixed\"\n", one(2e-3 + gap)),
        "free group" => format!("{}{held}motion = {{ free = [\"x\", \"y\", \"z\"] }}\n", one(2e-3 + gap)),
        _ => panic!("{kind}"),
    }
}

/// What is left of the velocity over the target after the impact, over the speed; and the time steps made. All in one communication step.
fn rebound(run: &str, law: &str, restitution: f64, kind: &str, gap: f64) -> (f64, u64) {
    let mut simulation = start(&scene(run, law, restitution, &target(kind, gap)));
    simulation.advance(gap / SPEED + 3e-3).expect("it runs");
    assert_eq!(simulation.contact_count(), 0, "{kind}: they are apart again");
    let state = simulation.state();
    let z = |id: u32| state.particles.velocity[state.particles.slot[id as usize] as usize][2];
    let other = if matches!(kind, "sphere" | "free group") { z(1) } else { 0.0 };
    ((z(0) - other) / SPEED, state.clock.steps)
}

/// Distances from which something is thrown, in any phase of lists, looks and time steps \[m\].
fn gaps(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(|number| {
        let part = (f64::from(number) * 0.618_033_988_749_894_8).fract();
        1e-5 + 6e-3 * part * part
    })
}

#[test]
fn impacts_of_two_bodies_are_as_accurate_as_the_scene_says_wherever_they_come_from() {
    for law in LAWS {
        for kind in ["plane", "rectangle", "sphere", "held group", "free group"] {
            for restitution in [0.5, 0.9] {
                let (right, _) = rebound("safety = 0.01", law, restitution, kind, 1e-4);
                for (run, most) in [("", 1e-2), ("accuracy = 0.003", 3e-3)] {
                    for gap in gaps(20) {
                        let (found, _) = rebound(run, law, restitution, kind, gap);
                        assert!(
                            (found - right).abs() <= most,
                            "{law}, {kind} from {gap} m, {run}: e = {found}, {right} expected"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_flight_between_impacts_takes_long_time_steps_within_one_communication_step() {
    let (_, free) = rebound("", LAWS[0], 0.9, "plane", 0.06);
    let (_, fixed) = rebound("safety = 0.2", LAWS[0], 0.9, "plane", 0.06);
    assert!(fixed > 3 * free, "{free} time steps, {fixed} with a fixed fraction");
}

/// A cubic lattice of touching spheres on a floor between walls, and what stands above it.
fn bed(run: &str, above: &str) -> String {
    let mut walls = String::new();
    for (name, point, normal) in [
        ("floor", [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ("left", [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ("right", [8e-3, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ("front", [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("back", [0.0, 8e-3, 0.0], [0.0, -1.0, 0.0]),
    ] {
        writeln!(
            walls,
            "[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"g\"\nmotion = \"fixed\""
        )
        .unwrap();
    }
    let spheres: Vec<String> = (0..48)
        .map(|index| {
            let [x, y, z] = [index % 4, index / 4 % 4, index / 16].map(|place| 1e-3 + 2e-3 * f64::from(place));
            format!("{{ position = [{x:?}, {y:?}, {z:?}], radius = 1e-3 }}")
        })
        .collect();
    format!(
        "gravity = [0.0, 0.0, -9.81]\n{}",
        scene(
            run,
            LAWS[0],
            0.5,
            &format!("[particles.bed]\nmaterial = \"g\"\nlist = [{}]\n{above}{walls}", spheres.join(",\n"))
        )
    )
}

/// The time step over the stable one.
fn part(simulation: &Simulation) -> f64 {
    simulation.state().clock.step / simulation.state().clock.stable
}

#[test]
fn a_bed_takes_the_stable_step_and_so_does_a_grain_that_lies_on_a_floor() {
    let mut simulation = start(&bed("", ""));
    simulation.advance(0.05).expect("it runs");
    assert!((part(&simulation) - 0.8).abs() < 0.08, "{} of the stable step", part(&simulation));
    let lies = target("plane", 0.0).replace("-0.7", "0.0");
    let mut simulation = start(&format!("gravity = [0.0, 0.0, -9.81]\n{}", scene("", LAWS[0], 0.5, &lies)));
    simulation.advance(0.05).expect("it runs");
    assert!((part(&simulation) - 0.8).abs() < 0.08, "{} of the stable step", part(&simulation));
}

#[test]
fn a_grain_that_falls_on_a_bed_takes_the_steps_of_the_bed_and_two_that_meet_above_it_their_own() {
    let falls = "[particles.above]\nmaterial = \"g\"\nlist = [{ position = [4e-3, 4e-3, 9e-3], radius = 1e-3, velocity = [0.0, 0.0, -0.3] }]\n";
    let mut simulation = start(&bed("", falls));
    let mut least = f64::INFINITY;
    for _ in 0..200 {
        simulation.advance(1e-4).expect("it runs");
        least = least.min(part(&simulation));
    }
    assert!(least > 0.4, "{least} of the stable step");
    let meet = "[particles.above]\nmaterial = \"g\"\nlist = [\n\
                { position = [2e-3, 4e-3, 0.03], radius = 1e-3, velocity = [0.3, 0.0, 0.0] },\n\
                { position = [6e-3, 4e-3, 0.03], radius = 1e-3, velocity = [-0.3, 0.0, 0.0] }]\n";
    let mut simulation = start(&bed("", meet));
    let mut least = f64::INFINITY;
    for _ in 0..200 {
        simulation.advance(1e-4).expect("it runs");
        least = least.min(part(&simulation));
    }
    assert!(least < 0.3, "{least} of the stable step");
}

#[test]
fn the_step_that_follows_is_part_of_the_state() {
    let meet = "[particles.above]\nmaterial = \"g\"\nlist = [\n\
                { position = [2e-3, 4e-3, 0.01], radius = 1e-3, velocity = [0.3, 0.0, -0.5] },\n\
                { position = [6e-3, 4e-3, 0.03], radius = 1e-3, velocity = [-0.3, 0.0, 0.0] }]\n";
    let text = bed("", meet);
    let mut whole = start(&text);
    for count in 1..60_u32 {
        whole.advance(2.7e-4).expect("it runs");
        if count % 7 == 0 {
            let bytes = whole.state().to_bytes(0);
            let mut restored = start(&text.replace("threads = 1", "threads = 2"));
            restored.restore(&cograin::state::State::from_bytes(&bytes, 0).unwrap()).unwrap();
            whole = restored;
        }
    }
    let mut straight = start(&text);
    for _ in 1..60 {
        straight.advance(2.7e-4).expect("it runs");
    }
    assert!(straight.state() == whole.state(), "a run that was saved and restored has other bits");
}

#[test]
fn trials_of_one_communication_step_are_divided_like_the_first() {
    // A plane presses two spheres in a row; the faster it comes, the stiffer they are foreseen to be.
    let text = scene(
        "safety = 0.3",
        LAWS[0],
        0.9,
        "[particles.p]\nmaterial = \"g\"\nlist = [\n{ position = [0.0, 0.0, 0.995e-3], radius = 1e-3 },\n\
         { position = [0.0, 0.0, 2.985e-3], radius = 1e-3 }]\n\
         [boundary.floor]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"g\"\nmotion = \"fixed\"\n\
         [boundary.lid]\nplane = { point = [0.0, 0.0, 3.975e-3], normal = [0.0, 0.0, -1.0] }\nmaterial = \"g\"\n\
         motion = { driven = [\"z\"] }\n",
    );
    let mut simulation = start(&text);
    simulation.advance_or_roll_back(5e-4).expect("it runs");
    let begin = simulation.state().clone();
    let force = |simulation: &mut Simulation, displacement: f64| {
        simulation.restore(&begin).unwrap();
        simulation.set_input(BoundaryIndex(1), 2, displacement);
        simulation.advance_or_roll_back(5e-4).expect("it runs");
        (simulation.state().boundaries[1].force[2], simulation.state().clock.steps)
    };
    let trials: Vec<(f64, u64)> = (0..=400).map(|trial| force(&mut simulation, -1e-7 * f64::from(trial))).collect();
    assert!(trials.iter().all(|trial| trial.1 == trials[0].1), "trials have other numbers of time steps");
    // What one trial adds is what the next adds, but for the curvature.
    let slopes: Vec<f64> = trials.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    for pair in slopes.windows(2) {
        let most = pair[0].abs().max(pair[1].abs());
        assert!((pair[1] - pair[0]).abs() <= 0.2 * most, "the force jumps: {} N, then {} N", pair[0], pair[1]);
    }
    // The first trial again has its bits.
    let first = force(&mut simulation, 0.0);
    assert_eq!(first, trials[0]);
}

#[test]
fn what_was_tried_and_discarded_leaves_nothing_behind() {
    // A plane that comes so fast that time steps must be far shorter, or that the trial fails; then a step from the same saved state.
    for run in ["", "safety = 0.3"] {
        let text = bed(run, "").replace("[boundary.floor]", LID);
        let mut used = start(&text);
        for _ in 0..10 {
            used.advance_or_roll_back(5e-4).expect("it runs");
        }
        let begin = used.state().to_bytes(0);
        let state = || cograin::state::State::from_bytes(&begin, 0).unwrap();
        let step = |simulation: &mut Simulation, displacement: f64| {
            simulation.set_input(BoundaryIndex(0), 2, displacement);
            simulation.advance_or_roll_back(5e-4).map(|()| simulation.state().clock.steps)
        };
        let mut fresh = start(&text);
        fresh.restore(&state()).unwrap();
        let expected = step(&mut fresh, -1e-7).expect("it runs");
        for wild in [-1e-4, -1e-3, -1.0] {
            let _ = step(&mut used, wild);
            used.restore(&state()).unwrap();
            assert_eq!(step(&mut used, -1e-7), Ok(expected), "{run}, after a trial that went {wild} m");
            assert!(used.state() == fresh.state(), "{run}: a trial that went {wild} m changes the next one");
            used.restore(&state()).unwrap();
        }
    }
}

/// A plane above a bed that the outside moves, and the heading that follows.
const LID: &str = "[boundary.lid]\nplane = { point = [0.0, 0.0, 6.05e-3], normal = [0.0, 0.0, -1.0] }\nmaterial = \"g\"\n\
                   motion = { driven = [\"z\"] }\n[boundary.floor]";
