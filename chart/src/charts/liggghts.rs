//! The same impacts in LIGGGHTS, where it is installed: points of a peer beside our own.
//!
//! LIGGGHTS takes no moduli above 1e9 Pa, so its spheres are softer and slower. An impact without friction depends on restitution and
//! on the number of steps in the contact alone.

use crate::ChartError;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Radius \[m\].
const RADIUS: f64 = 0.0025;

/// Density \[kg/m³\], Young's modulus \[Pa\], Poisson's ratio, speed \[m/s\].
const SPHERE: [f64; 4] = [4000.0, 1e8, 0.23, 0.39];

/// Moments within a time step at which contacts begin.
const PHASES: u32 = 16;

/// Duration of an elastic contact \[s\].
fn duration(model: &str) -> f64 {
    let [density, modulus, ratio, speed] = SPHERE;
    let mass = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * density;
    // Spheres and plane are of one material.
    let (effective, root) = (modulus / (2.0 * (1.0 - ratio * ratio)), RADIUS.sqrt());
    let deepest = libm::pow(15.0 * mass * speed * speed / (16.0 * effective * root), 0.4);
    match model {
        "hertz" => 2.943_28 * deepest / speed,
        _ => PI * (mass / (16.0 / 15.0 * root * effective * deepest.sqrt())).sqrt(),
    }
}

/// The input of spheres above a plane, and what it writes.
fn input(model: &str, restitution: f64, steps: f64) -> String {
    let ([density, modulus, ratio, speed], step) = (SPHERE, duration(model) / steps);
    let mut spheres = String::new();
    for phase in 0..PHASES {
        let (x, z) = (0.01 * f64::from(phase), RADIUS + speed * step * (f64::from(phase) + 0.5) / f64::from(PHASES));
        writeln!(spheres, "create_atoms 1 single {x:?} 0 {z:?} units box").expect("a text grows");
    }
    let (diameter, count) = (2.0 * RADIUS, (4.0 * steps).ceil());
    format!(
        "units si\natom_style granular\natom_modify map array\nboundary f f f\nnewton off\ncommunicate single vel yes\n\
         region r block -0.01 0.2 -0.01 0.01 -0.01 0.05 units box\ncreate_box 1 r\nneighbor 0.002 bin\nneigh_modify delay 0\n\
         fix m1 all property/global youngsModulus peratomtype {modulus:?}\n\
         fix m2 all property/global poissonsRatio peratomtype {ratio:?}\n\
         fix m3 all property/global coefficientRestitution peratomtypepair 1 {restitution:?}\n\
         fix m4 all property/global coefficientFriction peratomtypepair 1 0.0\n\
         fix m5 all property/global characteristicVelocity scalar {speed:?}\n\
         pair_style gran model {model} tangential history\npair_coeff * *\ntimestep {step:?}\n{spheres}\
         set group all density {density:?} diameter {diameter:?}\nvelocity all set 0.0 0.0 -{speed:?} units box\n\
         fix wall all wall/gran model {model} tangential history primitive type 1 zplane 0.0\nfix move all nve/sphere\n\
         dump d all custom {count} out.dump id vz\ndump_modify d sort id format \"%d %.15g\"\nrun {count}\n"
    )
}

/// The largest error of restitution over all phases; none where LIGGGHTS is not installed.
pub(super) fn error(model: &str, restitution: f64, steps: f64) -> Result<Option<f64>, ChartError> {
    let folder = std::env::temp_dir().join(format!("cograin-chart-{}", std::process::id()));
    let failed = |source| ChartError::File { path: folder.display().to_string(), source };
    std::fs::create_dir_all(&folder).map_err(failed)?;
    std::fs::write(folder.join("in.impact"), input(model, restitution, steps)).map_err(failed)?;
    let found = run(&folder);
    std::fs::remove_dir_all(&folder).map_err(failed)?;
    let errors = found
        .map(|speeds| speeds.into_iter().map(|speed| (speed / SPHERE[3] - restitution).abs()).fold(f64::NAN, f64::max));
    Ok(errors.filter(|error| error.is_finite()))
}

/// Runs the input in this folder; the speeds of its last frame \[m/s\].
fn run(folder: &Path) -> Option<Vec<f64>> {
    let mut command = Command::new("liggghts");
    command.args(["-in", "in.impact", "-log", "none", "-screen", "none"]).current_dir(folder);
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status().ok()?;
    let text = std::fs::read_to_string(folder.join("out.dump")).ok().filter(|_| status.success())?;
    let last = text.rsplit("ITEM: ATOMS id vz").next()?;
    Some(last.lines().filter_map(|line| line.split_whitespace().nth(1)?.parse().ok()).collect())
}
