//! Spheres in a cell that leans.

use crate::support::{HERTZ_AND_FRICTION, glass, read};
use cograin::simulation::Simulation;
use std::fmt::Write as _;

/// Edges of a cell that leans.
pub(super) const LEANING: [[f64; 3]; 3] = [[0.05, 0.0, 0.0], [0.01, 0.04, 0.0], [-0.012, 0.006, 0.045]];

/// A scene of spheres in a cell that leans, with these further lines.
pub(super) fn scene(list: &[([f64; 3], f64, [f64; 3])], rest: &str) -> String {
    let glass = glass(1e7, "restitution = 0.7\nfriction = 0.3");
    let mut text = format!(
        "[run]\nstep = 1e-5\nend = 1.0\nmax_overlap = 0.3\n{glass}{HERTZ_AND_FRICTION}[output]\nenergy = true\nlosses = true\n"
    );
    if !list.is_empty() {
        text += &crate::support::spheres(list);
    }
    let _ = write!(text, "{rest}\n[cell]\norigin = [0.01, -0.02, 0.0]\n");
    if !rest.contains("edges_of_file") { text + &format!("edges = {LEANING:?}\n") } else { text }
}

/// The vector to one of the particles from the nearest image of another.
pub(super) fn nearest(a: [f64; 3], b: [f64; 3], periodic: [bool; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for shift in 0..7 * 7 * 7 {
        let shift = [shift % 7 - 3, shift / 7 % 7 - 3, shift / 49 - 3];
        if (0..3).any(|edge| shift[edge] != 0 && !periodic[edge]) {
            continue;
        }
        let apart = [0, 1, 2].map(|axis: usize| {
            a[axis] - b[axis] + (0..3).map(|edge| f64::from(shift[edge]) * LEANING[edge][axis]).sum::<f64>()
        });
        least = least.min(apart.iter().map(|part| part * part).sum::<f64>().sqrt());
    }
    least
}

/// Places, radii and velocities of the particles.
pub(super) fn spheres(simulation: &Simulation) -> Vec<([f64; 3], f64, [f64; 3])> {
    let particles = &simulation.state().particles;
    let rows = particles.slots().map(|slot| (particles.position[slot], particles.velocity[slot]));
    rows.map(|([x, y, z, radius], [u, v, w, _])| ([x, y, z], radius, [u, v, w])).collect()
}

/// The least gap between two spheres, images included, over the smaller radius.
pub(super) fn least_gap(spheres: &[([f64; 3], f64)], periodic: [bool; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for (index, (a, r)) in spheres.iter().enumerate() {
        for (b, s) in &spheres[..index] {
            least = least.min((nearest(*a, *b, periodic) - r - s) / r.min(*s));
        }
    }
    least
}

/// A packing that fills the cell.
pub(super) fn packed(more: &str) -> String {
    scene(&[], &format!("[particles.all]\nmaterial = \"glass\"\npacking = {{ {more} }}\n"))
}

/// Spheres on both sides of the faces that press on each other.
pub(super) fn dense() -> Vec<([f64; 3], f64, [f64; 3])> {
    let text = packed("solid_fraction = 0.55, radius = [0.003, 0.004]");
    let particles = read(&text).unwrap().into_draft().particles;
    let wave = |part: f64| (1e3 * part).sin();
    let larger = |particle: &cograin::scene::Particle| {
        let [x, y, z] = particle.position;
        (particle.position, 1.04 * particle.radius, [wave(x), wave(y + z), wave(z - x)])
    };
    particles.iter().map(larger).collect()
}
