//! How the nodes of meshes move, and what they feel: as driven axes of boundaries do, node by node.

use super::course::BoundaryTravel;
use crate::engine::state::nodes::farthest;
use crate::engine::state::{Nodes, Row, State};
use crate::laws::motion::{InputCourse, Progress};
use crate::scene::Scene;

/// Working space of a time step: what the nodes felt at its beginning.
#[derive(Debug, Default)]
pub(crate) struct NodeWorkspace {
    /// Forces of each mesh \[N\].
    force: Vec<Vec<Row>>,
}

/// Begins a communication step of `interval` \[s\]: nodes now know where they go.
pub(crate) fn begin(scene: &Scene, state: &mut State, interval: f64) {
    for nodes in &mut state.nodes {
        nodes.start.clone_from(&nodes.displacement);
        for (target, rate) in nodes.target.iter_mut().zip(&mut nodes.target_rate) {
            (0..3).for_each(|axis| target[axis] += rate[axis] * interval);
            *rate = [0.0; 4];
        }
        nodes.end.clone_from(&nodes.target);
        nodes.impulse.fill([0.0; 4]);
        let course = scene.boundaries[nodes.boundary as usize].input;
        // Targets out of all bounds stay numbers that a state may have.
        nodes.fastest = (course.steepest() * farthest(&nodes.end, &nodes.start) / interval).min(f64::MAX);
    }
}

/// Ends a communication step after `elapsed` \[s\].
pub(crate) fn end(state: &mut State, elapsed: f64) {
    for nodes in state.nodes.iter_mut().filter(|_| elapsed > 0.0) {
        for (mean, impulse) in nodes.mean_force.iter_mut().zip(&nodes.impulse) {
            *mean = impulse.map(|impulse| impulse / elapsed);
        }
    }
}

/// Moves all nodes to where they stand at the end of the present time step, and notes how far their boundaries bend.
pub(crate) fn advance(scene: &Scene, state: &mut State, progress: &Progress, travels: &mut [BoundaryTravel]) {
    for nodes in &mut state.nodes {
        let course = scene.boundaries[nodes.boundary as usize].input;
        nodes.before.clone_from(&nodes.displacement);
        lead(nodes, course, progress);
        travels[nodes.boundary as usize].bent = farthest(&nodes.displacement, &nodes.before);
    }
}

/// Moves the nodes of a mesh from where they stood before the present time step.
fn lead(nodes: &mut Nodes, course: InputCourse, progress: &Progress) {
    let Nodes { displacement, before, velocity, start, end, .. } = nodes;
    let share = progress.share(course);
    for (((place, velocity), before), (start, end)) in
        displacement.iter_mut().zip(velocity).zip(&*before).zip(start.iter().zip(end))
    {
        for axis in 0..3 {
            let way = end[axis] - start[axis];
            place[axis] = if progress.is_last() { end[axis] } else { start[axis] + way * share };
            velocity[axis] = match course {
                InputCourse::Ramp => way / progress.length,
                InputCourse::Smooth | InputCourse::Quadratic => (place[axis] - before[axis]) / progress.step,
                InputCourse::Hold => 0.0,
            };
        }
    }
}

/// Sets the forces on all nodes to zero, and notes what they were.
pub(crate) fn clear_loads(state: &mut State, before: &mut NodeWorkspace) {
    before.force.resize_with(state.nodes.len(), Vec::new);
    for (nodes, force) in state.nodes.iter_mut().zip(&mut before.force) {
        force.clone_from(&nodes.force);
        nodes.force.fill([0.0; 4]);
    }
}

/// Books the impulses of a time step, and the work on its way: the kicks of both its halves, node by node.
pub(crate) fn book(state: &mut State, before: &NodeWorkspace, step: f64) {
    let State { nodes, boundaries, .. } = state;
    for (nodes, force) in nodes.iter_mut().zip(&before.force) {
        let mut work = 0.0;
        for node in 0..nodes.force.len() {
            for axis in 0..3 {
                let both = force[node][axis] + nodes.force[node][axis];
                nodes.impulse[node][axis] += 0.5 * step * both;
                work -= 0.5 * both * (nodes.displacement[node][axis] - nodes.before[node][axis]);
            }
        }
        boundaries[nodes.boundary as usize].work += work;
    }
}

/// Puts the nodes of a mesh where their inputs say, without motion. Returns whether any stands elsewhere then.
pub(crate) fn put(nodes: &mut Nodes, given: &Nodes) -> bool {
    let moves = nodes.displacement != given.target;
    nodes.displacement.clone_from(&given.target);
    take_inputs(nodes, given);
    moves
}

/// Takes over what was given to the nodes of the same mesh.
pub(crate) fn take_inputs(nodes: &mut Nodes, given: &Nodes) {
    nodes.target.clone_from(&given.target);
    nodes.target_rate.clone_from(&given.target_rate);
}

/// Lets the nodes of a mesh stand where those of the same mesh in another state stand, if there are as many.
pub(crate) fn stay(nodes: &mut Nodes, other: &Nodes) {
    if nodes.target.len() == other.target.len() {
        nodes.displacement.clone_from(&other.displacement);
        nodes.target.clone_from(&other.displacement);
    }
}
