//! From a checked scene to its state at time 0 and the passes composed for it.

use crate::engine::bodies::ClumpBodies;
use crate::engine::bodies::RigidBody;
use crate::engine::bonds::BondPass;
use crate::engine::bonds::walls::WallBondPass;
use crate::engine::boundaries::course;
use crate::engine::cell::Cell;
use crate::engine::contacts::Pass;
use crate::engine::contacts::batches::BatchLaw;
use crate::engine::contacts::coefficients::{self, CoefficientTable};
use crate::engine::contacts::followed::FollowedPairs;
use crate::engine::contacts::particles::ContactPass;
use crate::engine::contacts::surfaces::SurfacePass;
use crate::engine::flow;
use crate::engine::fluid;
use crate::engine::neighbours;
use crate::engine::state::{
    BondList, BoundaryState, Clock, ContactList, Deepest, Foresight, Ledger, Losses, Neighbours, Nodes, Pace,
    Particles, State, Through, WallContacts,
};
use crate::engine::traces;
use crate::engine::transfer;
use crate::scene::{Boundary, Particle, Scene};
use std::sync::Mutex;

/// The state of a scene at time 0, without lists and forces.
pub(super) fn state(scene: &Scene) -> State {
    let particles = particles(scene);
    let mean = scene.mean_radius();
    let lists = Neighbours { skin: scene.run.skin.unwrap_or(neighbours::FIRST_SKIN * mean), ..Neighbours::default() };
    State {
        clock: Clock::default(),
        underway: None,
        foresight: Foresight::default(),
        pace: Pace::default(),
        neighbours: lists,
        coefficients: scene.contacts.iter().map(|law| coefficients::rows(law, scene)).collect(),
        tuned: scene.tunables().map(|parameter| parameter.value).collect(),
        contacts: vec![ContactList::default(); scene.contacts.len()],
        walls: wall_lists(scene),
        deepest: Deepest::default(),
        through: Through::default(),
        bonds: vec![BondList::default(); scene.bonds.len()],
        breaks: Vec::new(),
        boundaries: scene.boundaries.iter().map(|it| boundary(scene, it)).collect(),
        nodes: nodes(scene),
        ledger: scene.output.energy.then(Ledger::default),
        losses: scene.output.losses.then(Losses::default),
        damping_force: [0.0; 3],
        damping_impulse: [0.0; 3],
        exchange: flow::begun(scene),
        cell: Cell::begun(scene),
        clumps: ClumpBodies::begun(scene),
        heat: transfer::begun(scene),
        fluid: fluid::begun(scene),
        traces: traces::begun(scene),
        particles,
    }
}

/// The particles in the scene's order.
fn particles(scene: &Scene) -> Particles {
    let bonds = if scene.bonds.is_empty() { Vec::new() } else { vec![[0; 2]; scene.particles.len()] };
    let count = scene.particles.len();
    let mut particles = Particles {
        bonds,
        position: Vec::with_capacity(count),
        velocity: Vec::with_capacity(count),
        angular_velocity: Vec::with_capacity(count),
        ..Particles::default()
    };
    for (index, particle) in scene.particles.iter().enumerate() {
        let [x, y, z] = particle.position;
        let [u, v, w] = particle.velocity;
        let [a, b, c] = particle.angular_velocity;
        particles.position.push([x, y, z, particle.radius]);
        particles.velocity.push([u, v, w, particle.mass()]);
        particles.angular_velocity.push([a, b, c, particle.inertia()]);
        particles.material.push(particle.material.0);
        particles.id.push(index as u32);
        particles.slot.push(index as u32);
    }
    particles.force = vec![[0.0; 4]; count];
    particles.torque = vec![[0.0; 4]; count];
    particles.owner = vec![0; count];
    particles.declared = scene.columns.iter().map(|start| start.particles.clone()).collect();
    for (index, boundary) in scene.boundaries.iter().enumerate() {
        for &member in boundary.shape.members() {
            particles.owner[member as usize] = index as u32 + 1;
        }
    }
    // Laws see the mass of the clump: with it two clumps meet.
    for (owner, clump) in (1 + scene.boundaries.len() as u32..).zip(&scene.clumps) {
        for index in scene.spheres_of(clump) {
            let Particle { shape, radius, .. } = scene.particles[index];
            particles.owner[index] = owner;
            particles.velocity[index][3] = clump.mass;
            particles.angular_velocity[index][3] = shape.inertia(clump.mass, radius);
        }
    }
    particles
}

/// A boundary at time 0.
fn boundary(scene: &Scene, boundary: &Boundary) -> BoundaryState {
    let prescribed: [f64; 6] =
        std::array::from_fn(|axis| boundary.axes[axis].at(0.0).map_or(0.0, |[_, velocity]| velocity));
    let [x, y, z, about_x, about_y, about_z] = prescribed;
    let mut moved = BoundaryState {
        velocity: [x, y, z],
        angular_velocity: [about_x, about_y, about_z],
        pivot: boundary.reference,
        target: [0, 1, 2, 3, 4, 5].map(|axis: usize| boundary.axes[axis].first_input()),
        ..BoundaryState::default()
    };
    course::apply_inputs(boundary, &mut moved);
    if let Some(body) = RigidBody::of(scene, boundary) {
        body.begin(scene, boundary, &mut moved);
    }
    moved
}

/// Nodes that the outside moves, at rest.
fn nodes(scene: &Scene) -> Vec<Nodes> {
    let count = |(index, boundary): (usize, &Boundary)| (index as u32, boundary.driven_nodes());
    let meshes = scene.boundaries.iter().enumerate().map(count).filter(|(_, count)| *count > 0);
    meshes.map(|(boundary, count)| Nodes::at_rest(boundary, count)).collect()
}

/// Surfaces and contact laws that can meet: boundary and law.
fn meetings(scene: &Scene) -> Vec<(u32, u32)> {
    let (mut meetings, governing) = (Vec::new(), scene.governing_laws());
    let present = scene.present();
    for (index, boundary) in (0..).zip(&scene.boundaries) {
        let Some(material) = boundary.shape.material() else { continue };
        for law in 0..scene.contacts.len() as u32 {
            let meets = |other: usize| present[other] && governing.between(other as u32, material.0) == Some(law);
            if (0..present.len()).any(meets) {
                meetings.push((index, law));
            }
        }
    }
    meetings
}

/// Empty lists of the surfaces and contact laws that can meet.
fn wall_lists(scene: &Scene) -> Vec<WallContacts> {
    let lists = meetings(scene).into_iter();
    lists.map(|(boundary, law)| WallContacts { boundary, law, ..WallContacts::default() }).collect()
}

/// The passes of a scene: contacts between particles law by law, bonds law by law, then all surfaces.
pub(super) fn passes(scene: &Scene) -> Vec<Box<dyn Pass>> {
    let mut passes = Vec::new();
    for index in 0..scene.contacts.len() {
        passes.push(Box::new(between_particles(scene, index)) as Box<dyn Pass>);
    }
    for (index, bond) in scene.bonds.iter().enumerate() {
        passes.extend(match bond.plane {
            None => Some(Box::new(BondPass::of(scene, index)) as Box<dyn Pass>),
            Some(plane) => WallBondPass::of(scene, index, plane).map(|pass| Box::new(pass) as _),
        });
    }
    passes.extend(SurfacePass::of(scene, &meetings(scene)).map(|pass| Box::new(pass) as _));
    passes
}

/// The pass of a law between particles.
fn between_particles(scene: &Scene, index: usize) -> ContactPass {
    let law = &scene.contacts[index];
    ContactPass {
        index,
        kept_rows: scene.kept_rows(index).len(),
        table: CoefficientTable::of(law, scene),
        law: BatchLaw::of_scene(scene, index),
        lost: Mutex::default(),
        followed: FollowedPairs::of(scene),
    }
}
