//! What keys of one bond table cannot say together.

use super::{BreakageKeys, DampingChoice, FormulationChoice, KeyError, Keys};
use crate::bond::creation::Creation;

/// A contradiction: whether it is there, its key, what was found and what would be right.
type Contradiction = (bool, &'static str, &'static str);

/// Every contradiction among the keys.
pub(super) fn contradictions(keys: &Keys) -> Vec<KeyError> {
    let exact = keys.formulation == FormulationChoice::EngineExact;
    let opposes = matches!(keys.damping, Some(DampingChoice::Opposing(_) | DampingChoice::Viscous(_)));
    let mut all: Vec<Contradiction> = vec![
        (
            keys.create.needs_distance() && keys.create_distance.is_none(),
            "create_distance",
            "missing; the distance of the centres below which bonds are made is needed, unless they are listed",
        ),
        (
            keys.create == Creation::Step(0),
            "create",
            "step 0 found; the first step that can bond is 1, and \"start\" bonds before it",
        ),
        (exact && opposes, "damping", "engine_exact has only the engine's damping; sign, smooth or none is right"),
    ];
    if let Some(breakage) = &keys.breakage {
        all.extend(of_limits(breakage, exact));
        all.extend(of_stress(breakage, exact));
    }
    let there = all.into_iter().filter(|(there, _, _)| *there);
    there.map(|(_, key, message)| KeyError { key, message: message.to_owned() }).collect()
}

/// Of limits among each other.
fn of_limits(keys: &BreakageKeys, exact: bool) -> [Contradiction; 2] {
    let stress = keys.max_normal_stress.is_some() || keys.max_shear_stress.is_some();
    [
        (
            !stress && keys.max_distance.is_none(),
            "breakage",
            "no limit found; max_distance, max_normal_stress or max_shear_stress is right, or no table",
        ),
        (
            exact && stress && keys.max_distance.is_some(),
            "breakage.max_distance",
            "found beside a largest stress; engine_exact looks at one of them",
        ),
    ]
}

/// Of what goes with a largest stress.
fn of_stress(keys: &BreakageKeys, exact: bool) -> [Contradiction; 5] {
    let (no_normal, no_shear) = (keys.max_normal_stress.is_none(), keys.max_shear_stress.is_none());
    [
        (
            keys.tension_ratio.is_some() && no_normal,
            "breakage.tension_ratio",
            "found without max_normal_stress, which it multiplies",
        ),
        (
            keys.friction_angle.is_some() && no_shear,
            "breakage.friction_angle",
            "found without max_shear_stress, which it raises",
        ),
        (
            keys.friction_angle.is_some_and(|angle| angle.get() >= std::f64::consts::FRAC_PI_2),
            "breakage.friction_angle",
            "an angle of π/2 or more found; radians from 0 to below π/2 are right",
        ),
        (
            keys.compression_breaks.is_some() && no_normal,
            "breakage.compression_breaks",
            "found without max_normal_stress, to which it belongs",
        ),
        (
            exact && keys.compression_breaks == Some(false),
            "breakage.compression_breaks",
            "false found; in engine_exact compression always breaks",
        ),
    ]
}
