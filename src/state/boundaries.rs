//! Where the boundaries stand and what they feel.

use serde::{Deserialize, Serialize};

/// Motion and loads of one boundary. Force and moment are those *of the particles on the boundary*.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundaryState {
    /// Displacement since time 0 \[m\].
    pub displacement: [f64; 3],
    /// Velocity in the present time step \[m/s\].
    pub velocity: [f64; 3],
    /// Where the present communication step began \[m\].
    pub start: [f64; 3],
    /// Where it is to end \[m\]: the last value given.
    pub target: [f64; 3],
    /// Rate of the input at the start of the communication step \[m/s\]; 0 where none was given.
    pub target_rate: [f64; 3],
    /// Force at the present time \[N\].
    pub force: [f64; 3],
    /// Moment about the moved reference point at the present time \[N m\].
    pub moment: [f64; 3],
    /// Sum of the half-kick impulses of the present communication step \[N s\].
    pub impulse: [f64; 3],
    /// Sum of the half-kick angular impulses of the present communication step \[N m s\].
    pub angular_impulse: [f64; 3],
    /// Mean force over the last communication step \[N\].
    pub mean_force: [f64; 3],
    /// Mean moment over the last communication step \[N m\].
    pub mean_moment: [f64; 3],
    /// Impulse since time 0, for the momentum balance \[N s\].
    pub total_impulse: [f64; 3],
    /// Work done by the boundary on the particles since time 0 \[J\].
    pub work: f64,
}
