//! `mesh` as a scene writes it, for a boundary and for a region.

use super::topology::Topology;
use super::{Mesh, faults, files};
use crate::base::document::keys;
use crate::base::geometry::rotation;
use crate::base::quantity::{MaterialIndex, Positive, Triple};
use crate::laws::surface::{Files, Shape, ShapeContext, ShapeKeys};

keys! {
    /// `mesh = { file }`
    #[derive(Clone, Debug)]
    pub(crate) struct Keys {
        /// STL (`.stl`, ASCII or binary), OBJ (`.obj`), or VTK (`.vtp`, `.vtu`, legacy `.vtk`) with triangles, flat convex polygons or
        /// strips. Normals follow from the order of the corners.
        file: String = "required",
        /// Files with further triangles of the same surface, welded to it. (Two boundaries with a common edge would both count it.)
        #[serde(default)]
        joined: Vec<String> = "`[]`",
        /// Length of one unit of the file \[m\].
        scale: Option<Positive> = "1",
        /// Rotation of the mesh after scaling: a rotation vector \[rad\].
        rotation: Option<Triple> = "none",
        /// Displacement of the mesh after that \[m\].
        offset: Option<Triple> = "none",
        /// `1`: a triangle counts only for particles in front of it (normals point towards the particles); `2`: both sides count.
        sides: Option<u8> = "1 for a closed surface, else 2",
        /// Corners no further apart become one vertex \[m\].
        weld_distance: Option<Positive> = "1e-6 of the size of the surface, at most 1e-3 of its shortest edge",
    }
}

impl Keys {
    /// The triangles of a file, where the scene wants them; what is wrong is reported.
    fn triangles(&self, key: &str, file: &str, around: &mut dyn Files) -> Option<Vec<[[f64; 3]; 3]>> {
        let mut triangles = match files::read(file, around.file(file)?) {
            Ok(triangles) if !triangles.is_empty() => triangles,
            Ok(_) => {
                around.refuse_file(key, file, "no triangle", "a surface");
                return None;
            }
            Err((found, expected)) => {
                around.refuse_file(key, file, &found, &expected);
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
            let found = format!("triangle {} with a number that is not finite", triangle + 1);
            around.refuse_file(key, file, &found, "finite coordinates");
            return None;
        }
        Some(triangles)
    }

    /// The triangles of all files, as one surface whose triangles look to the same side where they can; what is wrong is
    /// reported. `front`: whether one side counts.
    fn topology(&self, front: bool, around: &mut dyn Files) -> Option<Topology> {
        let mut triangles = self.triangles("mesh.file", &self.file, around)?;
        for file in &self.joined {
            triangles.extend(self.triangles("mesh.joined", file, around)?);
        }
        let mut refuse = |found: String, expected: &str| around.refuse_file("mesh.file", &self.file, &found, expected);
        let mut topology = match Topology::welded(&triangles, self.weld_distance.map(Positive::get)) {
            Ok(topology) => topology,
            Err(triangle) => {
                let found = format!("triangle {triangle} without area");
                match self.weld_distance {
                    Some(distance) => {
                        let distance = distance.get();
                        refuse(
                            format!("{found} once its corners are welded over {distance:?} m"),
                            "a shorter weld_distance",
                        );
                    }
                    None => refuse(found, "triangles of some area"),
                }
                return None;
            }
        };
        let farthest = triangles.iter().flatten().flatten().fold(0.0, |most: f64, part| most.max(part.abs()));
        if farthest * f64::EPSILON > topology.tolerance {
            let found = format!("corners at {farthest:.3e} m, where numbers are too far apart for its triangles");
            refuse(found, "a surface nearer to the origin");
            return None;
        }
        if let (Err(triangle), true) = (topology.turn_alike(), front) {
            let expected = if self.sides.is_some() { "sides = 2" } else { "a surface with an inside" };
            refuse(format!("a surface that has one side only, seen at triangle {triangle}"), expected);
            return None;
        }
        if let Some(found) = faults::found(&topology) {
            refuse(found, "a surface that is there once everywhere");
            return None;
        }
        Some(topology)
    }

    /// The closed surface around a part of space; what is wrong is reported.
    pub(crate) fn closed(&self, around: &mut dyn Files) -> Option<Shape> {
        if let Some(sides) = self.sides {
            around.refuse("mesh.sides", sides.to_string(), "a region without sides, which is the inside");
            return None;
        }
        let topology = self.topology(true, around)?;
        if let Some(edge) = (0..topology.edges.len()).find(|edge| topology.at_edge[*edge].len() != 2) {
            let [a, b] = topology.edges[edge].map(|vertex| topology.vertices[vertex as usize].to_array());
            let (count, triangle) =
                (topology.at_edge[edge].len(), topology.numbers[topology.at_edge[edge][0] as usize]);
            let triangles = if count == 1 { "one triangle".to_owned() } else { format!("{count} triangles") };
            let found = format!("{triangles} at the edge of triangle {triangle} from {a:?} m to {b:?} m");
            around.refuse_file("mesh.file", &self.file, &found, "a closed surface, two triangles at every edge");
            return None;
        }
        Some(Shape::of(Mesh::of(MaterialIndex(0), topology, Some(1))))
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "mesh";
    const HINT: &'static str = "mesh = { file }";
    const FILES: &'static [&'static str] = &["file", "joined"];

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let material = around.material("a mesh");
        if let Some(sides) = self.sides.filter(|sides| ![1, 2].contains(sides)) {
            around.refuse("mesh.sides", sides.to_string(), "1 or 2");
            return None;
        }
        let topology = self.topology(self.sides == Some(1), around)?;
        Some(Shape::of(Mesh::of(material?, topology, self.sides)))
    }
}
