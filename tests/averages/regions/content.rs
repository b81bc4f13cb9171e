//! Porosity, temperature and stress of what is in a region, its variables and what it follows.

use super::scenes::{ALL, PLANES, PRESSED, bed, bed_with, less, spheres};
use crate::support::{start, value};
use cograin::interface::{Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

#[test]
fn porosity_of_a_sphere_cut_by_a_plane_an_edge_and_a_corner_is_that_of_closed_forms() {
    let radius = 0.2_f64;
    let corner = |a: f64, b: f64, c: f64| {
        let box_to = |from: f64| 0.3 + radius * from;
        format!("[region.r]\nbox = [[{:?}, {:?}, {:?}], [1.3, 1.3, 1.3]]\n", box_to(a), box_to(b), box_to(c))
    };
    let cap = |c: f64| PI * (1.0 - c).powi(2) * (2.0 + c) / 3.0;
    // Parts of the unit sphere beyond x = a, y = b, z = c. An edge through the centre halves a cap, a corner with one face off
    // the centre quarters it; the others are integrals with 30 digits.
    let cases = [
        ([-1.4, -1.2, 0.35], cap(0.35)),
        ([-0.6, -1.5, -1.5], cap(-0.6)),
        ([0.0, -1.5, 0.35], cap(0.35) / 2.0),
        ([0.3, 0.5, -1.5], 0.152_345_774_168_150_46),
        ([-0.3, -0.5, -1.5], 2.506_445_869_258_102),
        ([0.0, 0.0, 0.35], cap(0.35) / 4.0),
        ([0.2, 0.3, 0.4], 0.069_436_398_976_012_31),
        ([-0.6, 0.3, -0.7], 1.042_725_348_087_817_1),
    ];
    for ([a, b, c], part) in cases {
        let simulation = spheres(&[([0.3; 3], radius, [0.0; 3])], &corner(a, b, c));
        let volume = [a, b, c].iter().map(|from| 1.0 - radius * from).product::<f64>();
        let found = (1.0 - value(&simulation, "r.porosity")) * volume / radius.powi(3);
        assert!((found - part).abs() < 1e-13, "{:?}: {found:?}, {part:?} expected", [a, b, c]);
        let mass = 1000.0 * part * radius.powi(3);
        assert!((value(&simulation, "r.mass") - mass).abs() < 1e-12 * mass.max(1.0));
    }
}

#[test]
fn porosity_of_a_bed_of_many_sizes_is_that_of_chance() {
    let regions = "
[region.block]
box = [[0.0031, 0.0057, 0.0083], [0.0289, 0.0331, 0.0277]]
[region.core]
cylinder = { from = [0.01, 0.012, 0.006], to = [0.03, 0.025, 0.035], radius = 0.011 }
";
    let mut simulation = bed(PLANES, regions);
    simulation.advance(2e-3).expect("it runs");
    let spheres = simulation.state().particles.position.clone();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut uniform = || random.next_u64() as f64 / u64::MAX as f64;
    const SAMPLES: u32 = 300_000;
    for (region, name) in simulation.scene().regions.iter().zip(["block", "core"]) {
        let (mut inside, mut sum, mut squares) = (0_u32, 0.0, 0.0);
        for _ in 0..SAMPLES {
            let place = [0.04 * uniform(), 0.04 * uniform(), 0.04 * uniform()];
            if !region.shape.holds(place.into()) {
                continue;
            }
            inside += 1;
            let holds = |[x, y, z, radius]: &&[f64; 4]| {
                less(place, [*x, *y, *z]).iter().map(|part| part * part).sum::<f64>() < radius * radius
            };
            let count = spheres.iter().filter(holds).count() as f64;
            (sum, squares) = (sum + count, squares + count * count);
        }
        let number = f64::from(inside);
        let (mean, deviation) = (sum / number, ((squares / number - (sum / number).powi(2)) / number).sqrt());
        let found = 1.0 - value(&simulation, &format!("{name}.porosity"));
        assert!((found - mean).abs() < 4.0 * deviation, "{name}: {found}, {mean} ± {deviation} expected");
        assert!(deviation < 2e-3 && (0.3..0.8).contains(&found), "{name}: {found} ± {deviation}");
        let volume = number / f64::from(SAMPLES) * 0.04_f64.powi(3);
        assert!((region.shape.volume() / volume - 1.0).abs() < 0.03, "{name}");
    }
}

#[test]
fn two_grains_have_the_temperature_and_the_stress_of_their_motion() {
    let mass = 1000.0 * 4.0 / 3.0 * PI * 1e-3;
    let list = [([0.5, 0.5, 0.5], 0.1, [1.0, 0.0, 3.0]), ([1.5, 0.5, 0.5], 0.1, [-1.0, 2.0, 3.0])];
    let simulation = spheres(&list, "[region.r]\nbox = [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]]\n");
    // Mean (0, 1, 3), differences ±(1, −1, 0).
    let expected = [
        ("r.mass", 2.0 * mass),
        ("r.velocity.x", 0.0),
        ("r.velocity.y", 1.0),
        ("r.velocity.z", 3.0),
        ("r.granular_temperature", 2.0 / 3.0),
        ("r.stress.xx", -mass),
        ("r.stress.yy", -mass),
        ("r.stress.zz", 0.0),
        ("r.stress.xy", mass),
        ("r.stress.xz", 0.0),
        ("r.stress.yz", 0.0),
        ("r.coordination", 0.0),
        ("r.porosity", 1.0 - 4.0 / 3.0 * PI * 1e-3),
    ];
    for (name, expected) in expected {
        let found = value(&simulation, name);
        assert!((found - expected).abs() < 1e-14 * mass, "{name}: {found:?}, {expected:?} expected");
    }
}

#[test]
fn an_empty_region_has_no_stress_and_no_motion() {
    let simulation = spheres(&[([0.5; 3], 0.1, [1.0; 3])], "[region.r]\nbox = [[2.0, 2.0, 2.0], [3.0, 3.0, 3.0]]\n");
    let interface = Interface::of(simulation.scene());
    for (index, variable) in interface.outputs().filter(|(_, variable)| variable.name.starts_with("r.")) {
        let expected = match variable.name.as_str() {
            "r.porosity" => Value::Real(1.0),
            name if name.starts_with("r.count") => Value::Integer(0),
            _ => Value::Real(0.0),
        };
        assert_eq!(interface.value(&simulation, index), expected, "{}", variable.name);
    }
}

#[test]
fn what_presses_is_below_zero_and_the_force_of_the_particles_on_a_wall_is_stress_times_its_normal() {
    let simulation = start(&format!("{PRESSED}[region.r]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\n"));
    let (floor, lid) = (value(&simulation, "floor.force.z"), value(&simulation, "lid.force.z"));
    assert!(floor < 0.0 && (floor + lid).abs() < 1e-15 * lid);
    // From one point of contact to the other, half an overlap behind each wall: 0.01998 + 0.00001 m.
    let (found, expected) = (value(&simulation, "r.stress.zz"), floor * 0.01999 / 8.0);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found}, {expected} expected");
    assert_eq!(value(&simulation, "r.coordination"), 2.0);
}

#[test]
fn a_region_goes_with_the_boundary_that_it_follows() {
    let regions = "
[region.still]
box = [[0.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
[region.moving]
box = [[0.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
follows = \"lid\"
";
    let mut simulation = start(&format!("{PRESSED}{regions}"));
    let part = |simulation: &Simulation, name: &str| {
        (1.0 - value(simulation, &format!("{name}.porosity"))) * 4.0 / (0.01_f64).powi(3)
    };
    let half = 2.0 / 3.0 * PI;
    for name in ["still", "moving"] {
        assert!((part(&simulation, name) - half).abs() < 1e-9);
    }
    simulation.set_input(BoundaryIndex(1), 0, 0.004);
    simulation.advance(1e-4).expect("it runs");
    // 4 mm are 0.4 of the radius. The porosity is rounded to 1e-16, 1e-10 of the volume of the sphere.
    let cap = PI * 0.6_f64.powi(2) * 2.4 / 3.0;
    let [still, moving] = ["still", "moving"].map(|name| part(&simulation, name));
    assert!((still - half).abs() < 1e-9 && (moving - cap).abs() < 1e-9, "{still}, {moving}; {half}, {cap} expected");
}

#[test]
fn looking_changes_nothing_and_any_number_of_threads_sees_the_same() {
    let more = format!(
        "{ALL}[region.core]\ncylinder = {{ from = [0.02, 0.02, 0.0], to = [0.02, 0.02, 0.03], radius = 0.01 }}\n"
    );
    let outputs = |threads: usize, more: &str| {
        let mut simulation = bed_with(threads, "[0.0012, 0.0014]", PLANES, more);
        simulation.advance(2e-3).expect("it runs");
        let interface = Interface::of(simulation.scene());
        let values: Vec<u64> =
            interface.outputs().map(|(index, _)| interface.value(&simulation, index).number().to_bits()).collect();
        simulation.advance(1e-3).expect("it runs");
        assert_eq!(simulation.threads(), threads);
        (values, simulation.state().particles.position.clone())
    };
    let (one, three) = (outputs(1, &more), outputs(3, &more));
    assert_eq!(one, three);
    assert_eq!(one.1, outputs(1, "").1);
}

#[test]
fn the_variables_of_a_region_stand_between_those_of_the_boundaries_and_of_the_scene() {
    let names = |more: &str| -> Vec<String> {
        let simulation = bed(PLANES, more);
        Interface::of(simulation.scene()).variables().iter().map(|variable| variable.name.clone()).collect()
    };
    let (with, without) = (names(ALL), names(""));
    let own = [
        "stress.xx",
        "stress.yy",
        "stress.zz",
        "stress.xy",
        "stress.xz",
        "stress.yz",
        "porosity",
        "coordination",
        "granular_temperature",
        "mass",
        "velocity.x",
        "velocity.y",
        "velocity.z",
        "count",
        "count_by_set.grains",
    ];
    let first = with.iter().position(|name| name.starts_with("all.")).expect("the region has variables");
    assert_eq!(with[first..first + own.len()], own.map(|name| format!("all.{name}")));
    assert_eq!(with[first + own.len()], "energy.kinetic");
    let others: Vec<&String> = with.iter().filter(|name| !name.starts_with("all.")).collect();
    assert_eq!(others, without.iter().collect::<Vec<_>>());
}
