//! What a contact loses in a step, by kind: found beside the law from what its sub-models answered, so that no sub-model
//! knows of it.
//!
//! A force acts half a step before its evaluation and half a step after it. Work is therefore booked as the integrator makes
//! it: the way of the step times the mean of the forces at its beginning, which are remembered ([`Seen::before`]), and at
//! its end. All sums here are twice the losses, so that no mean is halved before they are handed out. No loss is the rest of a
//! balance, but those of rolling, sticky and plastic models: there the work is booked, and what the models then hold is taken off
//! where somebody asks.

use super::{Contact, NormalForce};
use crate::base::number::{Number, Vector};

/// Kinds of loss that are found contact by contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LossKind {
    /// Dashpots along the normal.
    Normal,
    /// Dashpots in the tangent plane.
    Tangential,
    /// Friction at its limit.
    Sliding,
    /// Change of the tangential stiffness.
    Stiffness,
    /// Springs that are projected.
    Projection,
    /// Work against rolling torque.
    Rolling,
    /// Work against normal forces that are neither spring nor dashpot.
    Other,
}

impl LossKind {
    /// How many there are.
    pub const COUNT: usize = 7;
}

/// Which kinds of loss warm the bodies, by their place.
pub type Warming = [bool; LossKind::COUNT];

/// What a book of losses has to know of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Booked {
    /// Whether there is friction.
    pub friction: bool,
    /// Whether friction has a spring.
    pub spring: bool,
    /// Whether the fourth number beside the spring is its stiffness.
    pub keeps_stiffness: bool,
    /// Whether dashpot and spring together stand at the limit of friction.
    pub limits_dashpot: bool,
    /// Whether the part of the spring along the normal is lost.
    pub projects: bool,
    /// Whether there is rolling torque.
    pub rolling: bool,
    /// Whether the normal model is a spring k_n δ and a dashpot.
    pub presses: bool,
    /// Whether part of the normal force is neither the spring nor the dashpot of a pressed contact.
    pub other: bool,
    /// Whether springs are carried at mid-step.
    pub carries: bool,
    /// Whether dashpots along the normal, and nothing else, see another velocity than that of mid-step.
    pub predicts_normal_alone: bool,
    /// Where the least normal force stands among the coefficients.
    pub least_force: usize,
    /// Which losses warm the bodies.
    pub warming: Warming,
    /// Whether contacts are followed one by one.
    pub follows: bool,
}

impl Booked {
    /// Whether anything is to be kept that sub-models change.
    pub fn keeps_before(&self) -> bool {
        self.spring || self.moves_otherwise()
    }

    /// Whether a kind of loss, by its place, can occur.
    #[inline(always)]
    pub fn takes(&self, kind: usize) -> bool {
        let [rolling, other] = [LossKind::Rolling as usize, LossKind::Other as usize];
        (kind != rolling || self.rolling) && (kind != other || self.other)
    }

    /// Whether losses warm the bodies.
    #[inline(always)]
    pub fn warms(&self) -> bool {
        self.warming != [false; LossKind::COUNT]
    }

    /// What of these losses is heat \[J\].
    #[inline(always)]
    pub fn heat<N: Number>(&self, lost: &[N; LossKind::COUNT]) -> N {
        let mut heat = N::zero();
        for (loss, warms) in lost.iter().zip(self.warming) {
            if warms {
                heat = heat + *loss;
            }
        }
        heat
    }

    /// What of these losses is along the normal and what across it \[J\]; rolling is across it.
    #[inline(always)]
    pub fn by_direction<N: Number>(&self, lost: &[N; LossKind::COUNT]) -> [N; 2] {
        let (mut along, mut across, mut kind) = (N::zero(), N::zero(), 0);
        while kind < LossKind::COUNT {
            if self.takes(kind) && (kind == LossKind::Normal as usize || kind == LossKind::Other as usize) {
                along = along + lost[kind];
            } else if self.takes(kind) {
                across = across + lost[kind];
            }
            kind += 1;
        }
        [along, across]
    }

    /// Whether bodies move otherwise than dashpots see.
    pub fn moves_otherwise(&self) -> bool {
        self.carries || self.predicts_normal_alone
    }
}

/// What a book of losses sees of a contact.
pub struct Seen<N: Number> {
    /// The contact as the law saw it: its dashpots, these velocities.
    pub contact: Contact<N>,
    /// What the normal model answered.
    pub normal: NormalForce<N>,
    /// Overlap from which the elastic force is taken \[m\].
    pub pressing: N,
    /// Lower bound of the force of normal spring and dashpot \[N\].
    pub least_force: N,
    /// Whether the normal force and rolling torque act.
    pub acts: bool,
    /// How far the bodies went from each other along the normal in this step \[m\].
    pub normal_displacement: N,
    /// How far i went by j in the tangent plane in this step \[m\].
    pub tangential_displacement: Vector<N>,
    /// Angle by which i turned against j in this step \[rad\].
    pub turn: Vector<N>,
    /// Force on i \[N\], that along the normal among it if it acts.
    pub force: Vector<N>,
    /// Rolling torque \[N m\].
    pub rolling: Vector<N>,
    /// Tangential spring before \[m\].
    pub spring_before: Vector<N>,
    /// What friction remembers now.
    pub spring: [N; 4],
    /// Whether friction is at its limit.
    pub sliding: N::Mask,
    /// What the book remembers: k_t \[N/m\] with the force of both dashpots on i \[N\]; the normal force that is neither spring nor
    /// dashpot \[N\] with the rolling torque \[N m\].
    pub before: [[N; 4]; 2],
}

impl<N: Number> Seen<N> {
    /// Twice what the contact loses \[J\], by [`LossKind`], and what is to be remembered.
    #[inline(always)]
    pub fn twice_losses(&self, booked: &Booked) -> ([N; LossKind::COUNT], [[N; 4]; 2]) {
        let mut lost = [N::zero(); LossKind::COUNT];
        let normal = self.contact.normal;
        let (damping, other) = self.dashpot(booked);
        let [stiffness_before, x, y, z] = self.before[0];
        let before = Vector::new(x, y, z);
        let along = before.dot(normal) + damping;
        lost[LossKind::Normal as usize] = -(along * self.normal_displacement);
        let (mut stiffness, mut dashpots) = (N::zero(), normal * damping);
        if booked.friction {
            let pressing = if self.acts { self.normal.force - damping } else { N::zero() };
            dashpots = self.force - normal * pressing;
            let mut slipped = N::zero();
            if booked.spring {
                stiffness = self.normal.response.tangential_stiffness;
                stiffness = if booked.keeps_stiffness { self.spring[3] } else { stiffness };
                dashpots += Vector::of_row(self.spring) * stiffness;
                let [lost_by_both, projected] = self.spring_losses([stiffness_before, stiffness], booked.projects);
                if N::any(self.sliding) {
                    let gained = (stiffness - stiffness_before) * self.spring_before.dot(Vector::of_row(self.spring));
                    slipped = N::select(self.sliding, lost_by_both + gained, N::zero());
                }
                lost[LossKind::Stiffness as usize] = lost_by_both - slipped;
                lost[LossKind::Projection as usize] = projected;
            }
            let mut taken = (before + dashpots).dot(self.tangential_displacement);
            if booked.carries {
                // The tangent plane is that of mid-step.
                taken = taken - along * normal.dot(self.tangential_displacement);
            }
            let mut damped = -taken;
            if booked.limits_dashpot {
                let rubbed = N::select(self.sliding, damped, N::zero());
                (damped, slipped) = (damped - rubbed, slipped + rubbed);
            }
            lost[LossKind::Tangential as usize] = damped;
            lost[LossKind::Sliding as usize] = slipped;
        }
        let mut rolling = Vector::zero();
        let [other_before, x, y, z] = self.before[1];
        if booked.other {
            lost[LossKind::Other as usize] = -((other_before + other) * self.normal_displacement);
        }
        if booked.rolling && self.acts {
            rolling = self.rolling;
            lost[LossKind::Rolling as usize] = (Vector::new(x, y, z) + rolling).dot(self.turn);
        }
        (lost, [[stiffness, dashpots.x, dashpots.y, dashpots.z], [other, rolling.x, rolling.y, rolling.z]])
    }

    /// Force of the dashpot along the normal, and of what is neither that nor the spring \[N\].
    #[inline(always)]
    fn dashpot(&self, booked: &Booked) -> (N, N) {
        if !self.acts {
            return (N::zero(), N::zero());
        }
        let response = &self.normal.response;
        let elastic = response.normal_stiffness * self.pressing;
        if !booked.other {
            return (self.normal.force - elastic, N::zero());
        }
        let damping = -(response.normal_damping * self.contact.normal_velocity);
        if !booked.presses {
            return (damping, self.normal.force - damping);
        }
        let pressed = (elastic + damping).max(self.least_force);
        (pressed - elastic, self.normal.force - pressed)
    }

    /// Twice what a spring loses by its stiffness and by friction at its limit together, what friction takes of that, and what is
    /// projected, of stiffnesses before and now \[J\].
    ///
    /// ```text
    /// W = ½ (k₀ s₀ + k s)·Δ                   work on the spring
    /// P = ½ k₀ (s₀·n)²                        projected
    /// L = W − ½ k s² + ½ k₀ s₀² − P           lost by both
    ///   = ½ k₀ s₀·(Δ + s₀) + ½ k s·(Δ − s) − P
    /// S = W + ½ (k₀ s₀ + k s)·(s₀ − s) − P    the same mean force times what did not stretch the spring
    ///   = L + ½ (k − k₀) s₀·s
    /// ```
    #[inline(always)]
    fn spring_losses(&self, [stiffness_before, stiffness]: [N; 2], projects: bool) -> [N; 2] {
        let (before, now) = (self.spring_before, Vector::of_row(self.spring));
        let mut lost = before.dot(before + self.tangential_displacement) * stiffness_before
            + (now * stiffness).dot(self.tangential_displacement - now);
        let mut projected = N::zero();
        if projects {
            let along = before.dot(self.contact.normal);
            projected = stiffness_before * along * along;
            lost = lost - projected;
        }
        [lost, projected]
    }
}

/// Twice what is lost with a contact whose bodies have parted: of this motion and time step \[s\], of which the loads that are
/// remembered acted for half; by [`LossKind`], and twice what the spring held that friction remembers \[J\].
pub(crate) fn parting(
    booked: &Booked,
    contact: &Contact,
    step: f64,
    spring: Vector,
    before: [[f64; 4]; 2],
) -> ([f64; LossKind::COUNT], f64) {
    let (mut lost, mut held) = ([0.0; LossKind::COUNT], 0.0);
    let [stiffness, x, y, z] = before[0];
    let (loads, normal) = (Vector::new(x, y, z), contact.normal);
    let along = loads.dot(normal);
    lost[LossKind::Normal as usize] = -(along * contact.normal_velocity * step);
    if booked.friction {
        lost[LossKind::Tangential as usize] = -((loads - normal * along).dot(contact.slip) * step);
        held = stiffness * spring.dot(spring + contact.slip * step);
    }
    let [other, x, y, z] = before[1];
    lost[LossKind::Other as usize] = -(other * contact.normal_velocity * step);
    if booked.rolling {
        lost[LossKind::Rolling as usize] = Vector::new(x, y, z).dot(contact.relative_spin) * step;
    }
    (lost, held)
}

#[cfg(test)]
mod tests;
