//! The computed stable time step against the true one, with bonds and their dashpots, too. The true one is that of the whole time step,
//! linearised. The program itself shows it: at the stated step nothing grows, and at a ninth more something does.
//!
//! Each scene is at rest but for a motion that is small enough for springs and dashpots to be linear: what grows has left
//! the stable step behind, and what is stable stays bounded (velocity Verlet is linear there).

mod impacts;
mod laws;
mod linearised;
mod scenes;
mod threads;

use crate::support::checked;
use cograin::scene::{Scene, Step};
use cograin::simulation::Simulation;
use scenes::{
    Sphere, block, bonds, contacts, cubic, damped_hertz, damped_hooke, dashpots, face_centred, free, hertz, hexagonal,
    near_faces, packing,
};
use std::sync::Arc;

/// Least part of the true stable step that is to be stated.
const LEAST: f64 = 0.90;

/// Least part of it that is to be known where a given step is far below it.
const QUICK_LEAST: f64 = 0.5;

/// The scene with this time step, unstable or not.
fn with_step(scene: &Scene, step: f64) -> Simulation {
    let mut scene = scene.clone().into_draft();
    scene.run.step = Step::Given(step);
    scene.run.allow_unstable = true;
    Simulation::new(Arc::new(scene.build().expect("the scene is right"))).expect("it starts")
}

/// Whether the motion grows by more than ten thousand in energy at this step.
fn grows(scene: &Scene, step: f64, steps: u32) -> bool {
    let mut simulation = with_step(scene, step);
    let begun = simulation.kinetic_energy();
    for _ in 0..20 {
        if simulation.advance(f64::from(steps / 20) * step).is_err() || simulation.kinetic_energy() > 1e4 * begun {
            return true;
        }
    }
    false
}

/// The stated stable step \[s\].
fn stated(scene: &Scene) -> f64 {
    let mut free = scene.clone().into_draft();
    free.run.step = Step::Automatic { safety: 0.2 };
    Simulation::new(Arc::new(free.build().expect("the scene is right"))).expect("it starts").state().clock.stable
}

/// The stated stable step over the true one, by bisection on the engine, to one in two hundred.
fn ratio_on_the_engine(scene: &Scene, stated: f64) -> f64 {
    let (mut stable, mut unstable) = (0.95, 1.6);
    assert!(!grows(scene, stable * stated, 2000), "unstable at {stable} of the stated step {stated:e}");
    while unstable - stable > 0.005 {
        let middle = 0.5 * (stable + unstable);
        if grows(scene, middle * stated, 4000) { unstable = middle } else { stable = middle }
    }
    1.0 / stable
}

/// The stated step is within its range of that of the linearised time step.
#[allow(clippy::print_stdout, reason = "the figures of docs/stability.md are what this test prints with --nocapture")]
fn holds(name: &str, text: &str) -> f64 {
    let scene = checked(text);
    let stated = stated(&scene);
    let ratio = stated / linearised::stable_step(text, stated);
    let by_bodies = quick(&scene, stated) / stated * ratio;
    println!("{name}: stated over true {ratio:.3}, with a given step far below {by_bodies:.3}");
    assert!((QUICK_LEAST..=1.0).contains(&by_bodies), "{name}: {by_bodies:.3} of the true one with a given step");
    assert!((LEAST..=1.0).contains(&ratio), "{name}: the stated stable step is {ratio:.3} of the true one");
    ratio
}

/// What is known of the stable step where a given one is far below it: no more than is true \[s\].
fn quick(scene: &Scene, stated: f64) -> f64 {
    let mut given = scene.clone().into_draft();
    given.run.step = Step::Given(0.05 * stated);
    Simulation::new(Arc::new(given.build().expect("the scene is right"))).expect("it starts").state().clock.stable
}

/// The same, and the engine itself says the same.
fn holds_on_the_engine(name: &str, text: &str) {
    let linearised = holds(name, text);
    let scene = checked(text);
    let tried = ratio_on_the_engine(&scene, stated(&scene));
    // It is known to half a per cent, and what grows slowly is not seen within its time steps.
    assert!((tried / linearised - 1.0).abs() < 0.01, "{name}: {tried:.3} by trying, {linearised:.3} linearised");
}

#[test]
fn of_clamped_lattices_of_hertz_contacts() {
    let spacing = 1.998e-3;
    for (name, spheres) in [
        ("simple cubic", cubic(6, spacing)),
        ("face-centred", face_centred(3, spacing)),
        ("hexagonal", hexagonal(6, spacing)),
    ] {
        let held = near_faces(&spheres, 1.1e-3);
        holds_on_the_engine(name, &block(&spheres, held, &hertz()));
    }
}

#[test]
fn of_contact_dashpots() {
    let spheres = cubic(5, 1.998e-3);
    // k_n of neighbours is 1e5 N/m; m* of two spheres.
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    for ratio in [0.05, 0.3, 1.0] {
        let damping = 2.0 * ratio * (1e5 * 0.5 * mass).sqrt() / (0.5 * mass);
        let pair = format!(
            "normal_stiffness = 1e5\ntangential_stiffness = 8e4\nnormal_damping = {damping:?}\ntangential_damping = {damping:?}"
        );
        let held = near_faces(&spheres, 1.1e-3);
        let text = block(&spheres, held, &contacts("hooke_stiffness", &pair));
        holds_on_the_engine(&format!("contact dashpots, ratio {ratio}"), &text);
    }
}

#[test]
fn of_predicted_contact_dashpots() {
    let spheres = cubic(5, 1.998e-3);
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    for ratio in [0.05, 0.3] {
        let damping = 2.0 * ratio * (1e5 * 0.5 * mass).sqrt() / (0.5 * mass);
        let pair = format!(
            "normal_stiffness = 1e5\ntangential_stiffness = 8e4\nnormal_damping = {damping:?}\ntangential_damping = {damping:?}"
        );
        let text = block(&spheres, near_faces(&spheres, 1.1e-3), &contacts("hooke_stiffness", &pair));
        let text = text.replace("threads = 1\n", "threads = 1\nscheme = \"predicted\"\n");
        let scene = checked(&text);
        let tried = ratio_on_the_engine(&scene, stated(&scene));
        assert!((0.88..=1.005).contains(&tried), "predicted contact dashpots, ratio {ratio}: {tried:.3}");
    }
}

#[test]
fn of_bonded_blocks() {
    holds_on_the_engine("bonded simple cubic", &block(&cubic(4, 2e-3), free, &bonds("")));
    holds_on_the_engine("bonded face-centred", &block(&face_centred(2, 2e-3), free, &bonds("")));
    let chain: Vec<Sphere> = (0..12).map(|i| [2e-3 * f64::from(i), 0.0, 0.0, 1e-3]).collect();
    holds_on_the_engine("chain", &block(&chain, free, &bonds("")));
}

#[test]
fn of_bond_dashpots() {
    for ratio in [0.3, 1.0, 5.0] {
        holds_on_the_engine(
            &format!("pair, ratio {ratio}"),
            &block(&cubic(2, 2e-3)[..2], free, &bonds(&dashpots(ratio))),
        );
        holds_on_the_engine(&format!("block, ratio {ratio}"), &block(&cubic(3, 2e-3), free, &bonds(&dashpots(ratio))));
    }
}

#[test]
fn of_predicted_bond_dashpots() {
    for ratio in [0.3, 1.0, 3.0] {
        for spheres in [cubic(2, 2e-3)[..2].to_vec(), cubic(3, 2e-3)] {
            let text = block(&spheres, free, &bonds(&dashpots(ratio)));
            let scene = checked(&text.replace("threads = 1\n", "threads = 1\nscheme = \"predicted\"\n"));
            let tried = ratio_on_the_engine(&scene, stated(&scene));
            let what = format!("predicted bond dashpots, {} spheres, ratio {ratio}", spheres.len());
            assert!((0.88..=1.005).contains(&tried), "{what}: {tried:.3}");
        }
    }
}

#[test]
fn of_bonds_and_contacts_together() {
    let spheres = cubic(6, 1.998e-3);
    let soft = bonds("").replace("1e12", "1e10").replace("4e11", "4e9");
    holds_on_the_engine(
        "bond and contact",
        &block(&spheres, near_faces(&spheres, 1.1e-3), &format!("{}{soft}", hertz())),
    );
    let wall = "[boundary.floor]\nplane = { point = [0.0, 0.0, -1e-3], normal = [0.0, 0.0, 1.0] }\nmaterial = \"a\"\n\
                [bond.w]\nformulation = \"finite_rotation\"\nbetween = [\"core\", \"floor\"]\ncreate_distance = 2.2e-3\n\
                normal_stiffness = 3e12\ntangential_stiffness = 1e12\n";
    holds_on_the_engine("wall bonds", &block(&cubic(3, 2e-3), free, &format!("{}{wall}", bonds(""))));
}

#[test]
fn of_a_random_packing() {
    holds("random 1:1", &block(&packing(60, 1.0), free, &hertz()));
}

/// Random packings of so many spheres with contact dashpots of this ratio.
fn of_damped_packings(count: usize, ratio: f64) {
    for sizes in [1.0, 3.0, 10.0] {
        for (law, contacts) in [("Hertz", damped_hertz(ratio)), ("Hooke", damped_hooke(ratio))] {
            for scheme in ["engine", "predicted_normal", "predicted"] {
                let text = block(&packing(count, sizes), free, &contacts);
                let text = text.replace("threads = 1\n", &format!("threads = 1\nscheme = {scheme:?}\n"));
                holds(&format!("random 1:{sizes} of {count}, {law}, ratio {ratio}, {scheme}"), &text);
            }
        }
    }
}

#[test]
fn of_slightly_damped_random_packings() {
    of_damped_packings(60, 0.05);
}

#[test]
fn of_damped_random_packings() {
    of_damped_packings(60, 0.3);
}

#[test]
fn of_strongly_damped_random_packings() {
    of_damped_packings(60, 1.0);
}

#[test]
fn of_a_larger_damped_random_packing() {
    holds("random 1:1 of 150, Hertz, ratio 0.3", &block(&packing(150, 1.0), free, &damped_hertz(0.3)));
}

#[test]
fn of_random_packings_of_two_laws() {
    for sizes in [3.0, 10.0] {
        holds(&format!("random 1:{sizes}"), &block(&packing(60, sizes), free, &hertz()));
    }
    let hooke = "normal_stiffness = 1e5\ntangential_stiffness = 8e4\nnormal_damping = 0.0\ntangential_damping = 0.0";
    let hooke = contacts("hooke_stiffness", hooke);
    holds("random 1:1, Hooke", &block(&packing(60, 1.0), free, &hooke));
}

#[test]
fn of_a_sphere_on_a_plane() {
    let weight = 9.81 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    // Hertz: F = 4/3 E* √R δ^3/2 with E* of two equal materials; a spring: F = k δ.
    let modulus = 1e9 / (2.0 * (1.0 - 0.25 * 0.25));
    let sunk = (weight / (4.0 / 3.0 * modulus * 1e-3_f64.sqrt())).powf(2.0 / 3.0);
    let hooke = "normal_stiffness = 1e5\ntangential_stiffness = 3e4\nnormal_damping = 0.0\ntangential_damping = 0.0";
    let hooke = contacts("hooke_stiffness", hooke);
    for (name, law, sunk) in [("Hertz", hertz(), sunk), ("Hooke", hooke, weight / 1e5)] {
        let floor = format!(
            "[boundary.floor]\nplane = {{ point = [0.0, 0.0, {:?}], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"a\"\n",
            sunk - 1e-3
        );
        let sphere = block(&[[0.0, 0.0, 0.0, 1e-3]], free, &format!("{law}{floor}"));
        holds_on_the_engine(&format!("sphere on a plane, {name}"), &format!("gravity = [0.0, 0.0, -9.81]\n{sphere}"));
    }
}
