//! Damping of bonds: force and torque added to the elastic ones. One model a file.
//!
//! The bond's own state and its breakage do not see damping.

pub mod componentwise;
pub mod none;
pub mod opposing;
pub mod viscous;

use super::{Coefficients, Elastic, Motion, Pair};
use crate::number::{Number, Vector};

/// What damping adds to each part.
#[derive(Clone, Copy, Debug)]
pub struct Lost<N: Number> {
    /// To the normal force on i \[N\].
    pub normal: Vector<N>,
    /// To the shear force on i, which turns both bodies by their arms \[N\].
    pub shear: Vector<N>,
    /// To the torsion on i \[N m\].
    pub torsion: Vector<N>,
    /// To the bending torque on i \[N m\].
    pub bending: Vector<N>,
}

/// A damping model.
pub trait Damping: Send + Sync + 'static {
    /// Whether it adds anything.
    const ACTIVE: bool;
    /// Whether it looks at masses and moments of inertia.
    const NEEDS_MASSES: bool;
    /// What it adds.
    fn damp<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, motion: &Motion<N>, elastic: &Elastic<N>) -> Lost<N>;
}
