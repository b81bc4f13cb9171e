//! Spheres cut by planes, in closed form.

use std::f64::consts::{FRAC_PI_2, PI};

/// Volume of the unit sphere.
pub(super) const UNIT: f64 = 4.0 / 3.0 * PI;

/// Volume of the part of the unit sphere where x > a, y > b and z > c. A plane of −1 or below cuts nothing off.
///
/// What is beyond a plane behind the centre, a < 0, is what no such plane cuts, less what is beyond its reflection, −a.
pub(super) fn beyond(planes: [f64; 3]) -> f64 {
    if planes.iter().any(|plane| *plane >= 1.0) {
        return 0.0;
    }
    let with = |axis: usize, plane: f64| {
        let mut planes = planes;
        planes[axis] = plane;
        planes
    };
    if let Some(axis) = planes.iter().position(|plane| -1.0 < *plane && *plane < 0.0) {
        return (beyond(with(axis, -1.0)) - beyond(with(axis, -planes[axis]))).max(0.0);
    }
    let cuts = |axis: &usize| planes[*axis] > -1.0;
    let (first, last) = ((0..3).find(cuts), (0..3).rfind(cuts));
    match (first, last, (0..3).find(|axis| !cuts(axis))) {
        (Some(first), Some(last), _) if first == last => between(planes[first], 1.0),
        (Some(_), Some(_), Some(whole)) => 2.0 * corner(with(whole, 0.0)),
        (Some(_), Some(_), None) => corner(planes),
        _ => UNIT,
    }
}

/// Volume of the part of a sphere of this radius in a box of this volume. The box is told by its lower and upper corner, seen from the
/// centre and over the radius. `beyond` gives what is [`beyond`] each corner, whose number has a bit for each upper face: with
/// alternating signs their sum is the part inside.
pub(super) fn in_box(
    [lower, upper]: [[f64; 3]; 2],
    (radius, volume): (f64, f64),
    beyond: impl Fn(usize) -> f64,
) -> f64 {
    let axes = 0..3;
    if axes.clone().any(|axis| lower[axis] >= 1.0 || upper[axis] <= -1.0) {
        return 0.0;
    }
    let cube = radius * radius * radius;
    if axes.clone().all(|axis| lower[axis] <= -1.0 && upper[axis] >= 1.0) {
        return UNIT * cube;
    }
    let farthest = axes.map(|axis| lower[axis].abs().max(upper[axis].abs()));
    if farthest.map(|distance| distance * distance).sum::<f64>() <= 1.0 {
        return volume;
    }
    let signed = |corner: usize| if corner.count_ones().is_multiple_of(2) { beyond(corner) } else { -beyond(corner) };
    ((0..8).map(signed).sum::<f64>() * cube).clamp(0.0, volume)
}

/// The same for planes that do not cut the centre off: a, b, c of 0 or above.
///
/// ```text
/// V   = (Ω − a A_a − b A_b − c A_c)/3                    divergence theorem: a part of the sphere and three faces
/// Ω   = π/2 − a φ_a − b φ_b − c φ_c − ψ_ab − ψ_bc − ψ_ca     Gauss–Bonnet: three arcs and three angles
/// A_a = ((1 − a²) φ_a − b (z − c) − c (y − b))/2         a face: an arc and two straight edges
/// φ_a = atan(z/b) − atan(c/y)                            angle of the arc in the face
/// ψ_ab = atan(a b/z)                                     by which the angle at the end of an edge is less than π/2
/// ```
///
/// | symbol | meaning | unit | from |
/// |---|---|---|---|
/// | a, b, c | where the planes x, y, z = const are, over the radius | 1 | `planes` |
/// | z | where the edge of planes a and b leaves the sphere: √(1 − a² − b²); x and y likewise | 1 | |
/// | Ω | area of the part of the sphere | 1 | |
///
/// The equation holds for a² + b² + c² < 1; beyond, the area is 0.
fn corner([a, b, c]: [f64; 3]) -> f64 {
    if a * a + b * b + c * c >= 1.0 {
        return 0.0;
    }
    let edge = |one: f64, other: f64| (1.0 - one * one - other * other).max(0.0).sqrt();
    let (x, y, z) = (edge(b, c), edge(c, a), edge(a, b));
    let arc =
        |[along, across]: [f64; 2], [first, second]: [f64; 2]| libm::atan2(across, first) - libm::atan2(second, along);
    let faces = [(a, [b, c], [y, z]), (b, [c, a], [z, x]), (c, [a, b], [x, y])];
    let (mut sphere, mut planes) = (FRAC_PI_2, 0.0);
    for (plane, [first, second], [along, across]) in faces {
        let turn = arc([along, across], [first, second]);
        let area = (1.0 - plane * plane) * turn - first * (across - second) - second * (along - first);
        sphere -= plane * turn;
        planes += 0.5 * plane * area;
    }
    sphere -= libm::atan2(a * b, z) + libm::atan2(b * c, x) + libm::atan2(c * a, y);
    ((sphere - planes) / 3.0).max(0.0)
}

/// Volume of the part of the unit sphere between two planes, z = `low` and z = `high`; the planes may be beyond it.
pub(super) fn between(low: f64, high: f64) -> f64 {
    let (low, high) = (low.clamp(-1.0, 1.0), high.clamp(-1.0, 1.0));
    PI * (high - low) * (1.0 - (high * high + high * low + low * low) / 3.0)
}
