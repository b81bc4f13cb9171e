//! The longest stable time step of a scene, by bisection on the engine itself.

use crate::runs::given;
use crate::stage::Stage;
use cograin_chart::ChartError;

/// Growth of kinetic energy that only an unstable step brings about.
const GROWTH: f64 = 1e4;

/// Time steps in which it must have come about.
const STEPS: u32 = 2000;

/// Looks at the energy on the way: often enough to see it grow. A motion that has grown until contacts open may turn back in each
/// step, which is not a motion at whole steps.
const LOOKS: u32 = 400;

/// How exactly the border is found, over itself.
const EXACT: f64 = 0.01;

/// A scene as text, with these lines of `[run]`.
pub(crate) type Text<'a> = &'a dyn Fn(&str) -> String;

/// Whether a small motion grows at this step \[s\].
fn grows(text: Text, step: f64) -> Result<bool, ChartError> {
    let mut stage = Stage::of(&text(&given(step)))?;
    let begun = stage.simulation.kinetic_energy();
    for _ in 0..LOOKS {
        let advanced = stage.advance(f64::from(STEPS / LOOKS) * step);
        if advanced.is_err() || stage.simulation.kinetic_energy() > GROWTH * begun {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The longest step at which nothing grows \[s\], and the one that the program states \[s\].
pub(crate) fn border(text: Text) -> Result<[f64; 2], ChartError> {
    let stated = Stage::of(&text("threads = 1\n"))?.stable();
    let (mut stable, mut unstable) = (0.5 * stated, 2.0 * stated);
    while grows(text, stable)? {
        (stable, unstable) = (0.5 * stable, stable);
    }
    while !grows(text, unstable)? {
        (stable, unstable) = (unstable, 2.0 * unstable);
    }
    while unstable - stable > EXACT * stable {
        let middle = 0.5 * (stable + unstable);
        if grows(text, middle)? { unstable = middle } else { stable = middle }
    }
    Ok([0.5 * (stable + unstable), stated])
}
