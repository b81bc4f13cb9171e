//! `[boundary.<name>]`

use super::{AxisMotion, Body, BoundaryTemperature, InputCourse, NodeMotion, Outside, Shape};
use crate::base::quantity::BoundaryIndex;
use crate::laws::wear::WearModel;

/// `[boundary.<name>]`: where the outside world acts on the particles.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// What it is.
    pub shape: Shape,
    /// How it moves along x, y, z, and turns about them.
    pub axes: [AxisMotion; 6],
    /// The boundary with which it moves, as a part of one machine: its axes, its input and its point of reference are those of that one.
    pub moves_with: Option<BoundaryIndex>,
    /// What the nodes of a mesh do.
    pub nodes: NodeMotion,
    /// How a driven axis or node goes from where it stands to its new value.
    pub input: InputCourse,
    /// The point about which its moment is taken, at time 0 \[m\].
    pub reference: [f64; 3],
    /// Its properties as a rigid body that forces move.
    pub body: Body,
    /// What happens to a particle whose centre came through it.
    pub outside: Outside,
    /// Its temperature.
    pub temperature: BoundaryTemperature,
    /// What particles wear off it: the volumes of all models add up.
    pub wear: Vec<WearModel>,
}

impl Boundary {
    /// The plane that it is and stays parallel to, whose particles are worked on in lanes.
    pub(crate) fn shifting_plane(&self) -> Option<crate::laws::surface::Plane> {
        self.shape.plane().filter(|_| !self.turns())
    }

    /// Whether particles can be bonded to it: a plane that neither turns nor runs in itself.
    pub(crate) fn takes_bonds(&self) -> bool {
        let conveys = |axis: &AxisMotion| matches!(axis, AxisMotion::Conveying(_));
        self.shifting_plane().is_some() && !self.axes.iter().any(conveys)
    }

    /// How many nodes of it the outside moves, each by itself.
    pub(crate) fn driven_nodes(&self) -> usize {
        match self.nodes {
            NodeMotion::Rigid => 0,
            NodeMotion::Driven => self.shape.vertices().len(),
        }
    }

    /// Whether the outside says where it is, or where its nodes are.
    pub(crate) fn is_led(&self) -> bool {
        matches!(self.nodes, NodeMotion::Driven) || self.axes.iter().any(AxisMotion::is_driven)
    }

    /// Whether it can turn.
    pub(crate) fn turns(&self) -> bool {
        self.axes[3..].iter().any(|motion| !motion.is_fixed())
    }
}
