//! Where a rigid body stands: from global axes to its own and back.

use super::Quaternion;
use crate::number::{Row, Vector};

/// Where a rigid body stands, as seen from where it stood at time 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// How it has turned; nothing where it has not: then no rounding comes from it.
    turn: Option<Quaternion>,
    /// A point of it at time 0 \[m\].
    reference: Vector,
    /// How far that point has gone \[m\].
    displacement: Vector,
}

impl Frame {
    /// A body of which this point has gone so far \[m\], with this orientation.
    pub(crate) fn of(reference: Vector, displacement: Vector, orientation: Row) -> Self {
        let turn = (orientation != [1.0, 0.0, 0.0, 0.0]).then(|| Quaternion::from_row(orientation));
        Self { turn, reference, displacement }
    }

    /// Its point of reference at time 0 \[m\].
    pub(crate) fn reference(&self) -> Vector {
        self.reference
    }

    /// Where its point of reference stands \[m\].
    pub(crate) fn pivot(&self) -> Vector {
        self.reference + self.displacement
    }

    /// A position in the axes of the body at time 0 \[m\].
    pub(crate) fn inside(&self, position: Vector) -> Vector {
        match self.turn {
            None => position - self.displacement,
            Some(turn) => turn.conjugate().turn(position - self.pivot()) + self.reference,
        }
    }

    /// A direction of the body in global axes.
    pub(crate) fn outside(&self, direction: Vector) -> Vector {
        self.turn.map_or(direction, |turn| turn.turn(direction))
    }
}
