//! Heat of what plastic contacts and rolling springs lose: what they hold is not lost yet.

use super::losses::{heat, lost};
use super::{GRAINS, assert_close};
use crate::support::{Files, read, start_with};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::Loss;

/// All that may warm.
pub(super) const ALL: &str = "[heat]\nfrom_losses = [\"normal_damping\", \"tangential_damping\", \"sliding\", \"rolling\", \"plastic\", \
                   \"bond_damping\", \"bond_release\"]\n";

/// The causes of that.
const CAUSES: [Loss; 7] = [
    Loss::NormalDamping,
    Loss::TangentialDamping,
    Loss::Sliding,
    Loss::Rolling,
    Loss::Plastic,
    Loss::BondDamping,
    Loss::BondRelease,
];

/// The grains of these tests as plastic ones, of this surface energy \[J/m²\].
fn plastic(surface_energy: f64) -> String {
    GRAINS
        .replace(
            "[contact.touch.normal.hertz]",
            "[contact.touch.normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 3.0",
        )
        .replace(
            "friction = 0.5",
            &format!(
                "friction = 0.5\nunloading_stiffness_ratio = 4.0\npull_off_force = 0.0\nsurface_energy = {surface_energy:?}"
            ),
        )
        + ALL
}

/// The same as grains with a spring against rolling.
fn rolling(law: &str) -> String {
    GRAINS
        .replace(
            "[contact.touch.tangential.history]",
            &format!("[contact.touch.tangential.history]\n[contact.touch.rolling.{law}]"),
        )
        .replace("friction = 0.5", "friction = 0.5\nrolling_friction = 0.1\nrolling_viscous_damping = 0.2")
        .replace("[run]", "gravity = [0.0, 0.0, -9.81]\n[run]")
        + ALL
}

/// A scene with a time step of this length \[s\].
pub(super) fn with_step(text: &str, step: &str) -> String {
    text.replace("step = 1.0e-4", &format!("step = {step}"))
}

/// Fails unless heat is what the causes took since the start, to rounding of this energy \[J\].
#[track_caller]
pub(super) fn assert_booked(simulation: &Simulation, scale: f64) {
    let (gained, lost) = (heat(simulation), lost(simulation, &CAUSES));
    assert!((gained - lost).abs() <= 1e-11 * scale, "{gained:e} J gained, {lost:e} J lost");
}

/// What was lost and is no heat: springs whose stiffness changes, that turn and that part \[J\].
pub(super) fn unheated(simulation: &Simulation) -> f64 {
    simulation.losses().unwrap().iter().sum::<f64>() - lost(simulation, &CAUSES)
}

/// Files with a mesh of a floor of four triangles that meet in the origin.
fn floor() -> Files {
    let mesh =
        "v 0 0 0\nv -0.05 -0.05 0\nv 0.05 -0.05 0\nv 0.05 0.05 0\nv -0.05 0.05 0\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n";
    Files::from([("floor.obj".to_owned(), mesh.as_bytes().to_vec())])
}

/// What a sphere of 1 mm that comes down along z at 2 m/s, somewhat aslant, may strike.
fn struck() -> [(&'static str, &'static str); 3] {
    [
        ("another sphere", "{ position = [0.0, 0.0, -1.001e-3], radius = 1.0e-3, temperature = 300.0 },"),
        ("a plane", "[boundary.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stone\"\n"),
        ("a mesh", "[boundary.floor]\nmesh = { file = \"floor.obj\" }\nmaterial = \"stone\"\n"),
    ]
}

/// That impact.
fn impact(surface_energy: f64, struck: &str) -> Simulation {
    let (sphere, boundary) = if struck.starts_with('{') { (struck, "") } else { ("", struck) };
    let boundary = if boundary.is_empty() {
        String::new()
    } else {
        format!("{boundary}temperature = 300.0\nheat_capacity = 1.0\n")
    };
    let text = with_step(&plastic(surface_energy), "1.0e-7");
    let text = format!(
        "{text}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [0.0, 1.0e-6, 1.001e-3], radius = 1.0e-3, \
         temperature = 300.0, velocity = [0.1, 0.0, -2.0] }},\n{sphere}]\n{boundary}"
    );
    start_with(&text, floor())
}

#[test]
fn a_plastic_impact_warms_by_all_that_it_loses_and_cools_nothing() {
    for surface_energy in [0.0, 0.5] {
        for (name, what) in struck() {
            let mut simulation = impact(surface_energy, what);
            let before = simulation.kinetic_energy();
            let (mut warmed, mut touched) = (0.0, false);
            for _ in 0..200 {
                simulation.advance(2e-6).unwrap();
                assert_booked(&simulation, before);
                let now = heat(&simulation);
                assert!(now > warmed - 1e-5 * before, "{name}: {warmed:e} J, then {now:e} J");
                warmed = now;
                touched |= simulation.contact_count() > 0;
            }
            assert!(touched && simulation.contact_count() == 0, "{name}");
            let left = simulation.kinetic_energy();
            assert!(left < 0.8 * before, "{name}: {left:e} J of {before:e} J are left");
            assert!(lost(&simulation, &[Loss::Plastic]) > 0.1 * before, "{name}");
            // As far as the time step reaches.
            let residual = simulation.physical_residual().unwrap();
            assert_close(warmed, before - left + residual - unheated(&simulation), 1e-10);
            assert!(residual.abs() < 2e-3 * before, "{name}: {residual:e} J");
        }
    }
}

#[test]
fn a_sphere_that_rolls_to_rest_warms_by_the_motion_that_it_loses() {
    for law in ["epsd", "epsd2", "cdt"] {
        for (name, boundary) in &struck()[1..] {
            let text = with_step(&rolling(law), "2.0e-6").replace("[contact.touch.heat.constriction]\n", "");
            let text = format!(
                "{text}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [-2.0e-3, 1.0e-3, 0.9999e-3], \
                 radius = 1.0e-3, temperature = 300.0, velocity = [0.1, -0.03, 0.0], angular_velocity = [30.0, 100.0, 5.0] }}]\n\
                 {boundary}temperature = 300.0\nheat_capacity = 1.0\n"
            );
            let mut simulation = start_with(&text, floor());
            let before = simulation.kinetic_energy();
            for _ in 0..30 {
                simulation.advance(2e-3).unwrap();
                assert_booked(&simulation, before);
            }
            assert!(lost(&simulation, &[Loss::Rolling]) > 0.5 * before, "{law} on {name}");
            let place = simulation.state().particles.position[0];
            assert!(place[0] > 0.1e-3, "{law} on {name}: it has crossed edges, {place:?}");
            let boundary = simulation.state().heat.as_ref().unwrap().boundaries[0].heat();
            assert!(boundary > 0.4 * heat(&simulation), "{law} on {name}: {boundary:e} J");
        }
    }
}

/// A pile whose contacts are plastic or roll on springs, and whose spheres are bonded after a while: they fall on a mesh beside a plane.
fn pile(law: &str, contact: &str) -> String {
    let laws = if law == "plastic" { plastic(0.2) } else { rolling(law) };
    let [head, scene] = [laws, super::balance::pile("temperature = 350.0\nheat_capacity = 1.0", 100.0)];
    let particles = &scene[scene.find("[particles.all]").unwrap()..];
    let bonds = format!(
        "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.0e-3\ncreate = {{ time = 2.0e-3 }}\ncontact = \"{contact}\"\n\
         normal_stiffness = 1.0e8\ntangential_stiffness = 4.0e7\n[bond.glue.damping.viscous]\nnormal_force = 0.1\n\
         [bond.glue.breakage]\nmax_distance = 2.001e-3\n"
    );
    with_step(&head, "2.0e-6")
        + particles
        + "[boundary.side]\nmesh = { file = \"floor.obj\" }\nmaterial = \"stone\"\ntemperature = 290.0\n"
        + if contact.is_empty() { "" } else { &bonds }
}

#[test]
fn a_pile_of_plastic_or_rolling_or_bonded_grains_warms_by_its_book() {
    let cases = [("plastic", ""), ("epsd", ""), ("epsd2", "parallel"), ("epsd", "without_normal"), ("epsd", "none")];
    for (law, contact) in cases {
        let mut simulation = start_with(&pile(law, contact), floor());
        let before = simulation.kinetic_energy();
        for _ in 0..8 {
            simulation.advance(1e-3).unwrap();
            assert_booked(&simulation, before);
        }
        let held = if law == "plastic" { Loss::Plastic } else { Loss::Rolling };
        assert!(lost(&simulation, &[held]) > 0.0, "{law} {contact}");
        if !contact.is_empty() {
            assert!(lost(&simulation, &[Loss::BondDamping]) > 0.0, "{law} {contact}");
            assert!(lost(&simulation, &[Loss::BondRelease]) > 0.0, "{law} {contact}");
        }
    }
}

#[test]
fn what_contacts_hold_has_the_same_bits_for_any_threads_and_lanes_and_after_a_saved_state() {
    for (law, contact) in [("plastic", ""), ("epsd", "none")] {
        let run = |threads: usize, width: Width, saves: bool| {
            let text = pile(law, contact).replace("[run]\n", &format!("[run]\nthreads = {threads}\n"));
            let mut simulation = start_with(&text, floor());
            simulation.set_width(width);
            simulation.advance(3e-3).unwrap();
            if saves {
                let state = simulation.state().clone();
                simulation = start_with(&text, floor());
                simulation.set_width(width);
                simulation.restore(&state).unwrap();
            }
            simulation.advance(2e-3).unwrap();
            simulation.state().fingerprint()
        };
        let first = run(1, Width::Least, false);
        assert_eq!(run(2, Width::widest(), false), first, "{law}");
        assert_eq!(run(3, Width::widest(), true), first, "{law}");
    }
}

#[test]
fn what_contacts_held_is_no_heat_of_particles_that_go() {
    for law in ["plastic", "epsd"] {
        let text = pile(law, "")
            + "[region.bin]\nbox = [[2.0e-3, -1.0, -1.0], [1.0, 1.0, 2.0e-3]]\n[outlet.drain]\nregion = \"bin\"\n";
        let mut simulation = start_with(&text, floor());
        let before = simulation.kinetic_energy();
        for _ in 0..60 {
            simulation.advance(1e-4).unwrap();
            assert_booked(&simulation, before);
        }
        assert!(simulation.state().exchange.as_ref().unwrap().outlets[0].count > 5, "{law}");
    }
}

#[test]
fn attraction_that_comes_back_is_no_heat() {
    let impact = plastic(0.0)
        + "[particles.all]\nmaterial = \"stone\"\nlist = [{ position = [0.0, 0.0, 1.0], radius = 1.0, temperature = 300.0 }]\n";
    read(&impact).unwrap();
    let pulled = read(&impact.replace("pull_off_force = 0.0", "pull_off_force = 1.0e-3")).unwrap_err();
    assert!(pulled.contains("in the book of losses it has the attraction of [contact.touch]"), "{pulled}");
}
