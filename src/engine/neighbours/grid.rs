//! Slabs, and in them cells for each size of particles.
//!
//! Slabs lie across the longest extent of the packing, each at least as thick as the longest reach of a pair. Every
//! level of sizes has cells of its own, no smaller than the reach of two particles of that level, and a whole number
//! of layers of them in each slab. Particles of one level therefore find each other in neighbouring cells, and any
//! two find each other in neighbouring slabs.

use super::sizes::Sizes;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{Particles, Row};

/// Cells a particle more than this are not made: a few particles far apart need no fine grid.
const CELLS_PER_PARTICLE: f64 = 4.0;

/// More slabs than this are not made: they are pieces of work for threads, and counters of each are kept.
const MOST_SLABS: f64 = 1024.0;

/// A quotient that is rounded up must not bring a pair two cells apart.
const HAIR: f64 = 1.0 + 1e-9;

/// Cells around all particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grid {
    /// Axes in the order of sorting: across slabs, then the two inside a slab.
    pub axes: [usize; 3],
    /// Lower corner, in that order \[m\].
    pub origin: [f64; 3],
    /// Number of slabs.
    pub slabs: usize,
    /// Cells of one slab.
    pub cells: usize,
    /// Cells of each size, the largest particles first.
    pub levels: Vec<Level>,
    /// Of each layer of each level: its slab, and its first cell. Looking it up is cheaper than dividing.
    layers: Vec<[u32; 2]>,
}

/// The cells of one size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// Largest radius of its particles \[m\].
    pub largest: f64,
    /// Cells a metre, across slabs and inside them \[1/m\].
    pub fineness: [f64; 3],
    /// Layers in a slab.
    pub layers: usize,
    /// Rows of cells in a layer, cells in a row.
    pub counts: [usize; 2],
    /// Where its layers begin among those of all levels.
    first_layer: usize,
}

impl Grid {
    /// Cells around all particles: within a level no smaller than the reach of two of its particles and `skin` \[m\],
    /// slabs no thinner than `longest` \[m\] besides.
    pub(crate) fn around(particles: &Particles, sizes: &Sizes, skin: f64, longest: f64, context: &Context) -> Self {
        let (low, high) = corners(&particles.position, context);
        let mut axes = [0, 1, 2];
        let wide = [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
        axes.sort_by(|&a, &b| wide[b].total_cmp(&wide[a]).then(a.cmp(&b)));
        let extent = axes.map(|axis| wide[axis]);
        let reach = |level: usize| (2.0 * sizes.largest[level] + skin) * HAIR;
        let thick = (longest * HAIR).max(reach(0));
        let most = (particles.len() as f64 * CELLS_PER_PARTICLE).max(1.0);
        let [slabs, ..] = thinned(extent.map(|extent| (extent / thick).floor().max(1.0)), most);
        let slabs = slabs.min(MOST_SLABS).min(most);
        let thickness = (extent[0] / slabs).max(thick);
        let origin = axes.map(|axis| low[axis]);
        let mut grid = Self { axes, origin, slabs: slabs as usize, cells: 0, levels: vec![], layers: vec![] };
        let mut before = Vec::new();
        for level in 0..sizes.largest.len() {
            let cell = reach(level);
            let most = (sizes.counts[level] as f64 * CELLS_PER_PARTICLE / slabs).max(1.0);
            let wanted = [thickness, extent[1], extent[2]].map(|extent| (extent / cell).floor().max(1.0));
            let [layers, rows, row] = thinned(wanted, most).map(|count| count.min(most));
            grid.levels.push(Level {
                largest: sizes.largest[level],
                fineness: [layers / thickness, 1.0 / (extent[1] / rows).max(cell), 1.0 / (extent[2] / row).max(cell)],
                layers: layers as usize,
                counts: [rows as usize, row as usize],
                first_layer: 0,
            });
            before.push(grid.cells);
            grid.cells += layers as usize * rows as usize * row as usize;
        }
        for (level, before) in grid.levels.iter_mut().zip(before) {
            level.first_layer = grid.layers.len();
            let own = |layer: usize| (layer / level.layers, layer % level.layers);
            grid.layers.extend((0..grid.slabs * level.layers).map(own).map(|(slab, within)| {
                let first = slab * grid.cells + before + within * level.counts[0] * level.counts[1];
                [slab as u32, first as u32]
            }));
        }
        grid
    }

    /// The layer of a coordinate across the slabs, counted from the first slab \[m\].
    #[inline(always)]
    pub(crate) fn layer(&self, level: &Level, coordinate: f64) -> usize {
        let layer = ((coordinate - self.origin[0]) * level.fineness[0]) as usize;
        layer.min(self.slabs * level.layers - 1)
    }

    /// Row in its layer (`within` 0) or cell in its row (1) of a coordinate \[m\].
    #[inline(always)]
    pub(crate) fn place(&self, level: &Level, within: usize, coordinate: f64) -> usize {
        let place = ((coordinate - self.origin[within + 1]) * level.fineness[within + 1]) as usize;
        place.min(level.counts[within] - 1)
    }

    /// First cell of a row.
    #[inline(always)]
    pub(crate) fn row(&self, level: &Level, layer: usize, row: usize) -> usize {
        self.layers[level.first_layer + layer][1] as usize + row * level.counts[1]
    }

    /// Slab and cell of a particle of this level.
    #[inline(always)]
    pub(crate) fn cell(&self, level: &Level, position: &Row) -> [u32; 2] {
        let [slab, first] = self.layers[level.first_layer + self.layer(level, position[self.axes[0]])];
        let row = self.place(level, 0, position[self.axes[1]]) * level.counts[1];
        [slab, first + (row + self.place(level, 1, position[self.axes[2]])) as u32]
    }

    /// First cells of the rows ahead of a row in which particles of the same level can be reached from there: up to
    /// four, in the order of the cells; and how many.
    #[inline(always)]
    pub(crate) fn ahead(&self, level: &Level, layer: usize, row: usize) -> ([usize; 4], usize) {
        let [rows, cells] = level.counts;
        let (mut found, mut count) = ([0; 4], 0);
        if row + 1 < rows {
            found[0] = self.row(level, layer, row + 1);
            count = 1;
        }
        if layer + 1 < self.slabs * level.layers {
            let base = self.row(level, layer + 1, 0);
            let mut other = row.saturating_sub(1);
            while other < rows && other < row + 2 {
                found[count] = base + other * cells;
                count += 1;
                other += 1;
            }
        }
        (found, count)
    }
}

/// Counts of cells along three axes, made fewer until their product is not above `most`.
fn thinned(wanted: [f64; 3], most: f64) -> [f64; 3] {
    let product = wanted[0] * wanted[1] * wanted[2];
    if product <= most {
        return wanted;
    }
    let thin = libm::cbrt(product / most);
    wanted.map(|count| (count / thin).floor().max(1.0))
}

/// Lower and upper corner of a box around all centres \[m\].
fn corners(position: &[Row], context: &Context) -> ([f64; 3], [f64; 3]) {
    let boxes = context.collect(position.len().div_ceil(CHUNK), |piece| {
        let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        for row in &position[piece * CHUNK..((piece + 1) * CHUNK).min(position.len())] {
            for axis in 0..4 {
                low[axis] = if row[axis] < low[axis] { row[axis] } else { low[axis] };
                high[axis] = if row[axis] > high[axis] { row[axis] } else { high[axis] };
            }
        }
        (low, high)
    });
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (lower, upper) in boxes {
        for axis in 0..3 {
            low[axis] = low[axis].min(lower[axis]);
            high[axis] = high[axis].max(upper[axis]);
        }
    }
    if position.is_empty() { ([0.0; 3], [0.0; 3]) } else { (low, high) }
}
