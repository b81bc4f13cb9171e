//! A register's worth of bonds, as rules of breakage look at them.

use super::Loaded;
use crate::base::lanes::{Column, Lane, put, take, vector_of, vector_parts};
use crate::laws::bond::{Elastic, Motion, Pair, Section};

/// A register's worth of bonds under their loads, and why they break.
pub(crate) struct LoadedBonds {
    /// Distance, smaller radius.
    pub(crate) size: [Column; 2],
    /// Compression, normal force, shear force, torsion, bending torque.
    pub(crate) elastic: [Column; 9],
    /// 0, or why a bond broke: the code of [`crate::laws::bond::Law::cause_name`].
    pub(crate) cause: [Column; 1],
    /// Whether any broke.
    pub(crate) breaks: bool,
}

impl LoadedBonds {
    /// None.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { size: [[0.0; 8]; 2], elastic: [[0.0; 8]; 9], cause: [[0.0; 8]], breaks: false }
    }

    /// Writes bonds that hold.
    #[inline(always)]
    pub(crate) fn put<N: Lane>(&mut self, pair: &Pair<N>, motion: &Motion<N>, elastic: &Elastic<N>) {
        put(&mut self.size, 0, [motion.distance, pair.least_radius]);
        put(&mut self.elastic, 0, [elastic.compression, elastic.normal]);
        put(&mut self.elastic, 2, vector_parts(elastic.shear));
        put(&mut self.elastic, 5, [elastic.torsion]);
        put(&mut self.elastic, 6, vector_parts(elastic.bending));
        put(&mut self.cause, 0, [N::zero()]);
        self.breaks = false;
    }

    /// The bonds.
    #[inline(always)]
    pub(super) fn loaded<N: Lane>(&self, radius_multiplier: N) -> Loaded<N> {
        let [distance, least_radius] = take(&self.size, 0);
        let [compression, normal] = take(&self.elastic, 0);
        let [torsion] = take(&self.elastic, 5);
        Loaded {
            distance,
            section: Section::of(radius_multiplier, least_radius),
            compression,
            normal,
            shear: vector_of(take(&self.elastic, 2)),
            torsion,
            bending: vector_of(take(&self.elastic, 6)),
        }
    }

    /// Enters what a rule found: the codes of causes, 0 where a bond holds. The first cause of a bond stays.
    #[inline(always)]
    pub(super) fn enter_causes<N: Lane>(&mut self, found: N) {
        let [cause] = take::<N, 1>(&self.cause, 0);
        let all = N::select(cause.greater(N::zero()), cause, found);
        put(&mut self.cause, 0, [all]);
        self.breaks |= N::any(all.greater(N::zero()));
    }
}
