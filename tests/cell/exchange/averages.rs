//! Regions and flow meters see images.

use super::scenes::{dense, scene, spheres};
use crate::support::start;
use cograin::averages;

#[test]
fn a_region_sees_images_wherever_it_stands() {
    // Boxes of one cell, of an eighth of it somewhere, and across the faces; the same displaced by edges.
    let regions = "[region.whole]\nbox = [[0.1, -0.2, 0.3], [0.15, -0.16, 0.345]]\n\
                   [region.here]\nbox = [[0.055, -0.03, -0.01], [0.07, -0.005, 0.01]]\n\
                   [region.there]\nbox = [[0.005, -0.03, -0.01], [0.02, -0.005, 0.01]]\n\
                   [region.below]\nbox = [[0.067, -0.036, -0.055], [0.082, -0.011, -0.035]]\n\
                   [region.round]\ncylinder = { from = [0.0, 0.0, -0.02], to = [0.0, 0.0, 0.025], radius = 0.01 }\n";
    let mut simulation = start(&scene(&dense(), regions));
    for step in 0..3 {
        let contents = averages::contents(&simulation);
        let all = spheres(&simulation);
        let solid: f64 = all.iter().map(|(_, r, _)| 4.0 / 3.0 * std::f64::consts::PI * r * r * r).sum();
        // Upright boxes of this size fill space as cells do, so one holds each particle once.
        assert!((contents[0].solid / solid - 1.0).abs() < 1e-12, "{} {solid}", contents[0].solid);
        for other in [2, 3] {
            assert!((contents[other].solid - contents[1].solid).abs() < 1e-12 * solid, "{step}");
            for axis in 0..3 {
                assert!((contents[other].velocity[axis] - contents[1].velocity[axis]).abs() < 1e-12, "{step}");
            }
        }
        let (carried, counts) = (averages::carried(&simulation), averages::coordination(&simulation));
        assert_eq!([counts[2], counts[3]], [counts[1]; 2]);
        assert!(counts[1].contacts > 0);
        let scale = carried[1].iter().flatten().fold(0.0_f64, |most, part| most.max(part.abs()));
        for other in [2, 3] {
            for (found, expected) in carried[other].iter().flatten().zip(carried[1].iter().flatten()) {
                assert!((found - expected).abs() < 1e-12 * scale, "{step}");
            }
        }
        simulation.advance(2e-3).unwrap();
    }
}

#[test]
fn a_region_that_is_the_cell_carries_its_stress() {
    let region = "[region.all]\nbox = [[0.01, -0.02, 0.0], [0.06, 0.02, 0.045]]\n\
                  [region.moved]\nbox = [[0.03, -0.04, 0.02], [0.08, 0.0, 0.065]]\n";
    // One sphere that touches images of itself on four sides, and many, with and without bonds; without friction and dashpots.
    let one = vec![([0.03, 0.0, 0.01], 0.0236, [0.0; 3])];
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.0075\nnormal_stiffness = 1e9\ntangential_stiffness = 5e8\n";
    for (list, more) in [(one, ""), (dense(), ""), (dense(), bond)] {
        let list: Vec<_> = list.into_iter().map(|(place, radius, _)| (place, radius, [0.0; 3])).collect();
        let text = scene(&list, &format!("{region}{more}")).replace("max_overlap = 0.3", "max_overlap = 0.9");
        let text = text.replace("restitution = 0.7\nfriction = 0.3", "restitution = 1.0\nfriction = 0.0");
        let mut simulation = start(&text);
        if !more.is_empty() {
            simulation.advance(5e-5).unwrap();
        }
        let mut stress = simulation.cell_stress();
        let volume = simulation.cell_volume();
        let particles = &simulation.state().particles;
        for slot in particles.slots() {
            let [u, v, w, mass] = particles.velocity[slot];
            for (part, moving) in stress.iter_mut().zip([u * u, v * v, w * w, u * v, u * w, v * w]) {
                *part += mass * moving / volume;
            }
        }
        let scale = stress.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        assert!(scale > 0.0);
        for carried in averages::carried(&simulation) {
            for (part, [row, column]) in stress.iter().zip([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]) {
                let found = 0.5 * (carried[row][column] + carried[column][row]) / volume;
                assert!((found - part).abs() < 1e-9 * scale, "{found} {part}");
            }
        }
        let contents = averages::contents(&simulation);
        let solid: f64 =
            spheres(&simulation).iter().map(|(_, r, _)| 4.0 / 3.0 * std::f64::consts::PI * r * r * r).sum();
        contents.iter().for_each(|it| assert!((it.solid - solid).abs() < 1e-12 * solid, "{} {solid}", it.solid));
    }
}

#[test]
fn a_flow_meter_counts_each_way_round_wherever_it_stands() {
    // Around the cell once in 1/20 s along a; 15 and a half times in 0.775 s. One comes back.
    let list = [([0.012, 0.0, 0.02], 0.002, [1.0, 0.0, 0.0]), ([0.012, 0.01, 0.02], 0.002, [-0.5, 0.0, 0.0])];
    let meter = |name: &str, [x, y, z]: [f64; 3]| {
        format!(
            "[flow_meter.{name}]\npolygon = [[{x}, {}, {}], [{x}, {}, {}], [{x}, {}, {}], [{x}, {}, {}]]\n",
            y - 0.015,
            z - 0.01,
            y + 0.015,
            z - 0.01,
            y + 0.015,
            z + 0.01,
            y - 0.015,
            z + 0.01
        )
    };
    // At the place where they begin, at a face, and more than a cell away.
    let meters = meter("here", [0.02, 0.005, 0.02])
        + &meter("face", [0.0602, 0.005, 0.02])
        + &meter("far", [0.33, 0.005 - 0.04, 0.02]);
    let mut simulation = start(&scene(&list, &meters));
    for _ in 0..31 {
        simulation.advance(0.025).unwrap();
    }
    let exchange = simulation.state().exchange.as_ref().unwrap();
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.002_f64.powi(3);
    let ways = [(0.775 - 0.008) / 0.05, (0.775 - 0.0482) / 0.05, (0.775 - 0.028) / 0.05];
    let back = [(0.3875 - 0.042) / 0.05, (0.3875 - 0.0018) / 0.05, (0.3875 - 0.022) / 0.05];
    for ((meter, way), back) in exchange.meters.iter().zip(ways).zip(back) {
        let expected = [way, back].map(|way: f64| way.floor() as u64 + 1);
        assert_eq!(meter.counts, expected);
        let net = mass * (expected[0] as f64 - expected[1] as f64);
        assert!((meter.mass - net).abs() < 1e-12 * net.abs(), "{} {net}", meter.mass);
    }
}
