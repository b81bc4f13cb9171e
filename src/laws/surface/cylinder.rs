//! `cylinder`: a pipe, open or capped, or without end.

use super::profile::Revolution;
use super::{Shape, ShapeContext, ShapeKeys};
use crate::base::document::keys;
use crate::base::number::Vector;
use crate::base::quantity::{MaterialIndex, Positive, Triple};
use serde::Deserialize;

/// How far a cylinder without end reaches: beyond the numbers of any scene, and its square is still a number \[m\].
pub(super) const FAR: f64 = 1e30;

/// Which ends of a cylinder or a cone are closed by a disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Caps {
    /// Neither.
    #[default]
    None,
    /// The one where it begins.
    From,
    /// The one where it ends.
    To,
    /// Both.
    Both,
}

impl Caps {
    /// The profile between two ends, `[radius, height]` of each, with the discs that close them.
    pub(super) fn close(self, [from, to]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        let mut profile = vec![from, to];
        if matches!(self, Self::From | Self::Both) {
            profile.insert(0, [0.0, from[1]]);
        }
        if matches!(self, Self::To | Self::Both) {
            profile.push([0.0, to[1]]);
        }
        profile
    }
}

/// The point where an axis begins, its direction and its length \[m\]; reports two ends in one point.
pub(super) fn axis(
    from: Triple,
    to: Triple,
    key: &str,
    around: &mut dyn ShapeContext,
) -> Option<(Vector, Vector, f64)> {
    let (from, way) = (Vector::from(from.0), Vector::from(to.0) - Vector::from(from.0));
    let direction = super::direction(way.to_array());
    if direction.is_none() {
        around.refuse(&format!("{key}.to"), "the point of from".to_owned(), "another point on the axis");
    }
    direction.map(|direction| (from, direction.into(), way.length()))
}

/// A cylinder without ends about an axis through a point \[m\].
pub fn infinite(material: MaterialIndex, point: [f64; 3], axis: [f64; 3], radius: f64) -> Option<Shape> {
    let about = (point.into(), super::direction(axis)?.into());
    Some(Shape::of(Revolution::of("cylinder", material, about, &[[radius, -FAR], [radius, FAR]])))
}

keys! {
    /// `cylinder = { from, to, radius }`
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Keys {
        /// Where its axis begins \[m\].
        from: Triple = "required",
        /// Where its axis ends \[m\].
        to: Triple = "required",
        /// Its radius \[m\].
        radius: Positive = "required",
        /// Which ends are closed: `"from"`, `"to"`, `"both"`.
        #[serde(default)]
        caps: Caps = "`\"none\"`",
        /// Whether it goes on beyond both ends.
        #[serde(default)]
        infinite: bool = "`false`",
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "cylinder";
    const HINT: &'static str = "cylinder = { from, to, radius }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let (material, axis) = (around.material("a cylinder"), axis(self.from, self.to, "cylinder", around));
        if self.infinite && self.caps != Caps::None {
            let found = "caps on a cylinder without ends".to_owned();
            around.refuse("cylinder.caps", found, "infinite = false, or no caps");
            return None;
        }
        let (material, (from, along, length), radius) = (material?, axis?, self.radius.get());
        let heights = if self.infinite { [-FAR, FAR] } else { [0.0, length] };
        let profile = self.caps.close(heights.map(|height| [radius, height]));
        Some(Shape::of(Revolution::of("cylinder", material, (from, along), &profile)))
    }
}
