//! No damping.

use super::Lost;
use crate::bond::{Coefficients, Damping, Elastic, Motion, Pair};
use crate::number::{Number, Vector};

/// A bond that loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct Undamped;

impl Damping for Undamped {
    const ACTIVE: bool = false;
    const NEEDS_MASSES: bool = false;

    #[inline(always)]
    fn damp<N: Number>(_: &Coefficients<N>, _: &Pair<N>, _: &Motion<N>, _: &Elastic<N>) -> Lost<N> {
        Lost { normal: Vector::zero(), shear: Vector::zero(), torsion: Vector::zero(), bending: Vector::zero() }
    }
}
