//! Parts of scenes that tests of several subjects write.

use std::fmt::Write as _;

/// A triangle.
pub(crate) type Triangle = [[f64; 3]; 3];

/// The material `glass` of this Young's modulus \[Pa\] and Poisson's ratio ¼, with these properties of a pair.
pub(crate) fn glass(modulus: f64, pair: &str) -> String {
    format!(
        "[material.glass]\nyoungs_modulus = {modulus:e}\npoissons_ratio = 0.25\ndensity = 2500.0\n[pair.glass.glass]\n{pair}\n"
    )
}

/// Contacts by Hertz, with friction that remembers.
pub(crate) const HERTZ_AND_FRICTION: &str = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n";

/// A set of spheres of glass: place, radius and velocity of each.
pub(crate) fn spheres(list: &[([f64; 3], f64, [f64; 3])]) -> String {
    let mut text = "[particles.all]\nmaterial = \"glass\"\nlist = [\n".to_owned();
    for (position, radius, velocity) in list {
        let _ = writeln!(text, "{{ position = {position:?}, radius = {radius:?}, velocity = {velocity:?} }},");
    }
    text + "]\n"
}

/// A cell with these edges.
pub(crate) fn cell(edges: [[f64; 3]; 3], more: &str) -> String {
    format!("[cell]\nedges = {edges:?}\n{more}\n")
}

/// All components of the strain of a cell follow inputs.
pub(crate) const DRIVEN: &str = "motion = { driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }";

/// Triangles as an OBJ file, each with corners of its own, which are welded.
pub(crate) fn obj(triangles: &[Triangle]) -> Vec<u8> {
    let vertex = |[x, y, z]: &[f64; 3]| format!("v {x:.17e} {y:.17e} {z:.17e}\n");
    let face = |number: usize| format!("f {} {} {}\n", 3 * number + 1, 3 * number + 2, 3 * number + 3);
    let corners: String = triangles.iter().flatten().map(vertex).collect();
    (corners + &(0..triangles.len()).map(face).collect::<String>()).into_bytes()
}

/// Numbers from 0 to 1, the same each time.
pub(crate) fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}
