//! The fluid around the particles.

use super::check::all_finite;
use super::in_place::clone_in_place;
use super::{Row, StateFault, demand};
use serde::{Deserialize, Serialize};

/// What a fluid is given in one place or in each cell of its grid: a vector, which goes from where it is to its input in a communication
/// step. Rows hold x, y, z and a zero, if nothing else is said.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// At the present time.
    #[serde(with = "super::plain")]
    pub now: Vec<Row>,
    /// The last inputs: at the end of the communication step.
    #[serde(with = "super::plain")]
    pub target: Vec<Row>,
    /// Their rates at the start of the communication step; 0 where none was given.
    #[serde(with = "super::plain")]
    pub target_rate: Vec<Row>,
    /// Where the present communication step began.
    #[serde(with = "super::plain")]
    pub start: Vec<Row>,
    /// What it is to be at its end.
    #[serde(with = "super::plain")]
    pub end: Vec<Row>,
}

clone_in_place!(Course { now, target, target_rate, start, end });

/// How the fluid of a scene moves, and what it exchanged with the particles. Lists have a row for each cell of its grid; one without a
/// grid.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FluidState {
    /// Velocity \[m/s\]. Behind the present one stands the porosity that drag laws see.
    pub velocity: Course,
    /// Gradient of the pressure \[Pa/m\]; empty where none is given.
    pub pressure_gradient: Course,
    /// Temperature \[K\], along x; empty where no heat flows into it.
    pub temperature: Course,
    /// How fast its velocity changed at each place in the last time step \[m/s²\]; empty without added mass.
    #[serde(with = "super::plain")]
    pub acceleration: Vec<Row>,
    /// Lift on each particle, slot by slot, and then on each clump, as present loads hold it \[N\]; empty where nothing lifts.
    #[serde(with = "super::plain")]
    pub lift: Vec<Row>,
    /// Part of each cell that no particle fills, at the last communication point; empty without a grid.
    #[serde(with = "super::plain")]
    pub porosity: Vec<f64>,
    /// Length of the time step at whose end the present loads were found; 0 before the first \[s\].
    pub step: f64,
    /// What it exchanged in the present communication step, rows for each cell: impulse of the drag of the particles on it
    /// \[N s\], and behind it the sum over its time of drag over the velocity \[kg\]; where a gradient of its pressure is given,
    /// the impulse of that, too \[N s\], and superficial way of the particles \[m\].
    #[serde(with = "super::plain")]
    pub exchanged: Vec<Row>,
    /// The same over time, of the last communication step \[N\], \[N s/m\], \[N\], \[m/s\].
    #[serde(with = "super::plain")]
    pub mean: Vec<Row>,
    /// Heat of the particles into it in the present communication step \[J\], and behind it the sum over its time of the conductances
    /// \[J/K\]; empty where no heat flows into it.
    #[serde(with = "super::plain")]
    pub heat: Vec<Row>,
    /// The same over time: heat flow of the particles into it, mean over the last communication step \[W\], and conductance \[W/K\].
    #[serde(with = "super::plain")]
    pub mean_heat: Vec<Row>,
    /// What the half kick that begins the next time step exchanges with particles.
    pub coming: Coming,
    /// Work of the fluid since counting began: drag along its own velocity, and buoyancy along those of the particles \[J\].
    pub work: f64,
    /// Impulse on the bodies that forces move, of drag and pressure, since counting began \[N s\].
    pub impulse: [f64; 3],
}

clone_in_place!(FluidState {
    velocity,
    pressure_gradient,
    temperature,
    acceleration,
    lift,
    porosity,
    step,
    exchanged,
    mean,
    heat,
    mean_heat,
    coming,
    work,
    impulse
});

/// What the half kick that begins the next time step exchanges between a fluid and particles, where that step is as long as this one.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coming {
    /// Length of that step \[s\]; 0 where nothing is known of it.
    pub step: f64,
    /// What it adds to [`FluidState::exchanged`].
    #[serde(with = "super::plain")]
    pub rows: Vec<Row>,
    /// What it adds to the books.
    pub booked: Booked,
}

clone_in_place!(Coming { step, rows, booked });

/// What a fluid does in a half kick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Booked {
    /// Its work \[J\].
    pub work: f64,
    /// What drag takes \[J\].
    pub taken: f64,
    /// Work on the bodies that forces move \[J\].
    pub on_free: f64,
    /// Impulse on them \[N s\].
    pub moved: [f64; 3],
}

impl Booked {
    /// Both together.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        let moved = [0, 1, 2].map(|axis| self.moved[axis] + other.moved[axis]);
        Self {
            work: self.work + other.work,
            taken: self.taken + other.taken,
            on_free: self.on_free + other.on_free,
            moved,
        }
    }
}

/// How many rows a cell has of what it exchanges where a gradient of its pressure is given. Elsewhere it has one.
pub const EXCHANGED: usize = 3;

impl Course {
    /// So many vectors, at rest.
    pub(crate) fn at_rest(count: usize, [x, y, z]: [f64; 3]) -> Self {
        let rows = || vec![[x, y, z, 0.0]; count];
        Self { now: rows(), target: rows(), target_rate: vec![[0.0; 4]; count], start: rows(), end: rows() }
    }

    /// Begins a communication step of this length \[s\]: it is known now where it goes.
    pub(crate) fn begin(&mut self, interval: f64) {
        for (target, rate) in self.target.iter_mut().zip(&mut self.target_rate) {
            for axis in 0..3 {
                target[axis] += rate[axis] * interval;
            }
            *rate = [0.0; 4];
        }
        self.start.clone_from(&self.now);
        self.end.clone_from(&self.target);
    }

    /// Brings all to where they are when this share of the communication step is left.
    pub(crate) fn advance(&mut self, left: f64) {
        for ((now, start), end) in self.now.iter_mut().zip(&self.start).zip(&self.end) {
            for axis in 0..3 {
                now[axis] = end[axis] + (start[axis] - end[axis]) * left;
            }
        }
    }

    /// Gives all this value.
    pub(crate) fn fill(&mut self, value: [f64; 3]) {
        self.now.iter_mut().for_each(|now| now[..3].copy_from_slice(&value));
    }

    /// Takes the inputs of another over.
    pub(crate) fn take_inputs(&mut self, given: &Self) {
        self.target.clone_from(&given.target);
        self.target_rate.clone_from(&given.target_rate);
    }

    /// Takes the inputs of another at the start: all is there at once. Returns whether anything changed.
    pub(crate) fn put(&mut self, given: &Self) -> bool {
        self.take_inputs(given);
        let mut changed = false;
        for (now, target) in self.now.iter_mut().zip(&self.target) {
            changed |= now[..3] != target[..3];
            now[..3].copy_from_slice(&target[..3]);
        }
        self.start.clone_from(&self.now);
        self.end.clone_from(&self.target);
        changed
    }

    /// Its lists.
    fn lists(&self) -> [&Vec<Row>; 5] {
        [&self.now, &self.target, &self.target_rate, &self.start, &self.end]
    }

    /// Whether all lists have so many rows of finite numbers.
    fn check(&self, count: usize) -> Result<(), StateFault> {
        self.lists().into_iter().try_for_each(|rows| {
            demand(rows.len() == count, "fluid", rows.len(), "a row for each cell of its grid")?;
            all_finite(rows.as_flattened(), "fluid")
        })
    }
}

/// What a fluid may be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FluidField {
    /// Its velocity.
    Velocity,
    /// The gradient of its pressure.
    PressureGradient,
    /// Its temperature, along x.
    Temperature,
}

impl FluidState {
    /// How many rows each cell has of what it exchanges.
    pub fn rows(&self) -> usize {
        if self.pressure_gradient.now.is_empty() { 1 } else { EXCHANGED }
    }

    /// A row of what a cell exchanged, mean over the last communication step.
    pub fn mean_of(&self, cell: usize, row: usize) -> Row {
        self.mean[self.rows() * cell + row]
    }

    /// What it is given.
    pub fn given(&self, field: FluidField) -> &Course {
        match field {
            FluidField::Velocity => &self.velocity,
            FluidField::PressureGradient => &self.pressure_gradient,
            FluidField::Temperature => &self.temperature,
        }
    }

    /// The same, to be changed.
    pub fn given_mut(&mut self, field: FluidField) -> &mut Course {
        match field {
            FluidField::Velocity => &mut self.velocity,
            FluidField::PressureGradient => &mut self.pressure_gradient,
            FluidField::Temperature => &mut self.temperature,
        }
    }

    /// Counts from here.
    pub(super) fn begin_counting(&mut self) {
        self.work = 0.0;
        self.impulse = [0.0; 3];
    }

    /// Whether it can be one.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { velocity, pressure_gradient, temperature, porosity, step, .. } = self;
        let Self { exchanged, mean, heat, mean_heat, coming, work, impulse, acceleration, lift, .. } = self;
        let count = velocity.now.len();
        velocity.check(count)?;
        pressure_gradient.check(pressure_gradient.now.len())?;
        temperature.check(temperature.now.len())?;
        let there = [exchanged.len(), mean.len(), coming.rows.len()] == [self.rows() * count; 3]
            && [heat.len(), mean_heat.len()] == [temperature.now.len(); 2];
        demand(there, "fluid", exchanged.len(), "rows for each cell of its grid")?;
        let rows = [exchanged, mean, heat, mean_heat, acceleration, lift, &coming.rows];
        rows.into_iter().try_for_each(|rows| all_finite(rows.as_flattened(), "fluid"))?;
        all_finite(porosity, "fluid")?;
        let Booked { work: now, taken, on_free, moved } = coming.booked;
        all_finite(&[*step, *work, coming.step, now, taken, on_free], "fluid")?;
        all_finite(&[*impulse, moved].concat(), "fluid")?;
        let fills = velocity.now.iter().all(|row| row[3] > 0.0 && row[3] <= 1.0);
        demand(fills, "fluid", 0, "a porosity above 0 and up to 1")?;
        demand(*step >= 0.0, "fluid", 0, "a step of 0 or above")
    }

    /// Whether it is of the scene that another one is of.
    pub(super) fn check_same(&self, other: &Self) -> Result<(), StateFault> {
        let lengths = |it: &Self| {
            let given = [&it.velocity, &it.pressure_gradient, &it.temperature].map(|course| course.now.len());
            (given, [it.porosity.len(), it.acceleration.len()])
        };
        demand(lengths(self) == lengths(other), "fluid", self.velocity.now.len(), "as many cells as the scene has")
    }
}
