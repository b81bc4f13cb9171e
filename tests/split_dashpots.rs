//! Dashpots of bonds that are integrated by themselves: what decays, what is kept, what is booked, and what is refused.

use cograin::bond::damping::split::Moving;
use cograin::bond::damping::viscous::Viscous;
use cograin::bond::{Body, Elasticity, Pair, Quaternion};
use cograin::lanes::Width;
use cograin::number::Vector;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::state::ledger::Source as Kind;
use cograin::state::{Loss, State};
use cograin::step::Simulation;
use std::sync::Arc;

/// A scene as text, checked.
fn scene(text: &str) -> Arc<Scene> {
    let source = Source { name: "scene.toml".into(), text: text.into(), files: Default::default() };
    Arc::new(Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}\n{text}")))
}

/// Its simulation.
fn simulation(text: &str) -> Simulation {
    Simulation::new(scene(text)).expect("the scene starts")
}

/// A pair of bodies along a skew axis: of radius 1 and mass 3, and of this radius (0.6 with mass 2).
fn pair(other: f64) -> (Pair, Moving) {
    let axis = Vector::new(2.0, -1.0, 2.0) * (1.0 / 3.0);
    let body = |position, velocity: [f64; 3], spin: [f64; 3], radius: f64, mass: f64| Body {
        position,
        velocity: velocity.into(),
        spin: spin.into(),
        orientation: Quaternion::identity(),
        radius,
        mass,
        inertia: 0.4 * mass * radius * radius,
    };
    let i = body(axis * 1.9, [0.3, -0.2, 0.5], [1.0, 0.4, -0.7], 1.0, 3.0);
    let j = body(Vector::zero(), [-0.1, 0.6, 0.2], [-0.5, 0.9, 0.3], other, if other == 1.0 { 3.0 } else { 2.0 });
    (Pair::of_spheres(&i, &j), Moving { velocities: [i.velocity, j.velocity], spins: [i.spin, j.spin] })
}

/// v_n, v_s, w_n, w_t of a pair that moves so.
fn rates(pair: &Pair, moving: &Moving) -> [Vector; 4] {
    let distance = pair.connection.length();
    let axis = pair.connection * (1.0 / distance);
    let [apart, turned] = [moving.velocities, moving.spins].map(|[i, j]| i - j);
    let spin = moving.spins[0] * pair.share_i + moving.spins[1] * pair.share_j;
    let along = |vector: Vector| axis * vector.dot(axis);
    [along(apart), apart - along(apart) + pair.connection.cross(spin), along(turned), turned - along(turned)]
}

/// Momentum, angular momentum about body j, and kinetic energy.
fn kept(pair: &Pair, moving: &Moving) -> (Vector, Vector, f64) {
    let ([v, u], [w, s]) = (moving.velocities, moving.spins);
    let momentum = v * pair.mass_i + u * pair.mass_j;
    let angular = w * pair.inertia_i + s * pair.inertia_j + pair.connection.cross(v * pair.mass_i);
    let energy =
        pair.mass_i * v.dot(v) + pair.mass_j * u.dot(u) + pair.inertia_i * w.dot(w) + pair.inertia_j * s.dot(s);
    (momentum, angular, 0.5 * energy)
}

/// ζ of the four parts.
const RATIOS: [f64; 4] = [0.1, 0.7, 1.5, 4.0];

#[test]
fn the_rates_of_a_pair_alone_decay_exactly() {
    let (pair, begun) = pair(1.0);
    let law = Elasticity::of(1.0, 10.0, 4.0).at_step::<f64>(0.0);
    for time in [1e-6, 0.03, 0.4, 1e3] {
        let mut moving = begun;
        Viscous { ratios: RATIOS }.decay(&law, &pair, [1.0; 2], time).damp(&mut moving, false);
        // c/M = 2 ζ √(K/M), of spheres of mass 3 and inertia 6/5 at the distance 1.9, whose bond has radius 1.
        let area = std::f64::consts::PI;
        let turning = 2.0 / 1.2;
        let stiffness = [10.0 * area, 4.0 * area, 4.0 * 0.5 * area, 10.0 * 0.25 * area];
        let light = [2.0 / 3.0, 2.0 / 3.0 + 2.0 * 0.95 * 0.95 / 1.2, turning, turning];
        let (before, after) = (rates(&pair, &begun), rates(&pair, &moving));
        for part in 0..4 {
            let left = (-2.0 * RATIOS[part] * (stiffness[part] * light[part]).sqrt() * time).exp();
            let off = (after[part] - before[part] * left).length() / before[part].length();
            assert!(off < 2e-15, "part {part} after {time} s: off by {off:e}");
        }
    }
}

#[test]
fn a_sweep_keeps_momentum_and_angular_momentum_and_tells_the_energy_that_it_takes() {
    for other in [1.0, 0.6] {
        for (time, backwards) in [(0.05, false), (0.05, true), (5.0, false), (5.0, true)] {
            let (pair, begun) = pair(other);
            let law = Elasticity::of(1.0, 10.0, 4.0).at_step::<f64>(0.0);
            let mut moving = begun;
            let impulse = Viscous { ratios: RATIOS }.decay(&law, &pair, [1.0; 2], time).damp(&mut moving, backwards);
            let ((p, l, before), (q, m, after)) = (kept(&pair, &begun), kept(&pair, &moving));
            assert!((p - q).length() < 1e-15 * p.length() && (l - m).length() < 1e-15 * l.length());
            assert!(impulse.taken > 0.1, "{} J", impulse.taken);
            assert!((before - after - impulse.taken).abs() < 1e-15 * before, "{before} {after} {}", impulse.taken);
        }
    }
}

#[test]
fn a_sweep_backwards_undoes_one_forwards_in_reversed_time() {
    // Order matters where l/I differ: bending and shear then change each other.
    let (pair, begun) = pair(0.6);
    let law = Elasticity::of(1.0, 10.0, 4.0).at_step::<f64>(0.0);
    let decay = Viscous { ratios: RATIOS }.decay(&law, &pair, [1.0; 2], 0.05);
    let (mut one, mut other) = (begun, begun);
    decay.damp(&mut one, false);
    decay.damp(&mut other, true);
    assert!((one.spins[0] - other.spins[0]).length() > 1e-4, "shear and bending take turns");
    // (1 − s⁻¹) is the share that is gained: −lost/(1 − lost).
    let mut grown = decay;
    let light = [1.0 / pair.mass_i + 1.0 / pair.mass_j, 0.0, 1.0 / pair.inertia_i + 1.0 / pair.inertia_j, 0.0];
    let across =
        light[0] + decay.arms[0] * decay.arms[0] / pair.inertia_i + decay.arms[1] * decay.arms[1] / pair.inertia_j;
    let light = [light[0], across, light[2], light[2]];
    for part in 0..4 {
        grown.gains[part] = -decay.gains[part] / (1.0 - decay.gains[part] * light[part]);
    }
    grown.damp(&mut one, true);
    for body in 0..2 {
        assert!((one.velocities[body] - begun.velocities[body]).length() < 1e-14);
        assert!((one.spins[body] - begun.spins[body]).length() < 1e-14);
    }
}

/// A block of bonded spheres, thrown and turned, of which two layers are groups and one is glued to a plane; grains fall on it.
const BLOCK: &str = r#"
gravity = [0.5, -0.2, -9.81]
[run]
step = STEP
threads = 1
[material.ice]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.core]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [4, 3, 3], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [0.05, 0.03, -0.02]
angular_velocity = [3.0, 20.0, -8.0]
[particles.driven]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.008, 0.0, 0.0], counts = [1, 3, 3], spacing = 2.0e-3, radius = 1.0e-3 }
[particles.turned]
material = "ice"
lattice = { kind = "simple_cubic", origin = [-0.002, 0.0, 0.0], counts = [1, 3, 3], spacing = 2.0e-3, radius = 1.0e-3 }
[particles.grains]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.001, 0.001, 0.0065], counts = [3, 2, 1], spacing = 2.2e-3, radius = 0.8e-3 }
velocity = [0.1, 0.0, -0.3]
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
motion = { driven = ["x"] }
[boundary.stamp]
particles = { set = "driven" }
motion = { driven = ["x", "z"] }
[boundary.crank]
particles = { set = "turned" }
motion = { driven = ["rotation.y"] }
[bond.inner]
between = ["core", "core"]
LAW
[bond.stamp]
between = ["core", "driven"]
LAW
[bond.crank]
between = ["core", "turned"]
LAW
[bond.glue]
between = ["core", "floor"]
LAW
[output]
energy = true
losses = true
"#;

/// What all its bonds have.
const LAW: &str = r#"create_distance = 2.1e-3
normal_stiffness = 2.0e10
tangential_stiffness = 8.0e9
damping.viscous = { normal_force = 0.3, tangential_force = 0.2, normal_torque = 0.4, tangential_torque = 0.5, integration = "split" }"#;

/// The block with this step \[s\].
fn block(step: f64) -> Simulation {
    simulation(&BLOCK.replace("LAW", LAW).replace("STEP", &format!("{step:?}")))
}

/// Length of its communication steps \[s\].
const INTERVAL: f64 = 2.0e-4;

/// One communication step of the block, with its boundaries on their way.
fn drive(simulation: &mut Simulation, step: u32) {
    let wave = 1e-5 * f64::from(step % 5) - 2e-5;
    simulation.set_input(BoundaryIndex(0), 0, wave);
    simulation.set_input(BoundaryIndex(1), 0, 2e-6 * f64::from(step));
    simulation.set_input(BoundaryIndex(1), 2, wave);
    simulation.set_input(BoundaryIndex(2), 4, 2e-4 * f64::from(step));
    simulation.advance(INTERVAL).expect("it runs");
}

#[test]
fn both_books_close() {
    let mut simulation = block(5e-6);
    for step in 1..20 {
        drive(&mut simulation, step);
    }
    let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
    for kind in [Kind::Contacts, Kind::Bonds, Kind::Gravity] {
        assert!(ledger.work_of(kind).abs() > 1e-9, "{} did nothing", kind.name());
    }
    let residual = simulation.energy_residual().expect("the scene keeps a book");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
    let lost = simulation.losses().expect("the scene books losses")[Loss::BondDamping as usize];
    let bonds: f64 = simulation.bonds().iter().map(|bond| bond.dissipated).sum();
    assert!(lost > 1e-6 && (lost - bonds).abs() < 1e-12 * lost, "{lost:e} J, {bonds:e} J bond by bond");
}

#[test]
fn the_residual_of_the_physical_book_and_the_work_of_each_force_are_of_second_order() {
    let at = |step: f64| {
        let text = BLOCK.replace("LAW", LAW).replace("STEP", &format!("{step:?}"));
        // Contacts begin and end; bonds and weight alone are smooth.
        let text = text.replace("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n", "");
        let mut simulation = self::simulation(&text);
        for step in 1..11 {
            drive(&mut simulation, step);
        }
        let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
        let works = [Kind::Bonds, Kind::Gravity].map(|kind| ledger.work_of(kind));
        let boundaries = [0, 1, 2].map(|boundary| simulation.state().boundaries[boundary].work);
        let residual = simulation.physical_residual().expect("the scene books losses");
        [residual, works[0], works[1], boundaries[0], boundaries[1], boundaries[2]]
    };
    let found = [4e-6, 2e-6, 1e-6].map(at);
    let ratio = found[0][0] / found[1][0];
    assert!((3.4..4.6).contains(&ratio), "the residual falls by {ratio:.2}: {found:?}");
    for number in 1..6 {
        let ratio = (found[0][number] - found[1][number]) / (found[1][number] - found[2][number]);
        assert!((3.2..4.8).contains(&ratio), "work {number} converges by {ratio:.2}: {found:?}");
    }
}

#[test]
fn boundaries_feel_what_they_give() {
    let mut simulation = block(5e-6);
    let momentum = |simulation: &Simulation| {
        let particles = &simulation.state().particles;
        let free = particles.velocity.iter().zip(&particles.owner).filter(|(_, owner)| **owner == 0);
        free.fold([0.0; 4], |sum, ([x, y, z, m], _)| [sum[0] + m * x, sum[1] + m * y, sum[2] + m * z, sum[3] + m])
    };
    let (start, mut turnover) = (momentum(&simulation), 0.0_f64);
    for step in 1..20 {
        let before = [0, 1].map(|boundary: usize| simulation.state().boundaries[boundary]);
        drive(&mut simulation, step);
        for (boundary, before) in before.iter().enumerate() {
            let now = simulation.state().boundaries[boundary];
            let way = |axis: usize| now.displacement[axis] - before.displacement[axis];
            let expected: f64 = -(0..3).map(|axis| now.mean_force[axis] * way(axis)).sum::<f64>();
            let found = now.work - before.work;
            turnover += found.abs();
            assert!((found - expected).abs() <= 1e-11 * turnover, "{found:e} J, not {expected:e} J");
        }
    }
    assert!(turnover > 1e-7, "they worked: {turnover:e} J");
    let (end, state) = (momentum(&simulation), simulation.state());
    for axis in 0..3 {
        let given = end[3] * simulation.scene().gravity[axis] * state.clock.time;
        let felt = [0, 1, 2].map(|boundary| state.boundaries[boundary].total_impulse[axis]);
        let residual = end[axis] - start[axis] - given + felt.iter().sum::<f64>();
        let turnover = given.abs() + felt.iter().map(|felt| felt.abs()).sum::<f64>();
        assert!(residual.abs() < 1e-12 * turnover, "axis {axis}: {residual:e} N s of {turnover:e} N s");
    }
}

/// Two spheres between two groups, of which one is drawn and turned.
const DRAWN: &str = r#"
[run]
step = 1.0e-7
scheme = "engine"
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 1000.0
[particles.held]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 1.0e-3 }]
[particles.drawn]
material = "a"
list = [{ position = [2.0e-3, 0.0, 0.0], radius = 1.0e-3 }]
[boundary.wall]
particles = { set = "held" }
[boundary.hand]
particles = { set = "drawn" }
motion = { driven = ["x", "y", "rotation.x", "rotation.z"] }
[bond.string]
formulation = "incremental"
between = ["held", "drawn"]
create_distance = 2.1e-3
normal_stiffness = 2.0e10
tangential_stiffness = 8.0e9
damping.viscous = { normal_force = 0.3, tangential_force = 0.2, normal_torque = 0.4, tangential_torque = 0.5, integration = "HOW" }
[output]
losses = true
"#;

#[test]
fn a_steady_motion_between_two_groups_loads_them_as_dashpots_that_act_as_forces_do() {
    let of = |how: &str| {
        let mut simulation = simulation(&DRAWN.replace("HOW", how));
        for step in 1..4 {
            let part = f64::from(step);
            for (axis, way) in [(0, 1e-9), (1, 2e-9), (3, 1e-6), (5, -2e-6)] {
                simulation.set_input(BoundaryIndex(1), axis, part * way);
            }
            simulation.advance(1e-5).expect("it runs");
        }
        let loads = [0, 1].map(|boundary: usize| {
            let felt = simulation.state().boundaries[boundary];
            [felt.force, felt.moment, felt.mean_force, felt.mean_moment].concat()
        });
        let lost = simulation.losses().expect("the scene books losses")[Loss::BondDamping as usize];
        (loads.concat(), lost, simulation.state().boundaries[1].work, simulation.bonds()[0].force)
    };
    let (split, acting) = (of("split"), of("scheme"));
    for (one, other) in split.0.iter().zip(&acting.0).chain(split.3.iter().zip(&acting.3)) {
        let scale = if other.abs() > 1e-9 { other.abs() } else { 1.0 };
        // Dashpots that act as forces do nothing in the evaluation before the first step, half of whose impulse counts; and their rates
        // are half a step older.
        assert!((one - other).abs() < 1e-2 * scale, "{one:e}, {other:e}\n{split:?}\n{acting:?}");
    }
    assert!((split.1 / acting.1 - 1.0).abs() < 1e-2, "{:e} J lost, {:e} J", split.1, acting.1);
    assert!((split.2 / acting.2 - 1.0).abs() < 1e-2, "{:e} J given, {:e} J", split.2, acting.2);
    assert!(split.1 > 0.1 * split.2, "the dashpots take a good part: {:e} J of {:e} J", split.1, split.2);
}

/// A large block that breaks, glued to a plane.
fn breaking(threads: usize, formulation: &str) -> Simulation {
    let text = r#"
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
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.slow]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [13, 13, 7], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [1.0, 0.3, 0.0]
[particles.fast]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.014], counts = [13, 13, 6], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [3.0, -1.0, 0.5]
[particles.held]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.026, 0.0, 0.0], counts = [1, 13, 7], spacing = 2.0e-3, radius = 1.0e-3 }
[boundary.held]
particles = { set = "held" }
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
motion = { prescribed = { z = -0.2 } }
[bond.slow]
between = ["slow", "slow"]
LAW
[bond.fast]
between = ["slow", "fast"]
LAW
[bond.held]
between = ["slow", "held"]
LAW
[bond.glue]
between = ["slow", "floor"]
LAW
[output]
energy = true
"#;
    let law = format!(
        "formulation = \"{formulation}\"\ncreate_distance = 2.1e-3\nnormal_stiffness = 1.0e12\ntangential_stiffness = 4.0e11\n\
         breakage = {{ max_normal_stress = 2.0e6, max_shear_stress = 2.0e6 }}\n\
         damping.viscous = {{ normal_force = 0.3, tangential_force = 0.3, tangential_torque = 1.0, integration = \"split\" }}"
    );
    simulation(&text.replace("THREADS", &threads.to_string()).replace("LAW", &law))
}

/// Runs some communication steps. Returns how many bonds broke.
fn run(simulation: &mut Simulation, steps: usize) -> usize {
    (0..steps)
        .map(|_| {
            simulation.advance(2.0e-6).expect("it runs");
            simulation.state().breaks.len()
        })
        .sum()
}

#[test]
fn threads_lane_widths_and_saved_states_give_the_same_bits() {
    for formulation in ["finite_rotation", "incremental"] {
        let mut first = breaking(1, formulation);
        let broken = run(&mut first, 20);
        assert!(broken > 50, "{formulation}: {broken} bonds broke");
        let expected = first.state().fingerprint();
        for threads in 2..=4 {
            let mut other = breaking(threads, formulation);
            assert_eq!(other.threads(), threads);
            assert_eq!(run(&mut other, 20), broken, "{formulation}, {threads} threads");
            assert_eq!(other.state().fingerprint(), expected, "{formulation}, {threads} threads");
        }
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            let mut other = breaking(1, formulation);
            other.set_width(width);
            run(&mut other, 20);
            assert_eq!(other.state().fingerprint(), expected, "{formulation}, {width:?}");
        }
        let mut saved = breaking(2, formulation);
        run(&mut saved, 9);
        let scene = saved.scene().clone();
        let bytes = saved.state().to_bytes(scene.fingerprint);
        let state = State::from_bytes(&bytes, scene.fingerprint).expect("the bytes are whole");
        let mut resumed = Simulation::resume(scene, state).expect("the state is sound");
        run(&mut resumed, 11);
        assert_eq!(resumed.state().fingerprint(), expected, "{formulation}, saved and restored");
        let residual = resumed.energy_residual().expect("the scene keeps a book");
        let turnover = resumed.state().ledger.as_ref().expect("it does").turnover;
        assert!(residual.abs() < 1e-12 * turnover, "{formulation}: {residual:e} J of {turnover:e} J");
    }
}

#[test]
fn a_free_block_keeps_momentum_and_angular_momentum() {
    let text = r#"
[run]
step = 2.0e-6
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[particles.core]
material = "ice"
list = [
{ position = [0.0, 0.0, 0.0], radius = 1.0e-3, velocity = [1.0, 0.3, 0.0], angular_velocity = [30.0, 0.0, -9.0] },
{ position = [2.0e-3, 0.0, 0.0], radius = 0.8e-3, velocity = [0.2, -0.3, 0.4] },
{ position = [0.5e-3, 1.7e-3, 0.0], radius = 1.1e-3, velocity = [0.0, -0.5, 1.0], angular_velocity = [0.0, 80.0, 5.0] },
{ position = [1.0e-3, 0.6e-3, 1.6e-3], radius = 0.7e-3, velocity = [-1.0, 0.1, 0.2] },
]
[bond.b]
between = ["core", "core"]
create_distance = 2.1e-3
normal_stiffness = 2.0e10
tangential_stiffness = 8.0e9
damping.viscous = { normal_force = 1.0, tangential_force = 0.7, normal_torque = 0.5, tangential_torque = 2.0, integration = "split" }
"#;
    let mut simulation = simulation(text);
    let sums = |simulation: &Simulation| {
        let particles = &simulation.state().particles;
        let mut sums = [Vector::zero(); 2];
        for slot in 0..particles.len() {
            let push = Vector::from(particles.velocity[slot]) * particles.velocity[slot][3];
            let spin = Vector::from(particles.angular_velocity[slot]) * particles.angular_velocity[slot][3];
            sums[0] += push;
            sums[1] += Vector::from(particles.position[slot]).cross(push) + spin;
        }
        sums
    };
    let (start, energy) = (sums(&simulation), simulation.kinetic_energy());
    for _ in 0..10 {
        simulation.advance(2e-4).expect("it runs");
    }
    assert!(simulation.kinetic_energy() < 0.7 * energy, "dashpots took energy");
    for (before, after) in start.into_iter().zip(sums(&simulation)) {
        let off = (after - before).length() / before.length();
        assert!(off < 1e-12, "off by {off:e}");
    }
}

#[test]
fn a_block_that_turns_as_a_whole_is_damped_by_the_fourth_power_of_the_step_alone() {
    // Two bonded spheres turn about their middle, stretched so that the bond holds them on their circle.
    let lost = |step: f64| {
        let text = DRAWN.replace("HOW", "split").replace("step = 1.0e-7", &format!("step = {step:?}"));
        let text = text.replace("[boundary.wall]\nparticles = { set = \"held\" }\n", "");
        let (start, end) = (text.find("[boundary.hand]").unwrap(), text.find("[bond.string]").unwrap());
        let mut text = text;
        text.replace_range(start..end, "");
        let spin = 2000.0;
        let turned = |sign: f64| {
            format!(
                "radius = 1.0e-3, velocity = [0.0, {:?}, 0.0], angular_velocity = [0.0, 0.0, {spin:?}] }}",
                sign * spin * 1e-3
            )
        };
        let text = text.replace("[0.0, 0.0, 0.0], radius = 1.0e-3 }", &format!("[0.0, 0.0, 0.0], {}", turned(-1.0)));
        let text =
            text.replace("[2.0e-3, 0.0, 0.0], radius = 1.0e-3 }", &format!("[2.0e-3, 0.0, 0.0], {}", turned(1.0)));
        let mut simulation = simulation(&text);
        simulation.advance(0.002).expect("what it began with has decayed");
        let before = simulation.losses().expect("it books losses")[Loss::BondDamping as usize];
        simulation.advance(0.006).expect("two turns");
        (simulation.losses().expect("it does")[Loss::BondDamping as usize] - before) / simulation.kinetic_energy()
    };
    let [coarse, fine] = [8e-6, 4e-6].map(lost);
    assert!((13.0..19.0).contains(&(coarse / fine)), "{coarse:e} {fine:e} of the energy in two turns");
    assert!(coarse < 1e-5, "{coarse:e} of the energy in two turns");
}

#[test]
fn what_cannot_be_split_is_refused_by_name() {
    let refusal = |text: &str| {
        let source = Source { name: "scene.toml".into(), text: text.into(), files: Default::default() };
        Scene::from_source(&source).expect_err("it is refused").to_string()
    };
    let text = BLOCK.replace("STEP", "1e-6").replace("LAW", LAW);
    let said = refusal(&text.replacen("create_distance", "tension = false\ncreate_distance", 1));
    assert!(said.contains("integration") && said.contains("both pulls and pushes"), "{said}");
    let said = refusal(&text.replacen("\"split\"", "\"halves\"", 1));
    assert!(said.contains("halves") && said.contains("split"), "{said}");
    let said =
        refusal(&text.replace("motion = { driven = [\"x\", \"z\"] }", "motion = { driven = [\"x\"], free = [\"z\"] }"));
    assert!(said.contains("boundary.stamp") && said.contains("\"scheme\""), "{said}");
}

/// A beam of bonded spheres that weight bends from rest, with dashpots of this ratio.
fn beam(ratio: f64, integration: &str, scheme: &str, step: f64) -> Simulation {
    let parts = ["normal_force", "tangential_force", "normal_torque", "tangential_torque"];
    let ratios: String = parts.map(|part| format!("{part} = {ratio:?}, ")).concat();
    let law = format!(
        "create_distance = 2.1e-3\nnormal_stiffness = 1.0e12\ntangential_stiffness = 4.0e11\n\
         damping.viscous = {{ {ratios} integration = \"{integration}\" }}"
    );
    let block = |name: &str, from: f64, count: u32| {
        format!(
            "[particles.{name}]\nmaterial = \"a\"\nlattice = {{ kind = \"simple_cubic\", origin = [{from:?}, 0.0, 0.0], \
             counts = [{count}, 2, 2], spacing = 2.0e-3, radius = 1.0e-3 }}\n"
        )
    };
    let (core, held) = (block("core", 0.0, 10), block("held", -2.0e-3, 1));
    simulation(&format!(
        "gravity = [3.0, 1.0, -9.81]\n[run]\nstep = {step:?}\nscheme = \"{scheme}\"\nallow_unstable = true\n\
         [material.a]\nyoungs_modulus = 1.0e9\npoissons_ratio = 0.3\ndensity = 2500.0\n{core}{held}\
         [boundary.wall]\nparticles = {{ set = \"held\" }}\n[bond.b]\nbetween = [\"core\", \"core\"]\n{law}\n\
         [bond.w]\nbetween = [\"core\", \"held\"]\n{law}\n[output]\nlosses = true\n"
    ))
}

/// Kinetic energy of the beam and what its dashpots took, at ten moments up to 1 ms in so many time steps; none where it is unstable.
fn bent(ratio: f64, integration: &str, scheme: &str, steps: u32) -> Option<Vec<[f64; 2]>> {
    let mut simulation = beam(ratio, integration, scheme, 1e-3 / f64::from(steps));
    let mut told = Vec::new();
    for _ in 0..10 {
        simulation.advance(1e-4).ok()?;
        let taken = simulation.losses().expect("the scene books losses")[Loss::BondDamping as usize];
        told.push([simulation.kinetic_energy(), taken]);
    }
    Some(told)
}

/// Root mean square errors of both over their largest values.
fn errors(found: &[[f64; 2]], converged: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|number| {
        let most = converged.iter().map(|row| row[number].abs()).fold(0.0, f64::max);
        let squares = found.iter().zip(converged).map(|(a, b)| (a[number] - b[number]) * (a[number] - b[number]));
        (squares.sum::<f64>() / found.len() as f64).sqrt() / most
    })
}

#[test]
#[allow(clippy::print_stdout, reason = "the figures of docs/bonds.md are what this test prints with --nocapture")]
fn a_slow_vibration_converges_to_that_of_acting_dashpots() {
    let stable = beam(0.0, "scheme", "engine", 1e-7).state().clock.stable;
    for ratio in [0.3, 1.0, 3.0] {
        let converged = bent(ratio, "scheme", "predicted", 20_480).expect("it is stable");
        for (integration, scheme) in [("scheme", "engine"), ("scheme", "predicted"), ("split", "engine")] {
            let mut last = None;
            for steps in [1120, 2560, 5120, 10_240] {
                let part = 1e-3 / f64::from(steps) / stable;
                let Some(found) = bent(ratio, integration, scheme, steps) else { continue };
                let found = errors(&found, &converged);
                println!(
                    "ratio {ratio}, {integration:6} {scheme:9}: step {part:.3} of the undamped one, errors {:.1e} {:.1e}",
                    found[0], found[1]
                );
                last = Some(found);
            }
            // The error of sweeps grows with the product of damping and step, that of dashpots that act as forces does not.
            let most = if integration == "split" { 1e-2 * ratio } else { 1e-4 };
            assert!(last.is_none_or(|[kinetic, taken]| kinetic < most && taken < most), "ratio {ratio}: {last:?}");
        }
    }
}
