//! What touches at the start and is pressed on by a load from then on begins with a time step for the contact that the load makes.

use crate::support::start;

/// A law by its lines.
const LAWS: [&str; 3] = [
    "[contact.c.normal.hertz]\n[contact.c.tangential.history]\n",
    "[contact.c.normal.hooke]\ncharacteristic_velocity = 0.1\n",
    "cohesion_energy_density = 1e3\n[contact.c.normal.hertz]\n[contact.c.cohesion.sjkr]\n",
];

/// A scene of spheres of 5 mm, with what is said at its head and its end.
fn scene(head: &str, law: &str, rest: &str) -> String {
    format!(
        "{head}\n[run]\nthreads = 1\nend = 0.5\n[material.g]\ndensity = 2500\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n\
         [pair.g.g]\nrestitution = 0.9\nfriction = 0.3\n{law}{rest}"
    )
}

/// Spheres at these heights over a floor \[m\].
fn column(heights: &[f64]) -> String {
    let spheres: Vec<String> =
        heights.iter().map(|z| format!("{{ position = [0.0, 0.0, {z:?}], radius = 5e-3 }}")).collect();
    format!(
        "[particles.p]\nmaterial = \"g\"\nlist = [{}]\n[boundary.f]\n\
         plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"g\"\n",
        spheres.join(",\n")
    )
}

/// The largest part of the smallest radius by which any sphere rises above where it began in so many communication steps \[m\].
fn rise(text: &str, count: u32) -> f64 {
    let mut simulation = start(text);
    let heights = |simulation: &cograin::simulation::Simulation| -> Vec<f64> {
        let particles = &simulation.state().particles;
        particles.slot.iter().map(|&slot| particles.position[slot as usize][2]).collect()
    };
    let begun = heights(&simulation);
    let mut most = f64::NEG_INFINITY;
    for _ in 0..count {
        simulation.advance(1e-3).expect("it runs");
        let now = heights(&simulation);
        most = now.iter().zip(&begun).fold(most, |most, (now, then)| most.max((now - then) / 5e-3));
    }
    most
}

#[test]
fn spheres_that_touch_at_rest_stay_where_they_are_under_gravity() {
    for law in LAWS {
        for heights in [&[5e-3][..], &[5e-3 + 5e-15], &[5e-3, 15e-3, 25e-3], &[5e-3, 15e-3 + 1e-14]] {
            let found = rise(&scene("gravity = [0.0, 0.0, -9.81]", law, &column(heights)), 100);
            assert!(found < 1e-3, "{law}, {heights:?}: a sphere rises by {found} of its radius");
        }
    }
}

#[test]
fn an_applied_force_a_loaded_lid_and_a_group_that_touch_at_rest_throw_nothing_up() {
    let force = "[force.down]\nparticles = { sets = [\"p\"] }\nforce = [0.0, 0.0, -10.0]\n";
    let lid = "[boundary.lid]\nplane = { point = [0.0, 0.0, 10e-3], normal = [0.0, 0.0, -1.0] }\nmaterial = \"g\"\n\
               mass = 1.0\nmotion = { free = [\"z\"] }\n";
    for (head, rest) in [("", force), ("gravity = [0.0, 0.0, -9.81]", lid)] {
        let found = rise(&scene(head, LAWS[0], &format!("{}{rest}", column(&[5e-3]))), 100);
        assert!(found < 2e-3, "{rest}: a sphere rises by {found} of its radius");
    }
}

#[test]
fn the_first_time_step_is_about_as_long_as_those_that_follow() {
    let mut simulation = start(&scene("gravity = [0.0, 0.0, -9.81]", LAWS[0], &column(&[5e-3])));
    let first = simulation.state().clock.step;
    simulation.advance(0.4).expect("it runs");
    let last = simulation.state().clock.step;
    assert!(first < 1.3 * last && first > 0.5 * last, "{first} s, later {last} s");
}

#[test]
fn cohesive_spheres_discs_clumps_and_a_servo_that_touch_at_rest_throw_nothing_up() {
    let jkr = "surface_energy = 0.02\ndamping_coefficient = 100.0\n[contact.c.normal.jkr]\n";
    let floor = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }";
    let plate = "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.1 }";
    let (spheres, press) = (column(&[5e-3, 15e-3]), "motion = { servo = { z = { target = 5.0, speed = 0.02 } } }");
    let lid = format!(
        "[boundary.lid]\nplane = {{ point = [0.0, 0.0, 20e-3], normal = [0.0, 0.0, -1.0] }}\nmaterial = \"g\"\n{press}\n"
    );
    let clumps = format!(
        "[clump.c]\nmaterial = \"g\"\nspheres = [{{ position = [-4e-3, 0.0, 0.0], radius = 5e-3 }}, {{ position = [4e-3, 0.0, 0.0], \
         radius = 5e-3 }}]\n[particles.p]\nclump = \"c\"\nlist = [{{ position = [0.0, 0.0, 5e-3] }}, {{ position = [0.0, 0.0, 15e-3] }}]\n\
         [boundary.f]\n{floor}\nmaterial = \"g\"\n"
    );
    let flat = scene("gravity = [0.0, 0.0, -9.81]", LAWS[0], &spheres)
        .replace("[run]\n", "[run]\nplane = \"xz\"\nplane_particles = \"discs\"\n");
    let scenes = [
        scene("gravity = [0.0, 0.0, -9.81]", jkr, &spheres),
        scene("gravity = [0.0, 0.0, -9.81]", LAWS[0], &spheres.replace(floor, plate)),
        scene("gravity = [0.0, 0.0, -9.81]", LAWS[0], &clumps),
        scene("", LAWS[0], &format!("{spheres}{lid}")),
        flat,
    ];
    for text in scenes {
        let found = rise(&text, 100);
        assert!(found < 2e-3, "{text}: a sphere rises by {found} of its radius");
    }
}
