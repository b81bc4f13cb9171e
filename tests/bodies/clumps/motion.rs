//! Flight and impacts of one clump, against closed forms.

use super::scenes::{TOP, apart, falling_pair, of_spheres, three, tumbling};
use crate::support::start;
use cograin::simulation::Simulation;

#[test]
fn a_clump_that_nothing_touches_keeps_energy_and_angular_momentum_over_a_million_steps() {
    let mut simulation = start(&format!(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 1000.0
{TOP}
[particles.p]
material = "a"
clump = "top"
list = [{{ position = [0.0, 0.0, 0.0], angular_velocity = [3.0, -8.0, 14.0], orientation = [0.4, 0.1, -0.7, 0.3] }}]
"#
    ));
    let (energy, angular) = of_spheres(&simulation);
    let told = simulation.kinetic_energy();
    assert!((told / energy - 1.0).abs() < 1e-14, "{told} J, {energy} J by its spheres");
    let size = angular.iter().map(|part| part * part).sum::<f64>().sqrt();
    for _ in 0..10 {
        simulation.advance(100.0).expect("it runs");
        let (now, turned) = of_spheres(&simulation);
        assert!((now / energy - 1.0).abs() < 1e-12, "{now:e} J, {energy:e} J expected");
        assert!(apart(turned, angular) < 1e-12 * size, "{turned:?}, {angular:?} expected");
    }
    assert_eq!(simulation.state().clock.steps, 1_000_000);
}

#[test]
fn two_spheres_on_a_plate_get_impulse_and_spin_as_in_closed_form() {
    for angle in [0.3, 0.8, 1.2, -0.8] {
        let speed = 1e-3;
        let mut simulation = falling_pair(angle, speed);
        // Long enough for the impact, not for the other sphere to come down.
        simulation.advance(6.0e-4).expect("it runs");
        assert_eq!(simulation.contact_count(), 0);
        // The plate pushes the lower sphere at the lever h: P (1/M + h²/J) = (1 + e) v.
        let lever = 0.01 * angle.cos() * angle.signum();
        let (over_mass, square) = (1.0 / 2.0, 1e-4);
        let over_inertia = 1.0 / (2.0 * (0.4 + 1.0) * square);
        let impulse = 2.0 * speed / (over_mass + lever * lever * over_inertia);
        let clumps = &simulation.state().clumps;
        let (velocity, spin) = (clumps.velocity[0][2], clumps.angular_velocity[0]);
        let expected = (impulse * over_mass - speed, -lever * impulse * over_inertia);
        // It turns by 1e-5 rad and presses itself in by 1e-4 of the radius while it touches.
        assert!((velocity - expected.0).abs() < 3e-4 * speed, "{angle}: {velocity} m/s, {} expected", expected.0);
        assert!((spin[1] - expected.1).abs() < 3e-4 * expected.1.abs(), "{angle}: {spin:?}, {} expected", expected.1);
        assert!(spin[0].abs() + spin[2].abs() < 1e-12 * spin[1].abs(), "{spin:?}");
    }
}

#[test]
fn a_flat_pair_comes_back_with_the_restitution_of_its_law() {
    let text = |restitution: f64| {
        format!(
            r#"
[run]
step = 1.0e-7
[material.a]
density = 2000.0
youngs_modulus = 1.0e9
poissons_ratio = 0.3
[pair.a.a]
restitution = {restitution:?}
[contact.touch.normal.hertz]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]
[particles.p]
material = "a"
clump = "pair"
list = [{{ position = [0.0, 0.0, 0.0200001], velocity = [0.0, 0.0, -0.01] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#
        )
    };
    for restitution in [1.0, 0.7, 0.4] {
        let mut simulation = start(&text(restitution));
        simulation.advance(4e-3).expect("it runs");
        let found = simulation.state().clumps.velocity[0][2] / 0.01;
        // The dashpot sees the mass of the clump.
        assert!((found - restitution).abs() < 2e-3, "{found}, {restitution} expected");
    }
}

#[test]
fn a_clump_moves_as_a_free_group_of_its_spheres() {
    let (mut clump, mut group) = (tumbling(true), tumbling(false));
    for _ in 0..4 {
        clump.advance(0.05).expect("it runs");
        group.advance(0.05).expect("it runs");
        for index in 0..4 {
            let place = |simulation: &Simulation| {
                let particles = &simulation.state().particles;
                let slot = particles.slot[index] as usize;
                (three(particles.position[slot]), three(particles.angular_velocity[slot]))
            };
            let ((a, u), (b, v)) = (place(&clump), place(&group));
            // Impacts make roundings larger.
            assert!(apart(a, b) < 1e-9 && apart(u, v) < 1e-7, "sphere {index}: {a:?} {u:?}, {b:?} {v:?} in a group");
        }
    }
    assert!(clump.state().clumps.velocity[0][2] > -1.5, "it has touched the floor");
    assert_ne!(clump.state().particles.angular_velocity[clump.state().particles.slot[3] as usize][0], 0.0);
}
