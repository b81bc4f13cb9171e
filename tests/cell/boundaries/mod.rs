//! Surfaces and groups beside a periodic cell: they go on through its faces.

mod beds;
mod groups;
mod scenes;
mod surfaces;
