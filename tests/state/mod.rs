//! The state: the same bits whoever works on it, saved, restored, forged, and in any units.

mod columns;
mod forged;
mod lanes;
mod neighbours;
mod same_bits;
mod units;
