//! Regions, flow meters, insertions, outlets, packings and files beside a periodic cell.

use crate::support::{Files, read, read_with, start, start_with};
use cograin::averages;
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use std::fmt::Write as _;

/// Edges of a cell that leans.
const LEANING: [[f64; 3]; 3] = [[0.05, 0.0, 0.0], [0.01, 0.04, 0.0], [-0.012, 0.006, 0.045]];

/// A scene of spheres in a cell that leans, with these further lines.
fn scene(list: &[([f64; 3], f64, [f64; 3])], rest: &str) -> String {
    let mut text = "[run]\nstep = 1e-5\nend = 1.0\nmax_overlap = 0.3\n[material.glass]\nyoungs_modulus = 1e7\n\
        poissons_ratio = 0.25\ndensity = 2500.0\n[pair.glass.glass]\nrestitution = 0.7\nfriction = 0.3\n\
        [contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[output]\nenergy = true\nlosses = true\n"
        .to_owned();
    if !list.is_empty() {
        text += "[particles.all]\nmaterial = \"glass\"\nlist = [\n";
        for (position, radius, velocity) in list {
            let _ = writeln!(text, "{{ position = {position:?}, radius = {radius:?}, velocity = {velocity:?} }},");
        }
        text += "]\n";
    }
    let _ = write!(text, "{rest}\n[cell]\norigin = [0.01, -0.02, 0.0]\n");
    if !rest.contains("edges_of_file") { text + &format!("edges = {LEANING:?}\n") } else { text }
}

/// The vector to one of the particles from the nearest image of another.
fn nearest(a: [f64; 3], b: [f64; 3], periodic: [bool; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for shift in 0..7 * 7 * 7 {
        let shift = [shift % 7 - 3, shift / 7 % 7 - 3, shift / 49 - 3];
        if (0..3).any(|edge| shift[edge] != 0 && !periodic[edge]) {
            continue;
        }
        let apart = [0, 1, 2].map(|axis: usize| {
            a[axis] - b[axis] + (0..3).map(|edge| f64::from(shift[edge]) * LEANING[edge][axis]).sum::<f64>()
        });
        least = least.min(apart.iter().map(|part| part * part).sum::<f64>().sqrt());
    }
    least
}

/// Places, radii and velocities of the particles.
fn spheres(simulation: &Simulation) -> Vec<([f64; 3], f64, [f64; 3])> {
    let particles = &simulation.state().particles;
    let rows = particles.slots().map(|slot| (particles.position[slot], particles.velocity[slot]));
    rows.map(|([x, y, z, radius], [u, v, w, _])| ([x, y, z], radius, [u, v, w])).collect()
}

/// The least gap between two spheres, images included, over the smaller radius.
fn least_gap(spheres: &[([f64; 3], f64)], periodic: [bool; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for (index, (a, r)) in spheres.iter().enumerate() {
        for (b, s) in &spheres[..index] {
            least = least.min((nearest(*a, *b, periodic) - r - s) / r.min(*s));
        }
    }
    least
}

/// A packing that fills the cell.
fn packed(more: &str) -> String {
    scene(&[], &format!("[particles.all]\nmaterial = \"glass\"\npacking = {{ {more} }}\n"))
}

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

/// Spheres on both sides of the faces that press on each other.
fn dense() -> Vec<([f64; 3], f64, [f64; 3])> {
    let text = packed("solid_fraction = 0.55, radius = [0.003, 0.004]");
    let particles = read(&text).unwrap().into_draft().particles;
    let wave = |part: f64| (1e3 * part).sin();
    let larger = |particle: &cograin::scene::Particle| {
        let [x, y, z] = particle.position;
        (particle.position, 1.04 * particle.radius, [wave(x), wave(y + z), wave(z - x)])
    };
    particles.iter().map(larger).collect()
}

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

/// Spheres that come into a region across the corner of a cell.
fn filling(more: &str) -> String {
    let rest = format!(
        "[region.corner]\nbox = [[-0.01, -0.045, -0.02], [0.045, 0.0, 0.025]]\n\
         [insertion.feed]\nregion = \"corner\"\nmaterial = \"glass\"\nsizes = {{ uniform = [0.002, 0.004] }}\n{more}\n"
    );
    let apart: Vec<_> = dense().into_iter().take(20).map(|(place, radius, way)| (place, 0.95 * radius, way)).collect();
    scene(&apart, &rest)
}

#[test]
fn what_comes_finds_room_among_images() {
    let mut simulation = start(&filling("mass = 0.05"));
    for _ in 0..20 {
        simulation.advance(5e-5).unwrap();
        let all: Vec<_> = spheres(&simulation).into_iter().map(|(place, radius, _)| (place, radius)).collect();
        // Within 50 µs at 1 m/s nothing comes nearer by more than 0.1 mm.
        assert!(least_gap(&all, [true; 3]) > -0.1);
    }
    let came = simulation.state().exchange.as_ref().unwrap().feeds[0].came;
    assert!(came.count > 30, "{}", came.count);
    for _ in 0..20 {
        simulation.advance(2e-3).unwrap();
    }
    let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
    assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * turnover);
    let cell = simulation.state().cell.as_ref().unwrap();
    assert_eq!(cell.edges_away.len(), simulation.state().particles.slot.len());
}

#[test]
fn what_comes_and_goes_through_the_faces_gives_the_same_bits() {
    let rest = "count_rate = 20000.0\nvelocity = [2.0, -1.0, 0.5]\nscatter = 0.5\n\
                [region.hole]\nbox = [[0.1, -0.05, -0.03], [0.12, -0.02, 0.02]]\n[outlet.out]\nregion = \"hole\"\n\
                [flow_meter.face]\npolygon = [[0.06, -0.1, -0.1], [0.06, 0.1, -0.1], [0.06, 0.1, 0.1], [0.06, -0.1, 0.1]]\n";
    let text = |threads: usize| {
        let motion = "motion = { driven = [\"xx\", \"zz\"], shear = \"xz\" }\n";
        filling(rest).replace("[run]\nstep = 1e-5", &format!("[run]\nthreads = {threads}\nstep = 4e-6")) + motion
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let begin = || {
            let mut simulation = start(&text(threads));
            simulation.set_width(width);
            simulation
        };
        let mut simulation = begin();
        for step in 0..8 {
            simulation.set_strain(0, -0.01 * f64::from(step));
            simulation.set_strain(4, 0.1 * f64::from(step));
            simulation.advance(2e-3).unwrap();
            if kept && step == 4 {
                let state = simulation.state().clone();
                simulation = begin();
                simulation.restore(&state).unwrap();
            }
        }
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    let exchange = first.exchange.as_ref().unwrap();
    assert!(exchange.outlets[0].count > 10 && exchange.feeds[0].came.count > 50, "{exchange:?}");
    assert!(exchange.meters[0].counts[0] > 10);
    assert!(!first.particles.free.is_empty() || exchange.feeds[0].came.count > exchange.outlets[0].count);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn clumps_come_and_go_through_the_faces_as_spheres_do() {
    let shape = "[clump.pair]\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]\n";
    let rest = "count_rate = 20000.0\nvelocity = [2.0, -1.0, 0.5]\nscatter = 0.5\n\
                [region.hole]\nbox = [[0.1, -0.05, -0.03], [0.12, -0.02, 0.02]]\n[outlet.out]\nregion = \"hole\"\n\
                [flow_meter.face]\npolygon = [[0.06, -0.1, -0.1], [0.06, 0.1, -0.1], [0.06, 0.1, 0.1], [0.06, -0.1, 0.1]]\n";
    let run = |threads: usize, width: Width, kept: bool| {
        let begin = || {
            let text = filling(rest).replace("[run]\nstep = 1e-5", &format!("[run]\nthreads = {threads}\nstep = 4e-6"));
            let text = text
                .replace("sizes = {", "sizes = { clump = \"pair\",")
                .replace("[region.corner]", &format!("{shape}[region.corner]"));
            let mut simulation = start(&text);
            simulation.set_width(width);
            simulation
        };
        let mut simulation = begin();
        for step in 0..8 {
            simulation.advance(2e-3).unwrap();
            if kept && step == 4 {
                let state = simulation.state().clone();
                simulation = begin();
                simulation.restore(&state).unwrap();
            }
        }
        let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
        assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * turnover);
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    let exchange = first.exchange.as_ref().unwrap();
    assert!(exchange.feeds[0].came.clumps > 20 && exchange.outlets[0].clumps > 5, "{exchange:?}");
    assert_eq!(first.cell.as_ref().unwrap().edges_away.len(), first.particles.slot.len());
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn an_outlet_takes_what_has_an_image_in_it() {
    let outlet = "[region.gate]\nbox = [[0.157, -0.02, 0.0], [0.163, 0.05, 0.045]]\n[outlet.out]\nregion = \"gate\"\n";
    // The gate is the face at x = 0.06 two cells away; one flies along it, the other through it.
    let list = [([0.03, 0.0, 0.02], 0.002, [0.0, 1.0, 0.0]), ([0.02, 0.0, 0.02], 0.002, [1.0, 0.0, 0.0])];
    let mut simulation = start(&scene(&list, outlet));
    for _ in 0..20 {
        simulation.advance(2e-3).unwrap();
    }
    let exchange = simulation.state().exchange.as_ref().unwrap();
    assert_eq!(exchange.outlets[0].count, 1);
    assert_eq!(simulation.state().particles.slots().count(), 1);
    let refused = read(&scene(&list, "[outlet.all]\nbeyond = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n"));
    assert!(refused.unwrap_err().contains("one that crosses them"));
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
