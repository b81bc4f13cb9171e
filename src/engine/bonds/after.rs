//! What follows a formulation, a register's worth of bonds at a time: damping and rules of breakage. Each is compiled once
//! for each lane width, whatever the formulation; a law without them calls nothing.

use super::pipeline_buffer::PipelineBuffer;
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::laws::bond::breakage::Rule;
use crate::laws::bond::damping::{Damping, TakeDamping};
use crate::laws::bond::{Elasticity, Law};

/// Damping and rules of breakage of a law.
pub(super) struct After {
    /// Damping, if there is any.
    pub(super) damping: Option<Box<dyn OnLanes>>,
    /// Whether it looks at masses and moments of inertia.
    pub(super) needs_masses: bool,
    /// [`Law::foresees`]
    pub(super) foresees: bool,
    /// Rules of breakage, in their order, and how far the codes of their causes lie above their places.
    pub(super) breakage: Vec<(Rule, f64)>,
}

/// Something that is done with what a formulation answered.
pub(super) trait OnLanes: Send + Sync {
    /// Does it.
    fn run(&self, width: Width, bonds: Bonds);
}

/// A register's worth of bonds.
pub(super) struct Bonds<'a> {
    /// Section and stiffnesses.
    pub(super) elasticity: &'a Elasticity,
    /// Time since bonds were last advanced \[s\].
    pub(super) step: f64,
    /// What the formulation answered.
    pub(super) buffer: &'a mut PipelineBuffer,
    /// The turn of the pipeline.
    pub(super) turn: usize,
    /// First column of the pairs of that turn.
    pub(super) start: usize,
}

impl After {
    /// Those of a law.
    pub(super) fn of(law: &Law) -> Self {
        let damping = law.damping.map(|damping| damping.visit(BoxDamping));
        let (damping, needs_masses) = damping.map_or((None, false), |(damping, needs)| (Some(damping), needs));
        let breakage = law.rules().map(|(rule, before)| (rule.clone(), before)).collect();
        Self { damping, needs_masses, foresees: law.foresees, breakage }
    }

    /// Whether anything follows.
    pub(super) fn is_empty(&self) -> bool {
        self.damping.is_none() && self.breakage.is_empty()
    }
}

/// Makes the work of a damping model; and whether it needs masses.
struct BoxDamping;

impl TakeDamping for BoxDamping {
    type Output = (Box<dyn OnLanes>, bool);
    fn take<D: Damping>(self, damping: D) -> Self::Output {
        (Box::new(Damp(damping)), D::NEEDS_MASSES)
    }
}

/// Damping.
struct Damp<D>(D);

impl<D: Damping> OnLanes for Damp<D> {
    fn run(&self, width: Width, bonds: Bonds) {
        lanes::run(width, DampBonds { damping: &self.0, bonds });
    }
}

/// Damping of a register's worth of bonds.
struct DampBonds<'a, 'b, D> {
    /// The model.
    damping: &'a D,
    /// The bonds.
    bonds: Bonds<'b>,
}

impl<D: Damping> Kernel for DampBonds<'_, '_, D> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Bonds { elasticity, step, buffer, turn, start } = self.bonds;
        let law = elasticity.at_step::<N>(step);
        let (pair, motion, elastic) = buffer.moving::<N>(turn, start, &law);
        let load = self.damping.damp(&law, &pair, &motion, &elastic).load(&pair, &motion);
        let last = buffer.answer.damping::<N>().taken(&pair, law.step);
        buffer.put_damped(turn, &elastic, &load, [last, load.taken(&pair, law.step)]);
    }
}
