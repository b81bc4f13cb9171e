//! Neighbour lists hold what they must, whatever the sizes; motion alone asks for new ones.

use crate::support::start_with;
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Numbers between 0 and 1 that look random and are the same everywhere.
struct Numbers(u64);

impl Numbers {
    /// The next one.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A simulation of a scene whose particles stand in `bed.csv`.
fn simulation(text: &str, bed: String) -> Simulation {
    let files = BTreeMap::from([("bed.csv".to_string(), bed.into_bytes())]);
    start_with(text, files)
}

/// Spheres of four sizes, 1:20, anywhere in a box: they overlap as they like.
const MIXTURE: &str = r#"
[run]
step = 1.0e-7
threads = THREADS
skin = 2.0e-4
max_overlap = 1.0e9
[material.grain]
youngs_modulus = 1.0e5
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "grain"
file = "bed.csv"
"#;

/// The mixture with this many threads.
fn mixture(threads: usize) -> Simulation {
    let mut numbers = Numbers(7);
    let mut bed = String::from("x,y,z,radius\n");
    for (radius, count) in [(2.0e-2, 4), (1.0e-2, 30), (4.0e-3, 400), (1.0e-3, 2600)] {
        for _ in 0..count {
            let [x, y, z] = [0.2, 0.05, 0.05].map(|width| width * numbers.next());
            writeln!(bed, "{x},{y},{z},{radius}").expect("text grows");
        }
    }
    simulation(&MIXTURE.replace("THREADS", &threads.to_string()), bed)
}

#[test]
fn lists_of_a_mixture_hold_every_near_pair_once_and_reach_no_further_than_the_next_slab() {
    let simulation = mixture(1);
    let state = simulation.state();
    let (list, position) = (&state.contacts[0], &state.particles.position);
    let listed: Vec<(u32, u32)> = list.first.iter().copied().zip(list.second.iter().copied()).collect();
    assert!(listed.is_sorted() && listed.iter().all(|(i, j)| i < j), "ordered by the first, then the second");
    let mut near = BTreeSet::new();
    for i in 0..position.len() {
        for j in i + 1..position.len() {
            let (a, b) = (position[i], position[j]);
            let square: f64 = (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum();
            let reach = a[3] + b[3] + state.neighbours.skin;
            if square < reach * reach {
                near.insert((i as u32, j as u32));
            }
        }
    }
    assert!(near.len() > 2000, "{} pairs", near.len());
    assert_eq!(listed.len(), near.len(), "pairs");
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), near);
    let slabs = &state.neighbours.slabs;
    let slab = |slot: u32| slabs.partition_point(|&first| first <= slot);
    assert!(slabs.len() > 3, "{} slabs", slabs.len());
    assert!(listed.iter().all(|&(i, j)| slab(j) - slab(i) < 2));
}

#[test]
fn lists_of_a_mixture_are_the_same_for_threads_and_lane_widths() {
    let mut first = mixture(1);
    first.renew_lists();
    let expected = first.state().fingerprint();
    for threads in 2..=4 {
        let mut other = mixture(threads);
        assert_eq!(other.threads(), threads);
        other.renew_lists();
        assert_eq!(other.state().fingerprint(), expected, "{threads} threads");
    }
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        let mut other = mixture(1);
        other.set_width(width);
        other.renew_lists();
        assert_eq!(other.state().fingerprint(), expected, "{width:?}");
    }
}

/// A block of spheres in contact that falls apart between two planes.
const BLOCK: &str = r#"
[run]
step = 1.0e-5
threads = 2
SKIN
[material.grain]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.5
friction = 0.5
LAW
[particles.bed]
material = "grain"
file = "bed.csv"
velocity = [0.0, 0.0, -2.0]
BONDS
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "grain"
motion = { driven = ["z"] }
"#;

/// A contact law.
const LAW: &str = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";

/// A bond law.
const BONDS: &str = "[bond.glue]\nformulation = \"incremental\"\nbetween = [\"bed\", \"bed\"]\ncreate_distance = 8.4e-3\n\
                     normal_stiffness = 1.0e9\ntangential_stiffness = 4.0e8";

/// The block with this skin, contact law and bonds.
fn block(skin: &str, law: &str, bonds: &str) -> Simulation {
    let mut numbers = Numbers(11);
    let mut bed = String::from("x,y,z,radius\n");
    for n in 0..14 * 14 * 12 {
        let [x, y, z] = [n % 14, n / 14 % 14, n / 196].map(|k| 5.0e-3 + 8.0e-3 * f64::from(k));
        let [dx, dy, dz] = [0; 3].map(|_| 1.0e-4 * numbers.next());
        writeln!(bed, "{},{},{},4.0e-3", x + dx, y + dy, z + dz).expect("text grows");
    }
    simulation(&BLOCK.replace("SKIN", skin).replace("LAW", law).replace("BONDS", bonds), bed)
}

/// Runs so many time steps, with a floor that moves; lists are renewed after each `every`.
fn run(simulation: &mut Simulation, steps: usize, every: usize) {
    for step in 1..=steps {
        simulation.set_input(BoundaryIndex(0), 2, 2.0e-6 * (step % 5) as f64);
        simulation.advance(1.0e-5).expect("it runs");
        if step % every == 0 {
            simulation.renew_lists();
        }
    }
}

/// Largest difference of any particle's position \[m\]; of its velocity, angular velocity, force and torque, each over
/// the largest there is of the kind.
fn apart(a: &Simulation, b: &Simulation) -> [f64; 5] {
    let (of_a, of_b) = (&a.state().particles, &b.state().particles);
    let pairs = [
        (&of_a.position, &of_b.position),
        (&of_a.velocity, &of_b.velocity),
        (&of_a.angular_velocity, &of_b.angular_velocity),
        (&of_a.force, &of_b.force),
        (&of_a.torque, &of_b.torque),
    ];
    let mut differences = pairs.map(|(a, b)| {
        let (mut difference, mut largest) = (0.0_f64, f64::MIN_POSITIVE);
        for (&slot_a, &slot_b) in of_a.slot.iter().zip(&of_b.slot) {
            let (a, b) = (a[slot_a as usize], b[slot_b as usize]);
            for axis in 0..3 {
                difference = difference.max((a[axis] - b[axis]).abs());
                largest = largest.max(b[axis].abs());
            }
        }
        [difference, difference / largest]
    });
    differences[0][1] = differences[0][0];
    differences.map(|[_, relative]| relative)
}

/// Bonds among the spheres and to the floor, which break.
fn breaking(formulation: &str) -> String {
    // The engine keeps of the bending torque what lies along the present rate of bending, a direction that rounding alone
    // decides where that rate passes zero: there its own law makes 1e-10 of rounding.
    let bending = formulation != "engine_exact";
    let law = |name: &str, with: &str, distance: &str| {
        format!(
            "[bond.{name}]\nformulation = \"{formulation}\"\nbetween = [\"bed\", \"{with}\"]\n\
             create_distance = {distance}\nnormal_stiffness = 1.0e8\ntangential_stiffness = 4.0e7\n\
             bending = {bending}\nbreakage = {{ max_normal_stress = 2.0e3, max_shear_stress = 2.0e3 }}\n"
        )
    };
    law("glue", "bed", "8.2e-3") + &law("base", "floor", "1.02e-2")
}

#[test]
fn renewed_lists_and_another_skin_change_rounding_only() {
    let broken = |simulation: &Simulation| simulation.state().bonds.iter().map(|list| list.broken).collect::<Vec<_>>();
    for formulation in ["", "finite_rotation", "incremental", "engine_exact"] {
        let bonds = if formulation.is_empty() { String::new() } else { breaking(formulation) };
        let mut plain = block("", LAW, &bonds);
        run(&mut plain, 100, usize::MAX);
        let walls: usize = plain.contacts().iter().filter(|contact| contact.boundary.is_some()).count();
        assert!(broken(&plain).iter().all(|&broken| broken > 0), "{:?} bonds broke", broken(&plain));
        assert!(plain.contact_count() > 3000 && walls > 0, "{} contacts, {walls} at the floor", plain.contact_count());
        for (skin, every) in [("", 3), ("skin = 2.0e-4", usize::MAX), ("skin = 3.0e-3", 7)] {
            let mut other = block(skin, LAW, &bonds);
            run(&mut other, 100, every);
            assert_eq!(broken(&other), broken(&plain));
            let apart = apart(&plain, &other);
            let rounding = apart.iter().all(|apart| *apart < 1e-12);
            assert!(rounding, "{formulation}, {skin:?}, renewed after {every}: {apart:?}");
        }
    }
}

#[test]
fn the_chosen_skin_widens_with_fast_motion_and_is_kept_in_the_state() {
    let mut block = block("", LAW, "");
    let before = block.state().neighbours.skin;
    run(&mut block, 400, usize::MAX);
    let after = block.state().neighbours.skin;
    assert!(after > 1.5 * before && after <= 4.0e-3, "skin {before:e} m became {after:e} m");
    let (renewed, skin) = (block.state().clock.rebuilds, block.scene().run.skin);
    assert!(renewed > 2 && renewed < 40 && skin.is_none(), "{renewed} lists");
}

#[test]
fn a_given_skin_is_kept_and_lists_are_made_when_motion_has_used_it_up() {
    let mut block = block("skin = 1.0e-3", LAW, "");
    let before = block.state().clock.rebuilds;
    run(&mut block, 300, usize::MAX);
    assert_eq!(block.state().neighbours.skin, 1.0e-3);
    // 6 mm at 2 m/s; two spheres may use up a skin with half of it each.
    let renewed = block.state().clock.rebuilds - before;
    assert!((10..=20).contains(&renewed), "{renewed} lists");
}

#[test]
fn a_swing_within_the_skin_asks_for_no_new_lists_however_long_it_lasts() {
    let still = BLOCK.replace("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, 0.0, 0.0]");
    let text = still.replace("SKIN", "skin = 1.0e-3").replace("LAW", LAW).replace("BONDS", BONDS);
    let bed = "x,y,z,radius,vx\n0.005,0.005,0.01,0.004,0.2\n0.0131,0.005,0.01,0.004,-0.2\n";
    let mut swinging = simulation(&text, bed.into());
    let before = swinging.state().clock.rebuilds;
    let (mut way, mut farthest) = (0.0, 0.0_f64);
    for _ in 0..3000 {
        swinging.advance(1.0e-5).expect("it runs");
        let particles = &swinging.state().particles;
        way += 1.0e-5 * particles.velocity[0][0].abs();
        farthest = farthest.max((particles.position[particles.slot[0] as usize][0] - 0.005).abs());
    }
    assert!(way > 2.0e-3 && farthest < 4.0e-4, "{way:e} m there and back, {farthest:e} m away");
    assert_eq!(swinging.state().clock.rebuilds, before);
}

#[test]
fn no_lists_are_made_while_only_bonds_act() {
    let mut block = block("", "", BONDS);
    let before = block.state().clock.rebuilds;
    run(&mut block, 300, usize::MAX);
    assert_eq!(block.state().clock.rebuilds, before);
    assert!(block.state().contacts.is_empty());
}
