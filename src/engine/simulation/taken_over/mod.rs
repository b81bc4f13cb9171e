//! A state that another scene has reached, as the start of this one: stages of a protocol.
//!
//! The particles, found by their ids, keep what belongs to them: position, motion, orientation, springs of contacts, bonds.
//! Boundaries of the same name stay where they are. The new scene determines all the rest: materials, laws, motions, books.
//! If it differs from the other one only in its end and its outputs, the run continues bit for bit.

mod description;
mod exchange;
mod history;

pub use description::Description;

use super::{RunError, Simulation, assemble, number};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::engine::bodies::boundary;
use crate::engine::bodies::clumps;
use crate::engine::boundaries::{nodes, placing};
use crate::engine::cell::images;
use crate::engine::columns;
use crate::engine::state::{Particles, State, StateFault};
use crate::laws::bond::creation::Moment;
use crate::scene::{BoundaryTemperature, CellMotion, Scene};
use std::sync::Arc;

/// Distance over the radius below which a particle of a group is where its group has it.
const IN_PLACE: f64 = 1e-6;

/// Which of the new scene's particles each of the other's is.
struct Numbers {
    /// For each particle of the other scene: its index here, if it is here.
    here: Vec<Option<u32>>,
}

impl Numbers {
    /// Finds the numbers of one scene in the other; both ascend.
    fn of(scene: &Scene, from: &Description) -> Self {
        let find = |id: u32| scene.particles.binary_search_by_key(&id, |particle| particle.id.0).ok();
        Self { here: from.ids().map(|id| find(id).map(|index| index as u32)).collect() }
    }

    /// The index here of a particle of the other scene.
    fn at(&self, there: u32) -> Option<u32> {
        self.here.get(there as usize).copied().flatten()
    }

    /// Slots here, which are indices, and there of the particles that are in both.
    fn slots(&self, other: &Particles) -> Vec<[usize; 2]> {
        let both = |(there, here): (u32, &Option<u32>)| Some([(*here)? as usize, other.slot_of(there)?]);
        (0..).zip(&self.here).filter_map(both).collect()
    }
}

impl Simulation {
    /// The scene in a state that was reached by one which differs from it in its end and its outputs at most
    /// ([`Description::goes_on_as`]).
    pub fn going_on(scene: Arc<Scene>, mut state: State, from: &Description) -> Result<Self, StateFault> {
        history::fit_outputs(&scene, &mut state, from);
        // A communication step that was left on its way belongs to the other run.
        state.underway = None;
        Self::resume(scene, state)
    }

    /// The scene in a state that another scene has reached, and what of that state could not be taken over. A state from
    /// outside has been checked by [`Description::check`].
    pub fn taken_over(scene: Arc<Scene>, reached: &State, from: &Description) -> Result<(Self, Vec<String>), RunError> {
        let origin = |state: &State| state.cell.as_ref().map(|cell| cell.origin);
        if origin(&assemble::state(&scene)) != origin(reached) {
            return Err(RunError::CellElsewhere);
        }
        let mut numbers = Numbers::of(&scene, from);
        let mut state = assemble::state(&scene);
        let mut left = from.differences(&scene);
        left.extend(exchange::put_newcomers(&scene, &mut state, reached, (from, &mut numbers)));
        state.clock.time = reached.clock.time;
        state.clock.lost = reached.clock.lost;
        state.clock.steps = reached.clock.steps;
        state.clock.rebuilds = reached.clock.rebuilds;
        let slots = numbers.slots(&reached.particles);
        put_particles(&mut state, reached, &slots);
        left.extend(columns::take_over(&scene, &mut state, (reached, from.columns()), &slots));
        put_clumps(&mut state, reached, &numbers);
        put_boundaries(&scene, &mut state, reached, from);
        put_temperatures(&scene, &mut state, reached, from);
        let rows = images::take_over(&mut state, reached, |there| numbers.at(there));
        begin_inputs(&scene, &mut state);
        history::put_contacts(&scene, &mut state, reached, (from, &numbers), &rows);
        let mut simulation = Self::with(scene, state);
        simulation.give_orientations();
        let there: Vec<_> = simulation.state.particles.position.clone();
        let Self { scene, bodies, shapes, state, .. } = &mut simulation;
        boundary::place_groups(scene, bodies, state);
        if let Some(shapes) = shapes {
            shapes.place(state);
        }
        check_groups(scene, state, &there)?;
        exchange::take_gone(state, reached, &numbers);
        simulation.check_memory()?;
        simulation.rebuild(&simulation.standing());
        let time = simulation.state.clock.time;
        simulation.make_bonds(&Moment { number: 0, from: time, to: time }, &simulation.standing());
        left.extend(simulation.put_bonds(reached, from, &numbers));
        simulation.rebuild(&simulation.standing());
        simulation.start()?;
        Ok((simulation, left))
    }
}

/// Lets driven strains of a cell begin with what they have come to.
fn begin_inputs(scene: &Scene, state: &mut State) {
    if let (Some(scene), Some(cell)) = (&scene.cell, &mut state.cell) {
        for component in (0..6).filter(|&component| scene.motion[component] == CellMotion::Driven) {
            cell.target[component] = cell.strain[component];
        }
    }
}

/// Sets positions and motion of the particles.
fn put_particles(state: &mut State, reached: &State, slots: &[[usize; 2]]) {
    let (particles, other) = (&mut state.particles, &reached.particles);
    if !other.orientation.is_empty() {
        particles.orientation.resize(particles.len(), Quaternion::identity().to_row());
    }
    for &[slot, from] in slots {
        for axis in 0..3 {
            particles.position[slot][axis] = other.position[from][axis];
            particles.velocity[slot][axis] = other.velocity[from][axis];
            particles.angular_velocity[slot][axis] = other.angular_velocity[from][axis];
        }
        if let (Some(orientation), Some(other)) = (particles.orientation.get_mut(slot), other.orientation.get(from)) {
            *orientation = *other;
        }
    }
}

/// Lets clumps stand and move as those to which their spheres belonged.
fn put_clumps(state: &mut State, reached: &State, numbers: &Numbers) {
    let mut there = vec![None; state.particles.slot.len()];
    for (index, here) in numbers.here.iter().enumerate() {
        let Some(here) = here else { continue };
        there[*here as usize] = reached.particles.slot_of(index as u32).and_then(|slot| reached.clump(slot));
    }
    for index in 0..state.clumps.len() {
        let Some(from) = there[state.clumps.spheres_of(index)[0] as usize] else { continue };
        let (own, other) = (&mut state.clumps, &reached.clumps);
        for (own, other) in [
            (&mut own.position, &other.position),
            (&mut own.velocity, &other.velocity),
            (&mut own.angular_momentum, &other.angular_momentum),
        ] {
            own[index][..3].copy_from_slice(&other[from][..3]);
        }
        own.orientation[index] = other.orientation[from];
        clumps::set_spin(own, index);
    }
}

/// Lets boundaries that take up heat be as warm as they were; a group is as warm as its particles.
fn put_temperatures(scene: &Scene, state: &mut State, reached: &State, from: &Description) {
    let (Some(heat), Some(other)) = (&mut state.heat, &reached.heat) else { return };
    for (boundary, moved) in scene.boundaries.iter().zip(&mut heat.boundaries) {
        let there = from.boundary(boundary).and_then(|index| other.boundaries.get(index));
        let is_body = matches!(boundary.temperature, BoundaryTemperature::Body { .. });
        if let Some(there) = there.filter(|there| is_body && there.capacity > 0.0) {
            moved.initial = there.temperature();
        }
    }
}

/// Takes over the positions of boundaries of the same name, and the velocities of free axes.
fn put_boundaries(scene: &Scene, state: &mut State, reached: &State, from: &Description) {
    let time = state.clock.time;
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        // The parts of a machine stand where that with its motion does.
        let leader = boundary.moves_with.map_or(boundary, |leader| &scene.boundaries[leader.index()]);
        let Some(other) = from.boundary(leader).and_then(|index| reached.boundaries.get(index)) else {
            placing::begin_prescribed(boundary, moved, time);
            continue;
        };
        moved.displacement = other.displacement;
        let own = from.boundary(boundary).and_then(|index| reached.boundaries.get(index));
        if let Some(own) = own.filter(|_| scene.cell.is_some()) {
            moved.brought_back = own.brought_back;
        }
        moved.rotation = other.rotation;
        moved.orientation = other.orientation;
        moved.start_orientation = other.orientation;
        moved.before = moved.stand();
        let [x, y, z] = other.displacement;
        let [a, b, c] = other.rotation;
        for (axis, place) in [x, y, z, a, b, c].into_iter().enumerate() {
            let motion = &boundary.axes[axis];
            if !(motion.takes_force() || motion.takes_velocity()) {
                moved.target[axis] = place;
            }
        }
        placing::begin_prescribed(boundary, moved, time);
        for axis in (0..3).filter(|&axis| boundary.axes[axis].is_free()) {
            moved.velocity[axis] = other.velocity[axis];
        }
        if boundary.axes[3..].iter().any(|motion| motion.is_free()) {
            moved.angular_velocity = other.angular_velocity;
            moved.inertial.angular_momentum = other.inertial.angular_momentum;
        }
    }
    for moved in &mut state.nodes {
        let there = from.boundary(&scene.boundaries[moved.boundary as usize]);
        if let Some(other) = there.and_then(|boundary| reached.nodes_of(boundary)) {
            nodes::stay(moved, other);
        }
    }
}

/// Refuses a group or clump that this scene puts elsewhere than its particles are, because they would jump.
fn check_groups(scene: &Scene, state: &State, there: &[[f64; 4]]) -> Result<(), RunError> {
    for boundary in &scene.boundaries {
        for &member in boundary.shape.members() {
            let (now, then) = (state.particles.position[member as usize], there[member as usize]);
            let [[x, y, z, _], [a, b, c, _]] = [now, then];
            let apart = Vector::new(x - a, y - b, z - c).length();
            let in_cell = scene.cell.as_ref().map(|cell| cell.lattice.distance([x, y, z], [a, b, c]));
            let way = in_cell.unwrap_or(apart);
            if way.is_nan() || way > IN_PLACE * now[3] {
                let (boundary, id) = (boundary.name.clone(), scene.particles[member as usize].id.0);
                return Err(RunError::GroupElsewhere { boundary, id, way });
            }
        }
    }
    for &index in &state.clumps.spheres {
        let (now, then) = (state.particles.position[index as usize], there[index as usize]);
        let way = (Vector::from(now) - Vector::from(then)).length();
        if way.is_nan() || way > IN_PLACE * now[3] {
            return Err(RunError::ClumpElsewhere { id: number(scene, &state.particles, index), way });
        }
    }
    Ok(())
}
