//! What is loaded, and how stiff it is found.

use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::statics::{Factorise, Stiffness, stiffness};
use cograin_sparse::factorise;

/// The last boundary of a scene.
pub(super) fn last(simulation: &Simulation) -> BoundaryIndex {
    BoundaryIndex(simulation.scene().boundaries.len() as u32 - 1)
}

/// The stiffness of the last boundary.
pub(super) fn of_last(simulation: &Simulation) -> Stiffness {
    by(simulation, Some(factorise))
}

/// The same by one of the ways to solve the equations.
pub(super) fn by(simulation: &Simulation, factors: Option<Factorise>) -> Stiffness {
    let boundaries: Vec<_> =
        (!simulation.scene().boundaries.is_empty()).then(|| last(simulation)).into_iter().collect();
    stiffness(simulation, &boundaries, factors).unwrap_or_else(|error| panic!("{error}"))
}

/// The force on the last boundary along an axis when it was displaced along it and all has come to rest \[N\].
pub(super) fn settled_force(simulation: &mut Simulation, axis: usize, way: f64, time: f64) -> f64 {
    let boundary = last(simulation);
    simulation.set_input(boundary, axis, way);
    simulation.advance(0.2 * time).unwrap();
    simulation.advance(0.8 * time).unwrap();
    simulation.state().boundaries[boundary.index()].force[axis]
}

/// The stiffness along an axis by displacements there and back from the present state.
pub(super) fn settled_stiffness(simulation: &mut Simulation, axis: usize, way: f64, time: f64) -> f64 {
    let start = simulation.state().clone();
    let there = settled_force(simulation, axis, way, time);
    simulation.restore(&start).unwrap();
    let back = settled_force(simulation, axis, -way, time);
    simulation.restore(&start).unwrap();
    (back - there) / (2.0 * way)
}

/// Iteration about the bodies' own blocks finds what factors find, but for this \[N/m, Pa\].
pub(super) fn assert_same_by_iteration(simulation: &Simulation, found: &Stiffness, tolerance: f64) {
    let iterated = by(simulation, None);
    assert_eq!((iterated.freedoms, &iterated.rattlers), (found.freedoms, &found.rattlers));
    for (one, other) in iterated.boundaries.iter().zip(&found.boundaries) {
        for (one, other) in one.matrix.as_flattened().iter().zip(other.matrix.as_flattened()) {
            assert!((one - other).abs() <= tolerance, "by iteration {one}, by factors {other}");
        }
    }
    for (one, other) in iterated.cell.iter().zip(&found.cell) {
        for (one, other) in one.matrix.as_flattened().iter().zip(other.matrix.as_flattened()) {
            assert!((one - other).abs() <= tolerance, "by iteration {one}, by factors {other}");
        }
    }
}

/// A column of bonded spheres between a fixed and a driven end.
pub(super) fn bonded(counts: [u32; 3]) -> String {
    let top = 0.02 * f64::from(counts[2] - 1) - 0.005;
    format!(
        r#"
[run]
step = 1.0e-6
threads = 1

[material.ice]
density = 900.0

[particles.column]
material = "ice"
lattice = {{ kind = "simple_cubic", radius = 0.01, spacing = 0.02, origin = [0.0, 0.0, 0.0], counts = {counts:?} }}

[bond.neck]
between = ["column", "column"]
create_distance = 0.0201
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9

[damping.all]
linear = 0.3
angular = 0.3

[boundary.bottom]
particles = {{ set = "column", box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 0.005]] }}

[boundary.top]
particles = {{ set = "column", box = [[-1.0, -1.0, {top:?}], [1.0, 1.0, 1.0]] }}
motion = {{ driven = ["x", "z"] }}
"#
    )
}
