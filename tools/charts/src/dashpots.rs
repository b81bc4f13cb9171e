//! How much dashpots shorten the longest stable time step: measured on the engine, stated by the program, and in closed form.
//!
//! Velocity Verlet with dashpots that see the velocity of half a step ago is stable up to Δt = (2/ω)(√(1 + ζ²) − ζ) in a mode of
//! frequency ω and damping ratio ζ; a dashpot that sees a velocity extrapolated to the end of the step counts twice. By default
//! those along the normal of contacts do. A sphere between two planes has three modes: across (2 k_n/m), along (2 k_t/m), and its spin
//! (5 k_t/m). Bonded spheres have many; the curve beside them is that of one mode alone.

use crate::border::border;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, linear, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "dashpots",
    shows: "stability: longest stable step over the damping of contacts and of bonds, measured, stated, in theory",
    seconds: 3.0,
    measures: Measures::Errors,
    draw,
};

/// Radius \[m\].
const RADIUS: f64 = 1e-3;

/// Mass of a sphere \[kg\].
const MASS: f64 = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * 2500.0;

/// Stiffness of contacts, normal and tangential \[N/m\].
const STIFFNESS: [f64; 2] = [1e5, 8e4];

/// Damping ratios of contacts: of the motion across.
const CONTACTS: [f64; 7] = [0.0, 0.1, 0.2, 0.4, 0.8, 1.6, 3.0];

/// Damping ratios of bonds.
const BONDS: [f64; 6] = [0.0, 0.1, 0.3, 1.0, 2.0, 4.0];

/// What is in a list of spheres after its place and radius: a motion that belongs to the number, small enough to be linear.
fn motion(number: usize) -> String {
    let noise = |place: usize| {
        let mixed = (6 * number as u64 + place as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        1e-11 * ((mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    };
    let [u, v, w] = [0, 1, 2].map(noise);
    let [a, b, c] = [3, 4, 5].map(|place| 1e3 * noise(place));
    format!("velocity = [{u:?}, {v:?}, {w:?}], angular_velocity = [{a:?}, {b:?}, {c:?}]")
}

/// A sphere pressed between two planes, with this dashpot \[kg/s\] along the normal and across.
fn pressed(run: &str, tangential: &str, dashpot: f64) -> String {
    let ([normal_stiffness, tangential_stiffness], damping, motion) = (STIFFNESS, dashpot / MASS, motion(0));
    let half = 0.999 * RADIUS;
    format!(
        "[run]\nmax_overlap = 0.1\n{run}\n[material.a]\ndensity = 2500.0\n[pair.a.a]\nfriction = 1e6\n\
         normal_stiffness = {normal_stiffness:?}\ntangential_stiffness = {tangential_stiffness:?}\n\
         normal_damping = {damping:?}\ntangential_damping = {damping:?}\n\
         [contact.c.normal.hooke_stiffness]\n{tangential}\n\
         [particles.s]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, 0.0], radius = {RADIUS:?}, {motion} }}]\n\
         [boundary.below]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, -{half:?}], normal = [0.0, 0.0, 1.0] }}\n\
         [boundary.above]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, {half:?}], normal = [0.0, 0.0, -1.0] }}\n"
    )
}

/// The longest stable step of a mode with this rate \[1/s\] and damping ratio \[s\].
fn of_mode(rate: f64, ratio: f64) -> f64 {
    2.0 / rate * ((1.0 + ratio * ratio).sqrt() - ratio)
}

/// Bonded spheres at these places, in units of the radius.
fn bonded(run: &str, places: &[[usize; 3]], ratio: f64) -> String {
    let sphere = |(number, place): (usize, &[usize; 3])| {
        let [x, y, z] = place.map(|count| 2.0 * RADIUS * count as f64);
        format!("{{ position = [{x:?}, {y:?}, {z:?}], radius = {RADIUS:?}, {} }},\n", motion(number))
    };
    let spheres: String = places.iter().enumerate().map(sphere).collect();
    format!(
        "[run]\n{run}\n[material.a]\ndensity = 2500.0\n[particles.row]\nmaterial = \"a\"\nlist = [\n{spheres}]\n\
         [bond.b]\nbetween = [\"row\", \"row\"]\ncreate_distance = 2.2e-3\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n\
         [bond.b.damping.viscous]\nnormal_force = {ratio:?}\ntangential_force = {ratio:?}\nnormal_torque = {ratio:?}\n\
         tangential_torque = {ratio:?}\n"
    )
}

/// Columns of the table.
const COLUMNS: [&str; 3] =
    ["damping ratio", "longest stable step times √(k_n/m)", "longest stable step over the undamped one"];

/// Contacts: adds measured, stated and closed form.
fn fill_contacts(table: &mut Table) -> Result<(), ChartError> {
    let unit = (STIFFNESS[0] / MASS).sqrt();
    let rates = [2.0 * STIFFNESS[0], 2.0 * STIFFNESS[1], 5.0 * STIFFNESS[1]].map(|stiffness| (stiffness / MASS).sqrt());
    let mut add = |series: &str, ratio: f64, step: f64| {
        table.push(["contacts".into(), series.into(), ratio.into(), (step * unit).into(), "".into()]);
    };
    let models = [("without friction", ""), ("with friction", "[contact.c.tangential.history]")];
    for (number, (name, tangential)) in models.into_iter().enumerate() {
        for ratio in CONTACTS {
            let dashpot = ratio * MASS * rates[0];
            let [measured, stated] = border(&|run: &str| pressed(run, tangential, dashpot))?;
            add(&format!("{name}, measured"), ratio, measured);
            add(&format!("{name}, stated"), ratio, stated);
            // Dashpots over mass or inertia, as the closed form has them: 2 ζ ω. That along the normal is predicted.
            let spin = dashpot / (0.4 * MASS * rates[2]);
            let modes = [
                of_mode(rates[0], 2.0 * ratio),
                of_mode(rates[1], dashpot / (MASS * rates[1])),
                of_mode(rates[2], spin),
            ];
            let shortest = if number == 0 { modes[0] } else { modes.into_iter().fold(f64::INFINITY, f64::min) };
            add(if number == 0 { THEORY[0] } else { THEORY[1] }, ratio, shortest);
        }
    }
    Ok(())
}

/// Series that are closed forms.
const THEORY: [&str; 3] = ["without friction, theory", "with friction, theory", "a single mode, theory"];

/// Bonds: adds measured, stated and a single mode.
fn fill_bonds(table: &mut Table) -> Result<(), ChartError> {
    let chain: Vec<_> = (0..12).map(|count| [count, 0, 0]).collect();
    let block: Vec<_> = (0..27).map(|count| [count % 3, count / 3 % 3, count / 9]).collect();
    let mut add = |series: &str, ratio: f64, part: f64| {
        table.push(["bonds".into(), series.into(), ratio.into(), "".into(), part.into()]);
    };
    for (name, places) in [("pair", &chain[..2]), ("chain of 12", &chain), ("block of 27", &block)] {
        let mut free = None;
        for ratio in BONDS {
            let [measured, stated] = border(&|run: &str| bonded(run, places, ratio))?;
            let undamped = *free.get_or_insert(measured);
            add(&format!("{name}, measured"), ratio, measured / undamped);
            add(&format!("{name}, stated"), ratio, stated / undamped);
        }
    }
    for ratio in BONDS {
        add(THEORY[2], ratio, of_mode(2.0, ratio));
    }
    Ok(())
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let columns = [("case", ""), ("series", ""), (COLUMNS[0], "1"), (COLUMNS[1], "1"), (COLUMNS[2], "1")];
    let mut table = Table::new(columns);
    fill_contacts(&mut table)?;
    fill_bonds(&mut table)?;
    let panel = |case: &str, title: &str, column| Panel {
        only: Some(("case", case.to_owned())),
        theory: THEORY.into(),
        ..Panel::new(title, linear(COLUMNS[0]), logarithmic(column), "series")
    };
    let panels = vec![
        panel("contacts", "a sphere pressed between two planes, linear springs", COLUMNS[1]),
        panel("bonds", "bonded spheres, viscous damping of all four parts", COLUMNS[2]),
    ];
    Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes: Vec::new() })
}
