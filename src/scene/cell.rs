//! `[cell]`: a parallelepiped that repeats, and how it is deformed.

use crate::base::document::{Mistake, keys};
use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::{STRAIN_PLACES, STRAINS, brought_back};
use crate::base::number::Vector;
use crate::base::quantity::{Finite, Positive, Triple};
use crate::laws::surface::Copies;
use crate::scene::import::FileBox;
use crate::scene::{AxisMotion, Boundary, OutletPlace, SceneDraft};
use serde::Deserialize;
use std::collections::BTreeMap;

/// A surface that is so many times as wide as its copy is away meets it.
const WIDE: f64 = 1.0 + 1e-6;

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Sine of an angle below which an edge lies in a plane.
const ALONG: f64 = 1e-9;

/// Most images of a particle along an edge, and most copies of a surface on each side.
const MOST_IMAGES: f64 = 10.0;

/// A periodic cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Where it stands, and along which edges it repeats.
    pub lattice: Lattice,
    /// What each component of its strain does: xx, yy, zz, xy, xz, yz.
    pub motion: [CellMotion; 6],
    /// The component whose input is `cell.shear`.
    pub shear: Option<usize>,
}

/// What a component of the strain does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CellMotion {
    /// It stays.
    #[default]
    Fixed,
    /// It follows an input.
    Driven,
    /// It changes at this rate \[1/s\].
    Prescribed(f64),
    /// It reaches a stress.
    Servo(StressServo),
}

/// A component of the strain that reaches a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressServo {
    /// What the target starts with \[Pa\].
    pub stress: f64,
    /// Which stress that is.
    pub of: ServedStress,
    /// The largest rate of the strain \[1/s\].
    pub max_rate: f64,
}

/// Which stress a servo of the cell reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ServedStress {
    /// That of its own component.
    #[default]
    Own,
    /// The mean of the three normal ones: the components with such a servo have what the others leave of it, in equal parts.
    Mean,
}

impl CellMotion {
    /// Whether a servo of it reaches the mean of the normal stresses.
    pub(crate) fn serves_mean(&self) -> bool {
        self.servo().is_some_and(|servo| servo.of == ServedStress::Mean)
    }

    /// What the target of its servo is compared with, where these are the stresses of the cell \[Pa\].
    pub(crate) fn served(&self, component: usize, stresses: &[f64; 6]) -> f64 {
        if self.serves_mean() { stresses[..3].iter().sum::<f64>() / 3.0 } else { stresses[component] }
    }

    /// The stress that a component among these has where its servo reaches a target while the others have these stresses \[Pa\].
    pub(crate) fn wanted(all: &[Self; 6], component: usize, target: f64, stresses: &[f64; 6]) -> f64 {
        if !all[component].serves_mean() {
            return target;
        }
        let (mut left, mut sharing) = (3.0 * target, 0.0);
        for (motion, stress) in all.iter().zip(stresses).take(3) {
            match motion.serves_mean() {
                true => sharing += 1.0,
                false => left -= stress,
            }
        }
        left / sharing
    }

    /// The servo, if it is one.
    pub(crate) fn servo(&self) -> Option<&StressServo> {
        if let Self::Servo(servo) = self { Some(servo) } else { None }
    }

    /// What its input starts with.
    pub(crate) fn first_input(self) -> f64 {
        self.servo().map_or(0.0, |servo| servo.stress)
    }
}

impl Cell {
    /// Whether anything deforms it.
    pub fn moves(&self) -> bool {
        self.motion.iter().any(|motion| *motion != CellMotion::Fixed)
    }

    /// Whether the edges repeat that a component of the strain changes.
    pub fn repeats(&self, component: usize) -> bool {
        STRAIN_PLACES[component].iter().all(|&edge| self.lattice.periodic[edge])
    }
}

/// An edge, by the axis that it is along without lean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Edge {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// A component of the strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Component {
    /// Along x
    Xx,
    /// Along y
    Yy,
    /// Along z
    Zz,
    /// Planes across y along x
    Xy,
    /// Planes across z along x
    Xz,
    /// Planes across z along y
    Yz,
}

/// A shear without end.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shear {
    /// [`Component::Xy`]
    Xy = 3,
    /// [`Component::Xz`]
    Xz,
    /// [`Component::Yz`]
    Yz,
}

/// A servo as the scene writes it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ServoKeys {
    /// What the target starts with \[Pa\].
    stress: Option<Finite>,
    /// The same of the mean of the normal stresses \[Pa\].
    mean_stress: Option<Finite>,
    /// The largest rate of the strain \[1/s\].
    max_rate: Positive,
}

keys! {
    /// `motion` of the cell; a component not named is fixed.
    #[derive(Clone, Debug, Default)]
    pub(in crate::scene) struct MotionKeys {
        /// Components that stay.
        #[serde(default)]
        fixed: Vec<Component> = "all others",
        /// Components that follow the inputs `cell.strain.<component>`.
        #[serde(default)]
        driven: Vec<Component> = "none",
        /// `{ zz = -0.1 }`: components that change at this rate \[1/s\].
        #[serde(default)]
        prescribed: BTreeMap<Component, Finite> = "none",
        /// `{ zz = { stress = -1e5, max_rate = 0.1 } }`: the strain moves, at most at this rate \[1/s\], until the stress \[Pa\],
        /// tension positive, is that of the input `cell.target_stress.zz`, which starts with `stress` (0); `cell.servo_error.zz` is
        /// the error.
        #[serde(default)]
        servo: BTreeMap<Component, ServoKeys> = "none",
        /// `"xy"`, `"xz"` or `"yz"`: this shear follows the input `cell.shear`, as far as you like.
        shear: Option<Shear> = "none",
    }
}

keys! {
    /// `[cell]`
    #[derive(Clone, Debug)]
    pub(in crate::scene) struct CellKeys {
        /// `[[ax, 0, 0], [bx, by, 0], [cx, cy, cz]]` \[m\], as LAMMPS writes tilted boxes; `ax`, `by`, `cz` above 0; faces no nearer to
        /// each other than the largest radius.
        edges: Option<Vec<Triple>> = "those of a file of particles",
        /// The corner from which they go out \[m\]; it stays where it is.
        origin: Option<Triple> = "that of the file, or `[0, 0, 0]`",
        /// Edges that repeat, of `"x"`, `"y"`, `"z"`; along the others it only says the volume.
        periodic: Option<Vec<Edge>> = "all",
        /// What the strains `xx`, `yy`, `zz`, `xy`, `xz`, `yz` do, see below.
        #[serde(default)]
        motion: MotionKeys = "all fixed",
    }
}

impl ServoKeys {
    /// The servo.
    fn servo(&self) -> StressServo {
        let of = if self.mean_stress.is_some() { ServedStress::Mean } else { ServedStress::Own };
        let stress = self.mean_stress.or(self.stress).map_or(0.0, Finite::get);
        StressServo { stress, of, max_rate: self.max_rate.get() }
    }
}

impl MotionKeys {
    /// What its servos cannot be together.
    fn objection(&self) -> Option<Mistake> {
        let mean = |keys: &ServoKeys| keys.mean_stress.map(Finite::get);
        let (found, expected) = if let Some((component, _)) =
            self.servo.iter().find(|(_, keys)| keys.stress.is_some() && keys.mean_stress.is_some())
        {
            let name = STRAINS[*component as usize];
            (format!("both for {name}"), "one of stress and mean_stress")
        } else if let Some((component, _)) =
            self.servo.iter().find(|(component, keys)| **component as usize > 2 && keys.mean_stress.is_some())
        {
            let name = STRAINS[*component as usize];
            (format!("mean_stress for {name}"), "mean_stress for xx, yy and zz only: it is their mean")
        } else {
            let targets: Vec<f64> = self.servo.values().filter_map(mean).collect();
            let other = targets.iter().find(|target| **target != targets[0])?;
            (format!("mean_stress {:?} and {other:?}", targets[0]), "one value: there is one mean")
        };
        Some(Mistake::Unexpected { found, expected: expected.to_owned() })
    }
}

impl CellKeys {
    /// The cell, beside files that say this box; reports what is wrong in the table itself.
    pub(in crate::scene) fn cell(
        &self,
        box_of_file: Option<Lattice>,
        report: &mut dyn FnMut(&str, Mistake),
    ) -> Option<Cell> {
        let mut twice = |key: &str, name: &str| {
            let (found, expected) = (format!("{name} twice"), "each once".to_owned());
            report(key, Mistake::Unexpected { found, expected });
        };
        let mut periodic = [self.periodic.is_none(); 3];
        for edge in self.periodic.iter().flatten() {
            if std::mem::replace(&mut periodic[*edge as usize], true) {
                twice("periodic", AXES[*edge as usize]);
            }
        }
        let MotionKeys { fixed, driven, prescribed, servo, shear } = &self.motion;
        let shear = shear.map(|shear| shear as usize);
        let named = (fixed.iter().map(|component| (*component as usize, CellMotion::Fixed)))
            .chain(driven.iter().map(|component| *component as usize).chain(shear).map(|it| (it, CellMotion::Driven)))
            .chain(prescribed.iter().map(|(component, rate)| (*component as usize, CellMotion::Prescribed(rate.get()))))
            .chain(servo.iter().map(|(component, keys)| (*component as usize, CellMotion::Servo(keys.servo()))));
        let mut motion = [None; 6];
        for (component, moves) in named {
            if motion[component].replace(moves).is_some() {
                twice("motion", STRAINS[component]);
            }
        }
        if let Some(mistake) = self.motion.objection() {
            report("motion.servo", mistake);
        }
        let lattice = match (&self.edges, box_of_file) {
            (Some(edges), _) => match edges[..] {
                [a, b, c] => Lattice { edges: [a, b, c].map(Triple::get), ..Lattice::default() },
                _ => {
                    let (found, expected) = (format!("{} edges", edges.len()), "three edges [x, y, z]".to_owned());
                    report("edges", Mistake::Unexpected { found, expected });
                    return None;
                }
            },
            (None, Some(lattice)) => lattice,
            (None, None) => {
                let expected = "three edges [x, y, z], or a file of particles that says its box".to_owned();
                report("edges", Mistake::Missing { expected });
                return None;
            }
        };
        let origin = self.origin.map_or(lattice.origin, Triple::get);
        Some(Cell {
            lattice: Lattice { origin, periodic, ..lattice },
            motion: motion.map(Option::unwrap_or_default),
            shear,
        })
    }
}

/// What was expected of edges instead of these, if anything.
pub(in crate::scene) fn fault_of(lattice: &Lattice) -> Option<&'static str> {
    let Lattice { origin, edges: [a, b, c], .. } = *lattice;
    let numbers = [origin, a, b, c];
    if !numbers.as_flattened().iter().all(|number| number.is_finite()) || !lattice.volume().is_normal() {
        return Some("finite numbers and a volume");
    }
    let upright = a[1] == 0.0 && a[2] == 0.0 && b[2] == 0.0 && a[0] > 0.0 && b[1] > 0.0 && c[2] > 0.0;
    (!upright).then_some("[[ax, 0, 0], [bx, by, 0], [cx, cy, cz]] with ax, by, cz above 0")
}

/// How far the edges of a box in a file may be from those of the cell, over the longest: texts have six digits.
const DIGITS: f64 = 1e-5;

/// What a cell, or a scene without one, has against the box of a file of particles: found and expected.
pub(in crate::scene) fn box_objection(cell: Option<&Cell>, around: &FileBox) -> Option<[String; 2]> {
    let names = |periodic: [bool; 3]| {
        let names: Vec<&str> = (0..3).filter(|&edge| periodic[edge]).map(|edge| AXES[edge]).collect();
        names.join(", ")
    };
    let Some(cell) = cell else {
        let expected = "a [cell] in the scene, which takes its edges from this file where it names none".to_owned();
        return around.is_periodic().then(|| ["a box that repeats".to_owned(), expected]);
    };
    let upright = |lattice: &Lattice| brought_back(lattice.edges, lattice.leaning());
    let [own, other] = [cell.lattice.periodic, around.lattice.periodic];
    if (0..3).any(|edge| other[edge] && !own[edge]) {
        let found = format!("a box that repeats along {}", names(other));
        return Some([found, format!("one that repeats as [cell] does, along {}", names(own))]);
    }
    let shared = [0, 1, 2].map(|edge| own[edge] && (other[edge] || !around.is_told));
    let [here, there] = [&cell.lattice, &around.lattice].map(|it| upright(&Lattice { periodic: shared, ..*it }));
    let longest = here.as_flattened().iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let differs = |edge: usize| (0..3).any(|axis| (here[edge][axis] - there[edge][axis]).abs() > DIGITS * longest);
    let found = || format!("a box with edges {:?} m", around.lattice.edges);
    (0..3)
        .any(|edge| shared[edge] && differs(edge))
        .then(|| [found(), format!("the edges of [cell], {:?} m", cell.lattice.edges)])
}

/// A table, a key, and what is wrong.
type Objection = (String, &'static str, Mistake);

/// What a scene with a cell cannot be.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    let Some(cell) = &scene.cell else { return Vec::new() };
    let at_cell = |key, found: String, expected: &str| {
        ("cell".to_owned(), key, Mistake::Unexpected { found, expected: expected.to_owned() })
    };
    let periodic = cell.lattice.periodic;
    if let Some(expected) = fault_of(&cell.lattice) {
        return vec![at_cell("edges", format!("{:?}", cell.lattice.edges), expected)];
    }
    let mut found = Vec::new();
    if periodic == [false; 3] {
        found.push(at_cell("periodic", "none".to_owned(), "at least one edge along which the cell repeats"));
    }
    let largest = scene.radii().fold(0.0, f64::max);
    let heights = cell.lattice.heights();
    if let Some(edge) = (0..3).find(|&edge| periodic[edge] && heights[edge] < largest) {
        let narrow = format!("faces {:?} m apart along {}", heights[edge], AXES[edge]);
        found.push(at_cell("edges", narrow, &format!("at least the largest radius, {largest:?} m")));
    }
    for component in 0..6 {
        if cell.motion[component] != CellMotion::Fixed && !cell.repeats(component) {
            let name = STRAINS[component];
            found.push(at_cell(
                "motion",
                format!("{name}, where the cell does not repeat"),
                "components of edges that repeat",
            ));
        }
    }
    // What is further away than pairs reach has no image; an image of each edge up to there is made.
    let distance = scene.bonds.iter().filter_map(|bond| bond.create_distance()).fold(0.0, f64::max);
    let reach = (2.0 * largest + scene.run.skin.unwrap_or(0.0)).max(distance);
    if (0..3).any(|edge| periodic[edge] && heights[edge] * MOST_IMAGES < reach) {
        let found_reach = format!("pairs that reach {reach:?} m in a cell with faces {heights:?} m apart");
        found.push(at_cell("edges", found_reach, "a cell no narrower than a tenth of skin and create_distance"));
    }
    found.extend(beside(scene, cell));
    found
}

/// What does not go together with a cell.
fn beside(scene: &SceneDraft, cell: &Cell) -> Vec<Objection> {
    let refused = |table: String, key, message: &str| (table, key, Mistake::Refused { message: message.to_owned() });
    let mut found = Vec::new();
    for boundary in &scene.boundaries {
        let table = format!("boundary.{}", boundary.name);
        if let Some((key, message)) = refused_boundary(boundary, cell) {
            found.push(refused(table, if key.is_empty() { boundary.shape.key() } else { key }, message));
        }
    }
    for bond in &scene.bonds {
        let table = format!("bond.{}", bond.name);
        if bond.plane.is_some() {
            found.push(refused(
                table,
                "between",
                "expected bonds between particles beside [cell], found bonds at a plane",
            ));
        }
    }
    for outlet in &scene.outlets {
        if let OutletPlace::Beyond([_, normal]) = outlet.place
            && !lies_along(cell, normal)
        {
            let message = "expected a plane along the edges that repeat, found one that crosses them";
            found.push(refused(format!("outlet.{}", outlet.name), "beyond", message));
        }
    }
    let parts = (scene.regions.iter().map(|it| (format!("region.{}", it.name), it.shape.bounds())))
        .chain(scene.meters.iter().map(|it| (format!("flow_meter.{}", it.name), it.polygon.bounds())))
        .chain(scene.grids.iter().map(|it| (format!("grid.{}", it.name), it.shape.corners)));
    for (table, corners) in parts {
        let widths = cell.lattice.parts_of_box(corners).map(|[low, high]| high - low);
        if let Some(edge) = (0..3).find(|&edge| cell.lattice.periodic[edge] && widths[edge] > MOST_IMAGES) {
            let found_width = format!("one over {:.1} edges along {}", widths[edge], AXES[edge]);
            let expected = format!("a part of space over no more than {MOST_IMAGES} edges of the cell");
            found.push((table, "", Mistake::Unexpected { found: found_width, expected }));
        }
    }
    for grid in scene.grids.iter().filter(|_| cell.moves()) {
        let message =
            "expected a [cell] that keeps its shape beside a grid, whose cells stand still, found one that is deformed";
        found.push(refused(format!("grid.{}", grid.name), "", message));
    }
    if cell.moves() && (scene.gravity != [0.0; 3] || !scene.forces.is_empty()) {
        let message = "expected neither gravity nor [force] beside a [cell] that is deformed, found one: they would work on its streaming motion";
        found.push(refused("cell".to_owned(), "motion", message));
    }
    if scene.domain.is_some() {
        found.push(refused(
            "domain".to_owned(),
            "",
            "expected no [domain] beside [cell], whose particles come back into it, found one",
        ));
    }
    let named = scene
        .boundaries
        .iter()
        .map(|it| ("boundary", &it.name))
        .chain(scene.regions.iter().map(|it| ("region", &it.name)))
        .chain(scene.grids.iter().map(|it| ("grid", &it.name)))
        .chain(scene.insertions.iter().map(|it| ("insertion", &it.name)))
        .chain(scene.outlets.iter().map(|it| ("outlet", &it.name)))
        .chain(scene.meters.iter().map(|it| ("flow_meter", &it.name)))
        .chain(scene.probes.iter().map(|it| ("probe", &it.name)));
    for (kind, name) in named.filter(|(_, name)| *name == "cell") {
        let (found_name, expected) = ("that of [cell]".to_owned(), "a name of its own".to_owned());
        found.push((format!("{kind}.{name}"), "", Mistake::Unexpected { found: found_name, expected }));
    }
    found
}

/// What a boundary beside a cell cannot be: the key, if not that of the shape, and why.
fn refused_boundary(boundary: &Boundary, cell: &Cell) -> Option<(&'static str, &'static str)> {
    let edges = || {
        let edges = cell.lattice.edges.iter().zip(cell.lattice.periodic);
        edges.filter(|(_, periodic)| *periodic).map(|(edge, _)| Vector::from(*edge))
    };
    if cell.moves() {
        return Some((
            "",
            "expected no boundary beside a [cell] that is deformed, found one, which would not be deformed with it",
        ));
    }
    if boundary.driven_nodes() > 0 {
        return Some(("nodes", "expected rigid nodes beside [cell], found driven ones"));
    }
    // Images of particles turn with them; copies of a surface would go around with it.
    let about = |axis: usize| {
        let along = edges().all(|edge| (0..3).all(|other| other == axis || edge.to_array()[other] == 0.0));
        let across = (0..3).all(|edge| edge == axis || cell.lattice.edges[edge][axis] == 0.0);
        along && across || boundary.axes[3 + axis].is_fixed()
    };
    if boundary.shape.members().is_empty() && !(0..3).all(about) {
        let message = "expected a surface beside [cell] that turns only about the one edge that repeats, across its faces, found one that turns otherwise";
        return Some(("motion", message));
    }
    let plane = boundary.shape.plane()?;
    (!lies_along(cell, plane.normal))
        .then_some(("", "expected a plane along the edges that repeat, found one that crosses them"))
}

/// Whether a plane with this normal lies along all edges that repeat.
fn lies_along(cell: &Cell, normal: [f64; 3]) -> bool {
    let lies = |edge: Vector| edge.dot(normal.into()).abs() <= ALONG * edge.length();
    let edges = cell.lattice.edges.iter().zip(cell.lattice.periodic);
    edges.filter(|(_, periodic)| *periodic).all(|(edge, _)| lies(Vector::from(*edge)))
}

/// Lets surfaces go on through the faces of a cell that repeats.
pub(in crate::scene) fn repeat_surfaces(scene: &mut SceneDraft) -> Vec<Objection> {
    let Some(cell) = scene.cell.filter(|_| objections(scene).is_empty()) else { return Vec::new() };
    let largest = scene.radii().fold(0.0, f64::max);
    // Lists reach by the skin and what a law holds beyond touch; particles may be out of the cell by the skin, spheres by their clump.
    let reach = 2.0 * (largest + scene.run.skin.unwrap_or(0.0).max(largest)) + scene.widest_clump();
    let mut found = Vec::new();
    for boundary in scene.boundaries.iter_mut().filter(|boundary| boundary.shape.material().is_some()) {
        let copies = copies(boundary, &cell.lattice, reach);
        match copies.and_then(|copies| boundary.shape.with_copies(copies)) {
            Ok(shape) => boundary.shape = shape,
            Err([found_shape, expected]) => {
                let mistake = Mistake::Unexpected { found: found_shape, expected };
                found.push((format!("boundary.{}", boundary.name), boundary.shape.key(), mistake));
            }
        }
    }
    found
}

/// Where the copies of a surface stand that particles in a cell reach \[m\].
fn copies(boundary: &Boundary, lattice: &Lattice, reach: f64) -> Result<Copies, [String; 2]> {
    let shape = &boundary.shape;
    let mut points = shape.facets(&[]).unwrap_or_default().points;
    if points.is_empty() && shape.plane().is_none() {
        // The box around what is no further than it reaches.
        let reference = Vector::from(boundary.reference);
        let extent = shape.features().map_or(f64::INFINITY, |features| features.extent(reference));
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -extent } else { extent };
            points.push(reference + Vector::new(side(0), side(1), side(2)));
        }
    }
    let heights = lattice.heights();
    // Moved along an edge, it is brought back where it has gone by half of one.
    let moves = |edge: usize| {
        let along = |axis: usize| {
            let mut end = lattice.origin;
            end[axis] += lattice.edges[edge][edge];
            lattice.parts(end)[edge] != 0.0
        };
        (0..3).any(|axis| {
            let motion = &boundary.axes[axis];
            !motion.is_fixed() && !matches!(motion, AxisMotion::Conveying(_)) && along(axis)
        })
    };
    let mut range = [[0, 0]; 3];
    for edge in (0..3).filter(|&edge| lattice.periodic[edge] && !points.is_empty()) {
        let parts = points.iter().map(|point| lattice.parts(point.to_array())[edge]);
        let [low, high] =
            parts.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)]);
        let beyond = reach / heights[edge] + if moves(edge) { 0.5 } else { 0.0 };
        let (from, to) = ((-beyond - high).ceil(), (1.0 + beyond - low).floor());
        if from < -MOST_IMAGES || to > MOST_IMAGES {
            let found = format!("copies from {from} to {to} edges away along {}", AXES[edge]);
            return Err([found, format!("no more than {MOST_IMAGES}: a wider cell, or a surface nearer to it")]);
        }
        range[edge] = [from.min(0.0) as i64, to.max(0.0) as i64];
    }
    let [a, b, c] = range.map(|[from, to]| from..=to);
    let mut counts = vec![[0; 3]];
    for k in c {
        for j in b.clone() {
            counts.extend(a.clone().map(|i| [i, j, k]).filter(|count| *count != [0; 3]));
        }
    }
    let shifts: Vec<Vector> = counts.iter().map(|count| lattice.displacement(*count).into()).collect();
    // A copy is beyond the surface as seen along the way to it, or along the normal of a face.
    let width = |of: &dyn Fn(&Vector) -> f64| {
        let [low, high] = points
            .iter()
            .map(of)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)]);
        high - low
    };
    let widths = [0, 1, 2].map(|edge| width(&|point| lattice.parts(point.to_array())[edge]));
    let is_beyond = |(count, shift): (&[i64; 3], &Vector)| {
        width(&|point| point.dot(*shift)) <= shift.dot(*shift) * WIDE
            || (0..3).any(|edge| widths[edge] <= count[edge].abs() as f64 * WIDE && count[edge] != 0)
    };
    match counts.iter().zip(&shifts).skip(1).find(|copy| !is_beyond(*copy)) {
        None => Ok(Copies { counts, shifts }),
        Some((_, shift)) => {
            let found = format!("a surface wider than its copy at {:?} m is away", shift.to_array());
            Err([found, "one that is no wider than the cell".to_owned()])
        }
    }
}

/// Spheres with the images of those that are no further than `depth` \[m\] from the cell, and whose image each is.
pub(in crate::scene) fn with_images(
    scene: &SceneDraft,
    spheres: &mut Vec<([f64; 3], f64)>,
    depth: impl Fn(f64) -> f64,
) -> Vec<u32> {
    let own = spheres.len();
    let mut originals: Vec<u32> = (0..own as u32).collect();
    let Some(cell) = &scene.cell else { return originals };
    if !objections(scene).is_empty() {
        return originals;
    }
    for (position, _) in spheres.iter_mut() {
        *position = cell.lattice.brought_back(*position);
    }
    for index in 0..own {
        let (position, radius) = spheres[index];
        cell.lattice.images(position, depth(radius), &mut |edges| {
            let shift = cell.lattice.displacement(edges);
            spheres.push(([0, 1, 2].map(|axis| position[axis] + shift[axis]), radius));
            originals.push(index as u32);
        });
    }
    originals
}
