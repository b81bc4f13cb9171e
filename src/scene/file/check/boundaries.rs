//! Boundaries: shape, motion, point of reference.

use super::body;
use super::contacts::material_index;
use super::following;
use super::heat;
use super::motion;
use super::particles::ReadParticles;
use super::raw_tables::RawTables;
use super::selection::{ParticleOwners, members};
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::base::quantity::MaterialIndex;
use crate::laws::contact::Material;
use crate::laws::surface::{Files, Selection, Shape, ShapeContext, Surface};
use crate::scene::Source;
use crate::scene::file::tables::BoundaryTable;
use crate::scene::{AxisMotion, Boundary, ColumnStart, InputCourse, NodeMotion, Outside, SceneDraft};

/// All boundaries.
pub(super) fn boundaries(
    written: &RawTables,
    source: &Source,
    materials: &[Material],
    (born, columns): (&ReadParticles, &[ColumnStart]),
    faults: &mut Faults,
) -> Vec<Boundary> {
    let mut owners = ParticleOwners::of(born);
    let mut boundaries = Vec::new();
    for (name, boundary) in &written.boundaries {
        let table = format!("boundary.{name}");
        let Some(shape) = shape((boundary, &table), (&written.hints, source), materials, born, faults) else {
            continue;
        };
        owners.claim(shape.members(), &table, born, faults);
        let reference = boundary.reference.map_or_else(|| centre(&*shape, born), |reference| reference.0);
        let axes = match &boundary.motion {
            Some(motion) => motion::axes(motion, source, &table, faults),
            None => [const { AxisMotion::Fixed }; 6],
        };
        motion::reference(&axes, boundary.reference.is_some(), &table, faults);
        let driven = boundary.nodes != NodeMotion::Rigid;
        if boundary.input.is_some() && !driven && !axes.iter().any(|axis| axis.takes_place()) {
            let (what, expected) = ("no axis is driven by displacement".to_owned(), "leave input out".to_owned());
            faults.add(&table, "input", Mistake::InvalidCombination { what, expected });
        }
        let input = boundary.input.unwrap_or_default();
        let body = body::body(boundary, &axes, (&*shape, reference), &table, faults);
        // What moves and turns by forces does so about its mass centre.
        let reference =
            if motion::turns_about_its_centre(&axes) && shape.members().is_empty() { body.centre } else { reference };
        let (nodes, outside, wear) = (boundary.nodes, boundary.outside, boundary.wear.clone());
        let temperature = heat::temperature(boundary, &table, (materials, born, columns), faults);
        let (name, moves_with) = (name.clone(), None);
        boundaries.push(Boundary {
            name,
            shape,
            axes,
            moves_with,
            nodes,
            input,
            reference,
            body,
            outside,
            temperature,
            wear,
        });
    }
    following::resolve(&written.boundaries, &mut boundaries, faults);
    boundaries.iter().for_each(|boundary| alone(boundary, faults));
    boundaries
}

/// Reports what speaks against the boundaries of a draft.
pub(super) fn check(draft: &SceneDraft, faults: &mut Faults) {
    let mut owner: Vec<Option<&str>> = vec![None; draft.particles.len()];
    for boundary in &draft.boundaries {
        alone(boundary, faults);
        following::check(boundary, &draft.boundaries, faults);
        let mut taken = boundary.shape.members().iter().filter_map(|&member| {
            owner[member as usize].replace(&boundary.name).map(|other| (member, other.to_owned()))
        });
        if let Some((member, other)) = taken.next() {
            let (id, other) = (draft.particles[member as usize].id.0, format!("[boundary.{other}]"));
            faults.add(&format!("boundary.{}", boundary.name), "particles", Mistake::AlreadyTaken { id, other });
        }
        taken.for_each(drop);
    }
}

/// Reports what a boundary cannot be or do, whatever stands beside it.
fn alone(boundary: &Boundary, faults: &mut Faults) {
    let (table, shape, axes) = (format!("boundary.{}", boundary.name), &*boundary.shape, &boundary.axes);
    let key = if boundary.moves_with.is_some() { "moves_with" } else { "motion" };
    motion::check(axes, shape, (&table, key), faults);
    nodes(boundary.nodes, axes, shape, &table, faults);
    let driven = boundary.nodes != NodeMotion::Rigid;
    if boundary.input == InputCourse::Quadratic && (driven || axes[3..].iter().any(AxisMotion::takes_place)) {
        let found = format!(
            "\"quadratic\", which is for displacements of the whole boundary, with driven {}",
            if driven { "nodes" } else { "rotations" }
        );
        let expected = "\"ramp\", \"smooth\" or \"hold\"".to_owned();
        faults.add(&table, "input", Mistake::Unexpected { found, expected });
    }
    if boundary.outside == Outside::Remove && !shape.members().is_empty() {
        let (found, expected) = ("\"remove\" at a group of particles", "a surface, or \"stop\"".to_owned());
        faults.add(&table, "outside", Mistake::Unexpected { found: found.to_owned(), expected });
    }
    if let Some(wear) = boundary.wear.first().filter(|_| shape.material().is_none()) {
        let found = format!("{} of a group of particles", wear.name());
        faults.add(&table, "wear", Mistake::Unexpected { found, expected: "wear of a surface".to_owned() });
    }
    body::lacks(boundary, &table, faults);
}

/// Reports nodes that the outside moves and that are not there, or that move with axes.
fn nodes(motion: NodeMotion, axes: &[AxisMotion; 6], shape: &dyn Surface, table: &str, faults: &mut Faults) {
    if motion == NodeMotion::Rigid {
        return;
    }
    if shape.vertices().is_empty() {
        let (found, expected) = (format!("a {}, which has none", shape.key()), "a mesh, which has nodes".to_owned());
        faults.add(table, "nodes", Mistake::Unexpected { found, expected });
    } else if let Some(axis) = axes.iter().position(|axis| !axis.is_fixed() || axis.conveys() != 0.0) {
        let what = format!("driven nodes, and {} moves, too", AxisMotion::WORDS[axis]);
        let expected = "leave motion out: the displacements of the nodes say it all".to_owned();
        faults.add(table, "nodes", Mistake::InvalidCombination { what, expected });
    }
}

/// The shape of a boundary.
fn shape(
    (boundary, table): (&BoundaryTable, &str),
    (hints, source): (&[&str], &Source),
    materials: &[Material],
    born: &ReadParticles,
    faults: &mut Faults,
) -> Option<Shape> {
    match &boundary.shapes[..] {
        [(_, make)] => make(&mut Written { boundary, table, source, materials, born, faults }),
        [] => {
            let expected = format!("{} gives its shape", alternatives(hints));
            faults.add(table, "", Mistake::Missing { expected });
            None
        }
        several => {
            let keys: Vec<&str> = several.iter().map(|(row, _)| row.key).collect();
            let (found, expected) = (keys.join(" and "), "one shape".to_owned());
            faults.add(table, "", Mistake::Unexpected { found, expected });
            None
        }
    }
}

/// Several things of which one is right.
fn alternatives(words: &[&str]) -> String {
    match words {
        [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => words.concat(),
    }
}

/// A boundary as it is written, with what it refers to.
struct Written<'a, 'b, 'c> {
    /// The table.
    boundary: &'a BoundaryTable,
    /// Its name, as `boundary.floor`.
    table: &'a str,
    /// The files of the scene.
    source: &'a Source,
    /// All materials.
    materials: &'a [Material],
    /// All particles.
    born: &'a ReadParticles,
    /// Where mistakes go.
    faults: &'a mut Faults<'b, 'c>,
}

impl ShapeContext for Written<'_, '_, '_> {
    fn material(&mut self, who: &str) -> Option<MaterialIndex> {
        let Some(name) = &self.boundary.material else {
            self.faults.add(self.table, "material", Mistake::Missing { expected: format!("{who} needs one") });
            return None;
        };
        material_index(self.materials, name, self.table, "material", self.faults)
    }

    fn no_material(&mut self, why: &str) {
        if self.boundary.material.is_some() {
            let (what, expected) = (why.to_owned(), "leave it out".to_owned());
            self.faults.add(self.table, "material", Mistake::InvalidCombination { what, expected });
        }
    }

    fn select(&mut self, selection: &Selection) -> Vec<u32> {
        members(selection, self.born, self.table, self.faults)
    }
}

impl Files for Written<'_, '_, '_> {
    fn file(&self, name: &str) -> Option<&[u8]> {
        self.source.files.get(name).map(Vec::as_slice)
    }

    fn report(&mut self, key: &str, mistake: Mistake) {
        self.faults.add(self.table, key, mistake);
    }
}

/// The point about which a moment is taken if the scene names none.
fn centre(shape: &dyn Surface, born: &ReadParticles) -> [f64; 3] {
    if let Some(point) = shape.reference() {
        return point;
    }
    let (mut mass, mut first) = (0.0, [0.0; 3]);
    for particle in shape.members().iter().map(|member| &born.particles[*member as usize]) {
        mass += particle.mass();
        for (sum, part) in first.iter_mut().zip(particle.position) {
            *sum += particle.mass() * part;
        }
    }
    if mass > 0.0 { first.map(|moment| moment / mass) } else { [0.0; 3] }
}
