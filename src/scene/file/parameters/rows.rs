//! The kinds of parameters: keys, unit, range. A new kind is one row.

use crate::base::quantity::Range;

/// A kind of parameter that is fixed once the unit is initialised.
pub(super) struct Row {
    /// Its keys; `*` stands for a name.
    pub(super) keys: &'static str,
    /// Its unit.
    pub(super) unit: &'static str,
    /// Which numbers it takes.
    pub(super) range: Range,
    /// What it is.
    pub(super) about: &'static str,
}

/// One of them.
const fn row(keys: &'static str, unit: &'static str, range: Range, about: &'static str) -> Row {
    Row { keys, unit, range, about }
}

/// All kinds but the settings of the run, the properties of materials and pairs that laws declare, and the strengths of bonds.
#[rustfmt::skip]
pub(super) const ROWS: &[Row] = &[
    row("run.max_overlap", "1", Range::NON_NEGATIVE, "largest overlap at the start over the smaller radius"),
    row("run.skin", "m", Range::POSITIVE, "search distance of neighbours beyond touch"),
    row("material.*.density", "kg/m3", Range::POSITIVE, "density"),
    row("material.*.youngs_modulus", "Pa", Range::POSITIVE, "Young's modulus"),
    row("material.*.poissons_ratio", "1", Range::POISSONS_RATIO, "Poisson's ratio"),
    row("material.*.conductivity", "W/(m.K)", Range::POSITIVE, "conductivity"),
    row("material.*.specific_heat", "J/(kg.K)", Range::POSITIVE, "specific heat"),
    row("material.*.real_youngs_modulus", "Pa", Range::POSITIVE, "Young's modulus of the real bodies, for the area of contact that conducts"),
    row("fluid.*.density", "kg/m3", Range::POSITIVE, "density of the fluid"),
    row("fluid.*.viscosity", "Pa.s", Range::POSITIVE, "dynamic viscosity of the fluid"),
    row("fluid.*.porosity", "1", Range::RESTITUTION, "part of space that the particles leave to the fluid"),
    row("fluid.*.conductivity", "W/(m.K)", Range::POSITIVE, "conductivity of the fluid"),
    row("fluid.*.specific_heat", "J/(kg.K)", Range::POSITIVE, "specific heat of the fluid"),
    row("damping.*.linear", "1", Range::FRACTION, "global damping: fraction of the unbalanced force"),
    row("damping.*.angular", "1", Range::FRACTION, "global damping: fraction of the unbalanced torque"),
    row("bond.*.create_distance", "m", Range::POSITIVE, "distance of the centres below which bonds are made"),
    row("bond.*.radius_multiplier", "1", Range::POSITIVE, "bond radius over the smaller radius"),
    row("bond.*.normal_stiffness", "Pa/m", Range::POSITIVE, "normal stiffness of the bond for each area"),
    row("bond.*.tangential_stiffness", "Pa/m", Range::NON_NEGATIVE, "tangential stiffness of the bond for each area"),
    row("bond.*.conductivity", "W/(m.K)", Range::POSITIVE, "conductivity of the bond"),
    row("bond.*.breakage.tension_ratio", "1", Range::POSITIVE, "strength in tension over that in compression"),
    row("bond.*.breakage.friction_angle", "rad", Range::NON_NEGATIVE, "angle at which shear strength grows with compression"),
    row("bond.*.breakage.mohr_coulomb.friction_angle", "rad", Range::NON_NEGATIVE, "angle of internal friction"),
    row("bond.*.damping.viscous.*", "1", Range::NON_NEGATIVE, "damping of a part of the bond over its critical damping"),
    row("bond.*.damping.opposing.*", "1", Range::FRACTION, "damping of a part of the bond as a share of its load"),
    row("bond.*.damping.sign.*", "1", Range::FRACTION, "damping of a part of the bond as a share of its load"),
    row("bond.*.damping.smooth.*", "1", Range::FRACTION, "damping of a part of the bond as a share of its load"),
    row("bond.*.relaxation.*", "s", Range::POSITIVE, "relaxation time of a part of the bond"),
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
