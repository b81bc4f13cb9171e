//! A box of meshes holds spheres as six planes do.

use super::scenes::{FullBox, RADIUS, askew};

#[test]
fn a_box_of_meshes_gives_the_bits_of_six_planes() {
    let full = FullBox::turned(5, |place| place);
    let expected = full.run(false, 1000);
    assert!(expected.0 > 20, "{} contacts", expected.0);
    assert_eq!(full.run(true, 1000), expected);
}

/// Until spheres have had two impacts; every further one makes what rounding has changed larger.
#[test]
fn a_turned_box_of_meshes_goes_the_way_of_six_planes() {
    let upright = FullBox::turned(5, |place| place).run(false, 400);
    let (contacts, turned) = FullBox::turned(5, askew).run(true, 400);
    assert!(contacts > 20 && contacts == upright.0, "{contacts} and {} contacts", upright.0);
    for (found, before) in turned.iter().zip(&upright.1) {
        for (part, scale) in [(0, RADIUS), (1, 0.3), (2, 0.3 / RADIUS)] {
            let [x, y, z, _] = before[part];
            let expected = askew([x, y, z]);
            let apart = (0..3).map(|axis| (found[part][axis] - expected[axis]).abs()).fold(0.0, f64::max);
            assert!(apart <= 1e-10 * scale, "{:?} found, {expected:?} expected", found[part]);
        }
    }
}

/// What has settled: the force on the floor as a share of the weight, the mean height of the centres above it \[m\], and the force on all six walls
/// less the weight, as a share of that.
fn settled(full: &FullBox, meshes: bool) -> [f64; 3] {
    let mut simulation = full.start(meshes);
    simulation.advance(0.3).and_then(|()| simulation.advance(0.02)).unwrap_or_else(|error| panic!("{error}"));
    let strength = full.gravity.map(|part| part * part).iter().sum::<f64>().sqrt();
    let down = full.gravity.map(|part| part / strength);
    let along = |v: [f64; 3]| (0..3).map(|axis| v[axis] * down[axis]).sum::<f64>();
    let state = simulation.state();
    let weight: f64 = state.particles.velocity.iter().map(|row| row[3]).sum::<f64>() * strength;
    let forces: Vec<f64> = state.boundaries.iter().map(|moved| along(moved.mean_force)).collect();
    let depth = state.particles.position.iter().map(|[x, y, z, _]| along([*x, *y, *z])).sum::<f64>() / 216.0;
    [forces[4] / weight, 0.036 - depth, forces.iter().sum::<f64>() / weight - 1.0]
}

#[test]
fn what_settles_in_a_turned_box_of_meshes_lies_as_in_six_planes() {
    let of = |turn: fn([f64; 3]) -> [f64; 3], meshes: bool| -> Vec<[f64; 3]> {
        let from = |seed: u64| {
            let mut full = FullBox::turned(seed, turn);
            full.gravity = turn([0.0, 0.0, -98.1]);
            settled(&full, meshes)
        };
        (1..=4).map(from).collect()
    };
    let (planes, turned) = (of(|place| place, false), of(askew, true));
    for [.., unborne] in planes.iter().chain(&turned) {
        assert!(unborne.abs() < 2e-3, "all walls bear the weight but for {unborne} of it");
    }
    for part in [0, 1] {
        let mean = |list: &[[f64; 3]]| list.iter().map(|seen| seen[part]).sum::<f64>() / 4.0;
        let (expected, found) = (mean(&planes), mean(&turned));
        let scatter = (planes.iter().map(|seen| (seen[part] - expected).powi(2)).sum::<f64>() / 3.0).sqrt();
        assert!((found - expected).abs() <= scatter, "{turned:?}, between planes {planes:?}");
    }
}
