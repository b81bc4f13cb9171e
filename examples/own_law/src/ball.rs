//! A boundary of the shape of a sphere, touched from outside and from inside.

use cograin::number::Vector;
use cograin::quantity::{MaterialIndex, Positive, Triple};
use cograin::surface::{Facets, Features, Feet, Foot, Shape, ShapeContext, ShapeKeys, Surface};
use serde::Deserialize;

/// `ball = { centre, radius }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// Its centre \[m\].
    centre: Triple,
    /// Its radius \[m\].
    radius: Positive,
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "ball";
    const HINT: &'static str = "ball = { centre, radius }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let material = around.material("a ball")?;
        Some(Shape::of(Ball { material, centre: self.centre.get().into(), radius: self.radius.get() }))
    }
}

/// A hollow sphere. A smaller sphere touches it once, at the nearest point.
#[derive(Clone, Copy, Debug)]
struct Ball {
    /// What it is made of.
    material: MaterialIndex,
    /// Its centre \[m\].
    centre: Vector,
    /// Its radius \[m\].
    radius: f64,
}

impl Ball {
    /// How far outside of it a point is, negative inside \[m\], and the unit vector away from its centre.
    fn outside(&self, point: Vector) -> (f64, Vector) {
        let away = point - self.centre;
        let length = away.length();
        let unit = if length > 0.0 { away * (1.0 / length) } else { Vector::new(1.0, 0.0, 0.0) };
        (length - self.radius, unit)
    }
}

impl Features for Ball {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        if self.outside(centre).0.abs() <= reach {
            parts.push(0);
        }
    }

    fn counts(&self) -> [usize; 2] {
        [1, 1]
    }

    fn feet(&self, centre: Vector, radius: f64, _parts: &[u32], feet: &mut Feet) {
        let (height, unit) = self.outside(centre);
        if height.abs() <= radius {
            let normal = if height < 0.0 { -unit } else { unit };
            feet.list.push(Foot { feature: 0, distance: height.abs(), normal, weight: 1.0, slope: 1.0 });
        }
    }

    fn meet(&self, _one: u32, _other: u32) -> bool {
        true
    }

    fn extent(&self, point: Vector) -> f64 {
        (point - self.centre).length() + self.radius
    }
}

/// Facets along an edge of the cube whose sides, blown up, are the ball's picture.
const FACETS: u32 = 8;

impl Surface for Ball {
    fn key(&self) -> &'static str {
        Keys::KEY
    }

    fn material(&self) -> Option<MaterialIndex> {
        Some(self.material)
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        Some(self.outside(centre).0.abs())
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.centre.to_array())
    }

    fn turns(&self) -> bool {
        true
    }

    fn facets(&self, _beside: &[Vector]) -> Option<Facets> {
        let mut facets = Facets::default();
        for side in 0..6 {
            let first = facets.points.len() as u32;
            for place in 0..(FACETS + 1) * (FACETS + 1) {
                let [u, v] = [place / (FACETS + 1), place % (FACETS + 1)]
                    .map(|at| 2.0 * f64::from(at) / f64::from(FACETS) - 1.0);
                let mut corner = [0.0; 3];
                (corner[side % 3], corner[(side + 1) % 3], corner[(side + 2) % 3]) =
                    (if side < 3 { 1.0 } else { -1.0 }, u, v);
                let corner = Vector::from(corner);
                facets.points.push(self.centre + corner * (self.radius / corner.length()));
            }
            for place in 0..FACETS * FACETS {
                let corner = first + place / FACETS * (FACETS + 1) + place % FACETS;
                facets.add(&[corner, corner + 1, corner + FACETS + 2, corner + FACETS + 1]);
            }
        }
        Some(facets)
    }

    fn facet_at(&self, point: Vector) -> usize {
        let away = (point - self.centre).to_array();
        let axis = (0..3).fold(0, |most, axis| if away[axis].abs() > away[most].abs() { axis } else { most });
        let side = if away[axis] < 0.0 { axis + 3 } else { axis };
        let [u, v] = [1, 2].map(|next| {
            let along = away[(axis + next) % 3] / away[axis].abs().max(f64::MIN_POSITIVE);
            ((0.5 * (along + 1.0) * f64::from(FACETS)) as u32).min(FACETS - 1)
        });
        side * (FACETS * FACETS) as usize + (u * FACETS + v) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Coupled, SCENE, assert_close, told};
    use std::f64::consts::PI;

    /// One of radius 2 about (1, 0, 0).
    fn ball() -> Ball {
        Ball { material: MaterialIndex(0), centre: Vector::new(1.0, 0.0, 0.0), radius: 2.0 }
    }

    /// Feet of a sphere of radius ½.
    fn feet(centre: [f64; 3]) -> Vec<(f64, [f64; 3])> {
        let mut feet = Feet::default();
        ball().feet(centre.into(), 0.5, &[0], &mut feet);
        feet.list.iter().map(|foot| (foot.distance, foot.normal.to_array())).collect()
    }

    #[test]
    fn a_sphere_touches_it_once_from_outside_and_from_inside() {
        assert_eq!(feet([1.0, 2.25, 0.0]), [(0.25, [0.0, 1.0, 0.0])]);
        assert_eq!(feet([1.0, 1.75, 0.0]), [(0.25, [0.0, -1.0, 0.0])]);
        assert_eq!([feet([1.0, 2.75, 0.0]), feet([1.0, 0.0, 0.0])].concat(), []);
    }

    #[test]
    fn its_picture_lies_on_it_and_knows_its_facets() {
        let (ball, facets) = (ball(), ball().facets(&[]).unwrap());
        for point in &facets.points {
            assert_close((*point - ball.centre).length(), 2.0, 1e-15);
        }
        let area: f64 = (0..facets.len()).map(|facet| facets.area(facet)).sum();
        assert_close(area, 16.0 * PI, 0.02);
        for facet in 0..facets.len() {
            let corners = &facets.corners[4 * facet..4 * facet + 4];
            let middle =
                corners.iter().fold(Vector::zero(), |sum, corner| sum + facets.points[*corner as usize] * 0.25);
            assert_eq!(ball.facet_at(middle), facet);
        }
    }

    #[test]
    fn a_sphere_of_a_scene_feels_hertz() {
        // 4/3 E* √R δ^3/2 with E* = E/(2 (1 − ν²)) and R of the sphere, as at any boundary.
        let modulus = 5e7 / (2.0 * (1.0 - 0.25 * 0.25));
        let mut dent = Coupled::new("ball");
        assert_eq!(dent.at(-0.09e-3), 0.0, "they are 0.1 mm apart");
        for overlap in [1e-6_f64, 5e-6] {
            let expected = 4.0 / 3.0 * modulus * 1e-3_f64.sqrt() * overlap * overlap.sqrt();
            dent.at(-0.1e-3 - overlap);
            // Dashpots are gone where nothing moves.
            assert_close(dent.at(-0.1e-3 - overlap), expected, 1e-9);
        }
    }

    #[test]
    fn what_a_scene_says_wrong_is_refused_in_its_words() {
        let radius = told(&SCENE.replace("radius = 2.0e-3 }", "radius = -2.0e-3 }"));
        assert!(radius.contains("[boundary.ball] ball.radius"), "{radius}");
        let key = told(&SCENE.replace("ball = {", "bal = {"));
        assert!(key.contains("the nearest is ball"), "the nearest name: {key}");
        let none = told(&SCENE.replace("ball = {", "# ball = {"));
        assert!(none.contains("mesh = { file } or ball = { centre, radius } gives its shape"), "{none}");
        let two = told(&SCENE.replace("ball = {", "plane = { point = [1, 0, 0], normal = [-1, 0, 0] }\nball = {"));
        assert!(two.contains("plane and ball"), "{two}");
    }
}
