//! Contacts that a bond suppresses: nothing of them while bonded, and no jump when the bond breaks.

use crate::support::start;
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::state::contacts::{BONDED, RELEASED, TOUCHING, is_resting};

/// Two spheres that overlap by 2 % of their radius and are bonded.
const PAIR: &str = r#"
[run]
step = STEP
[material.ice]
youngs_modulus = 1.0e8
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = RESTITUTION
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.one]
material = "ice"
list = [{ id = 1, position = [0.0, 0.0, 0.0], radius = 1.0e-3 }]
[particles.other]
material = "ice"
list = [{ id = 2, position = [1.98e-3, 0.0, 0.0], radius = 1.0e-3, velocity = VELOCITY }]
[bond.glue]
between = ["one", "other"]
create_distance = 2.0e-3
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
contact = "CONTACT"
shear = false
torsion = false
bending = false
[bond.glue.breakage]
max_distance = 1.984e-3
[output]
energy = true
"#;

/// That scene.
fn pair(contact: &str, velocity: &str, restitution: f64, step: f64) -> Simulation {
    start(
        &PAIR
            .replace("CONTACT", contact)
            .replace("VELOCITY", velocity)
            .replace("RESTITUTION", &format!("{restitution:?}"))
            .replace("STEP", &format!("{step:?}")),
    )
}

/// How many bonds live.
fn living(simulation: &Simulation) -> usize {
    simulation.state().bonds.iter().map(|list| list.first.len()).sum()
}

#[test]
fn bonded_spheres_at_rest_do_not_press_on_each_other() {
    let force = |contact| pair(contact, "[0.0, 0.0, 0.0]", 0.5, 1e-7).state().particles.force[0][0];
    assert!(force("parallel") < -0.1, "{}", force("parallel"));
    assert_eq!((force("without_normal"), force("none")), (0.0, 0.0));
}

#[test]
fn friction_stays_without_normal_and_goes_with_none() {
    // The dashpot of the approach is what friction sees.
    let sideways = |contact| {
        let mut simulation = pair(contact, "[-0.1, 0.1, 0.0]", 0.5, 1e-7);
        simulation.advance(1e-6).unwrap();
        (simulation.state().particles.force[0][1].abs(), simulation.contact_count(), simulation.contacts())
    };
    let (force, count, records) = sideways("without_normal");
    assert!(force > 1e-3, "{force:e} N");
    assert_eq!((count, records.len(), records[0].normal_force.abs() < 1e-3 * force), (1, 1, true));
    let (force, count, records) = sideways("none");
    // The bond itself turns a little.
    assert!(force < 1e-5, "{force:e} N");
    assert_eq!((count, records.len()), (0, 0));
}

#[test]
fn a_broken_pair_starts_from_no_force_and_keeps_its_energy() {
    for contact in ["without_normal", "none"] {
        let mut simulation = pair(contact, "[1.0, 0.0, 0.0]", 1.0, 1e-8);
        while living(&simulation) > 0 {
            assert_eq!(
                simulation
                    .state()
                    .ledger
                    .as_ref()
                    .map(|ledger| ledger.work_of(cograin::state::ledger::Source::Contacts)),
                Some(0.0)
            );
            simulation.advance(1e-8).unwrap();
        }
        let released = simulation.state().breaks[0].energy;
        assert!(released > 0.0);
        // The spheres overlap by 1.6 % of their radius, and still fly apart: what the bond left.
        let kinetic = simulation.kinetic_energy();
        assert_eq!((simulation.state().particles.force[0][0], simulation.elastic_energy()), (0.0, 0.0));
        simulation.advance(1e-6).unwrap();
        assert_eq!(simulation.state().particles.force[0][0], 0.0, "{contact}: the overlap shrinks");
        assert!((simulation.kinetic_energy() / kinetic - 1.0).abs() < 1e-14, "{contact}");
    }
    // Side by side the contact has been loaded all the time, and drives the spheres apart.
    let mut parallel = pair("parallel", "[1.0, 0.0, 0.0]", 1.0, 1e-8);
    while living(&parallel) > 0 {
        parallel.advance(1e-8).unwrap();
    }
    assert!(parallel.elastic_energy() > 1e-6 * parallel.kinetic_energy());
}

/// They were worked on one by one in every step, though nothing of them acts: 6,000 spheres with 20,350 bonds took 1.57 ms a
/// step with `"none"` where they took 0.60 ms with `"parallel"`, which does more.
#[test]
fn contacts_of_which_nothing_acts_are_left_alone_until_their_bond_breaks() {
    // The flags of the contact, and what is kept of it.
    let kept = |simulation: &Simulation| {
        let list = &simulation.state().contacts[0];
        (list.flags[0], *list.history.get(0).last().expect("offsets are kept"))
    };
    let mut followed = pair("without_normal", "[1.0, 0.0, 0.0]", 1.0, 1e-8);
    let before = kept(&followed).1;
    followed.advance(1e-8).unwrap();
    let (flags, offset) = kept(&followed);
    assert!(flags & TOUCHING != 0 && offset[3] < before[3], "{flags} {offset:?} {before:?}");
    let mut simulation = pair("none", "[1.0, 0.0, 0.0]", 1.0, 1e-8);
    let before = kept(&simulation);
    assert!(is_resting(before.0) && before.0 & TOUCHING == 0, "{before:?}");
    while living(&simulation) > 0 {
        assert_eq!(kept(&simulation), before);
        assert_eq!(simulation.largest_overlap(), 0.0, "nothing presses there");
        simulation.advance(1e-8).unwrap();
    }
    let (flags, offset) = kept(&simulation);
    assert_eq!(flags, TOUCHING | RELEASED);
    assert!((offset[3] / 1e-3 - simulation.largest_overlap()).abs() < 1e-12, "{offset:?}");
}

/// Two spheres whose bond breaks while they are pressed together.
fn pressed(step: f64) -> Simulation {
    let text = PAIR
        .replace("CONTACT", "without_normal")
        .replace("VELOCITY", "[-2.0, 0.0, 0.0]")
        .replace("RESTITUTION", "1.0")
        .replace("STEP", &format!("{step:?}"))
        .replace("max_distance = 1.984e-3", "max_normal_stress = 5.0e4\ncompression_breaks = true");
    start(&text)
}

#[test]
fn a_pair_that_breaks_under_pressure_is_stopped_by_the_overlap_beyond_what_was_left() {
    let trial = |step: f64| {
        let mut simulation = pressed(step);
        while living(&simulation) > 0 {
            simulation.advance(step).unwrap();
        }
        let (mut most, mut energies) = (0.0_f64, Vec::new());
        for _ in 0..(2e-5 / step) as usize {
            simulation.advance(step).unwrap();
            most = most.max(simulation.elastic_energy());
            energies.push(simulation.elastic_energy() + simulation.kinetic_energy());
        }
        let (low, high) = energies.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), e| (low.min(*e), high.max(*e)));
        let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
        let residual = simulation.energy_residual().expect("the scene keeps a book");
        assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
        (most / energies[0], (high - low) / energies[0])
    };
    let (share, coarse) = trial(1e-8);
    let (_, fine) = trial(5e-9);
    assert!(share > 0.1, "the contact takes {share} of the energy");
    assert!(coarse < 1e-5 && (coarse / fine - 4.0).abs() < 0.5, "{coarse:e} and {fine:e} at half the step");
}

#[test]
fn a_bond_made_anew_suppresses_the_contact_again() {
    let text = PAIR
        .replace("CONTACT", "none")
        .replace("VELOCITY", "[1.0, 0.3, 0.0]")
        .replace("RESTITUTION", "0.5")
        .replace("STEP", "1e-7")
        .replace("create_distance = 2.0e-3", "create_distance = 1.9835e-3\ncreate = \"always\"");
    let mut simulation = start(&text);
    // At time 0 nothing is bonded: the contact acts, also in the step in which the bond is made.
    assert!(simulation.state().particles.force[0][0] < 0.0);
    simulation.advance(1e-7).unwrap();
    assert_eq!(living(&simulation), 1);
    assert!(simulation.state().particles.force[0][0] < 0.0);
    simulation.advance(1e-7).unwrap();
    assert_eq!(simulation.contact_count(), 0, "suppressed from the next step on");
    let mut breaks = 0;
    for _ in 0..200 {
        simulation.advance(1e-7).unwrap();
        breaks += simulation.state().breaks.len();
    }
    assert!(breaks > 0, "it breaks");
    let (ledger, residual) = (simulation.state().ledger.as_ref().unwrap(), simulation.energy_residual().unwrap());
    assert!(residual.abs() < 1e-12 * ledger.turnover);
}

/// A block that overlaps, glued to a plane that it overlaps too, and thrown sideways, half of it faster than the
/// other half.
const BLOCK: &str = r#"
[run]
step = 2.0e-7
threads = THREADS
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
cohesion_energy_density = 1.0e4
rolling_friction = 0.1
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[contact.touch.cohesion.sjkr]
[particles.slow]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [15, 15, 5], spacing = 2.0e-3, radius = 1.01e-3 }
velocity = [1.0, 0.3, 0.0]
[particles.fast]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.01], counts = [15, 15, 4], spacing = 2.0e-3, radius = 1.01e-3 }
velocity = [3.0, -1.0, -0.5]
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
motion = { prescribed = { z = -0.2 } }
[bond.slow]
between = ["slow", "slow"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
contact = "none"
breakage = { max_normal_stress = 4.0e6, max_shear_stress = 4.0e6 }
[bond.fast]
between = ["slow", "fast"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
contact = "without_normal"
breakage = { max_normal_stress = 4.0e6, max_shear_stress = 4.0e6 }
[bond.top]
between = ["fast", "fast"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.glue]
between = ["slow", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
contact = "without_normal"
breakage = { max_normal_stress = 2.0e6, max_shear_stress = 2.0e6 }
[output]
energy = true
"#;

/// That scene with this many threads.
fn block(threads: usize) -> Simulation {
    start(&BLOCK.replace("THREADS", &threads.to_string()))
}

/// Runs some communication steps. Returns how many bonds broke.
fn run(simulation: &mut Simulation, steps: usize) -> usize {
    let step = |_| {
        simulation.advance(2.0e-6).expect("it runs");
        simulation.state().breaks.len()
    };
    (0..steps).map(step).sum()
}

#[test]
fn threads_widths_and_saved_states_give_the_same_bits_and_the_book_closes() {
    let mut first = block(1);
    // How many contacts have a flag, between spheres and at the plane.
    let flagged = |simulation: &Simulation, flag: u8| {
        let count = |flags: &[u8]| flags.iter().filter(|flags| **flags & flag != 0).count();
        let State { contacts, walls, .. } = simulation.state();
        [count(&contacts[0].flags), count(&walls[0].flags)]
    };
    let spheres_below = 15 * 15;
    let between = 2 * 14 * 15 * 5 + spheres_below * 4 + spheres_below;
    assert_eq!(flagged(&first, BONDED), [between, spheres_below]);
    let broken = run(&mut first, 12);
    let bytes = first.state().to_bytes(first.scene().fingerprint);
    let broken = broken + run(&mut first, 12);
    assert!(broken > 50, "{broken} bonds broke");
    let over = flagged(&first, RELEASED).iter().sum::<usize>();
    assert!(over > 5, "{over} contacts beyond an offset");
    let expected = first.state().fingerprint();
    let residual = first.energy_residual().expect("the scene keeps a book");
    let turnover = first.state().ledger.as_ref().expect("the scene keeps a book").turnover;
    assert!(residual.abs() < 1e-12 * turnover, "{residual:e} J of {turnover:e} J");

    let state = State::from_bytes(&bytes, first.scene().fingerprint).expect("the bytes are whole");
    let mut resumed = Simulation::resume(first.scene().clone(), state).unwrap();
    run(&mut resumed, 12);
    assert_eq!(resumed.state().fingerprint(), expected, "through bytes");
    for threads in 2..=4 {
        let mut other = block(threads);
        assert_eq!(other.threads(), threads, "enough particles for them");
        assert_eq!(run(&mut other, 24), broken);
        assert_eq!(other.state().fingerprint(), expected, "{threads} threads");
    }
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        let mut other = block(1);
        other.set_width(width);
        run(&mut other, 24);
        assert_eq!(other.state().fingerprint(), expected, "{width:?}");
    }
}
