//! Surfaces of revolution: a profile of straight segments, turned about an axis. Exact, no facets.
//!
//! In the half plane through the axis and the centre of a sphere, q away from the axis and z along it, the nearest point of
//! each turned segment is that of the segment itself. So the rule of [`super::feet`] holds in two dimensions: segments
//! count +1, corners of k segments 1 − k.
//!
//! A sphere around the axis may also touch the far side of a ring, with the overlap δ' beside δ on the near one. Its force
//! is that of one overlap h of both, whose gradient leads from the near normal to the axis:
//!
//! ```text
//! h = δ (1 + (r³ − r²)/2),  r = δ'/δ      ∇h = (1 + r²/2 − r³) n + (3r²/2 − r) n'
//! ```
//!
//! h is δ where the far side is out of touch and on the axis, where the parts of n and n' across it cancel. The energy is
//! that of h, so the force is continuous and conservative.

use super::cylinder::FAR;
use super::facets::{Facets, across};
use super::feet::{Features, Feet, Foot};
use super::{Copies, Repeated, Surface};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use std::f64::consts::TAU;

/// What rounding may take from a square, with room.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Sine of an angle below which a displacement is along the axis, and share of it by which a surface ends before the next one.
const ALONG: f64 = 1e-9;

/// Facets around the axis, where the surface is shown.
const AROUND: usize = 64;

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
    /// The segments that end in each corner, ascending.
    at_corner: Vec<Vec<u32>>,
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
        let ends = |corner| (0..).zip(&segments).filter(move |(_, ends)| ends.contains(&corner));
        let at_corner = (0..corners.len() as u32).map(|corner| ends(corner).map(|(segment, _)| segment).collect());
        Self { key, material, origin, axis, at_corner: at_corner.collect(), corners, segments }
    }

    /// A centre in the half plane: q, z, and the direction away from the axis; on the axis any.
    #[inline(always)]
    fn in_profile(&self, centre: Vector) -> ([f64; 2], Vector) {
        let apart = centre - self.origin;
        let z = apart.dot(self.axis);
        let out = apart - self.axis * z;
        let q = out.length();
        ([q, z], if q >= f64::MIN_POSITIVE { out * (1.0 / q) } else { self.any_way_out() })
    }

    /// Whether a corner is within reach of a centre, or may be by rounding.
    #[inline(always)]
    fn is_within(&self, [q, z]: [f64; 2], corner: u32, reach: f64) -> bool {
        let [a, b] = self.corners[corner as usize];
        (q - a) * (q - a) + (z - b) * (z - b) <= ROUNDING * reach * reach
    }

    /// A direction across the axis.
    #[cold]
    fn any_way_out(&self) -> Vector {
        across(self.axis)[0]
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
            Nearest { apart, distance, corner: Some(place), along }
        };
        if along <= 0.0 {
            return at(a, from, 0.0);
        }
        if along >= length {
            return at(b, to, length);
        }
        // The distance from the line itself: a wall along or across the axis then has the bits of a cylinder or a plane.
        let across = apart[0] * unit[1] - apart[1] * unit[0];
        Nearest { apart: [unit[1] * across, -unit[0] * across], distance: across.abs(), corner: None, along }
    }

    /// Whether a segment is nowhere near a centre: the box around it is further than `reach` \[m\].
    fn is_apart(&self, [q, z]: [f64; 2], [from, to]: [u32; 2], reach: f64) -> bool {
        let (a, b) = (self.corners[from as usize], self.corners[to as usize]);
        let beyond = |place: f64, a: f64, b: f64| (a.min(b) - place).max(place - a.max(b));
        beyond(q, a[0], b[0]) > reach || beyond(z, a[1], b[1]) > reach
    }

    /// The foot of a sphere with this radius \[m\], whose centre is this one in the half plane, on a feature of which this is the
    /// nearest point.
    fn foot(&self, (place, outwards): ([f64; 2], Vector), radius: f64, at: (u32, &Nearest, f64)) -> Foot {
        let (feature, nearest, weight) = at;
        let Nearest { apart, distance, .. } = *nearest;
        let unit =
            |apart: [f64; 2], distance: f64| if distance > 0.0 { apart.map(|it| it / distance) } else { [1.0, 0.0] };
        let near = unit(apart, distance);
        let foot = |distance: f64, [q, z]: [f64; 2], slope: f64| Foot {
            feature,
            distance,
            normal: outwards * q + self.axis * z,
            weight,
            slope,
        };
        // Beyond the axis the sphere reaches as far as its radius goes beyond the distance from it.
        let far = if place[0] < radius { self.far_side(place, feature) } else { None };
        let Some(far) = far.filter(|far| far.distance < radius && distance < radius) else {
            return foot(distance, near, 1.0);
        };
        let [depth, beyond] = [radius - distance, radius - far.distance];
        let ratio = (beyond / depth).min(1.0);
        let other = unit([-far.apart[0], far.apart[1]], far.distance);
        let [share, rest] = [1.0 + ratio * ratio * (0.5 - ratio), ratio * (1.5 * ratio - 1.0)];
        let slope = [0, 1].map(|axis| share * near[axis] + rest * other[axis]);
        let steep = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        let overlap = depth * (1.0 + 0.5 * ratio * ratio * (ratio - 1.0));
        let normal = if steep > 0.0 { slope.map(|part| part / steep) } else { near };
        foot(radius - overlap, normal, steep)
    }

    /// The nearest point of a feature on the other side of the axis, if the feature has one of its own there.
    fn far_side(&self, [q, z]: [f64; 2], feature: u32) -> Option<Nearest> {
        match feature.checked_sub(self.segments.len() as u32) {
            Some(corner) => Some(self.at([-q, z], corner)).filter(|_| self.corners[corner as usize][0] > 0.0),
            None => Some(self.nearest([-q, z], self.segments[feature as usize])).filter(|far| far.corner.is_none()),
        }
    }
}

impl Features for Revolution {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        let (place, _) = self.in_profile(centre);
        let within = |segment: &[u32; 2]| {
            !self.is_apart(place, *segment, reach) && self.nearest(place, *segment).distance <= reach
        };
        parts.extend((0..).zip(&self.segments).filter(|(_, segment)| within(segment)).map(|(number, _)| number));
    }

    fn counts(&self) -> [usize; 2] {
        [self.segments.len(), self.segments.len() + self.corners.len()]
    }

    fn feet(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet) {
        let (place, outwards) = self.in_profile(centre);
        let count = self.segments.len() as u32;
        let Feet { list, room: [corners, _], .. } = feet;
        corners.clear();
        for &segment in parts {
            let ends = self.segments[segment as usize];
            let nearest = self.nearest(place, ends);
            if nearest.corner.is_none() && nearest.distance <= radius {
                list.push(self.foot((place, outwards), radius, (segment, &nearest, 1.0)));
            }
            for end in ends {
                if self.is_within(place, end, radius) && !corners.contains(&end) {
                    corners.push(end);
                }
            }
        }
        if !corners.is_sorted() {
            corners.sort_unstable();
        }
        let corners = std::mem::take(corners);
        for &corner in &corners {
            let (mut weight, mut here) = (1, None);
            let (mut inside, mut count_inside) = ([None; 2], 0);
            for &segment in &self.at_corner[corner as usize] {
                let ends = self.segments[segment as usize];
                let nearest = self.nearest(place, ends);
                match nearest.corner {
                    Some(end) if end == corner => here = Some(nearest),
                    _ => {
                        weight -= 1;
                        if nearest.corner.is_none() && nearest.distance <= radius {
                            let from_end =
                                if ends[0] == corner { nearest.along } else { self.length(ends) - nearest.along };
                            if let Some(place) = inside.get_mut(count_inside) {
                                *place = Some((segment, from_end));
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
            let feature = count + corner;
            feet.list.push(self.foot((place, outwards), radius, (feature, &nearest, f64::from(weight))));
            if let ([Some((one, x)), Some((other, y))], 2, true) = (inside, count_inside, weight < 0) {
                feet.add_saddle(feature, [one, other], [x, y]);
            }
        }
        feet.room[0] = corners;
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
    /// Length of a segment with these ends \[m\].
    fn length(&self, ends: [u32; 2]) -> f64 {
        let [a, b] = ends.map(|corner| self.corners[corner as usize]);
        ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])).sqrt()
    }

    /// A corner as the nearest point.
    fn at(&self, [q, z]: [f64; 2], corner: u32) -> Nearest {
        let [a, b] = self.corners[corner as usize];
        let apart = [q - a, z - b];
        let distance = (apart[0] * apart[0] + apart[1] * apart[1]).sqrt();
        Nearest { apart, distance, corner: Some(corner), along: 0.0 }
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

    fn facets(&self, beside: &[Vector]) -> Option<Facets> {
        let (directions, mut facets) = (across(self.axis), Facets::default());
        let beside = beside.iter().map(|place| (*place - self.origin).dot(self.axis));
        let [low, high] = beside.fold([0.0_f64; 2], |[low, high], z| [low.min(z), high.max(z)]);
        // The points of each corner of the profile: one on the axis, or one for each facet around it.
        let mut starts = Vec::with_capacity(self.corners.len());
        for [q, z] in &self.corners {
            let z = if z.abs() < FAR { *z } else { z.clamp(low, high) };
            let middle = self.origin + self.axis * z;
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

    fn repeated(&self, copies: &Copies) -> Result<Repeated, [String; 2]> {
        let [low, high] = self
            .corners
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [_, z]| [low.min(*z), high.max(*z)]);
        let is_along = |shift: &&Vector| shift.cross(self.axis).length() <= ALONG * shift.length();
        let along = copies.shifts[1..].iter().filter(is_along).map(|shift| shift.length());
        let next = along.fold(f64::INFINITY, f64::min);
        if next == f64::INFINITY || high - low < next * (1.0 - ALONG) {
            return Ok(Repeated::Apart);
        }
        if !copies.shifts.iter().all(|shift| is_along(&shift)) {
            let found = "a surface of revolution from face to face, beside copies across its axis".to_owned();
            return Err([found, "one that ends before the faces, or a mesh".to_owned()]);
        }
        let [[a, _], [b, _]] = [self.corners[0], self.corners[self.corners.len() - 1]];
        if self.corners.len() > 2 || a != b {
            let found = "a surface of revolution from face to face".to_owned();
            return Err([found, "a cylinder without caps, one that ends before the faces, or a mesh".to_owned()]);
        }
        if high - low < FAR {
            let ends = [[a, -FAR], [a, FAR]];
            let endless = Self::of(self.key, self.material, (self.origin, self.axis), &ends);
            return Ok(Repeated::Joined(super::Shape::of(endless)));
        }
        Ok(Repeated::Endless)
    }

    fn facet_at(&self, point: Vector) -> usize {
        let (place, outwards) = self.in_profile(point);
        let distance = |segment: &usize| self.nearest(place, self.segments[*segment]).distance;
        let segment = (0..self.segments.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let [along, up] = across(self.axis).map(|across| outwards.dot(across));
        let turn = libm::atan2(up, along).rem_euclid(TAU) / TAU;
        segment * AROUND + ((turn * AROUND as f64) as usize).min(AROUND - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vessel of so many rings.
    fn vessel(rings: u32) -> Revolution {
        let corner = |k: u32| [0.05 + 0.02 * libm::sin(0.4 * f64::from(k)), 0.01 * f64::from(k)];
        let profile: Vec<_> = [[0.0, 0.0]].into_iter().chain((0..rings).map(corner)).collect();
        Revolution::of("revolution", MaterialIndex(0), (Vector::zero(), Vector::new(0.0, 0.6, 0.8)), &profile)
    }

    #[test]
    fn feet_of_the_segments_within_reach_are_those_of_all() {
        let vessel = vessel(62);
        let all: Vec<u32> = (0..vessel.segments.len() as u32).collect();
        let (mut near, mut found, mut expected, mut most, mut touched) =
            (Vec::new(), Feet::default(), Feet::default(), 0, 0);
        for number in 0..20_000_u32 {
            let part = |ratio: f64| (f64::from(number) * ratio).fract();
            let centre = Vector::new(part(0.754_877_67) - 0.5, part(0.569_840_29) - 0.5, part(0.430_159_71) - 0.5)
                * 0.2
                + vessel.axis * (0.6 * part(0.32));
            let radius = 0.002 + 0.01 * part(0.618_033_99);
            near.clear();
            found.clear();
            expected.clear();
            vessel.near(centre, radius + 0.001, &mut near);
            most = most.max(near.len());
            vessel.feet(centre, radius, &near, &mut found);
            vessel.feet(centre, radius, &all, &mut expected);
            assert_eq!(found.list, expected.list);
            assert_eq!(found.saddles, expected.saddles);
            touched += found.list.len();
        }
        assert!(most < 8 && touched > 1000, "{most} segments near, {touched} touched");
    }
}
