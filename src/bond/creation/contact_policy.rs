//! What the contact law does between bonded bodies.

use serde::Deserialize;

/// What the contact law does between bonded bodies that overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactPolicy {
    /// Contact and bond act side by side (as in the engine).
    #[default]
    Parallel,
    /// No normal force of the contact while bonded; afterwards it grows from 0 at the overlap that is left
    /// (`disableNormalWhenBonded`).
    WithoutNormal,
    /// No contact at all while bonded; afterwards as `without_normal`, with a fresh spring.
    None,
}
