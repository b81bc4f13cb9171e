//! What a boundary is as a rigid body: whether it has what the forces on it need to move it.

use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{NonNegative, Positive};
use crate::laws::motion::Axis;
use crate::laws::surface::Surface;
use crate::scene::file::tables::{BoundaryTable, Inertia, Supports};
use crate::scene::{AxisMotion, Body, Boundary};

/// The body that a boundary is, with this point of reference \[m\].
pub(super) fn body(
    written: &BoundaryTable,
    axes: &[AxisMotion; 6],
    (shape, reference): (&dyn Surface, [f64; 3]),
    table: &str,
    faults: &mut Faults,
) -> Body {
    let free = |axis: usize| axes[axis].is_free();
    let mut senseless = |key: &str, what: String| {
        faults.add(table, key, Mistake::InvalidCombination { what, expected: "leave it out".to_owned() });
    };
    let given = [
        ("mass", written.mass.is_some()),
        ("centre", written.centre.is_some()),
        ("inertia", written.inertia.is_some()),
    ];
    let idle = !(0..6).any(free);
    for (key, _) in given.into_iter().filter(|(_, given)| *given) {
        if !shape.members().is_empty() {
            senseless(key, "a group has the mass of its particles".to_owned());
        } else if idle {
            senseless(key, "forces move no axis of it".to_owned());
        } else if key == "inertia" && !(3..6).any(free) {
            senseless(key, "moments turn it about no axis".to_owned());
        } else if key == "centre" && axes[3..].iter().all(AxisMotion::is_fixed) {
            senseless(key, "it does not turn".to_owned());
        }
    }
    for (key, supports) in [("stiffness", &written.stiffness), ("damping", &written.damping)] {
        for axis in supports.keys().map(|axis| *axis as usize).filter(|axis| !free(*axis)) {
            senseless(key, format!("forces do not move {}", AxisMotion::WORDS[axis]));
        }
    }
    Body {
        mass: written.mass.map_or(0.0, Positive::get),
        centre: written.centre.map_or(reference, |centre| centre.0),
        inertia: written.inertia.map_or([[0.0; 3]; 3], |Inertia(rows)| rows),
        stiffness: six(&written.stiffness),
        damping: six(&written.damping),
    }
}

/// Reports what a surface lacks that forces are to move.
pub(super) fn lacks(boundary: &Boundary, table: &str, faults: &mut Faults) {
    let Boundary { shape, axes, body, .. } = boundary;
    if !shape.members().is_empty() {
        return;
    }
    let mut missing = |key: &str, axis: usize| {
        let expected = format!("a {} that forces move ({}) needs it", shape.key(), AxisMotion::WORDS[axis]);
        faults.add(table, key, Mistake::Missing { expected });
    };
    let free = |range: std::ops::Range<usize>| range.into_iter().find(|axis| axes[*axis].is_free());
    if let Some(axis) = free(0..3).filter(|_| body.mass == 0.0) {
        missing("mass", axis);
    }
    if let Some(axis) = free(3..6).filter(|_| body.inertia == [[0.0; 3]; 3]) {
        missing("inertia", axis);
    }
}

/// What is given for each axis, 0 for those that are not named.
fn six(supports: &Supports) -> [f64; 6] {
    let mut all = [0.0; 6];
    for (axis, support) in supports {
        all[*axis as Axis as usize] = NonNegative::get(*support);
    }
    all
}
