//! A jammed bed that drifts with its walls feels what it feels at rest: history survives every new order.
//!
//! Without gravity a uniform motion changes nothing but rounding. A random packing is pressed and sheared between driven
//! walls until it is jammed and its contacts have slid, and damped to rest. Then everything moves 100 diameters while
//! lists are made again and again, with wide skins and narrow ones: cells of other sizes put the particles in other
//! orders.

use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::{ContactRecord, Simulation};
use std::fmt::Write;

/// Walls around the bed: name, axis, place \[m\], direction of the normal.
const WALLS: [(&str, usize, f64, f64); 6] = [
    ("west", 0, 0.0, 1.0),
    ("east", 0, WIDTH, -1.0),
    ("south", 1, 0.0, 1.0),
    ("north", 1, WIDTH, -1.0),
    ("floor", 2, 0.0, 1.0),
    ("lid", 2, WIDTH, -1.0),
];

/// Mean diameter \[m\].
const DIAMETER: f64 = 0.01;

/// Distance of opposite walls \[m\].
const WIDTH: f64 = 7.0 * DIAMETER;

/// Volume of the spheres over that between the walls.
const FILLED: f64 = 0.52;

/// How far opposite walls come nearer, over their distance: spheres then fill 0.61, and cannot but press.
const SQUEEZED: f64 = 0.05;

/// How far floor and lid are sheared, over their distance.
const SHEARED: f64 = 0.03;

/// Friction of the spheres.
const FRICTION: f64 = 0.3;

/// The time step \[s\].
const STEP: f64 = 1.0e-5;

/// Skins over the mean diameter: cells of other sizes.
const SKINS: [f64; 7] = [0.05, 0.2, 0.4, 0.6, 0.9, 1.2, 1.6];

/// The scene: bed and walls.
fn simulation() -> Simulation {
    let mut text = format!(
        r#"
[run]
step = {STEP:e}
threads = 1
[material.grain]
youngs_modulus = 5.0e6
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.3
friction = {FRICTION}
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "grain"
packing = {{ box = [[0.0, 0.0, 0.0], [{WIDTH}, {WIDTH}, {WIDTH}]], solid_fraction = {FILLED}, radius = [0.0045, 0.0055] }}
"#
    );
    for (name, axis, place, sign) in WALLS {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        (point[axis], normal[axis]) = (place, sign);
        writeln!(
            text,
            "[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"grain\"\n\
             motion = {{ driven = [\"x\", \"y\", \"z\"] }}"
        )
        .expect("text grows");
    }
    start(&text)
}

/// Puts all walls where they end up after this drift, the bed being squeezed and sheared by these fractions.
fn set_walls(simulation: &mut Simulation, drift: [f64; 3], squeezed: f64, sheared: f64) {
    for (index, (_, axis, _, sign)) in WALLS.into_iter().enumerate() {
        for along in 0..3 {
            let squeeze = if along == axis { 0.5 * sign * squeezed * WIDTH } else { 0.0 };
            let shear = if axis == 2 && along == 0 { -0.5 * sign * sheared * WIDTH } else { 0.0 };
            simulation.set_input(BoundaryIndex(index as u32), along, drift[along] + squeeze + shear);
        }
    }
}

/// Tangential force over the largest that friction allows.
fn mobilised(contact: &ContactRecord) -> f64 {
    contact.tangential_force.iter().map(|part| part * part).sum::<f64>().sqrt() / (FRICTION * contact.normal_force)
}

/// Forces on the bed's spheres in the scene's order, then on the walls \[N\].
fn forces(simulation: &Simulation) -> Vec<[f64; 3]> {
    let particles = &simulation.state().particles;
    let bed = (0..particles.len()).map(|index| {
        let [x, y, z, _] = particles.force[particles.slot[index] as usize];
        [x, y, z]
    });
    bed.chain(simulation.state().boundaries.iter().map(|boundary| boundary.force)).collect()
}

#[test]
fn a_jammed_bed_that_drifts_with_its_walls_feels_what_it_feels_at_rest() {
    let mut still = simulation();
    let mut damped = simulation();
    damped.damp_rest(0.7);
    let mut slid = 0;
    for step in 1..=100 {
        let part = f64::from(step) / 100.0;
        set_walls(&mut damped, [0.0; 3], SQUEEZED * part.min(0.5) * 2.0, SHEARED * (part - 0.5).max(0.0) * 2.0);
        damped.advance(20.0 * STEP).expect("it runs");
        slid = slid.max(damped.contacts().iter().filter(|contact| contact.sliding).count());
    }
    damped.advance(20_000.0 * STEP).expect("it comes to rest");
    still.restore(damped.state()).unwrap();
    let mut drifting = simulation();
    drifting.restore(damped.state()).unwrap();

    // A tenth of a radius in each step, askew.
    let way = [0.8, 0.48, -0.36].map(|part| part * 0.05 * DIAMETER);
    let mut state = drifting.state().clone();
    for slot in 0..state.particles.velocity.len() {
        for axis in 0..3 {
            state.particles.velocity[slot][axis] += way[axis] / STEP;
        }
    }
    drifting.restore(&state).unwrap();
    let first = forces(&still);
    let largest = first.iter().flatten().fold(0.0_f64, |most, part| most.max(part.abs()));
    let lists = &drifting.state().contacts[0];
    let springs = lists.history.all().chunks_exact(lists.history.rows()).map(|rows| rows[0]);
    let loaded = springs.filter(|spring| spring[..3].iter().any(|part| part.abs() > 1e-9)).count();
    assert!(largest > 1.0 && loaded > 2 * first.len(), "{largest} N, {loaded} springs loaded");
    for plane in [false, true] {
        let shares: Vec<f64> =
            still.contacts().iter().filter(|at| at.boundary.is_some() == plane).map(mobilised).collect();
        let (count, most) = (shares.len(), shares.iter().copied().fold(0.0, f64::max));
        assert!(count > 150 && most > 0.99, "{count} contacts, planes: {plane}; up to {most} of their friction acts");
    }
    assert!(slid > 200, "{slid} contacts slid at once");

    let rebuilds = drifting.state().clock.rebuilds;
    let (mut order, mut resorted) = (drifting.state().particles.id.clone(), 0);
    let steps = 2000;
    for step in 1..=steps {
        let drift = way.map(|way| way * f64::from(step));
        set_walls(&mut drifting, drift, SQUEEZED, SHEARED);
        drifting.advance(STEP).expect("it drifts");
        if step % 40 == 0 {
            let mut state = drifting.state().clone();
            state.neighbours.skin = SKINS[step as usize / 40 % SKINS.len()] * DIAMETER;
            drifting.restore(&state).unwrap();
            drifting.renew_lists();
        }
        let now = &drifting.state().particles.id;
        if *now != order {
            (order, resorted) = (now.clone(), resorted + 1);
        }
    }
    still.advance(f64::from(steps) * STEP).expect("it rests");
    let distance = way.iter().map(|way| way * way).sum::<f64>().sqrt() * f64::from(steps) / DIAMETER;
    let renewed = drifting.state().clock.rebuilds - rebuilds;
    assert!(distance > 99.9 && renewed > 100, "{distance} diameters, lists made {renewed} times");
    assert!(resorted > 30, "the particles were put in another order {resorted} times");
    for (moving, resting) in forces(&drifting).iter().zip(forces(&still)) {
        for axis in 0..3 {
            let change = (moving[axis] - resting[axis]).abs() / largest;
            assert!(change < 1e-9, "{change:e} of the largest force, {moving:?} N and {resting:?} N");
        }
    }
    for (after, before) in forces(&still).iter().zip(&first) {
        assert!((0..3).all(|axis| (after[axis] - before[axis]).abs() < 1e-6 * largest), "{after:?} N, {before:?} N");
    }
}
