//! Contacts and bonds that come are foreseen by the time step, and what stops a run is named.
//!
//! The automatic step knows the speed of planes, the dashpots of bonds and bonds to come. It becomes shorter inside a communication
//! step. `time_step.stable` is renewed where the step is given. Messages name speed or load where these are the cause.

use crate::support::{scene, start};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::{Cause, RunError, Simulation};

/// An elastic sphere at rest and a plane that comes at it as this motion says.
fn plane_hits_sphere(run: &str, motion: &str) -> String {
    format!(
        "[run]\nthreads = 1\n{run}\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e8\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 1.0\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"a\"\n\
         list = [ {{ position = [0.0, 0.0, 0.02], radius = 0.01 }} ]\n\
         [boundary.h]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"a\"\n\
         motion = {{ {motion} }}\n[output]\nenergy = true\n"
    )
}

/// How fast the sphere is when a plane at 0.1 m/s has hit it \[m/s\].
fn speed_after(text: &str, driven: bool, interval: f64) -> f64 {
    let mut simulation = start(text);
    let count = (0.3 / interval).round() as usize;
    for done in 1..=count {
        if driven {
            simulation.set_input(BoundaryIndex(0), 2, 0.1 * done as f64 * interval);
        }
        simulation.advance(interval).expect("it runs");
    }
    simulation.state().particles.velocity[0][2]
}

#[test]
fn a_plane_that_hits_a_sphere_gives_it_twice_its_speed() {
    let prescribed = plane_hits_sphere("safety = 0.2", "prescribed = { z = 0.1 }");
    let driven = plane_hits_sphere("safety = 0.2", "driven = [\"z\"]");
    // In one communication step, and in many.
    for interval in [0.3, 0.075, 1e-3] {
        for (text, is_driven) in [(&prescribed, false), (&driven, true)] {
            let speed = speed_after(text, is_driven, interval);
            // Two in a hundred: ten time steps to a collision.
            assert!((speed / 0.2 - 1.0).abs() < 0.02, "{speed} m/s in steps of {interval} s, 0.2 m/s expected");
        }
    }
}

/// How fast a sphere is that a plane has hit in this motion, in communication steps of this length \[s\] \[m/s\].
fn speed_behind(motion: &str, position: [f64; 3], interval: f64) -> f64 {
    let text = plane_hits_sphere("safety = 0.2", motion).replace("[0.0, 0.0, 0.02]", &format!("{position:?}"));
    let mut simulation = start(&text);
    for _ in 0..(0.1 / interval).round() as usize {
        simulation.advance(interval).expect("it runs");
    }
    simulation.state().particles.velocity[0][2]
}

#[test]
fn a_plane_that_turns_hits_a_sphere_with_the_speed_that_it_has_there() {
    for interval in [0.1, 1e-3] {
        // At x = −0.3 m a turn about y at 1 rad/s goes up at 0.3 m/s.
        let speed = speed_behind("prescribed = { \"rotation.y\" = 1.0 }", [-0.3, 0.0, 0.012], interval);
        assert!((speed / 0.6 - 1.0).abs() < 0.02, "{speed} m/s in steps of {interval} s, 0.6 m/s expected");
    }
}

#[test]
fn a_plane_that_starts_within_a_communication_step_is_foreseen() {
    let motion =
        "prescribed = { z = { trapezoid = { distance = 0.04, speed = 1.0, acceleration = 1e4, start = 0.03 } } }";
    for interval in [0.1, 1e-3] {
        let speed = speed_behind(motion, [0.0, 0.0, 0.02], interval);
        assert!((speed / 2.0 - 1.0).abs() < 0.02, "{speed} m/s in steps of {interval} s, 2 m/s expected");
    }
}

#[test]
fn a_plate_driven_into_a_loose_packing_gives_it_no_more_than_its_work() {
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3], motion: &str| {
        format!(
            "[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"wall\"\n{motion}"
        )
    };
    let edge = 0.016;
    let walls = [
        plane("bottom", [0.0; 3], [0.0, 0.0, 1.0], ""),
        plane("top", [0.0, 0.0, edge], [0.0, 0.0, -1.0], "motion = { driven = [\"z\"] }\n"),
        plane("xl", [0.0; 3], [1.0, 0.0, 0.0], ""),
        plane("xh", [edge, 0.0, 0.0], [-1.0, 0.0, 0.0], ""),
        plane("yl", [0.0; 3], [0.0, 1.0, 0.0], ""),
        plane("yh", [0.0, edge, 0.0], [0.0, -1.0, 0.0], ""),
    ];
    let text = format!(
        "[run]\nthreads = 1\n[material.sand]\ndensity = 2650.0\nyoungs_modulus = 1e8\npoissons_ratio = 0.25\n\
         [material.wall]\ndensity = 2650.0\nyoungs_modulus = 1e8\npoissons_ratio = 0.25\n\
         [pair.sand.sand]\nrestitution = 0.4\nfriction = 0.4\n[pair.sand.wall]\nrestitution = 0.4\nfriction = 0.0\n\
         [contact.g.normal.hertz]\n[contact.g.tangential.history]\n[particles.s]\nmaterial = \"sand\"\n\
         packing = {{ box = [[0.0, 0.0, 0.0], [{edge:?}, {edge:?}, {edge:?}]], solid_fraction = 0.5, radius = [0.0015, 0.0025] }}\n{}",
        walls.concat()
    );
    let mut simulation = start(&text);
    let top = simulation.scene().boundaries.iter().position(|boundary| boundary.name == "top").unwrap();
    for interval in 1..=10 {
        simulation.set_input(BoundaryIndex(top as u32), 2, -1e-4 * f64::from(interval));
        simulation.advance(2e-3).expect("it runs");
    }
    let given: f64 = simulation.state().boundaries.iter().map(|boundary| boundary.work).sum();
    let held = simulation.kinetic_energy() + simulation.elastic_energy();
    assert!(given > 0.0 && held < 1.01 * given, "{held:e} J of {given:e} J");
}

#[test]
fn a_given_step_is_refused_before_numbers_are_nonsense_and_the_bound_is_renewed() {
    let mut simulation = start(&plane_hits_sphere("step = 1e-3\nstrict_step = true", "driven = [\"z\"]"));
    simulation.advance(0.01).expect("nothing moves yet");
    let resting = simulation.state().clock.stable;
    simulation.set_input(BoundaryIndex(0), 2, 0.1);
    let error = simulation.advance(0.1).expect_err("the plane comes at 1 m/s");
    let RunError::StepTooLong { step, stable, by, .. } = &error else { panic!("{error}") };
    assert!(*step == 1e-3 && *stable < 1e-3 && *stable < resting, "{error}");
    assert!(by.contains("particle 1"), "{error}");
    assert_eq!(simulation.state().particles.velocity[0][2], 0.0, "nothing has happened yet");
}

#[test]
fn a_given_step_is_divided_where_the_bound_falls_below_it_and_counted() {
    let mut simulation = start(&plane_hits_sphere("step = 1e-3", "driven = [\"z\"]"));
    simulation.advance(0.01).expect("nothing moves yet");
    let begun = simulation.state().clock;
    assert_eq!((begun.step, begun.divided), (1e-3, 0), "it is the given one as long as that is stable");
    simulation.set_input(BoundaryIndex(0), 2, 0.1);
    for _ in 0..50 {
        let part = simulation.advance_part(0.1, 20).expect("it is divided");
        let clock = simulation.state().clock;
        assert!(clock.last_step <= clock.stable.max(1e-3) && clock.last_step <= 1e-3, "{clock:?}");
        if part {
            break;
        }
    }
    let clock = simulation.state().clock;
    assert!(clock.divided > 0 && clock.divided < clock.steps, "{} of {} time steps", clock.divided, clock.steps);
    let parts = 1e-3 / clock.step;
    assert!((parts - parts.round()).abs() < 1e-9, "the given step has {parts} parts");
    assert!(simulation.state().particles.velocity[0][2] > 0.5, "the plane has hit the sphere");
    let text = "strict_step beside allow_unstable";
    let both = crate::support::read(&plane_hits_sphere(
        "step = 1e-3\nstrict_step = true\nallow_unstable = true",
        "driven = [\"z\"]",
    ));
    assert!(both.as_ref().is_err_and(|error| error.contains(text)), "{both:?}");
}

#[test]
fn an_unstable_step_runs_where_the_scene_allows_it() {
    let mut simulation = start(&plane_hits_sphere("step = 1e-3\nallow_unstable = true", "prescribed = { z = 0.1 }"));
    simulation.advance(0.3).expect("it runs");
    assert!(simulation.state().clock.stable < 1e-3, "{:e} s", simulation.state().clock.stable);
}

/// Two bonded spheres that move against each other, their bond with these dashpots.
fn damped_pair(ratio: f64) -> String {
    format!(
        "[run]\nthreads = 1\nsafety = 0.7\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
         list = [ {{ position = [0.0, 0.0, 0.0], radius = 0.01, velocity = [1e-6, 0.0, 0.0] }}, \
         {{ position = [0.02, 0.0, 0.0], radius = 0.01, velocity = [-1e-6, 0.0, 0.0] }} ]\n\
         [bond.b]\nbetween = [\"p\", \"p\"]\ncreate_distance = 0.0205\nnormal_stiffness = 1e10\n\
         tangential_stiffness = 4e9\n[bond.b.damping.viscous]\nnormal_force = {ratio:?}\n"
    )
}

#[test]
fn strongly_damped_bonds_come_to_rest() {
    for ratio in [0.3, 1.0, 2.0, 5.0] {
        let mut simulation = start(&damped_pair(ratio));
        let begun = simulation.kinetic_energy();
        simulation.advance(0.02).expect("it runs");
        let left = simulation.kinetic_energy() / begun;
        assert!(left < 1e-3, "{left:e} of the energy is left at a damping ratio of {ratio}");
    }
}

#[test]
fn bonds_made_later_are_foreseen() {
    for create in ["\"always\"", "{ time = 2e-3 }"] {
        let text = format!(
            "gravity = [0.0, 0.0, -9.81]\n[run]\nthreads = 1\nmax_overlap = 0.3\n[material.a]\ndensity = 2500.0\n\
             youngs_modulus = 1e7\npoissons_ratio = 0.3\n[pair.a.a]\nrestitution = 0.5\nfriction = 0.5\n\
             [contact.c.normal.hertz]\n[contact.c.tangential.history]\n[particles.p]\nmaterial = \"a\"\n\
             lattice = {{ kind = \"simple_cubic\", radius = 0.01, origin = [0.0, 0.0, 0.00999], spacing = 0.01998, counts = [3, 3, 3] }}\n\
             [boundary.f]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"a\"\n\
             [bond.b]\nformulation = \"finite_rotation\"\nbetween = [\"p\", \"p\"]\ncreate_distance = 0.0205\n\
             create = {create}\nnormal_stiffness = 1e10\ntangential_stiffness = 4e9\n"
        );
        let mut simulation = start(&text);
        simulation.advance(0.02).expect("it runs");
        assert!(!simulation.bonds().is_empty(), "no bond was made with create = {create}");
        // What falls over the height of the block, at most.
        let energy: f64 = simulation.state().particles.velocity.iter().map(|v| v[3] * 9.81 * 0.06).sum();
        assert!(simulation.kinetic_energy() < energy, "{} J with create = {create}", simulation.kinetic_energy());
    }
}

#[test]
fn a_sphere_that_is_too_fast_for_a_step_below_the_stable_one_is_told_so() {
    let text = "[run]\nstep = 1e-2\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                list = [ { position = [0.0, 0.0, 0.0], radius = 0.01, velocity = [10.0, 0.0, 0.0] } ]\n";
    let error = start(text).advance(0.1).expect_err("it moves ten radii in a step");
    let RunError::Runaway { cause: Cause::Speed { speed, .. }, .. } = &error else { panic!("{error}") };
    assert_eq!(*speed, 10.0);
}

/// Two spheres that meet at 32 m/s: ½ m* V² is 2.6 J, and at an overlap of a radius Hertz's contact holds 8/15 E* √R* R^5/2 = 2e-3 J.
fn too_soft(step: &str) -> String {
    format!(
        "[run]\nthreads = 1\n{step}[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e4\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 1.0\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"a\"\nlist = [\n\
         {{ position = [0.0, 0.0, 0.0], radius = 0.01, velocity = [16.0, 0.0, 0.0] }},\n\
         {{ position = [0.05, 0.0, 0.0], radius = 0.01, velocity = [-16.0, 0.0, 0.0] }},\n]\n"
    )
}

#[test]
fn spheres_that_are_too_soft_for_their_impact_do_not_pass_through_each_other_unseen() {
    for step in ["step = 1e-4\n", "step = 1e-5\n"] {
        let error = start(&too_soft(step)).advance(0.01).expect_err("they go through each other");
        let RunError::Crushed { overlap, cause: Cause::Impact { speed }, .. } = &error else { panic!("{error}") };
        assert!(*overlap > 1.0 && *overlap < 1.5 && *speed > 20.0 && *speed <= 32.0, "{error}");
    }
    // The automatic step follows their stiffness and their motion: they do not jump over each other in it.
    let error = start(&too_soft("")).advance(0.01).expect_err("they go through each other");
    assert!(matches!(error, RunError::Crushed { cause: Cause::Impact { .. }, .. }), "{error}");
}

#[test]
fn an_automatic_step_does_not_lead_to_its_own_refusal() {
    // Nothing is stiff; it begins fast, it falls, it is pushed, or it comes fast.
    let falls = "gravity = [0.0, 0.0, -9.81]\n";
    let fast = "[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                list = [ { position = [0.0, 0.0, 0.0], radius = 0.001, velocity = [0.0, 0.0, 100.0] } ]\n";
    let pushed = "[force.f]\nparticles = { set = \"p\" }\nforce = [1e-3, 0.0, 0.0]\n";
    let comes = "[region.feed]\nbox = [[0.0, 0.0, 1.0], [1.0, 1.0, 2.0]]\n[insertion.rain]\nregion = \"feed\"\nmaterial = \"a\"\n\
                 sizes = { radius = 1e-3 }\ncount_rate = 100.0\nvelocity = [0.0, 0.0, -50.0]\n";
    let slow = fast.replace("100.0", "0.0");
    for text in [fast.to_owned(), format!("{falls}{slow}"), format!("{slow}{pushed}"), format!("{slow}{comes}")] {
        let mut simulation = start(&text);
        for interval in [1e-9, 1.0, 0.5] {
            simulation.advance(interval).unwrap_or_else(|error| panic!("{error}\n{text}"));
        }
        assert!((simulation.time() - 1.5).abs() < 1e-6);
    }
}

#[test]
fn where_nothing_moves_and_nothing_is_stiff_a_communication_step_is_one_time_step() {
    let text = "[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                list = [ { position = [0.0, 0.0, 0.0], radius = 0.01 } ]\n";
    let mut simulation = start(text);
    for interval in [1e-6, 3.0, 1e5] {
        let before = simulation.state().clock.steps;
        simulation.advance(interval).expect("nothing moves");
        assert_eq!(simulation.state().clock.steps - before, 1);
        assert_eq!(simulation.state().clock.step, interval);
    }
}

#[test]
fn spheres_that_are_squeezed_slowly_are_not_told_that_they_met_too_fast() {
    let text = "[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e4\npoissons_ratio = 0.3\n\
                [pair.a.a]\nrestitution = 0.3\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"a\"\nlist = [\n\
                { position = [0.0, 0.0, 0.01], radius = 0.01 },\n{ position = [0.0, 0.0, 0.03], radius = 0.01 },\n]\n\
                [boundary.floor]\nmaterial = \"a\"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n\
                [boundary.lid]\nmaterial = \"a\"\nplane = { point = [0, 0, 0.04], normal = [0, 0, -1] }\n\
                motion = { prescribed = { z = -0.01 } }\n";
    let error = start(text).advance(4.0).expect_err("the lid comes down to the floor");
    assert!(matches!(error, RunError::Crushed { cause: Cause::Load, .. }), "{error}");
}

#[test]
fn spheres_with_one_centre_are_told_so() {
    let text = too_soft("max_overlap = 2.0\n").replace("[0.05, 0.0, 0.0]", "[0.0, 0.0, 0.0]").replace("16.0", "0.0");
    let scene = scene(&text);
    let error = Simulation::new(scene).and_then(|mut simulation| simulation.advance(0.01)).expect_err("no direction");
    assert!(error.to_string().contains("the centres of particles 1 and 2 coincide"), "{error}");
}

#[test]
fn where_nothing_is_stiff_no_stable_step_is_told() {
    let text = "[run]\nstep = 1e-2\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                list = [ { position = [0.0, 0.0, 0.0], radius = 0.01, velocity = [10.0, 0.0, 0.0] } ]\n";
    let told = start(text).advance(0.1).expect_err("it moves ten radii in a step").to_string();
    assert!(told.ends_with("its speed, 1.000e1 m/s, is too high for a time step of 1.000e-2 s"), "{told}");
}

/// The stable step of a pair of bonded spheres beside a pair that touches \[s\].
fn stable_beside_a_contact(stiffness: f64) -> f64 {
    let text = format!(
        "[run]\nthreads = 1\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 0.5\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"a\"\n\
         list = [ {{ position = [0.5, 0.0, 0.0], radius = 0.005 }}, {{ position = [0.5099, 0.0, 0.0], radius = 0.005 }} ]\n\
         [particles.q]\nmaterial = \"a\"\n\
         list = [ {{ position = [0.0, 0.0, 0.0], radius = 0.005 }}, {{ position = [0.01, 0.0, 0.0], radius = 0.005 }} ]\n\
         [bond.b]\nbetween = [\"q\", \"q\"]\ncreate_distance = 0.0101\nnormal_stiffness = {stiffness:e}\n\
         tangential_stiffness = {stiffness:e}\n"
    );
    start(&text).state().clock.stable
}

/// Springs stood in single precision, in units of the first one: beside a contact, bonds of 1e50 Pa/m counted as none.
#[test]
fn a_bond_beside_a_contact_is_seen_however_stiff_it_is() {
    let soft = stable_beside_a_contact(1e12);
    for (stiffness, factor) in [(1e30, 1e9), (1e50, 1e19), (1e100, 1e44)] {
        let ratio = soft / factor / stable_beside_a_contact(stiffness);
        assert!((0.99..1.01).contains(&ratio), "{ratio} at {stiffness:e} Pa/m");
    }
}

/// Spheres at rest on a floor that goes so far \[m\] within so long \[s\], and then stands for three steps: the kinetic energy \[J\].
fn stirred(shift: f64, within: f64) -> Result<f64, RunError> {
    let text = "gravity = [0.0, 0.0, -9.81]\n[run]\nthreads = 1\nstep = 2e-5\n[material.a]\ndensity = 2600.0\n\
                youngs_modulus = 1e7\npoissons_ratio = 0.25\n[pair.a.a]\nrestitution = 0.5\n[contact.c.normal.hertz]\n\
                [particles.p]\nmaterial = \"a\"\nlist = [ { position = [0.0, 0.0, 0.00499], radius = 0.005 } ]\n\
                [boundary.floor]\nmaterial = \"a\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
                motion = { driven = [\"z\"] }\n";
    let mut simulation = start(text);
    for _ in 0..5000 {
        simulation.advance(2e-5)?;
    }
    simulation.set_input(BoundaryIndex(0), 2, shift);
    simulation.advance(within)?;
    for _ in 0..3 {
        simulation.advance(2e-5)?;
    }
    Ok(simulation.kinetic_energy())
}

/// The dashpot of a communication step of 1e-12 s acted over half of the next time step, ten million times as long: a nanometre gave
/// a bed 1.6 J.
#[test]
fn a_communication_step_far_shorter_than_a_time_step_gives_no_more_than_its_motion() {
    let slowly = stirred(1e-9, 2e-5).unwrap();
    for within in [1e-7, 1e-9, 1e-12, 1e-18] {
        let found = stirred(1e-9, within).unwrap();
        assert!(found < 2.0 * slowly, "{found:e} J within {within} s, {slowly:e} J within a time step");
    }
    let told = stirred(1e-9, 1e-21).expect_err("no clock has it").to_string();
    assert_eq!(told, "expected at least 1/1e15 of a time step of 2e-5 s from t = 0.1 s on, found 1e-21 s");
}
