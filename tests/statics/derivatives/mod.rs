//! Directional derivatives: differences of two steps from the same state, against the slopes of an earlier arithmetic and against
//! central differences by hand.

mod failures;
mod lids;
mod recorded;
mod scenes;
