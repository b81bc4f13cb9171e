//! How a scene writes a mesh.

use super::topology::Topology;
use super::{Mesh, faults, files};
use crate::geometry::rotation;
use crate::quantity::{Positive, Triple};
use crate::surface::{Around, Shape, ShapeKeys};
use serde::Deserialize;

/// `mesh = { file }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Keys {
    /// The file: STL, OBJ or VTK.
    file: String,
    /// Files of further triangles of the same surface.
    #[serde(default)]
    joined: Vec<String>,
    /// Length of one unit of the file \[m\].
    scale: Option<Positive>,
    /// Rotation after scaling: a rotation vector \[rad\].
    rotation: Option<Triple>,
    /// Displacement after that \[m\].
    offset: Option<Triple>,
    /// Which sides of the triangles count: 1, where the normals point, or 2.
    sides: Option<u8>,
}

impl Keys {
    /// The triangles of a file, where the scene wants them; what is wrong is reported.
    fn triangles(&self, key: &str, file: &str, around: &mut dyn Around) -> Option<Vec<[[f64; 3]; 3]>> {
        let mut triangles = match files::read(file, around.file(file)?) {
            Ok(triangles) if !triangles.is_empty() => triangles,
            Ok(_) => {
                around.refuse(key, format!("no triangle in {file}"), "a surface");
                return None;
            }
            Err((found, right)) => {
                around.refuse(key, format!("{file}: {found}"), &right);
                return None;
            }
        };
        let (scale, offset) = (self.scale.map_or(1.0, Positive::get), self.offset.unwrap_or_default().0);
        let turn = self.rotation.map(|rotation| rotation::orientation(rotation.0.into()));
        for corner in triangles.iter_mut().flatten() {
            let place = corner.map(|part| part * scale);
            let place = turn.map_or(place, |turn| turn.turn(place.into()).to_array());
            *corner = [0, 1, 2].map(|axis| place[axis] + offset[axis]);
        }
        let lost = triangles.iter().position(|triangle| !triangle.iter().flatten().all(|part| part.is_finite()));
        if let Some(triangle) = lost {
            let found = format!("{file}: triangle {} with a number that is not finite", triangle + 1);
            around.refuse(key, found, "finite coordinates");
            return None;
        }
        Some(triangles)
    }
}

impl ShapeKeys for Keys {
    const HINT: &'static str = "mesh = { file }";

    fn shape(&self, around: &mut dyn Around) -> Option<Shape> {
        let material = around.material("a mesh");
        if let Some(sides) = self.sides.filter(|sides| ![1, 2].contains(sides)) {
            around.refuse("mesh.sides", sides.to_string(), "1 or 2");
            return None;
        }
        let mut triangles = self.triangles("mesh.file", &self.file, around)?;
        for file in &self.joined {
            triangles.extend(self.triangles("mesh.joined", file, around)?);
        }
        let mut refuse =
            |found: String, right: &str| around.refuse("mesh.file", format!("{}: {found}", self.file), right);
        let mut topology = match Topology::of(&triangles) {
            Ok(topology) => topology,
            Err(triangle) => {
                refuse(format!("triangle {triangle} without area"), "triangles of some area");
                return None;
            }
        };
        if let (Err(triangle), Some(1)) = (topology.turn_alike(), self.sides) {
            refuse(format!("a surface that has one side only, seen at triangle {triangle},"), "sides = 2");
            return None;
        }
        if let Some(found) = faults::found(&topology) {
            refuse(found, "a surface that is there once everywhere");
            return None;
        }
        Some(Shape::of(Mesh::of(material?, topology, self.sides)))
    }
}
