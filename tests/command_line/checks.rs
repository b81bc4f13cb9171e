//! What `check` tells.

use crate::ground::{Place, cograin, complaint};

#[test]
fn check_tells_what_a_scene_uses_and_costs() {
    let place = Place::new("check");
    let scene = place.scene("end = 0.1\nstep = 1e-5", "history_interval = 3.5e-5");
    let output = cograin(&[&"check", &scene]).output().unwrap();
    complaint(&output, 0);
    let said = String::from_utf8(output.stdout).unwrap();
    for part in [
        "5 particles",
        "contact touch: normal hertz, tangential history",
        "boundary floor: plane, fixed",
        "time step",
        "memory",
        "for each step",
        "remark     [output] history_interval",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}
