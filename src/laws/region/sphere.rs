//! Spheres cut by planes, in closed form.

use std::f64::consts::{FRAC_PI_2, PI};

/// Volume of the unit sphere.
pub(super) const UNIT: f64 = 4.0 / 3.0 * PI;

/// Volume of the part of the unit sphere where x > a, y > b and z > c. A plane of −1 or below cuts nothing off.
///
/// A sphere that is cut at a < 0 is one that is not cut, which is twice the one that is cut at 0, less the one that is cut at −a.
pub(super) fn beyond(planes: [f64; 3]) -> f64 {
    if planes.iter().any(|plane| *plane >= 1.0) {
        return 0.0;
    }
    match planes.iter().position(|plane| *plane < 0.0) {
        Some(axis) => {
            let with = |plane: f64| {
                let mut planes = planes;
                planes[axis] = plane;
                beyond(planes)
            };
            2.0 * with(0.0) - with(-planes[axis])
        }
        None => corner(planes),
    }
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
