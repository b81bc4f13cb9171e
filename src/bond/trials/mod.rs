//! Trials of whole bonds: claims that take motion, random placements or stored trajectories to test.

mod compare;
mod conservation;
mod dashpots;
mod failures;
mod gradient;
mod keys;
mod placement;
mod points;
mod prescribed;
mod reference;
mod replay;
mod stored;
