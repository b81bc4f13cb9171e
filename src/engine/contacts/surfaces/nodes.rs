//! Contacts with a mesh whose nodes move: how the surface moves at each foot, and how the load there is shared out on the nodes.

use super::{AtSurface, Touched};
use crate::base::lanes::{Lane, Shared, vector};
use crate::base::number::Vector;
use crate::engine::run_error::RunError;
use crate::engine::state::heat::{BoundaryHeat, Level};
use crate::engine::state::{Nodes, Row, State};
use crate::laws::surface::{Deforming, Foot, NodeWeights};
use std::sync::PoisonError;

/// A mesh with its nodes, in a step.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    /// The mesh as it stands.
    pub(super) shape: &'a Deforming,
    /// Its nodes.
    pub(super) nodes: &'a Nodes,
}

impl Moving<'_> {
    /// Adds what the nodes around a foot give, and returns velocity \[m/s\] and angular velocity \[rad/s\] of the surface at the
    /// point of contact, `behind` the foot \[m\]. `centre` is in the axes of the surface.
    fn at(&self, foot: &Foot, centre: Vector, behind: Vector, grips: &mut Vec<NodeWeights>) -> [Vector; 2] {
        let from = grips.len();
        self.shape.grips(foot.feature, centre - foot.normal * foot.distance, grips);
        let mut motion = [Vector::zero(); 2];
        for grip in &grips[from..] {
            let [along, about] = grip.motion(self.nodes.velocity[grip.node as usize].into());
            motion[0] += along;
            motion[1] += about;
        }
        [motion[0] + motion[1].cross(behind), motion[1]]
    }

    /// The same motion alone.
    pub(super) fn motion(&self, foot: &Foot, centre: Vector, radius: f64) -> [Vector; 2] {
        self.at(foot, centre, behind(foot, foot.normal, radius), &mut Vec::new())
    }
}

/// From a foot to the point of contact, half an overlap behind it \[m\].
fn behind(foot: &Foot, normal: Vector, radius: f64) -> Vector {
    -(normal * (0.5 * (radius - foot.distance)))
}

/// What contacts with a mesh whose nodes move have beside others, each a column; empty at other surfaces.
#[derive(Default)]
pub(super) struct Held {
    /// What the nodes around the feet give.
    grips: Vec<NodeWeights>,
    /// Where those of each contact end.
    ends: Vec<u32>,
    /// Velocities of the surface at the points of contact \[m/s\].
    velocity: Vec<Row>,
    /// Its angular velocities there \[rad/s\].
    spin: Vec<Row>,
    /// From the feet to the points of contact \[m\].
    behind: Vec<Vector>,
    /// Forces on the particles \[N\].
    force: Vec<Row>,
    /// Rolling torques on the surface \[N m\].
    couple: Vec<Row>,
    /// Temperatures of the surface at the feet, where its nodes have one.
    level: Vec<Level>,
    /// Heat flows into the surface \[W\], conductances \[W/K\] and heat of losses \[J\].
    heat: Vec<[f64; 3]>,
}

impl Held {
    /// Forgets all contacts.
    pub(super) fn clear(&mut self) {
        self.grips.clear();
        self.ends.clear();
        self.velocity.clear();
        self.spin.clear();
        self.behind.clear();
        self.force.clear();
        self.couple.clear();
        self.level.clear();
        self.heat.clear();
    }

    /// Adds a contact: its foot, the normal in global axes, and a particle with this centre in the axes of the surface.
    pub(super) fn push(
        &mut self,
        (moving, warm): (&Moving, &[BoundaryHeat]),
        (foot, normal): (&Foot, Vector),
        centre: Vector,
        radius: f64,
    ) {
        let (behind, from) = (behind(foot, normal, radius), self.grips.len());
        let [velocity, spin] = moving.at(foot, centre, behind, &mut self.grips);
        self.ends.push(self.grips.len() as u32);
        self.velocity.push(velocity.row_with(0.0));
        self.spin.push(spin.row_with(0.0));
        self.behind.push(behind);
        self.force.push([0.0; 4]);
        self.couple.push([0.0; 4]);
        if !warm.is_empty() {
            let share = |[t, rise]: Level, grip: &NodeWeights| {
                let node = warm[grip.node as usize].level();
                [t + grip.weight() * node[0], rise + grip.weight() * node[1]]
            };
            self.level.push(self.grips[from..].iter().fold([0.0; 2], share));
            self.heat.push([0.0; 3]);
        }
    }

    /// The columns that a batch reads and writes.
    pub(super) fn columns(&mut self) -> HeldColumns<'_> {
        HeldColumns {
            velocity: &self.velocity,
            spin: &self.spin,
            force: Shared::new(&mut self.force),
            couple: Shared::new(&mut self.couple),
            level: &self.level,
            heat: Shared::new(&mut self.heat),
        }
    }

    /// Shares the heat into the surface out on its nodes.
    fn share_heat_out(&self, nodes: &mut [BoundaryHeat]) {
        let mut from = 0;
        for (&[flow, conductance, of_losses], &end) in self.heat.iter().zip(&self.ends) {
            for grip in &self.grips[from..end as usize] {
                let (node, weight) = (&mut nodes[grip.node as usize], grip.weight());
                node.takes([weight * flow, weight * conductance]);
                node.of_losses += weight * of_losses;
            }
            from = end as usize;
        }
    }

    /// Shares the loads on the surface out on its nodes.
    fn share_out(&self, nodes: &mut [Row]) {
        let mut from = 0;
        for (contact, &end) in self.ends.iter().enumerate() {
            let force = -Vector::from(self.force[contact]);
            let couple = self.behind[contact].cross(force) + self.couple[contact].into();
            for grip in &self.grips[from..end as usize] {
                let part = grip.load(force, couple).to_array();
                let node = &mut nodes[grip.node as usize];
                (0..3).for_each(|axis| node[axis] += part[axis]);
            }
            from = end as usize;
        }
    }
}

/// Columns of [`Held`] while contacts are evaluated.
#[derive(Clone, Copy)]
pub(super) struct HeldColumns<'a> {
    /// Velocities of the surface.
    velocity: &'a [Row],
    /// Its angular velocities.
    spin: &'a [Row],
    /// Forces on the particles.
    force: Shared<Row>,
    /// Rolling torques on the surface.
    couple: Shared<Row>,
    /// Temperatures of the surface; empty where its nodes have none.
    level: &'a [Level],
    /// What of heat it takes.
    heat: Shared<[f64; 3]>,
}

impl HeldColumns<'_> {
    /// Motion of the surface at some contacts.
    ///
    /// # Safety
    /// `numbers` points to [`Lane::WIDTH`] numbers of contacts.
    #[inline(always)]
    pub(super) unsafe fn motion<N: Lane>(&self, numbers: *const u32) -> [Vector<N>; 2] {
        // SAFETY: the caller's promise.
        unsafe {
            [N::load_rows(self.velocity.as_ptr(), numbers), N::load_rows(self.spin.as_ptr(), numbers)].map(vector)
        }
    }

    /// Temperature of the surface at a contact, if its nodes have one.
    pub(super) fn level(&self, number: usize) -> Option<Level> {
        self.level.get(number).copied()
    }

    /// Notes heat flow into the surface \[W\] and conductance \[W/K\] of a contact.
    ///
    /// # Safety
    /// The contact belongs to the piece of work that asks.
    pub(super) unsafe fn take(&self, number: usize, [flow, conductance]: [f64; 2]) {
        if number < self.level.len() {
            // SAFETY: the caller's promise.
            let [into, sum, _] = unsafe { self.heat.at(number) };
            (*into, *sum) = (*into + flow, *sum + conductance);
        }
    }

    /// Notes heat of losses into the surface at a contact \[J\].
    ///
    /// # Safety
    /// As for [`HeldColumns::take`].
    pub(super) unsafe fn warm(&self, number: usize, heat: f64) {
        if number < self.level.len() {
            // SAFETY: the caller's promise.
            unsafe { self.heat.at(number)[2] += heat };
        }
    }

    /// Notes what a contact does: force on the particle \[N\], rolling torque on the surface \[N m\].
    ///
    /// # Safety
    /// The contact belongs to the piece of work that asks.
    #[inline(always)]
    pub(super) unsafe fn note(&self, number: usize, force: Row, rolling: Option<Row>) {
        // SAFETY: the caller's promise.
        unsafe {
            *self.force.at(number) = force;
            *self.couple.at(number) = rolling.unwrap_or([0.0; 4]);
        }
    }
}

impl AtSurface {
    /// Lets a mesh whose nodes move take the shape that it has in a state.
    pub(super) fn follow(&self, state: &State) -> Result<(), RunError> {
        let Touched::Nodes(shape) = &self.touched else { return Ok(()) };
        let Some(nodes) = state.nodes_of(self.list(state).boundary as usize) else { return Ok(()) };
        let mut shape = shape.write().unwrap_or_else(PoisonError::into_inner);
        let collapsed = |face| RunError::Collapsed { boundary: self.name.clone(), face, time: state.clock.time };
        shape.follow(&nodes.displacement).map_err(collapsed)
    }

    /// Shares the loads of the pieces out on the nodes, in order.
    pub(super) fn load_nodes<'a>(&self, state: &mut State, pieces: impl Iterator<Item = &'a Held> + Clone) {
        let Touched::Nodes(_) = &self.touched else { return };
        let boundary = self.list(state).boundary as usize;
        if let Some(nodes) = state.nodes_of_mut(boundary) {
            pieces.clone().for_each(|piece| piece.share_out(&mut nodes.force));
        }
        if let Some(nodes) = state.heat.as_mut().and_then(|heat| heat.nodes_of_mut(boundary)) {
            pieces.for_each(|piece| piece.share_heat_out(nodes));
        }
    }
}
