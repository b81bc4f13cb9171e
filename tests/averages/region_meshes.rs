//! Regions inside of meshes: what they say is what boxes of the same shape say, and nothing depends on how the work is shared.

use crate::averages::regions::scenes::{PLANES, PRESSED, Vector, apart, bed, bed_with};
use crate::support::{start_with, value};
use cograin::averages;
use cograin::averages::Tensor;
use cograin::interface::Interface;
use cograin::quantity::BoundaryIndex;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A region inside the box of `box.obj`, which has edges of 40 mm, so many times as large and from this corner on; and the same
/// region as a box.
fn alike(scale: f64, corner: Vector) -> String {
    let upper = corner.map(|part| part + 0.04 * scale);
    format!(
        "[region.mesh]\nmesh = {{ file = \"box.obj\", scale = {scale:?}, offset = {corner:?} }}\n\
         [region.box]\nbox = [{corner:?}, {upper:?}]\n"
    )
}

/// Compares both regions of a bed.
fn compare(simulation: &cograin::simulation::Simulation, wide: bool) {
    let [mesh, cuboid] = averages::contents(simulation)[..] else { panic!("two regions") };
    assert!((mesh.solid - cuboid.solid).abs() < 1e-12 * cuboid.solid, "{} {}", mesh.solid, cuboid.solid);
    assert!((mesh.mass - cuboid.mass).abs() < 1e-12 * cuboid.mass);
    for axis in 0..3 {
        assert!((mesh.velocity[axis] - cuboid.velocity[axis]).abs() < 1e-12);
    }
    let [one, other] = averages::coordination(simulation)[..] else { panic!("two regions") };
    assert_eq!(one, other);
    let [mesh, cuboid] = averages::carried(simulation)[..] else { panic!("two regions") };
    let size = cuboid.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let error = apart(&mesh, &cuboid, size);
    assert!(error < if wide { 1e-15 } else { 1e-12 }, "{error:e}: {mesh:?}, {cuboid:?} expected");
    assert!(apart(&mesh, &Tensor::default(), size) > 0.5);
}

#[test]
fn a_bed_in_a_mesh_is_the_bed_in_the_box_of_the_same_corners() {
    for (scale, corner) in [(0.7, [0.004, 0.006, 0.005]), (0.5, [0.0, 0.013, 0.02]), (3.0, [-0.04; 3])] {
        let mut simulation = bed(PLANES, &alike(scale, corner));
        for _ in 0..3 {
            simulation.advance(1e-3).expect("it runs");
            compare(&simulation, scale > 1.0);
        }
    }
}

#[test]
fn regions_of_spheres_on_a_lattice_with_centres_on_faces_edges_and_corners() {
    let text = format!(
        "[run]\nstep = 1e-6\nthreads = 1\n[material.a]\ndensity = 1000.0\nyoungs_modulus = 1.0e7\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 0.5\n[contact.c.normal.hertz]\n[particles.all]\nmaterial = \"a\"\n\
         lattice = {{ kind = \"simple_cubic\", radius = 0.0051, spacing = 0.01, counts = [7, 7, 7] }}\n{}",
        alike(1.0, [0.01; 3])
    );
    let mut simulation = start_with(&text, mesh_files());
    simulation.advance(1e-6).expect("it runs");
    let [mesh, cuboid] = averages::contents(&simulation)[..] else { panic!("two regions") };
    assert!((mesh.solid - cuboid.solid).abs() < 1e-11 * cuboid.solid, "{} {}", mesh.solid, cuboid.solid);
    // 4³ cells of one sphere each, less six layers of caps that reach over 50 µm beyond contact.
    assert!((cuboid.solid / 64.0 / (4.0 / 3.0 * PI * 0.0051_f64.powi(3)) - 1.0).abs() < 0.01);
}

/// The box of `box.obj`, and a tetrahedron.
fn mesh_files() -> BTreeMap<String, Vec<u8>> {
    let mut files = crate::averages::regions::scenes::box_file();
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    files.insert("corner.obj".to_owned(), text.as_bytes().to_vec());
    files
}

#[test]
fn a_region_in_a_mesh_goes_with_the_boundary_that_it_follows() {
    let region =
        "[region.moving]\nmesh = { file = \"box.obj\", scale = 25.0, offset = [0.0, -0.5, -0.5] }\nfollows = \"lid\"\n";
    let mut simulation = start_with(&format!("{PRESSED}{region}"), mesh_files());
    let part = |simulation: &cograin::simulation::Simulation| {
        (1.0 - value(simulation, "moving.porosity")) / (0.01_f64).powi(3)
    };
    assert!((part(&simulation) - 2.0 / 3.0 * PI).abs() < 1e-9);
    simulation.set_input(BoundaryIndex(1), 0, 0.004);
    simulation.advance(1e-4).expect("it runs");
    let cap = PI * 0.6_f64.powi(2) * 2.4 / 3.0;
    assert!((part(&simulation) - cap).abs() < 1e-9, "{}, {cap} expected", part(&simulation));
}

#[test]
fn looking_into_a_mesh_changes_nothing_and_any_number_of_threads_sees_the_same() {
    let region = "[region.part]\nmesh = { file = \"box.obj\", scale = 0.6, rotation = [0.3, 0.4, 0.5], offset = [0.01, 0.005, 0.004] }\n";
    let outputs = |threads: usize, more: &str| {
        let mut simulation = bed_with(threads, "[0.0012, 0.0014]", PLANES, more);
        simulation.advance(2e-3).expect("it runs");
        let interface = Interface::of(simulation.scene());
        let values: Vec<u64> =
            interface.outputs().map(|(index, _)| interface.value(&simulation, index).number().to_bits()).collect();
        simulation.advance(1e-3).expect("it runs");
        (values, simulation.state().particles.position.clone())
    };
    let (one, three) = (outputs(1, region), outputs(3, region));
    assert_eq!(one, three);
    assert_eq!(one.1, outputs(1, "").1);
}

#[test]
fn what_comes_into_a_mesh_is_whole_inside_and_what_goes_is_gone() {
    let text = "
[run]
step = 1.0e-5
threads = 1
[material.a]
density = 1000.0
[region.mouth]
mesh = { file = \"corner.obj\", scale = 0.1 }
[region.below]
mesh = { file = \"corner.obj\", scale = 0.1, offset = [0.0, 0.0, -0.2] }
[insertion.feed]
region = \"mouth\"
material = \"a\"
sizes = { uniform = [0.002, 0.004] }
count_rate = 2000.0
velocity = [0.0, 0.0, -2.0]
[outlet.end]
region = \"below\"
";
    let mut simulation = start_with(text, mesh_files());
    simulation.advance(0.02).expect("it runs");
    let place = |[x, y, z, radius]: [f64; 4]| {
        let [x, y, z] = [x, y, z + 2.0 * 0.02];
        // They all came at most 40 mm above where they are now.
        assert!(x >= radius && y >= radius && z >= radius && x + y <= 0.1 - radius, "{x} {y} {z} {radius}");
    };
    assert!(simulation.state().particles.len() > 20);
    simulation.state().particles.position.iter().for_each(|sphere| place(*sphere));
    simulation.advance(0.18).expect("it runs");
    let gone = value(&simulation, "end.count");
    assert!(gone > 50.0, "{gone}");
}

/// What a region of so many triangles costs in a bed of so many spheres.
#[test]
#[ignore = "a measurement"]
fn ten_thousand_triangles_and_ten_thousand_spheres() {
    let ball = |around: usize, high: usize| {
        let mut text = String::from("v 0 0 1\nv 0 0 -1\n");
        for i in 1..high {
            for j in 0..around {
                let (polar, angle) = (PI * i as f64 / high as f64, 2.0 * PI * j as f64 / around as f64);
                let [x, y, z] = [polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos()];
                text += &format!("v {x:?} {y:?} {z:?}\n");
            }
        }
        let at = |i: usize, j: usize| 3 + (i - 1) * around + j % around;
        for j in 0..around {
            text += &format!("f 1 {} {}\nf 2 {} {}\n", at(1, j), at(1, j + 1), at(high - 1, j + 1), at(high - 1, j));
            for i in 1..high - 1 {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
            }
        }
        text
    };
    for (around, high) in [(10, 6), (100, 51)] {
        let text = "[run]\nstep = 1e-6\nthreads = 1\n[material.a]\ndensity = 1000.0\nyoungs_modulus = 1.0e7\npoissons_ratio = 0.3\n\
             [pair.a.a]\nrestitution = 0.5\n[contact.c.normal.hertz]\n[particles.all]\nmaterial = \"a\"\n\
             lattice = { kind = \"simple_cubic\", radius = 0.00501, spacing = 0.01, counts = [22, 22, 22] }\n\
             [region.ball]\nmesh = { file = \"ball.obj\", scale = 0.1, offset = [0.1, 0.11, 0.12] }\n";
        let simulation = start_with(text, BTreeMap::from([("ball.obj".to_owned(), ball(around, high).into_bytes())]));
        let begun = std::time::Instant::now();
        let solid = averages::contents(&simulation)[0].solid;
        let contents = begun.elapsed();
        let carried = averages::carried(&simulation)[0][0][0];
        println!(
            "{} triangles: {contents:?} for volumes, {:?} with stress; {solid} {carried}",
            2 * around * (high - 1),
            begun.elapsed()
        );
    }
}
