//! Packings and files that go on through the faces of a cell.

use super::scenes::{least_gap, packed};
use crate::support::{Files, read, read_with, start, start_with};

#[test]
fn a_packing_goes_on_through_the_faces() {
    let volume = 0.05 * 0.04 * 0.045;
    for (more, periodic, count) in [
        ("solid_fraction = 0.58, radius = [0.0025, 0.004]", [true; 3], None),
        ("solid_fraction = 0.3, radius = [0.001, 0.005]", [true, true, false], None),
        ("count = 220, radius = [0.002, 0.0035]", [true; 3], Some(220)),
        ("count = 120, radius = 0.003", [true, false, true], Some(120)),
    ] {
        let names: Vec<&str> = (0..3).filter(|&edge| periodic[edge]).map(|edge| ["x", "y", "z"][edge]).collect();
        let scene = read(&(packed(more) + &format!("periodic = {names:?}\n"))).unwrap();
        let all: Vec<_> = scene.particles.iter().map(|particle| (particle.position, particle.radius)).collect();
        assert!(count.is_none_or(|count| all.len() == count), "{}", all.len());
        let solid: f64 = all.iter().map(|(_, r)| 4.0 / 3.0 * std::f64::consts::PI * r * r * r).sum();
        if let Some(fraction) = more.strip_prefix("solid_fraction = ") {
            let fraction: f64 = fraction.split(',').next().unwrap().parse().unwrap();
            assert!((solid / volume - fraction).abs() < 0.02, "{}", solid / volume);
        }
        let gap = least_gap(&all, periodic);
        assert!(gap > -1e-12, "{more}: {gap}");
        let height = |place: [f64; 3], edge: usize| match edge {
            // Distances from the faces that z and y join, from the lower one on.
            2 => place[2],
            _ => {
                let z = place[2];
                let (y, lean) = (place[1] + 0.02 - z * (0.006 / 0.045), (1.0_f64 + (0.006_f64 / 0.045).powi(2)).sqrt());
                y / lean
            }
        };
        let heights = [0.0, 0.04 / (1.0_f64 + (0.006_f64 / 0.045).powi(2)).sqrt(), 0.045];
        for edge in (1..3).filter(|&edge| !periodic[edge]) {
            for (place, radius) in &all {
                let height = height(*place, edge);
                assert!(height > radius - 1e-12 && height < heights[edge] - radius + 1e-12, "{place:?}");
            }
        }
        let mut simulation = start(&(packed(more) + &format!("periodic = {names:?}\n")));
        assert_eq!(simulation.elastic_energy(), 0.0);
        simulation.advance(1e-4).unwrap();
    }
    // A cell of one sphere that just does not touch its images, and one that would.
    assert!(read(&packed("count = 1, radius = 0.0198")).is_ok());
    let full = read(&packed("count = 1, radius = 0.0199")).unwrap_err();
    assert!(full.contains("found room for 0"), "{full}");
}

/// A file that LAMMPS wrote.
fn foreign(name: &str) -> Files {
    let path = format!("{}/tests/scenes/foreign/periodic/{name}", env!("CARGO_MANIFEST_DIR"));
    Files::from([(name.to_owned(), std::fs::read(path).unwrap())])
}

/// The scene of such a file in a cell with these keys.
fn imported(name: &str, cell: &str) -> String {
    let units = if name.ends_with("data") { "units = \"si\"\n" } else { "" };
    format!(
        "[run]\nstep = 1e-5\nend = 1.0\n[material.glass]\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\ndensity = 2500.0\n\
         [pair.glass.glass]\nrestitution = 0.7\n[contact.touch.normal.hertz]\n[particles.cloud]\nfile = \"{name}\"\n\
         materials = {{ 1 = \"glass\", 2 = \"glass\" }}\n{units}{cell}"
    )
}

#[test]
fn clouds_that_went_round_periodic_boxes_elsewhere_go_on_here() {
    // They flew for 50 ms at (3, -2, 1) m/s.
    let began = [[0.004, 0.0, 0.010], [0.020, 0.028, 0.012], [0.012, 0.005, 0.030], [0.030, 0.020, 0.024]];
    for name in ["cloud.data", "wrapped.dump", "unwrapped.dump", "scaled.dump", "both.dump"] {
        let scene =
            read_with(&imported(name, "[cell]\n"), foreign(name)).unwrap_or_else(|found| panic!("{name}: {found}"));
        let lattice = scene.cell.unwrap().lattice;
        let edges = [[0.04, 0.0, 0.0], [0.01, 0.04, 0.0], [-0.012, 0.006, 0.04]];
        for (found, expected) in lattice.edges.iter().flatten().zip(edges.iter().flatten()) {
            assert!((found - expected).abs() < 1e-15, "{name}: {lattice:?}");
        }
        assert_eq!(lattice.origin, [0.0, -0.01, 0.005], "{name}");
        let order = [0, 1, 2, 3];
        for (particle, began) in scene.particles.iter().zip(order.map(|index| began[index])) {
            let expected = [began[0] + 0.15, began[1] - 0.1, began[2] + 0.05];
            for axis in 0..3 {
                assert!((particle.position[axis] - expected[axis]).abs() < 1e-10, "{name}: {:?}", particle.position);
            }
            assert!((particle.density / if particle.id.0 == 3 { 7800.0 } else { 2500.0 } - 1.0).abs() < 1e-8);
        }
        let mut simulation = start_with(&imported(name, "[cell]\n"), foreign(name));
        simulation.advance(1e-2).unwrap();
    }
}

#[test]
fn a_box_that_is_not_the_cell_is_told() {
    let told = |name: &str, cell: &str| read_with(&imported(name, cell), foreign(name)).unwrap_err();
    let right = "[cell]\nedges = [[0.04, 0.0, 0.0], [0.01, 0.04, 0.0], [-0.012, 0.006, 0.04]]\n";
    for name in ["cloud.data", "scaled.dump"] {
        assert!(read_with(&imported(name, right), foreign(name)).is_ok());
        // The same lattice with an edge that leans the other way.
        let other = right.replace("[0.01, 0.04", "[-0.03, 0.04");
        assert!(read_with(&imported(name, &other), foreign(name)).is_ok());
        let wrong = told(name, &right.replace("0.04]]", "0.05]]"));
        assert!(wrong.contains("[-0.012, 0.006, 0.05]] m") && wrong.contains("0.006, 0.04]] m"), "{wrong}");
        let none = told(name, "");
        assert!(none.contains("a [cell] in the scene") && none.contains("a box that repeats"), "{none}");
    }
    let along = told("scaled.dump", &format!("{right}periodic = [\"x\", \"y\"]\n"));
    assert!(along.contains("along x, y, z") && along.contains("as [cell] does, along x, y"), "{along}");
    let missing = read(
        "[material.glass]\ndensity = 2500.0\n[particles.all]\nmaterial = \"glass\"\n\
                        list = [{ position = [0.0, 0.0, 0.0], radius = 0.1 }]\n[cell]\n",
    )
    .unwrap_err();
    assert!(missing.contains("three edges [x, y, z], or a file of particles that says its box"), "{missing}");
}
