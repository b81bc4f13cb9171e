//! Which particles are near each other, and the order in which they are stored.
//!
//! Particles are sorted into slabs across the longest extent of the packing, each at least as thick as the largest
//! reach of a pair, and inside a slab by size and cell. Pairs therefore reach no further than the next slab. The history of a
//! contact follows the pair of particles, never a place in a list. Pieces of work follow from geometry or have a fixed length,
//! so lists and their order do not depend on the number of threads.

pub(crate) mod bonds;
mod grid;
mod lists;
mod order;
mod pair_cache;
pub(crate) mod pair_estimate;
mod pairs;
mod planes;
mod sizes;
mod skin;
mod surfaces;

use crate::base::geometry::{Frame, Quaternion, rotation};
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::cell::images::{self, Images};
use crate::engine::state::{Nodes, Particles, State, StateFault, demand};
use crate::laws::contact::{HistoryRow, Law};
use crate::laws::surface::{self, Deforming};
use crate::scene::{Boundary, Scene, Shape};
use grid::Grid;
use lists::ListBuilder;
use order::Order;
pub(crate) use pair_cache::PairCache;
use pairs::{FoundPairs, Laws, PairSearch};
use planes::Plane;
use sizes::Sizes;
pub(crate) use skin::FIRST as FIRST_SKIN;

/// The search: what it knows of the scene, and its working space.
pub(crate) struct Search {
    /// Which pairs have a law.
    laws: Laws,
    /// Rows that are stored for each contact of a law.
    histories: Vec<Vec<HistoryRow>>,
    /// Planes of the scene.
    planes: Vec<Plane>,
    /// Its boundaries: shape, point of reference, and whether they turn.
    boundaries: Vec<(Shape, Vector, bool)>,
    /// Levels of radii.
    sizes: Sizes,
    /// Radius of the smallest particle \[m\].
    smallest: f64,
    /// How far beyond touch a contact law holds bodies together \[m\].
    reach: f64,
    /// Radius of the largest particle \[m\].
    largest: f64,
    /// Skin that the scene asks for \[m\].
    skin: Option<f64>,
    /// Mean radius of the particles \[m\].
    mean: f64,
    /// Whether particles come.
    inserts: bool,
    /// Whether anything can touch.
    touching: bool,
    /// Whether particles can touch each other.
    pairs: bool,
    /// Whether there are lists at all.
    needed: bool,
    /// Order of the particles.
    order: Order,
    /// Pairs of each slab.
    found: Vec<FoundPairs>,
    /// Making of lists.
    making: ListBuilder,
    /// A number for each particle.
    mark: Vec<u32>,
    /// Makes images, where the scene has a periodic cell.
    images: Option<Images>,
}

impl Search {
    /// Reads what concerns the search from the scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let laws = laws(scene);
        let here = scene.present();
        let meet = |a: usize, b: usize| here[a] && here[b] && laws.between(a as u32, b as u32).is_some();
        let count = scene.materials.len();
        let planes = scene.boundaries.iter().enumerate().filter_map(|(index, boundary)| {
            let surface::Plane { material, point, normal } = boundary.shifting_plane()?;
            Some(Plane { boundary: index as u32, material: material.0, point, normal })
        });
        Self {
            histories: (0..scene.contacts.len()).map(|law| scene.kept_rows(law)).collect(),
            planes: planes.collect(),
            boundaries: scene.boundaries.iter().map(boundary).collect(),
            sizes: Sizes::of(scene.radii()),
            smallest: scene.radii().fold(f64::INFINITY, f64::min),
            reach: 0.0,
            largest: scene.radii().fold(0.0, f64::max),
            skin: scene.run.skin,
            mean: scene.mean_radius(),
            inserts: !scene.insertions.is_empty(),
            touching: !scene.contacts.is_empty() && scene.has_particles(),
            pairs: (0..count).any(|a| (0..count).any(|b| meet(a, b))),
            needed: scene.has_particles() && (!scene.contacts.is_empty() || !scene.bonds.is_empty()),
            laws,
            order: Order::default(),
            found: Vec::new(),
            making: ListBuilder::default(),
            mark: Vec::new(),
            images: Images::of(scene),
        }
    }

    /// Takes over the coefficients of contact laws of a state: they determine how far beyond touch bodies hold
    /// together.
    pub(crate) fn take_coefficients(&mut self, scene: &Scene, state: &State) {
        let reaches = scene.contacts.iter().zip(&state.coefficients).map(|(choice, rows)| {
            let law = Law::of(&choice.choice);
            let governed = rows.chunks_exact(law.places().count.max(1)).zip(&choice.between);
            let reaches = governed.filter(|(_, governed)| **governed).map(|(row, _)| law.reach(row, self.largest));
            if law.holds_beyond_touch() { reaches.fold(0.0, f64::max) } else { 0.0 }
        });
        self.reach = reaches.fold(0.0, f64::max);
    }

    /// How far beyond touch a contact law holds bodies together \[m\].
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether lists, and images with them, are made anew where motion asks for it.
    pub(crate) fn keeps_lists(&self) -> bool {
        self.touching
    }

    /// Radius of the smallest particle \[m\].
    pub(crate) fn smallest_radius(&self) -> f64 {
        self.smallest
    }

    /// Whether every two bodies that may touch once they have come nearer to each other by `way` \[m\] are in a list of near
    /// bodies. Lists of surfaces other than planes report only what touches.
    pub(crate) fn holds_all_within(&self, state: &State, way: f64) -> bool {
        if !self.touching || self.inserts {
            return false; // there are no lists, or what comes is in none
        }
        let tells = |(shape, _, turns): &(Shape, Vector, bool)| {
            shape.material().is_none() || (shape.plane().is_some() && !turns)
        };
        let walls = (0..self.boundaries.len()).map(|boundary| self.way_of(state, boundary)).fold(0.0, f64::max);
        let used = state.neighbours.travel + walls.max(state.neighbours.travel);
        self.boundaries.iter().all(tells) && used + way < state.neighbours.skin
    }

    /// Whether a state from outside, whose other parts have been checked, has the lists that the search makes.
    pub(crate) fn check(&self, state: &State) -> Result<(), StateFault> {
        let lists = &state.neighbours;
        demand(!self.needed || !lists.slabs.is_empty(), "slabs", 0, "slabs of particles")?;
        if !self.touching {
            return Ok(());
        }
        let there = lists.reference.x.len();
        demand(
            there == state.particles.len() + order::BEYOND,
            "reference",
            there,
            "a place for each particle and room",
        )?;
        let there = lists.boundary_reference.len();
        demand(there == state.boundaries.len(), "boundary_reference", there, "one for each boundary")
    }

    /// Whether the lists no longer hold every pair that can touch. Chooses the skin of the next ones, if so.
    pub(crate) fn outdated(&self, state: &mut State, context: &Context) -> bool {
        if !self.touching {
            return false;
        }
        let walls = (0..self.boundaries.len()).map(|boundary| self.way_of(state, boundary));
        let wall = walls.fold(0.0, f64::max);
        let skin = state.neighbours.skin;
        let used = |travel: f64| travel + wall.max(travel);
        if used(state.neighbours.travel) <= skin {
            return false;
        }
        let travel = farthest(state, context);
        // A cell that is deformed carries what is near along: by how much it comes nearer was summed up.
        state.neighbours.travel = if state.cell.is_some() { travel.min(state.neighbours.travel) } else { travel };
        let used = used(state.neighbours.travel);
        if used <= skin {
            return false;
        }
        if self.skin.is_none() {
            state.neighbours.skin = skin::next(state, used, self.mean);
        }
        true
    }

    /// Sorts the particles and makes the lists anew.
    pub(crate) fn rebuild(&mut self, state: &mut State, context: &Context) {
        if !self.needed {
            return;
        }
        let skin = if self.touching { state.neighbours.skin + self.reach } else { 0.0 };
        if self.inserts {
            self.sizes.count(&state.particles);
        }
        if let Some(images) = &self.images {
            let shapes: Vec<&Shape> = self.boundaries.iter().map(|(shape, ..)| shape).collect();
            images.renew(state, &shapes, skin);
        }
        let grid = Grid::around(&state.particles, &self.sizes, skin, bonds::longest(state), context);
        self.order.find(&grid, &self.sizes, &state.particles, context);
        self.order.apply(&mut state.particles, context);
        images::follow(state, &self.order.new_slot);
        for list in &mut state.bonds {
            bonds::sort(list, &self.order.new_slot, &self.order.slabs);
        }
        if self.touching {
            order::fill(&mut state.neighbours.reference, &state.particles.position, context);
        }
        if self.pairs {
            self.list_pairs(state, &grid, skin, context);
        }
        for index in 0..state.walls.len() {
            self.list_near_surface(state, index, context);
        }
        state.neighbours.slabs.clone_from(&self.order.slabs);
        state.neighbours.boundary_reference.clear();
        state.neighbours.boundary_reference.extend(state.boundaries.iter().map(|boundary| boundary.displacement));
        state.neighbours.boundary_orientation.clear();
        state.neighbours.boundary_orientation.extend(state.boundaries.iter().map(|boundary| boundary.orientation.0));
        state.nodes.iter_mut().for_each(|nodes| nodes.listed.clone_from(&nodes.displacement));
        let extents = (0..self.boundaries.len()).map(|boundary| self.extent(state, boundary)).collect();
        state.neighbours.boundary_extent = extents;
        state.neighbours.travel = 0.0;
        state.neighbours.made_at = state.clock.steps;
        state.clock.rebuilds += 1;
    }

    /// Makes the lists of near particles.
    fn list_pairs(&mut self, state: &mut State, grid: &Grid, skin: f64, context: &Context) {
        let look = PairSearch {
            grid,
            order: &self.order,
            columns: &state.neighbours.reference,
            particles: &state.particles,
            laws: &self.laws,
            skin,
        };
        pairs::find(&look, &mut self.found, context);
        for (law, list) in state.contacts.iter_mut().enumerate() {
            let of = (law as u32, &self.laws);
            self.making.replace(list, &self.found, of, &self.histories[law], (&self.order, context));
        }
    }

    /// How far a surface has moved since the lists were made, where it meets particles \[m\].
    fn way_of(&self, state: &State, boundary: usize) -> f64 {
        let (shape, _, turns) = &self.boundaries[boundary];
        if shape.material().is_none() {
            return 0.0;
        }
        let (moved, then) = (&state.boundaries[boundary], &state.neighbours);
        let bent = state.nodes_of(boundary).map_or(0.0, Nodes::way_since_listed);
        let shift = way(&moved.displacement, &then.boundary_reference[boundary]) + bent;
        if !turns {
            return shift;
        }
        let [from, to] = [then.boundary_orientation[boundary], moved.orientation.0].map(Quaternion::from_row);
        shift + rotation::between(from, to).length() * then.boundary_extent[boundary]
    }

    /// How far from its point of reference a surface that turns meets particles \[m\].
    fn extent(&self, state: &State, boundary: usize) -> f64 {
        let (shape, reference, turns) = &self.boundaries[boundary];
        let Some(features) = shape.features().filter(|_| *turns) else { return 0.0 };
        let pivot = *reference + state.boundaries[boundary].shift().into();
        let particles = surfaces::farthest_from(&state.particles, pivot) + 2.0 * state.neighbours.skin;
        features.extent(*reference).min(particles)
    }

    /// Makes the list of one surface and law.
    fn list_near_surface(&mut self, state: &mut State, index: usize, context: &Context) {
        let list = &mut state.walls[index];
        let (shape, reference, _) = &self.boundaries[list.boundary as usize];
        let plane = self.planes.iter().find(|plane| plane.boundary == list.boundary);
        if let (None, Some(features), Some(material)) = (plane, shape.features(), shape.material()) {
            let (boundary, skin) = (list.boundary, state.neighbours.skin + self.reach);
            let moved = &state.boundaries[boundary as usize];
            let frame = Frame::of(*reference, moved.shift().into(), moved.orientation.0);
            let nodes = state.nodes.iter().find(|nodes| nodes.boundary == boundary);
            let deformed = nodes.and_then(|nodes| Some(sorted(shape.deforming()?, nodes)));
            let features = deformed.as_ref().map_or(features, Deforming::features);
            let near = surfaces::Near { boundary, material: material.0, features, frame, skin };
            return surfaces::replace(list, &near, (&state.particles, &self.laws), (&self.order, context));
        }
        let Some(plane) = plane else { return };
        let moved = state.boundaries[list.boundary as usize].displacement;
        let point = [0, 1, 2].map(|axis| plane.point[axis] + moved[axis]);
        let (columns, skin) = (&state.neighbours.reference, state.neighbours.skin + self.reach);
        let near = planes::Side { columns, point, normal: plane.normal, skin };
        let particles = (&state.particles, &self.laws);
        let history = self.histories[list.law as usize].len();
        planes::replace(list, plane, (near, history), particles, &mut self.mark, (&self.order, context));
    }
}

/// A mesh as its nodes stand, its triangles sorted. One without area is told when forces are evaluated.
pub(crate) fn sorted(mut mesh: Deforming, nodes: &Nodes) -> Deforming {
    let _ = mesh.follow(&nodes.displacement);
    mesh.sort();
    mesh
}

/// Shape of a boundary, its point of reference, and whether it turns.
fn boundary(boundary: &Boundary) -> (Shape, Vector, bool) {
    (boundary.shape.clone(), boundary.reference.into(), boundary.turns())
}

/// Which pairs of the scene have a law.
fn laws(scene: &Scene) -> Laws {
    let (materials, governing) = (scene.materials.len(), scene.governing_laws());
    let groups = scene.cell.is_some()
        || scene.has_clumps()
        || scene.boundaries.iter().any(|boundary| !boundary.shape.members().is_empty());
    let here = scene.present();
    let mut met = (0..here.len().pow(2))
        .filter(|entry| here[entry / materials] && here[entry % materials])
        .map(|entry| governing.rows()[entry]);
    let first = met.next().flatten();
    let only = first.filter(|_| !groups && met.all(|law| law == first));
    Laws { governing, only, count: scene.contacts.len(), groups: scene.boundaries.len() as u32 }
}

/// How far the particle that has moved most since the lists were made is from where it was \[m\].
fn farthest(state: &State, context: &Context) -> f64 {
    let (position, then) = (&state.particles.position, &state.neighbours.reference);
    let square = |piece: usize| {
        let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(position.len()));
        let moved = position[from..to].iter().zip(&then.x[from..]).zip(&then.y[from..]).zip(&then.z[from..]);
        moved.fold(0.0, |most: f64, (((now, x), y), z)| {
            let (x, y, z) = (now[0] - x, now[1] - y, now[2] - z);
            most.max(x * x + y * y + z * z)
        })
    };
    context.fold(position.len().div_ceil(CHUNK), square, 0.0, f64::max).sqrt()
}

/// Hands out every two particles (slots) that are not further apart than `reach` \[m\], with their distance.
pub(crate) fn near_pairs(particles: &Particles, reach: f64, mut hand: impl FnMut(u32, u32, f64)) {
    if particles.is_empty() || reach <= 0.0 {
        return;
    }
    let context = Context { step: 0.0, width: crate::base::lanes::Width::Least, threads: None, watch: None };
    let sizes = Sizes::single(0.5 * reach, particles.len());
    let grid = Grid::around(particles, &sizes, 0.0, 0.0, &context);
    let mut order = Order::default();
    order.find(&grid, &sizes, particles, &context);
    let level = &grid.levels[0];
    for (place, &slot) in order.slots.iter().enumerate() {
        let a = particles.position[slot as usize];
        let layer = grid.layer(level, a[grid.axes[0]]);
        let [row, cell] = [0, 1].map(|within| grid.place(level, within, a[grid.axes[within + 1]]));
        let (lower, upper) = (cell.saturating_sub(1), (cell + 2).min(level.counts[1]));
        let (bases, count) = grid.ahead(level, layer, row);
        let first = |cell: usize| order.starts[cell] as usize;
        let own = [place + 1, first(grid.row(level, layer, row) + upper)];
        let ahead = bases.into_iter().take(count).map(|base| [first(base + lower), first(base + upper)]);
        for [from, to] in std::iter::once(own).chain(ahead) {
            for &other in &order.slots[from..to.max(from)] {
                let b = particles.position[other as usize];
                let distance = way(&[a[0], a[1], a[2]], &[b[0], b[1], b[2]]);
                if distance <= reach {
                    hand(slot, other, distance);
                }
            }
        }
    }
}

/// Distance of two points \[m\].
fn way(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}
