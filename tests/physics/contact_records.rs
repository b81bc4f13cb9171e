//! What is reported of contacts is what acted: the reported forces add up to those on the particles.

use crate::physics::momentum::{cloud, whole_law};
use crate::physics::stage::{HERTZ, Stage, assert_near, material, scene};
use cograin::contact::{LawChoice, NoKeys, TangentialModel, tangential};

/// Largest difference of reported and acting force on any particle, over the largest force; and whether any slid.
fn difference(law: LawChoice) -> (f64, bool) {
    let bodies = cloud();
    let count = bodies.len();
    let mut stage = Stage::of(scene(law, 5e-6, vec![material(1e7, 0.3)], whole_law().1, bodies));
    stage.steps(700);
    let mut reported = vec![[0.0; 3]; count];
    let mut slid = false;
    for contact in stage.simulation.contacts() {
        slid |= contact.sliding;
        for axis in 0..3 {
            let force = contact.normal_force * contact.normal[axis] + contact.tangential_force[axis];
            reported[contact.first as usize][axis] += force;
            reported[contact.second.unwrap() as usize][axis] -= force;
        }
    }
    let (mut most, mut apart) = (0.0_f64, 0.0_f64);
    for (particle, reported) in reported.iter().enumerate() {
        for (acting, reported) in stage.force(particle).iter().zip(reported) {
            most = most.max(acting.abs());
            apart = apart.max((acting - reported).abs());
        }
    }
    (apart / most, slid)
}

#[test]
fn reported_forces_add_up_to_those_on_the_particles() {
    for tangential in [HERTZ.tangential, TangentialModel::of::<tangential::no_history::NoHistory>(NoKeys {})] {
        let (apart, slid) = difference(LawChoice { tangential, ..whole_law().0 });
        assert!(slid, "no contact slides");
        // The velocities of the evaluation are found again from those after it: rounding.
        assert_near(apart, 0.0, 1e-9, "reported less acting force");
    }
}
