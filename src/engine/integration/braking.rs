//! Cundall's damping of one component, and what it takes.

use super::mobility;
use crate::base::number::Vector;
use crate::engine::state::Row;

/// Cundall's damping of everything, put aside.
pub(crate) struct Damping(pub(super) Vec<Damped>, pub(super) [Damped; 2], pub(super) bool);

/// Cundall's damping of one particle.
#[derive(Clone, Copy, Default)]
pub(crate) struct Damped {
    /// Fraction of the force.
    pub(crate) linear: f64,
    /// Fraction of the torque.
    pub(crate) angular: f64,
    /// Whether gravity is damped.
    pub(crate) gravity: bool,
    /// Whether applied forces are damped.
    pub(crate) applied: bool,
}

/// What damping takes from a component of a load: a fraction that lowers its power, also at rest.
#[inline(always)]
pub(super) fn brake(fraction: f64, load: f64, velocity: f64) -> f64 {
    if load * velocity >= 0.0 { fraction * load } else { -fraction * load }
}

/// What damping adds to a load, component by component.
pub(crate) fn brakes(fraction: f64, load: Vector, velocity: [f64; 3]) -> [f64; 3] {
    let load = load.to_array();
    [0, 1, 2].map(|axis| -brake(fraction, load[axis], velocity[axis]))
}

/// What a damping load takes: in half a kick of a step of this length \[s\] from velocities of its middle \[J\]; and in half a
/// kick from those after it, over the length of that step \[W\] and over its square \[W/s\].
#[inline(always)]
pub(super) fn taken(damping: [f64; 3], motion: &Row, load: &Row, step: f64) -> [f64; 3] {
    let per_inertia = mobility(motion, load, 0.5 * step);
    let (mut now, mut power, mut growth) = (0.0, 0.0, 0.0);
    for axis in 0..3 {
        let acceleration = load[axis] * per_inertia;
        let after = motion[axis] + 0.5 * step * acceleration;
        now += 0.25 * step * damping[axis] * (motion[axis] + after);
        power += 0.5 * damping[axis] * after;
        growth += 0.125 * damping[axis] * acceleration;
    }
    [now, power, growth]
}
