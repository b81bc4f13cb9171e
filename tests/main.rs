//! The tests of the library from outside, as one program: each file is a subject.
//!
//! Tests that need a process of their own stand in programs of their own (`Cargo.toml`).

mod bodies;
mod bond_energies;
mod bond_laws;
mod bond_lists;
mod bond_order;
mod bonded_block;
mod bonded_exchange;
mod bonds;
mod books;
mod coefficients;
mod derivatives;
mod every_law;
mod every_surface;
mod exchange;
mod floors;
mod foreseen_step;
mod forged_states;
mod free_groups;
mod lanes;
mod loaded;
mod losses;
mod motions;
mod neighbours;
mod nodes;
mod packings;
mod physics;
mod plane;
mod quadratic_motion;
mod random_scenes;
mod region_meshes;
mod regions;
mod same_bits;
mod scenes;
mod schemes;
mod servo;
mod stable_step;
mod starting;
mod statics;
mod support;
mod suppressed_contacts;
mod surface_courses;
mod surfaces;
