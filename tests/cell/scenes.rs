//! Spheres in cells.

use crate::support::{cell, glass, spheres, uniform};

/// Elastic spheres with these further lines: sets, the cell, what else there is.
pub(super) fn scene(law: &str, pair: &str, rest: &str) -> String {
    let glass = glass(1e7, pair);
    format!("[run]\nstep = 1e-5\nend = 1.0\n{glass}{law}\n[output]\nenergy = true\nlosses = true\n{rest}")
}

/// Without friction and damping.
pub(super) const SMOOTH: [&str; 2] = ["[contact.touch.normal.hertz]", "restitution = 1.0"];

/// With both.
pub(super) const ROUGH: [&str; 2] =
    ["[contact.touch.normal.hertz]\n[contact.touch.tangential.history]", "restitution = 0.6\nfriction = 0.4"];

pub(super) const STRAINS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Spheres that do not touch, with random velocities of no momentum in sum.
pub(super) fn gas(count: usize, size: f64, speed: f64) -> Vec<([f64; 3], f64, [f64; 3])> {
    let (mut random, per) = (7, (count as f64).cbrt().ceil() as usize);
    let mut list: Vec<_> = (0..count)
        .map(|place| {
            let at = [place % per, place / per % per, place / per / per];
            let position = at.map(|at| size * (at as f64 + 0.5 + 0.2 * (uniform(&mut random) - 0.5)) / per as f64);
            (position, 0.2 * size / per as f64, [(); 3].map(|()| speed * (uniform(&mut random) - 0.5)))
        })
        .collect();
    for axis in 0..3 {
        let mean = list.iter().map(|(.., velocity)| velocity[axis]).sum::<f64>() / count as f64;
        list.iter_mut().for_each(|(.., velocity)| velocity[axis] -= mean);
    }
    list
}

/// A cube.
pub(super) fn cube(size: f64) -> [[f64; 3]; 3] {
    [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]]
}

/// A dense gas of rough spheres, some across the faces, in a cell that leans over.
pub(super) fn dense(law: [&str; 2], more: &str) -> String {
    let mut list = gas(120, 0.1, 1.0);
    list.iter_mut().for_each(|(_, radius, _)| *radius *= 2.2);
    let edges = [[0.1, 0.0, 0.0], [0.02, 0.1, 0.0], [-0.03, 0.01, 0.1]];
    let list: Vec<_> = list
        .into_iter()
        .map(|(part, radius, velocity)| {
            let place = [0, 1, 2].map(|axis| (0..3).map(|edge| part[edge] / 0.1 * edges[edge][axis]).sum::<f64>());
            (place, radius, velocity)
        })
        .collect();
    scene(law[0], law[1], &(spheres(&list) + &cell(edges, more))).replace("[run]", "[run]\nmax_overlap = 0.3")
}

/// Sites of a lattice in parts of its cubic cell.
pub(super) fn sites(kind: &str) -> Vec<[f64; 3]> {
    let all = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.5], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    match kind {
        "sc" => vec![all[0]],
        "bcc" => vec![all[0], all[1]],
        _ => vec![all[0], all[2], all[3], all[4]],
    }
}

/// A cell of `counts` lattice cells of this size.
pub(super) fn lattice(kind: &str, counts: [usize; 3], size: f64, radius: f64, motion: &str) -> String {
    let mut list = Vec::new();
    for place in 0..counts.iter().product() {
        let at = [place % counts[0], place / counts[0] % counts[1], place / counts[0] / counts[1]];
        for site in sites(kind) {
            list.push(([0, 1, 2].map(|axis| size * (at[axis] as f64 + site[axis] + 0.1)), radius, [0.0; 3]));
        }
    }
    let [a, b, c] = counts.map(|count| size * count as f64);
    let [law, pair] = SMOOTH;
    scene(law, pair, &(spheres(&list) + &cell([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]], motion)))
}
