//! Bodies that forces move: energy after an elastic impact over the ratio of masses, and frequency on a spring to the ground over the
//! time step.
//!
//! A sphere flies against a plane that moves along its normal. Theory: the energy stays; velocity Verlet swings with
//! ω' = 2/Δt arcsin(ω Δt/2), and is unstable from ω Δt = 2 on.

use crate::stage::Stage;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, linear, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "bodies",
    shows: "bodies that forces move: energy after an elastic impact, frequency on a spring",
    seconds: 10.0,
    measures: Measures::Errors,
    draw,
};

/// Radius of the sphere \[m\].
const RADIUS: f64 = 5e-3;

/// Density \[kg/m³\].
const DENSITY: f64 = 2500.0;

/// Ratios of the masses of body and sphere.
const RATIOS: [f64; 10] = [1e3, 1e2, 10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Gaps at which the sphere begins, over its radius: contacts begin at other moments within a step.
const GAPS: [f64; 4] = [0.0100, 0.0111, 0.0123, 0.0137];

/// Mass of the body on its spring \[kg\], stiffness \[N/m\].
const SPRING: [f64; 2] = [1e-4, 1e5];

/// Time steps over the stable one.
const STEPS: [f64; 8] = [0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95];

/// Columns of the table.
const COLUMNS: [&str; 4] = [
    "mass of body over sphere",
    "energy of relative motion, after over before",
    "step over stable one",
    "frequency over theory",
];

/// Mass of the sphere \[kg\].
fn mass() -> f64 {
    4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY
}

/// A sphere a gap below a body.
fn text(run: &str, law: &str, gap: f64, body: &str) -> String {
    let height = -(1.0 + gap) * RADIUS;
    format!(
        "[run]\nthreads = 1\nmax_overlap = 0.2\n{run}\n[material.a]\ndensity = {DENSITY:?}\nyoungs_modulus = 5e7\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 1.0\nnormal_stiffness = 1e5\nnormal_damping = 0.0\n[contact.c.normal.{law}]\n\
         [particles.one]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, {height:?}], radius = {RADIUS:?}, velocity = [0.0, 0.0, 1.0] }}]\n\
         [boundary.body]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, -1.0] }}\n{body}\n"
    )
}

/// Energy of the relative motion of sphere and body, after an elastic impact over before: the whole loses what this one loses.
fn energy(law: &str, ratio: f64, gap: f64) -> Result<f64, ChartError> {
    let body = format!("mass = {:?}\nmotion = {{ free = [\"z\"] }}", ratio * mass());
    let mut stage = Stage::of(&text("step = \"auto\"", law, gap, &body))?;
    let begun = stage.simulation.kinetic_energy();
    for _ in 0..400 {
        stage.advance(5e-5)?;
        let body = &stage.simulation.state().boundaries[0];
        if body.force[2] == 0.0 && body.velocity[2] > stage.velocity(0)[2] {
            break;
        }
    }
    Ok(1.0 + (stage.simulation.kinetic_energy() / begun - 1.0) * (1.0 + ratio) / ratio)
}

/// The frequency of a body on its spring over theory, at this part of the stable step.
fn frequency(part: f64) -> Result<f64, ChartError> {
    let [mass, stiffness] = SPRING;
    let body = format!("mass = {mass:?}\nstiffness = {{ z = {stiffness:?} }}\nmotion = {{ loaded = {{ z = 1.0 }} }}");
    let step = part * 2.0 * (mass / stiffness).sqrt() * (1.0 - 1e-5);
    let mut stage = Stage::of(&text(&format!("step = {step:?}\nallow_unstable = true"), "hertz", 200.0, &body))?;
    // The times at which the displacement passes its mean, interpolated.
    let (mut crossings, mut before, mut time) = (Vec::new(), -1.0, 0.0);
    while crossings.len() < 41 {
        stage.advance(step)?;
        time += step;
        let now = stage.simulation.state().boundaries[0].displacement[2] * stiffness - 1.0;
        if before < 0.0 && now >= 0.0 || before >= 0.0 && now < 0.0 {
            crossings.push(time - step * now / (now - before));
        }
        before = now;
    }
    Ok(20.0 * 2.0 * PI / (crossings[40] - crossings[0]) / (stiffness / mass).sqrt())
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table = Table::new([
        ("case", ""),
        ("series", ""),
        (COLUMNS[0], "1"),
        (COLUMNS[1], "1"),
        (COLUMNS[2], "1"),
        (COLUMNS[3], "1"),
    ]);
    for (law, ratio) in ["hertz", "hooke_stiffness"].into_iter().flat_map(|law| RATIOS.map(|ratio| (law, ratio))) {
        let energies = GAPS.into_iter().map(|gap| energy(law, ratio, gap)).collect::<Result<Vec<_>, _>>()?;
        let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
        let most = energies.iter().copied().fold(0.0, f64::max);
        for (which, energy) in [("least", least), ("most", most)] {
            table.push([
                "impact".into(),
                format!("{law}, {which}").into(),
                ratio.into(),
                energy.into(),
                "".into(),
                "".into(),
            ]);
        }
    }
    for part in STEPS {
        let verlet = part.asin() / part;
        for (series, ratio) in [("measured", frequency(part)?), ("theory", verlet)] {
            table.push(["spring".into(), series.into(), "".into(), "".into(), part.into(), ratio.into()]);
        }
    }
    let impact = Panel {
        only: Some(("case", "impact".to_owned())),
        ..Panel::new(
            "elastic impacts of a sphere on a body, automatic step",
            logarithmic(COLUMNS[0]),
            linear(COLUMNS[1]),
            "series",
        )
    };
    let spring = Panel {
        only: Some(("case", "spring".to_owned())),
        theory: vec!["theory"],
        single: vec!["measured"],
        ..Panel::new("a body on a spring to the ground", linear(COLUMNS[2]), linear(COLUMNS[3]), "series")
    };
    Ok(Drawing { table, picture: Picture { panels: vec![impact, spring], ..Picture::default() }, notes: Vec::new() })
}
