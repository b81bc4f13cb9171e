//! Surfaces that go on through the faces of a cell.

use super::scenes::{EDGE, assert_alike, bumpy, floor_file, leaning, scene, sheet};
use crate::support::{Files, cell, read_with, start_with};

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
    let flat = || floor_file(&sheet([a, b], [[0, 1], [0, 1]], |_, _| 0.0));
    for shape in floors {
        let rest = boundary(&shape) + &cell(leaning(), "periodic = [\"x\", \"y\"]");
        let closed = start_with(&scene(&[ball], &rest), flat());
        let crossed = assert_alike(closed, start_with(&scene(&[ball], &plane), Files::new()), 60, 1e-10);
        assert!(crossed >= 3, "{crossed} faces");
    }
    let plate = boundary(&format!(
        "rectangle = {{ corner = [0.0, 0.0, 0.0], edges = [[{EDGE}, 0.0, 0.0], [0.0, {EDGE}, 0.0]] }}"
    ));
    let rest = plate + &cell([a, [0.0, EDGE, 0.0], [0.0, 0.0, EDGE]], "periodic = [\"x\", \"y\"]");
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
        let rest = floor.clone() + &cell(leaning(), "periodic = [\"x\", \"y\"]");
        let closed = start_with(&scene(list, &rest), floor_file(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
        let open = start_with(&scene(list, &floor), floor_file(&sheet([a, b], [[-3, 5], [-3, 5]], bumpy)));
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
    let rest = floor.to_owned() + &cell(leaning(), "periodic = [\"x\", \"y\"]");
    let closed = start_with(&scene(&balls, &rest), floor_file(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
    let open = start_with(&scene(&balls, floor), floor_file(&sheet([a, b], [[-6, 6], [-4, 6]], bumpy)));
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
        let rest = post.clone() + &cell(leaning(), "periodic = [\"x\", \"y\"]");
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
        let rest = drum(length) + &cell(edges, "periodic = [\"x\"]");
        let closed = start_with(&scene(&[ball], &rest), Files::new());
        assert!(assert_alike(closed, open(), 100, 1e-9) >= 1);
    }
    let rest = drum("") + &cell(edges, "periodic = [\"x\", \"y\"]");
    let told = read_with(&scene(&[ball], &rest), Files::new()).unwrap_err();
    assert!(told.contains("turns only about the one edge that repeats"), "{told}");
}

#[test]
fn surfaces_that_do_not_go_on_are_refused() {
    let [a, b, _] = leaning();
    let told = |shape: &str, files: Files| {
        let rest =
            format!("[boundary.wall]\nmaterial = \"glass\"\n{shape}\n") + &cell(leaning(), "periodic = [\"x\", \"y\"]");
        read_with(&scene(&[[[0.02, 0.02, 0.02], [0.0; 3], [0.0; 3]]], &rest), files).unwrap_err()
    };
    let mesh = "mesh = { file = \"floor.obj\" }";
    let wide = told(mesh, floor_file(&sheet([a, b], [[0, 2], [0, 1]], bumpy)));
    assert!(wide.contains("a surface wider than its copy at "), "{wide}");
    // Its vertices at one face are not at those of the other.
    let mut torn = sheet([a, b], [[0, 1], [0, 1]], |_, _| 0.0);
    for corner in torn.iter_mut().flatten().filter(|corner| (corner[0] - 0.25 * corner[1]).abs() < 1e-9) {
        if (corner[1] - 0.02).abs() < 1e-9 {
            (corner[0], corner[1]) = (0.005 * 1.1, 0.022);
        }
    }
    let torn = told(mesh, floor_file(&torn));
    assert!(torn.contains("with its copies, a vertex at"), "{torn}");
    let cone =
        told("cone = { from = [0.0, 0.02, 0.02], to = [0.04, 0.02, 0.02], radii = [0.01, 0.005] }", Files::new());
    assert!(cone.contains("from face to face, beside copies across its axis"), "{cone}");
    let nodes = told(&format!("{mesh}\nnodes = \"driven\""), floor_file(&sheet([a, b], [[0, 1], [0, 1]], bumpy)));
    assert!(nodes.contains("expected rigid nodes beside [cell]"), "{nodes}");
    let far = told("disc = { centre = [9.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.01 }", Files::new());
    assert!(far.contains("a wider cell, or a surface nearer to it"), "{far}");
}
