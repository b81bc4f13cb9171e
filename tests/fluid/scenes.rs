//! Grains in fluids, and what the fluid and its grids are given and tell.

use crate::support::{start, value};
use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;

/// Diameter \[m\] of the grains.
pub(super) const DIAMETER: f64 = 1.0e-4;
/// Their density \[kg/m³\].
pub(super) const DENSITY: f64 = 2500.0;
/// Viscosity of water \[Pa s\].
pub(super) const VISCOSITY: f64 = 1.0e-3;
/// Relaxation time of a grain by Stokes' law \[s\].
pub(super) const RELAXATION: f64 = DENSITY * DIAMETER * DIAMETER / (18.0 * VISCOSITY);

/// A grain of glass in water.
pub(super) fn grain(diameter: f64, (viscosity, step): (f64, f64), fluid: &str, more: &str) -> Simulation {
    let radius = 0.5 * diameter;
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.0], radius = {radius:?} }}]
[fluid.water]
density = 1000.0
viscosity = {viscosity:?}
{fluid}
{more}
"#
    ))
}

/// A small grain that is led, in a box of cells; `fluid` keys.
pub(super) fn led(position: [f64; 3], grid: &str, fluid: &str) -> Simulation {
    start(&format!(
        r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.grain]
material = "a"
list = [{{ position = {position:?}, radius = 1.0e-3 }}]
[boundary.hand]
particles = {{ set = "grain" }}
motion = {{ driven = ["x", "y", "z"] }}
[grid.column]
{grid}
[fluid.water]
density = 1000.0
viscosity = 1.0
grid = "column"
{fluid}
[fluid.water.drag.di_felice]
"#
    ))
}

/// Six cells along x, three along y, two along z, from 0 on, each of 1 cm.
pub(super) const SIX: &str = "box = [[0.0, 0.0, 0.0], [0.06, 0.03, 0.02]]\ncounts = [6, 3, 2]";

/// Grains and clumps that move through each other in the stirred water of a grid; `grid` and `more` tables.
pub(super) fn stirred(threads: usize, grid: &str, more: &str) -> Simulation {
    stirred_by(threads, grid, "", more)
}

/// The same with more keys of the water.
pub(super) fn stirred_by(threads: usize, grid: &str, keys: &str, more: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = 2.0e-5
threads = {threads}
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 2.0e-3 }}, {{ position = [3.0e-3, 0.0, 0.0], radius = 2.0e-3 }}]
[particles.pairs]
material = "a"
clump = "pair"
lattice = {{ kind = "simple_cubic", counts = [5, 5, 2], radius = 4.0e-3, spacing = 0.012, origin = [0.014, 0.014, 0.07] }}
[particles.grains]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.006, 0.006, 0.014], counts = [10, 10, 6], spacing = 8.0e-3, radius = 4.02e-3 }}
velocity = [0.4, 0.1, 0.6]
[grid.column]
{grid}
outputs = []
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
grid = "column"
velocity = "driven"
torque = true
{keys}
[fluid.water.drag.di_felice]
{more}
"#
    ))
}

/// A grid around them.
pub(super) const AROUND: &str = "box = [[0.0, 0.0, 0.0], [0.09, 0.09, 0.12]]\ncounts = [3, 4, 5]";

/// A velocity for each cell that is none of the others.
pub(super) fn swirl(cell: usize) -> [f64; 3] {
    let phase = cell as f64;
    [0.3 * (1.7 * phase).sin(), 0.4 * (2.9 * phase).cos(), 0.2 * (0.7 * phase).sin()]
}

/// Gives a field to the cells of a fluid: a vector for each.
pub(super) fn give(simulation: &mut Simulation, field: &str, of_cell: impl Fn(usize) -> [f64; 3]) {
    let interface = Interface::of(simulation.scene());
    let cells = simulation.scene().fluid.as_ref().unwrap().cells(&simulation.scene().grids);
    for cell in 0..cells {
        for (axis, part) in ["x", "y", "z"].into_iter().zip(of_cell(cell)) {
            let name = format!("water.cell[{}].{field}.{axis}", cell + 1);
            let index = interface.find(&name).unwrap_or_else(|| panic!("there is no {name}"));
            interface.set(simulation, index, Value::Real(part)).unwrap();
        }
    }
}

/// Numbers of all cells, in sum.
pub(super) fn sum(simulation: &Simulation, name: &str) -> f64 {
    let cells = simulation.scene().fluid.as_ref().unwrap().cells(&simulation.scene().grids);
    (1..=cells).map(|cell| value(simulation, &format!("water.cell[{cell}].{name}"))).sum()
}
