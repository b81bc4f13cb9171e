//! Near pairs of particles, slab by slab, several distances at a time.

use super::grid::{Grid, Level};
use super::order::Order;
use crate::base::lanes::{self, Kernel, Lane, Shared};
use crate::base::threads::Context;
use crate::engine::state::{Columns, Particles};
use crate::scene::GoverningLaws;

/// Room behind the found ones, for a register that begins at the last.
const BEYOND: usize = 8;

/// Which pairs have a law.
#[derive(Clone, Debug)]
pub(crate) struct Laws {
    /// The contact law of each two materials.
    pub governing: GoverningLaws,
    /// The law of every pair of particles, where there is only one and no two particles are moved by the same.
    pub only: Option<u32>,
    /// Number of laws.
    pub count: usize,
    /// The last owner of particles that is a boundary with its group.
    pub groups: u32,
}

impl Laws {
    /// The contact law of two materials.
    pub(crate) fn between(&self, a: u32, b: u32) -> Option<u32> {
        self.governing.between(a, b)
    }
}

/// Pairs whose first particle is in one slab.
#[derive(Clone, Debug, Default)]
pub(crate) struct FoundPairs {
    /// Second particles; more than [`FoundPairs::count`] of them are room to work in.
    pub second: Vec<u32>,
    /// First particles, where pairs have several laws; otherwise empty.
    pub first: Vec<u32>,
    /// The law of each pair; empty where one law is for all.
    pub law: Vec<u32>,
    /// First pair of each particle of the slab, counted from the slab's first; empty where pairs have several laws.
    pub starts: Vec<u32>,
    /// How many there are.
    pub count: usize,
    /// How many of each law.
    pub of_law: Vec<u32>,
}

/// The search: its input and its criteria.
pub(crate) struct PairSearch<'a> {
    /// The cells.
    pub grid: &'a Grid,
    /// What is in them.
    pub order: &'a Order,
    /// Where the particles are.
    pub columns: &'a Columns,
    /// Their materials and owners.
    pub particles: &'a Particles,
    /// Which pairs have a law.
    pub laws: &'a Laws,
    /// How far beyond touch pairs are listed \[m\].
    pub skin: f64,
}

/// Finds the near pairs of all slabs.
pub(crate) fn find(look: &PairSearch, found: &mut Vec<FoundPairs>, context: &Context) {
    found.resize(look.grid.slabs, FoundPairs::default());
    let found = Shared::new(found);
    context.each(look.grid.slabs, |slab| {
        // SAFETY: each slab has a place of its own.
        let found = unsafe { found.at(slab) };
        lanes::run(context.width, SlabSearch { look, slab, found });
    });
}

/// The search in one slab.
struct SlabSearch<'a, 'b> {
    /// The particles that are searched.
    look: &'a PairSearch<'a>,
    /// Which slab.
    slab: usize,
    /// Where the pairs go.
    found: &'b mut FoundPairs,
}

impl Kernel for SlabSearch<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { look, slab, found } = self;
        let grid = look.grid;
        found.clear(look.laws.count);
        let mut number = 0;
        while number < grid.levels.len() {
            let level = &grid.levels[number];
            let mut layer = slab * level.layers;
            while layer < (slab + 1) * level.layers {
                let mut row = 0;
                while row < level.counts[0] {
                    search_row::<N>(look, (slab, number), layer, row, found);
                    row += 1;
                }
                layer += 1;
            }
            number += 1;
        }
        if look.laws.only.is_some() {
            found.of_law[0] = found.count as u32;
        }
    }
}

/// Looks from the particles in one row of cells.
#[inline(always)]
fn search_row<N: Lane>(look: &PairSearch, from: (usize, usize), layer: usize, row: usize, found: &mut FoundPairs) {
    let (grid, starts) = (look.grid, &look.order.starts[..]);
    let level = &grid.levels[from.1];
    let here = &starts[grid.row(level, layer, row)..][..=level.counts[1]];
    let (bases, count) = grid.ahead(level, layer, row);
    let mut place = 0;
    while place < level.counts[1] {
        let (begin, end) = (here[place] as usize, here[place + 1] as usize);
        if begin < end {
            let lower = if place > 0 { place - 1 } else { 0 };
            let upper = if place + 2 < level.counts[1] { place + 2 } else { level.counts[1] };
            let own = here[upper] as usize;
            let (mut ranges, mut most) = ([[0; 2]; 4], own - begin);
            let mut other = 0;
            while other < count {
                ranges[other] = [starts[bases[other] + lower] as usize, starts[bases[other] + upper] as usize];
                most += ranges[other][1] - ranges[other][0];
                other += 1;
            }
            let mut i = begin;
            while i < end {
                let before = found.count;
                found.reserve(most);
                let body = Body::<N>::of(look.columns, i, look.skin);
                let mut count = body.near(look.columns, i + 1, own, &mut found.second[before..]);
                for [from, to] in ranges {
                    count += body.near(look.columns, from, to, &mut found.second[before + count..]);
                }
                found.count += count;
                if grid.levels.len() > 1 {
                    search_other_levels(look, from, i, &body, found);
                    found.second[before..found.count].sort_unstable();
                }
                found.accept(look, i as u32, before);
                i += 1;
            }
        }
        place += 1;
    }
}

/// Looks for particles of other levels that stand behind particle `i` in memory: smaller ones in its slab, all in the
/// next.
#[inline(always)]
fn search_other_levels<N: Lane>(
    look: &PairSearch,
    (slab, own): (usize, usize),
    i: usize,
    body: &Body<N>,
    found: &mut FoundPairs,
) {
    let (grid, starts) = (look.grid, &look.order.starts[..]);
    let of = [&look.columns.x, &look.columns.y, &look.columns.z];
    let at = [of[grid.axes[0]][i], of[grid.axes[1]][i], of[grid.axes[2]][i]];
    let mut number = 0;
    while number < grid.levels.len() {
        let level: &Level = &grid.levels[number];
        let reach = (look.columns.radius[i] + level.largest + look.skin) * (1.0 + 1e-9);
        let first = if number > own { slab } else { slab + 1 };
        let end = (slab + 2).min(grid.slabs) * level.layers;
        let lower = grid.layer(level, at[0] - reach).max(first * level.layers);
        let upper = (grid.layer(level, at[0] + reach) + 1).min(end);
        if number != own && lower < upper {
            let rows = [grid.place(level, 0, at[1] - reach), grid.place(level, 0, at[1] + reach)];
            let cells = [grid.place(level, 1, at[2] - reach), grid.place(level, 1, at[2] + reach)];
            let mut layer = lower;
            while layer < upper {
                let mut row = rows[0];
                while row <= rows[1] {
                    let base = grid.row(level, layer, row);
                    let (from, to) = (starts[base + cells[0]] as usize, starts[base + cells[1] + 1] as usize);
                    if from < to {
                        found.reserve(to - from);
                        found.count += body.near(look.columns, from, to, &mut found.second[found.count..]);
                    }
                    row += 1;
                }
                layer += 1;
            }
        }
        number += 1;
    }
}

/// A particle in lanes.
struct Body<N> {
    /// Position \[m\].
    position: [N; 3],
    /// Radius \[m\].
    radius: N,
    /// Skin \[m\].
    skin: N,
}

impl<N: Lane> Body<N> {
    /// Particle `i`.
    #[inline(always)]
    fn of(columns: &Columns, i: usize, skin: f64) -> Self {
        let Columns { x, y, z, radius } = columns;
        Self {
            position: [N::splat(x[i]), N::splat(y[i]), N::splat(z[i])],
            radius: N::splat(radius[i]),
            skin: N::splat(skin),
        }
    }

    /// Writes those of a range of particles that are nearer than touch plus skin. Returns how many.
    #[inline(always)]
    fn near(&self, columns: &Columns, from: usize, to: usize, place: &mut [u32]) -> usize {
        let Columns { x, y, z, radius } = columns;
        debug_assert!(to + BEYOND <= x.len() && place.len() + from >= to + BEYOND);
        let (x, y, z, radius) = (x.as_ptr(), y.as_ptr(), z.as_ptr(), radius.as_ptr());
        let place = place.as_mut_ptr();
        let mut count = 0;
        let mut j = from;
        while j < to {
            // SAFETY: columns reach a register beyond the last particle; there is room for all of the range and a
            // register more.
            unsafe {
                let dx = N::load(x.add(j)) - self.position[0];
                let dy = N::load(y.add(j)) - self.position[1];
                let dz = N::load(z.add(j)) - self.position[2];
                let reach = N::load(radius.add(j)) + self.radius + self.skin;
                let near = N::bits((reach * reach).greater(dx * dx + dy * dy + dz * dz));
                let inside = if to - j < N::WIDTH { (1 << (to - j)) - 1 } else { u32::MAX };
                count += N::compress(near & inside, j as u32, place.add(count));
            }
            j += N::WIDTH;
        }
        count
    }
}

impl FoundPairs {
    /// Forgets all.
    fn clear(&mut self, laws: usize) {
        self.count = 0;
        self.law.clear();
        self.starts.clear();
        self.of_law.clear();
        self.of_law.resize(laws.max(1), 0);
    }

    /// Makes room for so many more.
    #[inline(always)]
    fn reserve(&mut self, more: usize) {
        let least = self.count + more + BEYOND;
        if self.second.len() < least {
            self.grow(least);
        }
    }

    /// Makes room for so many in all.
    #[cold]
    fn grow(&mut self, least: usize) {
        self.second.resize(least + least / 2, 0);
    }

    /// Notes whose pairs were found since there were `before`, and drops what has no law.
    #[inline(always)]
    fn accept(&mut self, look: &PairSearch, i: u32, before: usize) {
        if look.laws.only.is_some() {
            self.starts.push(before as u32);
        } else {
            self.choose(look, i, before);
        }
    }

    /// The same where pairs have several laws, or none.
    fn choose(&mut self, look: &PairSearch, i: u32, before: usize) {
        let Particles { material, owner, .. } = look.particles;
        self.first.resize(self.second.len(), 0);
        let mut kept = before;
        for pair in before..self.count {
            let j = self.second[pair];
            // Two images make no pair, and images of a group are one body with it.
            let [one, other] = [i, j].map(|slot| owner[slot as usize]);
            let of = |slot: u32| owner[look.particles.original(slot) as usize];
            let together = one != 0 && other != 0 && (one == other || of(i) <= look.laws.groups && of(i) == of(j));
            let law = look.laws.between(material[i as usize], material[j as usize]);
            if let Some(law) = law.filter(|_| !together) {
                self.first[kept] = i;
                self.second[kept] = j;
                self.law.push(law);
                self.of_law[law as usize] += 1;
                kept += 1;
            }
        }
        self.count = kept;
    }
}
