//! Regions: their stress is that of the walls and of the inertia, whatever moves; their porosity is that of geometry; nothing
//! is paid for them before it is asked for.
//!
//! Balance of a bed. Each particle has m a = Σ f + m g, with forces f at its contacts. Times its place x and summed, with the way l
//! to its centre from the other one or, at a wall, from the point of contact c:
//!
//! ```text
//! −Σ l ⊗ f = Σ_walls c ⊗ f + Σ m x ⊗ (g − a)
//! ```
//!
//! The left side is what the contacts carry (times the volume, tension positive). Its part that is not symmetric is what makes the
//! particles turn faster, less the couples of the walls: −Σ l × f = Σ T − Σ_walls C.

mod balances;
mod bonded;
mod content;
pub(crate) mod scenes;
