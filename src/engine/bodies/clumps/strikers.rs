//! Clumps as what may strike others: how unit loads where they are touched accelerate them.

use crate::base::number::Vector;
use crate::engine::state::GONE;
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
    /// A particle of it: index into the scene's particles; [`GONE`] of one to come.
    pub(crate) particle: u32,
}

/// The lightest and the heaviest clump of each shape and material, of those to come as well.
pub(super) fn of(scene: &Scene) -> Vec<Striker> {
    let mut extremes: BTreeMap<(u32, u32), [(Clump, u32); 2]> = BTreeMap::new();
    let now = scene.clumps.iter().map(|clump| (*clump, scene.particles[clump.first as usize].material.0, clump.first));
    let coming = scene.insertions.iter().flat_map(|it| it.kinds.iter().map(move |kind| (it.material.0, kind)));
    let coming = coming.flat_map(|(material, kind)| kind.extremes().into_iter().map(move |it| (it, material, GONE)));
    for (clump, material, first) in now.chain(coming) {
        let [lightest, heaviest] = extremes.entry((clump.shape, material)).or_insert([(clump, first); 2]);
        if clump.mass < lightest.0.mass {
            *lightest = (clump, first);
        }
        if clump.mass > heaviest.0.mass {
            *heaviest = (clump, first);
        }
    }
    let mut strikers = Vec::new();
    for ((_, material), [lightest, heaviest]) in extremes {
        strikers.push(striker(scene, lightest, material));
        if heaviest.0.mass > lightest.0.mass {
            strikers.push(striker(scene, heaviest, material));
        }
    }
    strikers
}

/// One clump, whose first sphere is this particle.
fn striker(scene: &Scene, (clump, particle): (Clump, u32), material: u32) -> Striker {
    let shape = &scene.clump_shapes[clump.shape as usize];
    let inverse = Matrix3::from_diagonal(&Vector3::from(clump.moments).map(|moment| 1.0 / moment));
    let spin = inverse.diagonal().max();
    let mut striker = Striker { material, radius: 0.0, mass: clump.mass, shift: 0.0, slip: 0.0, spin, particle };
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
