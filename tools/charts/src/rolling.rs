//! How exactly a sphere that rests on a plane rolls, slips and slides, over the time step.
//!
//! Velocity and angular velocity of a sphere under its weight, against the same law with [`FINEST`] time steps a period of its
//! bounce: it rocks on its rolling spring (`epsd2`), swings on its tangential spring with a dashpot (e = 0.5), or is set down
//! sliding and ends rolling.

use crate::runs::{Sampled, apart, given};
use crate::schemes::{MIDWAY, PREDICTED, PREDICTED_NORMAL, Scheme};
use crate::stage::Stage;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "rolling",
    shows: "error of a sphere that rocks, swings or slides on a plane, over time steps",
    seconds: 1.0,
    measures: Measures::Errors,
    draw,
};

/// Radius \[m\].
const RADIUS: f64 = 0.01;

/// Density \[kg/m³\], gravity \[m/s²\].
const WEIGHT: [f64; 2] = [2500.0, 9.81];

/// Young's modulus \[Pa\] and Poisson's ratio.
const ELASTICITY: [f64; 2] = [1e7, 0.25];

/// Time steps in a period of the bounce.
const STEPS: [f64; 9] = [8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0];

/// Time steps of the run that the others are held against.
const FINEST: f64 = 32_768.0;

/// What happens: its name, restitution, rolling model, speed \[m/s\] and angular velocity \[rad/s\] at the start.
struct Case {
    /// Its name.
    name: &'static str,
    /// Coefficient of restitution.
    restitution: f64,
    /// Table of the rolling model.
    rolling: &'static str,
    /// Speed at the start \[m/s\].
    speed: f64,
    /// Angular velocity at the start \[rad/s\].
    spin: f64,
}

/// What happens.
const CASES: [Case; 3] = [
    Case {
        name: "rocks on its rolling spring, e = 1",
        restitution: 1.0,
        rolling: "[contact.touch.rolling.epsd2]",
        speed: 5e-4,
        spin: 0.05,
    },
    Case { name: "swings on its tangential spring, e = 0.5", restitution: 0.5, rolling: "", speed: 2e-3, spin: 0.0 },
    Case { name: "slides, then rolls, e = 0.5", restitution: 0.5, rolling: "", speed: 0.1, spin: 0.0 },
];

/// Overlap under the weight \[m\], and period of the bounce \[s\].
fn rest() -> [f64; 2] {
    let ([density, gravity], [modulus, ratio]) = (WEIGHT, ELASTICITY);
    let mass = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * density;
    let effective = modulus / (2.0 * (1.0 - ratio * ratio));
    let overlap = libm::pow(mass * gravity / (4.0 / 3.0 * effective * RADIUS.sqrt()), 2.0 / 3.0);
    let stiffness = 2.0 * effective * (RADIUS * overlap).sqrt();
    [overlap, 2.0 * PI * (mass / stiffness).sqrt()]
}

/// The scene.
fn text(case: &Case, tangential: &str, run: &str) -> String {
    let ([density, gravity], [modulus, ratio], [overlap, _]) = (WEIGHT, ELASTICITY, rest());
    let (height, Case { restitution, rolling, speed, spin, .. }) = (RADIUS - overlap, case);
    format!(
        "gravity = [0.0, 0.0, -{gravity:?}]\n[run]\n{run}\n\
         [material.a]\ndensity = {density:?}\nyoungs_modulus = {modulus:?}\npoissons_ratio = {ratio:?}\n\
         [pair.a.a]\nrestitution = {restitution:?}\nfriction = 0.3\nrolling_friction = 0.2\n\
         [contact.touch.normal.hertz]\n[contact.touch.tangential.{tangential}]\n{rolling}\n\
         [particles.sphere]\nmaterial = \"a\"\n\
         list = [{{ position = [0.0, 0.0, {height:?}], radius = {RADIUS:?}, velocity = [{speed:?}, 0.0, 0.0], \
         angular_velocity = [0.0, {spin:?}, 0.0] }}]\n\
         [boundary.floor]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n"
    )
}

/// Speed along the plane, and that of the surface about the centre \[m/s\].
fn observe(stage: &Stage) -> Vec<f64> {
    vec![stage.velocity(0)[0], RADIUS * stage.spin(0)[1]]
}

/// The largest errors of speed over the first, over time steps in a period of the bounce.
fn errors(case: &Case, tangential: &str, scheme: &Scheme) -> Result<Vec<[f64; 2]>, ChartError> {
    let [_, period] = rest();
    let sampled = Sampled { interval: period / 4.0, count: 12, observe };
    let run =
        |steps: f64| Ok::<_, ChartError>(sampled.of(&text(case, tangential, &(given(period / steps) + scheme.run)))?.0);
    let right = run(FINEST)?;
    STEPS.iter().map(|&steps| Ok([steps, apart(&run(steps)?, &right) / case.speed])).collect()
}

/// Those of a sphere that rocks on its rolling spring (`epsd2`) with `history`.
pub(crate) fn rocking_errors(scheme: &Scheme) -> Result<Vec<[f64; 2]>, ChartError> {
    errors(&CASES[0], "history", scheme)
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table = Table::new([
        ("case", ""),
        ("series", ""),
        ("time steps in a period of the bounce", "1"),
        ("largest error of speed over the first", "1"),
    ]);
    let mut notes = Vec::new();
    for case in &CASES {
        for tangential in ["history", "turned_history"] {
            // The curves of `engine` are those of the default.
            for scheme in [PREDICTED_NORMAL, MIDWAY, PREDICTED] {
                let errors = errors(case, tangential, &scheme)?;
                for &[steps, error] in &errors {
                    table.push([case.name.into(), scheme.named(tangential).into(), steps.into(), error.into()]);
                }
                let [.., [_, coarse], [_, fine]] = errors[..] else { continue };
                let (series, order) = (scheme.named(tangential), libm::log2(coarse / fine));
                notes.push(format!("{}, {series}: order {order:.2} between the two finest", case.name));
            }
        }
    }
    let panel = |case: &Case| Panel {
        only: Some(("case", case.name.to_owned())),
        ..Panel::new(
            case.name,
            logarithmic("time steps in a period of the bounce"),
            logarithmic("largest error of speed over the first"),
            "series",
        )
    };
    Ok(Drawing { table, picture: Picture { panels: CASES.iter().map(panel).collect(), ..Picture::default() }, notes })
}
