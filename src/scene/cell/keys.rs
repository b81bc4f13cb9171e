//! `[cell]` as the scene writes it.

use super::{AXES, Cell, CellMotion, ServedStress, StressServo};
use crate::base::document::{Mistake, keys};
use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::STRAINS;
use crate::base::quantity::{Finite, Positive, Triple};
use serde::Deserialize;
use std::collections::BTreeMap;

/// An edge, by the axis that it is along without lean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Edge {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// A component of the strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Component {
    /// Along x
    Xx,
    /// Along y
    Yy,
    /// Along z
    Zz,
    /// Planes across y along x
    Xy,
    /// Planes across z along x
    Xz,
    /// Planes across z along y
    Yz,
}

/// A shear without end.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Shear {
    /// [`Component::Xy`]
    Xy = 3,
    /// [`Component::Xz`]
    Xz,
    /// [`Component::Yz`]
    Yz,
}

/// A servo as the scene writes it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ServoKeys {
    /// What the target starts with \[Pa\].
    stress: Option<Finite>,
    /// The same of the mean of the normal stresses \[Pa\].
    mean_stress: Option<Finite>,
    /// The largest rate of the strain \[1/s\].
    max_rate: Positive,
}

keys! {
    /// `motion` of the cell; a component not named is fixed.
    #[derive(Clone, Debug, Default)]
    pub(in crate::scene) struct MotionKeys {
        /// Components that stay.
        #[serde(default)]
        fixed: Vec<Component> = "all others",
        /// Components that follow the inputs `cell.strain.<component>`.
        #[serde(default)]
        driven: Vec<Component> = "none",
        /// `{ zz = -0.1 }`: components that change at this rate \[1/s\].
        #[serde(default)]
        prescribed: BTreeMap<Component, Finite> = "none",
        /// `{ zz = { stress = -1e5, max_rate = 0.1 } }`: the strain moves, at most at this rate \[1/s\], until the stress \[Pa\],
        /// tension positive, is that of the input `cell.target_stress.zz`, which starts with `stress` (0); `cell.servo_error.zz` is
        /// the error.
        #[serde(default)]
        servo: BTreeMap<Component, ServoKeys> = "none",
        /// `"xy"`, `"xz"` or `"yz"`: this shear follows the input `cell.shear`, as far as you like.
        shear: Option<Shear> = "none",
    }
}

keys! {
    /// `[cell]`
    #[derive(Clone, Debug)]
    pub(in crate::scene) struct CellKeys {
        /// `[[ax, 0, 0], [bx, by, 0], [cx, cy, cz]]` \[m\], as LAMMPS writes tilted boxes; `ax`, `by`, `cz` above 0; faces no nearer to
        /// each other than the largest radius.
        edges: Option<Vec<Triple>> = "those of a file of particles",
        /// The corner from which they go out \[m\]; it stays where it is.
        origin: Option<Triple> = "that of the file, or `[0, 0, 0]`",
        /// Edges that repeat, of `"x"`, `"y"`, `"z"`; along the others it only says the volume.
        periodic: Option<Vec<Edge>> = "all",
        /// What the strains `xx`, `yy`, `zz`, `xy`, `xz`, `yz` do, see below.
        #[serde(default)]
        motion: MotionKeys = "all fixed",
    }
}

impl ServoKeys {
    /// The servo.
    fn servo(&self) -> StressServo {
        let of = if self.mean_stress.is_some() { ServedStress::Mean } else { ServedStress::Own };
        let stress = self.mean_stress.or(self.stress).map_or(0.0, Finite::get);
        StressServo { stress, of, max_rate: self.max_rate.get() }
    }
}

impl MotionKeys {
    /// What its servos cannot be together.
    fn objection(&self) -> Option<Mistake> {
        let mean = |keys: &ServoKeys| keys.mean_stress.map(Finite::get);
        let (found, expected) = if let Some((component, _)) =
            self.servo.iter().find(|(_, keys)| keys.stress.is_some() && keys.mean_stress.is_some())
        {
            let name = STRAINS[*component as usize];
            (format!("both for {name}"), "one of stress and mean_stress")
        } else if let Some((component, _)) =
            self.servo.iter().find(|(component, keys)| **component as usize > 2 && keys.mean_stress.is_some())
        {
            let name = STRAINS[*component as usize];
            (format!("mean_stress for {name}"), "mean_stress for xx, yy and zz only: it is their mean")
        } else {
            let targets: Vec<f64> = self.servo.values().filter_map(mean).collect();
            let other = targets.iter().find(|target| **target != targets[0])?;
            (format!("mean_stress {:?} and {other:?}", targets[0]), "one value: there is one mean")
        };
        Some(Mistake::Unexpected { found, expected: expected.to_owned() })
    }
}

impl CellKeys {
    /// The cell, beside files that say this box; reports what is wrong in the table itself.
    pub(in crate::scene) fn cell(
        &self,
        box_of_file: Option<Lattice>,
        report: &mut dyn FnMut(&str, Mistake),
    ) -> Option<Cell> {
        let mut twice = |key: &str, name: &str| {
            let (found, expected) = (format!("{name} twice"), "each once".to_owned());
            report(key, Mistake::Unexpected { found, expected });
        };
        let mut periodic = [self.periodic.is_none(); 3];
        for edge in self.periodic.iter().flatten() {
            if std::mem::replace(&mut periodic[*edge as usize], true) {
                twice("periodic", AXES[*edge as usize]);
            }
        }
        let MotionKeys { fixed, driven, prescribed, servo, shear } = &self.motion;
        let shear = shear.map(|shear| shear as usize);
        let named = (fixed.iter().map(|component| (*component as usize, CellMotion::Fixed)))
            .chain(driven.iter().map(|component| *component as usize).chain(shear).map(|it| (it, CellMotion::Driven)))
            .chain(prescribed.iter().map(|(component, rate)| (*component as usize, CellMotion::Prescribed(rate.get()))))
            .chain(servo.iter().map(|(component, keys)| (*component as usize, CellMotion::Servo(keys.servo()))));
        let mut motion = [None; 6];
        for (component, moves) in named {
            if motion[component].replace(moves).is_some() {
                twice("motion", STRAINS[component]);
            }
        }
        if let Some(mistake) = self.motion.objection() {
            report("motion.servo", mistake);
        }
        let lattice = match (&self.edges, box_of_file) {
            (Some(edges), _) => match edges[..] {
                [a, b, c] => Lattice { edges: [a, b, c].map(Triple::get), ..Lattice::default() },
                _ => {
                    let (found, expected) = (format!("{} edges", edges.len()), "three edges [x, y, z]".to_owned());
                    report("edges", Mistake::Unexpected { found, expected });
                    return None;
                }
            },
            (None, Some(lattice)) => lattice,
            (None, None) => {
                let expected = "three edges [x, y, z], or a file of particles that says its box".to_owned();
                report("edges", Mistake::Missing { expected });
                return None;
            }
        };
        let origin = self.origin.map_or(lattice.origin, Triple::get);
        Some(Cell {
            lattice: Lattice { origin, periodic, ..lattice },
            motion: motion.map(Option::unwrap_or_default),
            shear,
        })
    }
}
