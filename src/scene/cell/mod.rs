//! `[cell]`: a parallelepiped that repeats, and how it is deformed.

mod keys;
mod lattice;
mod refused;
mod repeated;

pub(in crate::scene) use keys::CellKeys;
#[cfg(test)]
pub(in crate::scene) use keys::MotionKeys;
pub(in crate::scene) use lattice::{box_objection, fault_of};
pub(in crate::scene) use refused::objections;
pub(in crate::scene) use repeated::{repeat_surfaces, with_images};

use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::STRAIN_PLACES;

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Most images of a particle along an edge, and most copies of a surface on each side.
const MOST_IMAGES: f64 = 10.0;

/// A periodic cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Where it stands, and along which edges it repeats.
    pub lattice: Lattice,
    /// What each component of its strain does: xx, yy, zz, xy, xz, yz.
    pub motion: [CellMotion; 6],
    /// The component whose input is `cell.shear`.
    pub shear: Option<usize>,
}

/// What a component of the strain does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CellMotion {
    /// It stays.
    #[default]
    Fixed,
    /// It follows an input.
    Driven,
    /// It changes at this rate \[1/s\].
    Prescribed(f64),
    /// It reaches a stress.
    Servo(StressServo),
}

/// A component of the strain that reaches a stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressServo {
    /// What the target starts with \[Pa\].
    pub stress: f64,
    /// Which stress that is.
    pub of: ServedStress,
    /// The largest rate of the strain \[1/s\].
    pub max_rate: f64,
}

/// Which stress a servo of the cell reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ServedStress {
    /// That of its own component.
    #[default]
    Own,
    /// The mean of the three normal ones: the components with such a servo have what the others leave of it, in equal parts.
    Mean,
}

impl CellMotion {
    /// Whether a servo of it reaches the mean of the normal stresses.
    pub(crate) fn serves_mean(&self) -> bool {
        self.servo().is_some_and(|servo| servo.of == ServedStress::Mean)
    }

    /// What the target of its servo is compared with, where these are the stresses of the cell \[Pa\].
    pub(crate) fn served(&self, component: usize, stresses: &[f64; 6]) -> f64 {
        if self.serves_mean() { stresses[..3].iter().sum::<f64>() / 3.0 } else { stresses[component] }
    }

    /// The stress that a component among these has where its servo reaches a target while the others have these stresses \[Pa\].
    pub(crate) fn wanted(all: &[Self; 6], component: usize, target: f64, stresses: &[f64; 6]) -> f64 {
        if !all[component].serves_mean() {
            return target;
        }
        let (mut left, mut sharing) = (3.0 * target, 0.0);
        for (motion, stress) in all.iter().zip(stresses).take(3) {
            match motion.serves_mean() {
                true => sharing += 1.0,
                false => left -= stress,
            }
        }
        left / sharing
    }

    /// The servo, if it is one.
    pub(crate) fn servo(&self) -> Option<&StressServo> {
        if let Self::Servo(servo) = self { Some(servo) } else { None }
    }

    /// What its input starts with.
    pub(crate) fn first_input(self) -> f64 {
        self.servo().map_or(0.0, |servo| servo.stress)
    }
}

impl Cell {
    /// Whether anything deforms it.
    pub fn moves(&self) -> bool {
        self.motion.iter().any(|motion| *motion != CellMotion::Fixed)
    }

    /// Whether the edges repeat that a component of the strain changes.
    pub fn repeats(&self, component: usize) -> bool {
        STRAIN_PLACES[component].iter().all(|&edge| self.lattice.periodic[edge])
    }
}
