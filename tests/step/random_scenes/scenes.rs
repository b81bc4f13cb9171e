//! Random scenes: laws, sizes, boundaries, bonds, gravity.

use std::fmt::Write;

/// Edge of the box \[m\].
const EDGE: f64 = 0.01;

/// Numbers that follow from a seed (SplitMix64: G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014).
pub(crate) struct Numbers(u64);

impl Numbers {
    /// Those of a seed.
    pub(crate) fn of(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xD1B5_4A32_D192_ED03))
    }

    /// The next one, between 0 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two numbers.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Between two numbers, their logarithm evenly spread.
    fn spread(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    /// One of these.
    fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[((self.next() * of.len() as f64) as usize).min(of.len() - 1)]
    }
}

/// A scene: its file, and how fast its lid is driven \[m/s\], if it is.
pub(crate) struct Random {
    /// What a user would write; `SAFETY` stands for the part of the stable step.
    pub(crate) text: String,
    /// What it is, in a few words.
    pub(crate) name: String,
    /// Speed of the driven lid \[m/s\].
    pub(crate) driven: Option<f64>,
}

/// The contact law, and its name.
fn law(numbers: &mut Numbers) -> (String, String) {
    let normal = numbers.one(&["hertz", "hertz", "hooke", "jkr", "eepa"]);
    let tangential = numbers.one(&["none", "history", "history", "no_history", "turned_history"]);
    let rolling = numbers.one(&["none", "none", "epsd", "cdt"]);
    // A constant torque by the overlap has no meaning beyond touch.
    let rolling = if normal == "jkr" && rolling == "cdt" { "epsd" } else { rolling };
    let cohesion = if normal == "hertz" { numbers.one(&["none", "none", "sjkr"]) } else { "none" };
    let limit = numbers.one(&["false", "true"]);
    let mut pair = String::from("[pair.a.a]\n");
    let mut set = |key: &str, value: f64| writeln!(pair, "{key} = {value:?}").unwrap();
    let mut keys = String::new();
    match normal {
        "jkr" => {
            set("surface_energy", numbers.spread(0.01, 0.3));
            set("damping_coefficient", numbers.between(0.0, 0.5));
            if tangential != "none" {
                set("tangential_damping_ratio", 1.0);
            }
        }
        "eepa" => {
            set("restitution", numbers.between(0.3, 1.0));
            set("unloading_stiffness_ratio", numbers.between(1.0, 4.0));
            set("pull_off_force", numbers.spread(1e-7, 1e-5));
            set("adhesion_stiffness_ratio", numbers.between(0.0, 0.5));
            keys.push_str("overlap_exponent = 1.0\nadhesion_exponent = 1.0\nadhesion = \"fixed\"\n");
        }
        _ => set("restitution", numbers.between(0.1, 1.0)),
    }
    if normal == "hooke" {
        keys.push_str("characteristic_velocity = 0.5\n");
    }
    if tangential != "none" {
        set("friction", numbers.between(0.05, 1.0));
    }
    if rolling != "none" {
        set("rolling_friction", numbers.spread(0.003, 0.1));
    }
    if rolling == "epsd" {
        set("rolling_viscous_damping", numbers.between(0.0, 0.5));
    }
    if cohesion == "sjkr" {
        set("cohesion_energy_density", numbers.spread(1e3, 1e5));
    }
    let limit = if normal == "jkr" || normal == "eepa" { "" } else { limit };
    let limit = if limit == "true" { "limit_force = true\n" } else { "" };
    let text = format!(
        "{pair}[contact.c]\n{limit}[contact.c.normal.{normal}]\n{keys}[contact.c.tangential.{tangential}]\n\
         [contact.c.rolling.{rolling}]\n[contact.c.cohesion.{cohesion}]\n"
    );
    (text, format!("{normal} {tangential} {rolling} {cohesion}"))
}

/// Spheres that do not touch yet, in pairs that nearly do: centre, radius, velocity.
fn spheres(numbers: &mut Numbers, sizes: f64) -> Vec<[f64; 7]> {
    let (count, largest) = (numbers.between(8.0, 20.0) as usize, 1.2e-3);
    let mut spheres: Vec<[f64; 7]> = Vec::new();
    let mut tries = 0;
    while spheres.len() < 2 * count && tries < 4000 {
        tries += 1;
        let radius = largest * numbers.spread(1.0 / sizes, 1.0);
        let partner = radius * numbers.spread((1.0 / sizes).max(0.5), 1.0);
        let center = [0, 1, 2].map(|_| numbers.between(2.5 * largest, EDGE - 2.5 * largest));
        let velocity = [0, 1, 2].map(|_| numbers.between(-0.6, 0.6));
        let (height, angle) = (numbers.between(-1.0, 1.0), numbers.between(0.0, std::f64::consts::TAU));
        let across = (1.0 - height * height).sqrt();
        let direction = [across * angle.cos(), across * angle.sin(), height];
        let apart = 1.002 * (radius + partner);
        let other = [0, 1, 2].map(|axis| center[axis] + apart * direction[axis]);
        let new = [(center, radius), (other, partner)].map(|([x, y, z], r)| {
            let [u, v, w] = velocity;
            [x, y, z, r, u, v, w]
        });
        let clear = |a: &[f64; 7]| {
            let inside = a[..3].iter().all(|x| (a[3]..EDGE - a[3]).contains(x));
            let apart =
                |b: &[f64; 7]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt() > 1.001 * (a[3] + b[3]);
            inside && spheres.iter().all(apart)
        };
        if new.iter().all(clear) {
            spheres.extend(new);
        }
    }
    spheres
}

/// Walls, and how fast the lid is driven \[m/s\].
fn walls(numbers: &mut Numbers) -> (String, Option<f64>, &'static str) {
    let lid = numbers.one(&["fixed", "prescribed", "driven", "sine", "trapezoid"]);
    let speed = numbers.between(0.05, 0.6);
    let motion = match lid {
        "prescribed" => format!("motion = {{ prescribed = {{ z = {:?} }} }}\n", -speed),
        "driven" => "motion = { driven = [\"z\"] }\n".to_owned(),
        "sine" => format!(
            "motion = {{ prescribed = {{ z = {{ sine = {{ amplitude = {:?}, frequency = 300.0 }} }} }} }}\n",
            speed / (600.0 * std::f64::consts::PI)
        ),
        "trapezoid" => format!(
            "motion = {{ prescribed = {{ z = {{ trapezoid = {{ distance = -1.5e-3, speed = {speed:?}, acceleration = 1e4, start = 1e-3 }} }} }} }}\n"
        ),
        _ => String::new(),
    };
    let mut text = String::new();
    for (name, point, normal) in [
        ("west", [0.0; 3], [1.0, 0.0, 0.0]),
        ("east", [EDGE, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ("south", [0.0; 3], [0.0, 1.0, 0.0]),
        ("north", [0.0, EDGE, 0.0], [0.0, -1.0, 0.0]),
        ("floor", [0.0; 3], [0.0, 0.0, 1.0]),
        ("lid", [0.0, 0.0, EDGE], [0.0, 0.0, -1.0]),
    ] {
        let motion = if name == "lid" { motion.as_str() } else { "" };
        writeln!(
            text,
            "[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"a\"\n{motion}"
        )
        .unwrap();
    }
    (text, (lid == "driven").then_some(-speed), lid)
}

/// Bonds between spheres that nearly touch.
fn bonds(numbers: &mut Numbers, spheres: &[[f64; 7]]) -> (String, &'static str) {
    let when = numbers.one(&["none", "none", "start", "always", "time"]);
    if when == "none" {
        return (String::new(), when);
    }
    let apart = |pair: &[[f64; 7]]| 1.002 * (pair[0][3] + pair[1][3]);
    let distance = 1.01 * spheres.chunks(2).map(apart).fold(f64::INFINITY, f64::min).max(1e-3);
    let damping = numbers.one(&["", "viscous", "opposing"]);
    let damping = match damping {
        "viscous" => {
            let ratio = numbers.spread(0.05, 3.0);
            format!("[bond.b.damping.viscous]\nnormal_force = {ratio:?}\ntangential_force = {ratio:?}\n")
        }
        "opposing" => format!("[bond.b.damping.opposing]\nnormal_force = {:?}\n", numbers.between(0.05, 0.5)),
        _ => String::new(),
    };
    let stiffness = numbers.spread(1e9, 1e11);
    let formulation = numbers.one(&["finite_rotation", "incremental"]);
    let create = if when == "time" { "{ time = 1e-3 }".to_owned() } else { format!("\"{when}\"") };
    let text = format!(
        "[bond.b]\nformulation = \"{formulation}\"\nbetween = [\"p\", \"p\"]\ncreate_distance = {distance:?}\n\
         create = {create}\nnormal_stiffness = {stiffness:?}\ntangential_stiffness = {:?}\n{damping}",
        0.4 * stiffness
    );
    (text, when)
}

/// By how much velocities stray at most in members of an ensemble, over themselves: far less than what the comparison allows.
const STRAY: f64 = 1e-3;

/// Lets each pair of spheres begin a little faster or slower, and in another direction.
fn stray(spheres: &mut [[f64; 7]], seed: u64, member: u64) {
    let mut numbers = Numbers::of(seed.wrapping_add(member << 32));
    for pair in spheres.chunks_mut(2) {
        for axis in 4..7 {
            let factor = 1.0 + numbers.between(-STRAY, STRAY);
            pair.iter_mut().for_each(|sphere| sphere[axis] *= factor);
        }
    }
}

/// The scene of a seed: that itself (member 0), or one that begins a little otherwise.
pub(crate) fn random(seed: u64, member: u64) -> Random {
    let mut numbers = Numbers::of(seed);
    let (law, law_name) = law(&mut numbers);
    let sizes = numbers.spread(1.0, 10.0);
    let mut spheres = spheres(&mut numbers, sizes);
    if member > 0 {
        stray(&mut spheres, seed, member);
    }
    let (walls, driven, lid) = walls(&mut numbers);
    let (bonds, when) = bonds(&mut numbers, &spheres);
    let gravity = numbers.one(&["0.0", "-9.81"]);
    let group = numbers.one(&["no", "yes"]);
    let modulus = numbers.spread(1e6, 1e8);
    let list = |which: &mut dyn Iterator<Item = &[f64; 7]>| {
        which.fold(String::new(), |mut list, [x, y, z, r, u, v, w]| {
            writeln!(list, "{{ position = [{x:?}, {y:?}, {z:?}], radius = {r:?}, velocity = [{u:?}, {v:?}, {w:?}] }},")
                .unwrap();
            list
        })
    };
    // The first two spheres move as one body, if there is a group.
    let grouped = if group == "yes" && when != "start" { 2 } else { 0 };
    let mut text = format!(
        "gravity = [0.0, 0.0, {gravity}]\n[run]\nthreads = 1\nSAFETY\n[material.a]\ndensity = 2500.0\n\
         youngs_modulus = {modulus:?}\npoissons_ratio = 0.3\n{law}{bonds}[particles.p]\nmaterial = \"a\"\nlist = [\n{}]\n",
        list(&mut spheres.iter().skip(grouped))
    );
    if grouped > 0 {
        write!(
            text,
            "[particles.g]\nmaterial = \"a\"\nlist = [\n{}]\n[boundary.body]\nparticles = {{ set = \"g\" }}\n\
             motion = {{ free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }}\n",
            list(&mut spheres.iter().take(grouped))
        )
        .unwrap();
    }
    text.push_str(&walls);
    let name = format!("1:{sizes:.1} {law_name}, lid {lid}, bonds {when}, gravity {gravity}, group {group}");
    Random { text, name, driven }
}
