//! `[boundary.<name>]`

use super::body::{Inertia, Supports};
use super::heat::TemperatureKey;
use crate::base::document::keys;
use crate::base::quantity::{Finite, Positive, Triple};
use crate::laws::motion::{self, InputCourse, NodeMotion};
use crate::laws::surface::{MakeShape, ShapeRow};
use crate::laws::wear::WearModel;
use crate::scene::exchange::Outside;

keys! {
    /// `[boundary.<name>]`
    pub(in crate::scene::file) struct BoundaryTable {
        /// Material of the surface; a group has that of its particles.
        pub(in crate::scene::file) material: Option<String> = "required of a surface",
        /// `"fixed"`, or a table of axes.
        pub(in crate::scene::file) motion: Option<motion::Keys> = "`\"fixed\"`",
        /// Name of a boundary that is prescribed or driven, of whose machine this one is a part, see below.
        pub(in crate::scene::file) moves_with: Option<String> = "none",
        /// `"driven"`: the outside moves [each node of a mesh](#meshes-that-deform).
        #[serde(default)]
        pub(in crate::scene::file) nodes: NodeMotion = "`\"rigid\"`",
        /// Way of driven axes and nodes to their new value ([fmu.md](fmu.md)): `"ramp"`, `"smooth"`, `"hold"`, or `"quadratic"`
        /// (displacements of the whole boundary only).
        pub(in crate::scene::file) input: Option<InputCourse> = "`\"ramp\"`",
        /// What happens to a particle whose centre came through the surface: `"stop"` or `"remove"`, which `<boundary>.outside.count`,
        /// `.clumps` and `.mass` count; a clump goes with its first sphere that did.
        #[serde(default)]
        pub(in crate::scene::file) outside: Outside = "`\"stop\"`",
        /// Point of the moment \[m\]; it moves with the boundary.
        pub(in crate::scene::file) reference: Option<Triple> = "plane point; mass centre of a group; centre of a disc, a rectangle or a mesh's box; `from`, `origin`",
        /// Mass of a surface that forces move \[kg\].
        pub(in crate::scene::file) mass: Option<Positive> = "none",
        /// Its mass centre at time 0 \[m\].
        pub(in crate::scene::file) centre: Option<Triple> = "`reference`",
        /// Inertia about it of a surface that moments turn \[kg m²\]: `[xx, yy, zz]` or three rows, in global axes at time 0.
        pub(in crate::scene::file) inertia: Option<Inertia> = "none",
        /// Springs to the ground along axes that forces move \[N/m, N m/rad\]: `{ z = 1e4, "rotation.x" = 2.0 }`.
        #[serde(default)]
        pub(in crate::scene::file) stiffness: Supports = "none",
        /// Dashpots to the ground along axes that forces move \[N s/m, N m s/rad\].
        #[serde(default)]
        pub(in crate::scene::file) damping: Supports = "none",
        /// Temperature \[K\], > 0; `"driven"` or `{ driven = 300.0 }` by an input, see [heat.md](heat.md).
        pub(in crate::scene::file) temperature: Option<TemperatureKey> = "adiabatic",
        /// What it takes up \[J/K\].
        pub(in crate::scene::file) heat_capacity: Option<Positive> = "none",
        /// Heat flow from the outside into what takes up heat, before another is given \[W\].
        pub(in crate::scene::file) applied_heat: Option<Finite> = "0",
    } beside {
        /// Its shapes, each read by its row: one, where the scene is right.
        #[serde(skip)]
        pub(in crate::scene::file) shapes: Vec<(&'static ShapeRow, MakeShape)>,
        /// What wears it, each read by its row.
        #[serde(skip)]
        pub(in crate::scene::file) wear: Vec<WearModel>,
    }
}
