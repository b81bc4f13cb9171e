//! Cundall's damping depends on the frame: on the direction of the axes and on a uniform motion. It takes momentum.
//!
//! It looks at each component of force and velocity, and the velocity is that of the scene's frame. This is the
//! documents' damping; the tests show what it does, so that nobody expects otherwise.

use crate::physics::cundall_decay::damping;
use crate::physics::stage::{SMOOTH, Stage, assert_close, assert_near, material, properties, scene, sphere};

/// Two spheres meet along this direction, all moving with `drift` along it besides. Returns their velocities along it
/// before and after \[m/s\].
fn impact(direction: [f64; 3], drift: f64, fraction: f64) -> ([f64; 2], [f64; 2]) {
    let mut bodies = vec![sphere(0.005, 2500.0), sphere(0.005, 5000.0)];
    let speeds = [0.5 + drift, -0.5 + drift];
    for axis in 0..3 {
        bodies[1].position[axis] = 0.01001 * direction[axis];
        bodies[0].velocity[axis] = speeds[0] * direction[axis];
        bodies[1].velocity[axis] = speeds[1] * direction[axis];
    }
    let mut scene = scene(SMOOTH, 1e-6, vec![material(1e7, 0.3)], properties(1.0, 0.0), bodies);
    scene.damping = damping(&scene, fraction, 0.0, false);
    let mut stage = Stage::of(scene);
    stage.steps(1000);
    let along = |v: [f64; 3]| v[0] * direction[0] + v[1] * direction[1] + v[2] * direction[2];
    (speeds, [along(stage.velocity(0)), along(stage.velocity(1))])
}

/// Along x.
const STRAIGHT: [f64; 3] = [1.0, 0.0, 0.0];

#[test]
fn a_uniform_motion_changes_what_an_impact_leaves() {
    let (_, still) = impact(STRAIGHT, 0.0, 0.2);
    let (_, moving) = impact(STRAIGHT, 1.0, 0.2);
    let change = moving[1] - moving[0] - (still[1] - still[0]);
    assert!(change.abs() > 0.05, "the relative velocity after differs by {change:e} m/s only");
    // Undamped, it does not.
    let (_, still) = impact(STRAIGHT, 0.0, 0.0);
    let (_, moving) = impact(STRAIGHT, 1.0, 0.0);
    assert_near(moving[1] - moving[0], still[1] - still[0], 1e-12, "relative velocity, undamped");
}

#[test]
fn an_impact_loses_momentum() {
    let (before, after) = impact(STRAIGHT, 0.0, 0.2);
    // the second sphere is twice as heavy
    let lost = (before[0] + 2.0 * before[1] - after[0] - 2.0 * after[1]).abs();
    assert!(lost > 0.02, "{lost:e} of the momentum of 1 kg m/s lost");
    let (before, after) = impact(STRAIGHT, 0.0, 0.0);
    assert_near(after[0] + 2.0 * after[1], before[0] + 2.0 * before[1], 1e-12, "momentum, undamped");
}

#[test]
fn turning_the_axes_changes_an_oblique_flight() {
    // A sphere flies along x under gravity across: damped components are those of the axes.
    let fly = |turned: bool| {
        let half = 0.5_f64.sqrt();
        let turn = |x: f64, z: f64| if turned { [half * (x - z), 0.0, half * (x + z)] } else { [x, 0.0, z] };
        let mut body = sphere(0.005, 2500.0);
        body.velocity = turn(1.0, 0.0);
        let mut scene = scene(SMOOTH, 1e-4, vec![material(1e7, 0.3)], properties(1.0, 0.0), vec![body]);
        scene.gravity = turn(0.0, -9.81);
        scene.damping = damping(&scene, 0.3, 0.0, true);
        let mut stage = Stage::of(scene);
        stage.steps(500);
        let [x, _, z] = stage.velocity(0);
        if turned { [half * (x + z), half * (z - x)] } else { [x, z] }
    };
    let (plain, turned) = (fly(false), fly(true));
    assert_close(plain[0], 1.0, 1e-12, "along x nothing acts");
    assert!((turned[0] - 1.0).abs() > 0.05, "{:e} m/s across gravity", turned[0]);
}
