//! The kinds of parameters: keys, unit, range. A new kind is one row.

use crate::base::quantity::{
    AtLeastOne, BelowOne, Fraction, NonNegative, PoissonsRatio, Positive, Restitution, Safety,
};
use crate::laws::contact::normal::sticky::{self, DampingKind};
use crate::scene::{ContactLaw, Range, range_of as of};

/// The least number above 0 that has all its digits.
const ABOVE_ZERO: Option<f64> = Some(f64::MIN_POSITIVE);
/// Above 0.
pub(super) const POSITIVE: Range = of::<Positive>(ABOVE_ZERO, None);
/// 0 or above.
pub(super) const NON_NEGATIVE: Range = of::<NonNegative>(Some(0.0), None);
/// A whole number of 0 or above.
pub(super) const COUNT: Range = of::<NonNegative>(Some(0.0), Some(65535.0));
/// 0 for no, 1 for yes.
pub(super) const SWITCH: Range = of::<NonNegative>(Some(0.0), Some(1.0));
/// 1 or above.
const AT_LEAST_ONE: Range = of::<AtLeastOne>(Some(1.0), None);
/// Above 0, at most 1.
const RESTITUTION: Range = of::<Restitution>(ABOVE_ZERO, Some(1.0));
/// From 0 to 1.
const FRACTION: Range = of::<Fraction>(Some(0.0), Some(1.0));
/// From 0 to ½.
const POISSONS_RATIO: Range = of::<PoissonsRatio>(Some(0.0), Some(0.5));
/// Above 0 and below 1.
pub(super) const PART: Range = of::<Safety>(ABOVE_ZERO, Some(1.0 - f64::EPSILON / 2.0));
/// From 0 to below 1.
pub(super) const PART_OR_NONE: Range = of::<BelowOne>(Some(0.0), Some(1.0 - f64::EPSILON / 2.0));

/// The unit of a key, which may depend on the law that governs two materials.
#[derive(Clone, Copy)]
pub(super) enum Unit {
    /// Always this.
    Always(&'static str),
    /// By the law.
    ByLaw(fn(&ContactLaw) -> &'static str),
}
pub(super) use Unit::{Always, ByLaw};

/// Of a given stiffness: a force over a length, or a pressure where the overlap or the contact radius is a factor.
fn stiffness(law: &ContactLaw) -> &'static str {
    if law.choice.normal.name() == "hertz_stiffness" || law.choice.normal.keys::<sticky::Keys>().is_some() {
        "Pa"
    } else {
        "N/m"
    }
}

/// Of a given damping over the effective mass.
fn damping(law: &ContactLaw) -> &'static str {
    if law.choice.normal.name() == "hertz_stiffness" { "1/(m.s)" } else { "1/s" }
}

/// Of the damping of `jkr` and `dmt`.
fn sticky_damping(law: &ContactLaw) -> &'static str {
    match law.choice.normal.keys::<sticky::Keys>().map(|keys| keys.damping) {
        Some(DampingKind::MassVelocity) => "1/s",
        Some(DampingKind::Velocity) => "kg/s",
        Some(DampingKind::Viscoelastic) | None => "1/(m.s)",
    }
}

/// A kind of parameter.
pub(super) struct Row {
    /// Its keys; `*` stands for a name.
    pub(super) keys: &'static str,
    /// Its unit.
    pub(super) unit: Unit,
    /// Which numbers it takes.
    pub(super) range: Range,
    /// Whether it may be changed between communication steps.
    pub(super) tunable: bool,
    /// What it is.
    pub(super) about: &'static str,
}

/// A parameter that is fixed once the unit is initialised.
const fn fixed(keys: &'static str, unit: Unit, range: Range, about: &'static str) -> Row {
    Row { keys, unit, range, tunable: false, about }
}

/// A parameter that may be changed between communication steps.
const fn tunable(keys: &'static str, unit: Unit, range: Range, about: &'static str) -> Row {
    Row { keys, unit, range, tunable: true, about }
}

/// All kinds but the settings of the run and the strengths of bonds, which their rules of breakage declare.
#[rustfmt::skip]
pub(super) const ROWS: &[Row] = &[
    fixed("run.max_overlap", Always("1"), NON_NEGATIVE, "largest overlap at the start over the smaller radius"),
    fixed("run.skin", Always("m"), POSITIVE, "search distance of neighbours beyond touch"),
    fixed("material.*.density", Always("kg/m3"), POSITIVE, "density"),
    fixed("material.*.youngs_modulus", Always("Pa"), POSITIVE, "Young's modulus"),
    fixed("material.*.poissons_ratio", Always("1"), POISSONS_RATIO, "Poisson's ratio"),
    fixed("material.*.conductivity", Always("W/(m.K)"), POSITIVE, "conductivity"),
    fixed("material.*.specific_heat", Always("J/(kg.K)"), POSITIVE, "specific heat"),
    fixed("material.*.real_youngs_modulus", Always("Pa"), POSITIVE, "Young's modulus of the real bodies, for the area of contact that conducts"),
    tunable("pair.*.*.restitution", Always("1"), RESTITUTION, "coefficient of restitution"),
    tunable("pair.*.*.friction", Always("1"), NON_NEGATIVE, "coefficient of friction"),
    tunable("pair.*.*.rolling_friction", Always("1"), NON_NEGATIVE, "coefficient of rolling friction"),
    tunable("pair.*.*.cohesion_energy_density", Always("J/m3"), NON_NEGATIVE, "cohesion energy density"),
    fixed("pair.*.*.normal_stiffness", ByLaw(stiffness), NON_NEGATIVE, "given normal stiffness"),
    fixed("pair.*.*.tangential_stiffness", ByLaw(stiffness), NON_NEGATIVE, "given tangential stiffness"),
    tunable("pair.*.*.normal_damping", ByLaw(damping), NON_NEGATIVE, "given normal damping over the effective mass"),
    tunable("pair.*.*.tangential_damping", ByLaw(damping), NON_NEGATIVE, "given tangential damping over the effective mass"),
    tunable("pair.*.*.absolute_normal_damping", Always("kg/s"), NON_NEGATIVE, "given normal damping"),
    tunable("pair.*.*.absolute_tangential_damping", Always("kg/s"), NON_NEGATIVE, "given tangential damping"),
    tunable("pair.*.*.fluid_viscosity", Always("Pa.s"), POSITIVE, "viscosity of the fluid between the bodies"),
    tunable("pair.*.*.critical_stokes_number", Always("1"), POSITIVE, "critical Stokes number of the fluid between the bodies"),
    tunable("pair.*.*.maximum_restitution", Always("1"), RESTITUTION, "largest coefficient of restitution"),
    tunable("pair.*.*.rolling_viscous_damping", Always("1"), NON_NEGATIVE, "damping of the rolling spring over its critical damping"),
    tunable("pair.*.*.surface_energy", Always("J/m2"), NON_NEGATIVE, "surface energy, half the work of adhesion"),
    tunable("pair.*.*.damping_coefficient", ByLaw(sticky_damping), NON_NEGATIVE, "damping of jkr and dmt"),
    tunable("pair.*.*.tangential_damping_ratio", Always("1"), NON_NEGATIVE, "tangential damping over normal damping"),
    fixed("pair.*.*.unloading_stiffness_ratio", Always("1"), AT_LEAST_ONE, "stiffness of unloading over that of loading"),
    tunable("pair.*.*.pull_off_force", Always("N"), NON_NEGATIVE, "constant attraction of touching bodies"),
    fixed("pair.*.*.adhesion_stiffness_ratio", Always("1"), NON_NEGATIVE, "stiffness of the adhesion branch over that of loading"),
    fixed("pair.*.*.conductivity", Always("W/(m.K)"), POSITIVE, "conductivity of both materials"),
    fixed("pair.*.*.heat_transfer_coefficient", Always("W/(m2.K)"), NON_NEGATIVE, "heat transfer coefficient of the area of contact"),
    fixed("fluid.*.density", Always("kg/m3"), POSITIVE, "density of the fluid"),
    fixed("fluid.*.viscosity", Always("Pa.s"), POSITIVE, "dynamic viscosity of the fluid"),
    fixed("fluid.*.porosity", Always("1"), RESTITUTION, "part of space that the particles leave to the fluid"),
    fixed("damping.*.linear", Always("1"), FRACTION, "global damping: fraction of the unbalanced force"),
    fixed("damping.*.angular", Always("1"), FRACTION, "global damping: fraction of the unbalanced torque"),
    fixed("bond.*.create_distance", Always("m"), POSITIVE, "distance of the centres below which bonds are made"),
    fixed("bond.*.radius_multiplier", Always("1"), POSITIVE, "bond radius over the smaller radius"),
    fixed("bond.*.normal_stiffness", Always("Pa/m"), POSITIVE, "normal stiffness of the bond for each area"),
    fixed("bond.*.tangential_stiffness", Always("Pa/m"), NON_NEGATIVE, "tangential stiffness of the bond for each area"),
    fixed("bond.*.conductivity", Always("W/(m.K)"), POSITIVE, "conductivity of the bond"),
    fixed("bond.*.breakage.tension_ratio", Always("1"), POSITIVE, "strength in tension over that in compression"),
    fixed("bond.*.breakage.friction_angle", Always("rad"), NON_NEGATIVE, "angle at which shear strength grows with compression"),
    fixed("bond.*.breakage.mohr_coulomb.friction_angle", Always("rad"), NON_NEGATIVE, "angle of internal friction"),
    fixed("bond.*.damping.viscous.*", Always("1"), NON_NEGATIVE, "damping of a part of the bond over its critical damping"),
    fixed("bond.*.damping.opposing.*", Always("1"), FRACTION, "damping of a part of the bond as a share of its load"),
    fixed("bond.*.damping.sign.*", Always("1"), FRACTION, "damping of a part of the bond as a share of its load"),
    fixed("bond.*.damping.smooth.*", Always("1"), FRACTION, "damping of a part of the bond as a share of its load"),
    fixed("bond.*.relaxation.*", Always("s"), POSITIVE, "relaxation time of a part of the bond"),
];

/// Whether a name is one of those that a row's keys stand for.
pub(super) fn is_of(name: &str, keys: &str) -> bool {
    let (mut parts, mut pattern) = (name.split('.'), keys.split('.'));
    loop {
        match (parts.next(), pattern.next()) {
            (None, None) => return true,
            (Some(part), Some(key)) if key == "*" || key == part => {}
            _ => return false,
        }
    }
}
