//! What springs against rolling have in common.

use crate::base::document::keys;
use crate::base::number::{Number, Vector};
use crate::base::quantity::Positive;
use crate::laws::contact::{Contact, HistoryRow, Needs, Objection, RollingResponse};

/// What a rolling spring remembers: its torque.
pub(super) const HISTORY: HistoryRow =
    HistoryRow { name: "rolling torque", odd: [true, true, true, false], fourth_is_free: false };

/// What of a contact it looks at.
pub(super) const NEEDS: Needs = Needs { torque: true, spin: true, bodies: true, ..Needs::NONE };

keys! {
    /// `[contact.<law>.rolling.<model>]` of models with a spring.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// Whether spin about the normal is resisted, too.
        #[serde(default)]
        pub torsion: bool = "`false`",
        /// Whether spin at a wall, the direction of the torque and the first evaluation are as in the engine.
        #[serde(default)]
        pub engine_exact: bool = "`false`",
        /// With `engine_exact` only: the step by which the engine stretches the spring before the first step \[s\].
        pub set_up_step: Option<Positive> = "none",
    }
}

impl Keys {
    /// What speaks against them, if anything.
    pub(super) fn objection(&self) -> Option<Objection> {
        let reason = "expected engine_exact = true beside a step of the engine, found it alone";
        (self.set_up_step.is_some() && !self.engine_exact).then_some(Objection {
            table: "rolling",
            key: "set_up_step",
            reason,
        })
    }

    /// As numbers: torsion, engine, step of the set-up \[s\].
    pub(super) fn numbers(self) -> [f64; 3] {
        let number = |yes: bool| if yes { 1.0 } else { 0.0 };
        let set_up = self.set_up_step.map_or(0.0, Positive::get);
        [number(self.torsion), number(self.engine_exact), set_up]
    }
}

/// Overlap over radius up to which the stable step follows the engine's arms at a wall, which have no bound at the centre.
const DEEPEST: f64 = 0.5;

/// What spring and dashpot of these coefficients \[N m\], \[N m s\] are to the stable step, by 1 or 0 for `torsion` and `engine`.
pub(super) fn response(
    contact: &Contact,
    [stiffness, damping]: [f64; 2],
    torsion: f64,
    engine: f64,
) -> RollingResponse {
    let at_wall = engine > 0.5 && contact.per_reach <= 0.0;
    let overlap = contact.overlap.min(DEEPEST * contact.radius);
    let stretched = if at_wall { spin_at_wall(&Contact { overlap, ..*contact }) } else { 1.0 };
    let [bending_stiffness, bending_damping] = [stiffness, damping].map(|part| part * stretched);
    let [torsional_stiffness, torsional_damping] = [bending_stiffness, bending_damping].map(|part| part * torsion);
    RollingResponse { bending_stiffness, bending_damping, torsional_stiffness, torsional_damping }
}

/// How many times as fast as the body's the engine sees a spin at a wall: as if the arm were (R − δ/2)/(R − δ) times as long.
#[inline(always)]
fn spin_at_wall<N: Number>(contact: &Contact<N>) -> N {
    (contact.radius - N::splat(0.5) * contact.overlap) / (contact.radius - contact.overlap)
}

/// A spring against rolling at this moment.
#[derive(Clone, Copy)]
pub(super) struct Spring<N> {
    /// Its stiffness \[N m\].
    pub(super) stiffness: N,
    /// Damping beside it \[N m s\].
    pub(super) damping: N,
    /// The largest torque of the spring \[N m\].
    pub(super) limit: N,
    /// 1 where spin about the normal is resisted, too.
    pub(super) torsion: N,
    /// 1 where all is as in the engine.
    pub(super) engine: N,
    /// Step of the engine's set-up \[s\].
    pub(super) set_up: N,
}

impl<N: Number> Spring<N> {
    /// The torque taken from i and what is to be remembered.
    #[inline(always)]
    pub(super) fn torque(self, contact: &Contact<N>, history: [N; 4], step: N) -> (Vector<N>, [N; 4]) {
        let (half, one, normal) = (N::splat(0.5), N::splat(1.0), contact.normal);
        let engine = self.engine.greater(half);
        let rolls_only = half.greater(self.torsion);
        let of_engine = N::select(engine, one, N::zero());
        let at_wall = N::select(contact.per_reach.greater(N::zero()), N::zero(), of_engine).greater(half);
        let spin = contact.relative_spin * N::select(at_wall, spin_at_wall(contact), one);
        let spin = Vector::select(rolls_only, spin - normal * spin.dot(normal), spin);
        let moved = step.greater(N::zero());
        let before = Vector::of_row(history);
        let turned = before - normal * before.dot(normal);
        let keeps_direction = N::either(engine, half.greater(one - self.torsion));
        let before = Vector::select(keeps_direction, before, turned);
        let grown = before + spin * (self.stiffness * N::select(moved, step, self.set_up));
        let square = grown.dot(grown);
        let rolling = square.greater(self.limit * self.limit);
        let kept = N::select(rolling, self.limit / square.sqrt(), one);
        let spring = grown * kept;
        let damping = N::select(rolling, N::zero(), self.damping);
        let remembered = Vector::select(moved, spring, Vector::of_row(history));
        (spring + spin * damping, remembered.row_with(N::zero()))
    }
}
