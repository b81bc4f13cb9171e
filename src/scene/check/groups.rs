//! Boundaries, damping and applied forces: what is done to chosen particles.

use super::contacts::material_index;
use super::particles::Born;
use super::written::Written;
use crate::contact::Material;
use crate::scene::document::Faults;
use crate::scene::error::Mistake;
use crate::scene::file::{BoundaryTable, DampingTable, MotionTable, PlaneTable, ScaleTable, Selection};
use crate::scene::import::REPORTED;
use crate::scene::{AppliedForce, AxisMotion, Boundary, Damping, Shape};

/// The particles that a selection chooses, ascending; reports a selection of none.
fn members(selection: &Selection, born: &Born, table: &str, faults: &mut Faults) -> Vec<u32> {
    let before = faults.count();
    let mut sets: Option<Vec<usize>> = None;
    for name in selection.set.iter().chain(selection.sets.iter().flatten()) {
        match born.sets.iter().position(|set| set == name) {
            Some(index) => sets.get_or_insert_default().push(index),
            None => {
                let (found, known) = (name.clone(), born.sets.clone());
                let key = if selection.set.as_ref() == Some(name) { "particles.set" } else { "particles.sets" };
                faults.add(table, key, Mistake::UnknownName { found, kind: "particle set", known });
            }
        }
    }
    let ids = selection.ids.as_ref().map(|ids| {
        let mut ids = ids.clone();
        ids.sort_unstable();
        let known = |id: &&u32| born.particles.binary_search_by_key(id, |particle| &particle.id.0).is_ok();
        for id in ids.iter().filter(|id| !known(id)).take(REPORTED) {
            let (found, right) = (id.to_string(), "the number of a particle of this scene".to_owned());
            faults.add(table, "particles.ids", Mistake::Wrong { found, right });
        }
        ids
    });
    let chosen = |particle: &crate::scene::Particle| {
        let in_box = |corners: [[f64; 3]; 2]| {
            (0..3).all(|axis| (corners[0][axis]..=corners[1][axis]).contains(&particle.position[axis]))
        };
        sets.as_ref().is_none_or(|sets| sets.contains(&particle.set.index()))
            && ids.as_ref().is_none_or(|ids| ids.binary_search(&particle.id.0).is_ok())
            && selection.corners.is_none_or(|corners| in_box(corners.0))
    };
    let members: Vec<u32> =
        (0..).zip(&born.particles).filter(|(_, particle)| chosen(particle)).map(|(i, _)| i).collect();
    if members.is_empty() && faults.count() == before {
        faults.add(table, "particles", Mistake::Nobody { right: extent(born) });
    }
    members
}

/// Where the centres of the particles are.
fn extent(born: &Born) -> String {
    let Some(first) = born.particles.first() else { return "the scene has no particles".to_owned() };
    let (mut lower, mut upper) = (first.position, first.position);
    for particle in &born.particles {
        for axis in 0..3 {
            lower[axis] = lower[axis].min(particle.position[axis]);
            upper[axis] = upper[axis].max(particle.position[axis]);
        }
    }
    format!("all centres are between {lower:?} and {upper:?} m")
}

/// All boundaries.
pub(super) fn boundaries(written: &Written, materials: &[Material], born: &Born, faults: &mut Faults) -> Vec<Boundary> {
    let mut owners = Owners::of(born);
    let mut boundaries = Vec::new();
    for (name, boundary) in &written.boundaries {
        let table = format!("boundary.{name}");
        let Some(shape) = shape(boundary, &table, materials, born, faults) else { continue };
        if let Shape::Particles { members } = &shape {
            owners.claim(members, &table, born, faults);
        }
        let reference = boundary.reference.map_or_else(|| centre(&shape, born), |reference| reference.0);
        let axes = axes(&boundary.motion.0, &table, faults);
        if boundary.input.is_some() && !axes.contains(&AxisMotion::Driven) {
            let (what, right) = ("no axis is driven".to_owned(), "leave input out".to_owned());
            faults.add(&table, "input", Mistake::Senseless { what, right });
        }
        let input = boundary.input.unwrap_or_default();
        boundaries.push(Boundary { name: name.clone(), shape, axes, input, reference });
    }
    boundaries
}

/// Whose the particles are.
struct Owners {
    /// The tables that have some.
    tables: Vec<String>,
    /// Index into the tables, of each particle.
    of: Vec<Option<u32>>,
}

impl Owners {
    /// Nobody's yet.
    fn of(born: &Born) -> Self {
        Self { tables: Vec::new(), of: vec![None; born.particles.len()] }
    }

    /// Notes whose the members are; reports one that is somebody's already.
    fn claim(&mut self, members: &[u32], table: &str, born: &Born, faults: &mut Faults) {
        let taken = members.iter().find_map(|member| self.of[*member as usize].map(|owner| (*member, owner)));
        if let Some((member, owner)) = taken {
            let (id, other) = (born.particles[member as usize].id.0, format!("[{}]", self.tables[owner as usize]));
            faults.add(table, "particles", Mistake::Taken { id, other });
        }
        for member in members {
            self.of[*member as usize].get_or_insert(self.tables.len() as u32);
        }
        self.tables.push(table.to_owned());
    }
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

/// What each axis does; an axis may be named once.
fn axes(motion: &MotionTable, table: &str, faults: &mut Faults) -> [AxisMotion; 3] {
    let mut axes = [None; 3];
    let named = (motion.fixed.iter().map(|axis| (axis, AxisMotion::Fixed)))
        .chain(motion.driven.iter().map(|axis| (axis, AxisMotion::Driven)))
        .chain(motion.prescribed.iter().map(|(axis, speed)| (axis, AxisMotion::Prescribed(speed.get()))));
    for (axis, does) in named {
        if axes[*axis as usize].replace(does).is_some() {
            let what = format!("axis {} is named twice", ["x", "y", "z"][*axis as usize]);
            let right = "an axis is fixed, driven or prescribed".to_owned();
            faults.add(table, "motion", Mistake::Senseless { what, right });
        }
    }
    axes.map(|does| does.unwrap_or(AxisMotion::Fixed))
}

/// All damping.
pub(super) fn damping(written: &Written, materials: &[Material], born: &Born, faults: &mut Faults) -> Vec<Damping> {
    let mut owners = Owners::of(born);
    let mut list = Vec::new();
    for (name, damping) in &written.damping {
        let table = format!("damping.{name}");
        let members = match &damping.particles {
            Some(selection) => members(selection, born, &table, faults),
            None => (0..born.particles.len() as u32).collect(),
        };
        owners.claim(&members, &table, born, faults);
        let scales = scales(damping, &members, &table, materials, born, faults);
        let mut all = [damping.linear.get(), damping.angular.get()].map(|coefficient| {
            let mut each = vec![0.0; born.particles.len()];
            for (member, scale) in members.iter().zip(&scales) {
                each[*member as usize] = coefficient * scale;
            }
            each
        });
        let gravity = written.gravity.0 != [0.0; 3];
        let gravity_damped = said(damping.gravity_damped, gravity, &table, "gravity_damped", faults);
        let applied = !written.forces.is_empty();
        let forces_damped = said(damping.applied_forces_damped, applied, &table, "applied_forces_damped", faults);
        let (linear, angular) = (std::mem::take(&mut all[0]), std::mem::take(&mut all[1]));
        let name = name.clone();
        list.push(Damping { name, linear, angular, gravity_damped, applied_forces_damped: forces_damped });
    }
    list
}

/// A choice that the scene must make where it matters.
fn said(choice: Option<bool>, matters: bool, table: &str, key: &str, faults: &mut Faults) -> bool {
    if choice.is_none() && matters {
        faults.add(table, key, Mistake::Missing { right: "true or false".to_owned() });
    }
    choice.unwrap_or(false)
}

/// The factor on the damping of each member.
fn scales(
    damping: &DampingTable,
    members: &[u32],
    table: &str,
    materials: &[Material],
    born: &Born,
    faults: &mut Faults,
) -> Vec<f64> {
    let particle = |member: &u32| &born.particles[*member as usize];
    match &damping.scale {
        None => vec![1.0; members.len()],
        Some(ScaleTable { material: Some(scale), radius_divisor: None, column: None }) => {
            let mut factors = vec![1.0; materials.len()];
            for (name, factor) in scale {
                let key = format!("scale.material.{name}");
                if let Some(index) = material_index(materials, name, table, &key, faults) {
                    factors[index.index()] = factor.get();
                }
            }
            members.iter().map(|member| factors[particle(member).material.index()]).collect()
        }
        Some(ScaleTable { material: None, radius_divisor: Some(divisor), column: None }) => {
            members.iter().map(|member| particle(member).radius / divisor.get()).collect()
        }
        Some(ScaleTable { material: None, radius_divisor: None, column: Some(column) }) => {
            from_column(column, members, table, born, faults)
        }
        Some(_) => {
            let right = "one of material, radius_divisor, column is right".to_owned();
            faults.add(table, "scale", Mistake::Senseless { what: "not one kind of scale".to_owned(), right });
            Vec::new()
        }
    }
}

/// Factors from a column of the sets' files.
fn from_column(column: &str, members: &[u32], table: &str, born: &Born, faults: &mut Faults) -> Vec<f64> {
    let mut lacking = vec![false; born.sets.len()];
    let mut factors = Vec::with_capacity(members.len());
    for member in members.iter().map(|member| *member as usize) {
        let set = born.particles[member].set.index();
        match born.columns[set].get(column) {
            Some(values) => factors.push(values[born.rows[member] as usize]),
            None => lacking[set] = true,
        }
    }
    for (name, _) in born.sets.iter().zip(lacking).filter(|(_, lacking)| *lacking) {
        let what = format!("[particles.{name}] has no column {column}");
        let right = "every set that is damped needs it in its file".to_owned();
        faults.add(table, "scale.column", Mistake::Senseless { what, right });
    }
    if let Some(factor) = factors.iter().find(|factor| **factor < 0.0) {
        let (found, right) = (format!("{factor:?} in column {column}"), "factors of 0 or above".to_owned());
        faults.add(table, "scale.column", Mistake::Wrong { found, right });
    }
    factors
}

/// All applied forces.
pub(super) fn forces(written: &Written, born: &Born, faults: &mut Faults) -> Vec<AppliedForce> {
    let mut forces = Vec::new();
    for (name, force) in &written.forces {
        let members = members(&force.particles, born, &format!("force.{name}"), faults);
        forces.push(AppliedForce { name: name.clone(), members, force: force.force.0 });
    }
    forces
}
