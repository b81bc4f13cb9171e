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

/// Contact of a pair whose bond suppresses, or has suppressed, the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suppressed {
    /// Overlap from which the elastic normal force is taken; stiffness and damping are those of the whole overlap \[m\].
    pub pressing: f64,
    /// Whether that normal force acts. The friction limit sees it in both cases, as in the engine.
    pub acts: bool,
    /// Offset to remember; 0 once the bodies part \[m\].
    pub offset: f64,
}

/// What is suppressed of an overlap, from the offset remembered \[m\] and how the pair stood before the creations of this
/// step.
///
/// While bonded, the overlap becomes the offset. Afterwards what goes beyond the offset presses, and the offset shrinks with
/// the overlap.
pub fn suppressed(overlap: f64, offset: f64, bonded: bool) -> Suppressed {
    let offset = offset.min(overlap);
    Suppressed { pressing: overlap - offset, acts: !bonded, offset: if bonded { overlap } else { offset } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suppressed_contact_presses_from_where_the_bond_left_it() {
        let found = suppressed(3.0, 0.0, true);
        assert_eq!((found.acts, found.offset), (false, 3.0));
        assert_eq!(suppressed(3.5, found.offset, false), Suppressed { pressing: 0.5, acts: true, offset: 3.0 });
        assert_eq!(suppressed(2.0, found.offset, false), Suppressed { pressing: 0.0, acts: true, offset: 2.0 });
        assert_eq!(suppressed(2.5, 2.0, false), Suppressed { pressing: 0.5, acts: true, offset: 2.0 });
    }
}
