//! Quantities of particles beside those of motion.

use crate::laws::contact::Material;
use std::fmt;

/// A number of every particle beside those of motion, such as a temperature, declared once.
///
/// Where a scene asks for it, the state has a column of it. That column is sorted, given to images, saved, restored, checked, written to frames,
/// read from particle sets, their files and insertions, and taken over by a later scene, without another line.
#[derive(Clone, Copy)]
pub struct Column {
    /// Its key in `[particles.<name>]`, their lists and `[insertion.<name>]`, and its name in files and frames.
    pub name: &'static str,
    /// Its unit, as variables of a unit have it.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// Its names in files of other programs.
    pub aliases: &'static [&'static str],
    /// Which finite numbers it takes.
    pub takes: fn(f64) -> bool,
    /// The words for these in a message.
    pub expected: &'static str,
    /// With what particles begin that say nothing; none: each must say it.
    pub start: Option<f64>,
    /// Given where the particles of a group, and the spheres of a clump, have one value: by how much one of this material and mass \[kg\]
    /// counts in the mean of several.
    pub shared: Option<fn(&Material, f64) -> f64>,
    /// Tables and keys of a scene that ask for it, dotted, `*` for any name: `contact.*.heat`.
    pub asked_by: &'static [&'static str],
}

impl fmt::Debug for Column {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// Temperature of a particle.
pub static TEMPERATURE: Column = Column {
    name: "temperature",
    unit: "K",
    about: "temperature",
    aliases: &["f_Temp[0]", "f_Temp"],
    takes: |value| value > 0.0,
    expected: "a number above 0",
    start: None,
    shared: Some(|material, mass| mass * material.thermal.specific_heat.unwrap_or(1.0)),
    asked_by: &["contact.*.heat", "bond.*.conductivity", "heat_source", "heat.from_losses", "fluid.*.heat"],
};
