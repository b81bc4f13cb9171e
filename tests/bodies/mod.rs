//! Bodies that forces move, from far lighter to far heavier than what they touch: impacts, springs, dashpots, and the time step that
//! follows them.

mod clumps;
mod free_groups;
mod loaded;

use crate::support::start;
use cograin::simulation::{LimiterKind, Simulation};
use std::f64::consts::PI;

/// The body: boundaries stand in the order of the text.
const BODY: usize = 0;

/// Mass of a sphere of radius 5 mm \[kg\].
fn sphere() -> f64 {
    4.0 / 3.0 * PI * 5e-3_f64.powi(3) * 2500.0
}

/// A sphere that flies upwards at 1 m/s, a hundredth of its radius below a body, with this restitution.
fn flying(run: &str, restitution: f64, normal: &str, body: &str) -> String {
    format!(
        r#"
[run]
{run}
threads = 1
[material.a]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = {restitution:?}
normal_stiffness = 1.0e5
normal_damping = 0.0
[contact.touch.normal.{normal}]
[particles.one]
material = "a"
list = [{{ position = [0.0, 0.0, -5.05e-3], radius = 5e-3, velocity = [0.0, 0.0, 1.0] }}]
[boundary.a_body]
material = "a"
{body}
[output]
energy = true
losses = true
"#
    )
}

/// A plane or a disc that moves along z, this many times as heavy as the sphere.
fn plate(shape: &str, ratio: f64) -> String {
    let mass = ratio * sphere();
    let shape = match shape {
        "plane" => "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, -1.0] }",
        _ => "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, -1.0], radius = 0.02 }",
    };
    format!("{shape}\nmass = {mass:?}\nmotion = {{ free = [\"z\"] }}")
}

/// Velocities along z of the sphere and of the body after an impact \[m/s\].
fn after(simulation: &mut Simulation) -> [f64; 2] {
    for _ in 0..200 {
        simulation.advance(5e-5).unwrap_or_else(|error| panic!("{error}"));
        let [ball, body] = velocities(simulation);
        if simulation.state().boundaries[BODY].force[2] == 0.0 && ball < body {
            return [ball, body];
        }
    }
    panic!("they do not part: {:?}", velocities(simulation));
}

/// Velocities along z of the sphere and of the body \[m/s\].
fn velocities(simulation: &Simulation) -> [f64; 2] {
    [simulation.state().particles.velocity[0][2], simulation.state().boundaries[BODY].velocity[2]]
}

/// Ratios of mass from far heavier to far lighter than the sphere.
const RATIOS: [f64; 8] = [1e3, 10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-6];

#[test]
fn an_elastic_impact_keeps_energy_and_momentum_at_any_ratio_of_masses() {
    for (ratio, shape) in RATIOS.into_iter().flat_map(|ratio| [(ratio, "plane"), (ratio, "disc")]) {
        let mut simulation = start(&flying("step = \"auto\"", 1.0, "hertz", &plate(shape, ratio)));
        let [ball, body] = after(&mut simulation);
        // Of the sphere's ½ m v² and m v, with masses in spheres.
        let energy = ball * ball + ratio * body * body;
        assert!((energy - 1.0).abs() < 0.006, "{shape} of {ratio}: {energy} of the energy");
        let momentum = ball + ratio * body;
        assert!((momentum - 1.0).abs() < 1e-12, "{shape} of {ratio}: {momentum} of the momentum");
        // Of what the spring holds where they are nearest.
        let held = ratio / (1.0 + ratio);
        // A hundredth of the velocity at which they part, as `accuracy` says.
        assert!((energy - 1.0).abs() < 0.02 * held, "{shape} of {ratio}: {energy} with {held} held");
        let expected = 2.0 / (1.0 + ratio);
        assert!((body / expected - 1.0).abs() < 0.01, "{shape} of {ratio}: {body} m/s, not {expected} m/s");
        let residual = simulation.energy_residual().expect("a book");
        assert!(residual.abs() < 1e-11 * sphere(), "{shape} of {ratio}: {residual:e} J");
    }
}

#[test]
fn an_impact_with_a_body_of_any_mass_has_its_restitution() {
    for (ratio, restitution) in RATIOS.into_iter().flat_map(|ratio| [(ratio, 0.9), (ratio, 0.5)]) {
        let mut simulation = start(&flying("step = \"auto\"", restitution, "hertz", &plate("disc", ratio)));
        let [ball, body] = after(&mut simulation);
        let found = body - ball;
        assert!((found - restitution).abs() < 0.01, "{found}, not {restitution}, at {ratio}");
    }
}

#[test]
fn an_impact_on_a_flap_turns_it_as_theory_says() {
    // The hinge is the axis y; the sphere meets it at an arm of 12 mm, where it acts like a mass of I/a².
    for ratio in [10.0, 1.0, 1e-2, 1e-4] {
        let arm = 0.012;
        let inertia = ratio * sphere() * arm * arm;
        let flap = format!(
            "rectangle = {{ corner = [-0.012, -0.02, 0.0], edges = [[0.0, 0.04, 0.0], [0.04, 0.0, 0.0]] }}\n\
             reference = [-0.012, 0.0, 0.0]\n\
             inertia = [{inertia:?}, {inertia:?}, {inertia:?}]\nmotion = {{ free = [\"rotation.y\"] }}"
        );
        let mut simulation = start(&flying("step = \"auto\"", 1.0, "hertz", &flap));
        let (mut ball, mut spin) = (1.0, 0.0);
        for _ in 0..200 {
            simulation.advance(2e-5).unwrap_or_else(|error| panic!("{error}"));
            let state = simulation.state();
            (ball, spin) = (state.particles.velocity[0][2], state.boundaries[BODY].angular_velocity[1]);
            if state.boundaries[BODY].force == [0.0; 3] && spin != 0.0 {
                break;
            }
        }
        // It turns about −y: the end with the sphere goes up.
        let (tip, expected) = (-spin * arm, 2.0 / (1.0 + ratio));
        assert!((tip / expected - 1.0).abs() < 0.02, "{tip} m/s, not {expected} m/s, at {ratio}");
        let energy = simulation.kinetic_energy() / (0.5 * sphere());
        assert!((energy - 1.0).abs() < 0.006, "{energy} of the energy at {ratio}, sphere {ball} m/s");
    }
}

/// A plane on springs, which nothing touches.
fn sprung(run: &str, more: &str) -> String {
    flying(run, 1.0, "hertz", "").replace("-5.05e-3]", "-1.0]").replace("[contact.touch.normal.hertz]\n", "").replace(
        "material = \"a\"\n\n[output]",
        &format!(
            "material = \"a\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, -1.0] }}\n{more}\n[output]"
        ),
    )
}

#[test]
fn a_body_on_a_spring_swings_with_its_frequency_at_the_automatic_step() {
    for (mass, stiffness) in [(1e-4_f64, 1e5), (1e-2, 1e7), (1e-7, 1e2)] {
        let text = sprung(
            "step = \"auto\"",
            &format!("mass = {mass:?}\nstiffness = {{ z = {stiffness:?} }}\nmotion = {{ loaded = {{ z = 1e-3 }} }}"),
        );
        let mut simulation = start(&text);
        let limit = simulation.limit();
        let theory = 2.0 * (mass / stiffness).sqrt();
        assert!((0.9..=1.0).contains(&(limit.safe / theory)), "{:e} s, not {theory:e} s", limit.safe);
        assert_eq!(limit.by.expect("something limits it").kind, LimiterKind::Support);
        let period = 2.0 * PI * (mass / stiffness).sqrt();
        // After ten and a quarter periods u = F/k (1 − cos ωt) passes F/k; its rate there tells the phase.
        simulation.advance(10.25 * period).expect("it runs");
        let moved = &simulation.state().boundaries[BODY];
        let (scale, rate) = (1e-3 / stiffness, (stiffness / mass).sqrt());
        let phase = (moved.velocity[2] / (scale * rate)).atan2(1.0 - moved.displacement[2] / scale);
        let off = (phase - 0.5 * PI) / (2.0 * PI * 10.25);
        assert!(off.abs() < 0.01, "the frequency is off by {off}");
    }
}

#[test]
fn a_group_on_a_spring_is_followed_too() {
    let text = "[run]\nstep = \"auto\"\n[material.a]\ndensity = 2500.0\n\
                [particles.one]\nmaterial = \"a\"\nlist = [{ position = [0.0, 0.0, 0.0], radius = 5e-3 }]\n\
                [boundary.a_body]\nparticles = { set = \"one\" }\nstiffness = { z = 1e5 }\nmotion = { loaded = { z = 1.0 } }\n";
    let simulation = start(text);
    let (found, theory) = (simulation.limit().safe, 2.0 * (sphere() / 1e5).sqrt());
    assert!((0.9..=1.0).contains(&(found / theory)), "{found:e} s, not {theory:e} s");
}

#[test]
fn the_stable_step_holds_a_light_body_between_spring_and_sphere() {
    // Linear springs: 4 M − Δt² K with the pressed sphere and the body on its spring is positive definite up to the theory's step.
    for ratio in [1.0, 0.1, 1e-3, 1e-6] {
        let body = plate("plane", ratio) + "\nstiffness = { z = 3.0e4 }";
        let text = flying("step = \"auto\"", 1.0, "hooke_stiffness", &body).replace("-5.05e-3]", "-4.9e-3]");
        let simulation = start(&text.replace("velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, 0.0]"));
        let (k, s, m, b) = (1.0e5, 3.0e4, sphere(), ratio * sphere());
        // Roots of the two by two system.
        let (trace, product) = (k / m + (k + s) / b, k * s / (m * b));
        let theory = 2.0 / (0.5 * (trace + (trace * trace - 4.0 * product).sqrt())).sqrt();
        let found = simulation.limit().safe;
        assert!((0.75..=1.0).contains(&(found / theory)), "{} of the theory at {ratio}", found / theory);
    }
}

#[test]
fn an_impact_to_come_on_a_light_body_is_as_stiff_as_its_contact() {
    let hooke = "hooke]\ncharacteristic_velocity = 1.0\n#";
    for ratio in [10.0, 1.0, 1e-2, 1e-6] {
        for shape in ["plane", "disc"] {
            let text = flying("", 1.0, hooke, &plate(shape, ratio));
            let touching = start(&text.replace("-5.05e-3]", "-4.9999e-3]")).limit().safe;
            let coming = start(&text).limit().safe;
            assert!((0.75..=1.06).contains(&(coming / touching)), "{shape}, {ratio}: {coming:e}, then {touching:e} s");
        }
    }
}

#[test]
fn light_bodies_among_spheres_take_no_energy_from_nothing() {
    // A sphere strikes a column of discs and spheres. The second disc is thrown to and fro, or pressed from both sides.
    let disc = |name: &str, height: f64, ratio: f64| {
        format!(
            "[boundary.{name}]\nmaterial = \"a\"\ndisc = {{ centre = [0.0, 0.0, {height:?}], normal = [0.0, 0.0, 1.0], radius = 0.02 }}\n\
             mass = {:?}\nmotion = {{ free = [\"z\"] }}\n",
            ratio * sphere()
        )
    };
    let bodies = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n".to_owned()
        + &disc("first", 0.01, 1e-2)
        + &disc("second", 0.02, 1e-6)
        + &disc("third", 0.03, 1.0);
    let sphere_at = |height: f64, speed: f64| {
        format!("{{ position = [0.0, 0.0, {height:?}], radius = 5e-3, velocity = [0.0, 0.0, {speed:?}] }}")
    };
    let list = [sphere_at(5e-3, 0.5), sphere_at(15e-3, 0.0), sphere_at(25e-3, 0.0)].join(", ");
    let one = "{ position = [0.0, 0.0, -5.05e-3], radius = 5e-3, velocity = [0.0, 0.0, 1.0] }";
    for restitution in [1.0, 0.95] {
        let text = flying("", restitution, "hooke]\ncharacteristic_velocity = 1.0\n#", &bodies).replace(one, &list);
        let mut simulation = start(&text);
        let energy = 0.5 * sphere() * 0.25;
        for _ in 0..20 {
            simulation.advance(5e-4).unwrap_or_else(|error| panic!("e = {restitution}: {error}"));
            let residual = simulation.physical_residual().expect("a book") / energy;
            assert!(residual.abs() < 0.05, "e = {restitution}: {residual} of the energy at {:e} s", simulation.time());
        }
    }
}

#[test]
fn a_dashpot_to_the_ground_takes_energy_whatever_the_step_and_is_of_second_order() {
    let speed = |damping: f64, step: f64| {
        let more = format!("mass = 1e-3\ndamping = {{ z = {damping:?} }}\nmotion = {{ loaded = {{ z = 1.0 }} }}");
        let mut simulation = start(&sprung(&format!("step = {step:?}"), &more));
        simulation.advance(16e-4).expect("it runs");
        let residual = simulation.energy_residual().expect("a book");
        assert!(residual.abs() < 1e-12, "{residual:e} J");
        simulation.state().boundaries[BODY].velocity[2]
    };
    // v = F/C (1 − exp(−C t/M)); a step is a tenth and a twentieth of M/C.
    let exact = (1.0 - (-16e-4_f64 / 1e-3).exp()) / 1.0;
    let [coarse, fine] = [1e-4, 5e-5].map(|step| (speed(1.0, step) / exact - 1.0).abs());
    assert!(coarse < 1e-3 && (3.5..4.5).contains(&(coarse / fine)), "{coarse:e} and {fine:e}");
    // Far above M/Δt: never faster than twice what the load would keep.
    for damping in [1e2, 1e4, 1e8] {
        let found = speed(damping, 1e-4) * damping;
        assert!((0.0..=2.0).contains(&found), "{found} of the final speed");
    }
}

#[test]
fn a_light_plate_that_is_pressed_comes_to_rest_on_its_bed() {
    let places = [-0.011, 0.0, 0.011];
    let bed: Vec<String> = (places.iter().flat_map(|x| places.iter().map(move |y| (x, y))))
        .flat_map(|(x, y)| [0.0055, 0.016].map(|z| format!("{{ position = [{x:?}, {y:?}, {z:?}], radius = 5e-3 }}")))
        .collect();
    let wall = |name: &str, point: [f64; 3], normal: [f64; 3]| {
        format!("[boundary.{name}]\nmaterial = \"a\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n")
    };
    let walls = [
        wall("floor", [0.0; 3], [0.0, 0.0, 1.0]),
        wall("x_low", [-0.0165, 0.0, 0.0], [1.0, 0.0, 0.0]),
        wall("x_high", [0.0165, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        wall("y_low", [0.0, -0.0165, 0.0], [0.0, 1.0, 0.0]),
        wall("y_high", [0.0, 0.0165, 0.0], [0.0, -1.0, 0.0]),
    ];
    let text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = \"auto\"\nthreads = 1\n\
         [material.a]\nyoungs_modulus = 5e7\npoissons_ratio = 0.3\ndensity = 2500.0\n\
         [pair.a.a]\nrestitution = 0.5\nfriction = 0.3\n[contact.c.normal.hertz]\n[contact.c.tangential.history]\n\
         [particles.bed]\nmaterial = \"a\"\nlist = [{}]\n\
         [boundary.a_plate]\nmaterial = \"a\"\ndisc = {{ centre = [0.0, 0.0, 0.024], normal = [0.0, 0.0, -1.0], radius = 0.03 }}\n\
         mass = 1e-5\nmotion = {{ loaded = {{ z = -2.0 }} }}\n{}[output]\nenergy = true\n",
        bed.join(", "),
        walls.concat()
    );
    let mut simulation = start(&text);
    simulation.advance(0.02).unwrap_or_else(|error| panic!("{error}"));
    let moved = &simulation.state().boundaries[BODY];
    // Gaps of 3, 0.5 and 0.5 mm, and what three contacts a column give way under 2/9 N.
    let modulus = 5e7 / (2.0 * (1.0 - 0.3 * 0.3));
    let overlap = |radius: f64| (0.75 * 2.0 / 9.0 / (modulus * radius.sqrt())).powf(2.0 / 3.0);
    let expected = -4.0e-3 - 2.0 * overlap(5e-3) - overlap(2.5e-3);
    let found = moved.displacement[2];
    assert!((found - expected).abs() < 3e-5, "{found} m, not {expected} m");
    let residual = simulation.energy_residual().expect("a book");
    assert!(residual.abs() < 1e-12, "{residual:e} J");
}

#[test]
fn a_scene_with_bodies_and_a_servo_is_the_same_at_scales_by_powers_of_two() {
    // Lengths and times by 2^k, masses by 2^3k: densities, moduli and velocities stay.
    let run = |k: i32| {
        let by = |power: i32| 2.0_f64.powi(power * k);
        let (l, m) = (by(1), by(3));
        let text = format!(
            "gravity = [0.0, 0.0, {g:?}]\n[run]\nstep = \"auto\"\nthreads = 1\n\
             [material.a]\nyoungs_modulus = 5e7\npoissons_ratio = 0.3\ndensity = 2500.0\n\
             [pair.a.a]\nrestitution = 0.5\nfriction = 0.3\n[contact.c.normal.hertz]\n[contact.c.tangential.history]\n\
             [particles.two]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, {z:?}], radius = {r:?} }}, {{ position = [{x:?}, 0.0, {z:?}], radius = {r:?} }}]\n\
             [boundary.a_plate]\nmaterial = \"a\"\ndisc = {{ centre = [0.0, 0.0, {h:?}], normal = [0.0, 0.0, -1.0], radius = {d:?} }}\n\
             mass = {mass:?}\ninertia = [{i:?}, {i:?}, {i:?}]\nstiffness = {{ x = {s:?} }}\ndamping = {{ z = {c:?} }}\n\
             motion = {{ loaded = {{ z = {f:?} }}, free = [\"x\", \"y\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }}\n\
             [boundary.b_side]\nmaterial = \"a\"\nplane = {{ point = [{w:?}, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}\n\
             motion = {{ servo = {{ x = {{ target = {t:?}, speed = 0.1 }} }} }}\n\
             [boundary.floor]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n",
            g = -9.765625 * by(-1),
            z = 0.00625 * l,
            r = 0.00625 * l,
            x = 0.0125 * l,
            h = 0.0126953125 * l,
            d = 0.03125 * l,
            mass = 1.52587890625e-5 * m,
            i = 1e-9 * m * l * l,
            s = 50.0 * by(1),
            c = 0.0078125 * by(2),
            f = -0.5 * by(2),
            w = -0.0064 * l,
            t = -0.03125 * by(2)
        );
        let mut simulation = start(&text);
        for _ in 0..8 {
            simulation.advance(0.5e-3 * l).unwrap_or_else(|error| panic!("2^{k}: {error}"));
        }
        let [plate, side] = [0, 1].map(|index: usize| simulation.state().boundaries[index]);
        let places = [plate.displacement, side.displacement].concat().into_iter().map(|it| it / l);
        let forces = [plate.force, side.force].concat().into_iter().map(|it| it / by(2));
        let numbers: Vec<f64> = places.chain(forces).chain(plate.velocity).chain(plate.rotation).collect();
        (simulation.state().clock.steps, numbers)
    };
    let plain = run(0);
    assert!(plain.1.iter().filter(|number| **number != 0.0).count() > 8, "{plain:?}");
    for k in [-30, -20, 3] {
        assert_eq!(run(k), plain, "2^{k}");
    }
}

#[test]
fn the_step_follows_the_root_of_the_mass_of_a_light_body() {
    let stable = |ratio: f64| {
        let text =
            flying("step = \"auto\"", 0.5, "hooke_stiffness", &plate("plane", ratio)).replace("-5.05e-3]", "-4.99e-3]");
        start(&text.replace("velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, 0.0]")).state().clock.stable
    };
    let ratio = stable(1e-2) / stable(1e-6);
    // √(1/(1/m + 1/M)) for both.
    let expected = ((1.0 + 1e6) / (1.0 + 1e2_f64)).sqrt();
    assert!((ratio / expected - 1.0).abs() < 0.1, "{ratio}, not {expected}");
}
