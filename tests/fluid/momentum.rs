//! What cells of a fluid lose, the grains in them gain: momentum, energy, pressure drop.

use super::scenes::{AROUND, give, stirred, stirred_by, sum, swirl};
use crate::support::{assert_near, start, value};
use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Momentum of all that moves by forces along an axis, and the sum of its parts without their signs \[N s\].
fn momentum(simulation: &Simulation, axis: usize) -> [f64; 2] {
    let (particles, clumps) = (&simulation.state().particles, &simulation.state().clumps);
    let free = particles.slots().filter(|&slot| particles.owner[slot] == 0).map(|slot| particles.velocity[slot]);
    let parts: Vec<f64> = free.chain(clumps.velocity.iter().copied()).map(|row| row[3] * row[axis]).collect();
    [parts.iter().sum(), parts.iter().map(|part| part.abs()).sum()]
}

/// Asserts that in a communication step of this length the cells give what particles gain.
#[track_caller]
fn assert_given(simulation: &mut Simulation, interval: f64) {
    let before = [0, 1, 2].map(|axis| momentum(simulation, axis)[0]);
    simulation.advance(interval).unwrap();
    for axis in 0..3 {
        let [after, scale] = momentum(simulation, axis);
        let name = format!("mean_drag.{}", ["x", "y", "z"][axis]);
        let (gained, given) = (after - before[axis], -interval * sum(simulation, &name));
        assert!((gained - given).abs() < 1e-13 * scale, "{gained:e} gained, {given:e} given of {scale:e} N s");
        assert!(gained.abs() > 1e-6 * scale, "{gained:e} of {scale:e} N s");
    }
}

#[test]
fn cells_give_what_grains_and_clumps_gain_to_rounding() {
    let mut simulation = stirred(2, AROUND, "");
    for turn in 0..4 {
        give(&mut simulation, "velocity", |cell| swirl(cell + turn));
        // Time steps of one length follow each other, and of another one from the next communication step on.
        assert_given(&mut simulation, 1e-3 + 7e-6 * turn as f64);
    }
    let coefficients = sum(&simulation, "drag_coefficient");
    assert!(coefficients > 0.0, "{coefficients:e} N s/m");
}

#[test]
fn cells_that_repeat_give_what_grains_gain_to_rounding() {
    let cell = "[cell]\nedges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]";
    let mut simulation = stirred(1, "box = [[0.0, 0.0, 0.0], [0.1, 0.1, 0.1]]\ncounts = [3, 4, 5]", cell);
    for turn in 0..20 {
        give(&mut simulation, "velocity", |cell| swirl(cell + turn));
        assert_given(&mut simulation, 2e-3);
    }
}

#[test]
fn a_half_kick_that_its_load_tells_is_that_which_is_found_anew() {
    let run = |anew: bool| {
        let tables = "[output]\nenergy = true\nlosses = true";
        let mut simulation = stirred_by(1, AROUND, "pressure = \"total\"", tables);
        give(&mut simulation, "velocity", swirl);
        give(&mut simulation, "pressure_gradient", |cell| swirl(cell + 3).map(|part| 1e3 * part));
        for _ in 0..20 {
            simulation.advance(2e-5).unwrap();
            if anew {
                let mut state = simulation.state().clone();
                state.fluid.as_mut().unwrap().coming.step = 0.0;
                simulation.restore(&state).unwrap();
            }
        }
        simulation
    };
    let (told, anew) = (run(false), run(true));
    let [a, b] = [&told, &anew].map(Simulation::state);
    assert_eq!(a.particles.velocity, b.particles.velocity);
    let [one, other] = [a, b].map(|state| state.fluid.as_ref().unwrap());
    let most =
        |row: usize| one.mean.iter().skip(row).step_by(3).flatten().fold(0.0_f64, |most, part| most.max(part.abs()));
    for (place, (one, other)) in one.mean.iter().zip(&other.mean).enumerate() {
        let off = (0..4).map(|part| (one[part] - other[part]).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-12 * most(place % 3), "row {place}: {one:?}, anew {other:?}");
    }
    assert_near(one.work, other.work, 1e-12);
    assert_near(value(&told, "energy.lost.drag"), value(&anew, "energy.lost.drag"), 1e-12);
    let [one, other] = [a, b].map(|state| state.ledger.as_ref().unwrap());
    assert!((one.total() - other.total()).abs() < 1e-12 * one.turnover);
}

#[test]
fn the_books_close_where_each_grain_has_a_flow_of_its_own() {
    let tables = "[output]\nenergy = true\nlosses = true";
    let mut simulation = stirred(1, AROUND, tables);
    give(&mut simulation, "velocity", swirl);
    for interval in [1e-3, 3e-4, 0.7e-5, 1e-3] {
        simulation.advance(interval).unwrap();
        let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
        let residual = simulation.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * turnover, "{residual:e} of {turnover:e} J");
    }
    assert!(value(&simulation, "energy.lost.drag") > 0.0);
}

/// A bed of grains that are held, in one cell through which water flows; the velocity between the grains.
fn bed(velocity: f64) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.5e-3, 0.5e-3, 0.5e-3], counts = [10, 10, 10], spacing = 1.0e-3, radius = 0.5e-3 }}
[boundary.holder]
particles = {{ set = "bed" }}
motion = "fixed"
[grid.column]
box = [[0.0, 0.0, 0.0], [0.01, 0.01, 0.01]]
counts = [1, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [0.0, 0.0, {velocity:?}]
grid = "column"
[fluid.water.drag.gidaspow]
"#
    ))
}

#[test]
fn a_fixed_bed_has_erguns_pressure_drop() {
    // −∇p = n f_d/ε, the drag on a volume over its part that is fluid.
    let (superficial, porosity, d) = (0.01, 1.0 - PI / 6.0, 1e-3);
    let mut simulation = bed(superficial / porosity);
    simulation.advance(1e-3).unwrap();
    let found = -value(&simulation, "water.cell[1].mean_drag.z") / (1e-6 * porosity);
    let solid = 1.0 - porosity;
    let viscous = 150.0 * 1e-3 * superficial * solid * solid / (d * d);
    let inertial = 1.75 * 1000.0 * superficial * superficial * solid / d;
    assert_near(found, (viscous + inertial) / porosity.powi(3), 1e-12);
    let coefficient = value(&simulation, "water.cell[1].drag_coefficient");
    assert_near(coefficient * superficial / porosity, found * 1e-6 * porosity, 1e-13);
}

#[test]
fn a_floor_bears_the_weight_less_buoyancy_and_drag() {
    let mut simulation = start(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.3
[contact.all.normal.hertz]
[particles.bed]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.5e-3, 0.5e-3, 0.5e-3], counts = [4, 4, 4], spacing = 1.0e-3, radius = 0.5e-3 }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[grid.column]
box = [[0.0, 0.0, 0.0], [0.004, 0.004, 0.005]]
counts = [1, 1, 1]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [0.0, 0.0, 2.0e-3]
grid = "column"
[fluid.water.drag.koch_hill]
"#,
    );
    simulation.advance(0.2).unwrap();
    simulation.advance(0.01).unwrap();
    let volume = 64.0 * PI / 6.0 * 1e-9;
    let drag = -value(&simulation, "water.cell[1].mean_drag.z");
    let floor = -simulation.state().boundaries[0].mean_force[2];
    assert_near(floor, volume * 1500.0 * 9.81 - drag, 1e-9);
    assert!(drag > 0.01 * floor, "{drag:e} N of {floor:e} N");
}

#[test]
fn a_step_that_is_made_again_keeps_momentum_at_ten_relaxation_times_of_the_fluid() {
    let (side, mu) = (5e-3_f64, 1.8e-3);
    let mut simulation = start(&format!(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [1.0e-3, 1.0e-3, 1.0e-3], counts = [3, 3, 3], spacing = 1.5e-3, radius = 0.5e-3 }}
[grid.column]
box = [[0.0, 0.0, 0.0], [{side:?}, {side:?}, {side:?}]]
counts = [1, 1, 1]
[fluid.water]
density = 1.2
viscosity = {mu:?}
grid = "column"
velocity = {{ driven = [1.0, 0.0, 0.0] }}
[fluid.water.drag.stokes]
"#
    ));
    let porosity = value(&simulation, "water.cell[1].porosity");
    let mass = 1.2 * porosity * side.powi(3);
    let interval = 10.0 * mass / (27.0 * 3.0 * PI * mu * 1e-3 * porosity);
    let mut velocity = 1.0;
    for _ in 0..20 {
        let (saved, mut end) = (simulation.state().clone(), velocity);
        for turn in 0.. {
            simulation.restore(&saved).unwrap();
            give(&mut simulation, "velocity", |_| [end, 0.0, 0.0]);
            simulation.advance(interval).unwrap();
            let drag = value(&simulation, "water.cell[1].mean_drag.x");
            let lacks = mass * (end - velocity) - interval * drag;
            if lacks.abs() < 1e-13 * mass {
                break;
            }
            assert!(turn < 10, "{lacks:e} N s of {mass:e}");
            // Newton's method: on a ramp half of the change acts in the mean.
            end -= lacks / (mass + 0.5 * interval * value(&simulation, "water.cell[1].drag_coefficient"));
        }
        velocity = end;
        let all = mass * velocity + momentum(&simulation, 0)[0];
        assert_near(all, mass, 2.5e-12);
        assert!(velocity.abs() < 1.0, "{velocity} m/s");
    }
    assert!(velocity.abs() < 0.02, "{velocity} m/s");
}
