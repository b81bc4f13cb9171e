//! Regions carry what walls and inertia say.

use super::scenes::{
    ALL, MESH, PLANES, apart, axial, bed, bed_text, box_file, cross, less, touches, walls_and_inertia,
};
use crate::support::start_with;
use cograin::averages;
use cograin::averages::Tensor;
use cograin::simulation::Simulation;

/// Lets a bed move and checks the balance of the region that holds all of it.
fn balances(simulation: &mut Simulation, rounds: usize) {
    let mut slid = false;
    for round in 0..rounds {
        simulation.advance(1e-3).expect("it runs");
        slid |= simulation.contacts().iter().any(|contact| contact.sliding);
        let found = averages::carried(simulation)[0];
        let expected = walls_and_inertia(simulation, |place| place);
        let error = apart(&found, &expected.tensor, expected.turnover);
        assert!(error < 1e-12, "round {round}: {error:e}: {found:?}, {:?} expected", expected.tensor);
        let size = apart(&found, &Tensor::default(), expected.turnover);
        assert!(size > 1e-3, "round {round}: only {size:e} of the turnover is carried");
        at_walls(simulation);
        turning(simulation, &found, expected.turnover);
    }
    assert!(slid, "no contact slides");
}

/// The contacts at the walls are all that the walls feel.
fn at_walls(simulation: &Simulation) {
    for (index, boundary) in simulation.state().boundaries.iter().enumerate() {
        let (mut felt, mut turnover) = ([0.0; 3], 0.0);
        for touch in touches(simulation).iter().filter(|touch| touch.boundary == index) {
            for axis in 0..3 {
                felt[axis] -= touch.force[axis];
                turnover += touch.force[axis].abs();
            }
        }
        for axis in 0..3 {
            let error = (felt[axis] - boundary.force[axis]).abs();
            assert!(error <= 1e-12 * turnover, "boundary {index}, axis {axis}: {error:e} of {turnover:e} N");
        }
    }
}

/// What is not symmetric makes the particles turn.
fn turning(simulation: &Simulation, found: &Tensor, turnover: f64) {
    let mut couple = [0.0; 3];
    for torque in &simulation.state().particles.torque {
        (0..3).for_each(|axis| couple[axis] += torque[axis]);
    }
    // The moment on a wall is −Σ (c − pivot) × f − Σ C.
    for boundary in &simulation.state().boundaries {
        (0..3).for_each(|axis| couple[axis] += boundary.moment[axis]);
    }
    for touch in touches(simulation) {
        let pivot = simulation.state().boundaries[touch.boundary].pivot;
        let moment = cross(less(touch.point, pivot), touch.force);
        (0..3).for_each(|axis| couple[axis] += moment[axis]);
    }
    let error = less(axial(found), couple).iter().fold(0.0, |most: f64, part| most.max(part.abs())) / turnover;
    assert!(error < 1e-12, "{error:e}: {:?}, {couple:?} expected", axial(found));
}

#[test]
fn a_moving_bed_between_planes_carries_what_walls_and_inertia_say() {
    balances(&mut bed(PLANES, ALL), 12);
}

#[test]
fn a_moving_bed_in_a_mesh_carries_what_walls_and_inertia_say() {
    balances(&mut bed(MESH, ALL), 12);
}

/// How far the balance of a bed is from closing after 4 ms, over the turnover, where its scene has these words in the place of others.
fn imbalance(walls: &str, changes: &[[&str; 2]]) -> f64 {
    let mut text = bed_text(1, "[0.0015, 0.0035]", walls, ALL);
    for [old, new] in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let mut simulation = start_with(&text, box_file());
    simulation.advance(4e-3).expect("it runs");
    let found = averages::carried(&simulation)[0];
    let expected = walls_and_inertia(&simulation, |place| place);
    apart(&found, &expected.tensor, expected.turnover)
}

#[test]
fn every_kind_of_law_balances() {
    let sticky = "friction = 0.4\ncohesion_energy_density = 2.0e4";
    let sjkr = "[contact.grains.rolling.cdt]\n[contact.grains.cohesion.sjkr]";
    let adhesive = "friction = 0.4\nsurface_energy = 0.05\ndamping_coefficient = 2.0e4\ntangential_damping_ratio = 0.5";
    let plastic = "friction = 0.4\nsurface_energy = 0.5\nunloading_stiffness_ratio = 3.0\npull_off_force = 1.0e-3";
    let eepa = "normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 2";
    let laws: [&[[&str; 2]]; 8] = [
        &[["tangential.history", "tangential.rescaled"]],
        &[["tangential.history", "tangential.turned_history"]],
        &[["tangential.history", "tangential.no_history"]],
        &[["rolling.cdt", "rolling.epsd2"]],
        &[["friction = 0.4", sticky], ["[contact.grains.rolling.cdt]", sjkr]],
        &[["friction = 0.4", adhesive], ["normal.hertz", "normal.dmt"]],
        &[["friction = 0.4", adhesive], ["normal.hertz", "normal.jkr"], ["rolling.cdt", "rolling.epsd2"]],
        &[["friction = 0.4", plastic], ["normal.hertz]", eepa]],
    ];
    for law in laws {
        for walls in [PLANES, MESH] {
            let error = imbalance(walls, law);
            assert!(error < 1e-12, "{law:?}: {error:e}");
        }
    }
}

#[test]
fn every_scheme_balances_as_far_as_its_dashpots_are_told() {
    let with = |scheme: &str| imbalance(PLANES, &[["step = ", &format!("scheme = {scheme:?}\nstep = ")]]);
    for scheme in ["engine", "predicted_normal", "midway"] {
        let error = with(scheme);
        assert!(error < 1e-12, "{scheme}: {error:e}");
    }
    // What a dashpot foresaw is not stored; records take the present velocity for it.
    let error = with("predicted");
    assert!(error < 1e-5, "predicted: {error:e}");
}

#[test]
fn a_slab_carries_what_is_beyond_it() {
    // The part s of a branch in a slab of z is what the branch gains of the depth in the slab: the balance holds with the
    // depth in place of z, whatever the slab cuts through.
    let (low, high) = (0.0113, 0.0247);
    let slab = format!("[region.slab]\nbox = [[-1.0, -1.0, {low:?}], [1.0, 1.0, {high:?}]]\n");
    let mut simulation = bed(PLANES, &slab);
    for _ in 0..6 {
        simulation.advance(1e-3).expect("it runs");
        let found = averages::carried(&simulation)[0];
        let expected = walls_and_inertia(&simulation, |[_, _, z]| [0.0, 0.0, z.clamp(low, high) - low]);
        let error = apart(&[[0.0; 3], [0.0; 3], found[2]], &expected.tensor, expected.turnover);
        assert!(error < 1e-12, "{error:e}: {:?}, {:?} expected", found[2], expected.tensor[2]);
    }
}

#[test]
fn regions_side_by_side_add_up() {
    let cells = "
[region.all]
box = [[0.004, 0.006, 0.005], [0.03, 0.035, 0.033]]
[region.lower]
box = [[0.004, 0.006, 0.005], [0.017, 0.035, 0.033]]
[region.upper]
box = [[0.017, 0.006, 0.005], [0.03, 0.035, 0.033]]
";
    let mut simulation = bed(PLANES, cells);
    simulation.advance(3e-3).expect("it runs");
    let [all, lower, upper] = averages::carried(&simulation)[..] else { panic!("three regions") };
    let sum: Tensor =
        [0, 1, 2].map(|row: usize| [0, 1, 2].map(|column: usize| lower[row][column] + upper[row][column]));
    let size = all.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    assert!(apart(&sum, &all, size) < 1e-12, "{sum:?}, {all:?} expected");
    let [all, lower, upper] = averages::contents(&simulation)[..] else { panic!("three regions") };
    assert!((lower.solid + upper.solid - all.solid).abs() < 1e-13 * all.solid);
    assert!((lower.mass + upper.mass - all.mass).abs() < 1e-13 * all.mass);
}
