//! The periodic cell: its images, its motion, and what it does to the particles.
//!
//! Velocities of particles are those relative to the streaming motion of the cell, which carries what is at rest along with the
//! edges; passes see both together. In a time step a particle with velocity v goes from x to A (x + ½ Δt v) + ½ Δt v′, v′ = A⁻¹ v: straight
//! on, at constant velocity, while the edges change at a constant rate. The work of the step is
//!
//! ```text
//! W = M : (A − 1) − ½ [S₀ : (A − 1) + S₁ : (1 − A⁻¹)]     M = −½ Σ m (v′ + v) ⊗ v′     S = Σ f ⊗ r
//! ```
//!
//! with forces f of contacts and bonds over the vectors r between their bodies, S₀ and S₁ before and after it. It is linear in
//! the changes of the strains: what belongs to each is its conjugate stress times the volume.

mod deformation;
pub(crate) mod images;
pub(crate) mod near;
mod servo;
mod stress;
mod sweeps;

pub use stress::Fabric;

use crate::base::number::Row;
use crate::base::threads::Context;
use crate::engine::averages::look::Fullness;
use crate::engine::bodies::clumps::{self, ClumpBodies};
use crate::engine::run_error::RunError;
use crate::engine::state::cell::{CellState, Square, Strains};
use crate::engine::state::ledger::Source;
use crate::engine::state::{Ledger, State, StateFault, demand};
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::{CellMotion, Scene};
use deformation::{Change, product, times};
use images::Images;
use servo::Felt;
use sweeps::carry;

/// Strain in one time step that nobody can mean.
const LARGEST_STEP: f64 = 0.05;

/// The strain of an automatic time step over that, at most.
const NEAR_LARGEST: f64 = 0.9;

/// The cell of a scene.
pub(crate) struct Cell {
    /// Its images.
    images: Images,
    /// What each component does.
    motion: [CellMotion; 6],
    /// Radius of the largest particle \[m\].
    largest: f64,
    /// The largest distance of a surface from the point that the cell carries along: that radius or, of a clump, one about the mass centre
    /// \[m\].
    reach: f64,
    /// Shares of the volumes of spheres that overlap.
    fullness: Fullness,
    /// The deformation of the present time step.
    change: Option<Change>,
    /// The other velocities: with the streaming motion while time steps are at their ends, without it while forces are evaluated.
    other: Vec<Row>,
}

impl Cell {
    /// That of a scene, if it has one.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let images = Images::of(scene)?;
        let motion = scene.cell.as_ref()?.motion;
        let largest = scene.radii().fold(0.0, f64::max);
        let reach = clumps::farthest(&ClumpBodies::begun(scene)) + largest;
        let fullness = Fullness::of(scene);
        Some(Self { images, motion, largest, reach, fullness, change: None, other: Vec::new() })
    }

    /// The state of a scene's cell at time 0.
    pub(crate) fn begun(scene: &Scene) -> Option<CellState> {
        let cell = scene.cell.as_ref()?;
        let edges = cell.lattice.edges;
        Some(CellState {
            origin: cell.lattice.origin,
            reference: edges,
            edges,
            target: cell.motion.map(|motion| motion.first_input()),
            edges_away: vec![[0; 3]; scene.particles.len()],
            ..CellState::default()
        })
    }

    /// Whether a state from outside, whose other parts have been checked, has a cell as wide as the largest particle.
    pub(crate) fn check(&self, state: &State) -> Result<(), StateFault> {
        let wide = state.cell.as_ref().is_some_and(|cell| self.narrowest(cell) >= self.largest);
        demand(wide, "cell", 1, "faces no nearer to each other than the largest radius")
    }

    /// The least distance of two faces that repeat \[m\].
    fn narrowest(&self, cell: &CellState) -> f64 {
        let heights = self.images.lattice(cell).heights();
        (0..3).filter(|&edge| self.images.repeats(edge)).map(|edge| heights[edge]).fold(f64::INFINITY, f64::min)
    }

    /// Begins a communication step of `interval` \[s\]: driven components know where they go.
    pub(crate) fn begin(&self, state: &mut State, interval: f64) -> Result<(), RunError> {
        let time = state.clock.time;
        let Some(cell) = &mut state.cell else { return Ok(()) };
        let change: Strains = std::array::from_fn(|component| cell.target_rate[component] * interval);
        for (component, motion) in self.motion.iter().enumerate() {
            let end = cell.target[component] + change[component];
            if matches!(motion, CellMotion::Driven) && !end.is_finite() {
                return Err(RunError::CellStrain { component, strain: end, time });
            }
        }
        cell.volume_before = self.images.lattice(cell).volume();
        (cell.action, cell.stress_sum) = (Strains::default(), Strains::default());
        for (component, motion) in self.motion.iter().enumerate() {
            let is_led = matches!(motion, CellMotion::Driven | CellMotion::Prescribed(_));
            cell.start[component] = if is_led { cell.strain[component] } else { cell.target[component] };
            match motion {
                CellMotion::Prescribed(rate) => cell.target[component] = cell.start[component] + rate * interval,
                _ => cell.target[component] += change[component],
            }
            cell.end[component] = cell.target[component];
            cell.rate[component] = match motion {
                CellMotion::Fixed => 0.0,
                CellMotion::Driven => (cell.end[component] - cell.start[component]) / interval,
                CellMotion::Prescribed(rate) => *rate,
                CellMotion::Servo(servo) => servo.max_rate,
            };
        }
        cell.target_rate = Strains::default();
        Ok(())
    }

    /// Ends a communication step after `elapsed` \[s\].
    pub(crate) fn end(&self, state: &mut State, elapsed: f64) {
        let Some(cell) = &mut state.cell else { return };
        if elapsed > 0.0 {
            let per = elapsed * cell.volume_before;
            cell.conjugate_stress = cell.action.map(|action| action / per);
            cell.mean_stress = cell.stress_sum.map(|sum| sum / elapsed);
        }
    }

    /// Lets the mean stresses begin with the present ones.
    pub(crate) fn begin_mean(&self, state: &mut State, context: &Context) {
        let Some(mut cell) = state.cell.take() else { return };
        let change = Change::between(&cell.strain, &cell.strain);
        (cell.kinetic, _) = carry(state, &cell.origin, &change, 0.0, context);
        let volume = self.images.lattice(&cell).volume();
        let load = |part: &Square| -(product(&cell.kinetic, part) + product(&cell.virial, part));
        cell.conjugate_stress = std::array::from_fn(|component| load(&change.of_start[component]) / volume);
        cell.mean_stress = std::array::from_fn(|component| stress::of(&cell.virial, &cell.kinetic, component) / volume);
        state.cell = Some(cell);
    }

    /// Puts driven components to the inputs of a state, particles with the cell. Returns whether that moved anything.
    pub(crate) fn put(&self, state: &mut State, given: &CellState) -> bool {
        let Some(mut cell) = state.cell.take() else { return false };
        (cell.target, cell.target_rate) = (given.target, given.target_rate);
        let is_driven = |component: usize| matches!(self.motion[component], CellMotion::Driven);
        let after = std::array::from_fn(|component| match is_driven(component) {
            true => cell.target[component],
            false => cell.strain[component],
        });
        let change = Change::between(&cell.strain, &after);
        if !change.is_none() {
            strain_to(&mut cell, state, after, &change);
        }
        state.cell = Some(cell);
        !change.is_none()
    }

    /// Strains the cell by so much in one component, in so long \[s\], particles with it.
    pub(crate) fn displace(&self, state: &mut State, component: usize, (amount, time): (f64, f64)) {
        let Some(mut cell) = state.cell.take() else { return };
        let mut after = cell.strain;
        after[component] += amount;
        let change = Change::between(&cell.strain, &after);
        strain_to(&mut cell, state, after, &change);
        cell.gradient = change.gradient(&after, time);
        state.cell = Some(cell);
    }

    /// Puts images where their particles are.
    pub(crate) fn place_images(&self, state: &mut State) {
        let State { cell: Some(cell), particles, .. } = state else { return };
        images::place(&self.images.lattice(cell), cell, particles);
    }

    /// The strains at the end of the present time step. Servos go on.
    fn strains(&self, cell: &mut CellState, progress: &Progress) -> Strains {
        let volume = self.images.lattice(cell).volume();
        let share = if progress.is_last() { 1.0 } else { progress.share(InputCourse::Ramp) };
        let stresses: Strains =
            std::array::from_fn(|component| stress::of(&cell.virial, &cell.kinetic, component) / volume);
        std::array::from_fn(|component| {
            let along = |from: f64, to: f64| if share < 1.0 { from + (to - from) * share } else { to };
            let (from, to) = (cell.start[component], cell.end[component]);
            match &self.motion[component] {
                CellMotion::Fixed => cell.strain[component],
                CellMotion::Driven | CellMotion::Prescribed(_) => along(from, to),
                CellMotion::Servo(servo) => {
                    let wanted = CellMotion::wanted(&self.motion, component, along(from, to), &stresses);
                    let felt = Felt {
                        error: wanted - stresses[component],
                        stiffness: cell.stiffness[component]
                            + stress::kinetic_stiffness(&cell.kinetic, component) / volume,
                        inertia: cell.inertia,
                    };
                    let rate = servo::rate(servo, felt, &mut cell.held_rate[component], progress.step);
                    cell.strain[component] + progress.step * rate
                }
            }
        })
    }

    /// Deforms the cell and carries particles and images along, after the drift. Returns the strain: no two points at a distance of 1 were
    /// carried towards each other by more.
    pub(crate) fn advance(
        &mut self,
        state: &mut State,
        progress: &Progress,
        context: &Context,
    ) -> Result<f64, RunError> {
        let Some(mut cell) = state.cell.take() else { return Ok(0.0) };
        let result = self.deform(&mut cell, state, progress, context);
        let lattice = self.images.lattice(&cell);
        images::place(&lattice, &cell, &mut state.particles);
        state.cell = Some(cell);
        result
    }

    /// Deforms the cell in a time step.
    fn deform(
        &mut self,
        cell: &mut CellState,
        state: &mut State,
        progress: &Progress,
        context: &Context,
    ) -> Result<f64, RunError> {
        let step = progress.step;
        let after = self.strains(cell, progress);
        let change = Change::between(&cell.strain, &after);
        let largest = change.strain.iter().map(|change| change.abs()).sum::<f64>();
        if largest > LARGEST_STEP || !largest.is_finite() {
            return Err(RunError::CellStep { strain: largest, step, time: state.clock.time });
        }
        let (kinetic, impulse) = carry(state, &cell.origin, &change, step, context);
        cell.kinetic = kinetic;
        self.book_stress(cell, step);
        (0..3).for_each(|axis| cell.impulse[axis] += impulse[axis]);
        cell.strain = after;
        cell.edges = deformation::edges(&cell.reference, &after);
        cell.gradient = if change.is_none() { Square::default() } else { change.gradient(&after, step) };
        let work = book(cell, &change, (-1.0, &kinetic, &change.of_start), step);
        let virial = cell.virial;
        book(cell, &change, (-0.5, &virial, &change.of_start), step);
        if let Some(ledger) = &mut state.ledger {
            book_streaming(ledger, work);
        }
        self.change = Some(change);
        let height = self.narrowest(cell);
        if height < self.largest {
            return Err(RunError::CellNarrow { height, radius: self.largest, time: state.clock.time });
        }
        Ok(change.farthest())
    }

    /// Gives passes the velocities that include the streaming motion.
    pub(crate) fn stream(&mut self, state: &mut State, context: &Context) {
        let Some(cell) = &mut state.cell else { return };
        cell.virial = Square::default();
        let Some(cell) = state.cell.as_ref().filter(|cell| cell.streams()) else { return };
        sweeps::streaming(cell, state, &mut self.other, context);
        std::mem::swap(&mut self.other, &mut state.particles.velocity);
    }

    /// Lets images hand on the loads that passes of one kind have put on them.
    pub(crate) fn gather_images(&self, state: &mut State) {
        let State { cell: Some(cell), particles, .. } = state else { return };
        let lattice = self.images.lattice(cell);
        let sum = images::gather(&lattice, cell, particles);
        add(&mut cell.virial, &sum);
    }

    /// Finds the virial of the loads that stand among the particles, and takes the streaming motion out of their velocities.
    pub(crate) fn find_virial(&mut self, state: &mut State, context: &Context) {
        let Some(cell) = &state.cell else { return };
        if cell.streams() {
            std::mem::swap(&mut self.other, &mut state.particles.velocity);
        }
        let sum = sweeps::virial(cell, state, context);
        if let Some(cell) = &mut state.cell {
            add(&mut cell.virial, &sum);
        }
    }

    /// Books what the present forces did in the second half of the time step.
    pub(crate) fn finish(&mut self, state: &mut State, step: f64) {
        let (Some(cell), Some(change)) = (&mut state.cell, self.change.take()) else { return };
        let virial = cell.virial;
        book(cell, &change, (-0.5, &virial, &change.of_end), step);
        self.book_stress(cell, step);
    }

    /// Books the Cauchy stress at one end of a time step of this length \[s\], with the velocities at its middle.
    fn book_stress(&self, cell: &mut CellState, step: f64) {
        let per_volume = 0.5 * step / self.images.lattice(cell).volume();
        for component in 0..6 {
            cell.stress_sum[component] += per_volume * stress::of(&cell.virial, &cell.kinetic, component);
        }
    }

    /// The largest distance of a surface from the point that the cell carries along \[m\].
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The largest speed at which the deformation brings neighbours towards each other, as it is or is about to be \[m/s\].
    pub(crate) fn speed(&self, state: &State) -> f64 {
        let Some(cell) = &state.cell else { return 0.0 };
        let near = 2.0 * self.reach + state.neighbours.skin;
        let norm = |parts: &[f64]| parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        near * norm(cell.gradient.as_flattened()).max(norm(&cell.rate))
    }

    /// The time step in which no strain changes by too much, as fast as they are about to; infinite where none does \[s\].
    pub(crate) fn longest_step(&self, state: &State) -> f64 {
        let fastest = state.cell.iter().flat_map(|cell| cell.rate).map(f64::abs).sum::<f64>();
        NEAR_LARGEST * LARGEST_STEP / fastest
    }
}

/// Strains a cell at rest, particles and all.
fn strain_to(cell: &mut CellState, state: &mut State, after: Strains, change: &Change) {
    let carry = |row: &mut Row, point: Row| {
        let to = times(&change.forward, [0, 1, 2].map(|axis| point[axis] - cell.origin[axis]));
        (0..3).for_each(|axis| row[axis] = (row[axis] - point[axis]) + (cell.origin[axis] + to[axis]));
    };
    let points: Vec<Row> = (0..state.particles.len()).map(|slot| state.carried_point(slot)).collect();
    state.particles.position.iter_mut().zip(points).for_each(|(row, point)| carry(row, point));
    for row in &mut state.clumps.position {
        let point = *row;
        carry(row, point);
    }
    cell.strain = after;
    cell.edges = deformation::edges(&cell.reference, &after);
}

/// Books the work of a matrix of sums, by a factor and what belongs to each strain. Returns it \[J\].
fn book(
    cell: &mut CellState,
    change: &Change,
    (factor, matrix, parts): (f64, &Square, &[Square; 6]),
    step: f64,
) -> f64 {
    let mut work = 0.0;
    for (component, part) in parts.iter().enumerate() {
        let load = factor * product(matrix, part);
        cell.action[component] += step * load;
        work += load * change.strain[component];
    }
    cell.work += work;
    work
}

/// Books what the streaming motion of the cell did to velocities \[J\].
fn book_streaming(ledger: &mut Ledger, work: f64) {
    ledger.work[Source::Cell as usize] += work;
    ledger.turnover += work.abs();
}

/// Adds a matrix to a sum.
fn add(sum: &mut Square, other: &Square) {
    sum.as_flattened_mut().iter_mut().zip(other.as_flattened()).for_each(|(sum, part)| *sum += part);
}
