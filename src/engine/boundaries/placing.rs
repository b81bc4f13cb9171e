//! Where boundaries stand at the start.

use super::course::six;
use crate::base::geometry::rotation;
use crate::engine::state::{BoundaryState, Orientation, State};
use crate::scene::{Boundary, Scene};

/// Puts driven axes where they are to start: axis (0 to 5) and value \[m, rad\].
pub(crate) fn put(moved: &mut BoundaryState, axis: usize, value: f64) {
    moved.target[axis] = value;
    match axis {
        0..3 => moved.displacement[axis] = value,
        _ => {
            moved.rotation[axis - 3] = value;
            moved.orientation = Orientation::from(rotation::orientation(moved.rotation.into()));
        }
    }
}

/// Lets prescribed axes go on from where they stand at this time \[s\]: their target is where they would have stood at time 0.
pub(crate) fn begin_prescribed(boundary: &Boundary, moved: &mut BoundaryState, time: f64) {
    for (axis, motion) in boundary.axes.iter().enumerate() {
        if let Some([place, _]) = motion.at(time) {
            moved.target[axis] = six(moved.displacement, moved.rotation)[axis] - place;
        }
    }
}

/// Puts prescribed axes where they are at this time \[s\].
pub(crate) fn put_prescribed(scene: &Scene, state: &mut State, time: f64) {
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        for (axis, motion) in boundary.axes.iter().enumerate() {
            if let Some([place, _]) = motion.at(time) {
                put(moved, axis, place);
                moved.target[axis] = 0.0;
            }
        }
    }
}
