//! A stored case: what it says of bodies and bonds, its samples, and the law its flags mean.

use crate::bond::creation::Creation;
use crate::bond::keys::{BreakageKeys, DampingChoice, FormulationChoice, Keys, PartKeys};
use crate::number::Vector;
use crate::quantity::{Fraction, NonNegative, Positive};
use serde_json::Value;
use std::path::PathBuf;

/// One file of numbers: names of the columns, rows.
pub(super) struct Table {
    /// Names of the columns.
    names: Vec<String>,
    /// Rows.
    pub(super) rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a file.
    fn read(path: PathBuf) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let names = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let rows = reader.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect());
        Self { names, rows: rows.collect() }
    }

    /// Where a column stands.
    pub(super) fn column(&self, name: &str) -> usize {
        self.names.iter().position(|other| other == name).unwrap()
    }

    /// Three columns from this name on.
    pub(super) fn vector(&self, row: &[f64], first: &str) -> Vector {
        let at = self.column(first);
        Vector::new(row[at], row[at + 1], row[at + 2])
    }
}

/// A case of `tests/reference/bond`.
pub(super) struct Case {
    /// `case.json`.
    pub(super) json: Value,
    /// `samples.csv`.
    pub(super) samples: Table,
    /// `bonds.csv`, where there is one.
    pub(super) bonds: Option<Table>,
}

/// A vector from JSON.
pub(super) fn vector(value: &Value) -> Vector {
    let number = |index: usize| value[index].as_f64().unwrap();
    Vector::new(number(0), number(1), number(2))
}

impl Case {
    /// Reads a case by its name.
    pub(super) fn read(name: &str) -> Self {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference/bond").join(name);
        let json = std::fs::read_to_string(folder.join("case.json")).unwrap();
        let bonds = folder.join("bonds.csv");
        Self {
            json: serde_json::from_str(&json).unwrap(),
            samples: Table::read(folder.join("samples.csv")),
            bonds: bonds.exists().then(|| Table::read(bonds)),
        }
    }

    /// A case that no file holds.
    pub(super) fn made(json: Value) -> Self {
        Self { json, samples: Table { names: Vec::new(), rows: Vec::new() }, bonds: None }
    }

    /// The property of two types, where the case gives it.
    fn property(&self, name: &str, types: [usize; 2]) -> Option<f64> {
        self.json["pair_properties"][name][types[0]][types[1]].as_f64()
    }

    /// A flag of the law, with its default.
    fn flag(&self, name: &str, default: bool) -> bool {
        self.json["model"][name].as_bool().unwrap_or(default)
    }

    /// One number for each part, from properties of these names.
    fn parts<T: Copy>(&self, kind: &str, types: [usize; 2], checked: fn(f64) -> Option<T>) -> PartKeys<T> {
        let part = |name: &str| checked(self.property(&format!("{kind}{name}Bond"), types).unwrap());
        PartKeys {
            normal_force: part("NormalForce"),
            tangential_force: part("TangentialForce"),
            normal_torque: part("NormalTorque"),
            tangential_torque: part("TangentialTorque"),
        }
    }

    /// The table that a scene would have for two types; `None` where they do not bond.
    pub(super) fn keys(&self, formulation: FormulationChoice, types: [usize; 2]) -> Option<Keys> {
        let positive = |name: &str| self.property(name, types).and_then(Positive::new);
        let stress = self.flag("stressBreak", false);
        let degrees = self.property("frictionAngle", types).filter(|_| self.flag("druckerPrager", false));
        let tension_ratio = positive("ratioTensionCompression").filter(|_| self.flag("ratioTensionCompression", false));
        let smooth = self.flag("dampingBondSmooth", false);
        let damped = self.flag("dampingBond", true) || smooth;
        let choice = if smooth { DampingChoice::Smooth } else { DampingChoice::Sign };
        Some(Keys {
            formulation,
            between: Default::default(),
            create: if self.flag("createBondAlways", false) {
                Creation::Always
            } else {
                Creation::Step(self.json["pair_properties"]["tsCreateBond"].as_u64().unwrap())
            },
            create_distance: positive("createDistanceBond"),
            radius_multiplier: Some(positive("radiusMultiplierBond")?),
            normal_stiffness: positive("normalBondStiffnessPerUnitArea")?,
            tangential_stiffness: self
                .property("tangentialBondStiffnessPerUnitArea", types)
                .and_then(NonNegative::new)?,
            tension: self.flag("tensionStress", true),
            compression: self.flag("compressionStress", true),
            shear: self.flag("shearStress", true),
            torsion: self.flag("normalTorqueStress", true),
            bending: self.flag("shearTorqueStress", true),
            contact: Default::default(),
            breakage: Some(BreakageKeys {
                max_distance: positive("maxDistanceBond").filter(|_| !stress),
                max_normal_stress: positive("maxSigmaBond").filter(|_| stress),
                max_shear_stress: positive("maxTauBond").filter(|_| stress),
                tension_ratio,
                friction_angle: degrees.and_then(|angle| NonNegative::new(angle.to_radians())),
                compression_breaks: stress.then_some(true),
            }),
            damping: damped.then(|| choice(self.parts("damping", types, Fraction::new))),
            relaxation: self.flag("dissipationBond", false).then(|| self.parts("dissipation", types, Positive::new)),
            temperature_break: None,
        })
    }
}
