//! What is told of parts of space: regions and grids.

mod grids;
mod region_meshes;
pub(crate) mod regions;
