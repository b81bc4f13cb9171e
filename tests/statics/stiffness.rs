//! Stiffness of bonds, beds and what hangs on hinges.

use super::scenes::{assert_same_by_iteration, bonded, by, last, of_last, settled_force, settled_stiffness};
use crate::support::start;
use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;
use cograin::statics::stiffness;
use cograin_sparse::factorise;

#[test]
fn bonds_in_a_row_are_springs_in_series() {
    let found = of_last(&start(&bonded([1, 1, 6])));
    // five bonds of k_n times their area, pi r²
    let expected = 1.0e10 * std::f64::consts::PI * 1.0e-4 / 5.0;
    let along = found.boundaries[0].matrix[2][2];
    assert!((along - expected).abs() <= 1e-7 * expected, "{along} is not {expected}");
    assert!(found.boundaries[0].residual < 1e-6, "{}", found.boundaries[0].residual);
    assert!(found.rattlers.is_empty() && found.loose.is_empty());
}

#[test]
fn a_unit_finds_by_iteration_what_factors_find() {
    let simulation = start(&bonded([3, 2, 5]));
    let found = of_last(&simulation);
    assert!(found.boundaries[0].residual < 1e-6 && found.asymmetry < 1e-6, "{found:?}");
    assert_same_by_iteration(&simulation, &found, 1e-7 * found.boundaries[0].matrix[2][2]);
}

#[test]
fn a_unit_shows_the_stiffness_of_its_boundaries() {
    let simulation = start(&(bonded([1, 1, 6]) + "[output]\nstiffness = true\n"));
    let interface = Interface::of(simulation.scene());
    let expected = by(&simulation, None).boundaries[0].matrix;
    for (axis, name) in ["top.stiffness.x", "top.stiffness.y", "top.stiffness.z"].into_iter().enumerate() {
        let index = interface.find(name).unwrap_or_else(|| panic!("there is no {name}"));
        assert_eq!(interface.value(&simulation, index), Value::Real(expected[axis][axis]), "{name}");
    }
    assert!(expected[2][2] > 1e5 && expected[0][0] < 0.1 * expected[2][2], "{expected:?}");
}

#[test]
fn a_bonded_block_is_as_stiff_as_it_is_when_time_steps_have_settled() {
    let mut simulation = start(&bonded([2, 2, 4]));
    let found = of_last(&simulation);
    for axis in [0, 2] {
        let (condensed, expected) =
            (found.boundaries[0].matrix[axis][axis], settled_stiffness(&mut simulation, axis, 1.0e-9, 0.02));
        let off = (condensed - expected).abs() / expected;
        assert!(off <= 1e-7, "axis {axis}: {condensed} is not {expected}, off by {off:e}");
    }
}

#[test]
fn a_bed_is_as_stiff_as_it_is_when_time_steps_have_settled() {
    let text = r#"
gravity = [0.0, 0.0, -9.81]

[run]
step = 5.0e-6
threads = 1

[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3

[pair.glass.glass]
restitution = 0.5
friction = 0.5

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.bed]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.01, spacing = 0.01999, origin = [0.0, 0.0, 0.009995], counts = [4, 4, 3] }

[damping.all]
linear = 0.3
angular = 0.3
gravity_damped = true

[boundary.west]
plane = { point = [-0.009995, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "glass"

[boundary.east]
plane = { point = [0.069965, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
material = "glass"

[boundary.south]
plane = { point = [0.0, -0.009995, 0.0], normal = [0.0, 1.0, 0.0] }
material = "glass"

[boundary.north]
plane = { point = [0.0, 0.069965, 0.0], normal = [0.0, -1.0, 0.0] }
material = "glass"

[boundary.lid]
particles = { set = "bed", box = [[-1.0, -1.0, 0.03], [1.0, 1.0, 1.0]] }

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { driven = ["x", "z"] }
"#;
    let mut simulation = start(text);
    // pressed and sheared a little, and left alone
    settled_force(&mut simulation, 2, 2.0e-6, 0.05);
    settled_force(&mut simulation, 0, 1.0e-6, 0.05);
    simulation.advance(0.2).unwrap();
    let found = of_last(&simulation);
    let start = simulation.state().boundaries[last(&simulation).index()].displacement[2];
    let boundary = last(&simulation);
    let settled = |simulation: &mut Simulation, way: f64| {
        simulation.set_input(boundary, 2, start + way);
        simulation.advance(0.02).unwrap();
        simulation.advance(0.15).unwrap();
        simulation.state().boundaries[boundary.index()].force[2]
    };
    let state = simulation.state().clone();
    let there = settled(&mut simulation, 1.0e-9);
    simulation.restore(&state).unwrap();
    let back = settled(&mut simulation, -1.0e-9);
    let (condensed, expected) = (found.boundaries[0].matrix[2][2], (back - there) / 2.0e-9);
    let off = (condensed - expected).abs() / expected;
    assert!(off <= 1e-6, "{condensed} is not {expected}, off by {off:e}");
    assert!(found.asymmetry > 1e-6, "springs follow the overlap: {}", found.asymmetry);
    simulation.restore(&state).unwrap();
    assert_same_by_iteration(&simulation, &found, 1e-6 * expected);
}

#[test]
fn particles_that_nothing_holds_are_told() {
    let text = bonded([1, 1, 4]).replace(
        "[bond.neck]",
        "[particles.dust]\nmaterial = \"ice\"\nlist = [{ position = [1.0, 0.0, 0.0], radius = 0.01 }]\n\n[bond.neck]",
    );
    let simulation = start(&text);
    let found = of_last(&simulation);
    assert_eq!(found.rattlers, [simulation.scene().particles.len() as u32 - 1]);
}

#[test]
fn what_has_no_static_stiffness_is_refused_by_name() {
    let text =
        bonded([1, 1, 4]).replace("[damping.all]", "[bond.neck.relaxation]\nnormal_force = 1.0\n\n[damping.all]");
    let simulation = start(&text);
    let error = stiffness(&simulation, &[last(&simulation)], Some(factorise)).unwrap_err().to_string();
    assert_eq!(
        error,
        "expected a bond that keeps its load, found [bond.neck] relaxation, which has no static \
                       stiffness"
    );
}

/// A column of three spheres with friction between a floor and a lid, one on the floor and one on that beside it, at 2^`scale` of their
/// size, times as much longer.
fn loose(scale: i32) -> String {
    let size = 2.0_f64.powi(scale);
    let [radius, apart, over] = [0.01, 0.01999, 0.00999].map(|length| length * size);
    let place =
        |x: f64, height: f64| format!("{{ position = [{:?}, 0.0, {height:?}], radius = {radius:?} }}", x * size);
    let (beside, top) = (place(0.1, over), place(0.1, over + apart));
    format!(
        r#"
gravity = [0.0, 0.0, {:?}]

[run]
step = {:?}
threads = 1

[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3

[pair.glass.glass]
restitution = 0.5
friction = 0.5

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.column]
material = "glass"
list = [{}, {}, {}, {beside}, {top}]

[boundary.floor]
material = "glass"
rectangle = {{ corner = [{:?}, {:?}, 0.0], edges = [[{:?}, 0.0, 0.0], [0.0, {:?}, 0.0]] }}

[boundary.lid]
material = "glass"
rectangle = {{ corner = [{:?}, {:?}, {:?}], edges = [[{:?}, 0.0, 0.0], [0.0, {:?}, 0.0]] }}
motion = {{ driven = ["x", "z"] }}
"#,
        -9.81 / size,
        2e-6 * size,
        place(0.0, over),
        place(0.0, over + apart),
        place(0.0, over + 2.0 * apart),
        -0.05 * size,
        -0.05 * size,
        0.3 * size,
        0.1 * size,
        -0.05 * size,
        -0.05 * size,
        2.0 * (over + apart),
        0.1 * size,
        0.1 * size,
    )
}

#[test]
fn what_bears_nothing_is_left_out_and_the_answer_is_that_of_the_column_alone_at_any_scale() {
    let stacked = of_last(&start(&loose(0)));
    assert_eq!(
        stacked.rattlers,
        [3, 4],
        "the upper one touches the lower one alone, which then touches the floor alone"
    );
    assert_eq!(stacked.loose, [0, 1, 2], "they bear, and nothing keeps them from turning about the column");
    let alone = loose(0).replace(", { position = [0.1, 0.0, 0.00999], radius = 0.01 }", "");
    let alone = alone.replace(&format!(", {{ position = [0.1, 0.0, {:?}], radius = 0.01 }}", 0.00999 + 0.01999), "");
    let alone = of_last(&start(&alone));
    assert_eq!(alone.freedoms, 18);
    assert_eq!((stacked.freedoms, &stacked.boundaries), (18, &alone.boundaries));
    // Four equal contacts in a row, E* = E/(2 (1 − ν²)), of which those of two spheres have half the radius.
    let modulus = 5.0e7 / (2.0 * (1.0 - 0.09));
    let [wall, pair] = [0.01_f64, 0.005].map(|radius| 2.0 * modulus * (radius * 1e-5).sqrt());
    let (expected, found) = (1.0 / (2.0 / wall + 2.0 / pair), stacked.boundaries[0].matrix[2][2]);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
    for scale in [-20, -7, 3, 20] {
        let scaled = of_last(&start(&loose(scale)));
        assert_eq!((&scaled.rattlers, &scaled.loose), (&stacked.rattlers, &stacked.loose));
        let size = 2.0_f64.powi(scale);
        let same = scaled.boundaries[0].matrix.map(|row| row.map(|entry| entry / size));
        assert_eq!(same, stacked.boundaries[0].matrix, "at 2^{scale}");
        assert_eq!(scaled.boundaries[0].residual, stacked.boundaries[0].residual, "at 2^{scale}");
    }
}

/// A bar of three bonded spheres along z whose ends hang by thin bonds, which bear no moment, on what is below and, `above`, on what
/// is over it. Beside it, two spheres that are bonded to each other alone.
fn hinged(above: bool) -> String {
    let place = |z: f64| format!("{{ position = [0.0, 0.0, {z:?}], radius = 0.01 }}");
    let held = if above { format!("{}, {}", place(0.0), place(0.08)) } else { place(0.0) };
    let groups = |name: &str, low: f64, motion: &str| {
        format!(
            "[boundary.{name}]\nparticles = {{ set = \"held\", box = [[-1.0, -1.0, {low:?}], [1.0, 1.0, {:?}]] }}\n{motion}\n",
            low + 0.02
        )
    };
    format!(
        "[run]\nstep = 1.0e-6\nthreads = 1\n[material.ice]\ndensity = 900.0\n[particles.bar]\nmaterial = \"ice\"\nlist = [{}, {}, {}]\n\
         [particles.pair]\nmaterial = \"ice\"\nlist = [{{ position = [1.0, 0.0, 0.0], radius = 0.01 }}, {{ position = [1.02, 0.0, 0.0], \
         radius = 0.01 }}]\n[particles.held]\nmaterial = \"ice\"\nlist = [{held}]\n\
         [bond.neck]\nbetween = [\"bar\", \"bar\"]\ncreate_distance = 0.0201\nnormal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
         [bond.twin]\nbetween = [\"pair\", \"pair\"]\ncreate_distance = 0.0201\nnormal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
         [bond.hinge]\nbetween = [\"bar\", \"held\"]\ncreate_distance = 0.0201\nradius_multiplier = 1.0e-5\nnormal_stiffness = 1.0e20\n\
         tangential_stiffness = 1.0e20\n{}{}",
        place(0.02),
        place(0.04),
        place(0.06),
        if above { groups("above", 0.07, "") } else { String::new() },
        groups("below", -0.01, "motion = { driven = [\"x\", \"z\"] }"),
    )
}

#[test]
fn a_bar_between_hinges_bears_along_its_axis_and_one_that_hangs_follows() {
    let area = std::f64::consts::PI * 1e-4;
    let (neck, hinge) = (1.0e10 * area, 1.0e20 * area * 1e-10);
    for (above, expected) in [(true, 1.0 / (2.0 / neck + 2.0 / hinge)), (false, 0.0)] {
        let simulation = start(&hinged(above));
        let found = of_last(&simulation);
        let along = found.boundaries[0].matrix[2][2];
        assert!((along - expected).abs() <= 1e-6 * neck, "{along} is not {expected}");
        assert!(found.boundaries[0].matrix[0][0].abs() <= 1e-6 * neck, "{:?}", found.boundaries[0].matrix);
        assert_eq!(found.loose, [0, 1, 2], "the bar turns as a whole");
        assert_eq!(found.rattlers, [3, 4], "the pair holds itself, and nothing holds it");
        assert!(found.boundaries[0].residual < 1e-6, "{}", found.boundaries[0].residual);
        assert_same_by_iteration(&simulation, &found, 1e-6 * neck);
    }
}
