//! Dashpots that are integrated by themselves: before and after each time step the rates of a bond decay exactly, pair by pair.
//!
//! ```text
//! r ← r exp(−c Δt/2M)        J = −M (1 − exp(−c Δt/2M)) r
//! ```
//!
//! | symbol | meaning                                                        | unit            | comes from  |
//! |--------|----------------------------------------------------------------|-----------------|-------------|
//! | r      | v_n, v_s, w_n, w_t about the present axis                      | m/s, rad/s      | both bodies |
//! | c      | 2 ζ √(K M), as in [`super::viscous`]                           | kg/s, N m s     | the law     |
//! | M      | effective mass or inertia of the bodies that the bond can move | kg, kg m²       | both bodies |
//! | J      | impulse on i along the part, and its moment on both bodies     | N s, N m s      | –           |
//!
//! All bonds take their turn, in the order of their list before the time step (a sweep) and in the reversed order after it: Strang's
//! splitting, symmetric and of second order. Momentum and angular momentum stay as they are, and kinetic energy can only fall.
//!
//! **Why the stable step is the undamped one.** Without dashpots velocity Verlet keeps, at the times at which positions and velocities
//! belong together, the form ½ vᵀ M v + ½ xᵀ (K − Δt²/4 K M⁻¹ K) x. It is positive exactly while Δt < 2/ω of every mode. Velocities enter it
//! as kinetic energy alone, and a sweep changes velocities alone and takes kinetic energy. So the form never grows, whatever the dashpots
//! and the network. At Δt = 2/ω the mode of ω is thrown from x to −x with v = 0, which no sweep changes: the limit is the same with any ζ.
//!
//! Normal, shear and twist do not change each other; shear and bending do where l/I of the bodies differ, and then one comes after
//! the other, in reversed order after the time step.
//!
//! Source: G. Strang, *SIAM J. Numer. Anal.* 5 (1968) 506–517; pair by pair: T. Shardlow, *SIAM J. Sci. Comput.* 24 (2003) 1267–1282.

use super::viscous::{Viscous, arms, dashpot, inverse_masses, lightness};
use crate::bond::elasticity::Parts;
use crate::bond::{Coefficients, Pair};
use crate::number::{Number, Vector};

/// How a bond changes the rates of its bodies in a given time.
#[derive(Clone, Copy, Debug)]
pub struct Decay<N: Number = f64> {
    /// e, from j to i.
    pub axis: Vector<N>,
    /// l of both bodies \[m\].
    pub arms: [N; 2],
    /// Impulse of each part over its rate, with the other sign \[kg, kg m²\].
    pub gains: Parts<N>,
    /// Energy that each part takes over the square of its rate \[kg, kg m²\].
    pub losses: Parts<N>,
    /// 1/m_i, 1/m_j, 1/I_i, 1/I_j; 0 of a body that is led.
    pub lightness: [N; 4],
    /// l_i/I_i − l_j/I_j: what a couple by shear adds to the rate of bending \[1/(kg m)\].
    pub across: N,
}

/// Velocities \[m/s\] and angular velocities \[rad/s\] of both bodies.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// Velocities of i and j.
    pub velocities: [Vector; 2],
    /// Angular velocities of i and j.
    pub spins: [Vector; 2],
}

/// What dashpots gave to two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Impulse {
    /// On i; j gets the opposite \[N s\].
    pub push: Vector,
    /// On i and on j \[N m s\].
    pub twists: [Vector; 2],
    /// Energy that it took from both \[J\].
    pub taken: f64,
}

/// Squarings in [`lost_share`].
const DOUBLINGS: usize = 8;

/// 1 − e^(−y) for y of 0 or above, to some units in the last place: that of y/256 by its series, then 1 − (1 − s)² eight times.
#[inline(always)]
fn lost_share<N: Number>(exponent: N) -> N {
    /// Exponents from here on leave nothing.
    const MOST: f64 = 64.0;
    /// (−1)ᵏ/(k + 1)!
    const SERIES: [f64; 12] = [
        1.0,
        -1.0 / 2.0,
        1.0 / 6.0,
        -1.0 / 24.0,
        1.0 / 120.0,
        -1.0 / 720.0,
        1.0 / 5040.0,
        -1.0 / 40_320.0,
        1.0 / 362_880.0,
        -1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        -1.0 / 479_001_600.0,
    ];
    let part = exponent.min(N::splat(MOST)) * N::splat(1.0 / (1 << DOUBLINGS) as f64);
    let mut lost = part * part.polynomial(&SERIES);
    let mut turn = 0;
    while turn < DOUBLINGS {
        lost = lost * (N::splat(2.0) - lost);
        turn += 1;
    }
    lost
}

impl Viscous {
    /// Stiffness of each part of a bond that both pulls and pushes \[N/m, N m\].
    #[inline(always)]
    fn stiffness<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Parts<N> {
        let section = law.section(pair.least_radius);
        let elastic = &law.elastic;
        [
            elastic.compression * section.area,
            elastic.shear * section.area,
            elastic.torsion * section.polar,
            elastic.bending * section.axial,
        ]
    }

    /// How the rates of a pair decay in this time \[s\]. `free` is 1 for a body that forces move and 0 for one that is led. A bond
    /// between two that are led changes no rate; its impulses are those of steady dashpots.
    #[inline(always)]
    pub fn decay<N: Number>(&self, law: &Coefficients<N>, pair: &Pair<N>, free: [N; 2], time: f64) -> Decay<N> {
        let zero = N::zero();
        let distance = pair.connection.length();
        let (own, arms) = (lightness(pair), arms(pair, distance));
        let moved = [own[0] * free[0], own[1] * free[1], own[2] * free[0], own[3] * free[1]];
        let (whole, light) = (inverse_masses(own, arms), inverse_masses(moved, arms));
        let stiffness = Self::stiffness(law, pair);
        let (mut gains, mut losses) = ([zero; 4], [zero; 4]);
        let mut part = 0;
        while part < 4 {
            if self.ratios[part] != 0.0 {
                let impulse = dashpot(self.ratios[part], stiffness[part], whole[part]) * N::splat(time);
                [gains[part], losses[part]] = answer(impulse, light[part]);
            }
            part += 1;
        }
        let axis = pair.connection * (N::splat(1.0) / distance);
        Decay { axis, arms, gains, losses, lightness: moved, across: arms[0] * moved[2] - arms[1] * moved[3] }
    }

    /// Force and torques of the dashpots of a pair as it moves \[N, N m\], in place of impulses; the energy is a power \[W\].
    pub fn loads(&self, law: &Coefficients, pair: &Pair) -> Impulse {
        let decay = self.decay(law, pair, [0.0; 2], 1.0);
        // Dashpots see what i does relative to j.
        decay.impulse(&Moving { velocities: [pair.velocity, Vector::zero()], spins: [pair.spin_i, pair.spin_j] }, false)
    }
}

/// Impulse over the rate, and energy over its square, of a dashpot that gives this impulse in the time if its rate stays, to bodies
/// with this 1/M.
#[inline(always)]
fn answer<N: Number>(steady: N, light: N) -> [N; 2] {
    let moves = light.greater(N::zero());
    let lost = lost_share(steady * light);
    let gain = N::select(moves, lost / N::select(moves, light, N::splat(1.0)), steady);
    [gain, gain * (N::splat(1.0) - lost * N::splat(0.5))]
}

impl Decay {
    /// Lets the rates of two bodies decay, bending before shear if that is asked for. Tells what was given for that.
    #[inline(always)]
    pub fn damp(&self, moving: &mut Moving, backwards: bool) -> Impulse {
        let impulse = self.impulse(moving, backwards);
        let [along_i, along_j, about_i, about_j] = self.lightness;
        moving.velocities[0] += impulse.push * along_i;
        moving.velocities[1] = moving.velocities[1] - impulse.push * along_j;
        moving.spins[0] += impulse.twists[0] * about_i;
        moving.spins[1] += impulse.twists[1] * about_j;
        impulse
    }

    /// What two bodies get. What the second of shear and bending finds of the first one is taken into account: the angular
    /// velocities themselves need not be known in between.
    #[inline(always)]
    fn impulse(&self, moving: &Moving, backwards: bool) -> Impulse {
        let Self { axis, arms, gains, losses, across, .. } = *self;
        let [v, u] = moving.velocities;
        let [w, s] = moving.spins;
        let (apart, turned) = (v - u, w - s);
        let (along, about) = (apart.dot(axis), turned.dot(axis));
        let mut slip = apart - axis * along + axis.cross(w * arms[0] + s * arms[1]);
        let mut bend = turned - axis * about;
        if backwards {
            slip += axis.cross(bend) * -(across * gains[3]);
        } else {
            bend += axis.cross(slip) * (across * gains[1]);
        }
        let couple = axis.cross(slip) * gains[1];
        let twist = axis * -(gains[2] * about) - bend * gains[3];
        Impulse {
            push: axis * -(gains[0] * along) - slip * gains[1],
            twists: [couple * arms[0] + twist, couple * arms[1] - twist],
            taken: losses[0] * (along * along)
                + losses[1] * slip.dot(slip)
                + losses[2] * (about * about)
                + losses[3] * bend.dot(bend),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lost_share_holds_to_some_units_in_the_last_place_at_any_exponent() {
        for exponent in [0.0, 1e-300, 1e-12, 1e-3, 0.1, 0.7, 1.0, 3.0, 20.0, 63.0, 64.0, 1e6, f64::INFINITY] {
            let (found, expected) = (lost_share(exponent), -libm::expm1(-exponent));
            assert!(
                (found - expected).abs() <= 16.0 * f64::EPSILON * expected,
                "{found:e} at {exponent:e}: {expected:e}"
            );
        }
    }
}
