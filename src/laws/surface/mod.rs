//! The shapes of boundaries: surfaces that particles can touch, and groups of particles that move as a rigid
//! body.
//!
//! A shape is one file and one row of [`STANDARD`]. Its file holds what a scene writes under its key and the check of
//! that, where the surface is, how a sphere touches it, and its words in reports. The shape does not know how the surface
//! moves ([`crate::laws::motion`]).

pub(crate) mod cone;
mod copies;
pub mod cylinder;
pub(crate) mod disc;
mod facets;
mod feet;
pub(crate) mod group;
pub mod mesh;
pub(crate) mod plane;
mod profile;
pub(crate) mod rectangle;
pub(crate) mod revolution;

pub use copies::{Copies, Repeated};
pub use facets::Facets;
pub use feet::{DEEP, Features, Feet, Foot, NO_PLANE, OnPlanes, SLOW, Saddle, TOGETHER, is_skipped};
pub use group::{Group, Selection};
pub use mesh::{Deforming, NodeWeights};
pub use plane::Plane;

use crate::base::document::{Document, Faults, Mistake};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use serde::de::DeserializeOwned;
use std::fmt::{self, Debug};
use std::ops::Deref;
use std::sync::Arc;

/// The shapes of the program.
pub(crate) const STANDARD: &[&ShapeRow] = &[
    ShapeRow::of::<plane::Keys>(),
    ShapeRow::of::<Selection>(),
    ShapeRow::of::<disc::Keys>(),
    ShapeRow::of::<rectangle::Keys>(),
    ShapeRow::of::<cylinder::Keys>(),
    ShapeRow::of::<cone::Keys>(),
    ShapeRow::of::<revolution::Keys>(),
    ShapeRow::of::<mesh::Keys>(),
];

/// The shape of a boundary.
#[derive(Clone, Debug)]
pub struct Shape(Arc<dyn Surface>);

impl Shape {
    /// The shape that this surface has.
    pub fn of(surface: impl Surface + 'static) -> Self {
        Self(Arc::new(surface))
    }
}

impl Deref for Shape {
    type Target = dyn Surface;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

/// What every shape provides.
pub trait Surface: Debug + Send + Sync {
    /// Its key in a scene.
    fn key(&self) -> &'static str;

    /// What it is, for a report.
    fn words(&self) -> String {
        self.key().to_owned()
    }

    /// What it is made of, where particles touch the surface itself.
    fn material(&self) -> Option<MaterialIndex> {
        None
    }

    /// The particles that it consists of: indices into the scene's particles, ascending. They touch others as all
    /// particles do.
    fn members(&self) -> &[u32] {
        &[]
    }

    /// The plane that it is, if it is one.
    fn plane(&self) -> Option<Plane> {
        None
    }

    /// Where a sphere touches it, if it is a surface of features: any surface except a plane.
    fn features(&self) -> Option<&dyn Features> {
        None
    }

    /// The same as a surface whose vertices move one by one, if it is made of such.
    fn deforming(&self) -> Option<Deforming> {
        None
    }

    /// Its vertices at time 0, if it is made of such \[m\].
    fn vertices(&self) -> &[Vector] {
        &[]
    }

    /// The vertices of each of its triangles, if it is made of such.
    fn triangles(&self) -> &[[u32; 3]] {
        &[]
    }

    /// How far in front of the surface, at time 0, a centre is, negative behind it \[m\]; nothing for a group, which has no
    /// surface.
    fn distance(&self, _centre: Vector) -> Option<f64> {
        None
    }

    /// The point about which its moment is taken if the scene names none \[m\]; nothing if this is the mass centre of its
    /// particles.
    fn reference(&self) -> Option<[f64; 3]> {
        None
    }

    /// Whether it can turn.
    fn turns(&self) -> bool {
        false
    }

    /// What it looks like at time 0; nothing for a group, which looks like its particles. A surface without end is shown as far
    /// as these points are beside it \[m\].
    fn facets(&self, _beside: &[Vector]) -> Option<Facets> {
        None
    }

    /// Two edges of it that are nearer than this \[m\] and were probably meant as one, in words.
    fn crack(&self, _within: f64) -> Option<String> {
        None
    }

    /// The facet that is nearest to a point \[m\].
    fn facet_at(&self, _point: Vector) -> usize {
        0
    }

    /// Gives the shares of what happens at a foot on a feature to the facets there: they add up to 1. A feature that lies on several facets
    /// has a share of each.
    fn share_out(&self, _feature: u32, foot: Vector, give: &mut dyn FnMut(usize, f64)) {
        give(self.facet_at(foot), 1.0);
    }

    /// What it and its copies in a periodic cell are, none of which is wider than the cell; otherwise what is wrong with them, found
    /// and expected.
    fn repeated(&self, _copies: &Copies) -> Result<Repeated, [String; 2]> {
        Ok(Repeated::Apart)
    }
}

/// What a scene writes of a shape, under its key in `[boundary.<name>]`.
pub trait ShapeKeys: DeserializeOwned + 'static {
    /// The key of the shape.
    const KEY: &'static str;

    /// How it is written, for a message.
    const HINT: &'static str;

    /// Keys below it that name files.
    const FILES: &'static [&'static str] = &[];

    /// The shape that is meant, if nothing is wrong with it; what is wrong is reported.
    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape>;
}

/// Makes a shape of the keys that a scene has written.
pub(crate) type MakeShape = Box<dyn Fn(&mut dyn ShapeContext) -> Option<Shape>>;

/// What the program knows of a shape before a scene names it.
pub struct ShapeRow {
    /// [`ShapeKeys::KEY`]
    pub(crate) key: &'static str,
    /// [`ShapeKeys::HINT`]
    pub(crate) hint: &'static str,
    /// [`ShapeKeys::FILES`]
    pub(crate) files: &'static [&'static str],
    /// Reads what stands under its key in a table.
    pub(crate) read: fn(&Document, &str, &mut Faults) -> Option<MakeShape>,
}

impl ShapeRow {
    /// The row of a shape.
    pub const fn of<K: ShapeKeys>() -> &'static Self {
        const {
            &Self {
                key: K::KEY,
                hint: K::HINT,
                files: K::FILES,
                read: |document, table, faults| {
                    let keys: K = document.read_key(table, K::KEY, faults)?;
                    Some(Box::new(move |around| keys.shape(around)))
                },
            }
        }
    }
}

impl Debug for ShapeRow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.key)
    }
}

/// Files that a table of a scene names, and where its mistakes go.
pub trait Files {
    /// The content of a file that the table names; nothing if it could not be read, which has been reported.
    fn file(&self, name: &str) -> Option<&[u8]>;

    /// Reports a mistake at a key below the table.
    fn report(&mut self, key: &str, mistake: Mistake);

    /// Reports a value: what was found at a key below the table and what was expected.
    fn refuse(&mut self, key: &str, found: String, expected: &str) {
        self.report(key, Mistake::Unexpected { found, expected: expected.to_owned() });
    }

    /// Reports the content of a file: what was found in it and what was expected.
    fn refuse_file(&mut self, key: &str, file: &str, found: &str, expected: &str) {
        self.report(key, Mistake::Refused { message: format!("{file}: expected {expected}, found {found}") });
    }
}

/// What stands around the key of a shape in a scene.
pub trait ShapeContext: Files {
    /// The material that the boundary names. Reports an unknown or missing one: `who` needs one.
    fn material(&mut self, who: &str) -> Option<MaterialIndex>;

    /// Reports a material that the boundary names although, as `why` says, it has none of its own.
    fn no_material(&mut self, why: &str);

    /// The particles that a selection chooses; reports a selection of none.
    fn select(&mut self, selection: &Selection) -> Vec<u32>;
}

/// A direction as a unit vector, from one of any length except 0: scaled first, so that neither very long nor very short
/// ones overflow.
pub fn direction(vector: [f64; 3]) -> Option<[f64; 3]> {
    let largest = vector.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    if largest == 0.0 {
        return None;
    }
    let scaled = vector.map(|part| part / largest);
    let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
    Some(scaled.map(|part| part / length))
}
