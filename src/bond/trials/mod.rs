//! Trials of whole bonds: claims that take motion, random placements or stored trajectories to test.

mod conservation;
mod gradient;
mod placement;
