//! Clumps: rigid bodies whose spheres stand among the particles.

use super::in_place::clone_in_place;
use super::{Row, plain};
use serde::{Deserialize, Serialize};

/// Clumps in the scene's order, rows of 32 bytes.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clumps {
    /// Mass centre, and the distance of the sphere centre furthest from it \[m\].
    #[serde(with = "plain")]
    pub position: Vec<Row>,
    /// Moments of inertia about the principal axes \[kg m²\], and the radius of the smallest sphere \[m\].
    #[serde(with = "plain")]
    pub moments: Vec<Row>,
    /// Velocity \[m/s\] and mass \[kg\].
    #[serde(with = "plain")]
    pub velocity: Vec<Row>,
    /// Principal axes as a unit quaternion: scalar, x, y, z.
    #[serde(with = "plain")]
    pub orientation: Vec<Row>,
    /// Angular momentum about the mass centre \[kg m²/s\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub angular_momentum: Vec<Row>,
    /// Angular velocity \[rad/s\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub angular_velocity: Vec<Row>,
    /// Force \[N\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub force: Vec<Row>,
    /// Moment about the mass centre \[N m\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub moment: Vec<Row>,
    /// Force and moment of global damping, which are among these; empty where nothing is damped.
    #[serde(with = "plain")]
    pub braking: Vec<[Row; 2]>,
}

clone_in_place!(Clumps {
    position,
    moments,
    velocity,
    orientation,
    angular_momentum,
    angular_velocity,
    force,
    moment,
    braking
});

impl Clumps {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}
