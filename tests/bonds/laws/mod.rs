//! Bond laws as they are: points worked out by hand, motion that is prescribed, random placements, and the known failures of
//! the engine's bond.

mod conservation;
mod dashpots;
mod failures;
mod gradient;
mod keys;
mod placement;
mod points;
mod prescribed;
