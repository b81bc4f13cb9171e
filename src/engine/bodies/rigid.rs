//! A rigid body that forces move: half a kick and the drift, for one body or for as many as a register has numbers.
//!
//! ```text
//! v += Δt/2 F/m    L += Δt/2 M    x += Δt v    q ← q (1, g)/|..|        w = w₀ − J⁻¹ (g × J w)    g = w Δt/2 · tan(|w| Δt/2)/(|w| Δt/2)
//! ```
//!
//! w is the mean of the angular velocities before and after the drift, in principal axes. A turn about it leaves kinetic energy and
//! angular momentum as they are (Simo and Wong 1991): the component of J w along it stays. The map is of second order and its own inverse in
//! reversed time; for a sphere it is exact.
//!
//! Functions, not closures: what is not inlined into a kernel is compiled without its registers.

use crate::base::geometry::Quaternion;
use crate::base::number::{Number, Vector};

/// Most iterations in which the rotation of a time step is found. Each gains a factor of about the angle of the step.
const ITERATIONS: usize = 40;

/// Square of the change of an angular velocity, over that of its length, at which the iteration ends.
const STANDS: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Square of half an angle of a step beyond which it is no longer followed exactly \[rad²\].
const FOLLOWED: f64 = 1.0;

/// A rigid body and what acts on it, about its point of reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rigid<N = f64> {
    /// Velocity of the point \[m/s\].
    pub velocity: Vector<N>,
    /// Mass \[kg\].
    pub mass: N,
    /// The turn of the axes of space into the principal axes.
    pub turn: Quaternion<N>,
    /// Moments of inertia about these; infinite where nothing turns it \[kg m²\].
    pub inertia: Vector<N>,
    /// Angular momentum \[kg m²/s\].
    pub momentum: Vector<N>,
    /// Force \[N\].
    pub force: Vector<N>,
    /// Moment \[N m\].
    pub moment: Vector<N>,
    /// Dashpots of force and moment to the ground, which a fluid has \[kg/s, kg m²/s\].
    pub dashpots: [N; 2],
}

impl<N: Number> Rigid<N> {
    /// The angular velocity in principal axes \[rad/s\].
    #[inline(always)]
    fn spin_inside(&self) -> Vector<N> {
        let inside = self.turn.conjugate().turn(self.momentum);
        Vector::new(inside.x / self.inertia.x, inside.y / self.inertia.y, inside.z / self.inertia.z)
    }

    /// The angular velocity \[rad/s\].
    #[inline(always)]
    pub(crate) fn spin(&self) -> Vector<N> {
        self.turn.turn(self.spin_inside())
    }

    /// The same after a kick of this length \[s\].
    #[inline(always)]
    pub(crate) fn kicked(self, length: N) -> Self {
        let velocity = self.velocity + self.force * (length / (self.mass + length * self.dashpots[0]));
        Self { velocity, momentum: self.momentum + self.twisted(length), ..self }
    }

    /// What a kick of this length \[s\] gives to the angular momentum \[kg m²/s\].
    #[inline(always)]
    fn twisted(&self, length: N) -> Vector<N> {
        let twist = self.moment * length;
        let dashpot = length * self.dashpots[1];
        if !N::any(dashpot.greater(N::zero())) {
            return twist;
        }
        let share = |inertia: N| inertia / (inertia + dashpot);
        let (inside, Vector { x, y, z }) = (self.turn.conjugate().turn(twist), self.inertia);
        self.turn.turn(Vector::new(inside.x * share(x), inside.y * share(y), inside.z * share(z)))
    }

    /// The largest speed of a point at most so far from its point of reference \[m\], or above \[m/s\].
    #[inline(always)]
    pub(crate) fn fastest(&self, reach: N) -> N {
        self.velocity.length() + self.spin().length() * reach
    }

    /// Mean of the angular velocities before and after a drift of twice `half` \[s\], in principal axes \[rad/s\].
    #[inline(always)]
    pub(crate) fn mean_spin(&self, half: N) -> Vector<N> {
        let (begun, Vector { x: a, y: b, z: c }) = (self.spin_inside(), self.inertia);
        let shares = Vector::new((b - c) / a, (c - a) / b, (a - b) / c);
        let mut mean = begun;
        for _ in 0..ITERATIONS {
            let (above, below) = tangent(mean, half);
            let factor = half * above / below;
            let x = begun.x + factor * shares.x * (mean.y * mean.z);
            let y = begun.y + factor * shares.y * (mean.z * x);
            let z = begun.z + factor * shares.z * (x * y);
            let next = Vector::new(x, y, z);
            let change = next - mean;
            let goes_on = change.dot(change).greater(N::splat(STANDS) * next.dot(next));
            // What stands is not touched again: the bits do not depend on who stands in the other lanes.
            mean = Vector::new(
                N::select(goes_on, next.x, mean.x),
                N::select(goes_on, next.y, mean.y),
                N::select(goes_on, next.z, mean.z),
            );
            if !N::any(goes_on) {
                break;
            }
        }
        mean
    }

    /// The same after a drift of twice `half` \[s\] with this mean angular velocity in principal axes \[rad/s\].
    #[inline(always)]
    pub(crate) fn turned(self, mean: Vector<N>, half: N) -> Self {
        let (above, below) = tangent(mean, half);
        let turn = (self.turn * Quaternion { scalar: below, vector: mean * (half * above) }).normalised();
        Self { turn, ..self }
    }
}

impl Rigid {
    /// The acceleration \[m/s²\] and the angular one \[rad/s²\] that its load gives.
    pub(crate) fn answer(self) -> [Vector; 2] {
        let answer =
            Self { velocity: Vector::zero(), momentum: Vector::zero(), dashpots: [0.0; 2], ..self }.kicked(1.0);
        [answer.velocity, answer.spin()]
    }

    /// Kinetic energy \[J\].
    pub(crate) fn kinetic(&self) -> f64 {
        0.5 * self.mass * self.velocity.dot(self.velocity) + 0.5 * self.spin().dot(self.momentum)
    }
}

/// Numerator and denominator of tan|h|/|h| for h = w Δt/2 (as [`Quaternion::turned`]).
#[inline(always)]
fn tangent<N: Number>(spin: Vector<N>, half: N) -> (N, N) {
    let square = (spin.dot(spin) * (half * half)).min(N::splat(FOLLOWED));
    let above = N::splat(945.0) - square * (N::splat(105.0) - square);
    let below = N::splat(945.0) - square * (N::splat(420.0) - N::splat(15.0) * square);
    (above, below)
}

/// Where a turn takes the axes.
#[inline(always)]
pub(crate) fn axes(turn: Quaternion) -> [Vector; 3] {
    let (w, Vector { x, y, z }) = (turn.scalar, turn.vector);
    [
        Vector::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        Vector::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        Vector::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    ]
}
