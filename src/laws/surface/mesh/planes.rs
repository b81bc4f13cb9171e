//! Spheres over planes of triangles, in lanes: one triangle of each plane tells what all of them do, where it is well under the
//! centre.

use super::{Mesh, Sides};
use crate::base::lanes::{Kernel, Lane, columns_from, rows_from};
use crate::base::number::Vector;
use crate::laws::surface::feet::{DEEP, OnPlanes};

/// A sphere that is further from the plane of a triangle than its radius by this share of it touches no other triangle of this
/// plane either: they may be nearer by what their angles make.
const ROOM: f64 = 1e-3;

/// A look at spheres over planes.
pub(super) struct Look<'a> {
    /// The surface.
    pub(super) mesh: &'a Mesh,
    /// The spheres.
    pub(super) spheres: &'a mut OnPlanes,
}

impl Kernel for Look<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { mesh, spheres } = self;
        let (faces, count) = (mesh.face(0), mesh.faces.len() as u32);
        let mut from = 0;
        while from < spheres.count {
            // Of an edge, a vertex, or none: behind the triangles.
            let (mut triangles, mut known) = ([0; 8], 0);
            for (triangle, feature) in triangles.iter_mut().zip(&spheres.feature[from..from + N::WIDTH]) {
                *triangle = feature.wrapping_sub(faces);
            }
            if triangles.iter().fold(true, |all, &triangle| all & (triangle < count)) {
                known = u32::MAX;
            } else {
                for (lane, triangle) in triangles.iter_mut().enumerate() {
                    known |= u32::from(*triangle < count) << lane;
                    *triangle = (*triangle).min(count - 1);
                }
            }
            known &= u32::MAX >> (u32::BITS as usize - N::WIDTH);
            let (face, sphere) = (mesh.faces.in_lanes::<N>(&triangles), columns_from::<N>(&spheres.sphere, from));
            let (centre, radius) = (Vector::of_row(sphere), sphere[3]);
            let height = face.height(centre);
            let distance = height.abs();
            let normal = Vector::select(N::zero().greater(height), -face.normal, face.normal);
            rows_from(normal.row_with(distance), &mut spheres.foot, from);
            let away = N::bits(distance.greater(radius * N::splat(1.0 + ROOM)));
            let deep = (radius * N::splat(DEEP)).greater(distance);
            let beside = N::either(distance.greater(radius), face.is_beside(centre, radius));
            let unclear = N::bits(N::either(deep, beside));
            let counts = match mesh.sides {
                Sides::Both => u32::MAX,
                Sides::Front => N::bits(height.greater(N::zero())),
            };
            spheres.away |= (away & known) << from;
            spheres.touching |= (!away & !unclear & counts & known) << from;
            from += N::WIDTH;
        }
    }
}
