//! Clumps: rigid bodies of several spheres, against closed forms, against groups, and their books and bits.

use crate::support::{read, read_with, start};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::statics::stiffness;
use cograin_sparse::factorise;
use std::sync::Arc;

/// A material and a law without friction and damping.
const ELASTIC: &str = r#"
[material.a]
density = 2000.0
youngs_modulus = 1.0e9
poissons_ratio = 0.3
[pair.a.a]
restitution = 1.0
[contact.touch.normal.hertz]
"#;

/// A clump of three spheres of unequal size that no axis goes through.
const TOP: &str = r#"
[clump.top]
spheres = [
    { position = [0.0, 0.0, 0.0], radius = 0.1 },
    { position = [0.3, 0.1, 0.0], radius = 0.08 },
    { position = [0.0, 0.5, 0.2], radius = 0.12 },
]
"#;

/// Length of a difference.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The first three numbers of a row.
fn three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// Kinetic energy \[J\] and angular momentum about the origin \[kg m²/s\] of spheres that do not overlap.
fn of_spheres(simulation: &Simulation) -> (f64, [f64; 3]) {
    let particles = &simulation.state().particles;
    let (mut energy, mut angular) = (0.0, [0.0; 3]);
    for (index, sphere) in simulation.scene().particles.iter().enumerate() {
        let slot = particles.slot[index] as usize;
        let (p, v, w) = (particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]);
        let (mass, inertia) = (sphere.mass(), sphere.inertia());
        let arm = [p[1] * v[2] - p[2] * v[1], p[2] * v[0] - p[0] * v[2], p[0] * v[1] - p[1] * v[0]];
        for axis in 0..3 {
            angular[axis] += mass * arm[axis] + inertia * w[axis];
            energy += 0.5 * mass * v[axis] * v[axis] + 0.5 * inertia * w[axis] * w[axis];
        }
    }
    (energy, angular)
}

#[test]
fn a_clump_that_nothing_touches_keeps_energy_and_angular_momentum_over_a_million_steps() {
    let mut simulation = start(&format!(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 1000.0
{TOP}
[particles.p]
material = "a"
clump = "top"
list = [{{ position = [0.0, 0.0, 0.0], angular_velocity = [3.0, -8.0, 14.0], orientation = [0.4, 0.1, -0.7, 0.3] }}]
"#
    ));
    let (energy, angular) = of_spheres(&simulation);
    let told = simulation.kinetic_energy();
    assert!((told / energy - 1.0).abs() < 1e-14, "{told} J, {energy} J by its spheres");
    let size = angular.iter().map(|part| part * part).sum::<f64>().sqrt();
    for _ in 0..10 {
        simulation.advance(100.0).expect("it runs");
        let (now, turned) = of_spheres(&simulation);
        assert!((now / energy - 1.0).abs() < 1e-12, "{now:e} J, {energy:e} J expected");
        assert!(apart(turned, angular) < 1e-12 * size, "{turned:?}, {angular:?} expected");
    }
    assert_eq!(simulation.state().clock.steps, 1_000_000);
}

#[test]
fn mass_and_inertia_of_spheres_apart_are_those_of_the_solids() {
    let simulation = start(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 1000.0
[clump.pair]
spheres = [{ position = [5.0, 1.0, 2.0], radius = 0.5 }, { position = [5.0, 2.0, 2.0], radius = 0.5 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 3.0] }, { position = [2.0, 0.0, 3.0], scale = 2.0 }]
"#,
    );
    let clumps = &simulation.state().clumps;
    for (clump, scale) in [(0, 1.0_f64), (1, 2.0)] {
        let sphere = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125 * scale.powi(3);
        let square = 0.25 * scale * scale;
        let expected = [(0.4 + 1.0) * 2.0, 0.4 * 2.0, (0.4 + 1.0) * 2.0].map(|factor| factor * sphere * square);
        assert!((clumps.velocity[clump][3] / (2.0 * sphere) - 1.0).abs() < 1e-14);
        let mut found = three(clumps.moments[clump]);
        found.sort_by(f64::total_cmp);
        let mut expected = expected;
        expected.sort_by(f64::total_cmp);
        assert!(apart(found, expected) < 1e-12 * expected[2], "{found:?}, {expected:?} expected");
    }
    let particles = &simulation.state().particles;
    assert!(apart(three(particles.position[0]), [0.0, -0.5, 3.0]) < 1e-14, "placed by its mass centre");
    assert!(apart(three(particles.position[3]), [2.0, 1.0, 3.0]) < 1e-14);
}

/// A clump of two spheres, turned by an angle about y from x, just above a floor without friction.
fn falling_pair(angle: f64, speed: f64) -> Simulation {
    let (w, y) = ((0.5 * angle).cos(), (0.5 * angle).sin());
    let height = 0.01 + 0.01 * angle.sin().abs() + 1e-9;
    start(&format!(
        r#"
[run]
step = 2.0e-8
{}
[clump.pair]
spheres = [{{ position = [-0.01, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.01, 0.0, 0.0], radius = 0.01 }}]
[particles.p]
material = "a"
clump = "pair"
list = [{{ position = [0.0, 0.0, {height:?}], orientation = [{w:?}, 0.0, {y:?}, 0.0], velocity = [0.0, 0.0, {:?}] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#,
        ELASTIC.replace("1.0e9", "1.0e11"),
        -speed
    ))
}

#[test]
fn two_spheres_on_a_plate_get_impulse_and_spin_as_in_closed_form() {
    for angle in [0.3, 0.8, 1.2, -0.8] {
        let speed = 1e-3;
        let mut simulation = falling_pair(angle, speed);
        // Long enough for the impact, not for the other sphere to come down.
        simulation.advance(6.0e-4).expect("it runs");
        assert_eq!(simulation.contact_count(), 0);
        // The plate pushes the lower sphere at the lever h: P (1/M + h²/J) = (1 + e) v.
        let lever = 0.01 * angle.cos() * angle.signum();
        let (over_mass, square) = (1.0 / 2.0, 1e-4);
        let over_inertia = 1.0 / (2.0 * (0.4 + 1.0) * square);
        let impulse = 2.0 * speed / (over_mass + lever * lever * over_inertia);
        let clumps = &simulation.state().clumps;
        let (velocity, spin) = (clumps.velocity[0][2], clumps.angular_velocity[0]);
        let expected = (impulse * over_mass - speed, -lever * impulse * over_inertia);
        // It turns by 1e-5 rad and presses itself in by 1e-4 of the radius while it touches.
        assert!((velocity - expected.0).abs() < 3e-4 * speed, "{angle}: {velocity} m/s, {} expected", expected.0);
        assert!((spin[1] - expected.1).abs() < 3e-4 * expected.1.abs(), "{angle}: {spin:?}, {} expected", expected.1);
        assert!(spin[0].abs() + spin[2].abs() < 1e-12 * spin[1].abs(), "{spin:?}");
    }
}

#[test]
fn a_flat_pair_comes_back_with_the_restitution_of_its_law() {
    let text = |restitution: f64| {
        format!(
            r#"
[run]
step = 1.0e-7
[material.a]
density = 2000.0
youngs_modulus = 1.0e9
poissons_ratio = 0.3
[pair.a.a]
restitution = {restitution:?}
[contact.touch.normal.hertz]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]
[particles.p]
material = "a"
clump = "pair"
list = [{{ position = [0.0, 0.0, 0.0200001], velocity = [0.0, 0.0, -0.01] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#
        )
    };
    for restitution in [1.0, 0.7, 0.4] {
        let mut simulation = start(&text(restitution));
        simulation.advance(4e-3).expect("it runs");
        let found = simulation.state().clumps.velocity[0][2] / 0.01;
        // The dashpot sees the mass of the clump.
        assert!((found - restitution).abs() < 2e-3, "{found}, {restitution} expected");
    }
}

/// The same body falling onto a floor beside a loose sphere, as a clump or as a group.
fn tumbling(as_clump: bool) -> Simulation {
    let body = if as_clump {
        format!(
            "{TOP}\n[particles.top]\nmaterial = \"a\"\nclump = \"top\"\nlist = [{{ position = {CENTRE:?}, \
             velocity = [0.4, 0.0, -1.0], angular_velocity = [2.0, -1.0, 3.0] }}]"
        )
    } else {
        let [x, y, z] = START;
        let sphere = |[a, b, c]: [f64; 3], radius: f64| {
            let place = [x + a, y + b, z + c];
            let arm = [place[0] - CENTRE[0], place[1] - CENTRE[1], place[2] - CENTRE[2]];
            let w = [2.0, -1.0, 3.0];
            let v = [
                0.4 + w[1] * arm[2] - w[2] * arm[1],
                w[2] * arm[0] - w[0] * arm[2],
                -1.0 + w[0] * arm[1] - w[1] * arm[0],
            ];
            format!("{{ position = {place:?}, radius = {radius:?}, velocity = {v:?}, angular_velocity = {w:?} }}")
        };
        format!(
            "[particles.top]\nmaterial = \"a\"\nlist = [{}, {}, {}]\n[boundary.top]\nparticles = {{ set = \"top\" }}\n\
             motion = {{ free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }}",
            sphere([0.0, 0.0, 0.0], 0.1),
            sphere([0.3, 0.1, 0.0], 0.08),
            sphere([0.0, 0.5, 0.2], 0.12),
        )
    };
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
{}
[contact.touch.tangential.history]
{body}
[particles.z]
material = "a"
list = [{{ position = [0.55, 0.2, 0.10001], radius = 0.1 }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#,
        ELASTIC.replace("1.0e9", "1.0e7").replace("restitution = 1.0", "restitution = 1.0\nfriction = 0.3")
    ))
}

/// Where the first sphere of the body stands, and its mass centre.
const START: [f64; 3] = [0.0, 0.0, 0.3];
/// Masses go as the cubes of 10, 8 and 12.
const CENTRE: [f64; 3] = [0.3 * 512.0 / 3240.0, (0.1 * 512.0 + 0.5 * 1728.0) / 3240.0, 0.3 + 0.2 * 1728.0 / 3240.0];

#[test]
fn a_clump_moves_as_a_free_group_of_its_spheres() {
    let (mut clump, mut group) = (tumbling(true), tumbling(false));
    for _ in 0..4 {
        clump.advance(0.05).expect("it runs");
        group.advance(0.05).expect("it runs");
        for index in 0..4 {
            let place = |simulation: &Simulation| {
                let particles = &simulation.state().particles;
                let slot = particles.slot[index] as usize;
                (three(particles.position[slot]), three(particles.angular_velocity[slot]))
            };
            let ((a, u), (b, v)) = (place(&clump), place(&group));
            // Impacts make roundings larger.
            assert!(apart(a, b) < 1e-9 && apart(u, v) < 1e-7, "sphere {index}: {a:?} {u:?}, {b:?} {v:?} in a group");
        }
    }
    assert!(clump.state().clumps.velocity[0][2] > -1.5, "it has touched the floor");
    assert_ne!(clump.state().particles.angular_velocity[clump.state().particles.slot[3] as usize][0], 0.0);
}

/// A bed of pairs and triples that falls into a box, with loose spheres among them.
fn bed(threads: usize, scale: f64, more: &str) -> String {
    let l = |length: f64| format!("{:?}", length * scale);
    format!(
        r#"
gravity = [0.0, 0.0, {}]
[run]
step = 1.0e-5
threads = {threads}
[material.a]
density = 2500.0
youngs_modulus = {:?}
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.5
friction = 0.4
rolling_friction = 0.05
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.epsd2]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = {r} }}, {{ position = [{d}, 0.0, 0.0], radius = {r} }}]
[clump.bent]
spheres = [
    {{ position = [0.0, 0.0, 0.0], radius = {r} }},
    {{ position = [{d}, 0.0, 0.0], radius = {r} }},
    {{ position = [{d}, {d}, 0.0], radius = {s} }},
]
[particles.pairs]
material = "a"
clump = "pair"
orientation = "random"
velocity = [{}, {}, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {a}], counts = [9, 9, 8], radius = {b}, spacing = {c} }}
[particles.bent]
material = "a"
clump = "bent"
orientation = "random"
velocity = [0.0, 0.0, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {top}], counts = [9, 9, 3], radius = {b}, spacing = {c} }}
[particles.loose]
material = "a"
velocity = [0.0, 0.0, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {higher}], counts = [9, 9, 1], radius = {r}, spacing = {c} }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[boundary.west]
plane = {{ point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}
material = "a"
[boundary.east]
plane = {{ point = [{wide}, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}
material = "a"
[boundary.south]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }}
material = "a"
[boundary.north]
plane = {{ point = [0.0, {wide}, 0.0], normal = [0.0, -1.0, 0.0] }}
material = "a"
{more}
"#,
        l(-9.81),
        1e7 * scale * scale,
        l(0.5),
        l(0.3),
        l(-0.6),
        l(-1.0),
        l(-1.0),
        r = l(0.002),
        s = l(0.0015),
        d = l(0.003),
        a = l(0.005),
        b = l(0.0045),
        c = l(0.0095),
        top = l(0.082),
        higher = l(0.112),
        wide = l(0.086),
    )
}

/// A hash of the whole state.
fn bits(simulation: &Simulation) -> u64 {
    simulation.state().fingerprint()
}

#[test]
fn threads_lanes_saving_and_restoring_change_no_bit() {
    let books =
        "[output]\nenergy = true\nlosses = true\n[damping.all]\nlinear = 0.1\nangular = 0.1\ngravity_damped = false";
    for more in ["", books] {
        let mut one = start(&bed(1, 1.0, more));
        one.advance(0.008).expect("it runs");
        let saved = one.state().clone();
        one.advance(0.008).expect("it runs");
        for (threads, width) in [(2, Width::widest()), (3, Width::Least), (1, Width::Four)] {
            let mut other = start(&bed(threads, 1.0, more));
            other.set_width(width);
            other.advance(0.008).expect("it runs");
            assert_eq!(bits(&other), saved.fingerprint(), "{threads} threads, {width:?}");
            other.advance(0.001).expect("it runs");
            other.restore(&saved).expect("its own state");
            other.advance(0.008).expect("it runs");
            assert_eq!(bits(&other), bits(&one), "{threads} threads, {width:?}, restored");
        }
        assert!(one.contact_count() > 100, "{} contacts", one.contact_count());
    }
}

#[test]
fn a_scene_scaled_by_powers_of_two_gives_the_same_bits() {
    let (mut one, mut twice) = (start(&bed(1, 1.0, "")), start(&bed(1, 2.0, "")));
    one.advance(0.004).expect("it runs");
    twice.advance(0.004).expect("it runs");
    let (a, b) = (&one.state().clumps, &twice.state().clumps);
    for clump in 0..a.len() {
        for axis in 0..3 {
            assert_eq!(2.0 * a.position[clump][axis], b.position[clump][axis], "clump {clump}");
        }
        assert_eq!(a.orientation[clump], b.orientation[clump], "clump {clump}");
    }
}

#[test]
fn both_books_close_and_momentum_is_conserved() {
    for damping in ["", "[damping.all]\nlinear = 0.2\nangular = 0.1\ngravity_damped = true"] {
        let mut simulation = start(&bed(1, 1.0, &format!("[output]\nenergy = true\nlosses = true\n{damping}")));
        simulation.advance(0.02).expect("it runs");
        let turnover = simulation.state().ledger.as_ref().expect("a book").turnover;
        let residual = simulation.energy_residual().expect("a book");
        // Each of 2000 steps rounds.
        assert!(residual.abs() < 1e-12 * turnover, "{residual:e} J of {turnover:e} J");
        let physical = simulation.physical_residual().expect("a book");
        // The error of the time steps.
        assert!(physical.abs() < 2e-3 * turnover, "{physical:e} J of {turnover:e} J");
    }
}

#[test]
fn momentum_changes_by_the_impulses_of_boundaries_and_weight() {
    let mut simulation = start(&bed(1, 1.0, ""));
    let momentum = |simulation: &Simulation| {
        let mut sum = [0.0; 3];
        let particles = &simulation.state().particles;
        for [x, y, z, mass] in &simulation.state().clumps.velocity {
            sum.iter_mut().zip([x, y, z]).for_each(|(sum, part)| *sum += mass * part);
        }
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            let [x, y, z, mass] = particles.velocity[slot];
            sum.iter_mut().zip([x, y, z]).for_each(|(sum, part)| *sum += mass * part);
        }
        sum
    };
    let mass: f64 = simulation.scene().particles.iter().map(|it| it.mass()).sum();
    let before = momentum(&simulation);
    simulation.advance(0.02).expect("it runs");
    let after = momentum(&simulation);
    let impulse = |axis: usize| -simulation.state().boundaries.iter().map(|it| it.total_impulse[axis]).sum::<f64>();
    let size = mass * 9.81 * 0.02;
    for axis in 0..3 {
        let weight = if axis == 2 { -size } else { 0.0 };
        let rest = after[axis] - before[axis] - weight - impulse(axis);
        assert!(rest.abs() < 1e-11 * size, "along {axis}: {rest:e} N s of {size:e} N s");
    }
    assert!(impulse(2) > 0.1 * size, "the floor pushes");
}

#[test]
fn a_bed_comes_to_rest_and_a_checkpoint_of_it_is_where_another_scene_begins() {
    let settled = bed(1, 1.0, "[damping.all]\nlinear = 0.4\nangular = 0.4\ngravity_damped = true");
    let mut simulation = start(&settled);
    simulation.advance(0.1).expect("it runs");
    let (first, reached) = (simulation.scene().clone(), simulation.state().clone());
    let description = cograin::simulation::Description::of(&first, "settled.toml", simulation.time());
    let next = Arc::new(read(&bed(1, 1.0, "")).expect("a scene"));
    let (again, left) = Simulation::taken_over(next, &reached, &description).expect("it is taken over");
    assert!(left.is_empty(), "{left:?}");
    for (slot, row) in reached.particles.position.iter().enumerate() {
        let index = reached.particles.id[slot] as usize;
        let there = again.state().particles.position[again.state().particles.slot[index] as usize];
        assert!(apart(three(*row), three(there)) < 1e-15, "{row:?}, {there:?}");
    }
    assert_eq!(again.contact_count(), simulation.contact_count());
    assert!((again.kinetic_energy() - simulation.kinetic_energy()).abs() <= 1e-12 * simulation.kinetic_energy());
}

#[test]
fn the_stable_step_is_that_of_the_group_of_the_same_spheres() {
    let (clump, group) = (tumbling(true), tumbling(false));
    let (a, b) = (clump.stable_step(), group.stable_step());
    assert!((0.5..=2.0).contains(&(a / b)), "{a:e} s, {b:e} s in a group");
}

#[test]
fn a_bond_of_a_clump_and_a_particle_carries_both_and_keeps_momentum_and_energy() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-6
[material.a]
density = 2000.0
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.015, 0.0, 0.0], radius = 0.01 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 0.0], velocity = [0.0, 0.4, 0.0], angular_velocity = [0.0, 3.0, 20.0] }]
[particles.q]
material = "a"
list = [{ position = [0.03, 0.0, 0.0], radius = 0.01 }]
[bond.glue]
between = ["p", "q"]
create_distance = 0.024
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
formulation = "finite_rotation"
[output]
energy = true
"#,
    );
    assert_eq!(simulation.bonds().len(), 1, "none inside the clump");
    let energy = simulation.kinetic_energy();
    let momentum = |simulation: &Simulation| {
        let (clump, slot) = (simulation.state().clumps.velocity[0], simulation.state().particles.slot[2] as usize);
        let particle = simulation.state().particles.velocity[slot];
        [0, 1, 2].map(|axis| clump[3] * clump[axis] + particle[3] * particle[axis])
    };
    let before = momentum(&simulation);
    simulation.advance(0.05).expect("it runs");
    let whole = simulation.kinetic_energy() + simulation.bond_elastic_energy();
    assert!((whole / energy - 1.0).abs() < 1e-4, "{whole} J, {energy} J at the start");
    assert!(apart(momentum(&simulation), before) < 1e-12 * before[1], "{:?}", momentum(&simulation));
    let residual = simulation.energy_residual().expect("a book");
    assert!(residual.abs() < 1e-12 * simulation.state().ledger.as_ref().expect("a book").turnover, "{residual:e} J");
    // It has turned by about a radian, and the bond still joins the second sphere and the particle.
    let place = |index: usize| {
        let particles = &simulation.state().particles;
        three(particles.position[particles.slot[index] as usize])
    };
    assert!((apart(place(1), place(2)) / 0.0225 - 1.0).abs() < 1e-2, "{:?} {:?}", place(1), place(2));
    assert!((place(2)[1] - place(1)[1]).abs() > 0.005, "{:?} {:?}", place(1), place(2));
}

#[test]
fn a_region_counts_what_spheres_of_a_clump_overlap_once() {
    let simulation = start(
        r#"
[run]
step = 1.0e-6
[material.a]
density = 2000.0
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.01, 0.0, 0.0], radius = 0.01 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 0.0], velocity = [0.0, 0.4, 0.0], orientation = [1.0, 2.0, 3.0, 4.0] }]
[region.all]
box = [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]]
"#,
    );
    let content = cograin::averages::contents(&simulation)[0];
    // Two spheres less the lens: two caps of height r/2.
    let (r, pi): (f64, f64) = (0.01, std::f64::consts::PI);
    let volume = 8.0 / 3.0 * pi * r.powi(3) - 2.0 * pi * (0.5 * r).powi(2) * (r - 0.5 * r / 3.0);
    assert!((content.solid / volume - 1.0).abs() < 1e-12, "{} m³, {volume} expected", content.solid);
    assert!((content.mass / (2000.0 * volume) - 1.0).abs() < 1e-12, "{} kg", content.mass);
    assert!(apart(content.velocity, [0.0, 0.4, 0.0]) < 1e-15, "{:?}", content.velocity);
}

#[test]
fn a_derivative_is_the_difference_of_two_steps_and_leaves_no_trace() {
    let mut simulation = falling_pair(0.8, 1e-3);
    // To the middle of the impact; the derivative is that of the last step.
    for _ in 0..12 {
        simulation.advance_or_roll_back(1e-5).expect("it runs");
    }
    let before = simulation.state().clone();
    simulation.advance_or_roll_back(1e-5).expect("it runs");
    assert_eq!(simulation.contact_count(), 1);
    let interface = Interface::of(simulation.scene());
    let [force, input] =
        ["floor.mean_force.z", "floor.displacement.z"].map(|name| interface.find(name).expect("it is there"));
    let state = simulation.state().clone();
    let found = interface
        .derivatives(&mut simulation, &mut Derivatives::default(), (&[force], &[(input, 1.0)]))
        .expect("there is a derivative")[0];
    assert_eq!(simulation.state().fingerprint(), state.fingerprint());
    let mut at = |way: f64| {
        simulation.restore(&before).expect("its own state");
        interface.set(&mut simulation, input, Value::Real(way)).expect("an input");
        simulation.advance_or_roll_back(1e-5).expect("it runs");
        interface.value(&simulation, force).number()
    };
    let way = 1e-11;
    let expected = (at(way) - at(-way)) / (2.0 * way);
    assert!(expected < -1.0, "{expected} N/m: the floor is pressed");
    // The displacement of a derivative is 1e-13 m here, and places of 0.01 m are rounded to 2e-18 m.
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} N/m, {expected} N/m by differences");
}

#[test]
fn a_clump_between_two_plates_is_as_stiff_as_its_two_contacts() {
    for spheres in [1, 3] {
        let list: Vec<_> = (0..spheres)
            .map(|k| format!("{{ position = [0.0, 0.0, {:?}], radius = 0.01 }}", 0.015 * f64::from(k)))
            .collect();
        let (middle, top) = (0.0075 * f64::from(spheres - 1), 0.015 * f64::from(spheres - 1) + 0.01 - 1e-5);
        let simulation = start(&format!(
            r#"
[run]
step = 1.0e-7
{}
[contact.touch.tangential.history]
[clump.post]
spheres = [{}]
[particles.p]
material = "a"
clump = "post"
list = [{{ position = [0.0, 0.0, {middle:?}] }}]
[boundary.lid]
plane = {{ point = [0.0, 0.0, {top:?}], normal = [0.0, 0.0, -1.0] }}
material = "a"
[boundary.floor]
plane = {{ point = [0.0, 0.0, -0.00999], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#,
            ELASTIC.replace("restitution = 1.0", "restitution = 1.0\nfriction = 0.5"),
            list.join(", ")
        ));
        let found = stiffness(&simulation, &[BoundaryIndex(1)], Some(factorise)).expect("a stiffness");
        // Each contact has dF/dδ = 2 E* √(R δ), and both are in a row.
        let contact = 2.0 * 1.0e9 / (2.0 * (1.0 - 0.09)) * (0.01_f64 * 1e-5).sqrt();
        let stiff = found.boundaries[0].matrix[2][2];
        assert!((stiff / (0.5 * contact) - 1.0).abs() < 1e-6, "{stiff} N/m, {} expected", 0.5 * contact);
        assert_eq!((found.freedoms, found.rattlers.len()), (6, 0));
    }
}

#[test]
fn a_bed_of_clumps_is_as_stiff_as_it_is_when_time_steps_have_settled() {
    let mut list = Vec::new();
    for (x, y, z) in (0..2).flat_map(|x| (0..4).flat_map(move |y| (0..3).map(move |z| (x, y, z)))) {
        let place = [0.009995 + 0.03998 * f64::from(x), 0.01999 * f64::from(y), 0.009995 + 0.01999 * f64::from(z)];
        list.push(format!("{{ position = {place:?} }}"));
    }
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3]| {
        format!("[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"a\"\n")
    };
    let planes = [
        plane("west", [-0.009995, 0.0, 0.0], [1.0, 0.0, 0.0]),
        plane("east", [0.069965, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        plane("south", [0.0, -0.009995, 0.0], [0.0, 1.0, 0.0]),
        plane("north", [0.0, 0.069965, 0.0], [0.0, -1.0, 0.0]),
        plane("lid", [0.0, 0.0, 0.05997], [0.0, 0.0, -1.0]),
        plane("floor", [0.0; 3], [0.0, 0.0, 1.0]),
    ];
    let mut simulation = start(&format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 5.0e-6\n{}\n[contact.touch.tangential.history]\n[clump.pair]\nspheres = [{{ position = \
         [0.0, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.01999, 0.0, 0.0], radius = 0.01 }}]\n[particles.bed]\nmaterial = \"a\"\nclump = \
         \"pair\"\nlist = [{}]\n[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = true\n{}motion = {{ driven = [\"x\", \"z\"] }}\n",
        ELASTIC.replace("1.0e9", "5.0e7").replace("restitution = 1.0", "restitution = 0.5\nfriction = 0.5"),
        list.join(", "),
        planes.concat()
    ));
    let floor = BoundaryIndex(5);
    let to = |simulation: &mut Simulation, axis: usize, way: f64, time: f64| {
        simulation.set_input(floor, axis, way);
        simulation.advance(0.02).expect("it runs");
        simulation.advance(time).expect("it runs");
        simulation.state().boundaries[5].force[2]
    };
    // Pressed and sheared a little, and left alone.
    to(&mut simulation, 2, 2.0e-6, 0.05);
    to(&mut simulation, 0, 1.0e-6, 0.25);
    let found = stiffness(&simulation, &[floor], Some(factorise)).expect("a stiffness").boundaries[0].matrix[2][2];
    let state = simulation.state().clone();
    let there = to(&mut simulation, 2, 2.0e-6 + 1.0e-9, 0.15);
    simulation.restore(&state).expect("its own state");
    let back = to(&mut simulation, 2, 2.0e-6 - 1.0e-9, 0.15);
    let expected = (back - there) / 2.0e-9;
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} N/m, {expected} N/m when it has settled");
}

#[test]
fn spheres_from_a_file_are_those_of_the_table() {
    let scene = |clump: &str, file: &str| {
        let text = format!(
            "[material.a]\ndensity = 1.0\n[clump.b]\n{clump}\n[particles.p]\nmaterial = \"a\"\nclump = \"b\"\nlist = [{{ position = [0.0, 0.0, 0.0] }}]"
        );
        read_with(&text, [("b.csv".to_owned(), file.as_bytes().to_vec())].into())
    };
    let file = "x, y, z, radius\n0.0, 0.0, 0.0, 0.1\n0.3, 0.1, 0.0, 0.08\n0.0, 0.5, 0.2, 0.12\n";
    let filed = scene("file = \"b.csv\"", file).expect("a scene");
    let written = scene(TOP.trim().trim_start_matches("[clump.top]"), "").expect("a scene");
    assert_eq!(filed.clump_shapes, written.clump_shapes);
    assert_eq!(filed.particles, written.particles);
    for (clump, file, expected) in [
        ("file = \"c.csv\"", file, "c.csv"),
        ("", file, "[clump.b] spheres: missing"),
        ("file = \"b.csv\"", "x, y, z\n0.0, 0.0, 0.0\n", "radius"),
        ("file = \"b.csv\"", "x, y, z, radius\n0.0, 0.0, 0.0, -0.1\n", "b.csv, line 2"),
        ("file = \"b.csv\"", "x, y, z, radius, vx\n0.0, 0.0, 0.0, 0.1, 1.0\n", "a clump moves as a whole"),
        ("file = \"b.csv\"", "x, y, z, radius\n", "expected 1 to 256 spheres, found 0"),
        ("file = \"b.csv\"\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 1.0 }]", file, "found spheres and file"),
    ] {
        let found = scene(clump, file).expect_err(expected);
        assert!(found.contains(expected), "{found}\n{expected} expected");
    }
}

#[test]
fn what_clumps_cannot_be_is_refused_in_words() {
    let scene = |clump: &str, set: &str, more: &str| {
        let text = format!(
            "[material.a]\ndensity = 1.0\n[clump.b]\n{clump}\n[particles.p]\nmaterial = \"a\"\nclump = \"b\"\n{set}\n{more}"
        );
        read(&text).expect_err("a mistake")
    };
    let two = "spheres = [{ position = [0.0, 0.0, 0.0], radius = 1.0 }, { position = [1.0, 0.0, 0.0], radius = 1.0 }]";
    let one = "list = [{ position = [0.0, 0.0, 0.0] }]";
    for (found, expected) in [
        (scene("spheres = []", one, ""), "[clump.b] spheres: expected 1 to 256 spheres, found 0"),
        (
            scene(&format!("{two}\ninertia = [1.0, 1.0, 1.0]"), one, ""),
            "[clump.b] mass: missing; an inertia is that of a mass",
        ),
        (
            scene(&format!("{two}\nmass = 1.0\ninertia = [1.0, 1.0, 3.0]"), one, ""),
            "expected moments above 0, none above the sum of the others",
        ),
        (
            scene(two, "list = [{ position = [0.0, 0.0, 0.0], id = 3 }]", ""),
            "list.1.id: spheres of clumps get their numbers",
        ),
        (
            scene(two, "list = [{ position = [0.0, 0.0, 0.0], orientation = [0.0, 0.0, 0.0, 0.0] }]", ""),
            "expected a quaternion [w, x, y, z] that is not zero",
        ),
        (scene(two, "orientation = \"any\"\nlist = []", ""), "\"random\" or \"principal_axes\", found \"any\""),
        (scene(&format!("{two}\nmass = 1.0"), &format!("density = 2.0\n{one}"), ""), "[clump.b] has a mass"),
        (scene(two, one, "[boundary.g]\nparticles = { set = \"p\" }\nmotion = \"fixed\""), "cannot move as a group"),
    ] {
        assert!(found.contains(expected), "{found}\n{expected} expected");
    }
    let unknown = "[material.a]\ndensity = 1.0\n[particles.p]\nmaterial = \"a\"\nclump = \"c\"\nlist = []";
    let found = read(unknown).expect_err("a mistake");
    assert!(found.contains("clump"), "{found}");
}
