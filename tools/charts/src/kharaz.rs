//! What oblique impacts leave, over the angle: the laws converged, the closed form of sliding, and the experiment.
//!
//! Experiment: A. H. Kharaz, D. A. Gorham & A. D. Salman, *Powder Technol.* 120 (2001) 281–291, aluminium oxide spheres of 5 mm
//! on thick glass, e = 0.98, µ = 0.092, points as they were digitised for set-up 4 of Y. C. Chung & J. Y. Ooi (2011). While
//! the contact slides, e_t = 1 − µ (1 + e)/tan θ and r ω = −5/2 µ (1 + e) v_n.

use crate::drops::{RADIUS, SPEED, Throw, hertz_duration};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, linear};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "kharaz",
    shows: "oblique impacts over the angle: laws, closed form and experiment (Kharaz et al. 2001)",
    seconds: 1.0,
    measures: Measures::Errors,
    draw,
};

/// Restitution and friction.
const COEFFICIENTS: [f64; 2] = [0.98, 0.092];

/// Angles to the normal \[°\].
const ANGLES: [f64; 12] = [2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 80.0];

/// Time steps in an elastic contact.
const STEPS: f64 = 1600.0;

/// Angle \[°\] and tangential restitution, measured.
const RESTITUTION: [[f64; 2]; 7] =
    [[4.2, 0.746], [9.8, 0.675], [20.2, 0.599], [30.4, 0.690], [39.5, 0.774], [49.6, 0.848], [79.2, 0.970]];

/// Angle \[°\] and angular velocity \[rad/s\], measured.
const SPIN: [[f64; 2]; 8] = [
    [5.9, 135.0],
    [10.9, 261.0],
    [21.1, 574.0],
    [31.1, 612.0],
    [39.0, 595.0],
    [50.2, 450.0],
    [60.1, 376.0],
    [78.6, 142.0],
];

/// Columns of angle, tangential restitution and angular velocity.
const COLUMNS: [&str; 3] = ["angle to the normal", "tangential restitution", "angular velocity"];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table = Table::new([("series", ""), (COLUMNS[0], "°"), (COLUMNS[1], "1"), (COLUMNS[2], "rad/s")]);
    for (name, keys) in [("history", ""), ("turned_history", ""), ("turned_history, rescale", "rescale = true")] {
        let model = name.split(',').next().unwrap_or(name);
        let law = format!("[contact.touch.normal.hertz]\n[contact.touch.tangential.{model}]\n{keys}");
        for angle in ANGLES {
            let radians = angle.to_radians();
            let duration = hertz_duration(SPEED * libm::cos(radians));
            let throw = Throw { law: &law, coefficients: COEFFICIENTS, angle: radians, duration };
            let [velocity, spin] = throw.steps(STEPS, "")?[0];
            let restitution = velocity[0] / (SPEED * libm::sin(radians));
            table.push([name.into(), angle.into(), restitution.into(), spin[1].into()]);
        }
    }
    let sliding = COEFFICIENTS[1] * (1.0 + COEFFICIENTS[0]);
    for angle in ANGLES.into_iter().filter(|angle| *angle >= 30.0) {
        let radians = angle.to_radians();
        let spin = 2.5 * sliding * SPEED * libm::cos(radians) / RADIUS;
        table.push([
            "sliding, closed form".into(),
            angle.into(),
            (1.0 - sliding / libm::tan(radians)).into(),
            spin.into(),
        ]);
    }
    for [angle, restitution] in RESTITUTION {
        table.push(["experiment".into(), angle.into(), restitution.into(), "".into()]);
    }
    for [angle, spin] in SPIN {
        table.push(["experiment".into(), angle.into(), "".into(), spin.into()]);
    }
    let panel = |column| Panel {
        theory: vec!["sliding, closed form"],
        single: vec!["experiment"],
        ..Panel::new("aluminium oxide at 3.9 m/s, e = 0.98, µ = 0.092", linear(COLUMNS[0]), linear(column), "series")
    };
    Ok(Drawing {
        table,
        picture: Picture { panels: vec![panel(COLUMNS[1]), panel(COLUMNS[2])], ..Picture::default() },
        notes: Vec::new(),
    })
}
