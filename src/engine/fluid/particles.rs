//! What the fluid and particles do to each other, for many particles at once.
//!
//! The load on a particle is what its next two half kicks exchange, if the next time step is as long as this one: both are found with it.

use super::book::enter;
use super::columns::Columns;
use super::half_kick::HalfKick;
use super::sums::{CellSums, Given};
use super::{Medium, Stream};
use crate::base::lanes::{self, Kernel, Lane, Shared, Width};
use crate::base::number::add;
use crate::base::threads::{CHUNK, Context};
use crate::engine::integration::{Fields, Rows};
use crate::engine::state::fluid::{Booked, EXCHANGED};
use crate::engine::state::{FluidState, Row, State};
use std::ops::Range;

/// Rows that each cell is given where a gradient of the pressure is given: those of [`Exchanged`](super::half_kick::Exchanged), and the
/// way of the half kick that comes.
pub(super) const WITH_GRADIENT: usize = EXCHANGED + 1;

/// Adds the force of the fluid to the loads on particles, those of groups among them; clumps have it as bodies. Books what follows for the
/// half kicks around the end of the step, unless damping is still to come to the loads.
pub(crate) fn load(medium: &mut Medium, state: &mut State, fields: &Fields, context: &Context) {
    let Some(mut fluid) = state.fluid.take() else { return };
    let mut sums = std::mem::take(&mut medium.sums);
    let ids = std::mem::take(&mut state.particles.id);
    let (count, cells, step) = (ids.len(), fluid.velocity.now.len(), context.step);
    let mut lift = std::mem::take(&mut fluid.lift);
    lift.clear();
    lift.resize(if medium.lift.is_empty() { 0 } else { count + state.clumps.len() }, [0.0; 4]);
    let work = Work {
        stream: Stream::of(medium, &fluid),
        medium,
        fields,
        rows: Rows::of(&mut state.particles),
        ids: &ids,
        lift: (!lift.is_empty()).then(|| Shared::new(&mut lift)),
        boundaries: state.boundaries.len() as u32,
        step,
        width: context.width,
        books: step > 0.0 && !fields.damps(),
    };
    let (found, given, rows) = match (medium.grid.is_some() && work.books, fluid.rows()) {
        (false, _) => (work.in_pieces(count, context), None, 1),
        (true, 1) => (work.in_parts::<1>((count, cells), &mut sums, context), Some(sums.whole()), 1),
        (true, _) => {
            let found = work.in_parts::<WITH_GRADIENT>((count, cells), &mut sums, context);
            (found, Some(sums.whole()), WITH_GRADIENT)
        }
    };
    let books = work.books;
    fluid.lift = lift;
    fluid.step = step;
    fluid.coming.step = if books { step } else { 0.0 };
    if books {
        give(&mut fluid, given.unwrap_or(&[found.drag]), rows);
        enter(&mut fluid, state, found.now);
        fluid.coming.booked = found.coming;
    }
    state.particles.id = ids;
    medium.sums = sums;
    state.fluid = Some(fluid);
}

/// Gives cells what they exchange in the half kick that ends the step, and notes it for the one that comes, which is the same but for the way
/// of the particles. Each has so many rows.
fn give(fluid: &mut FluidState, given: &[Row], rows: usize) {
    let each = fluid.rows();
    for (cell, given) in given.chunks_exact(rows).enumerate() {
        for row in 0..each.min(rows) {
            let place = each * cell + row;
            add(&mut fluid.exchanged[place], &given[row]);
            fluid.coming.rows[place] = given[if row == EXCHANGED - 1 { EXCHANGED } else { row }];
        }
    }
}

/// What is booked of two half kicks.
#[derive(Clone, Copy, Default)]
pub(super) struct Booking {
    /// Impulse of the drag on the fluid \[N s\], and behind it drag over the velocity times the length of the half kick \[kg\].
    pub(super) drag: Row,
    /// What is booked of the half kick that ends the step.
    pub(super) now: Booked,
    /// What is booked of that which comes.
    pub(super) coming: Booked,
}

impl Booking {
    /// Both together.
    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        let mut drag = self.drag;
        add(&mut drag, &other.drag);
        Self { drag, now: self.now.plus(other.now), coming: self.coming.plus(other.coming) }
    }
}

/// What is to be done.
pub(super) struct Work<'a> {
    /// What never changes of the fluid.
    pub(super) medium: &'a Medium,
    /// How it flows.
    pub(super) stream: Stream<'a>,
    /// Gravity and applied forces.
    pub(super) fields: &'a Fields,
    /// The particles.
    pub(super) rows: Rows<'a>,
    /// Their ids.
    pub(super) ids: &'a [u32],
    /// Lift on each of them, where anything lifts \[N\].
    pub(super) lift: Option<Shared<Row>>,
    /// How many boundaries there are: images and spheres of clumps are counted on behind them.
    pub(super) boundaries: u32,
    /// The time step \[s\].
    pub(super) step: f64,
    /// Lane width.
    pub(super) width: Width,
    /// Whether half kicks are booked.
    pub(super) books: bool,
}

/// A part of the work, in which cells have so many rows.
struct Part<'a, 'b, 'c, const ROWS: usize> {
    /// What is to be done.
    work: &'a Work<'b>,
    /// On which particles.
    some: Range<usize>,
    /// What cells are given.
    given: &'a mut Given<'c>,
    /// What is booked.
    found: &'a mut Booking,
}

impl<const ROWS: usize> Kernel for Part<'_, '_, '_, ROWS> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, some, given, found } = self;
        let (mut columns, beside) = (Columns::new(), work.medium.acts_beside());
        let mut next = some.start;
        while next < some.end {
            next = columns.gather(work, next..some.end);
            if beside {
                columns.gather_beside(work);
            }
            columns.find_drag(work);
            if beside {
                columns.find_lift(work);
            }
            if work.books {
                if beside {
                    columns.find_books::<true>(work);
                } else {
                    columns.find_books::<false>(work);
                }
                columns.hand_out::<ROWS>(given, found);
            }
            if beside {
                columns.share_out();
            }
            columns.write(work, found);
        }
    }
}

impl Work<'_> {
    /// Does it for all of so many particles, with nothing for cells.
    fn in_pieces(&self, count: usize, context: &Context) -> Booking {
        let of_piece =
            |piece: usize| self.on::<0>(piece * CHUNK..((piece + 1) * CHUNK).min(count), &mut Given(&mut []));
        context.fold(count.div_ceil(CHUNK), of_piece, Booking::default(), Booking::plus)
    }

    /// Does it for all of so many particles, with so many rows for each of so many cells.
    fn in_parts<const ROWS: usize>(
        &self,
        (count, cells): (usize, usize),
        sums: &mut CellSums,
        context: &Context,
    ) -> Booking {
        let of_part = |some: Range<usize>, given: &mut Given| self.on::<ROWS>(some, given);
        sums.over((count, ROWS * cells), context, of_part, (Booking::default(), Booking::plus))
    }

    /// Does it for these particles.
    fn on<const ROWS: usize>(&self, some: Range<usize>, given: &mut Given) -> Booking {
        let mut found = Booking::default();
        lanes::run(self.width, Part::<ROWS> { work: self, some, given, found: &mut found });
        found
    }

    /// The half kick that ends the step, and that which comes.
    #[inline(always)]
    pub(super) fn kicks(&self) -> [HalfKick; 2] {
        let half = 0.5 * self.step;
        [None, Some(half)].map(|behind| HalfKick { half, behind })
    }
}
