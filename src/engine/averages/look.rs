//! Parts of space that are looked at, as particles see them: a region, or the cells of a grid.

use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::cell::near::Place;
use crate::engine::state::{IMAGE, State};
use crate::laws::region::{self, Grid};
use crate::scene::{ClumpShape, Region, Scene};

/// Parts of space, each with a number from 0.
pub(crate) struct Look<'a> {
    /// Which they are.
    parts: Parts<'a>,
    /// How far they moved since time 0 \[m\].
    shift: Vector,
    /// Where particles meet them.
    place: Place,
}

/// What is looked at.
enum Parts<'a> {
    /// The one part that is a region.
    Region(&'a region::Region),
    /// The cells of a grid.
    Grid(&'a Grid),
}

/// The part of a particle that is in a part of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inside {
    /// Where the particle stands in memory.
    pub(crate) slot: u32,
    /// The part of space: the cell of a grid.
    pub(crate) part: u32,
    /// Volume of the part of the sphere \[m³\].
    pub(crate) volume: f64,
}

impl<'a> Look<'a> {
    /// At a region of the scene.
    pub(crate) fn at_region(region: &'a Region, scene: &Scene, state: &State) -> Self {
        let moved = region.follows.map(|boundary| state.boundaries[boundary.index()].displacement);
        let shift = moved.map_or(Vector::zero(), Vector::from);
        let corners = region.shape.bounds().map(|corner| (Vector::from(corner) + shift).to_array());
        Self { parts: Parts::Region(&region.shape), shift, place: Place::of(scene, state, corners) }
    }

    /// At the cells of a grid.
    pub(crate) fn at_grid(grid: &'a Grid, scene: &Scene, state: &State) -> Self {
        Self { parts: Parts::Grid(grid), shift: Vector::zero(), place: Place::of(scene, state, grid.corners) }
    }

    /// How many parts there are.
    pub(crate) fn count(&self) -> usize {
        match self.parts {
            Parts::Region(_) => 1,
            Parts::Grid(grid) => grid.cells(),
        }
    }

    /// Hands out the parts that have some of a sphere, or of an image of it, with the volume of that \[m³\].
    pub(crate) fn parts_of_sphere(&self, centre: Vector, radius: f64, mut hand: impl FnMut(usize, f64)) {
        self.place.meets(centre, radius, |centre| match self.parts {
            Parts::Region(region) => {
                let volume = region.volume_of_sphere(centre - self.shift, radius);
                if volume > 0.0 {
                    hand(0, volume);
                }
            }
            Parts::Grid(grid) => grid.parts_of_sphere(centre - self.shift, radius, &mut hand),
        });
    }

    /// Hands out the parts that have some of a line, or of an image of it, with that over its length. The line goes a way \[m\] and
    /// ends here.
    pub(crate) fn parts_of_line(&self, to: Vector, way: Vector, mut hand: impl FnMut(usize, f64)) {
        self.place.meets(to, way.length(), |to| {
            let (from, to) = (to - way - self.shift, to - self.shift);
            match self.parts {
                Parts::Region(region) => {
                    let share = region.share_of_line(from, to);
                    if share > 0.0 {
                        hand(0, share);
                    }
                }
                Parts::Grid(grid) => grid.parts_of_line(from, to, &mut hand),
            }
        });
    }

    /// Hands out the parts that a point, or an image of it, is in.
    pub(crate) fn parts_at(&self, point: Vector, mut hand: impl FnMut(usize)) {
        self.place.meets(point, 0.0, |point| {
            let point = point - self.shift;
            let part = match self.parts {
                Parts::Region(region) => region.holds(point).then_some(0),
                Parts::Grid(grid) => grid.cell_of(point),
            };
            if let Some(part) = part {
                hand(part);
            }
        });
    }
}

/// How much of the volume of its spheres is that of a clump, for each shape of the scene.
pub(crate) struct Fullness(Vec<f64>);

impl Fullness {
    /// That of the clumps of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        Self(scene.clump_shapes.iter().map(ClumpShape::fullness).collect())
    }

    /// The share of the particle in a slot: 1 but of the sphere of a clump.
    pub(crate) fn share(&self, state: &State, slot: usize) -> f64 {
        state.clump(slot).map_or(1.0, |clump| self.0[state.clumps.shape[clump] as usize])
    }

    /// Volume of what of a particle is inside \[m³\]: of the sphere of a clump its share of the union.
    pub(crate) fn volume(&self, state: &State, part: &Inside) -> f64 {
        part.volume * self.share(state, part.slot as usize)
    }
}

/// What there is of all particles, in the order of memory, in each part that is looked at.
pub(crate) fn inside(look: &Look, state: &State, context: &Context) -> Vec<Inside> {
    let particles = &state.particles;
    let piece = |number: usize| {
        let mut found = Vec::new();
        let slots = number * CHUNK..particles.position.len().min((number + 1) * CHUNK);
        for slot in slots.filter(|&slot| particles.owner[slot] != IMAGE) {
            let [x, y, z, radius] = particles.position[slot];
            let hand = |part: usize, volume| found.push(Inside { slot: slot as u32, part: part as u32, volume });
            look.parts_of_sphere(Vector::new(x, y, z), radius, hand);
        }
        found
    };
    context.collect(particles.position.len().div_ceil(CHUNK), piece).into_iter().flatten().collect()
}
