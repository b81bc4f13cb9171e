//! Forces that are told of single contacts are those that acted, with every scheme and from the first time step of a contact to its last.
//!
//! This holds through a face of a periodic cell and at surfaces that forces move, and for the weights of dashpots with `midway` and
//! `predicted`.

use crate::support::start;
use cograin::simulation::Simulation;

/// Schemes.
const SCHEMES: [&str; 4] = ["engine", "predicted_normal", "midway", "predicted"];

/// Time step \[s\].
const STEP: f64 = 2e-5;

/// Two spheres of 10 mm, one of them with its centre at this x \[m\], that come towards each other along x and turn; `more`: tables.
fn spheres(scheme: &str, [first, second]: [f64; 2], more: &str) -> String {
    format!(
        "[run]\nstep = {STEP:e}\nend = 1.0\nscheme = \"{scheme}\"\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\n\
         [pair.a.a]\nrestitution = 0.3\nfriction = 0.4\n[contact.c.normal.hertz]\n[contact.c.tangential.history]\n\
         [particles.p]\nmaterial = \"a\"\nlist = [\n\
         {{ position = [{first:?}, 0.05, 0.05], radius = 0.01, velocity = [0.3, 0.1, 0.05], angular_velocity = [5.0, 6.0, 7.0] }},\n\
         {{ position = [{second:?}, 0.052, 0.049], radius = 0.01, velocity = [-0.3, -0.1, -0.05], angular_velocity = [1.0, 2.0, 3.0] }}]\n\
         [output]\ncontacts = true\nframe_interval = 1.0\n{more}"
    )
}

/// Sum of the forces that contacts are told to have on the first particle, or on all \[N\].
fn told(simulation: &Simulation, all: bool) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for contact in simulation.contacts() {
        let sign = match (all, contact.first, contact.second) {
            (true, ..) | (_, 0, _) => 1.0,
            (_, _, Some(0)) => -1.0,
            _ => 0.0,
        };
        for axis in 0..3 {
            sum[axis] += sign * (contact.normal_force * contact.normal[axis] + contact.tangential_force[axis]);
        }
    }
    sum
}

/// Looks at told forces and those that acted, step by step as long as the bodies touch: they agree to rounding of the largest.
fn agree(what: &str, simulation: &mut Simulation, all: bool, acted: impl Fn(&Simulation) -> [f64; 3]) {
    let (mut apart, mut most, mut steps) = (0.0_f64, 0.0_f64, 0);
    for _ in 0..500 {
        simulation.advance(STEP).unwrap();
        let (told, acted) = (told(simulation, all), acted(simulation));
        steps += usize::from(told != [0.0; 3]);
        for axis in 0..3 {
            apart = apart.max((told[axis] - acted[axis]).abs());
            most = most.max(acted[axis].abs());
        }
    }
    assert!(steps > 20 && most > 0.1, "{what}: the bodies met, {steps} steps, {most} N");
    assert!(apart <= 1e-13 * most, "{what}: {apart:e} N apart, of {most} N");
}

/// The force on the first particle \[N\].
fn on_first(simulation: &Simulation) -> [f64; 3] {
    let particles = &simulation.state().particles;
    let [x, y, z, _] = particles.force[particles.slot[0] as usize];
    [x, y, z]
}

#[test]
fn of_two_grains_inside_and_through_a_face() {
    let cell = "[cell]\nedges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]\n";
    for scheme in SCHEMES {
        for (what, places, more) in [
            ("alone", [0.0395, 0.0605], ""),
            ("in a cell", [0.0395, 0.0605], cell),
            ("through a face", [-0.0105, 0.0105], cell),
        ] {
            agree(&format!("{scheme} {what}"), &mut start(&spheres(scheme, places, more)), false, on_first);
        }
    }
}

#[test]
fn at_surfaces_that_forces_move() {
    let shapes = [
        "plane = { point = [0.05, 0.05, 0.0385], normal = [0.0, 0.0, 1.0] }",
        "rectangle = { corner = [0.02, 0.02, 0.0385], edges = [[0.06, 0.0, 0.0], [0.0, 0.06, 0.0]] }",
    ];
    for scheme in SCHEMES {
        for shape in shapes {
            for mass in [0.1, 1e-3] {
                let plate = format!(
                    "[boundary.plate]\nmaterial = \"a\"\n{shape}\nmass = {mass:?}\nmotion = {{ free = [\"x\", \"y\", \"z\"] }}\n"
                );
                let text = spheres(scheme, [0.035, 0.065], &plate)
                    .replace("[0.3, 0.1, 0.05]", "[0.0, 0.1, -1.0]")
                    .replace("[-0.3, -0.1, -0.05]", "[0.0, -0.1, -1.0]");
                let mut simulation = start(&text);
                agree(&format!("{scheme} {shape} {mass} kg"), &mut simulation, true, |simulation| {
                    simulation.state().boundaries[0].force.map(|part| -part)
                });
            }
        }
    }
}
