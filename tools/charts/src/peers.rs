//! Other programs, where they are installed: their points beside our own.
//!
//! An impact without friction depends on restitution and on the number of time steps in the contact alone, so these spheres may
//! be softer and slower than ours: LIGGGHTS takes no moduli above 1e9 Pa.

use crate::block;
use cograin_chart::ChartError;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Density \[kg/m³\], Young's modulus \[Pa\], Poisson's ratio, radius \[m\], speed \[m/s\] of the spheres that rebound.
const SPHERE: [f64; 5] = [4000.0, 1e8, 0.23, 0.0025, 0.39];

/// Moments within a time step at which contacts begin.
const PHASES: u32 = 16;

/// Time steps of the block before those that are timed, these, and how often they are: the quickest counts.
const TIMED: [u32; 3] = [20, 200, 3];

/// The peers.
pub(crate) const PEERS: [Peer; 2] = [
    Peer { name: "LIGGGHTS", program: "liggghts", write: liggghts },
    Peer { name: "LAMMPS", program: "lmp", write: lammps },
];

/// Another program.
pub(crate) struct Peer {
    /// Its name.
    pub name: &'static str,
    /// What it is called by.
    program: &'static str,
    /// Its input: all but `run` and what is written.
    write: fn(&Sample) -> String,
}

/// What a peer computes.
struct Sample<'a> {
    /// Name of the normal model: `hertz` or `hooke`.
    model: &'a str,
    /// Density \[kg/m³\], Young's modulus \[Pa\], Poisson's ratio, radius \[m\], speed \[m/s\].
    sphere: [f64; 5],
    /// Coefficients of restitution and of friction.
    coefficients: [f64; 2],
    /// Velocity of all spheres along z \[m/s\].
    velocity: f64,
    /// Planes: across which axis, where \[m\], whether the spheres are above.
    planes: &'a [(usize, f64, bool)],
    /// The time step \[s\].
    step: f64,
}

impl Sample<'_> {
    /// Stiffness of the spring of `hooke` at a plane: what Hertz's contact stores at its largest overlap \[N/m\].
    fn stiffness(&self) -> f64 {
        let duration = duration("hooke", self.sphere);
        mass(self.sphere) * (PI / duration) * (PI / duration)
    }
}

/// Mass of a sphere \[kg\].
fn mass([density, _, _, radius, _]: [f64; 5]) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius * density
}

/// Duration of an elastic contact with a plane of the same material \[s\].
fn duration(model: &str, sphere: [f64; 5]) -> f64 {
    let [_, modulus, ratio, radius, speed] = sphere;
    let (effective, root) = (modulus / (2.0 * (1.0 - ratio * ratio)), radius.sqrt());
    let deepest = libm::pow(15.0 * mass(sphere) * speed * speed / (16.0 * effective * root), 0.4);
    match model {
        "hertz" => 2.943_28 * deepest / speed,
        _ => PI * (mass(sphere) / (16.0 / 15.0 * root * effective * deepest.sqrt())).sqrt(),
    }
}

/// The input of LIGGGHTS.
fn liggghts(sample: &Sample) -> String {
    let Sample { model, sphere: [_, modulus, ratio, _, speed], coefficients: [restitution, friction], .. } = sample;
    let mut text = format!(
        "units si\natom_style granular\natom_modify map array\nboundary f f f\nnewton off\ncommunicate single vel yes\n\
         read_data spheres.txt\nneighbor 0.0005 bin\nneigh_modify delay 0\n\
         fix m1 all property/global youngsModulus peratomtype {modulus:?}\n\
         fix m2 all property/global poissonsRatio peratomtype {ratio:?}\n\
         fix m3 all property/global coefficientRestitution peratomtypepair 1 {restitution:?}\n\
         fix m4 all property/global coefficientFriction peratomtypepair 1 {friction:?}\n\
         fix m5 all property/global characteristicVelocity scalar {speed:?}\n\
         pair_style gran model {model} tangential history\npair_coeff * *\n"
    );
    for (number, (axis, at, _)) in sample.planes.iter().enumerate() {
        let axis = ["x", "y", "z"][*axis];
        let line = format!("wall/gran model {model} tangential history primitive type 1 {axis}plane {at:?}");
        writeln!(text, "fix wall{number} all {line}").expect("a text grows");
    }
    text
}

/// The input of LAMMPS.
fn lammps(sample: &Sample) -> String {
    let [_, modulus, ratio, ..] = sample.sphere;
    let [restitution, friction] = sample.coefficients;
    let normal = match sample.model {
        "hertz" => {
            format!("hertz/material {modulus:?} {restitution:?} {ratio:?} tangential mindlin NULL 1.0 {friction:?}")
        }
        _ => {
            let stiffness = sample.stiffness();
            format!("hooke {stiffness:?} {restitution:?} tangential linear_history {stiffness:?} 1.0 {friction:?}")
        }
    };
    let law = format!("{normal} damping coeff_restitution");
    let mut text = format!(
        "units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\ncomm_modify vel yes\n\
         read_data spheres.txt\nneighbor 0.0005 bin\nneigh_modify delay 0\npair_style granular\npair_coeff * * {law}\n"
    );
    for (number, (axis, at, above)) in sample.planes.iter().enumerate() {
        let (axis, places) =
            (["x", "y", "z"][*axis], if *above { format!("{at:?} NULL") } else { format!("NULL {at:?}") });
        writeln!(text, "fix wall{number} all wall/gran granular {law} {axis}plane {places}").expect("a text grows");
    }
    text
}

/// A data file of these spheres, as both programs read it.
fn data(sphere: [f64; 5], centers: &[[f64; 3]]) -> String {
    let [density, _, _, radius, _] = sphere;
    let mut text = format!("spheres\n\n{} atoms\n1 atom types\n", centers.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let at = || centers.iter().map(|center| center[axis]);
        let [low, high] = [at().fold(f64::INFINITY, f64::min), at().fold(f64::NEG_INFINITY, f64::max)];
        writeln!(text, "{:?} {:?} {name}lo {name}hi", low - 20.0 * radius, high + 20.0 * radius).expect("a text grows");
    }
    text += "\nAtoms\n\n";
    for (number, [x, y, z]) in centers.iter().enumerate() {
        let (id, diameter) = (number + 1, 2.0 * radius);
        writeln!(text, "{id} 1 {diameter:?} {density:?} {x:?} {y:?} {z:?}").expect("a text grows");
    }
    text
}

impl Peer {
    /// The largest error of restitution over all phases, with so many time steps in an elastic contact; none where the program is
    /// not installed.
    pub(crate) fn impact(&self, model: &str, restitution: f64, steps: f64) -> Result<Option<f64>, ChartError> {
        let ([.., radius, speed], step) = (SPHERE, duration(model, SPHERE) / steps);
        let center = |phase: u32| {
            let phase = f64::from(phase);
            [4.0 * radius * phase, 0.0, radius + speed * step * (phase + 0.5) / f64::from(PHASES)]
        };
        let centers: Vec<[f64; 3]> = (0..PHASES).map(center).collect();
        let coefficients = [restitution, 0.0];
        let planes = [(2, 0.0, true)];
        let sample = Sample { model, sphere: SPHERE, coefficients, velocity: -speed, planes: &planes, step };
        let count = (4.0 * steps).ceil();
        // LIGGGHTS knows no `line`, and LAMMPS asks for it.
        let line = if self.program == "liggghts" { "" } else { "line " };
        let last = format!(
            "dump d all custom {count} out.dump id vz\ndump_modify d sort id format {line}\"%d %.15g\"\nrun {count}\n"
        );
        let found = self.run(&sample, &centers, &last, |folder| {
            let text = std::fs::read_to_string(folder.join("out.dump")).ok()?;
            let last = text.rsplit("ITEM: ATOMS id vz").next()?;
            let speeds = last.lines().filter_map(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
            Some(speeds.map(|found| (found / speed - restitution).abs()).fold(f64::NAN, f64::max))
        })?;
        Ok(found.filter(|error| error.is_finite()))
    }

    /// Wall time of a time step of the block of spheres, with friction \[s\]; none where the program is not installed.
    pub(crate) fn step_time(&self, model: &str, step: f64) -> Result<Option<f64>, ChartError> {
        let [before, timed, repeats] = TIMED;
        let planes = block::planes();
        let sample =
            Sample { model, sphere: block::SPHERE, coefficients: [0.5, 0.5], velocity: 0.0, planes: &planes, step };
        let last = format!("run {before}\n{}", format!("run {timed}\n").repeat(repeats as usize));
        self.run(&sample, &block::centers(), &last, |folder| {
            let text = std::fs::read_to_string(folder.join("log.txt")).ok()?;
            let times =
                text.lines().filter_map(|line| line.strip_prefix("Loop time of ")?.split(' ').next()?.parse().ok());
            let least = times.skip(1).fold(f64::INFINITY, f64::min);
            least.is_finite().then_some(least / f64::from(timed))
        })
    }

    /// Runs the program in a folder of its own; what it says of what was written there, none where it does not run.
    fn run(
        &self,
        sample: &Sample,
        centers: &[[f64; 3]],
        last: &str,
        read: impl FnOnce(&Path) -> Option<f64>,
    ) -> Result<Option<f64>, ChartError> {
        let folder = std::env::temp_dir().join(format!("cograin-chart-{}", std::process::id()));
        let failed = |source| ChartError::File { path: folder.display().to_string(), source };
        std::fs::create_dir_all(&folder).map_err(failed)?;
        let input = (self.write)(sample);
        let (velocity, step) = (sample.velocity, sample.step);
        let motion =
            format!("velocity all set 0.0 0.0 {velocity:?} units box\nfix move all nve/sphere\ntimestep {step:?}\n");
        std::fs::write(folder.join("in.txt"), format!("{input}{motion}{last}")).map_err(failed)?;
        std::fs::write(folder.join("spheres.txt"), data(sample.sphere, centers)).map_err(failed)?;
        let mut command = Command::new(self.program);
        command.args(["-in", "in.txt", "-log", "log.txt", "-screen", "none"]).current_dir(&folder);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let found = command.status().ok().filter(std::process::ExitStatus::success).and_then(|_| read(&folder));
        std::fs::remove_dir_all(&folder).map_err(failed)?;
        Ok(found)
    }
}
