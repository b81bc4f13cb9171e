//! `[boundary.<name>]`

use super::body::{Inertia, Supports};
use crate::base::quantity::{Positive, Triple};
use crate::laws::motion::{self, InputCourse, NodeMotion};
use crate::laws::surface::{self, Shape, ShapeContext, ShapeKeys, with_shapes};
use crate::scene::exchange::Outside;
use serde::Deserialize;

/// Declares the table of a boundary: a key for each shape, and what every boundary has.
macro_rules! boundary_table {
    ($($key:ident: $file:ident::$keys:ident,)+) => {
        /// `[boundary.<name>]`
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(in crate::scene::file) struct BoundaryTable {
            $(
                #[doc = concat!("`", stringify!($key), "`")]
                $key: Option<surface::$file::$keys>,
            )+
            /// Material of a surface.
            pub(in crate::scene::file) material: Option<String>,
            /// How it moves.
            #[serde(default)]
            pub(in crate::scene::file) motion: motion::Keys,
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
        }

        impl BoundaryTable {
            /// How the key of each shape is written.
            pub(in crate::scene::file) const HINTS: &'static [&'static str] =
                &[$(<surface::$file::$keys as ShapeKeys>::HINT),+];

            /// Keys of the shapes that are written.
            pub(in crate::scene::file) fn shapes(&self) -> Vec<&'static str> {
                let written = [$((stringify!($key), self.$key.is_some())),+];
                written.into_iter().filter(|(_, written)| *written).map(|(key, _)| key).collect()
            }

            /// Whether particles can be bonded to it: a plane that neither turns nor runs in itself.
            pub(in crate::scene::file) fn takes_bonds(&self) -> bool {
                self.shapes().contains(&"plane") && !self.motion.turns() && !self.motion.conveys()
            }

            /// The first shape that is written; what is wrong with it is reported.
            pub(in crate::scene::file) fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
                $(if let Some(keys) = &self.$key {
                    return keys.shape(around);
                })+
                None
            }
        }
    };
}
with_shapes!(boundary_table);
