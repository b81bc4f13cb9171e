//! `[boundary.<name>]`

use super::body::{Inertia, Supports};
use super::heat::TemperatureKey;
use crate::base::quantity::{Finite, Positive, Triple};
use crate::laws::motion::{self, InputCourse, NodeMotion};
use crate::laws::surface::{MakeShape, ShapeRow};
use crate::laws::wear::WearModel;
use crate::scene::exchange::Outside;
use serde::Deserialize;

/// `[boundary.<name>]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct BoundaryTable {
    /// Its shapes, each read by its row: one, where the scene is right.
    #[serde(skip)]
    pub(in crate::scene::file) shapes: Vec<(&'static ShapeRow, MakeShape)>,
    /// What wears it, each read by its row.
    #[serde(skip)]
    pub(in crate::scene::file) wear: Vec<WearModel>,
    /// Material of a surface.
    pub(in crate::scene::file) material: Option<String>,
    /// How it moves; absent: not, or as `moves_with` says.
    pub(in crate::scene::file) motion: Option<motion::Keys>,
    /// Name of the boundary with which it moves.
    pub(in crate::scene::file) moves_with: Option<String>,
    /// What the nodes of a mesh do.
    #[serde(default)]
    pub(in crate::scene::file) nodes: NodeMotion,
    /// How driven axes and nodes go to their new value.
    pub(in crate::scene::file) input: Option<InputCourse>,
    /// What happens to particles that came through it.
    #[serde(default)]
    pub(in crate::scene::file) outside: Outside,
    /// Point of reference of the moment \[m\].
    pub(in crate::scene::file) reference: Option<Triple>,
    /// Mass of a surface \[kg\].
    pub(in crate::scene::file) mass: Option<Positive>,
    /// Mass centre of a surface at time 0 \[m\].
    pub(in crate::scene::file) centre: Option<Triple>,
    /// Inertia of a surface about its mass centre \[kg m²\].
    pub(in crate::scene::file) inertia: Option<Inertia>,
    /// Springs to the ground.
    #[serde(default)]
    pub(in crate::scene::file) stiffness: Supports,
    /// Dashpots to the ground.
    #[serde(default)]
    pub(in crate::scene::file) damping: Supports,
    /// Its temperature.
    pub(in crate::scene::file) temperature: Option<TemperatureKey>,
    /// What it takes up \[J/K\].
    pub(in crate::scene::file) heat_capacity: Option<Positive>,
    /// Heat flow from the outside into what takes up heat, before another is given \[W\].
    pub(in crate::scene::file) applied_heat: Option<Finite>,
}
