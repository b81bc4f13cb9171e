//! Boundaries: shape, motion, point of reference.

use super::contacts::material_index;
use super::motion;
use super::particles::Born;
use super::raw_tables::RawTables;
use super::selection::{Owners, members};
use crate::contact::Material;
use crate::scene::document::Faults;
use crate::scene::file::{BoundaryTable, PlaneTable};
use crate::scene::mistake::Mistake;
use crate::scene::{AxisMotion, Boundary, Shape};

/// All boundaries.
pub(super) fn boundaries(
    written: &RawTables,
    materials: &[Material],
    born: &Born,
    faults: &mut Faults,
) -> Vec<Boundary> {
    let mut owners = Owners::of(born);
    let mut boundaries = Vec::new();
    for (name, boundary) in &written.boundaries {
        let table = format!("boundary.{name}");
        let Some(shape) = shape(boundary, &table, materials, born, faults) else { continue };
        if let Shape::Particles { members } = &shape {
            owners.claim(members, &table, born, faults);
        }
        let reference = boundary.reference.map_or_else(|| centre(&shape, born), |reference| reference.0);
        let axes = motion::axes(&boundary.motion.0, &table, faults);
        motion::check(&axes, &shape, boundary.reference.is_some(), &table, faults);
        if boundary.input.is_some() && !axes.contains(&AxisMotion::Driven) {
            let (what, right) = ("no axis is driven".to_owned(), "leave input out".to_owned());
            faults.add(&table, "input", Mistake::Senseless { what, right });
        }
        let input = boundary.input.unwrap_or_default();
        boundaries.push(Boundary { name: name.clone(), shape, axes, input, reference });
    }
    boundaries
}

/// The shape of a boundary.
fn shape(
    boundary: &BoundaryTable,
    table: &str,
    materials: &[Material],
    born: &Born,
    faults: &mut Faults,
) -> Option<Shape> {
    match (&boundary.plane, &boundary.particles) {
        (Some(plane), None) => match &boundary.material {
            Some(name) => {
                let material = material_index(materials, name, table, "material", faults);
                plane_shape(plane, table, faults).zip(material).map(|((point, normal), material)| Shape::Plane {
                    material,
                    point,
                    normal,
                })
            }
            None => {
                faults.add(table, "material", Mistake::Missing { right: "a plane needs one".to_owned() });
                None
            }
        },
        (None, Some(selection)) => {
            if boundary.material.is_some() {
                let what = "particles have their own material".to_owned();
                faults.add(table, "material", Mistake::Senseless { what, right: "leave it out".to_owned() });
            }
            Some(Shape::Particles { members: members(selection, born, table, faults) })
        }
        (Some(_), Some(_)) => {
            let (found, right) = ("plane and particles".to_owned(), "one shape".to_owned());
            faults.add(table, "", Mistake::Wrong { found, right });
            None
        }
        (None, None) => {
            let right = "plane = { point, normal } or particles = { set, box, ids } gives its shape".to_owned();
            faults.add(table, "", Mistake::Missing { right });
            None
        }
    }
}

/// Point and unit normal of a plane.
fn plane_shape(plane: &PlaneTable, table: &str, faults: &mut Faults) -> Option<([f64; 3], [f64; 3])> {
    let normal = plane.normal.0;
    // Scaled first, so that neither very long nor very short normals overflow.
    let largest = normal.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    if largest == 0.0 {
        let (found, right) = ("a normal of length 0".to_owned(), "one that points towards the particles".to_owned());
        faults.add(table, "plane.normal", Mistake::Wrong { found, right });
        return None;
    }
    let scaled = normal.map(|part| part / largest);
    let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
    Some((plane.point.0, scaled.map(|part| part / length)))
}

/// The point about which a moment is taken if the scene names none.
fn centre(shape: &Shape, born: &Born) -> [f64; 3] {
    match shape {
        Shape::Plane { point, .. } => *point,
        Shape::Particles { members } => {
            let (mut mass, mut first) = (0.0, [0.0; 3]);
            for particle in members.iter().map(|member| &born.particles[*member as usize]) {
                mass += particle.mass();
                for (sum, part) in first.iter_mut().zip(particle.position) {
                    *sum += particle.mass() * part;
                }
            }
            if mass > 0.0 { first.map(|moment| moment / mass) } else { [0.0; 3] }
        }
    }
}
