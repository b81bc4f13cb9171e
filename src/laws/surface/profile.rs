//! Surfaces of revolution: a profile of straight segments, turned about an axis. Exact, no facets.
//!
//! In the half plane through the axis and the centre of a sphere, q away from the axis and z along it, the nearest point of
//! each turned segment is that of the segment itself. So the rule of [`super::feet`] holds in two dimensions: segments
//! count +1, corners of k segments 1 − k.

use super::Surface;
use super::facets::{Facets, across};
use super::feet::{Features, Feet, Foot};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use std::f64::consts::TAU;

/// Facets around the axis, where the surface is shown.
const AROUND: usize = 64;

/// Below this share of the profile's size a distance from the axis has no direction.
const ON_AXIS: f64 = 1e-14;

/// A profile turned about an axis. It is touched from both sides.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Revolution {
    /// Its key in a scene.
    key: &'static str,
    /// What it is made of.
    material: MaterialIndex,
    /// Where z is 0 on the axis \[m\].
    origin: Vector,
    /// Unit vector along the axis.
    axis: Vector,
    /// The corners of the profile, q and z of each \[m\].
    corners: Vec<[f64; 2]>,
    /// The corners at the ends of each segment.
    segments: Vec<[u32; 2]>,
    /// Size of the profile \[m\].
    size: f64,
}

/// The nearest point of a segment.
#[derive(Clone, Copy)]
struct Nearest {
    /// From it to the centre, along q and z \[m\].
    apart: [f64; 2],
    /// Distance \[m\].
    distance: f64,
    /// The corner that it is, if it is not an inner point.
    corner: Option<u32>,
    /// Along the segment from its first corner \[m\].
    along: f64,
    /// Whether the centre is on the side to the left of the segment.
    behind: bool,
}

impl Revolution {
    /// A profile of these corners, one after the other, about an axis. Corners that coincide are one.
    pub(super) fn of(
        key: &'static str,
        material: MaterialIndex,
        (origin, axis): (Vector, Vector),
        profile: &[[f64; 2]],
    ) -> Self {
        let mut corners: Vec<[f64; 2]> = Vec::new();
        let mut segments = Vec::new();
        let mut last = None;
        for point in profile {
            let place = corners.iter().position(|corner| corner == point).unwrap_or_else(|| {
                corners.push(*point);
                corners.len() - 1
            }) as u32;
            if let Some(last) = last.filter(|last| *last != place) {
                segments.push([last, place]);
            }
            last = Some(place);
        }
        let size = corners.iter().map(|[q, z]| q.abs().max(z.abs())).fold(0.0, f64::max);
        Self { key, material, origin, axis, corners, segments, size }
    }

    /// A centre in the half plane: q, z, and the direction away from the axis, if it has one.
    fn in_profile(&self, centre: Vector) -> ([f64; 2], Option<Vector>) {
        let apart = centre - self.origin;
        let z = apart.dot(self.axis);
        let across = apart - self.axis * z;
        let q = across.length();
        ([q, z], (q > ON_AXIS * self.size).then(|| across * (1.0 / q)))
    }

    /// The nearest point of a segment.
    fn nearest(&self, [q, z]: [f64; 2], [from, to]: [u32; 2]) -> Nearest {
        let (a, b) = (self.corners[from as usize], self.corners[to as usize]);
        let way = [b[0] - a[0], b[1] - a[1]];
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let unit = way.map(|part| part / length);
        let apart = [q - a[0], z - a[1]];
        let along = apart[0] * unit[0] + apart[1] * unit[1];
        let at = |corner: [f64; 2], place: u32, along: f64| {
            let apart = [q - corner[0], z - corner[1]];
            let distance = (apart[0] * apart[0] + apart[1] * apart[1]).sqrt();
            Nearest { apart, distance, corner: Some(place), along, behind: false }
        };
        if along <= 0.0 {
            return at(a, from, 0.0);
        }
        if along >= length {
            return at(b, to, length);
        }
        // The distance from the line itself: a wall along or across the axis then has the bits of a cylinder or a plane.
        let across = apart[0] * unit[1] - apart[1] * unit[0];
        Nearest {
            apart: [unit[1] * across, -unit[0] * across],
            distance: across.abs(),
            corner: None,
            along,
            behind: across < 0.0,
        }
    }

    /// A direction of the half plane in space; on the axis, along it.
    fn in_space(&self, [q, z]: [f64; 2], outwards: Option<Vector>) -> Vector {
        match outwards {
            Some(outwards) => outwards * q + self.axis * z,
            None => self.axis * if z < 0.0 { -1.0 } else { 1.0 },
        }
    }

    /// The segments that end in a corner.
    fn at_corner(&self, corner: u32) -> impl Iterator<Item = usize> + '_ {
        (0..self.segments.len()).filter(move |segment| self.segments[*segment].contains(&corner))
    }
}

impl Features for Revolution {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        let (place, _) = self.in_profile(centre);
        if self.segments.iter().any(|segment| self.nearest(place, *segment).distance <= reach) {
            parts.push(0);
        }
    }

    fn counts(&self) -> [usize; 2] {
        [1, self.segments.len() + self.corners.len()]
    }

    fn feet(&self, centre: Vector, radius: f64, _parts: &[u32], feet: &mut Feet) {
        let (place, outwards) = self.in_profile(centre);
        let foot = |feature: usize, nearest: &Nearest, weight: i32| {
            let Nearest { apart, distance, .. } = *nearest;
            let unit = if distance > 0.0 { apart.map(|part| part / distance) } else { [1.0, 0.0] };
            let normal = self.in_space(unit, outwards);
            Foot { feature: feature as u32, distance, normal, weight: f64::from(weight), behind: nearest.behind }
        };
        let count = self.segments.len();
        for (number, segment) in self.segments.iter().enumerate() {
            let nearest = self.nearest(place, *segment);
            if nearest.corner.is_none() && nearest.distance <= radius {
                feet.list.push(foot(number, &nearest, 1));
            }
        }
        for corner in 0..self.corners.len() as u32 {
            let (mut weight, mut here) = (1, None);
            let (mut inside, mut count_inside) = ([None; 2], 0);
            for segment in self.at_corner(corner) {
                let nearest = self.nearest(place, self.segments[segment]);
                match nearest.corner {
                    Some(end) if end == corner => here = Some(nearest),
                    _ => {
                        weight -= 1;
                        if nearest.corner.is_none() && nearest.distance <= radius {
                            let from_end = if self.segments[segment][0] == corner {
                                nearest.along
                            } else {
                                self.length(segment) - nearest.along
                            };
                            if let Some(place) = inside.get_mut(count_inside) {
                                *place = Some((segment as u32, from_end));
                            }
                            count_inside += 1;
                        }
                    }
                }
            }
            if weight == 0 {
                continue;
            }
            let nearest = here.unwrap_or_else(|| self.at(place, corner));
            if nearest.distance > radius {
                continue;
            }
            let feature = count + corner as usize;
            feet.list.push(foot(feature, &nearest, weight));
            if let ([Some((one, x)), Some((other, y))], 2, true) = (inside, count_inside, weight < 0) {
                feet.add_saddle(feature as u32, [one, other], [x, y]);
            }
        }
    }

    fn meet(&self, one: u32, other: u32) -> bool {
        let count = self.segments.len() as u32;
        let ends = |feature: u32| match feature.checked_sub(count) {
            Some(corner) => [corner; 2],
            None => self.segments[feature as usize],
        };
        ends(one).iter().any(|corner| ends(other).contains(corner))
    }

    fn extent(&self, point: Vector) -> f64 {
        let ([q, z], _) = self.in_profile(point);
        let far = |[p, w]: &[f64; 2]| ((p + q) * (p + q) + (w - z) * (w - z)).sqrt();
        self.corners.iter().map(far).fold(0.0, f64::max)
    }
}

impl Revolution {
    /// Length of a segment \[m\].
    fn length(&self, segment: usize) -> f64 {
        let [a, b] = self.segments[segment].map(|corner| self.corners[corner as usize]);
        ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])).sqrt()
    }

    /// A corner as the nearest point.
    fn at(&self, [q, z]: [f64; 2], corner: u32) -> Nearest {
        let [a, b] = self.corners[corner as usize];
        let apart = [q - a, z - b];
        let distance = (apart[0] * apart[0] + apart[1] * apart[1]).sqrt();
        Nearest { apart, distance, corner: Some(corner), along: 0.0, behind: false }
    }
}

impl Surface for Revolution {
    fn key(&self) -> &'static str {
        self.key
    }

    fn material(&self) -> Option<MaterialIndex> {
        Some(self.material)
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        let (place, _) = self.in_profile(centre);
        self.segments.iter().map(|segment| self.nearest(place, *segment).distance).reduce(f64::min)
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.origin.to_array())
    }

    fn turns(&self) -> bool {
        true
    }

    fn facets(&self, _beside: &[Vector]) -> Option<Facets> {
        let (directions, mut facets) = (across(self.axis), Facets::default());
        // The points of each corner of the profile: one on the axis, or one for each facet around it.
        let mut starts = Vec::with_capacity(self.corners.len());
        for [q, z] in &self.corners {
            let middle = self.origin + self.axis * *z;
            starts.push(facets.points.len() as u32);
            let count = if *q == 0.0 { 1 } else { AROUND };
            facets.points.extend((0..count).map(|place| {
                let (up, along) = libm::sincos(TAU * place as f64 / AROUND as f64);
                middle + (directions[0] * along + directions[1] * up) * *q
            }));
        }
        let point = |corner: u32, place: usize| {
            let turned = if self.corners[corner as usize][0] == 0.0 { 0 } else { place % AROUND };
            starts[corner as usize] + turned as u32
        };
        for [from, to] in self.segments.iter().copied() {
            for place in 0..AROUND {
                facets.add(&[point(from, place), point(to, place), point(to, place + 1), point(from, place + 1)]);
            }
        }
        Some(facets)
    }

    fn facet_at(&self, point: Vector) -> usize {
        let (place, outwards) = self.in_profile(point);
        let distance = |segment: &usize| self.nearest(place, self.segments[*segment]).distance;
        let segment = (0..self.segments.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let [along, up] = across(self.axis).map(|across| outwards.map_or(1.0, |outwards| outwards.dot(across)));
        let turn = libm::atan2(up, along).rem_euclid(TAU) / TAU;
        segment * AROUND + ((turn * AROUND as f64) as usize).min(AROUND - 1)
    }
}
