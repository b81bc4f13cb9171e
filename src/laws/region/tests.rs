//! Volumes and lengths against theory and against integrals taken with 30 digits.

use super::sphere::{UNIT, beyond};
use super::{Cuboid, Cylinder, Region};
use crate::base::number::Vector;
use std::f64::consts::PI;

/// A box.
fn cuboid(lower: [f64; 3], upper: [f64; 3]) -> Region {
    Region::Box(Cuboid { corners: [lower, upper] })
}

/// A cylinder.
fn cylinder(from: [f64; 3], to: [f64; 3], radius: f64) -> Region {
    Region::Cylinder(Cylinder::new(from, to, radius).expect("it has a length"))
}

/// A point.
fn point(x: f64, y: f64, z: f64) -> Vector {
    Vector::new(x, y, z)
}

/// Whether two volumes agree to so much of a sphere.
#[track_caller]
fn agree(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() <= error * UNIT, "{found:?}, {expected:?} expected");
}

#[test]
fn a_plane_cuts_off_a_cap() {
    for height in [-0.99, -0.4, 0.0, 1e-9, 0.3, 0.999] {
        // π h² (3 − h)/3, of height h = 1 − c.
        let cap = PI * (1.0_f64 - height).powi(2) * (2.0 + height) / 3.0;
        agree(beyond([-2.0, -1.0, height]), cap, 1e-15);
        agree(beyond([height, -3.0, -1.0]), cap, 1e-15);
    }
}

#[test]
fn planes_through_the_centre_halve() {
    agree(beyond([0.0, -1.0, -1.0]), UNIT / 2.0, 1e-15);
    agree(beyond([0.0, 0.0, -1.0]), UNIT / 4.0, 1e-15);
    agree(beyond([0.0, 0.0, 0.0]), UNIT / 8.0, 1e-15);
    agree(beyond([0.0, 0.0, 0.25]), PI * 0.5625 * 2.25 / 12.0, 1e-15);
}

#[test]
fn edges_and_corners_cut_as_integrals_say() {
    // ∫ of the area beyond x = a, y = b from z = c on, tanh-sinh with 30 digits between the places where it is not smooth.
    let integrals = [
        ([0.3, 0.5, -2.0], 0.152_345_774_168_150_46),
        ([-0.3, 0.5, -2.0], 0.502_152_695_329_723_2),
        ([-0.3, -0.5, -2.0], 2.506_445_869_258_102),
        ([0.6, 0.79, -2.0], 8.879_158_032_950_65e-6),
        ([0.2, 0.3, 0.4], 0.069_436_398_976_012_31),
        ([-0.2, 0.5, 0.1], 0.183_284_434_065_004_33),
        ([-0.3, -0.4, -0.5], 1.911_045_326_767_398_6),
        ([-0.6, 0.3, -0.7], 1.042_725_348_087_817_1),
        ([0.57, 0.57, 0.57], 1.770_182_758_492_783_8e-6),
        ([-0.9, -0.8, -0.95], 4.033_412_268_127_596),
    ];
    for (planes, expected) in integrals {
        agree(beyond(planes), expected, 1e-15);
        // A box far larger than the sphere, one of whose corners is there; in any order of the axes.
        let [a, b, c] = planes;
        for [a, b, c] in [[a, b, c], [b, c, a], [c, b, a]] {
            let (centre, radius) = (point(5.0, -7.0, 11.0), 0.25);
            let corner = [5.0 + a * radius, -7.0 + b * radius, 11.0 + c * radius];
            let found = cuboid(corner, [50.0; 3]).volume_of_sphere(centre, radius);
            // Coordinates of about 10 are rounded to 1e-15, 4e-15 of the radius.
            agree(found / radius.powi(3), expected, 1e-14);
        }
    }
}

#[test]
fn a_sphere_that_bulges_from_each_face_loses_six_caps() {
    let found = cuboid([-0.9; 3], [0.9; 3]).volume_of_sphere(Vector::zero(), 1.0);
    agree(found, UNIT - 6.0 * PI * 0.01 * 2.9 / 3.0, 1e-15);
}

#[test]
fn a_region_inside_of_a_sphere_is_filled() {
    let small = cuboid([0.1, 0.2, 0.3], [0.1001, 0.2002, 0.3003]);
    assert_eq!(small.volume_of_sphere(Vector::zero(), 1.0), small.volume());
    let rod = cylinder([0.1, 0.2, -0.1], [0.1, 0.2, 0.1], 0.05);
    agree(rod.volume_of_sphere(Vector::zero(), 1.0), rod.volume(), 1e-14);
}

#[test]
fn parts_of_a_sphere_in_boxes_side_by_side_add_up() {
    let cuts = [-2.0, -0.7, -0.1, 0.45, 0.8, 2.0];
    let (mut sum, mut parts) = (0.0, 0);
    for x in cuts.windows(2) {
        for y in cuts.windows(2) {
            for z in cuts.windows(2) {
                let part = cuboid([x[0], y[0], z[0]], [x[1], y[1], z[1]]).volume_of_sphere(Vector::zero(), 1.0);
                parts += usize::from(part > 0.0);
                sum += part;
            }
        }
    }
    agree(sum, UNIT, 1e-14);
    assert!(parts > 50, "{parts} parts");
}

#[test]
fn a_cylinder_through_the_centre_drills_a_hole() {
    for radius in [0.05_f64, 0.5, 0.999] {
        let hole = cylinder([0.0, -3.0, 0.0], [0.0, 5.0, 0.0], radius);
        // What is left of the sphere is 4/3 π (1 − R²)^(3/2).
        let expected = UNIT * (1.0 - (1.0 - radius * radius).powf(1.5));
        agree(hole.volume_of_sphere(Vector::zero(), 1.0), expected, 1e-13);
    }
}

#[test]
fn a_cylinder_beside_the_centre_cuts_as_integrals_say() {
    // ∫ of the area that both discs have in common, tanh-sinh or Gauss–Legendre with 30 digits.
    let integrals = [
        ([-2.0, 2.0, 0.5, 0.3], 1.383_065_649_150_095_7),
        ([-2.0, 0.3, 0.5, 0.8], 0.510_895_972_553_200_7),
        ([-0.2, 0.3, 3.0, 2.5], 1.199_657_614_711_932_2),
        ([-2.0, 2.0, 1000.0, 999.7], 3.008_273_297_285_130_3),
        ([-2.0, 2.0, 2.0, 2.9], 0.025_024_045_153_279_252),
        ([-2.0, 2.0, 0.1, 0.9], 0.026_001_478_391_045_85),
        ([-0.1, 2.0, 0.5, 0.5], 0.681_276_245_287_235_8),
    ];
    for ([low, high, radius, distance], expected) in integrals {
        let upright = cylinder([distance, 0.0, low], [distance, 0.0, high], radius);
        // An axis 1000 radii away is rounded to 1e-13 of a radius.
        let rounding = f64::EPSILON * radius.max(1.0);
        agree(upright.volume_of_sphere(Vector::zero(), 1.0), expected, 1e-13 + rounding);
        // The same askew: along (2, 3, 6)/7, away along (3, −6, 2)/7.
        let at = |height: f64| [[3.0, 2.0], [-6.0, 3.0], [2.0, 6.0]].map(|[a, h]| (a * distance + h * height) / 7.0);
        let askew = cylinder(at(low), at(high), radius);
        agree(askew.volume_of_sphere(Vector::zero(), 1.0), expected, 1e-13 + 4.0 * rounding);
    }
}

#[test]
fn a_large_cylinder_cuts_as_a_plane() {
    // The mantle of radius 10⁷ is a plane to 10⁻⁷.
    let found = cylinder([0.0, 0.3 - 1e7, -5.0], [0.0, 0.3 - 1e7, 5.0], 1e7).volume_of_sphere(Vector::zero(), 1.0);
    agree(found, UNIT - beyond([0.3, -1.0, -1.0]), 1e-7);
}

#[test]
fn a_line_is_inside_from_where_it_enters_to_where_it_leaves() {
    let region = cuboid([0.0; 3], [1.0, 2.0, 3.0]);
    let share = |from: Vector, to: Vector| region.share_of_line(from, to);
    assert_eq!(share(point(0.2, 0.2, 0.2), point(0.8, 1.8, 2.8)), 1.0);
    assert_eq!(share(point(-1.0, 1.0, 1.0), point(1.0, 1.0, 1.0)), 0.5);
    assert_eq!(share(point(0.5, 1.0, -1.0), point(0.5, 1.0, 7.0)), 3.0 / 8.0);
    assert_eq!(share(point(-1.0, 1.0, 1.0), point(-0.5, 1.0, 1.0)), 0.0);
    assert_eq!(share(point(-1.0, 0.5, 1.0), point(0.5, -1.0, 1.0)), 0.0);
    assert_eq!(share(point(0.5, 0.5, 0.5), point(0.5, 0.5, 0.5)), 1.0);
}

#[test]
fn a_line_through_a_cylinder_is_inside_between_its_mantle_and_its_ends() {
    let region = cylinder([0.0, 0.0, 0.0], [0.0, 0.0, 2.0], 1.0);
    // Numbers of about 1.
    let share = |from: Vector, to: Vector| (region.share_of_line(from, to) * 1e15).round() / 1e15;
    assert_eq!(share(point(-2.0, 0.0, 1.0), point(2.0, 0.0, 1.0)), 0.5);
    assert_eq!(share(point(-2.0, 0.6, 1.0), point(2.0, 0.6, 1.0)), 0.4);
    assert_eq!(share(point(0.0, 0.0, 1.0), point(0.0, 0.0, 5.0)), 0.25);
    assert_eq!(share(point(0.0, 1.5, 1.0), point(0.0, 1.5, 5.0)), 0.0);
    assert_eq!(share(point(-2.0, 1.5, 1.0), point(2.0, 1.5, 1.0)), 0.0);
    // From the axis at half height up and out: it leaves by the upper end at 1/2, by the mantle at 1/4.
    assert_eq!(share(point(0.0, 0.0, 1.0), point(4.0, 0.0, 3.0)), 0.25);
}

#[test]
fn a_point_in_a_common_face_is_in_one_of_two_boxes() {
    let [lower, upper] = [0.0, 1.0].map(|low| cuboid([0.0, 0.0, low], [1.0, 1.0, low + 1.0]));
    let in_the_face = point(0.5, 0.0, 1.0);
    assert!(!lower.holds(in_the_face) && upper.holds(in_the_face));
    let share = |region: &Region| region.share_of_line(in_the_face, point(1.5, 0.0, 1.0));
    assert_eq!([share(&lower), share(&upper)], [0.0, 0.5]);
    assert!(!upper.holds(point(1.0, 0.0, 1.5)));
    let region = cylinder([0.0; 3], [0.0, 0.0, 2.0], 1.0);
    assert!(region.holds(point(0.0, -1.0, 0.0)) && !region.holds(point(0.0, -1.0, 2.0)));
    assert!(!region.holds(point(0.8, 0.8, 1.0)));
}
