//! A cloud of spheres that collide with friction, rolling resistance and cohesion keeps its linear and angular momentum.
//!
//! Every contact force acts on both bodies along one line, and the arms of both add up to their distance.

use crate::physics::stage::{HERTZ, Stage, assert_near, material, properties, scene, sphere};
use cograin::contact::cohesion::sjkr;
use cograin::contact::{CohesionModel, LawChoice, NoKeys, Properties, RollingModel, cohesion, property, rolling};
use cograin::scene::Particle;

/// A block of spheres of three sizes that flies together, twists and collides.
pub(crate) fn cloud() -> Vec<Particle> {
    let mut all = Vec::new();
    for index in 0..125_i32 {
        let place = [index % 5 - 2, (index / 5) % 5 - 2, index / 25 - 2].map(f64::from);
        let mut body = sphere(0.004 + 0.0005 * f64::from(index % 3), 2500.0);
        body.position = place.map(|at| 0.0102 * at);
        let jitter = |salt: i32| f64::from((index * 37 + salt * 101) % 17) / 17.0 - 0.5;
        body.velocity = [
            -0.4 * place[0] + 0.1 * place[1] + 0.3 * jitter(1),
            -0.4 * place[1] - 0.1 * place[0] + 0.3 * jitter(2),
            -0.4 * place[2] + 0.3 * jitter(3),
        ];
        body.angular_velocity = [jitter(4), jitter(5), jitter(6)].map(|at| 40.0 * at);
        all.push(body);
    }
    all
}

/// Everything that makes forces between spheres.
pub(crate) fn whole_law() -> (LawChoice, Properties) {
    let law = LawChoice {
        rolling: RollingModel::of::<rolling::cdt::Cdt>(NoKeys {}),
        cohesion: CohesionModel::of::<cohesion::sjkr::Sjkr>(sjkr::Keys { tangential_reduce: true }),
        ..HERTZ
    };
    let pair =
        properties(0.6, 0.5).with(&property::ROLLING_FRICTION, 0.1).with(&property::COHESION_ENERGY_DENSITY, 2e4);
    (law, pair)
}

/// Linear and angular momentum about the origin, and the sums of magnitudes they are made of.
fn momenta(stage: &Stage, bodies: &[Particle]) -> ([f64; 3], [f64; 3], f64, f64) {
    let (mut linear, mut angular, mut size, mut turn) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
    for (index, body) in bodies.iter().enumerate() {
        let (x, v, w) = (stage.position(index), stage.velocity(index), stage.spin(index));
        let (mass, inertia) = (body.mass(), 0.4 * body.mass() * body.radius * body.radius);
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            linear[a] += mass * v[a];
            size += mass * v[a].abs();
            angular[a] += mass * (x[b] * v[c] - x[c] * v[b]) + inertia * w[a];
            turn += mass * (x[b] * v[c]).abs() + mass * (x[c] * v[b]).abs() + inertia * w[a].abs();
        }
    }
    (linear, angular, size, turn)
}

#[test]
fn a_colliding_cloud_keeps_linear_and_angular_momentum() {
    let bodies = cloud();
    let (law, pair) = whole_law();
    let mut stage = Stage::of(scene(law, 5e-6, vec![material(1e7, 0.3)], pair, bodies.clone()));
    let (linear, angular, size, turn) = momenta(&stage, &bodies);
    let energy = stage.simulation.kinetic_energy();
    stage.steps(3000);
    let (linear_after, angular_after, ..) = momenta(&stage, &bodies);
    assert!(stage.simulation.kinetic_energy() < 0.5 * energy, "the cloud has hardly collided");
    for axis in 0..3 {
        // 3000 steps of rounding, each half an ulp of a part
        assert_near(linear_after[axis], linear[axis], 1e-13 * size, "linear momentum");
        assert_near(angular_after[axis], angular[axis], 1e-13 * turn, "angular momentum");
    }
}
