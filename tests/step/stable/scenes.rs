//! Blocks, chains and packings of spheres, their contacts and bonds.

use std::fmt::Write;

/// Where a sphere lies and how large it is \[m\].
pub(crate) type Sphere = [f64; 4];

/// A number between −1 and 1 that belongs to this one.
pub(crate) fn noise(seed: usize) -> f64 {
    let mixed = (seed as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((mixed ^ (mixed >> 32)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A scene of these spheres: those of `shell` are held, the others move a little.
pub(crate) fn block(spheres: &[Sphere], held: impl Fn(&Sphere) -> bool, more: &str) -> String {
    let mut lists = [String::new(), String::new()];
    for (index, sphere) in spheres.iter().enumerate() {
        let [x, y, z, radius] = sphere;
        let is_held = held(sphere);
        let [u, v, w, a, b, c] = [0, 1, 2, 3, 4, 5].map(|k| if is_held { 0.0 } else { 1e-11 * noise(6 * index + k) });
        let [a, b, c] = [a, b, c].map(|spin| 1e3 * spin);
        writeln!(
            lists[usize::from(is_held)],
            "{{ position = [{x:?}, {y:?}, {z:?}], radius = {radius:?}, velocity = [{u:?}, {v:?}, {w:?}], angular_velocity = [{a:?}, {b:?}, {c:?}] }},"
        )
        .unwrap();
    }
    let [free, shell] = lists;
    let shell = if shell.is_empty() {
        String::new()
    } else {
        format!(
            "[particles.shell]\nmaterial = \"a\"\nlist = [\n{shell}]\n[boundary.shell]\nparticles = {{ set = \"shell\" }}\n"
        )
    };
    format!(
        "[run]\nthreads = 1\nmax_overlap = 0.5\n[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e9\npoissons_ratio = 0.25\n\
         {more}\n[particles.core]\nmaterial = \"a\"\nlist = [\n{free}]\n{shell}"
    )
}

/// Spheres of radius 1 mm on a lattice of cubes with these points, nearest centres this far apart \[m\].
pub(crate) fn lattice(counts: usize, points: &[[f64; 3]], edge: f64) -> Vec<Sphere> {
    let mut spheres = Vec::new();
    for cell in 0..counts * counts * counts {
        let at = [cell % counts, cell / counts % counts, cell / counts / counts];
        for point in points {
            let [x, y, z] = [0, 1, 2].map(|axis| edge * (at[axis] as f64 + point[axis]));
            spheres.push([x, y, z, 1e-3]);
        }
    }
    spheres
}

/// Simple cubic, so many a side.
pub(crate) fn cubic(counts: usize, spacing: f64) -> Vec<Sphere> {
    lattice(counts, &[[0.0; 3]], spacing)
}

/// Face-centred cubic, so many cubes a side.
pub(crate) fn face_centred(counts: usize, spacing: f64) -> Vec<Sphere> {
    lattice(counts, &[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]], spacing * 2.0_f64.sqrt())
}

/// Hexagonal, so many a side.
pub(crate) fn hexagonal(counts: usize, spacing: f64) -> Vec<Sphere> {
    let place = |place: usize| {
        let [i, j, k] = [place % counts, place / counts % counts, place / counts / counts].map(|count| count as f64);
        let x = spacing * (i + 0.5 * ((j + k) % 2.0));
        let y = spacing * 3.0_f64.sqrt() / 2.0 * (j + k % 2.0 / 3.0);
        [x, y, spacing * (2.0_f64 / 3.0).sqrt() * k, 1e-3]
    };
    (0..counts * counts * counts).map(place).collect()
}

/// Those within a distance \[m\] of the faces of the box around all.
pub(crate) fn near_faces(spheres: &[Sphere], thickness: f64) -> impl Fn(&Sphere) -> bool + use<> {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| spheres.iter().map(|s| s[axis]).fold(start, pick);
    let low = [0, 1, 2].map(|axis| bound(axis, f64::min, f64::INFINITY));
    let high = [0, 1, 2].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
    move |sphere| (0..3).any(|axis| sphere[axis] < low[axis] + thickness || sphere[axis] > high[axis] - thickness)
}

/// Contacts of a law with friction enough to stick.
pub(crate) fn contacts(normal: &str, pair: &str) -> String {
    format!("[pair.a.a]\nfriction = 1e3\n{pair}\n[contact.c.normal.{normal}]\n[contact.c.tangential.history]\n")
}

/// Elastic Hertz contacts.
pub(crate) fn hertz() -> String {
    contacts("hertz", "restitution = 1.0")
}

/// Hertz contacts with dashpots of this ratio, at 1 of nine tenths of it.
pub(crate) fn damped_hertz(ratio: f64) -> String {
    // Dashpots of restitution e have √(5/6) β, where e = exp(−π β/√(1 − β²)).
    let beta = (ratio * 1.2_f64.sqrt()).min(0.999);
    let restitution = (-std::f64::consts::PI * beta / (1.0 - beta * beta).sqrt()).exp();
    contacts("hertz", &format!("restitution = {restitution:?}"))
}

/// Linear contacts with dashpots of this ratio between spheres of radius 1 mm.
pub(crate) fn damped_hooke(ratio: f64) -> String {
    let reduced = 0.5 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    let damping = 2.0 * ratio * (1e5 / reduced).sqrt();
    let pair = format!(
        "normal_stiffness = 1e5\ntangential_stiffness = 8e4\nnormal_damping = {damping:?}\ntangential_damping = {damping:?}"
    );
    contacts("hooke_stiffness", &pair)
}

/// Bonds.
pub(crate) fn bonds(more: &str) -> String {
    format!(
        "[bond.b]\nformulation = \"finite_rotation\"\nbetween = [\"core\", \"core\"]\ncreate_distance = 2.2e-3\n\
         normal_stiffness = 1e12\ntangential_stiffness = 4e11\n{more}"
    )
}

/// Dashpots of this damping ratio.
pub(crate) fn dashpots(ratio: f64) -> String {
    format!(
        "[bond.b.damping.viscous]\nnormal_force = {ratio:?}\ntangential_force = {ratio:?}\nnormal_torque = {ratio:?}\ntangential_torque = {ratio:?}\n"
    )
}

/// Nothing is held.
pub(crate) fn free(_: &Sphere) -> bool {
    false
}

/// A random packing of about so many spheres of radius 1 mm, give or take the square root of these sizes, pushed apart until they
/// overlap little; those that still lie deep in another one are left out.
pub(crate) fn packing(count: usize, sizes: f64) -> Vec<Sphere> {
    /// Rounds of pushing.
    const ROUNDS: usize = 300;
    let radius = |index: usize| 1e-3 * sizes.powf(-0.5 - 0.5 * noise(7919 * index + 11));
    let radii: Vec<f64> = (0..count).map(radius).collect();
    // Where spheres of these sizes just do not fit: every one ends up with several contacts.
    let volume: f64 = radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum();
    let edge = (volume / 0.68).cbrt();
    let mut spheres: Vec<Sphere> = (0..count)
        .map(|index| {
            let [x, y, z] = [0, 1, 2].map(|axis| 0.5 * edge * noise(3 * index + axis));
            [x, y, z, radii[index]]
        })
        .collect();
    for _ in 0..ROUNDS {
        for i in 0..count {
            let [_, _, _, r] = spheres[i];
            for axis in 0..3 {
                let most = (0.5 * edge - r).max(0.0);
                spheres[i][axis] = spheres[i][axis].clamp(-most, most);
            }
            for j in 0..i {
                push_apart(&mut spheres, i, j);
            }
        }
    }
    let mut left: Vec<Sphere> = Vec::new();
    for sphere in spheres {
        if left.iter().all(|other| overlap(&sphere, other) < 0.3 * sphere[3].min(other[3])) {
            left.push(sphere);
        }
    }
    left
}

/// How deep one sphere lies in another \[m\].
fn overlap(a: &Sphere, b: &Sphere) -> f64 {
    let square: f64 = (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum();
    a[3] + b[3] - square.sqrt()
}

/// Moves two spheres apart by a third of their overlap, the lighter one further.
fn push_apart(spheres: &mut [Sphere], i: usize, j: usize) {
    let (a, b) = (spheres[i], spheres[j]);
    let apart: [f64; 3] = std::array::from_fn(|axis| a[axis] - b[axis]);
    let distance = apart.iter().map(|part| part * part).sum::<f64>().sqrt();
    let overlap = a[3] + b[3] - distance;
    if overlap <= 0.0 || distance <= 0.0 {
        return;
    }
    let share = b[3].powi(3) / (a[3].powi(3) + b[3].powi(3));
    for axis in 0..3 {
        let way = 0.3 * overlap * apart[axis] / distance;
        spheres[i][axis] += share * way;
        spheres[j][axis] -= (1.0 - share) * way;
    }
}
