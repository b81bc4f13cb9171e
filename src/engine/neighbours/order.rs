//! Particles sorted into cells: by slab first, piece by piece, then slab by slab.
//!
//! Both sorts count and keep the order of equals, so the result does not depend on who does which piece.

use super::grid::Grid;
use super::sizes::Sizes;
use crate::base::lanes::Shared;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::particles::{Entry, each_column};
use crate::engine::state::{Columns, IMAGE, Particles, Row};

/// Particles in a piece of the sort by slab.
const PIECE: usize = 4 * CHUNK;

/// Room behind the columns, for a register that begins at the last particle.
pub(crate) const BEYOND: usize = 8;

/// Where the particles belong, and what sorting needs; kept from one time to the next.
#[derive(Debug, Default)]
pub(crate) struct Order {
    /// Old slot of each new one.
    pub slots: Vec<u32>,
    /// New slot of each old one.
    pub new_slot: Vec<u32>,
    /// First new slot of each cell, and the number of particles behind the last.
    pub starts: Vec<u32>,
    /// First new slot of each slab, and the number of particles behind the last.
    pub slabs: Vec<u32>,
    /// Cell and old slot, sorted by slab.
    keyed: Vec<[u32; 2]>,
    /// Slab and cell of each old slot.
    cells: Vec<[u32; 2]>,
    /// Of each piece and slab: how many particles, then where the next goes.
    counts: Vec<u32>,
    /// Entries of columns in their new order.
    spare: Spare,
}

/// Room for a column that is sorted, for each type of its entries.
#[derive(Debug, Default)]
struct Spare {
    /// Rows.
    rows: Vec<Row>,
    /// Whole numbers.
    numbers: Vec<u32>,
    /// Numbers.
    scalars: Vec<f64>,
}

/// Finds the room for a column.
trait Sorted: Entry {
    /// The room for columns of such entries.
    fn room(spare: &mut Spare) -> &mut Vec<Self>;
}

impl Sorted for Row {
    fn room(spare: &mut Spare) -> &mut Vec<Self> {
        &mut spare.rows
    }
}

impl Sorted for u32 {
    fn room(spare: &mut Spare) -> &mut Vec<Self> {
        &mut spare.numbers
    }
}

impl Sorted for f64 {
    fn room(spare: &mut Spare) -> &mut Vec<Self> {
        &mut spare.scalars
    }
}

impl Order {
    /// Finds the new order of the particles. Nothing is moved yet.
    pub(crate) fn find(&mut self, grid: &Grid, sizes: &Sizes, particles: &Particles, context: &Context) {
        self.sort_by_slab(grid, sizes, particles, context);
        self.sort_by_cell(grid, context);
    }

    /// Sorts into slabs, pieces of particles side by side.
    fn sort_by_slab(&mut self, grid: &Grid, sizes: &Sizes, particles: &Particles, context: &Context) {
        let count = particles.len();
        let pieces = count.div_ceil(PIECE);
        self.cells.resize(count, [0; 2]);
        self.counts.clear();
        self.counts.resize(pieces * grid.slabs, 0);
        let (cells, counts) = (Shared::new(&mut self.cells), Shared::new(&mut self.counts));
        let range = |piece: usize| piece * PIECE..((piece + 1) * PIECE).min(count);
        let own = |piece: usize| {
            // SAFETY: each piece has counters of its own.
            unsafe { counts.part(piece * grid.slabs, (piece + 1) * grid.slabs) }
        };
        context.each(pieces, |piece| {
            let tally = own(piece);
            for slot in range(piece) {
                let position = &particles.position[slot];
                let cell = grid.cell(&grid.levels[sizes.level(position[3])], position);
                // SAFETY: pieces do not overlap.
                unsafe { *cells.at(slot) = cell };
                tally[cell[0] as usize] += 1;
            }
        });
        self.slabs.clear();
        let mut sum = 0;
        for slab in 0..grid.slabs {
            self.slabs.push(sum);
            for piece in 0..pieces {
                let here = &mut self.counts[piece * grid.slabs + slab];
                (*here, sum) = (sum, sum + *here);
            }
        }
        self.slabs.push(sum);
        self.keyed.resize(count, [0; 2]);
        let (keyed, counts) = (Shared::new(&mut self.keyed), Shared::new(&mut self.counts));
        let cells = &self.cells;
        context.each(pieces, |piece| {
            // SAFETY: each piece has counters of its own, which point to places of its own.
            let next = unsafe { counts.part(piece * grid.slabs, (piece + 1) * grid.slabs) };
            for slot in range(piece) {
                let [slab, cell] = cells[slot];
                let place = &mut next[slab as usize];
                // SAFETY: as above.
                unsafe { *keyed.at(*place as usize) = [cell, slot as u32] };
                *place += 1;
            }
        });
    }

    /// Sorts into the cells of each slab, slabs side by side.
    fn sort_by_cell(&mut self, grid: &Grid, context: &Context) {
        self.starts.clear();
        self.starts.resize(grid.slabs * grid.cells + 1, 0);
        self.slots.resize(self.keyed.len(), 0);
        let (starts, slots) = (Shared::new(&mut self.starts), Shared::new(&mut self.slots));
        let (keyed, slabs) = (&self.keyed, &self.slabs);
        context.each(grid.slabs, |slab| {
            let (from, to) = (slabs[slab] as usize, slabs[slab + 1] as usize);
            let first = slab * grid.cells;
            // SAFETY: what stands behind the first cell of a slab up to its last belongs to the slab alone. While
            // particles are placed it holds where the next one goes, in the end where the next cell begins.
            let next = unsafe { starts.part(first + 1, first + grid.cells + 1) };
            for [cell, _] in &keyed[from..to] {
                next[*cell as usize - first] += 1;
            }
            let mut sum = from as u32;
            for count in next.iter_mut() {
                (*count, sum) = (sum, sum + *count);
            }
            for [cell, slot] in &keyed[from..to] {
                let place = &mut next[*cell as usize - first];
                // SAFETY: places from `from` to `to` belong to this slab.
                unsafe { *slots.at(*place as usize) = *slot };
                *place += 1;
            }
        });
    }

    /// Puts the particles into the new order.
    pub(crate) fn apply(&mut self, particles: &mut Particles, context: &Context) {
        let count = self.slots.len();
        let pieces = count.div_ceil(CHUNK);
        let slots = &self.slots;
        let spare = &mut self.spare;
        each_column!(&mut *particles, |_name, _images, column| permute(column, spare, slots, context));
        self.new_slot.resize(count, 0);
        let (new_slot, slot_of) = (Shared::new(&mut self.new_slot), Shared::new(&mut particles.slot));
        let (id, owner) = (&particles.id, &particles.owner);
        context.each(pieces, |piece| {
            for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
                // SAFETY: each old slot, and each of the scene's particles, has one new slot.
                unsafe {
                    *new_slot.at(slots[slot] as usize) = slot as u32;
                    if owner[slot] != IMAGE {
                        *slot_of.at(id[slot] as usize) = slot as u32;
                    }
                }
            }
        });
    }
}

/// Puts items into a new order, by way of a spare list.
fn permute<T: Sorted>(items: &mut Vec<T>, spare: &mut Spare, slots: &[u32], context: &Context) {
    let count = items.len();
    if count == 0 {
        return;
    }
    let spare = T::room(spare);
    spare.resize(count, T::default());
    let (from, to) = (&items[..], Shared::new(spare));
    context.each(count.div_ceil(CHUNK), |piece| {
        let (first, end) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
        // SAFETY: pieces do not overlap.
        let part = unsafe { to.part(first, end) };
        for (item, &slot) in part.iter_mut().zip(&slots[first..end]) {
            *item = from[slot as usize];
        }
    });
    std::mem::swap(items, spare);
}

/// Brings the positions into columns.
pub(crate) fn fill(columns: &mut Columns, position: &[Row], context: &Context) {
    let Columns { x, y, z, radius } = columns;
    let columns = [x, y, z, radius].map(|column| {
        column.resize(position.len() + BEYOND, 0.0);
        Shared::new(column)
    });
    context.each(position.len().div_ceil(CHUNK), |piece| {
        let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(position.len()));
        // SAFETY: pieces do not overlap.
        let [x, y, z, radius] = columns.map(|column| unsafe { column.part(from, to) });
        for (place, row) in position[from..to].iter().enumerate() {
            [x[place], y[place], z[place], radius[place]] = *row;
        }
    });
}
