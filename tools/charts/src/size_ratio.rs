//! The longest stable step of a small sphere between two large ones, with and without friction, over the ratio of sizes.
//!
//! The large spheres are held. Closed form: the small one moves along the line (2 k_n/m) and, where it sticks, spins about an
//! axis across it (5 k_t/m); Hertz's stiffnesses at the given overlap. The unit is the Rayleigh time of the small sphere, which
//! knows neither overlap nor ratio.

use crate::border::border;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "size_ratio",
    shows: "stability: longest stable step of a small sphere between large ones, with and without friction",
    seconds: 1.0,
    measures: Measures::Errors,
    draw,
};

/// Radius of the small sphere \[m\].
const RADIUS: f64 = 1e-3;

/// Overlap \[m\].
const OVERLAP: f64 = 1e-3 * RADIUS;

/// Density \[kg/m³\].
const DENSITY: f64 = 2500.0;

/// Young's modulus \[Pa\] and Poisson's ratio.
const ELASTICITY: [f64; 2] = [1e9, 0.25];

/// Radius of the large spheres over that of the small one.
const RATIOS: [f64; 7] = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0];

/// The small sphere between large ones. Without friction it moves along the line only: across it the large ones push it out, at any
/// step.
fn text(run: &str, ratio: f64, rough: bool) -> String {
    let (motion, tangential) = match rough {
        true => ("velocity = [1e-11, 7e-12, 4e-12], angular_velocity = [9e-9, -5e-9, 3e-9]", "history"),
        false => ("velocity = [0.0, 0.0, 1e-11]", "none"),
    };
    let ([modulus, poisson], large) = (ELASTICITY, ratio * RADIUS);
    let away = RADIUS + large - OVERLAP;
    format!(
        "[run]\nmax_overlap = 0.1\n{run}\n[material.a]\ndensity = {DENSITY:?}\nyoungs_modulus = {modulus:?}\npoissons_ratio = {poisson:?}\n\
         [pair.a.a]\nrestitution = 1.0\nfriction = 1e3\n[contact.c.normal.hertz]\n[contact.c.tangential.{tangential}]\n\
         [particles.small]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, 0.0], radius = {RADIUS:?}, {motion} }}]\n\
         [particles.large]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, -{away:?}], radius = {large:?} }}, \
         {{ position = [0.0, 0.0, {away:?}], radius = {large:?} }}]\n\
         [boundary.held]\nparticles = {{ set = \"large\" }}\n"
    )
}

/// Closed forms of the longest stable step, without and with friction, and the Rayleigh time \[s\].
fn theory(ratio: f64) -> [f64; 3] {
    let ([modulus, poisson], mass) = (ELASTICITY, 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY);
    let shear = modulus / (2.0 * (1.0 + poisson));
    let contact = (RADIUS * ratio / (1.0 + ratio) * OVERLAP).sqrt();
    let normal = 2.0 * modulus / (2.0 * (1.0 - poisson * poisson)) * contact;
    let tangential = 8.0 * shear / (2.0 * (2.0 - poisson)) * contact;
    let step = |stiffness: f64| 2.0 * (mass / stiffness).sqrt();
    let rayleigh = PI * RADIUS * (DENSITY / shear).sqrt() / (0.1631 * poisson + 0.8766);
    let [along, spin] = [2.0 * normal, 5.0 * tangential];
    [step(along), step(along.max(spin)), rayleigh]
}

/// Columns of the table.
const COLUMNS: [&str; 2] = ["large over small radius", "longest stable step over Rayleigh time"];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table = Table::new([("series", ""), (COLUMNS[0], "1"), (COLUMNS[1], "1")]);
    for ratio in RATIOS {
        let [smooth, rough, rayleigh] = theory(ratio);
        for (name, has_friction, closed) in [("without friction", false, smooth), ("with friction", true, rough)] {
            let [measured, stated] = border(&|run: &str| text(run, ratio, has_friction))?;
            for (what, step) in [("measured", measured), ("theory", closed), ("stated", stated)] {
                table.push([format!("{name}, {what}").into(), ratio.into(), (step / rayleigh).into()]);
            }
        }
    }
    let panel = Panel {
        theory: vec!["without friction, theory", "with friction, theory"],
        ..Panel::new(
            "a small sphere between two large ones, hertz, overlap of 0.1 %",
            logarithmic(COLUMNS[0]),
            logarithmic(COLUMNS[1]),
            "series",
        )
    };
    Ok(Drawing { table, picture: Picture { panels: vec![panel], ..Picture::default() }, notes: Vec::new() })
}
