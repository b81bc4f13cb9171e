//! Where a rigid body stands: from global axes to its own and back.

use super::Quaternion;
use crate::base::number::{Row, Vector};

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
    #[inline(always)]
    pub(crate) fn inside(&self, position: Vector) -> Vector {
        match &self.turn {
            None => position - self.displacement,
            Some(turn) => self.turned_inside(turn, position),
        }
    }

    /// The same of a body that has turned. By itself: in line, its arithmetic would be done for bodies that have not turned.
    #[inline(never)]
    fn turned_inside(&self, turn: &Quaternion, position: Vector) -> Vector {
        turn.conjugate().turn(position - self.pivot()) + self.reference
    }

    /// The position in global axes of a place in the axes of the body at time 0 \[m\].
    pub(crate) fn place(&self, inside: Vector) -> Vector {
        match &self.turn {
            None => inside + self.displacement,
            Some(turn) => turned(turn, inside - self.reference) + self.pivot(),
        }
    }

    /// A direction of the body in global axes.
    #[inline(always)]
    pub(crate) fn outside(&self, direction: Vector) -> Vector {
        match &self.turn {
            None => direction,
            Some(turn) => turned(turn, direction),
        }
    }
}

/// A direction that has turned. By itself as [`Frame::turned_inside`].
#[inline(never)]
fn turned(turn: &Quaternion, direction: Vector) -> Vector {
    turn.turn(direction)
}
