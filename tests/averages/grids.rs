//! Grids: a cell has what a region of the same box has; in sum the cells have what all has; the same bits whatever the threads, the
//! way through bytes and the scale.

use crate::averages::regions::scenes::{PLANES, Vector, apart, bed};
use crate::support::{checked, read, start, value};
use cograin::averages::{Content, Tensor};
use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::{averages, interface};
use std::f64::consts::PI;

/// Everything that cells have in a scene without heat.
const OUTPUTS: &str = "outputs = [\"porosity\", \"density\", \"velocity\", \"stress\", \"granular_temperature\", \"count\", \"count_by_set\"]";

/// Where the planes between the cells of a grid are \[m\].
const PLANES_BETWEEN: [&[f64]; 3] = [&[0.005, 0.0175, 0.03], &[-0.01, 0.015, 0.04, 0.065], &[0.0, 0.04]];

/// All numbers of a grid, field by field, as bits.
fn bits(simulation: &Simulation, grid: usize) -> Vec<u64> {
    let fields = interface::fields(simulation, grid);
    fields.iter().flat_map(|field| field.values.iter().map(|value| value.to_bits())).collect()
}

/// The numbers of a field of the first grid.
fn field(simulation: &Simulation, name: &str) -> Vec<f64> {
    let fields = interface::fields(simulation, 0);
    fields.into_iter().find(|field| field.name == name).unwrap_or_else(|| panic!("no field {name}")).values
}

#[test]
fn a_cell_has_what_a_region_of_the_same_box_has() {
    let [x, y, z] = PLANES_BETWEEN;
    let mut text = format!(
        "[grid.cut]\nbox = [[{:?}, {:?}, {:?}], [{:?}, {:?}, {:?}]]\ncounts = [2, 3, 1]\n{OUTPUTS}\n",
        x[0], y[0], z[0], x[2], y[3], z[1]
    );
    for cell in 0..6 {
        let (i, j) = (cell % 2, cell / 2);
        text += &format!(
            "[region.part{}]\nbox = [[{:?}, {:?}, {:?}], [{:?}, {:?}, {:?}]]\n",
            cell + 1,
            x[i],
            y[j],
            z[0],
            x[i + 1],
            y[j + 1],
            z[1]
        );
    }
    let mut simulation = bed(PLANES, &text);
    simulation.advance(2e-3).expect("it runs");
    let mut stresses: f64 = 0.0;
    for cell in 1..=6 {
        for name in ["porosity", "velocity.x", "velocity.z", "granular_temperature", "stress.xx", "stress.yz"] {
            let found = value(&simulation, &format!("cut.cell[{cell}].{name}"));
            let expected = value(&simulation, &format!("part{cell}.{name}"));
            assert!(
                (found - expected).abs() <= 1e-12 * expected.abs(),
                "cell {cell} {name}: {found:?}, {expected:?} expected"
            );
            stresses = stresses.max(if name.starts_with("stress") { expected.abs() } else { 0.0 });
        }
        let density = value(&simulation, &format!("cut.cell[{cell}].density"));
        let expected = value(&simulation, &format!("part{cell}.mass")) / (0.0125 * 0.025 * 0.04);
        assert!((density - expected).abs() <= 1e-12 * expected, "cell {cell}: {density:?}, {expected:?} expected");
    }
    assert!(stresses > 1.0, "contacts carry {stresses} Pa");
}

#[test]
fn cells_have_in_sum_what_all_has() {
    let all = "[region.all]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\n";
    let around = "[grid.around]\nbox = [[-0.013, -0.02, -0.01], [0.061, 0.055, 0.047]]\ncounts = [9, 7, 5]\n";
    let mut simulation = bed(PLANES, &format!("{all}{around}{OUTPUTS}\n"));
    for round in 0..4 {
        simulation.advance(1e-3).expect("it runs");
        let (all, cells) = (averages::contents(&simulation)[0], averages::contents_of_cells(&simulation, 0));
        let sum = |of: &dyn Fn(&Content) -> f64| cells.iter().map(of).sum::<f64>();
        let near = |found: f64, expected: f64, scale: f64| {
            assert!((found - expected).abs() < 1e-13 * scale, "{found:?} {expected:?}");
        };
        near(sum(&|cell| cell.mass), all.mass, all.mass);
        near(sum(&|cell| cell.solid), all.solid, all.solid);
        for axis in 0..3 {
            near(sum(&|cell| cell.mass * cell.velocity[axis]), all.mass * all.velocity[axis], all.mass);
        }
        let carried = averages::carried_in_cells(&simulation, 0);
        let mut found = Tensor::default();
        for (row, column) in (0..9).map(|entry| (entry / 3, entry % 3)) {
            found[row][column] = carried.iter().map(|cell| cell[row][column]).sum();
        }
        let expected = averages::carried(&simulation)[0];
        let scale = apart(&expected, &Tensor::default(), 1.0);
        assert!(
            scale > 0.0 && apart(&found, &expected, scale) < 1e-12,
            "round {round}: {found:?}, {expected:?} expected"
        );
        let count: u64 = averages::counts(&simulation, 0).iter().map(|cell| cell.all).sum();
        assert_eq!(count, simulation.state().particles.slots().count() as u64);
    }
}

/// Grains that fall on a floor: enough for several threads.
const MANY: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
threads = THREADS
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
specific_heat = 800.0
conductivity = 1.0
[pair.glass.glass]
restitution = 0.6
friction = 0.4
[contact.grains.normal.hertz]
[contact.grains.tangential.history]
[contact.grains.heat.constriction]
[particles.cold]
material = "glass"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [13, 13, 8], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
temperature = 280.0
[particles.hot]
material = "glass"
lattice = { kind = "simple_cubic", origin = [0.006, 0.005, 0.075], counts = [12, 12, 6], spacing = 8.2e-3, radius = 4.0e-3 }
velocity = [-0.3, 0.2, -1.0]
temperature = 360.0
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
[grid.bed]
box = [[0.0, 0.0, 0.0], [0.1, 0.1, 0.12]]
counts = [7, 6, 5]
outputs = ["porosity", "density", "velocity", "stress", "granular_temperature", "temperature", "count", "count_by_set"]
"#;

#[test]
fn threads_and_the_way_through_bytes_change_no_bit_of_a_field() {
    let run = |threads: usize| {
        let mut simulation = start(&MANY.replace("THREADS", &threads.to_string()));
        simulation.advance(4e-3).expect("it runs");
        simulation
    };
    let one = run(1);
    assert!(one.contact_count() > 1000);
    for threads in [2, 3] {
        assert_eq!(bits(&run(threads), 0), bits(&one, 0), "{threads} threads");
    }
    let scene = one.scene().clone();
    let bytes = one.state().to_bytes(scene.fingerprint);
    let state = State::from_bytes(&bytes, scene.fingerprint).expect("the bytes are whole");
    assert_eq!(bits(&Simulation::resume(scene, state).expect("it goes on"), 0), bits(&one, 0));
    let temperature = field(&one, "temperature");
    // A mean is rounded in its last digits.
    let between = 280.0 - 1e-10..=360.0 + 1e-10;
    assert!(temperature.iter().all(|it| *it == 0.0 || between.contains(it)), "{temperature:?}");
    let count: f64 = field(&one, "count").iter().sum();
    assert_eq!(count, field(&one, "count_by_set").iter().sum::<f64>(), "every particle is of one of the two sets");
}

#[test]
fn reading_a_field_changes_nothing() {
    let run = |read: bool| {
        let mut simulation = start(&MANY.replace("THREADS", "1"));
        for _ in 0..3 {
            simulation.advance(1e-3).expect("it runs");
            if read {
                bits(&simulation, 0);
            }
        }
        simulation.state().fingerprint()
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn a_scene_scaled_by_a_power_of_two_has_the_same_porosities() {
    let porosities = |scale: f64| {
        let length = |length: f64| length * scale;
        field(
            &start(&format!(
                "[run]\nstep = 1e-9\n[material.glass]\ndensity = 2500.0\n[particles.grains]\nmaterial = \"glass\"\nlattice = {{ kind = \
                 \"face_centred_cubic\", origin = [{0:?}, {0:?}, {0:?}], counts = [4, 4, 4], radius = {1:?} }}\n[grid.bed]\nbox = [[{0:?}, \
                 {1:?}, {0:?}], [{2:?}, {2:?}, {2:?}]]\ncounts = [5, 3, 4]\n",
                length(0.0011),
                length(0.0007),
                length(0.0093)
            )),
            "porosity",
        )
    };
    let (found, expected) = (porosities(2f64.powi(-12)), porosities(1.0));
    assert_eq!(
        found.iter().map(|it| it.to_bits()).collect::<Vec<_>>(),
        expected.iter().map(|it| it.to_bits()).collect::<Vec<_>>()
    );
    assert!(expected.iter().any(|porosity| *porosity < 0.5));
}

/// A periodic cell of 10 mm with one sphere of 2 mm, which stands at a corner, and a grid.
fn at_a_corner(motion: &str, corners: &str, counts: [u32; 3]) -> String {
    format!(
        "[run]\nstep = 1e-6\n[material.glass]\ndensity = 2500.0\n[particles.one]\nmaterial = \"glass\"\nlist = [{{ position = [0.0, 0.0, \
         0.0], radius = 0.002 }}]\nvelocity = [0.1, 0.2, 0.3]\n[cell]\norigin = [0.0, 0.0, 0.0]\nedges = [[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]]\n{motion}\n[grid.bed]\nbox = \
         {corners}\ncounts = {counts:?}\n{OUTPUTS}\n"
    )
}

#[test]
fn a_grid_in_a_periodic_cell_goes_on_through_its_faces() {
    let mut simulation = start(&at_a_corner("", "[[0.0, 0.0, 0.0], [0.01, 0.01, 0.01]]", [2, 2, 2]));
    let volume = 4.0 / 3.0 * PI * 0.002_f64.powi(3);
    for porosity in field(&simulation, "porosity") {
        let expected = 1.0 - volume / 8.0 / 0.005_f64.powi(3);
        assert!((porosity - expected).abs() < 1e-14, "{porosity:?}, {expected:?} expected");
    }
    assert_eq!(field(&simulation, "count").iter().sum::<f64>(), 1.0);
    assert_eq!(simulation.scene().grids[0].shape.repeats, [true; 3], "weights go on, too");
    for _ in 0..40 {
        simulation.advance(1e-3).expect("it runs");
        let solid: f64 = field(&simulation, "porosity").iter().map(|it| (1.0 - it) * 0.005_f64.powi(3)).sum();
        assert!((solid - volume).abs() < 1e-14 * volume, "{solid:?}, {volume:?} expected");
    }
    let twice = start(&at_a_corner("", "[[-0.005, 0.0, 0.0], [0.015, 0.01, 0.01]]", [4, 1, 1]));
    assert_eq!(field(&twice, "count").iter().sum::<f64>(), 2.0, "a grid over two edges sees it twice");
    assert_eq!(twice.scene().grids[0].shape.repeats, [false, true, true]);
}

#[test]
fn a_grid_beside_a_cell_that_is_deformed_is_refused() {
    let text = at_a_corner("motion = { driven = [\"xy\"] }", "[[0.0, 0.0, 0.0], [0.01, 0.01, 0.01]]", [2, 2, 2]);
    let message = read(&text).unwrap_err();
    assert!(message.contains("[grid.bed]: expected a [cell] that keeps its shape beside a grid"), "{message}");
}

#[test]
fn a_clump_fills_what_its_union_does_and_counts_as_one() {
    let simulation = start(
        "[run]\nstep = 1e-6\n[material.glass]\ndensity = 2500.0\n[clump.pair]\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { \
         position = [0.002, 0.0, 0.0], radius = 0.002 }]\n[particles.pairs]\nmaterial = \"glass\"\nclump = \"pair\"\nlist = [{ position = [0.004, 0.005, \
         0.005] }]\n[grid.bed]\nbox = [[0.0, 0.0, 0.0], [0.01, 0.01, 0.01]]\ncounts = [2, 1, 1]\noutputs = [\"porosity\", \"count\", \"count_by_set\"]\n",
    );
    let solid: f64 = field(&simulation, "porosity").iter().map(|it| (1.0 - it) * 0.5e-6).sum();
    // Two spheres, less their lens of width h = r: twice π h²(3 r − h)/3 of height h = r/2.
    let (r, h) = (0.002_f64, 0.001);
    let expected = 8.0 / 3.0 * PI * r.powi(3) - 2.0 * PI * h * h * (3.0 * r - h) / 3.0;
    assert!((solid - expected).abs() < 1e-9 * expected, "{solid:?}, {expected:?} expected");
    assert_eq!(field(&simulation, "count").iter().sum::<f64>(), 1.0);
    assert_eq!(field(&simulation, "count_by_set").iter().sum::<f64>(), 1.0);
}

#[test]
fn variables_of_cells_stand_by_kind_so_that_one_call_reads_a_field() {
    let scene = checked(&MANY.replace("THREADS", "1"));
    let interface = Interface::of(&scene);
    let first = interface.find("bed.cell[1].velocity.x").expect("there is a velocity");
    for cell in 0..210 {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let variable = &interface.variables()[first + 3 * cell + axis];
            assert_eq!(variable.name, format!("bed.cell[{}].velocity.{name}", cell + 1));
        }
    }
    assert_eq!(interface.variables()[first].quantity.unit(), Some("m/s"));
    assert!(
        interface.find("bed.cell[210].count_by_set.hot").is_some() && interface.find("bed.cell[211].count").is_none()
    );
    assert!(
        interface.recorded().all(|(_, variable)| !variable.name.starts_with("bed.")),
        "columns of a history are asked for"
    );
    let simulation = start(&MANY.replace("THREADS", "1"));
    let count = interface.find("bed.cell[1].count").expect("there is a count");
    assert!(matches!(interface.value(&simulation, count), Value::Integer(count) if count > 0));
}

#[test]
fn a_grid_without_outputs_is_there_for_others() {
    let text = "[run]\nstep = 1e-6\n[material.glass]\ndensity = 2500.0\n[grid.bed]\nbox = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]\ncounts = [2, 2, \
                2]\noutputs = []\n";
    let scene = checked(text);
    assert!(Interface::of(&scene).variables().iter().all(|variable| !variable.name.starts_with("bed")));
    let centre: Vector = scene.grids[0].shape.centre(7);
    assert_eq!(centre, [0.75; 3]);
}

/// Two sets in two halves of a box: 4 and 0 on the left, 1 and 3 on the right.
const HALVES: &str = r#"
[run]
step = 1e-6
[material.glass]
density = 2500.0
[particles.sand]
material = "glass"
list = [
    { position = [0.001, 0.002, 0.002], radius = 0.0005 }, { position = [0.003, 0.002, 0.002], radius = 0.0005 },
    { position = [0.001, 0.006, 0.002], radius = 0.0005 }, { position = [0.003, 0.006, 0.002], radius = 0.0005 },
    { position = [0.011, 0.002, 0.002], radius = 0.0005 },
]
[particles.salt]
material = "glass"
list = [
    { position = [0.013, 0.002, 0.002], radius = 0.0005 }, { position = [0.011, 0.006, 0.002], radius = 0.0005 },
    { position = [0.013, 0.006, 0.002], radius = 0.0005 },
]
[region.right]
box = [[0.008, 0.0, 0.0], [0.016, 0.008, 0.008]]
[grid.bed]
box = [[0.0, 0.0, 0.0], [0.016, 0.008, 0.008]]
counts = [2, 1, 1]
outputs = ["mixing_index"]
"#;

#[test]
fn a_grid_tells_how_far_sets_are_mixed_and_a_region_how_many_it_has_of_each() {
    let simulation = start(HALVES);
    // p = 5/8, each half 3/8 off it: S²/S₀² = 9/15; Sᵣ²/S₀² = 2/8.
    let expected = (1.0 - 9.0 / 15.0) / (1.0 - 2.0 / 8.0);
    for set in ["sand", "salt"] {
        let found = value(&simulation, &format!("bed.mixing_index.{set}"));
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    let counts =
        ["count", "count_by_set.sand", "count_by_set.salt"].map(|name| value(&simulation, &format!("right.{name}")));
    assert_eq!(counts, [4.0, 1.0, 3.0]);
    let interface = Interface::of(simulation.scene());
    let index = interface.find("bed.mixing_index.salt").expect("it is there");
    assert!(
        interface.recorded().any(|(recorded, _)| recorded == index),
        "one number of a grid is a column of histories"
    );
    assert!(interface::fields(&simulation, 0).is_empty(), "it is no field");
}
