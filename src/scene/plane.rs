//! Scenes whose particles stay in one plane.

use super::{Mistake, Particle, SceneDraft};
use serde::Deserialize;
use std::f64::consts::PI;

/// `[run] plane`: the plane in which the centres of all particles stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionPlane {
    /// x and z: y is the same for all particles, nothing moves along y, and particles spin about y alone.
    Xz,
}

/// `[run] plane_particles`: the body whose mass and moment of inertia a particle has. Contact and bond laws see its
/// radius and mass alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum ParticleShape {
    /// A full sphere.
    #[default]
    #[serde(rename = "spheres")]
    Sphere,
    /// A disc of unit thickness \[1 m\] that lies in the plane.
    #[serde(rename = "discs")]
    Disc,
}

impl ParticleShape {
    /// Volume of a body of this radius \[m\] \[m³\].
    pub fn volume(self, radius: f64) -> f64 {
        match self {
            Self::Sphere => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Disc => PI * radius.powi(2),
        }
    }

    /// Moment of inertia of a body of this mass \[kg\] and radius \[m\]: of a sphere about any diameter, of a disc about its axis
    /// \[kg m²\].
    pub fn inertia(self, mass: f64, radius: f64) -> f64 {
        let share = match self {
            Self::Sphere => 0.4,
            Self::Disc => 0.5,
        };
        share * mass * radius * radius
    }
}

/// The table and the key that are wrong, and why.
pub(crate) type Objection = (String, &'static str, Mistake);

/// What speaks against `[run] plane` in this scene.
pub(crate) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    let Some(MotionPlane::Xz) = scene.run.plane else { return Vec::new() };
    let mut objections = Vec::new();
    let mut leaves = |table: String, key: &'static str, found: String, expected: &str| {
        objections.push((
            table,
            key,
            Mistake::Unexpected { found, expected: format!("{expected} with plane = \"xz\"") },
        ));
    };
    if scene.gravity[1] != 0.0 {
        leaves("gravity".to_owned(), "", format!("{:?} m/s²", scene.gravity), "gravity without a component along y");
    }
    for force in scene.forces.iter().filter(|force| force.force[1] != 0.0) {
        let found = format!("{:?} N", force.force);
        leaves(format!("force.{}", force.name), "force", found, "a force without a component along y");
    }
    for insertion in &scene.insertions {
        let found = "particles that come anywhere in a region".to_owned();
        leaves(format!("insertion.{}", insertion.name), "region", found, "a scene without insertions");
    }
    if let Some((particle, found, expected)) = first_outside(scene) {
        let table =
            scene.sets.get(particle.set.index()).map_or("particles".to_owned(), |set| format!("particles.{set}"));
        leaves(table, "", found, expected);
    }
    if scene.particles.iter().any(|particle| particle.shape == ParticleShape::Disc) {
        objections.extend(discs(scene));
    }
    objections
}

/// The first particle that is not in the plane of the first one or leaves it; what it has, and what is right.
fn first_outside(scene: &SceneDraft) -> Option<(&Particle, String, &'static str)> {
    let level = scene.particles.first()?.position[1];
    scene.particles.iter().find_map(|particle| {
        let ([.., v, _], [a, _, c]) = (particle.velocity, particle.angular_velocity);
        let id = particle.id.0;
        if particle.position[1] != level {
            let found = format!("particle {id} at y = {:?} m, the first one at {level:?} m", particle.position[1]);
            Some((particle, found, "the same y for all particles"))
        } else if v != 0.0 {
            Some((particle, format!("particle {id} with {v:?} m/s along y"), "a velocity without a component along y"))
        } else if a != 0.0 || c != 0.0 {
            let found = format!("particle {id} with an angular velocity of {:?} rad/s", particle.angular_velocity);
            Some((particle, found, "an angular velocity about y alone"))
        } else {
            None
        }
    })
}

/// What reckons with the volume or the moment of inertia of spheres.
fn discs(scene: &SceneDraft) -> Vec<Objection> {
    let refused = |table: String, found: &str, expected: &str| {
        (
            table,
            "",
            Mistake::Unexpected {
                found: found.to_owned(),
                expected: format!("{expected} with plane_particles = \"discs\""),
            },
        )
    };
    let epsd = scene.contacts.iter().filter(|law| law.choice.rolling.name() == "epsd").map(|law| {
        let found = "epsd, whose dashpot is made for the moment of inertia of spheres";
        refused(format!("contact.{}.rolling.epsd", law.name), found, "another rolling model")
    });
    let regions = scene.regions.iter().map(|region| {
        let found = "a region, which reckons with the volume of spheres";
        refused(format!("region.{}", region.name), found, "a scene without regions")
    });
    let grids = scene.grids.iter().map(|grid| {
        let found = "a grid, which reckons with the volume of spheres";
        refused(format!("grid.{}", grid.name), found, "a scene without grids")
    });
    epsd.chain(regions).chain(grids).collect()
}
