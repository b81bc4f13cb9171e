//! `[region.<name>]` as a scene writes it.

use super::{Cuboid, Cylinder, Region, Solid};
use crate::base::document::{Mistake, keys};
use crate::base::quantity::{Corners, Positive, Triple};
use crate::laws::surface::{Files, mesh};
use serde::Deserialize;

keys! {
    /// `[region.<name>]`
    #[derive(Debug)]
    pub(crate) struct Keys {
        /// Lower and upper corner \[m\].
        r#box: Option<Corners> = "one of three",
        /// `{ from = [x, y, z], to = [x, y, z], radius = r }`: between two points \[m\].
        cylinder: Option<CylinderKeys> = "one of three",
        /// `{ file, joined, scale, rotation, offset }`: the inside of a closed surface of triangles, with keys as in a boundary.
        mesh: Option<mesh::Keys> = "one of three",
        /// Name of a boundary: the region has its displacement; it does not turn with it.
        pub(crate) follows: Option<String> = "it stays",
    }
}

/// `cylinder = { from, to, radius }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CylinderKeys {
    /// Centre of one end \[m\].
    from: Triple,
    /// Centre of the other \[m\].
    to: Triple,
    /// Radius \[m\].
    radius: Positive,
}

impl Keys {
    /// The keys of the shapes that are written.
    fn written(&self) -> Vec<&'static str> {
        let all = [("box", self.r#box.is_some()), ("cylinder", self.cylinder.is_some()), ("mesh", self.mesh.is_some())];
        all.into_iter().filter(|(_, written)| *written).map(|(key, _)| key).collect()
    }

    /// The region; what is wrong with it is reported.
    pub(crate) fn shape(&self, around: &mut dyn Files) -> Option<Region> {
        let [key] = self.written()[..] else {
            let mistake = match &self.written()[..] {
                [] => Mistake::Missing {
                    expected: "box = [[x, y, z], [x, y, z]], cylinder = { from, to, radius } or mesh = { file } gives its shape"
                        .to_owned(),
                },
                written => Mistake::Unexpected { found: written.join(" and "), expected: "one shape".to_owned() },
            };
            around.report("", mistake);
            return None;
        };
        let shape = if let Some(Corners(corners)) = self.r#box {
            Region::Box(Cuboid { corners })
        } else if let Some(CylinderKeys { from: Triple(from), to: Triple(to), radius }) = self.cylinder {
            let Some(cylinder) = Cylinder::new(from, to, radius.get()) else {
                around.refuse("cylinder", format!("from and to at {from:?}"), "two different points");
                return None;
            };
            Region::Cylinder(cylinder)
        } else {
            Region::Solid(solid(self.mesh.as_ref()?, around)?)
        };
        let volume = shape.volume();
        if !volume.is_normal() {
            around.refuse(key, format!("{volume:?} m³"), "a volume that 64 bits hold");
        }
        volume.is_normal().then_some(shape)
    }
}

/// The inside of a mesh; what is wrong with it is reported.
fn solid(keys: &mesh::Keys, around: &mut dyn Files) -> Option<Solid> {
    match Solid::of(keys.closed(around)?) {
        Ok(solid) => Some(solid),
        Err(place) => {
            let found = format!("a part of the surface, seen at {place:?} m, whose normals point to the wrong side");
            let expected = "parts beside each other with normals that point alike, and within another part only holes, with \
                         normals that point into them";
            around.refuse("mesh.file", found, expected);
            None
        }
    }
}
