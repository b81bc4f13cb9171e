//! Clumps as what may strike others: how unit loads where they are touched accelerate them.

use crate::base::number::Vector;
use crate::scene::{Clump, Scene};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

/// The spheres of a clump, as one that is as large and moves as easily as any of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Striker {
    /// Index of its material.
    pub(crate) material: u32,
    /// Radius of the largest \[m\].
    pub(crate) radius: f64,
    /// Mass of the clump \[kg\].
    pub(crate) mass: f64,
    /// Acceleration along the normal where it is touched by a unit force, by the turn alone \[1/kg\].
    pub(crate) shift: f64,
    /// The same across the normal \[1/kg\].
    pub(crate) slip: f64,
    /// Angular acceleration by a unit couple \[1/(kg m²)\].
    pub(crate) spin: f64,
    /// A particle of it: index into the scene's particles.
    pub(crate) particle: u32,
}

/// The lightest and the heaviest clump of each shape and material.
pub(super) fn of(scene: &Scene) -> Vec<Striker> {
    let mut extremes: BTreeMap<(u32, u32), [&Clump; 2]> = BTreeMap::new();
    for clump in &scene.clumps {
        let material = scene.particles[clump.first as usize].material.0;
        let [lightest, heaviest] = extremes.entry((clump.shape, material)).or_insert([clump; 2]);
        if clump.mass < lightest.mass {
            *lightest = clump;
        }
        if clump.mass > heaviest.mass {
            *heaviest = clump;
        }
    }
    let mut strikers = Vec::new();
    for ((_, material), [lightest, heaviest]) in extremes {
        strikers.push(striker(scene, lightest, material));
        if heaviest.mass > lightest.mass {
            strikers.push(striker(scene, heaviest, material));
        }
    }
    strikers
}

/// One clump.
fn striker(scene: &Scene, clump: &Clump, material: u32) -> Striker {
    let shape = &scene.clump_shapes[clump.shape as usize];
    let inverse = Matrix3::from_diagonal(&Vector3::from(clump.moments).map(|moment| 1.0 / moment));
    let spin = inverse.diagonal().max();
    let mut striker =
        Striker { material, radius: 0.0, mass: clump.mass, shift: 0.0, slip: 0.0, spin, particle: clump.first };
    for sphere in 0..shape.spheres.len() {
        let radius = clump.scale * shape.spheres[sphere].1;
        // The force along the normal goes through the centre of the sphere: its moment is a × n.
        let arm = Vector3::from(Vector::from(clump.arm(shape, sphere)).to_array()).cross_matrix();
        let by_arm = (arm.transpose() * inverse * arm).symmetric_eigenvalues().max().max(0.0);
        let across = by_arm.sqrt() + radius * spin.sqrt();
        striker.radius = striker.radius.max(radius);
        striker.shift = striker.shift.max(by_arm);
        striker.slip = striker.slip.max(across * across);
    }
    striker
}
