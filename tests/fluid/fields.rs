//! Fields of a fluid on a grid: what grains see of them, and what cells tell.

use super::scenes::{SIX, give, led, sum, swirl};
use crate::support::{assert_near, start, value};
use cograin::interface::{Derivatives, Interface};
use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Drag of the fluid on the grain over the drag coefficient: the velocity that it sees.
fn seen(simulation: &Simulation) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| -sum(simulation, &format!("mean_drag.{axis}")) / sum(simulation, "drag_coefficient"))
}

#[test]
fn a_field_that_is_linear_in_space_is_seen_as_it_is_at_the_centre_of_a_grain() {
    let field = |[x, y, z]: [f64; 3]| [2.0 * x - 3.0 * y + 0.1, 5.0 * z - 1.0 * x, 0.7 + 4.0 * y];
    for place in [[0.0123, 0.0171, 0.0088], [0.051, 0.0053, 0.0149], [0.03, 0.015, 0.01]] {
        let mut simulation = led(place, SIX, "velocity = \"driven\"");
        let grid = simulation.scene().grids[0].shape;
        give(&mut simulation, "velocity", |cell| field(grid.centre(cell)));
        simulation.place(None).unwrap();
        simulation.advance(1e-3).unwrap();
        for (found, expected) in seen(&simulation).into_iter().zip(field(place)) {
            assert_near(found, expected, 1e-13);
        }
    }
}

#[test]
fn nothing_jumps_where_a_grain_crosses_faces() {
    // Across the face at x = 0.02 by 2e-9 m, and across the plane of centres at 0.025, at places between and on other faces.
    for (face, y, z) in [(0.02, 0.0123, 0.0091), (0.02, 0.01, 0.01), (0.025, 0.0171, 0.01)] {
        let force = |x: f64| {
            let fluid = "velocity = \"driven\"\npressure = \"total\"";
            let mut simulation = led([x, y, z], SIX, fluid);
            give(&mut simulation, "velocity", swirl);
            give(&mut simulation, "pressure_gradient", |cell| swirl(cell).map(|part| 1e5 * part));
            simulation.place(None).unwrap();
            simulation.state().boundaries[0].force
        };
        let (before, after) = (force(face - 1e-9), force(face + 1e-9));
        let largest = before.into_iter().map(f64::abs).fold(0.0, f64::max);
        for (before, after) in before.into_iter().zip(after) {
            // A change as large as the force from one cell to the next is one of 2e-7 on this way.
            assert!((before - after).abs() < 2e-6 * largest, "{before:e} N before, {after:e} N after");
        }
    }
}

#[test]
fn porosity_is_what_spheres_leave_by_their_exact_parts() {
    // A sphere whose centre is on an edge of four cells has a quarter in each.
    let simulation = led([0.02, 0.01, 0.005], SIX, "");
    let quarter = 0.25 * 4.0 / 3.0 * PI * 1e-9;
    for cell in [2, 3, 8, 9] {
        assert_near(value(&simulation, &format!("water.cell[{cell}].porosity")), 1.0 - quarter / 1e-6, 1e-14);
    }
    assert_near(36.0 - sum(&simulation, "porosity"), 4.0 * quarter / 1e-6, 1e-11);
}

#[test]
fn a_grain_in_empty_cells_has_the_drag_of_one_sphere_wherever_it_is() {
    for law in ["koch_hill", "beetstra", "di_felice", "gidaspow"] {
        let drag = |fluid: &str| {
            // A grain of 1 µm leaves a cell of 1 m empty, to rounding.
            let mut simulation = start(&format!(
                r#"
[run]
step = 1.0e-9
[material.a]
density = 2500.0
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.51, 0.53, 0.57], counts = [5, 5, 5], spacing = 0.21, radius = 1.0e-6 }}
[grid.column]
box = [[0.0, 0.0, 0.0], [2.0, 2.0, 2.0]]
counts = [2, 2, 2]
[fluid.air]
density = 1.2
viscosity = 1.8e-5
velocity = [0.1, 0.2, 0.3]
{fluid}
[fluid.air.drag.{law}]
"#
            ));
            simulation.advance(1e-8).unwrap();
            simulation.state().particles.force.iter().map(|force| force[2]).collect::<Vec<_>>()
        };
        let expected = drag("porosity = 1.0");
        for (found, expected) in drag("grid = \"column\"").into_iter().zip(expected) {
            assert_near(found, expected, 1e-6);
        }
    }
}

#[test]
fn a_uniform_flow_on_a_grid_is_that_of_a_fluid_without_one() {
    let keys = "viscosity = 1.0e-3\ndensity = 1000.0\nvelocity = [0.1, 0.2, -0.05]";
    let run = |fluid: &str| {
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.01, 0.01, 0.01], counts = [4, 4, 4], spacing = 4.0e-3, radius = 1.5e-3 }}
[grid.column]
box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.04]]
counts = [1, 1, 1]
[fluid.water]
{keys}
{fluid}
[fluid.water.drag.beetstra]
"#
        ));
        simulation.advance(0.02).unwrap();
        let row = simulation.state().particles.velocity[5];
        ([row[0], row[1], row[2]], simulation.state().fluid.as_ref().unwrap().mean[0])
    };
    let porosity = 1.0 - 64.0 * 4.0 / 3.0 * PI * 1.5e-3_f64.powi(3) / 0.04_f64.powi(3);
    let (one, drag) = run("grid = \"column\"");
    let (other, expected) = run(&format!("porosity = {porosity:?}"));
    one.into_iter().zip(other).for_each(|(one, other)| assert_near(one, other, 1e-12));
    drag.into_iter().zip(expected).for_each(|(drag, expected)| assert_near(drag, expected, 1e-12));
}

#[test]
fn no_fluid_acts_outside_of_the_box() {
    let simulation = led([0.0123, 0.0171, 0.0201], SIX, "velocity = [1.0, 0.0, 0.0]");
    assert_eq!(simulation.state().boundaries[0].force, [0.0; 3]);
    let simulation = led([0.0123, 0.0171, 0.0199], SIX, "velocity = [1.0, 0.0, 0.0]");
    assert!(simulation.state().boundaries[0].force[0] > 0.0);
}

#[test]
fn a_grain_at_a_face_of_a_cell_that_repeats_sees_both_sides() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grain]
material = "a"
list = [{ position = [0.0, 0.005, 0.005], radius = 1.0e-3 }]
[cell]
edges = [[0.04, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]]
[grid.column]
box = [[0.0, 0.0, 0.0], [0.04, 0.01, 0.01]]
counts = [4, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = "driven"
grid = "column"
[fluid.water.drag.stokes]
"#,
    );
    let half = 2.0 / 3.0 * PI * 1e-9;
    for cell in [1, 4] {
        assert_near(value(&simulation, &format!("water.cell[{cell}].porosity")), 1.0 - half / 1e-6, 1e-14);
    }
    give(&mut simulation, "velocity", |cell| [0.0, [0.1, 9.0, 9.0, 0.3][cell], 0.0]);
    simulation.place(None).unwrap();
    simulation.advance(1e-5).unwrap();
    let drags = [1, 2, 3, 4].map(|cell| value(&simulation, &format!("water.cell[{cell}].mean_drag.y")));
    assert!(drags[0] < 0.0 && (drags[0] - drags[3]).abs() < 1e-12 * drags[0].abs(), "{drags:?} N");
    assert_eq!(drags[1..3], [0.0; 2]);
    let coefficient = 2.0 * value(&simulation, "water.cell[1].drag_coefficient");
    // In a hundredth of a relaxation time the grain follows a little.
    assert_near(-2.0 * drags[0], coefficient * 0.2, 0.1);
}

#[test]
fn fields_are_by_kind_cell_by_cell() {
    let simulation = led([0.0123, 0.0171, 0.0088], SIX, "velocity = \"driven\"\npressure = \"dynamic\"");
    let interface = Interface::of(simulation.scene());
    let first = interface.find("water.cell[1].velocity.x").unwrap();
    let names: Vec<_> = (first..first + 4).map(|index| interface.variables()[index].name.clone()).collect();
    let expected = [
        "water.cell[1].velocity.x",
        "water.cell[1].velocity.y",
        "water.cell[1].velocity.z",
        "water.cell[2].velocity.x",
    ];
    assert_eq!(names, expected);
    let gradient = interface.find("water.cell[1].pressure_gradient.x").unwrap();
    assert_eq!(gradient, first + 3 * 36);
    assert!(interface.find("water.velocity.x").is_none() && interface.find("water.mean_drag.x").is_none());
}

#[test]
fn derivatives_of_drag_by_velocities_are_the_weights_and_the_coefficient() {
    let mut simulation = led([0.0123, 0.0171, 0.0088], SIX, "velocity = \"driven\"");
    give(&mut simulation, "velocity", |_| [1e-6, 0.0, 0.0]);
    simulation.place(None).unwrap();
    simulation.advance_or_roll_back(1e-3).unwrap();
    let interface = Interface::of(simulation.scene());
    let input = interface.find("water.cell[2].velocity.x").unwrap();
    let output = interface.find("water.cell[2].mean_drag.x").unwrap();
    let found =
        interface.derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, 1.0)])).unwrap()[0];
    let [all, share] = [sum(&simulation, "drag_coefficient"), value(&simulation, "water.cell[2].drag_coefficient")];
    // On a ramp half of a change acts in the mean.
    assert_near(found, -0.5 * share * share / all, 0.05);
}
