//! Which particles are near each other, and the order they are kept in.
//!
//! Particles are sorted into slabs across the longest extent of the packing, each at least as thick as the largest
//! reach of a pair, and inside a slab into square columns of cells. Pairs therefore reach no further than the next
//! slab. Springs follow the pair of particles, never a place in a list.

use super::{bonds, walls};
use crate::scene::{Scene, Shape};
use crate::state::contacts::TOUCHING;
use crate::state::{ContactList, Particles, Row, State};

/// Cells a particle more than this are not made: a few particles far apart need no fine grid.
const CELLS_PER_PARTICLE: usize = 4;

/// What the search needs to know of the scene.
pub(super) struct Search {
    /// The contact law of each two materials, row by row.
    law_of: Vec<Option<u32>>,
    /// Number of materials.
    materials: usize,
    /// Planes of the scene: boundary, material, point at time 0, normal.
    planes: Vec<(u32, u32, [f64; 3], [f64; 3])>,
    /// Radius of the largest particle \[m\].
    largest: f64,
    /// Radius of the smallest particle \[m\].
    smallest: f64,
    /// Whether anything can touch.
    touching: bool,
    /// Whether there are lists at all.
    needed: bool,
}

impl Search {
    /// Reads what concerns the search from the scene.
    pub(super) fn of(scene: &Scene) -> Self {
        let materials = scene.materials.len();
        let law_of = (0..materials * materials)
            .map(|entry| scene.contacts.iter().position(|law| law.between[entry]).map(|law| law as u32))
            .collect();
        let planes = scene.boundaries.iter().enumerate().filter_map(|(index, boundary)| match &boundary.shape {
            Shape::Plane { material, point, normal } => Some((index as u32, material.0, *point, *normal)),
            Shape::Particles { .. } => None,
        });
        Self {
            law_of,
            materials,
            planes: planes.collect(),
            largest: scene.particles.iter().fold(0.0, |largest, particle| particle.radius.max(largest)),
            smallest: scene.particles.iter().fold(f64::INFINITY, |smallest, particle| particle.radius.min(smallest)),
            touching: !scene.contacts.is_empty() && !scene.particles.is_empty(),
            needed: !scene.particles.is_empty() && (!scene.contacts.is_empty() || !scene.bonds.is_empty()),
        }
    }

    /// Radius of the smallest particle \[m\].
    pub(super) fn smallest_radius(&self) -> f64 {
        self.smallest
    }

    /// The contact law of two materials.
    fn law(&self, a: u32, b: u32) -> Option<u32> {
        self.law_of[a as usize * self.materials + b as usize]
    }

    /// Whether the lists no longer hold every pair that can touch.
    pub(super) fn outdated(&self, state: &mut State) -> bool {
        if !self.touching {
            return false;
        }
        let walls = self.planes.iter().map(|&(boundary, ..)| {
            let now = state.boundaries[boundary as usize].displacement;
            let then = state.neighbours.boundary_reference[boundary as usize];
            way(&now, &then)
        });
        let wall = walls.fold(0.0, f64::max);
        let skin = state.neighbours.skin;
        if state.neighbours.travel + wall.max(state.neighbours.travel) <= skin {
            return false;
        }
        let moved = state.particles.position.iter().zip(&state.neighbours.reference);
        let square = moved.fold(0.0, |most: f64, (now, then)| {
            let (x, y, z) = (now[0] - then[0], now[1] - then[1], now[2] - then[2]);
            most.max(x * x + y * y + z * z)
        });
        state.neighbours.travel = square.sqrt();
        state.neighbours.travel + wall.max(state.neighbours.travel) > skin
    }

    /// Sorts the particles and makes the lists anew.
    pub(super) fn rebuild(&self, state: &mut State) {
        if !self.needed {
            return;
        }
        let skin = if self.touching { state.neighbours.skin } else { 0.0 };
        let reach = (2.0 * self.largest + skin).max(bonds::longest(state));
        let grid = Grid::around(&state.particles, reach);
        let order = grid.order(&state.particles);
        let new_slot = sort(&mut state.particles, &order.slots);
        for list in &mut state.bonds {
            bonds::sort(list, &new_slot, &order.slabs);
        }
        let lists = self.pairs(&state.particles, &grid, &order, state.neighbours.skin, state.contacts.len());
        for (old, mut new) in state.contacts.iter_mut().zip(lists) {
            carry(old, &mut new, &new_slot, &order.slabs);
            *old = new;
        }
        for index in 0..state.walls.len() {
            state.walls[index] = self.near_plane(state, index, &new_slot);
        }
        state.neighbours.slabs = order.slabs;
        state.neighbours.reference.clone_from(&state.particles.position);
        state.neighbours.boundary_reference = state.boundaries.iter().map(|b| b.displacement).collect();
        state.neighbours.travel = 0.0;
        state.neighbours.made_at = state.clock.steps;
        state.clock.rebuilds += 1;
    }

    /// The list of one plane and law.
    fn near_plane(&self, state: &State, index: usize, new_slot: &[u32]) -> crate::state::WallContacts {
        let old = &state.walls[index];
        let (boundary, material, point, normal) =
            self.planes.iter().copied().find(|plane| plane.0 == old.boundary).expect("a wall list belongs to a plane");
        let offset = state.boundaries[boundary as usize].displacement;
        let particles = &state.particles;
        walls::list(old, new_slot, particles, |slot| {
            let row = particles.position[slot];
            let distance: f64 = (0..3).map(|axis| (row[axis] - point[axis] - offset[axis]) * normal[axis]).sum();
            distance <= row[3] + state.neighbours.skin
                && self.law(particles.material[slot], material) == Some(old.law)
                && particles.owner[slot] != boundary + 1
        })
    }

    /// The half lists of all laws.
    fn pairs(&self, particles: &Particles, grid: &Grid, order: &Order, skin: f64, laws: usize) -> Vec<ContactList> {
        let mut lists = vec![ContactList::default(); laws];
        let mut near = Vec::new();
        for slab in 0..grid.counts[0] {
            for list in &mut lists {
                list.slabs.push(list.first.len() as u32);
            }
            let (from, to) = (order.slabs[slab] as usize, order.slabs[slab + 1] as usize);
            for i in from..to {
                near.clear();
                grid.ahead(order, order.cells[i], |from, to| {
                    collect(particles, i, from.max(i + 1), to, skin, &mut near);
                });
                near.sort_unstable();
                for &j in &near {
                    if particles.owner[i] != 0 && particles.owner[i] == particles.owner[j as usize] {
                        continue;
                    }
                    if let Some(law) = self.law(particles.material[i], particles.material[j as usize]) {
                        lists[law as usize].first.push(i as u32);
                        lists[law as usize].second.push(j);
                    }
                }
            }
        }
        for list in &mut lists {
            list.slabs.push(list.first.len() as u32);
            list.flags = vec![0; list.first.len()];
            list.spring = vec![[0.0; 4]; list.first.len()];
        }
        lists
    }
}

/// Hands out every two particles (slots) that are not further apart than `reach` \[m\], with their distance.
pub(super) fn near_pairs(particles: &Particles, reach: f64, mut hand: impl FnMut(u32, u32, f64)) {
    if particles.is_empty() || reach <= 0.0 {
        return;
    }
    let grid = Grid::around(particles, reach);
    let order = grid.order(particles);
    for (place, &slot) in order.slots.iter().enumerate() {
        grid.ahead(&order, order.cells[place], |from, to| {
            for &other in &order.slots[from.max(place + 1).min(to)..to] {
                let (a, b) = (particles.position[slot as usize], particles.position[other as usize]);
                let distance = way(&[a[0], a[1], a[2]], &[b[0], b[1], b[2]]);
                if distance <= reach {
                    hand(slot, other, distance);
                }
            }
        });
    }
}

/// Distance of two points \[m\].
fn way(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Appends the particles of a range that are nearer to `i` than touch plus skin.
#[inline(always)]
fn collect(particles: &Particles, i: usize, from: usize, to: usize, skin: f64, near: &mut Vec<u32>) {
    if from >= to {
        return;
    }
    let [x, y, z, radius] = particles.position[i];
    for (j, row) in particles.position[from..to].iter().enumerate() {
        let (dx, dy, dz) = (row[0] - x, row[1] - y, row[2] - z);
        let reach = row[3] + radius + skin;
        if dx * dx + dy * dy + dz * dz < reach * reach {
            near.push((from + j) as u32);
        }
    }
}

/// Cells of equal size around all particles.
struct Grid {
    /// Axes in the order of sorting: across slabs, then the two inside a slab.
    axes: [usize; 3],
    /// Lower corner, in that order \[m\].
    origin: [f64; 3],
    /// Size of a cell, in that order \[m\].
    size: [f64; 3],
    /// Number of cells, in that order.
    counts: [usize; 3],
}

/// Where the particles belong.
struct Order {
    /// Old slot of each new one.
    slots: Vec<u32>,
    /// Cell of each new slot.
    cells: Vec<u32>,
    /// First new slot of each cell, and the number of particles behind the last.
    starts: Vec<u32>,
    /// First new slot of each slab, and the number of particles behind the last.
    slabs: Vec<u32>,
}

impl Grid {
    /// Cells no smaller than `reach` around all particles.
    fn around(particles: &Particles, reach: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for row in &particles.position {
            for axis in 0..3 {
                low[axis] = low[axis].min(row[axis]);
                high[axis] = high[axis].max(row[axis]);
            }
        }
        let extent = [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]).then(a.cmp(&b)));
        // A hair above the reach: a quotient rounded up must not bring a pair two cells apart.
        let least = reach * (1.0 + 1e-9);
        let most = ((particles.len() * CELLS_PER_PARTICLE) as f64).max(1.0);
        let wanted = axes.map(|axis| (extent[axis] / least).floor().max(1.0));
        let thin = libm::cbrt((wanted[0] * wanted[1] * wanted[2] / most).max(1.0));
        let counts = wanted.map(|count| (count / thin).floor().max(1.0).min(most) as usize);
        let mut size = [0.0; 3];
        for (k, &axis) in axes.iter().enumerate() {
            size[k] = (extent[axis] / counts[k] as f64).max(least);
        }
        Self { axes, origin: axes.map(|axis| low[axis]), size, counts }
    }

    /// The cell of a position.
    fn cell(&self, row: &Row) -> u32 {
        let mut cell = 0;
        for k in 0..3 {
            let place = ((row[self.axes[k]] - self.origin[k]) / self.size[k]) as usize;
            cell = cell * self.counts[k] + place.min(self.counts[k] - 1);
        }
        cell as u32
    }

    /// Sorts the particles into cells, keeping their order inside a cell.
    fn order(&self, particles: &Particles) -> Order {
        let cells: Vec<u32> = particles.position.iter().map(|row| self.cell(row)).collect();
        let count = self.counts.iter().product::<usize>();
        let mut starts = vec![0_u32; count + 1];
        for &cell in &cells {
            starts[cell as usize + 1] += 1;
        }
        for cell in 0..count {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        let mut slots = vec![0_u32; cells.len()];
        let mut sorted = vec![0_u32; cells.len()];
        for (slot, &cell) in cells.iter().enumerate() {
            let place = next[cell as usize] as usize;
            next[cell as usize] += 1;
            slots[place] = slot as u32;
            sorted[place] = cell;
        }
        let column = self.counts[1] * self.counts[2];
        let slabs = (0..=self.counts[0]).map(|slab| starts[slab * column]).collect();
        Order { slots, cells: sorted, starts, slabs }
    }

    /// Hands out the ranges of slots in the cells at and ahead of this one.
    fn ahead(&self, order: &Order, cell: u32, mut hand: impl FnMut(usize, usize)) {
        let cell = cell as usize;
        let (row, third) = (cell / self.counts[2], cell % self.counts[2]);
        let (slab, second) = (row / self.counts[1], row % self.counts[1]);
        let upper = (third + 1).min(self.counts[2] - 1);
        let lower = third.saturating_sub(1);
        let mut range = |row: usize, from: usize| {
            let base = row * self.counts[2];
            hand(order.starts[base + from] as usize, order.starts[base + upper + 1] as usize);
        };
        range(row, third);
        if second + 1 < self.counts[1] {
            range(row + 1, lower);
        }
        if slab + 1 < self.counts[0] {
            let next = row + self.counts[1];
            if second > 0 {
                range(next - 1, lower);
            }
            range(next, lower);
            if second + 1 < self.counts[1] {
                range(next + 1, lower);
            }
        }
    }
}

/// Puts the particles into a new order. Returns the new slot of each old one.
fn sort(particles: &mut Particles, slots: &[u32]) -> Vec<u32> {
    let mut new_slot = vec![0; slots.len()];
    for (new, &old) in slots.iter().enumerate() {
        new_slot[old as usize] = new as u32;
    }
    for rows in [
        &mut particles.position,
        &mut particles.velocity,
        &mut particles.angular_velocity,
        &mut particles.force,
        &mut particles.torque,
        &mut particles.attitude,
    ] {
        if rows.is_empty() {
            continue;
        }
        *rows = slots.iter().map(|&old| rows[old as usize]).collect();
    }
    for numbers in [&mut particles.material, &mut particles.owner, &mut particles.id] {
        *numbers = slots.iter().map(|&old| numbers[old as usize]).collect();
    }
    for (slot, &id) in particles.id.iter().enumerate() {
        particles.slot[id as usize] = slot as u32;
    }
    new_slot
}

/// Brings the springs of touching pairs from the old list into the new one.
fn carry(old: &ContactList, new: &mut ContactList, new_slot: &[u32], slabs: &[u32]) {
    let mut starts = vec![0_u32; *slabs.last().unwrap_or(&0) as usize + 1];
    for &i in &new.first {
        starts[i as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    for pair in 0..old.first.len() {
        if old.flags[pair] & TOUCHING == 0 {
            continue;
        }
        let (a, b) = (new_slot[old.first[pair] as usize], new_slot[old.second[pair] as usize]);
        let (i, j, sign) = if a < b { (a, b, 1.0) } else { (b, a, -1.0) };
        let (from, to) = (starts[i as usize] as usize, starts[i as usize + 1] as usize);
        if let Ok(place) = new.second[from..to].binary_search(&j) {
            new.flags[from + place] = old.flags[pair];
            if let Some(spring) = old.spring.get(pair) {
                new.spring[from + place] = spring.map(|part| sign * part);
            }
        }
    }
}
