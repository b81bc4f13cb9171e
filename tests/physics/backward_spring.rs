//! An impact that slides at first and sticks later, with a strong tangential dashpot.
//!
//! Where the dashpot alone exceeds the limit of friction, LAMMPS stretches the spring backwards, by an amount that depends on how
//! deep the first time step finds the contact. The test shows how much, and that the spring which is not stretched converges.

use crate::physics::stage::{HERTZ, hertz_duration, hit, material, properties, rigid, sphere};
use cograin::contact::tangential::turned_history;
use cograin::contact::{LawChoice, TangentialModel, tangential};

/// Largest error of the rebound with 100 time steps in a contact against 6,400, over the speed of impact; restitution 0.5, µ = 0.4.
fn error(backward_spring: bool) -> f64 {
    let keys = turned_history::Keys { backward_spring: Some(backward_spring), ..Default::default() };
    let law = LawChoice { tangential: TangentialModel::of::<tangential::turned_history::TurnedHistory>(keys), ..HERTZ };
    let (radius, speed, modulus) = (0.0025, 3.9, 70e9);
    let error = |angle: f64| {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let mut body = sphere(radius, 2500.0);
        body.velocity = [speed * sine, 0.0, -speed * cosine];
        let duration = hertz_duration(modulus / (1.0 - 0.0625), radius, body.mass(), speed * cosine);
        let rebound = |steps| {
            let materials = vec![material(modulus, 0.25), rigid()];
            let found = hit(law, materials, properties(0.5, 0.4), body, duration, steps);
            [found.velocity[0], found.velocity[2], radius * found.spin[1]]
        };
        let (coarse, fine) = (rebound(100), rebound(6400));
        (0..3).map(|part| (coarse[part] - fine[part]).powi(2)).sum::<f64>().sqrt() / speed
    };
    [20.0, 30.0, 40.0, 50.0].into_iter().map(error).fold(0.0, f64::max)
}

#[test]
fn a_spring_that_is_not_stretched_backwards_converges() {
    let [engine, at_rest] = [error(true), error(false)];
    assert!(engine > 0.03, "{engine:.2e}: the engine's spring is better than the docs say");
    assert!(at_rest < 0.01, "{at_rest:.2e}");
}
