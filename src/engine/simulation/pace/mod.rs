//! How long time steps are: what is looked at for it, when, and what follows.
//!
//! [`due`] tells when to look, [`sight`] how far a look foresees, [`look`] finds the stable time step by it, [`impacts`] what share of the
//! energy impacts of two bodies have, and [`step_length`] chooses the time step by both. `docs/stability.md` describes the rule.

mod due;
mod impacts;
mod look;
mod sight;
mod step_length;

pub(super) use due::{BETWEEN_LOOKS, Seen};
