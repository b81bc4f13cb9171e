//! Clumps: rigid bodies of several spheres.
//!
//! A clump is placed by its mass centre. Its spheres are particles of the scene, one behind the other; what moves them is the clump.

mod keys;
mod union;

pub use keys::OrientationKey;
pub(in crate::scene) use keys::{ClumpKeys, unit};

use super::{Mistake, Particle, ParticleShape, SceneDraft};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;

/// How far a sphere may be from where its clump has it, over its radius.
const IN_PLACE: f64 = 1e-6;

/// `[clump.<name>]`: spheres that are one rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct ClumpShape {
    /// Its name in the scene.
    pub name: String,
    /// Centres in its own frame, and radii \[m\].
    pub spheres: Vec<([f64; 3], f64)>,
    /// Mass, where the scene gives it \[kg\].
    pub mass: Option<f64>,
    /// Volume of the union of the spheres \[m³\].
    pub volume: f64,
    /// Mass centre in the own frame \[m\].
    pub centre: [f64; 3],
    /// Principal axes in the own frame: the turn of global axes into them, as a unit quaternion.
    pub axes: [f64; 4],
    /// Squares of the radii of gyration about the principal axes \[m²\].
    pub gyration: [f64; 3],
    /// Estimated error of volume and inertia, relative; 0 where they are exact or given.
    pub error: f64,
}

/// A clump as the scene starts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clump {
    /// Index of its shape.
    pub shape: u32,
    /// Index of its first sphere among the particles; the others follow.
    pub first: u32,
    /// All lengths over those of the shape.
    pub scale: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Moments of inertia about the principal axes \[kg m²\].
    pub moments: [f64; 3],
    /// Mass centre \[m\].
    pub position: [f64; 3],
    /// Where its principal axes are: the turn of global axes into them, as a unit quaternion.
    pub orientation: [f64; 4],
    /// Velocity of the mass centre \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity \[rad/s\].
    pub angular_velocity: [f64; 3],
}

impl ClumpShape {
    /// The way from the mass centre to a sphere, in principal axes \[m\].
    pub fn arm(&self, sphere: usize) -> [f64; 3] {
        let way = Vector::from(self.spheres[sphere].0) - self.centre.into();
        Quaternion::from_row(self.axes).conjugate().turn(way).to_array()
    }

    /// Volume of the union over the sum of those of the spheres.
    pub fn fullness(&self) -> f64 {
        let sum: f64 = self.spheres.iter().map(|(_, radius)| ParticleShape::Sphere.volume(*radius)).sum();
        self.volume / sum
    }

    /// Radius of the smallest sphere about the mass centre that holds all of it \[m\].
    pub fn bounding_radius(&self) -> f64 {
        let reach = |sphere: usize| Vector::from(self.arm(sphere)).length() + self.spheres[sphere].1;
        (0..self.spheres.len()).map(reach).fold(0.0, f64::max)
    }
}

impl Clump {
    /// One of a shape, its own frame turned by `orientation`, of this density \[kg/m³\].
    pub(in crate::scene) fn of(
        (shape, index): (&ClumpShape, u32),
        (scale, density): (f64, f64),
        (position, orientation): ([f64; 3], Quaternion),
        [velocity, angular_velocity]: [[f64; 3]; 2],
    ) -> Self {
        let mass = shape.mass.unwrap_or(density * shape.volume) * (scale * scale * scale);
        let moments = shape.gyration.map(|square| square * (scale * scale) * mass);
        let orientation = (orientation * Quaternion::from_row(shape.axes)).normalised().to_row();
        Self { shape: index, first: 0, scale, mass, moments, position, orientation, velocity, angular_velocity }
    }

    /// The way from the mass centre to a sphere, in principal axes \[m\].
    pub fn arm(&self, shape: &ClumpShape, sphere: usize) -> [f64; 3] {
        shape.arm(sphere).map(|part| self.scale * part)
    }

    /// Its spheres: centres and radii \[m\].
    pub(crate) fn spheres(&self, shape: &ClumpShape) -> Vec<[f64; 4]> {
        let sphere = |index: usize| {
            let [[x, y, z], _] = self.placed(shape, index);
            [x, y, z, self.scale * shape.spheres[index].1]
        };
        (0..shape.spheres.len()).map(sphere).collect()
    }

    /// Where a sphere stands at the start \[m\], and its velocity \[m/s\].
    pub fn placed(&self, shape: &ClumpShape, sphere: usize) -> [[f64; 3]; 2] {
        let arm = Quaternion::from_row(self.orientation).turn(self.arm(shape, sphere).into());
        let velocity = Vector::from(self.velocity) + Vector::from(self.angular_velocity).cross(arm);
        [(Vector::from(self.position) + arm).to_array(), velocity.to_array()]
    }
}

impl SceneDraft {
    /// Radius of the largest sphere about a mass centre that holds a clump, or one that comes; 0 where there is none \[m\].
    pub(crate) fn widest_clump(&self) -> f64 {
        let there = |clump: &Clump| clump.scale * self.clump_shapes[clump.shape as usize].bounding_radius();
        let coming = self.insertions.iter().filter(|it| it.has_clumps()).map(|it| it.radii()[1]);
        self.clumps.iter().map(there).chain(coming).fold(0.0, f64::max)
    }

    /// Indices of the spheres of a clump among the particles.
    pub fn spheres_of(&self, clump: &Clump) -> std::ops::Range<usize> {
        let first = clump.first as usize;
        first..first + self.clump_shapes[clump.shape as usize].spheres.len()
    }

    /// The clump of each particle; empty where the scene has none.
    pub fn clump_of_particles(&self) -> Vec<Option<u32>> {
        let mut of = vec![None; if self.clumps.is_empty() { 0 } else { self.particles.len() }];
        for (index, clump) in (0..).zip(&self.clumps) {
            of[self.spheres_of(clump)].fill(Some(index));
        }
        of
    }
}

/// A table, a key, and what is wrong.
type Objection = (String, &'static str, Mistake);

/// What is wrong with the clumps of a draft by themselves: a scene file cannot get any of this wrong, code can.
pub(in crate::scene) fn faults(scene: &SceneDraft) -> Option<Objection> {
    let wrong = |found: String, expected: &str| {
        Some(("clump".to_owned(), "", Mistake::Unexpected { found, expected: expected.to_owned() }))
    };
    let came = scene.insertions.iter().flat_map(|insertion| &insertion.kinds).filter_map(|kind| kind.clump.as_ref());
    for clump in came {
        if scene.clump_shapes.get(clump.index as usize) != Some(&clump.shape) || clump.shape.spheres.is_empty() {
            return wrong(format!("shape {} of an insertion", clump.index), "the index of a shape, and that shape");
        }
    }
    let mut next = 0;
    for (place, clump) in scene.clumps.iter().enumerate() {
        let Some(shape) = scene.clump_shapes.get(clump.shape as usize) else {
            return wrong(format!("shape {} of clump {place}", clump.shape), "the index of a shape");
        };
        let last = clump.first as usize + shape.spheres.len();
        if (clump.first as usize) < next || last > scene.particles.len() || shape.spheres.is_empty() {
            return wrong(format!("first sphere {} of clump {place}", clump.first), "particles of its own, ascending");
        }
        next = last;
        let [a, b, c] = clump.moments;
        let numbers = [&clump.position[..], &clump.orientation, &clump.velocity, &clump.angular_velocity].concat();
        let length = clump.orientation.iter().map(|part| part * part).sum::<f64>();
        if ![clump.mass, clump.scale, a, b, c].iter().all(|it| it.is_normal() && *it > 0.0)
            || !numbers.iter().all(|it| it.is_finite())
            || (length - 1.0).abs() > 1e-9
        {
            return wrong(format!("{clump:?}"), "mass, scale and moments above 0, finite numbers, a unit quaternion");
        }
        for (sphere, particle) in scene.particles[clump.first as usize..last].iter().enumerate() {
            let [place, _] = clump.placed(shape, sphere);
            let away = (Vector::from(place) - particle.position.into()).length();
            let radius = clump.scale * shape.spheres[sphere].1;
            if away > IN_PLACE * radius || (particle.radius - radius).abs() > IN_PLACE * radius {
                let found = format!("particle {} of radius {:?} m", particle.id.0, particle.radius);
                return wrong(
                    found,
                    &format!("a sphere of radius {radius:?} m at {place:?} m, where its clump has it"),
                );
            }
        }
    }
    None
}

/// What clumps do not go together with.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    if !scene.has_clumps() {
        return Vec::new();
    }
    let mut of = scene.clump_of_particles();
    of.resize(scene.particles.len(), None);
    let mut found = Vec::new();
    let mut refuse = |table: String, key, what: &str| {
        let message = format!("expected none beside [clump], found one: {what}");
        found.push((table, key, Mistake::Refused { message }));
    };
    if scene.run.plane.is_some() {
        refuse("run".to_owned(), "plane", "clumps move in space");
    }
    for boundary in &scene.boundaries {
        if boundary.shape.members().iter().any(|&member| of[member as usize].is_some()) {
            refuse(format!("boundary.{}", boundary.name), "particles", "spheres of a clump cannot move as a group");
        }
    }
    let rigid = |[a, b]: &[u32; 2]| of[*a as usize].is_some() && of[*a as usize] == of[*b as usize];
    for bond in scene.bonds.iter().filter(|bond| bond.pairs.iter().any(rigid)) {
        refuse(format!("bond.{}", bond.name), "create", "it bonds two spheres of one clump");
    }
    for damping in &scene.damping {
        let differs = |clump: &Clump| {
            let spheres = scene.spheres_of(clump);
            let first = [damping.linear[spheres.start], damping.angular[spheres.start]];
            spheres.clone().any(|index| [damping.linear[index], damping.angular[index]] != first)
        };
        if scene.clumps.iter().any(differs) {
            refuse(format!("damping.{}", damping.name), "", "it damps spheres of one clump differently");
        }
    }
    found
}

/// Gives each clump its first sphere: they follow each other among the particles that belong to one, in the order of the clumps.
pub(in crate::scene) fn number(clumps: &mut [Clump], shapes: &[ClumpShape], of_clump: impl Iterator<Item = bool>) {
    let mut places = (0..).zip(of_clump).filter(|(_, is_of_clump)| *is_of_clump).map(|(place, _)| place);
    for clump in clumps {
        clump.first = places.next().unwrap_or(0);
        let others = shapes[clump.shape as usize].spheres.len() - 1;
        places.by_ref().take(others).for_each(drop);
    }
}

/// The spheres of a clump as particles that are like this one.
pub(in crate::scene) fn spheres(clump: &Clump, shape: &ClumpShape, like: &Particle) -> Vec<Particle> {
    let radius = |sphere: usize| clump.scale * shape.spheres[sphere].1;
    let volume: f64 = (0..shape.spheres.len()).map(|sphere| like.shape.volume(radius(sphere))).sum();
    let sphere = |sphere: usize| {
        let [position, velocity] = clump.placed(shape, sphere);
        Particle {
            radius: radius(sphere),
            density: clump.mass / volume,
            position,
            velocity,
            angular_velocity: clump.angular_velocity,
            ..*like
        }
    };
    (0..shape.spheres.len()).map(sphere).collect()
}
