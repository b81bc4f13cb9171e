//! What a deformed cell does with every particle in a time step: whole rows of four numbers at once, of which the fourth is not used.

use crate::base::lanes::{self, Kernel, Lane, Shared};
use crate::base::number::Row;
use crate::base::threads::{CHUNK, Context};
use crate::engine::integration::Rows;
use crate::engine::state::State;
use crate::engine::state::cell::{CellState, Square};

use super::deformation::Change;

/// A matrix by its columns.
pub(super) type Columns = [Row; 3];

/// The columns of a matrix.
fn columns(matrix: &Square) -> Columns {
    [0, 1, 2].map(|column| [matrix[0][column], matrix[1][column], matrix[2][column], 0.0])
}

/// The matrix of columns.
pub(super) fn square(columns: &Columns) -> Square {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row]))
}

/// A vector as a row.
fn row([x, y, z]: [f64; 3]) -> Row {
    [x, y, z, 0.0]
}

/// Of each place of a row.
#[inline(always)]
fn each(of: impl Fn(usize) -> f64) -> Row {
    [of(0), of(1), of(2), of(3)]
}

/// Product of a matrix and a vector.
#[inline(always)]
fn times([a, b, c]: &Columns, &[x, y, z, _]: &Row) -> Row {
    each(|k| a[k] * x + b[k] * y + c[k] * z)
}

/// Adds a dyad to a sum.
#[inline(always)]
pub(super) fn add_dyad(sum: &mut Columns, rows: &Row, columns: &Row) {
    for (sum, column) in sum.iter_mut().zip(columns) {
        *sum = each(|k| sum[k] + rows[k] * column);
    }
}

/// Adds columns to a sum.
fn add(sum: &mut Columns, part: &Columns) {
    for (sum, part) in sum.iter_mut().zip(part) {
        *sum = each(|k| sum[k] + part[k]);
    }
}

/// What carries bodies along after the drift.
struct Carry {
    /// The origin of the cell.
    origin: Row,
    /// Where what was at rest goes.
    forward: Columns,
    /// The way back.
    backward: Columns,
    /// Whether nothing is deformed.
    is_none: bool,
    /// Half the time step \[s\].
    half: f64,
}

/// Sums over bodies: −M \[J\] and what was added to the momentum \[N s\].
#[derive(Clone, Copy, Default)]
struct Sums {
    /// −M, by columns.
    kinetic: Columns,
    /// Added momentum.
    impulse: Row,
}

impl Sums {
    /// Adds those of other bodies.
    fn add(mut self, part: Self) -> Self {
        add(&mut self.kinetic, &part.kinetic);
        self.impulse = each(|k| self.impulse[k] + part.impulse[k]);
        self
    }
}

impl Carry {
    /// Carries one body along.
    #[inline(always)]
    fn body(&self, sums: &mut Sums, position: &mut Row, velocity: &mut Row) {
        let (before, mass) = (*velocity, velocity[3]);
        let after = if self.is_none { before } else { times(&self.backward, &before) };
        let half_mass = 0.5 * mass;
        let mean = each(|k| half_mass * (after[k] + before[k]));
        add_dyad(&mut sums.kinetic, &mean, &after);
        if self.is_none {
            return;
        }
        let radius = position[3];
        let from = each(|k| position[k] - self.half * before[k] - self.origin[k]);
        let to = times(&self.forward, &from);
        *position = each(|k| self.origin[k] + to[k] + self.half * after[k]);
        position[3] = radius;
        sums.impulse = each(|k| sums.impulse[k] + mass * (after[k] - before[k]));
        *velocity = after;
        velocity[3] = mass;
    }
}

/// Carries the particles and clumps along, after the drift. Returns −M \[J\] and what that added to the momentum
/// \[N s\].
pub(super) fn carry(
    state: &mut State,
    origin: &[f64; 3],
    change: &Change,
    step: f64,
    context: &Context,
) -> (Square, [f64; 3]) {
    let carry = Carry {
        origin: row(*origin),
        forward: columns(&change.forward),
        backward: columns(&change.backward),
        is_none: change.is_none(),
        half: 0.5 * step,
    };
    let rows = Rows::of(&mut state.particles);
    let of_piece = |piece: usize| {
        let mut sums = Sums::default();
        lanes::run(context.width, CarryPiece { carry: &carry, rows: &rows, piece, sums: &mut sums });
        sums
    };
    let mut sums = context.fold(rows.pieces(), of_piece, Sums::default(), Sums::add);
    carry_clumps(state, &carry, &mut sums);
    let [x, y, z, _] = sums.impulse;
    (square(&sums.kinetic), [x, y, z])
}

/// Carries the clumps along. Their spheres go with them and do not turn.
fn carry_clumps(State { particles, clumps, .. }: &mut State, carry: &Carry, sums: &mut Sums) {
    for clump in 0..clumps.len() {
        let before = [clumps.position[clump], clumps.velocity[clump]];
        carry.body(sums, &mut clumps.position[clump], &mut clumps.velocity[clump]);
        if carry.is_none {
            continue;
        }
        for &sphere in clumps.spheres_of(clump) {
            let slot = particles.slot[sphere as usize] as usize;
            let (position, velocity) = (&mut particles.position[slot], &mut particles.velocity[slot]);
            for axis in 0..3 {
                position[axis] += clumps.position[clump][axis] - before[0][axis];
                velocity[axis] += clumps.velocity[clump][axis] - before[1][axis];
            }
        }
    }
}

/// The carrying of one piece of the particles.
struct CarryPiece<'a> {
    /// What carries.
    carry: &'a Carry,
    /// The particles.
    rows: &'a Rows<'a>,
    /// Which piece.
    piece: usize,
    /// The sums.
    sums: &'a mut Sums,
}

impl Kernel for CarryPiece<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        self.rows.each_free(self.piece, |body| self.carry.body(self.sums, body.position, body.velocity));
    }
}

/// Velocities with the streaming motion, of all rows.
pub(super) fn streaming(cell: &CellState, state: &State, velocities: &mut Vec<Row>, context: &Context) {
    velocities.resize(state.particles.len(), Row::default());
    let (gradient, origin, velocities) = (columns(&cell.gradient), row(cell.origin), Shared::new(velocities));
    context.each(pieces(state), |piece| {
        lanes::run(context.width, StreamingPiece { state, gradient, origin, piece, velocities });
    });
}

/// How many pieces of work all rows are.
fn pieces(state: &State) -> usize {
    state.particles.len().div_ceil(CHUNK)
}

/// The rows of one piece.
#[inline(always)]
fn slots(state: &State, piece: usize) -> std::ops::Range<usize> {
    piece * CHUNK..((piece + 1) * CHUNK).min(state.particles.len())
}

/// Velocities of one piece.
struct StreamingPiece<'a> {
    /// The particles.
    state: &'a State,
    /// The gradient of the streaming velocity \[1/s\].
    gradient: Columns,
    /// The origin of the cell.
    origin: Row,
    /// Which piece.
    piece: usize,
    /// Where the velocities go.
    velocities: Shared<Row>,
}

impl Kernel for StreamingPiece<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        for slot in slots(self.state, self.piece) {
            let (point, velocity) = (self.state.carried_point(slot), self.state.particles.velocity[slot]);
            let streaming = times(&self.gradient, &each(|k| point[k] - self.origin[k]));
            let mut sum = each(|k| velocity[k] + streaming[k]);
            sum[3] = velocity[3];
            // SAFETY: pieces do not overlap.
            unsafe { *self.velocities.at(slot) = sum };
        }
    }
}

/// Σ f ⊗ r of the loads that stand among the particles, over their places in the cell \[J\].
pub(super) fn virial(cell: &CellState, state: &State, context: &Context) -> Square {
    let origin = row(cell.origin);
    let of_piece = |piece: usize| {
        let mut sum = Columns::default();
        lanes::run(context.width, VirialPiece { state, origin, piece, sum: &mut sum });
        sum
    };
    let sum = context.fold(pieces(state), of_piece, Columns::default(), |mut sum, part| {
        add(&mut sum, &part);
        sum
    });
    square(&sum)
}

/// The virial of one piece.
struct VirialPiece<'a> {
    /// The particles.
    state: &'a State,
    /// The origin of the cell.
    origin: Row,
    /// Which piece.
    piece: usize,
    /// The sum, by columns.
    sum: &'a mut Columns,
}

impl Kernel for VirialPiece<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        for slot in slots(self.state, self.piece) {
            let point = self.state.carried_point(slot);
            add_dyad(self.sum, &self.state.particles.force[slot], &each(|k| point[k] - self.origin[k]));
        }
    }
}
