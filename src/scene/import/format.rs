//! What a particle file is and which units it has, as a scene says it.

use serde::Deserialize;

/// Formats of particle files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Format {
    /// Comma-separated columns.
    Csv,
    /// VTK's XML unstructured grid.
    Vtu,
    /// Data file of LIGGGHTS or LAMMPS.
    Data,
    /// Dump file of LIGGGHTS or LAMMPS.
    Dump,
    /// The spheres of one body, as LIGGGHTS reads them: known by the name of the file alone.
    #[serde(skip)]
    Multisphere,
}

/// Units of particle files, by the names that LIGGGHTS and LAMMPS have for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Units {
    /// Metre, kilogram, second.
    Si,
    /// Centimetre, gram, second.
    Cgs,
    /// Micrometre, picogram, microsecond.
    Micro,
    /// Nanometre, attogram, nanosecond.
    Nano,
}

impl Units {
    /// The units of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        [("si", Self::Si), ("cgs", Self::Cgs), ("micro", Self::Micro), ("nano", Self::Nano)]
            .into_iter()
            .find_map(|(known, units)| (known == name).then_some(units))
    }

    /// Length \[m\], mass \[kg\] and time \[s\] of one.
    pub(crate) fn sizes(self) -> [f64; 3] {
        match self {
            Self::Si => [1.0, 1.0, 1.0],
            Self::Cgs => [1e-2, 1e-3, 1.0],
            Self::Micro => [1e-6, 1e-15, 1e-6],
            Self::Nano => [1e-9, 1e-21, 1e-9],
        }
    }
}
