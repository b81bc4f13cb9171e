//! Clumps: tops, pairs, beds.

use crate::support::start;
use cograin::simulation::Simulation;

/// A material and a law without friction and damping.
pub(super) const ELASTIC: &str = r#"
[material.a]
density = 2000.0
youngs_modulus = 1.0e9
poissons_ratio = 0.3
[pair.a.a]
restitution = 1.0
[contact.touch.normal.hertz]
"#;

/// Length of a difference.
pub(super) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Kinetic energy \[J\] and angular momentum about the origin \[kg m²/s\] of spheres that do not overlap.
pub(super) fn of_spheres(simulation: &Simulation) -> (f64, [f64; 3]) {
    let particles = &simulation.state().particles;
    let (mut energy, mut angular) = (0.0, [0.0; 3]);
    for (index, sphere) in simulation.scene().particles.iter().enumerate() {
        let slot = particles.slot[index] as usize;
        let (p, v, w) = (particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]);
        let (mass, inertia) = (sphere.mass(), sphere.inertia());
        let arm = [p[1] * v[2] - p[2] * v[1], p[2] * v[0] - p[0] * v[2], p[0] * v[1] - p[1] * v[0]];
        for axis in 0..3 {
            angular[axis] += mass * arm[axis] + inertia * w[axis];
            energy += 0.5 * mass * v[axis] * v[axis] + 0.5 * inertia * w[axis] * w[axis];
        }
    }
    (energy, angular)
}

/// A bed of pairs and triples that falls into a box, with loose spheres among them.
pub(super) fn bed(threads: usize, scale: f64, more: &str) -> String {
    let l = |length: f64| format!("{:?}", length * scale);
    format!(
        r#"
gravity = [0.0, 0.0, {}]
[run]
step = 1.0e-5
threads = {threads}
[material.a]
density = 2500.0
youngs_modulus = {:?}
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.5
friction = 0.4
rolling_friction = 0.05
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.epsd2]
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = {r} }}, {{ position = [{d}, 0.0, 0.0], radius = {r} }}]
[clump.bent]
spheres = [
    {{ position = [0.0, 0.0, 0.0], radius = {r} }},
    {{ position = [{d}, 0.0, 0.0], radius = {r} }},
    {{ position = [{d}, {d}, 0.0], radius = {s} }},
]
[particles.pairs]
material = "a"
clump = "pair"
orientation = "random"
velocity = [{}, {}, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {a}], counts = [9, 9, 8], radius = {b}, spacing = {c} }}
[particles.bent]
material = "a"
clump = "bent"
orientation = "random"
velocity = [0.0, 0.0, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {top}], counts = [9, 9, 3], radius = {b}, spacing = {c} }}
[particles.loose]
material = "a"
velocity = [0.0, 0.0, {}]
lattice = {{ kind = "simple_cubic", origin = [{a}, {a}, {higher}], counts = [9, 9, 1], radius = {r}, spacing = {c} }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
[boundary.west]
plane = {{ point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}
material = "a"
[boundary.east]
plane = {{ point = [{wide}, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}
material = "a"
[boundary.south]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }}
material = "a"
[boundary.north]
plane = {{ point = [0.0, {wide}, 0.0], normal = [0.0, -1.0, 0.0] }}
material = "a"
{more}
"#,
        l(-9.81),
        1e7 * scale * scale,
        l(0.5),
        l(0.3),
        l(-0.6),
        l(-1.0),
        l(-1.0),
        r = l(0.002),
        s = l(0.0015),
        d = l(0.003),
        a = l(0.005),
        b = l(0.0045),
        c = l(0.0095),
        top = l(0.082),
        higher = l(0.112),
        wide = l(0.086),
    )
}

/// A hash of the whole state.
pub(super) fn bits(simulation: &Simulation) -> u64 {
    simulation.state().fingerprint()
}

/// Where the first sphere of the body stands, and its mass centre.
pub(super) const START: [f64; 3] = [0.0, 0.0, 0.3];
/// Masses go as the cubes of 10, 8 and 12.
pub(super) const CENTRE: [f64; 3] =
    [0.3 * 512.0 / 3240.0, (0.1 * 512.0 + 0.5 * 1728.0) / 3240.0, 0.3 + 0.2 * 1728.0 / 3240.0];

/// A clump of three spheres of unequal size that no axis goes through.
pub(super) const TOP: &str = r#"
[clump.top]
spheres = [
    { position = [0.0, 0.0, 0.0], radius = 0.1 },
    { position = [0.3, 0.1, 0.0], radius = 0.08 },
    { position = [0.0, 0.5, 0.2], radius = 0.12 },
]
"#;

/// The first three numbers of a row.
pub(super) fn three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// A clump of two spheres, turned by an angle about y from x, just above a floor without friction.
pub(super) fn falling_pair(angle: f64, speed: f64) -> Simulation {
    let (w, y) = ((0.5 * angle).cos(), (0.5 * angle).sin());
    let height = 0.01 + 0.01 * angle.sin().abs() + 1e-9;
    start(&format!(
        r#"
[run]
step = 2.0e-8
{}
[clump.pair]
spheres = [{{ position = [-0.01, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.01, 0.0, 0.0], radius = 0.01 }}]
[particles.p]
material = "a"
clump = "pair"
list = [{{ position = [0.0, 0.0, {height:?}], orientation = [{w:?}, 0.0, {y:?}, 0.0], velocity = [0.0, 0.0, {:?}] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#,
        ELASTIC.replace("1.0e9", "1.0e11"),
        -speed
    ))
}

/// The same body falling onto a floor beside a loose sphere, as a clump or as a group.
pub(super) fn tumbling(as_clump: bool) -> Simulation {
    let body = if as_clump {
        format!(
            "{TOP}\n[particles.top]\nmaterial = \"a\"\nclump = \"top\"\nlist = [{{ position = {CENTRE:?}, \
             velocity = [0.4, 0.0, -1.0], angular_velocity = [2.0, -1.0, 3.0] }}]"
        )
    } else {
        let [x, y, z] = START;
        let sphere = |[a, b, c]: [f64; 3], radius: f64| {
            let place = [x + a, y + b, z + c];
            let arm = [place[0] - CENTRE[0], place[1] - CENTRE[1], place[2] - CENTRE[2]];
            let w = [2.0, -1.0, 3.0];
            let v = [
                0.4 + w[1] * arm[2] - w[2] * arm[1],
                w[2] * arm[0] - w[0] * arm[2],
                -1.0 + w[0] * arm[1] - w[1] * arm[0],
            ];
            format!("{{ position = {place:?}, radius = {radius:?}, velocity = {v:?}, angular_velocity = {w:?} }}")
        };
        format!(
            "[particles.top]\nmaterial = \"a\"\nlist = [{}, {}, {}]\n[boundary.top]\nparticles = {{ set = \"top\" }}\n\
             motion = {{ free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }}",
            sphere([0.0, 0.0, 0.0], 0.1),
            sphere([0.3, 0.1, 0.0], 0.08),
            sphere([0.0, 0.5, 0.2], 0.12),
        )
    };
    start(&format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
{}
[contact.touch.tangential.history]
{body}
[particles.z]
material = "a"
list = [{{ position = [0.55, 0.2, 0.10001], radius = 0.1 }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#,
        ELASTIC.replace("1.0e9", "1.0e7").replace("restitution = 1.0", "restitution = 1.0\nfriction = 0.3")
    ))
}
