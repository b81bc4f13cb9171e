//! Spheres above floors in cells, and their motion.

use crate::support::{Files, HERTZ_AND_FRICTION, Triangle, glass, obj};
use cograin::simulation::Simulation;
use std::fmt::Write as _;

/// Edge of the cells \[m\].
pub(super) const EDGE: f64 = 0.04;

/// A box whose edge b leans.
pub(super) fn leaning() -> [[f64; 3]; 3] {
    [[EDGE, 0.0, 0.0], [0.01, EDGE, 0.0], [0.0, 0.0, EDGE]]
}

/// Spheres of 3 mm with velocities and spins, above what these lines say.
pub(super) fn scene(list: &[[[f64; 3]; 3]], rest: &str) -> String {
    let mut text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 2e-6\nmax_overlap = 0.3\n{}{HERTZ_AND_FRICTION}[output]\nenergy = true\n\
         [particles.all]\nmaterial = \"glass\"\nlist = [\n",
        glass(5e6, "restitution = 0.7\nfriction = 0.4")
    );
    for [place, velocity, spin] in list {
        let _ = writeln!(
            text,
            "{{ position = {place:?}, radius = 0.003, velocity = {velocity:?}, angular_velocity = {spin:?} }},"
        );
    }
    text + "]\n" + rest
}

/// Triangles of a sheet over so many steps along two vectors, whose height is this over parts of a cell.
pub(super) fn sheet(edges: [[f64; 3]; 2], cells: [[i32; 2]; 2], height: fn(i32, i32) -> f64) -> Vec<Triangle> {
    let steps = 4;
    let at = |i: i32, j: i32| {
        let [u, v] = [i, j].map(|step| f64::from(step) / f64::from(steps));
        let [x, y] = [0, 1].map(|axis| u * edges[0][axis] + v * edges[1][axis]);
        [x, y, height(i.rem_euclid(steps), j.rem_euclid(steps))]
    };
    let [[left, right], [front, back]] = cells.map(|range| range.map(|cell| cell * steps));
    let mut triangles = Vec::new();
    for i in left..right {
        for j in front..back {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    triangles
}

/// The file of a floor of these triangles.
pub(super) fn floor_file(triangles: &[Triangle]) -> Files {
    Files::from([("floor.obj".to_owned(), obj(triangles))])
}

/// Bumps that go on through the faces.
pub(super) fn bumpy(i: i32, j: i32) -> f64 {
    [[0.0, 0.001, 0.0005, -0.001], [0.0015, 0.0, -0.0005, 0.001], [-0.001, 0.0008, 0.0, 0.0], [0.0, 0.0, 0.0012, 0.0]]
        [i as usize][j as usize]
}

/// Velocities and spins of the scene's particles, and how far they went without being brought back.
pub(super) fn motion(simulation: &Simulation) -> Vec<f64> {
    let particles = &simulation.state().particles;
    let mut found = Vec::new();
    for (index, &slot) in particles.slot.iter().enumerate() {
        let slot = slot as usize;
        let mut place: [f64; 3] = std::array::from_fn(|axis| particles.position[slot][axis]);
        if let Some(cell) = &simulation.state().cell {
            for (count, edge) in cell.edges_away[index].iter().zip(cell.edges) {
                (0..3).for_each(|axis| place[axis] += *count as f64 * edge[axis]);
            }
        }
        found.extend(place);
        found.extend(&particles.velocity[slot][..3]);
        found.extend(particles.angular_velocity[slot][..3].iter().map(|spin| 0.003 * spin));
    }
    found
}

/// Advances both, and compares motions; returns how many faces were crossed.
#[track_caller]
pub(super) fn assert_alike(mut closed: Simulation, mut open: Simulation, steps: usize, tolerance: f64) -> i64 {
    for step in 0..steps {
        closed.advance(2e-3).unwrap();
        open.advance(2e-3).unwrap();
        let (found, expected) = (motion(&closed), motion(&open));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < tolerance, "{step}: {found:?} {expected:?}");
        }
    }
    closed.state().cell.as_ref().unwrap().edges_away.iter().flatten().map(|count| count.abs()).sum()
}
