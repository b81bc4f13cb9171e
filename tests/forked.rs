//! A simulation with helpers in a child made by `fork`, where only the calling thread lives on. It starts
//! helpers of its own and waits for no others.

#![cfg(unix)]

use cograin::run::FrameWriter;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

unsafe extern "C" {
    /// Doubles the process.
    fn fork() -> i32;
    /// Waits for a child.
    fn waitpid(process: i32, status: *mut i32, options: i32) -> i32;
    /// Ends the process without anything else.
    fn _exit(status: i32) -> !;
    /// Has the process killed after some seconds.
    fn alarm(seconds: u32) -> u32;
}

/// A block of touching spheres, enough for two threads.
fn simulation() -> Simulation {
    let mut particles = String::from("id,x,y,z,radius\n");
    for index in 0..2200 {
        let [x, y, z] = [index % 13, index / 13 % 13, index / 169].map(|step| 1.98e-3 * f64::from(step));
        writeln!(particles, "{index},{x},{y},{z},1e-3").unwrap();
    }
    let text = r#"
[run]
step = 1e-6
threads = 2
[material.glass]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.glass.glass]
restitution = 0.5
[contact.touch.normal.hertz]
[particles.block]
material = "glass"
file = "block.csv"
"#;
    let files = BTreeMap::from([("block.csv".to_owned(), particles.into_bytes())]);
    let source = Source { name: "scene.toml".into(), text: text.into(), files };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(scene)).unwrap()
}

/// A child writes no frames into the folder of its parent, and does not give it back.
fn frames_stay_with_the_process_that_opened_their_folder(simulation: &Simulation) {
    let folder = std::env::temp_dir().join(format!("cograin-forked-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    let mut writer = Some(FrameWriter::open(&folder, simulation, 0.0, 0.0).unwrap());
    let files = || std::fs::read_dir(&folder).unwrap().count();
    let before = files();
    let refused = in_child(|| {
        let said = writer.as_mut().unwrap().pass(simulation, 1.0).unwrap_err().to_string();
        drop(writer.take());
        said.ends_with("the process that opened it writes there; a child that it made by fork does not")
    });
    assert!(refused && files() == before, "nothing is written, and the lock stays");
    writer.as_mut().unwrap().pass(simulation, 1.0).unwrap();
    assert_eq!(files(), before + 1);
    drop(writer);
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Whether a child that does this ends well.
fn in_child(act: impl FnOnce() -> bool) -> bool {
    // SAFETY: this is the only test of its program, and the library has no lock that helpers hold for longer than a
    // moment; the child ends without unwinding.
    unsafe {
        let child = fork();
        if child == 0 {
            alarm(60);
            let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(act));
            _exit(i32::from(!matches!(done, Ok(true))));
        }
        let mut status = -1;
        waitpid(child, &raw mut status, 0);
        status == 0
    }
}

#[test]
fn a_simulation_with_helpers_goes_on_and_ends_in_a_forked_child() {
    let mut simulation = simulation();
    assert_eq!(simulation.threads(), 2);
    simulation.advance(2e-5).unwrap();
    let start = simulation.state().clone();
    simulation.advance(2e-5).unwrap();
    let expected = simulation.state().fingerprint();
    simulation.restore(&start).unwrap();
    let mut simulation = Some(simulation);
    let goes_on = in_child(|| {
        let simulation = simulation.as_mut().unwrap();
        simulation.advance(2e-5).is_ok() && simulation.state().fingerprint() == expected && simulation.threads() == 2
    });
    assert!(goes_on, "it steps in the child, to the same bits");
    assert!(in_child(|| simulation.take().is_some()), "it is dropped in the child");
    let simulation = simulation.as_mut().unwrap();
    simulation.advance(2e-5).unwrap();
    assert_eq!(simulation.state().fingerprint(), expected, "the parent goes on");
    frames_stay_with_the_process_that_opened_their_folder(simulation);
}
