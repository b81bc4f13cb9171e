//! The condensed stiffness of boundaries: against closed forms, and against what the time steps come to when they have
//! settled.

mod derivatives;

use crate::support::start;
use cograin::interface::{Derivatives, Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::statics::{Factorise, Motionless, Stiffness, come_to_rest, stiffness};
use cograin_sparse::factorise;

/// The last boundary of a scene.
fn last(simulation: &Simulation) -> BoundaryIndex {
    BoundaryIndex(simulation.scene().boundaries.len() as u32 - 1)
}

/// The stiffness of the last boundary.
fn of_last(simulation: &Simulation) -> Stiffness {
    by(simulation, Some(factorise))
}

/// The same by one of the ways to solve the equations.
fn by(simulation: &Simulation, factors: Option<Factorise>) -> Stiffness {
    let boundaries: Vec<_> =
        (!simulation.scene().boundaries.is_empty()).then(|| last(simulation)).into_iter().collect();
    stiffness(simulation, &boundaries, factors).unwrap_or_else(|error| panic!("{error}"))
}

/// Iteration about the bodies' own blocks finds what factors find, but for this \[N/m, Pa\].
fn assert_same_by_iteration(simulation: &Simulation, found: &Stiffness, tolerance: f64) {
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

/// The force on the last boundary along an axis when it was displaced along it and all has come to rest \[N\].
fn settled_force(simulation: &mut Simulation, axis: usize, way: f64, time: f64) -> f64 {
    let boundary = last(simulation);
    simulation.set_input(boundary, axis, way);
    simulation.advance(0.2 * time).unwrap();
    simulation.advance(0.8 * time).unwrap();
    simulation.state().boundaries[boundary.index()].force[axis]
}

/// The stiffness along an axis by displacements there and back from the present state.
fn settled_stiffness(simulation: &mut Simulation, axis: usize, way: f64, time: f64) -> f64 {
    let start = simulation.state().clone();
    let there = settled_force(simulation, axis, way, time);
    simulation.restore(&start).unwrap();
    let back = settled_force(simulation, axis, -way, time);
    simulation.restore(&start).unwrap();
    (back - there) / (2.0 * way)
}

/// A column of bonded spheres between a fixed and a driven end.
fn bonded(counts: [u32; 3]) -> String {
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

/// Bonded spheres on the sites of a cubic lattice whose next neighbours are `spacing` apart, in a cell of so many cubes.
fn crystal(sites: &[[f64; 3]], counts: [usize; 3], cube: f64, spacing: f64) -> String {
    let mut list = Vec::new();
    for place in 0..counts.iter().product() {
        let at = [place % counts[0], place / counts[0] % counts[1], place / counts[0] / counts[1]];
        for site in sites {
            let position = [0, 1, 2].map(|axis| cube * (at[axis] as f64 + site[axis] + 0.1));
            list.push(format!("{{ position = {position:?}, radius = {:?} }}", 0.5 * spacing));
        }
    }
    let [a, b, c] = counts.map(|count| cube * count as f64);
    format!(
        "[run]\nstep = 1.0e-7\nthreads = 1\n[material.ice]\ndensity = 900.0\n[particles.all]\nmaterial = \"ice\"\nlist = [{}]\n\
         [bond.neck]\nbetween = [\"all\", \"all\"]\ncreate_distance = {:?}\nnormal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
         [cell]\nedges = [[{a:?}, 0.0, 0.0], [0.0, {b:?}, 0.0], [0.0, 0.0, {c:?}]]\n[output]\nstiffness = true\n",
        list.join(", "),
        1.01 * spacing
    )
}

#[test]
fn bonded_lattices_in_a_cell_have_the_moduli_of_their_springs() {
    let spacing = 0.01;
    let area = std::f64::consts::PI * 0.25 * spacing * spacing;
    let (normal, shear) = (1.0e10 * area / spacing, 4.0e9 * area / spacing);
    // Spheres turn with the mean rotation of the lattice, so springs across a bond feel the symmetric part of the strain.
    let root = 2.0_f64.sqrt();
    let cubic = [normal, 0.0, 0.5 * shear];
    let face_centred = [root * (normal + shear), (normal - shear) / root, (normal + shear) / root];
    let fcc = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    for (sites, counts, cube, [c11, c12, c44]) in
        [(&fcc[..1], [3, 4, 3], spacing, cubic), (&fcc[..], [2, 3, 2], root * spacing, face_centred)]
    {
        let simulation = start(&crystal(sites, counts, cube, spacing));
        let found = stiffness(&simulation, &[], Some(factorise)).unwrap();
        let cell = found.cell.as_ref().unwrap();
        for (row, entries) in cell.matrix.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                let expected = match (row, column) {
                    (0..3, 0..3) if row == column => c11,
                    (0..3, 0..3) => c12,
                    _ if row == column => c44,
                    _ => 0.0,
                };
                assert!((entry - expected).abs() < 1e-6 * c11, "{row} {column}: {entry} is not {expected}");
            }
        }
        assert!(found.loose.is_empty() && found.rattlers.is_empty(), "{found:?}");
        assert!(cell.residual < 1e-6, "{}", cell.residual);
        assert_same_by_iteration(&simulation, &found, 1e-7 * c11);
        let interface = Interface::of(simulation.scene());
        let index = interface.find("cell.stiffness.xz.xz").unwrap();
        let Value::Real(value) = interface.value(&simulation, index) else { panic!() };
        assert!((value / c44 - 1.0).abs() < 1e-6, "{value}");
    }
}

#[test]
fn the_derivative_of_the_stress_in_a_step_is_that_of_the_springs() {
    let text = crystal(&[[0.0; 3]], [3, 4, 3], 0.01, 0.01);
    let text =
        text.replace("[output]", "motion = { driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }\n[output]");
    let mut simulation = start(&text);
    simulation.advance_or_roll_back(1e-5).unwrap();
    let interface = Interface::of(simulation.scene());
    let find = |name: &str| interface.find(name).unwrap();
    let outputs = ["xx", "yy", "zz"].map(|name| find(&format!("cell.stress.{name}")));
    let normal = 1.0e10 * std::f64::consts::PI * 0.25 * 0.01;
    for (component, name) in ["xx", "yy", "zz"].into_iter().enumerate() {
        let direction = [(find(&format!("cell.strain.{name}")), 1.0)];
        let found =
            interface.derivatives(&mut simulation, &mut Derivatives::default(), (&outputs, &direction)).unwrap();
        for (row, found) in found.into_iter().enumerate() {
            let expected = if row == component { normal } else { 0.0 };
            assert!((found - expected).abs() < 1e-5 * normal, "{row} {component}: {found} is not {expected}");
        }
    }
}

#[test]
fn the_tangent_of_a_packing_in_a_cell_is_what_it_relaxes_to() {
    // Spheres of three sizes, pressed together from a lattice; a smaller one lies loose in a gap.
    let mut list = vec!["{ position = [0.011, 0.011, 0.011], radius = 0.002 }".to_owned()];
    for place in 0..27 {
        let at = [place % 3, place / 3 % 3, place / 9];
        let radius = [0.0101, 0.01005, 0.0102][(place * 7 + place / 3) % 3];
        let position = [0, 1, 2].map(|axis| 0.02 * f64::from(at[axis] as u32) + 0.001);
        list.push(format!("{{ position = {position:?}, radius = {radius:?} }}"));
    }
    let text = format!(
        "[run]\nstep = 1.0e-5\nthreads = 1\n[material.glass]\ndensity = 2500.0\nyoungs_modulus = 5.0e7\npoissons_ratio = 0.3\n\
         [pair.glass.glass]\nrestitution = 0.5\nfriction = 0.5\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n\
         [damping.all]\nlinear = 0.3\nangular = 0.3\n[particles.all]\nmaterial = \"glass\"\nlist = [{}]\n\
         [cell]\nedges = [[0.06, 0.0, 0.0], [0.0, 0.06, 0.0], [0.0, 0.0, 0.06]]\n\
         motion = {{ driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }}\n",
        list.join(", ")
    );
    let mut simulation = start(&text);
    simulation.advance(0.4).unwrap();
    let found = stiffness(&simulation, &[], Some(factorise)).unwrap();
    let cell = found.cell.as_ref().unwrap();
    assert_eq!(found.rattlers, [0], "the small one");
    assert!(cell.residual < 1e-3, "{}", cell.residual);
    assert_same_by_iteration(&simulation, &found, 1e-5 * cell.matrix[0][0]);
    let state = simulation.state().clone();
    for component in [0, 4] {
        let mut relaxed = |strain: f64| {
            simulation.restore(&state).unwrap();
            simulation.set_strain(component, strain);
            simulation.advance(0.01).unwrap();
            simulation.advance(0.3).unwrap();
            simulation.cell_stress()
        };
        let (there, back) = (relaxed(1e-8), relaxed(-1e-8));
        for (row, entries) in cell.matrix.iter().enumerate() {
            let expected = (there[row] - back[row]) / 2e-8;
            let off = (entries[component] - expected).abs() / cell.matrix[0][0];
            assert!(off < 1e-4, "{row} {component}: {} is not {expected}", entries[component]);
        }
    }
}

/// A bonded beam of spheres along z that is fixed at its lower end, under a weight across it; with this motion of its upper end, if it is
/// to be a group.
fn leaning(counts: [u32; 3], upper: Option<&str>) -> String {
    let text = bonded(counts).replace("[boundary.bottom]", "gravity_damped = true\n\n[boundary.bottom]");
    let text = format!("gravity = [9.81, 0.0, -3.0]\n{text}");
    match upper {
        Some(motion) => text.replace("{ driven = [\"x\", \"z\"] }", motion),
        None => text[..text.find("[boundary.top]").unwrap()].to_owned(),
    }
}

#[test]
fn newtons_method_leads_a_beam_to_where_time_steps_leave_it() {
    let guided = "{ driven = [\"z\"], free = [\"x\", \"y\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }";
    for (counts, upper) in [([1, 1, 6], None), ([2, 2, 4], None), ([1, 1, 6], Some(guided))] {
        let mut simulation = start(&leaning(counts, upper));
        let begun = simulation.state().clone();
        let mut ratios = Vec::new();
        let iterations = come_to_rest(&mut simulation, 1e-7, factorise, &mut |ratio| {
            ratios.push(ratio);
            true
        })
        .unwrap();
        assert!(iterations <= 6 && ratios.len() == iterations + 1, "{iterations} iterations, {ratios:?}");
        let unbalanced = simulation.undamped_unbalanced_force();
        assert!(unbalanced < 1e-6, "{unbalanced}");
        let places = |simulation: &Simulation| -> Vec<[f64; 3]> {
            let particles = &simulation.state().particles;
            let rows = particles.slot.iter().map(|slot| particles.position[*slot as usize]);
            rows.map(|[x, y, z, _]| [x, y, z]).collect()
        };
        let by_newton = places(&simulation);
        simulation.restore(&begun).unwrap();
        let before = places(&simulation);
        simulation.damp_rest(0.7);
        simulation.advance(0.1).unwrap();
        let by_steps = places(&simulation);
        let way = |from: &[[f64; 3]], to: &[[f64; 3]]| {
            let parts = from.as_flattened().iter().zip(to.as_flattened());
            parts.fold(0.0_f64, |most, (from, to)| most.max((to - from).abs()))
        };
        let (off, all) = (way(&by_steps, &by_newton), way(&before, &by_steps));
        assert!(off < 1e-4 * all, "{off} of {all}");
    }
}

#[test]
fn newtons_method_leaves_what_has_no_rest_as_it_was_and_says_why() {
    let dust = "[particles.dust]\nmaterial = \"ice\"\nlist = [{ position = [1.0, 0.0, 0.0], radius = 0.01 }]\n";
    let weak = "[bond.neck.breakage]\nmax_normal_stress = 5.0e3\n";
    for (more, expected) in [(dust, "can move without a load"), (weak, "break")] {
        let text = leaning([1, 1, 5], None);
        let text = match more == dust {
            true => text.replace("[bond.neck]", &format!("{dust}[bond.neck]")),
            false => text.replace("[damping.all]", &format!("{weak}[damping.all]")),
        };
        let mut simulation = start(&text);
        let begun = simulation.state().clone();
        let error: Motionless = come_to_rest(&mut simulation, 1e-7, factorise, &mut |_| true).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert_eq!(*simulation.state(), begun);
    }
}
