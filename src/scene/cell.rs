//! `[cell]`: a parallelepiped that repeats, and how it is deformed.

use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::{STRAIN_PLACES, STRAINS};
use crate::base::number::Vector;
use crate::base::quantity::{Finite, Positive, Triple};
use crate::laws::bond::creation::Creation;
use crate::scene::SceneDraft;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Sine of an angle below which an edge lies in a plane.
const ALONG: f64 = 1e-9;

/// So many images of a particle along an edge are made at most.
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
    /// It reaches a stress.
    Servo(StressServo),
}

/// A component of the strain that reaches a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressServo {
    /// What the target starts with \[Pa\].
    pub stress: f64,
    /// The largest rate of the strain \[1/s\].
    pub max_rate: f64,
}

impl CellMotion {
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

/// A servo as the scene writes it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ServoKeys {
    /// What the target starts with \[Pa\].
    #[serde(default)]
    stress: Finite,
    /// The largest rate of the strain \[1/s\].
    max_rate: Positive,
}

/// `motion` of the cell; a component not named is fixed.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionKeys {
    /// Components that stay.
    #[serde(default)]
    fixed: Vec<Component>,
    /// Components that follow an input.
    #[serde(default)]
    driven: Vec<Component>,
    /// Components that reach a stress.
    #[serde(default)]
    servo: BTreeMap<Component, ServoKeys>,
    /// A shear without end.
    shear: Option<Component>,
}

/// `[cell]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CellKeys {
    /// The edges \[m\].
    edges: Vec<Triple>,
    /// The corner from which they go out \[m\].
    #[serde(default)]
    origin: Triple,
    /// Along which it repeats; absent: all.
    periodic: Option<Vec<Edge>>,
    /// How it is deformed.
    #[serde(default)]
    motion: MotionKeys,
}

impl CellKeys {
    /// The cell; reports what is wrong in the table itself.
    pub(in crate::scene) fn cell(&self, report: &mut dyn FnMut(&str, Mistake)) -> Option<Cell> {
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
        let MotionKeys { fixed, driven, servo, shear } = &self.motion;
        let named = (fixed.iter().map(|component| (*component, CellMotion::Fixed)))
            .chain(driven.iter().chain(shear).map(|component| (*component, CellMotion::Driven)))
            .chain(servo.iter().map(|(component, keys)| {
                let servo = StressServo { stress: keys.stress.get(), max_rate: keys.max_rate.get() };
                (*component, CellMotion::Servo(servo))
            }));
        let mut motion = [None; 6];
        for (component, moves) in named {
            if motion[component as usize].replace(moves).is_some() {
                twice("motion", STRAINS[component as usize]);
            }
        }
        let Ok(edges) = <[Triple; 3]>::try_from(self.edges.clone()) else {
            let (found, expected) = (format!("{} edges", self.edges.len()), "three edges [x, y, z]".to_owned());
            report("edges", Mistake::Unexpected { found, expected });
            return None;
        };
        Some(Cell {
            lattice: Lattice { origin: self.origin.get(), edges: edges.map(Triple::get), periodic },
            motion: motion.map(Option::unwrap_or_default),
            shear: shear.map(|component| component as usize),
        })
    }
}

/// A table, a key, and what is wrong.
type Objection = (String, &'static str, Mistake);

/// What a scene with a cell cannot be.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    let Some(cell) = &scene.cell else { return Vec::new() };
    let at_cell = |key, found: String, expected: &str| {
        ("cell".to_owned(), key, Mistake::Unexpected { found, expected: expected.to_owned() })
    };
    let Lattice { origin, edges: [a, b, c], periodic } = cell.lattice;
    let numbers = [origin, a, b, c];
    if !numbers.as_flattened().iter().all(|number| number.is_finite()) || !cell.lattice.volume().is_normal() {
        return vec![at_cell("edges", format!("{:?}", cell.lattice.edges), "finite numbers and a volume")];
    }
    if a[1] != 0.0 || a[2] != 0.0 || b[2] != 0.0 || a[0] <= 0.0 || b[1] <= 0.0 || c[2] <= 0.0 {
        let expected = "[[ax, 0, 0], [bx, by, 0], [cx, cy, cz]] with ax, by, cz above 0";
        return vec![at_cell("edges", format!("{:?}", cell.lattice.edges), expected)];
    }
    let mut found = Vec::new();
    if periodic == [false; 3] {
        found.push(at_cell("periodic", "none".to_owned(), "at least one edge along which the cell repeats"));
    }
    let largest = scene.particles.iter().fold(0.0_f64, |most, particle| most.max(particle.radius));
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
    if let Some(component) = cell.shear.filter(|&component| component < 3) {
        found.push(at_cell("motion.shear", STRAINS[component].to_owned(), "xy, xz or yz"));
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
        let crosses = |normal: [f64; 3]| {
            let edges = cell.lattice.edges.iter().zip(cell.lattice.periodic).filter(|(_, periodic)| *periodic);
            let lies = |edge: Vector| edge.dot(normal.into()).abs() <= ALONG * edge.length();
            edges.map(|(edge, _)| Vector::from(*edge)).any(|edge| !lies(edge))
        };
        let message = match boundary.shifting_plane() {
            None => {
                "expected planes that do not turn beside [cell], found another boundary; other shapes have no images yet"
            }
            Some(plane) if crosses(plane.normal) => {
                "expected a plane along the edges that repeat, found one that crosses them"
            }
            Some(_) if cell.moves() => {
                "expected no boundary beside a [cell] that is deformed, found one, which would not be deformed with it"
            }
            Some(_) => continue,
        };
        found.push(refused(table, boundary.shape.key(), message));
    }
    for bond in &scene.bonds {
        let table = format!("bond.{}", bond.name);
        if bond.plane.is_some() {
            found.push(refused(
                table,
                "between",
                "expected bonds between particles beside [cell], found bonds at a plane",
            ));
        } else if matches!(bond.keys.create, Creation::Always) {
            found.push(refused(
                table,
                "create",
                "expected bonds that are made at a time beside [cell], found \"always\"",
            ));
        }
    }
    let tables = [
        ("region", scene.regions.iter().map(|it| &it.name).next()),
        ("insertion", scene.insertions.iter().map(|it| &it.name).next()),
        ("outlet", scene.outlets.iter().map(|it| &it.name).next()),
        ("flow_meter", scene.meters.iter().map(|it| &it.name).next()),
    ];
    for (kind, name) in tables {
        if let Some(name) = name {
            let message = format!("expected no [{kind}] beside [cell], found one; it has no images yet");
            found.push(refused(format!("{kind}.{name}"), "", &message));
        }
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
        .chain(scene.probes.iter().map(|it| ("probe", &it.name)));
    for (kind, name) in named.filter(|(_, name)| *name == "cell") {
        let (found_name, expected) = ("that of [cell]".to_owned(), "a name of its own".to_owned());
        found.push((format!("{kind}.{name}"), "", Mistake::Unexpected { found: found_name, expected }));
    }
    found
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
        let shift = cell.lattice.displacement(cell.lattice.edges_away(*position));
        *position = [0, 1, 2].map(|axis| position[axis] - shift[axis]);
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
