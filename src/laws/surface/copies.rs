//! A surface in a periodic cell: it and its copies are one.

use super::feet::{Features, Feet, Foot};
use super::{Facets, Shape, Surface};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;

/// Where the copies of a surface stand.
#[derive(Clone, Debug)]
pub struct Copies {
    /// By how many edges of the cell each is displaced; the first is the surface itself.
    pub counts: Vec<[i64; 3]>,
    /// How far that is \[m\].
    pub shifts: Vec<Vector>,
}

impl Copies {
    /// The copy that stands by so many edges beside another.
    pub(super) fn beside(&self, copy: usize, by: [i64; 3]) -> Option<usize> {
        let wanted = [0, 1, 2].map(|edge| self.counts[copy][edge].saturating_add(by[edge]));
        self.counts.iter().position(|counts| *counts == wanted)
    }
}

/// What a surface and its copies are.
pub enum Repeated {
    /// They are the surface itself, which goes on along the displacements.
    Endless,
    /// Surfaces that stand apart.
    Apart,
    /// One surface, made of all.
    Joined(Shape),
}

/// A surface with its copies: what it is like is that of the surface, where it is touched that of all.
#[derive(Debug)]
pub(super) struct WithCopies {
    /// The surface.
    one: Shape,
    /// All.
    all: Shape,
    /// Where they stand \[m\].
    shifts: Vec<Vector>,
}

impl Shape {
    /// The surface with its copies; otherwise what is wrong with them, found and expected.
    pub(crate) fn with_copies(&self, copies: Copies) -> Result<Self, [String; 2]> {
        let shifts = copies.shifts.clone();
        let all = match self.repeated(&copies)? {
            Repeated::Endless => return Ok(self.clone()),
            Repeated::Apart => Self::of(Apart { one: self.clone(), copies }),
            Repeated::Joined(all) => all,
        };
        Ok(Self::of(WithCopies { one: self.clone(), all, shifts }))
    }
}

impl Surface for WithCopies {
    fn key(&self) -> &'static str {
        self.one.key()
    }

    fn words(&self) -> String {
        self.one.words()
    }

    fn material(&self) -> Option<MaterialIndex> {
        self.one.material()
    }

    fn features(&self) -> Option<&dyn Features> {
        self.all.features()
    }

    fn vertices(&self) -> &[Vector] {
        self.one.vertices()
    }

    fn triangles(&self) -> &[[u32; 3]] {
        self.one.triangles()
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        self.all.distance(centre)
    }

    fn reference(&self) -> Option<[f64; 3]> {
        self.one.reference()
    }

    fn turns(&self) -> bool {
        self.one.turns()
    }

    fn facets(&self, beside: &[Vector]) -> Option<Facets> {
        self.one.facets(beside)
    }

    fn crack(&self, within: f64) -> Option<String> {
        self.all.crack(within)
    }

    fn facet_at(&self, point: Vector) -> usize {
        let apart = |place: &Vector| self.one.distance(*place).map_or(f64::INFINITY, f64::abs);
        let places = self.shifts.iter().map(|shift| point - *shift);
        self.one.facet_at(places.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(point))
    }

    fn repeated(&self, copies: &Copies) -> Result<Repeated, [String; 2]> {
        self.one.repeated(copies)
    }
}

/// A surface and its copies that stand apart. Parts and features are those of the surface, copy by copy.
#[derive(Debug)]
struct Apart {
    /// The surface.
    one: Shape,
    /// Where it stands.
    copies: Copies,
}

impl Apart {
    /// The features of the surface.
    fn one(&self) -> &dyn Features {
        self.one.features().expect("a group or a plane has no copies")
    }
}

impl Surface for Apart {
    fn key(&self) -> &'static str {
        self.one.key()
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        let distances = self.copies.shifts.iter().filter_map(|shift| self.one.distance(centre - *shift));
        distances.min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }
}

impl Features for Apart {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        let count = self.one().counts()[0] as u32;
        for (copy, shift) in (0..).zip(&self.copies.shifts) {
            let before = parts.len();
            self.one().near(centre - *shift, reach, parts);
            parts[before..].iter_mut().for_each(|part| *part += copy * count);
        }
    }

    fn counts(&self) -> [usize; 2] {
        self.one().counts().map(|count| count * self.copies.counts.len())
    }

    fn feet(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet) {
        let [count, features] = self.one().counts().map(|count| count as u32);
        let mut room = feet.of_one.take().unwrap_or_default();
        let (own, found) = &mut *room;
        for parts in parts.chunk_by(|a, b| a / count == b / count) {
            let copy = parts[0] / count;
            own.clear();
            own.extend(parts.iter().map(|part| part % count));
            found.clear();
            self.one().feet(centre - self.copies.shifts[copy as usize], radius, own, found);
            let first = copy * features;
            feet.list.extend(found.list.iter().map(|foot| Foot { feature: first + foot.feature, ..*foot }));
            for saddle in &found.saddles {
                let [one, other] = saddle.faces;
                feet.saddles.push(super::Saddle {
                    feature: first + saddle.feature,
                    faces: [first + one, first + other],
                    ..*saddle
                });
            }
            feet.behind |= found.behind;
        }
        feet.of_one = Some(room);
    }

    fn meet(&self, one: u32, other: u32) -> bool {
        let count = self.one().counts()[1] as u32;
        one / count == other / count && self.one().meet(one % count, other % count)
    }

    fn extent(&self, point: Vector) -> f64 {
        let shifts = self.copies.shifts.iter();
        shifts.map(|shift| self.one().extent(point - *shift)).fold(0.0, f64::max)
    }

    fn beside(&self, feature: u32, by: [i64; 3]) -> Option<u32> {
        let count = self.one().counts()[1] as u32;
        let copy = self.copies.beside((feature / count) as usize, by)?;
        Some(copy as u32 * count + feature % count)
    }
}
