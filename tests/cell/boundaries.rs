//! Surfaces and groups beside a periodic cell: they go on through its faces.

use crate::support::{Files, read_with, start_with};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use std::fmt::Write as _;

/// Edge of the cells \[m\].
const EDGE: f64 = 0.04;

/// A cell with these edges that repeats along these.
fn cell(edges: [[f64; 3]; 3], periodic: &str) -> String {
    format!("[cell]\nedges = {edges:?}\nperiodic = {periodic}\n")
}

/// A box whose edge b leans.
fn leaning() -> [[f64; 3]; 3] {
    [[EDGE, 0.0, 0.0], [0.01, EDGE, 0.0], [0.0, 0.0, EDGE]]
}

/// Spheres of 3 mm with velocities and spins, above what these lines say.
fn scene(list: &[[[f64; 3]; 3]], rest: &str) -> String {
    let mut text = "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 2e-6\nmax_overlap = 0.3\n[material.glass]\n\
        youngs_modulus = 5e6\npoissons_ratio = 0.25\ndensity = 2500.0\n[pair.glass.glass]\nrestitution = 0.7\n\
        friction = 0.4\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[output]\nenergy = true\n\
        [particles.all]\nmaterial = \"glass\"\nlist = [\n"
        .to_owned();
    for [place, velocity, spin] in list {
        let _ = writeln!(
            text,
            "{{ position = {place:?}, radius = 0.003, velocity = {velocity:?}, angular_velocity = {spin:?} }},"
        );
    }
    text + "]\n" + rest
}

/// Triangles of a sheet over so many steps along two vectors, whose height is this over parts of a cell.
fn sheet(edges: [[f64; 3]; 2], cells: [[i32; 2]; 2], height: fn(i32, i32) -> f64) -> Vec<[[f64; 3]; 3]> {
    let steps = 4;
    let at = |i: i32, j: i32| {
        let [u, v] = [i, j].map(|step| f64::from(step) / f64::from(steps));
        let [x, y] = [0, 1].map(|axis| u * edges[0][axis] + v * edges[1][axis]);
        [x, y, height(i.rem_euclid(steps), j.rem_euclid(steps))]
    };
    let [[left, right], [front, back]] = cells.map(|range| range.map(|cell| cell * steps));
    let mut triangles = Vec::new();
    for i in left..right {
        for j in front..back {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    triangles
}

/// An OBJ file of triangles.
fn obj(triangles: &[[[f64; 3]; 3]]) -> Files {
    let mut text = String::new();
    for [x, y, z] in triangles.iter().flatten() {
        let _ = writeln!(text, "v {x:.17e} {y:.17e} {z:.17e}");
    }
    for first in (1..=3 * triangles.len()).step_by(3) {
        let _ = writeln!(text, "f {first} {} {}", first + 1, first + 2);
    }
    Files::from([("floor.obj".to_owned(), text.into_bytes())])
}

/// Bumps that go on through the faces.
fn bumpy(i: i32, j: i32) -> f64 {
    [[0.0, 0.001, 0.0005, -0.001], [0.0015, 0.0, -0.0005, 0.001], [-0.001, 0.0008, 0.0, 0.0], [0.0, 0.0, 0.0012, 0.0]]
        [i as usize][j as usize]
}

/// Velocities and spins of the scene's particles, and how far they went without being brought back.
fn motion(simulation: &Simulation) -> Vec<f64> {
    let particles = &simulation.state().particles;
    let mut found = Vec::new();
    for (index, &slot) in particles.slot.iter().enumerate() {
        let slot = slot as usize;
        let mut place: [f64; 3] = std::array::from_fn(|axis| particles.position[slot][axis]);
        if let Some(cell) = &simulation.state().cell {
            for (count, edge) in cell.edges_away[index].iter().zip(cell.edges) {
                (0..3).for_each(|axis| place[axis] += *count as f64 * edge[axis]);
            }
        }
        found.extend(place);
        found.extend(&particles.velocity[slot][..3]);
        found.extend(particles.angular_velocity[slot][..3].iter().map(|spin| 0.003 * spin));
    }
    found
}

/// Advances both, and compares motions; returns how many faces were crossed.
#[track_caller]
fn assert_alike(mut closed: Simulation, mut open: Simulation, steps: usize, tolerance: f64) -> i64 {
    for step in 0..steps {
        closed.advance(2e-3).unwrap();
        open.advance(2e-3).unwrap();
        let (found, expected) = (motion(&closed), motion(&open));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < tolerance, "{step}: {found:?} {expected:?}");
        }
    }
    closed.state().cell.as_ref().unwrap().edges_away.iter().flatten().map(|count| count.abs()).sum()
}

#[test]
fn a_ball_rolls_over_the_seam_of_a_flat_floor_as_over_a_plane() {
    let ball = [[0.01, 0.035, 0.00299], [0.9, 0.5, 0.0], [0.0, 0.0, 0.0]];
    let [a, b, _] = leaning();
    let floors = [
        "mesh = { file = \"floor.obj\" }".to_owned(),
        "mesh = { file = \"floor.obj\", sides = 1 }".to_owned(),
        // One that is not over the cell, but whose copies are.
        "mesh = { file = \"floor.obj\", offset = [0.055, -0.03, 0.0] }".to_owned(),
    ];
    let boundary = |shape: &str| format!("[boundary.floor]\nmaterial = \"glass\"\n{shape}\n");
    let plane = boundary("plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }");
    let flat = || obj(&sheet([a, b], [[0, 1], [0, 1]], |_, _| 0.0));
    for shape in floors {
        let rest = boundary(&shape) + &cell(leaning(), "[\"x\", \"y\"]");
        let closed = start_with(&scene(&[ball], &rest), flat());
        let crossed = assert_alike(closed, start_with(&scene(&[ball], &plane), Files::new()), 60, 1e-10);
        assert!(crossed >= 3, "{crossed} faces");
    }
    let plate = boundary(&format!(
        "rectangle = {{ corner = [0.0, 0.0, 0.0], edges = [[{EDGE}, 0.0, 0.0], [0.0, {EDGE}, 0.0]] }}"
    ));
    let rest = plate + &cell([a, [0.0, EDGE, 0.0], [0.0, 0.0, EDGE]], "[\"x\", \"y\"]");
    let closed = start_with(&scene(&[ball], &rest), Files::new());
    assert!(assert_alike(closed, start_with(&scene(&[ball], &plane), Files::new()), 60, 1e-10) >= 3);
}

#[test]
fn bumps_at_the_seam_are_those_of_a_floor_that_goes_on() {
    // Two balls that meet nothing but the floor: one rolls and jumps over bumps, one over bends along the faces.
    let balls = [
        [[0.01, 0.035, 0.0045], [0.45, 0.25, 0.0], [0.0, 50.0, 0.0]],
        [[0.0105, 0.0102, 0.0045], [-0.5, 0.02, 0.0], [0.0, 0.0, 0.0]],
    ];
    let [a, b, _] = leaning();
    let floor = "[boundary.floor]\nmaterial = \"glass\"\nmesh = { file = \"floor.obj\" }\n";
    for (sides, which) in [("", 0..1), (", sides = 1", 0..1), ("", 1..2)] {
        let floor = floor.replace(" }", &format!("{sides} }}"));
        let list = &balls[which];
        let rest = floor.clone() + &cell(leaning(), "[\"x\", \"y\"]");
        let closed = start_with(&scene(list, &rest), obj(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
        let open = start_with(&scene(list, &floor), obj(&sheet([a, b], [[-3, 5], [-3, 5]], bumpy)));
        assert!(assert_alike(closed, open, 60, 1e-6) >= 1);
    }
}

#[test]
fn a_platen_that_goes_through_the_faces_carries_what_lies_on_it() {
    // Three edges along x and one back along b, over bumps.
    let balls = [[[0.01, 0.015, 0.0047], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]];
    let [a, b, _] = leaning();
    let floor = "[boundary.floor]\nmaterial = \"glass\"\nmesh = { file = \"floor.obj\" }\n\
                 motion = { prescribed = { x = 1.1, y = -0.35 } }\n";
    let rest = floor.to_owned() + &cell(leaning(), "[\"x\", \"y\"]");
    let closed = start_with(&scene(&balls, &rest), obj(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
    let open = start_with(&scene(&balls, floor), obj(&sheet([a, b], [[-6, 6], [-4, 6]], bumpy)));
    assert_alike(closed, open, 60, 1e-6);
}

#[test]
fn posts_and_discs_stand_in_each_cell() {
    let shapes = [
        "cylinder = { from = [0.035, 0.012, -0.01], to = [0.035, 0.012, 0.03], radius = 0.004, caps = \"both\" }",
        "disc = { centre = [0.036, 0.012, 0.01], normal = [1.0, 0.5, 0.0], radius = 0.006 }",
        "revolution = { origin = [0.035, 0.012, 0.0], axis = [0.0, 0.0, 1.0], profile = [[0.0, 0.0], [0.006, 0.01], [0.0, 0.02]] }",
    ];
    // Bounces between the post and its image at the left, and slides under both.
    let ball = [[0.012, 0.0125, 0.01], [-1.3, 0.02, 0.0], [0.0, 0.0, 20.0]];
    for shape in shapes {
        let post = format!("[boundary.post]\nmaterial = \"glass\"\n{shape}\n");
        let image = post.replace("boundary.post", "boundary.image").replace("[0.03", "[-0.00");
        let image = image.replace("[-0.005,", &format!("[{:?},", 0.035 - EDGE));
        let image = image.replace("[-0.006,", &format!("[{:?},", 0.036 - EDGE));
        let rest = post.clone() + &cell(leaning(), "[\"x\", \"y\"]");
        let weightless = |text: String| text.replace("-9.81", "0.0");
        let closed = start_with(&weightless(scene(&[ball], &rest)), Files::new());
        let open = start_with(&weightless(scene(&[ball], &(post + &image))), Files::new());
        let crossed = assert_alike(closed, open, 20, 1e-9);
        assert!(crossed <= 1, "{crossed}");
    }
}

#[test]
fn a_drum_turns_along_the_one_edge_that_repeats() {
    let ball = [[0.01, 0.003, -0.0165], [0.4, 0.0, 0.0], [0.0, 0.0, 0.0]];
    let drum = |length: &str| {
        format!(
            "[boundary.drum]\nmaterial = \"glass\"\ncylinder = {{ from = [0.0, 0.0, 0.0], to = [{EDGE}, 0.0, 0.0], \
             radius = 0.02{length} }}\nmotion = {{ prescribed = {{ \"rotation.x\" = 6.0 }} }}\n"
        )
    };
    let edges = [[EDGE, 0.0, 0.0], [0.0, EDGE, 0.0], [0.0, 0.0, EDGE]];
    let open = || start_with(&scene(&[ball], &drum(", infinite = true")), Files::new());
    for length in ["", ", infinite = true"] {
        let rest = drum(length) + &cell(edges, "[\"x\"]");
        let closed = start_with(&scene(&[ball], &rest), Files::new());
        assert!(assert_alike(closed, open(), 100, 1e-9) >= 1);
    }
    let rest = drum("") + &cell(edges, "[\"x\", \"y\"]");
    let told = read_with(&scene(&[ball], &rest), Files::new()).unwrap_err();
    assert!(told.contains("turns only about the one edge that repeats"), "{told}");
}

/// Spheres in a row along x, fixed to one another, that fill a cell or several.
fn row(cells: [i32; 2]) -> Vec<[[f64; 3]; 3]> {
    let at = |k: i32| [[0.002 + 0.005 * f64::from(k), 0.01, if k % 2 == 0 { 0.0 } else { 0.0015 }], [0.0; 3], [0.0; 3]];
    (8 * cells[0]..8 * cells[1]).map(at).collect()
}

#[test]
fn a_group_goes_through_the_faces_as_one_body() {
    let ball = [[0.0095, 0.0104, 0.0062], [0.1, 0.0, 0.0], [0.0; 3]];
    let motions = [
        "prescribed = { x = -0.6 }",
        "prescribed = { x = { sine = { amplitude = 0.03, frequency = 9.0 } } }",
        "prescribed = { x = 0.5 }, servo = { z = { target = -2.0, speed = 0.05 } }",
    ];
    for motion in motions {
        let text = |cells: [i32; 2], rest: &str| {
            let mut list = vec![ball];
            list.extend(row(cells));
            let group = format!(
                "[boundary.base]\nparticles = {{ box = [[-1.0, -1.0, -0.001], [1.0, 1.0, 0.002]] }}\nmotion = {{ {motion} }}\n"
            );
            scene(&list, &(group + rest))
        };
        let rails = "[boundary.front]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0065, 0.0], normal = [0.0, 1.0, 0.0] }\n\
                     [boundary.back]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0135, 0.0], normal = [0.0, -1.0, 0.0] }\n\
                     [boundary.lid]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0, 0.0095], normal = [0.0, 0.0, -1.0] }\n";
        let closed = text([0, 1], &(rails.to_owned() + &cell(leaning(), "[\"x\"]")));
        let (mut closed, mut open) =
            (start_with(&closed, Files::new()), start_with(&text([-3, 4], rails), Files::new()));
        for _ in 0..40 {
            closed.advance(2e-3).unwrap();
            open.advance(2e-3).unwrap();
            let (found, expected) = (motion_of_first(&closed), motion_of_first(&open));
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-7, "{motion}: {found:?} {expected:?}");
            }
            let force = |simulation: &Simulation| simulation.state().boundaries[0].mean_force;
            for (found, expected) in force(&closed).iter().zip(force(&open)) {
                assert!((found - expected).abs() < 1e-5, "{motion}: {found:?} {expected:?}");
            }
        }
        let cell = closed.state().cell.as_ref().unwrap();
        let crossed: i64 = cell.edges_away.iter().map(|away| away[0].abs()).sum();
        assert!(crossed >= 3, "{motion}: {crossed}");
    }
}

/// Motion of the first particle.
fn motion_of_first(simulation: &Simulation) -> Vec<f64> {
    motion(simulation)[..9].to_vec()
}

#[test]
fn a_rigid_body_that_flies_and_turns_through_the_faces_does_what_it_does_in_the_open() {
    let mut list = vec![[[0.045, 0.021, 0.003], [-3.0, 1.0, 2.0], [0.0; 3]]];
    for [x, y, z] in [[0.0, 0.0, 0.0], [0.005, 0.0, 0.0], [0.0, 0.004, 0.0], [0.0, 0.0, 0.005]] {
        list.push([[0.03 + x, 0.02 + y, 0.003 + z], [1.0, 0.4, -0.6], [0.0; 3]]);
    }
    let group = "[boundary.body]\nparticles = { box = [[0.025, 0.0, 0.0], [0.037, 0.03, 0.03]] }\n\
                 motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n";
    let text = |rest: &str| scene(&list, &(group.to_owned() + rest)).replace("-9.81", "0.0");
    let closed = start_with(&text(&cell(leaning(), "[\"x\", \"y\", \"z\"]")), Files::new());
    // They meet once, before either meets an image.
    let open = start_with(&text(""), Files::new());
    assert!(open.elastic_energy() == 0.0);
    assert!(assert_alike(closed, open, 6, 1e-9) >= 4);
}

#[test]
fn a_force_on_a_sphere_of_a_group_turns_it_through_the_faces_as_in_the_open() {
    let mut list = Vec::new();
    for [x, y, z] in [[0.0, 0.0, 0.0], [0.005, 0.0, 0.0], [0.0, 0.004, 0.0], [0.0, 0.0, 0.005]] {
        list.push([[0.03 + x, 0.02 + y, 0.003 + z], [1.0, 0.4, -0.6], [0.0; 3]]);
    }
    let rest = "[force.push]\nparticles = { ids = [2] }\nforce = [0.0, 0.02, 0.01]\n\
                [damping.all]\nlinear = 0.1\nangular = 0.2\ngravity_damped = true\napplied_forces_damped = true\n\
                [boundary.body]\nparticles = { box = [[0.025, 0.0, 0.0], [0.037, 0.03, 0.03]] }\n\
                motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n";
    let text = |more: &str| scene(&list, &(rest.to_owned() + more)).replace("-9.81", "0.0");
    let closed = start_with(&text(&cell(leaning(), "[\"x\", \"y\", \"z\"]")), Files::new());
    assert!(assert_alike(closed, start_with(&text(""), Files::new()), 10, 1e-9) >= 4);
}

#[test]
fn the_books_of_a_rigid_body_astride_a_face_close_and_its_stable_step_is_that_of_one_that_is_not() {
    let text = |shift: f64| {
        let mut list = vec![[[0.022 + shift, 0.0215, 0.013], [0.1, 0.0, -1.0], [0.0; 3]]];
        for [x, z] in [[0.0, 0.0], [0.005, 0.002]] {
            list.push([[0.0175 + x + shift, 0.02, 0.0029 + z], [0.3, 0.0, -1.0], [0.0; 3]]);
        }
        let group = "[boundary.body]\nparticles = { ids = [2, 3] }\n\
                     motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }\n\
                     [boundary.floor]\nmaterial = \"glass\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
        let edges = [[EDGE, 0.0, 0.0], [0.0, EDGE, 0.0], [0.0, 0.0, EDGE]];
        scene(&list, &(group.to_owned() + &cell(edges, "[\"x\", \"y\"]")))
    };
    let inside = start_with(&text(0.0), Files::new());
    for shift in [-0.0222, 0.02, 1.02] {
        let mut astride = start_with(&text(shift), Files::new());
        let (stable, expected) = (astride.stable_step(), inside.stable_step());
        assert!((stable / expected - 1.0).abs() < 1e-9, "{shift}: {stable} {expected}");
        astride.advance(0.02).unwrap();
        let ledger = astride.state().ledger.as_ref().unwrap();
        let residual = astride.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * ledger.turnover, "{shift}: {residual} of {}", ledger.turnover);
    }
}

/// A bed on a mesh that goes on, between a group and a plate that presses.
fn bed(threads: usize) -> (String, Files) {
    let mut list = Vec::new();
    for k in 0..6 * 6 * 3 {
        let [i, j, layer] = [k % 6, k / 6 % 6, k / 36].map(f64::from);
        list.push([
            [0.0065 * i + 0.001 * layer, 0.0065 * j + 0.0004 * i, 0.0046 + 0.0062 * layer],
            [0.2 * (0.3 * i).sin(), 0.1 * (j + layer).cos(), -0.1],
            [0.0; 3],
        ]);
    }
    for k in 0..8 * 8 {
        list.push([[0.005 * f64::from(k % 8), 0.005 * f64::from(k / 8), 0.0225], [0.0; 3], [0.0; 3]]);
    }
    let rest = "[boundary.floor]\nmaterial = \"glass\"\nmesh = { file = \"floor.obj\" }\nmotion = { prescribed = { x = 0.8 } }\n\
                [boundary.post]\nmaterial = \"glass\"\ndisc = { centre = [0.039, 0.01, 0.01], normal = [1.0, 0.0, 0.2], radius = 0.004 }\n\
                motion = { conveying = { z = 0.1 } }\n\
                [boundary.platen]\nparticles = { box = [[-1.0, -1.0, 0.022], [1.0, 1.0, 0.023]] }\n\
                motion = { prescribed = { x = -0.3 }, servo = { z = { target = 3.0, speed = 0.2 } } }\n";
    let (a, b) = ([EDGE, 0.0, 0.0], [0.0, EDGE, 0.0]);
    let edges = [a, b, [0.0, 0.0, EDGE]];
    let text = scene(&list, &(rest.to_owned() + &cell(edges, "[\"x\", \"y\"]")));
    let text = text.replace("[run]", &format!("[run]\nthreads = {threads}"));
    let files = obj(&sheet([a, b], [[0, 1], [0, 1]], |i, j| 0.4 * bumpy(i, j)));
    (text.replace("2e-6", "1e-5").replace("max_overlap = 0.3", "max_overlap = 0.9"), files)
}

#[test]
fn bits_are_the_same_for_threads_lanes_and_after_save_and_restore() {
    let begin = |threads: usize, width: Width| {
        let (text, files) = bed(threads);
        let mut simulation = start_with(&text, files);
        simulation.set_width(width);
        simulation
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let mut simulation = begin(threads, width);
        for step in 0..6 {
            simulation.advance(5e-3).unwrap();
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = begin(threads, width);
                simulation.restore(&state).unwrap();
            }
        }
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    assert!(first.clock.rebuilds > 4 && first.boundaries[0].brought_back[0] > 0.0);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn another_scene_takes_over_what_has_gone_through_the_faces() {
    use cograin::simulation::Description;
    use std::sync::Arc;
    let (text, files) = bed(1);
    let mut first = start_with(&text, files.clone());
    for _ in 0..7 {
        first.advance(5e-3).unwrap();
    }
    assert!(first.state().boundaries[0].brought_back[0] > 0.0);
    let from = Description::of(first.scene(), "first.toml", first.time());
    let second = Arc::new(read_with(&text.replace("[output]", "[output]\nhistory_interval = 0.1"), files).unwrap());
    let (second, left) = Simulation::taken_over(second, first.state(), &from).unwrap();
    assert!(left.is_empty(), "{left:?}");
    assert_eq!(second.contact_count(), first.contact_count());
    let energies = [first.elastic_energy(), second.elastic_energy()];
    assert!((energies[1] - energies[0]).abs() < 1e-3 * energies[0], "{energies:?}");
}

#[test]
fn a_platen_presses_a_bed_over_a_floor_that_goes_on() {
    let (text, files) = bed(1);
    let damping =
        "[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    let still = text.replace("motion = { prescribed = { x = 0.8 } }", "").replace("x = -0.3", "x = 0.0");
    let still = still.replace("motion = { conveying = { z = 0.1 } }", "");
    let mut simulation = start_with(&still.replace("[run]", damping), files);
    simulation.advance(0.35).unwrap();
    simulation.advance(0.05).unwrap();
    let forces = simulation.state().boundaries.iter().map(|boundary| boundary.mean_force[2]).collect::<Vec<_>>();
    let weight = 108.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.003_f64.powi(3) * 9.81;
    assert!((forces[2] - 3.0).abs() < 0.05, "{forces:?}");
    assert!((forces.iter().sum::<f64>() + weight).abs() < 0.02 * weight, "{forces:?} {weight}");
}

#[test]
fn surfaces_that_do_not_go_on_are_refused() {
    let [a, b, _] = leaning();
    let told = |shape: &str, files: Files| {
        let rest = format!("[boundary.wall]\nmaterial = \"glass\"\n{shape}\n") + &cell(leaning(), "[\"x\", \"y\"]");
        read_with(&scene(&[[[0.02, 0.02, 0.02], [0.0; 3], [0.0; 3]]], &rest), files).unwrap_err()
    };
    let mesh = "mesh = { file = \"floor.obj\" }";
    let wide = told(mesh, obj(&sheet([a, b], [[0, 2], [0, 1]], bumpy)));
    assert!(wide.contains("a surface wider than its copy at "), "{wide}");
    // Its vertices at one face are not at those of the other.
    let mut torn = sheet([a, b], [[0, 1], [0, 1]], |_, _| 0.0);
    for corner in torn.iter_mut().flatten().filter(|corner| (corner[0] - 0.25 * corner[1]).abs() < 1e-9) {
        if (corner[1] - 0.02).abs() < 1e-9 {
            (corner[0], corner[1]) = (0.005 * 1.1, 0.022);
        }
    }
    let torn = told(mesh, obj(&torn));
    assert!(torn.contains("with its copies, a vertex at"), "{torn}");
    let cone =
        told("cone = { from = [0.0, 0.02, 0.02], to = [0.04, 0.02, 0.02], radii = [0.01, 0.005] }", Files::new());
    assert!(cone.contains("from face to face, beside copies across its axis"), "{cone}");
    let nodes = told(&format!("{mesh}\nnodes = \"driven\""), obj(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
    assert!(nodes.contains("expected rigid nodes beside [cell]"), "{nodes}");
    let far = told("disc = { centre = [9.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.01 }", Files::new());
    assert!(far.contains("a wider cell, or a surface nearer to it"), "{far}");
}
