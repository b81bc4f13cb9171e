//! Whole time steps of the common scenes: user CPU time of a contact (or bond) and step.
//!
//! `cargo bench --bench whole_step -- [SCENE] [--steps N] [--threads N] [--widths] [--parts] [--packing FILE.csv.gz] [--laws] [--copies N] [--turn N]
//! [--add FILE.toml]`
//!
//! `--laws` runs the dense packing with every contact law there is instead, or those whose names hold SCENE.
//! SCENE is part of a name below; without one all of them run. `--widths` repeats each in every lane width: the states
//! must be the same. `--copies` of a scene make a `--turn` of time steps one after the other: what many steps on a part of a large
//! scene, while it stays in the cache, can gain at the most. `--add` adds the tables of a file to each scene: a fluid, a grid. `--parts` prints what each part of a step takes. Peers on the same scenes: LIGGGHTS 49 ns (s1), 66 ns (s2), LAMMPS 136 ns a bond (s3).

use cograin::lanes::Width;
use cograin::scene::{Models, Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Large arrays begin at different places of a page, as in the program.
#[global_allocator]
static ALLOCATOR: cograin::memory::Staggered = cograin::memory::Staggered;

/// Scenes: name, and what they need beside the text of all.
const SCENES: [(&str, Kind); 8] = [
    ("s1", Kind::Dense { normal: "hertz", tangential: "history", rolling: "none", cohesion: "none" }),
    ("s2", Kind::Dense { normal: "hertz", tangential: "history", rolling: "cdt", cohesion: "sjkr" }),
    ("hertz_history_rolling", Kind::Dense { normal: "hertz", tangential: "history", rolling: "cdt", cohesion: "none" }),
    (
        "hooke_history",
        Kind::Dense { normal: "hooke_stiffness", tangential: "history", rolling: "none", cohesion: "none" },
    ),
    ("hertz_smooth", Kind::Dense { normal: "hertz", tangential: "none", rolling: "none", cohesion: "none" }),
    ("hooke_smooth", Kind::Dense { normal: "hooke_stiffness", tangential: "none", rolling: "none", cohesion: "none" }),
    ("s3_incremental", Kind::Bonded { formulation: "incremental" }),
    ("s3_finite_rotation", Kind::Bonded { formulation: "finite_rotation" }),
];

/// What a scene is made of.
#[derive(Clone, Copy)]
enum Kind {
    /// The dense packing at rest in six walls, with this contact law.
    Dense {
        /// Normal sub-model.
        normal: &'static str,
        /// Tangential sub-model.
        tangential: &'static str,
        /// Rolling sub-model.
        rolling: &'static str,
        /// Cohesion sub-model.
        cohesion: &'static str,
    },
    /// The bonded block of 10,000 spheres.
    Bonded {
        /// Formulation of the bonds.
        formulation: &'static str,
    },
}

/// Materials of all scenes.
const MATERIALS: &str = r#"
[material.grain]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
cohesion_energy_density = 5.0e3
fluid_viscosity = 1.0e-3
critical_stokes_number = 10.0
maximum_restitution = 0.9
"#;

/// Stiffness and damping of linear springs, then of springs that grow with the root of the overlap.
const SPRINGS: [&str; 2] = [
    "normal_stiffness = 4.0e3\ntangential_stiffness = 3.0e3\nnormal_damping = 100.0\ntangential_damping = 100.0\n",
    "normal_stiffness = 3.7e7\ntangential_stiffness = 3.0e7\nnormal_damping = 1.0e5\ntangential_damping = 1.0e5\n",
];

/// The dense packing: time step [s] of 10 % of Rayleigh's, in a box around it.
fn dense(packing: Vec<u8>, law: [&str; 4], threads: usize) -> Source {
    let width = box_width(&packing);
    let mut text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 1.54807158678598e-5\nend = 1.0\nthreads = {threads}\nmax_overlap = 0.5\n{MATERIALS}{}",
        SPRINGS[usize::from(law[0] == "hertz_stiffness")]
    );
    for (kind, model) in ["normal", "tangential", "rolling", "cohesion"].iter().zip(law) {
        if model != "none" {
            let _ = writeln!(text, "[contact.touch.{kind}.{model}]");
            if *kind == "normal" && matches!(model, "hooke" | "hooke_viscous") {
                text += "characteristic_velocity = 1.0\n";
            }
        }
    }
    text += "[particles.bed]\nmaterial = \"grain\"\nfile = \"bed.csv.gz\"\n";
    for (axis, end) in [("x", width), ("y", 0.2448), ("z", 0.4)] {
        for (name, place, sign) in [("low", 0.0, 1.0), ("high", end, -1.0)] {
            let [point, normal] = [place, sign].map(|n| ["x", "y", "z"].map(|a| if a == axis { n } else { 0.0 }));
            let _ = writeln!(text, "[boundary.{axis}_{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}");
            text += "material = \"grain\"\n";
        }
    }
    Source { name: "dense".into(), text, files: BTreeMap::from([("bed.csv.gz".into(), packing)]) }
}

/// Extent of the box along x [m]: the packing may be some copies side by side.
fn box_width(packing: &[u8]) -> f64 {
    let mut text = String::new();
    let mut reader = flate2::read::GzDecoder::new(packing);
    std::io::Read::read_to_string(&mut reader, &mut text).expect("the packing is text");
    let reach = |line: &str| {
        let numbers: Vec<f64> = line.split(',').filter_map(|part| part.parse().ok()).collect();
        numbers[1] + numbers[4]
    };
    let most = text.lines().skip(1).map(reach).fold(0.0, f64::max);
    (most / 0.2448).round().max(1.0) * 0.2448
}

/// 20 × 20 × 25 spheres in hexagonal close packing, the lowest layer held, a smooth motion at the start.
fn bonded(formulation: &str, threads: usize) -> Source {
    let spacing = 2.0 * 0.005 * 1.001;
    let height = spacing * (6.0_f64).sqrt() / 3.0 * 24.0;
    let mut rows = String::from("id,x,y,z,radius,vx,vy,vz\n");
    for place in 0..10_000_u32 {
        let (i, j, k) = (place % 20, place / 20 % 20, place / 400);
        let x = spacing * (f64::from(i) + 0.5 * f64::from((j + k) % 2));
        let y = spacing * 3.0_f64.sqrt() / 2.0 * (f64::from(j) + f64::from(k % 2) / 3.0);
        let z = spacing * 6.0_f64.sqrt() / 3.0 * f64::from(k);
        let s = if k == 0 { 0.0 } else { (0.5 * std::f64::consts::PI * z / height).sin() };
        let v = [0.005 * s, 0.002 * s * s, -0.0015 * s];
        let _ = writeln!(rows, "{},{x:?},{y:?},{z:?},0.005,{:?},{:?},{:?}", place + 1, v[0], v[1], v[2]);
    }
    let text = format!(
        r#"[run]
step = 2.0e-6
end = 1.0
threads = {threads}
{MATERIALS}{}
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "grain"
file = "block.csv"
[boundary.base]
particles = {{ set = "block", box = [[-1.0, -1.0, -0.001], [1.0, 1.0, 0.001]] }}
[bond.glue]
formulation = "{formulation}"
between = ["block", "block"]
create_distance = 0.0105
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
[bond.glue.breakage]
max_distance = 0.012
"#,
        SPRINGS[0]
    );
    Source { name: "bonded".into(), text, files: BTreeMap::from([("block.csv".into(), rows.into_bytes())]) }
}

/// User CPU time of this process \[s\].
fn user_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().nth(11)?.parse::<f64>().ok());
    ticks.unwrap_or(0.0) / 100.0
}

/// What the arguments say.
struct Options {
    /// Part of the names of the scenes to run.
    name: String,
    /// Time steps.
    steps: usize,
    /// Threads.
    threads: usize,
    /// Whether to run every lane width.
    widths: bool,
    /// Whether to print the parts of a step.
    parts: bool,
    /// Whether to run every contact law.
    laws: bool,
    /// The dense packing.
    packing: String,
    /// How often the scene is there.
    copies: usize,
    /// Time steps of a copy before the next one's turn; all if 0.
    turn: usize,
    /// Tables that are added to each scene.
    more: String,
}

impl Options {
    /// Reads the arguments.
    fn read() -> Self {
        let mut options = Self {
            name: String::new(),
            steps: 1000,
            threads: 1,
            widths: false,
            parts: false,
            laws: false,
            packing: "models/loaded_beam/dense_20k.csv.gz".into(),
            copies: 1,
            turn: 0,
            more: String::new(),
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().expect("a value follows");
            match argument.as_str() {
                "--bench" => {}
                "--steps" => options.steps = value().parse().expect("a number of steps"),
                "--threads" => options.threads = value().parse().expect("a number of threads"),
                "--widths" => options.widths = true,
                "--parts" => options.parts = true,
                "--laws" => options.laws = true,
                "--packing" => options.packing = value(),
                "--copies" => options.copies = value().parse().expect("a number of copies"),
                "--add" => options.more = std::fs::read_to_string(value()).expect("the tables can be read"),
                "--turn" => options.turn = value().parse().expect("a number of time steps"),
                name => options.name = name.into(),
            }
        }
        options
    }

    /// Runs one scene in one lane width and prints what it cost.
    #[allow(clippy::print_stdout, reason = "a benchmark prints")]
    fn run(&self, name: &str, scene: &Arc<Scene>, width: Width) {
        let mut simulations: Vec<_> = (0..self.copies)
            .map(|_| {
                let mut simulation = Simulation::new(scene.clone()).expect("the scene starts");
                simulation.set_width(width);
                simulation.advance(20.0 * simulation.state().clock.step).expect("it runs");
                simulation
            })
            .collect();
        let step = simulations[0].state().clock.step;
        let turn = if self.turn == 0 { self.steps } else { self.turn };
        let (wall, user) = (Instant::now(), user_time());
        for _ in 0..self.steps / turn {
            for simulation in &mut simulations {
                simulation.advance(turn as f64 * step).expect("it runs");
            }
        }
        let (wall, user) = (wall.elapsed().as_secs_f64(), user_time() - user);
        let mut simulation = simulations.swap_remove(0);
        let bonds: usize = simulation.state().bonds.iter().map(|list| list.first.len()).sum();
        let (count, what) = if bonds > 0 { (bonds, "bonds") } else { (simulation.contact_count(), "contacts") };
        let work = (self.steps / turn * turn * count * self.copies) as f64 * 1e-9;
        println!(
            "{name:40} {:6}: {:5.2} ns user, {:5.2} ns wall; {count} {what}, {} lists, state {:016x}, energy {:.6e} J",
            format!("{width:?}"),
            user / work,
            wall / work,
            simulation.state().clock.rebuilds,
            simulation.state().fingerprint(),
            simulation.kinetic_energy(),
        );
        if self.parts {
            self.watch(&mut simulation, work);
        }
    }

    /// Goes on with a clock beside it, and prints the wall time of each part of a step.
    #[allow(clippy::print_stdout, reason = "a benchmark prints")]
    fn watch(&self, simulation: &mut Simulation, work: f64) {
        let parts: Arc<Mutex<BTreeMap<&str, f64>>> = Arc::default();
        let (told, mut before) = (parts.clone(), Instant::now());
        simulation.watch(Box::new(move |part, _| {
            *told.lock().expect("one thread tells").entry(part).or_default() += before.elapsed().as_secs_f64();
            before = Instant::now();
        }));
        let step = simulation.state().clock.step;
        simulation.advance(self.steps as f64 * step).expect("it runs");
        for (part, seconds) in parts.lock().expect("nobody tells any more").iter() {
            println!("    {part:21} {:5.2} ns wall", seconds / work);
        }
    }
}

/// The dense packing with every contact law: name, and what it is made of.
fn every_law() -> Vec<(String, Kind)> {
    let mut laws = Vec::new();
    let models = Models::standard();
    for normal in models.normal_names() {
        for tangential in models.tangential_names() {
            for rolling in models.rolling_names() {
                for cohesion in models.cohesion_names() {
                    let name = [normal, tangential, rolling, cohesion].join(" ");
                    laws.push((name, Kind::Dense { normal, tangential, rolling, cohesion }));
                }
            }
        }
    }
    laws
}

fn main() {
    let options = Options::read();
    let named = || SCENES.map(|(name, kind)| (name.to_owned(), kind)).to_vec();
    let scenes = if options.laws { every_law() } else { named() };
    for (name, kind) in scenes.into_iter().filter(|(name, _)| name.contains(&options.name)) {
        let mut source = match kind {
            Kind::Dense { normal, tangential, rolling, cohesion } => {
                let packing = std::fs::read(&options.packing).expect("the packing can be read");
                dense(packing, [normal, tangential, rolling, cohesion], options.threads)
            }
            Kind::Bonded { formulation } => bonded(formulation, options.threads),
        };
        source.text += &options.more;
        let scene = Arc::new(Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")));
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            if options.widths || width == Width::widest() {
                options.run(&name, &scene, width);
            }
        }
    }
}
