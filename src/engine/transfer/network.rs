//! The conductances of a scene in which nothing moves, sorted by what they lead to.

use super::conduction::Conductances;
use super::flows::{Body, body};
use crate::engine::state::State;
use crate::laws::surface::NodeWeights;

/// What leads to a node: another one and a conductance.
type Lead = (u32, f64);

/// Bodies and surroundings as nodes: particles by their index, then boundaries, the surroundings of sources, and feet ([`NodeFoot`]).
#[derive(Default)]
pub(super) struct Network {
    /// Each conductance \[W/K\] with its two nodes, as it was told.
    told: Vec<([u32; 2], f64)>,
    /// Where the leads of each node begin.
    begins: Vec<u32>,
    /// What leads to the nodes, node by node, in the order in which it was told.
    leads: Vec<Lead>,
    /// Sum of the conductances at each node \[W/K\].
    sums: Vec<f64>,
}

impl Network {
    /// Begins anew.
    pub(super) fn clear(&mut self) {
        self.told.clear();
    }

    /// Adds a conductance \[W/K\] between two nodes.
    pub(super) fn connect(&mut self, first: usize, second: usize, conductance: f64) {
        if first != second && conductance != 0.0 {
            self.told.push(([first as u32, second as u32], conductance));
        }
    }

    /// Sorts what was told by so many nodes.
    pub(super) fn sort(&mut self, nodes: usize) {
        let Self { told, begins, leads, sums } = self;
        begins.clear();
        begins.resize(nodes + 1, 0);
        sums.clear();
        sums.resize(nodes, 0.0);
        for (ends, conductance) in &*told {
            for end in ends {
                begins[*end as usize + 1] += 1;
                // A saddle of a surface takes away from what its faces give.
                sums[*end as usize] += conductance.abs();
            }
        }
        (0..nodes).for_each(|node| begins[node + 1] += begins[node]);
        leads.clear();
        leads.resize(2 * told.len(), (0, 0.0));
        for ([first, second], conductance) in told.iter().rev() {
            for (node, other) in [(first, second), (second, first)] {
                let end = &mut begins[*node as usize + 1];
                *end -= 1;
                leads[*end as usize] = (*other, *conductance);
            }
        }
        // Each end has come down to its beginning.
        begins.remove(0);
        begins.push(2 * told.len() as u32);
    }

    /// What leads to a node.
    pub(super) fn leads(&self, node: usize) -> &[Lead] {
        &self.leads[self.begins[node] as usize..self.begins[node + 1] as usize]
    }

    /// Sum of the conductances at a node \[W/K\].
    pub(super) fn sum(&self, node: usize) -> f64 {
        self.sums[node]
    }
}

/// Where a particle touches a mesh whose nodes have temperatures: a node of the network for itself.
pub(super) struct NodeFoot {
    /// The boundary.
    pub(super) boundary: usize,
    /// The mesh among those whose nodes have temperatures.
    pub(super) mesh: usize,
    /// Nodes of the mesh, and their shares of the foot.
    pub(super) shares: Vec<(u32, f64)>,
}

/// A network that is told what conducts in a state.
pub(super) struct Told<'a> {
    /// The state.
    pub(super) state: &'a State,
    /// The network.
    pub(super) network: &'a mut Network,
    /// The feet on meshes whose nodes have temperatures.
    pub(super) feet: &'a mut Vec<NodeFoot>,
    /// The node of the first of them.
    pub(super) first_foot: usize,
}

impl Told<'_> {
    /// The node of the particle in a slot.
    pub(super) fn node(&self, slot: u32) -> usize {
        match body(self.state, slot as usize) {
            Body::Particle(index) => index,
            Body::Boundary(boundary) => self.boundary(boundary),
        }
    }

    /// The node of a boundary.
    fn boundary(&self, boundary: usize) -> usize {
        self.state.particles.slot.len() + boundary
    }

    /// The node of a foot on a boundary whose nodes have temperatures.
    fn foot(&mut self, boundary: usize, nodes: &[NodeWeights]) -> Option<usize> {
        let meshes = &self.state.heat.as_ref()?.nodes;
        let mesh = meshes.iter().position(|mesh| mesh.boundary as usize == boundary && !nodes.is_empty())?;
        self.feet.push(NodeFoot { boundary, mesh, shares: nodes.iter().map(|it| (it.node, it.weight())).collect() });
        Some(self.first_foot + self.feet.len() - 1)
    }
}

impl Conductances for Told<'_> {
    fn between(&mut self, first: u32, second: u32, conductance: f64) {
        self.network.connect(self.node(first), self.node(second), conductance);
    }

    fn at_boundary(&mut self, slot: u32, boundary: u32, nodes: &[NodeWeights], conductance: f64) {
        let own = self.boundary(boundary as usize);
        let node = self.foot(boundary as usize, nodes).unwrap_or(own);
        self.network.connect(self.node(slot), node, conductance);
    }
}

#[cfg(test)]
mod tests {
    use super::Network;

    #[test]
    fn leads_come_node_by_node_in_the_order_in_which_they_were_told() {
        let mut network = Network::default();
        for (first, second, conductance) in [(0, 2, 1.0), (2, 3, 2.0), (3, 0, 4.0), (1, 1, 8.0), (0, 3, 0.5)] {
            network.connect(first, second, conductance);
        }
        network.sort(4);
        let leads: Vec<_> = (0..4).map(|node| network.leads(node).to_vec()).collect();
        assert_eq!(leads[0], [(2, 1.0), (3, 4.0), (3, 0.5)]);
        assert_eq!(leads[1], []);
        assert_eq!(leads[2], [(0, 1.0), (3, 2.0)]);
        assert_eq!(leads[3], [(2, 2.0), (0, 4.0), (0, 0.5)]);
        assert_eq!((0..4).map(|node| network.sum(node)).collect::<Vec<_>>(), [5.5, 0.0, 3.0, 6.5]);
    }
}
