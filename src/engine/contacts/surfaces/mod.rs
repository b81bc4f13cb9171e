//! Contacts of particles with surfaces: one pass for all surfaces of a scene.
//!
//! All surfaces are evaluated together, in pieces of the particles. A particle gets the loads of all surfaces from
//! one thread, in their order, and that thread has the particles of the piece in its cache. A surface alone
//! has too few particles for several threads. Loads on a surface are summed piece by piece, in order.

mod features;
mod history;
mod nodes;
mod plane;
mod sphere;
mod told;
mod traces;

use super::pass::Pass;
use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::RigidBody;
use crate::engine::boundaries::passing::Passing;
use crate::engine::contacts::batches::{BatchLaw, Batches, Bodies, DeepestSearch, Entries};
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::run_error::{Cause, RunError};
use crate::engine::state::heat::{BoundaryHeat, Level, NodesHeat};
use crate::engine::state::ledger::Source;
use crate::engine::state::{BoundaryState, Deepest, Named, Nodes, Row, State, StateFault, WallContacts};
use crate::engine::transfer::takes_heat;
use crate::laws::surface::{self, Deforming};
use crate::scene::{Boundary, Outside, Scene, Shape};
use features::{ColumnBuffer, FeatureContacts};
use plane::{AtPlane, Plane, PlaneList};
use sphere::{Load, ParticleLoads};
use std::ops::Range;
use std::sync::{Mutex, PoisonError, RwLock};
use traces::{SurfaceFollower, TraceRoom};

/// Particles in one piece of work.
const PIECE: usize = 2 * CHUNK;

/// The pass of all surfaces and the contact laws that they meet.
pub(crate) struct SurfacePass {
    /// The surfaces, in the order of their lists.
    surfaces: Vec<AtSurface>,
    /// How particles came to where they are, as surfaces see it.
    passing: Passing,
    /// Working space of a step.
    workspace: Mutex<Workspace>,
}

/// One surface and one contact law that meet.
pub(super) struct AtSurface {
    /// Which list of the state is their own.
    index: usize,
    /// Name of the boundary.
    name: String,
    /// What is touched.
    touched: Touched,
    /// Whether what came through it is taken away.
    removes: bool,
    /// Index of the law.
    law_index: u32,
    /// Index of its material.
    material: u32,
    /// Point about which the moment is taken, at time 0 \[m\].
    reference: Vector,
    /// Velocity of a conveying surface where it lies along this vector, in its own axes \[m/s\].
    conveying: Vector,
    /// The body that it is, where forces move it.
    body: Option<RigidBody>,
    /// Which share of the heat of losses it takes.
    share_of_heat: f64,
    /// Who follows its contacts one by one, if anybody does.
    follower: Option<SurfaceFollower>,
    /// Rows that are stored for each contact.
    kept_rows: usize,
    /// Coefficients of the law.
    table: CoefficientTable,
    /// The law.
    law: BatchLaw,
}

/// What particles touch of a surface.
enum Touched {
    /// A plane that does not turn, as it is at time 0.
    Plane(Plane),
    /// Features of a shape.
    Features(Shape),
    /// Features of a mesh whose nodes move one by one, as it stood last.
    Nodes(RwLock<Box<Deforming>>),
}

/// Working arrays of a step, kept from one step to the next.
#[derive(Default)]
struct Workspace {
    /// What the lists store.
    entries: Vec<Entries>,
    /// Loads of each piece on each surface, piece by piece.
    loads: Vec<Load>,
    /// Contacts with features, of each piece and each surface.
    contacts: Vec<FeatureContacts>,
    /// Room for the contacts with features of each surface.
    spare: Vec<ColumnBuffer>,
    /// Who looks for the deepest contact at each surface.
    deepest: Vec<DeepestSearch>,
}

/// What all pieces share.
struct Work<'a> {
    /// Lists.
    walls: &'a [WallContacts],
    /// What they store.
    entries: &'a [Entries],
    /// Boundaries.
    boundaries: &'a [BoundaryState],
    /// Nodes of meshes.
    nodes: &'a [Nodes],
    /// Temperatures of boundaries and of their nodes; empty where no heat flows.
    heat: (&'a [BoundaryHeat], &'a [NodesHeat]),
    /// Particles.
    particles: ParticleLoads<'a>,
    /// How they came to where they are.
    passing: &'a Passing,
    /// Who looks for the deepest contact at each surface.
    deepest: &'a [DeepestSearch],
    /// Whether a boundary went so far in the present time step that what it went over may not be near it any more.
    far: bool,
    /// Whether heat flows now.
    conducts: bool,
    /// The threads.
    context: &'a Context<'a>,
}

impl Work<'_> {
    /// The temperature of a boundary; zeros where heat does not flow.
    fn level(&self, boundary: u32) -> Level {
        self.heat.0.get(boundary as usize).map_or([0.0; 2], BoundaryHeat::level)
    }
}

impl AtSurface {
    /// A boundary and a law that meet, whose list is this one.
    fn of(scene: &Scene, index: usize, (boundary, law): (&Boundary, usize)) -> Self {
        let choice = &scene.contacts[law];
        let conveying = Vector::from([0, 1, 2].map(|axis| boundary.axes[axis].conveys()));
        let body = RigidBody::of(scene, boundary).filter(RigidBody::is_free);
        let touched = match boundary.shifting_plane() {
            Some(surface::Plane { point, normal, .. }) => {
                let (point, normal, velocity) = (point.into(), normal.into(), Vector::zero());
                let (mobility, conveying) =
                    (body.as_ref().map(|body| body.yields_along(normal)), sphere::along(conveying, normal));
                Touched::Plane(Plane { point, normal, velocity, conveying, mobility })
            }
            None => match boundary.shape.deforming().filter(|_| boundary.driven_nodes() > 0) {
                Some(mesh) => Touched::Nodes(RwLock::new(Box::new(mesh))),
                None => Touched::Features(boundary.shape.clone()),
            },
        };
        Self {
            index,
            law_index: law as u32,
            name: boundary.name.clone(),
            touched,
            removes: boundary.outside == Outside::Remove,
            material: boundary.shape.material().map_or(0, |material| material.0),
            reference: boundary.reference.into(),
            conveying,
            body,
            // An adiabatic surface leaves all to the particle.
            share_of_heat: if takes_heat(boundary) { 0.5 } else { 0.0 },
            follower: SurfaceFollower::of(scene, boundary),
            kept_rows: scene.kept_rows(law).len(),
            table: CoefficientTable::of(choice, scene),
            law: BatchLaw::of_scene(scene, law),
        }
    }

    /// Its list.
    fn list<'a>(&self, state: &'a State) -> &'a WallContacts {
        &state.walls[self.index]
    }

    /// The coefficients of a particle (slot).
    fn row(&self, state: &State, slot: u32) -> &[f64] {
        self.table.row(state.particles.material[slot as usize], self.material)
    }

    /// Loads of the particles in a range of slots on it. Ranges that are evaluated at the same time do not overlap.
    fn piece(&self, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let list = &work.walls[self.index];
        match &self.touched {
            Touched::Plane(plane) => {
                let bodies = self.at_plane(plane, list, work);
                let [from, to] =
                    [slots.start, slots.end].map(|end| bodies.particle.partition_point(|&slot| (slot as usize) < end));
                let batches = self.batches(bodies, work.entries[self.index], work);
                let load = self.run(&batches, from..to, contacts.traces_mut());
                self.trace_plane(&batches, contacts.traces_mut());
                Load { conveying_power: -bodies.plane.conveying.dot(load.force.into()), ..load }
            }
            Touched::Features(_) | Touched::Nodes(_) => self.piece_at_features(work, slots, contacts),
        }
    }

    /// The particles of its list at this plane, where it stands.
    fn at_plane<'a>(&self, plane: &Plane, list: &'a WallContacts, work: &Work<'a>) -> AtPlane<'a> {
        let boundary = &work.boundaries[list.boundary as usize];
        let (plane, pivot) = (plane.at(boundary), self.reference + boundary.displacement.into());
        let (material, share_of_heat) = (self.material, self.share_of_heat);
        let (level, particles) = (work.level(list.boundary), work.particles);
        AtPlane { plane, pivot, particle: &list.particle, material, share_of_heat, level, particles }
    }

    /// Evaluates a piece of a list.
    fn run<B: Bodies<Sum = Load>>(&self, batches: &Batches<B>, entries: Range<usize>, traces: &mut TraceRoom) -> Load {
        let Range { start, end } = entries;
        if batches.follows {
            let (load, lost) = batches.run_followed(start, end, 0..0, &mut traces.followed);
            return Load { lost, ..load };
        }
        if self.law.law.is_booked() {
            let (load, lost) = batches.run_booked(start, end, 0..0);
            return Load { lost, ..load };
        }
        batches.run(start, end, 0..0)
    }

    /// A list that is evaluated in batches.
    fn batches<'a, B>(&'a self, bodies: B, entries: Entries, work: &Work<'a>) -> Batches<'a, B> {
        Batches {
            bodies,
            entries,
            law: &self.law,
            table: &self.table,
            uniform: self.table.uniform_with(self.material),
            step: work.context.step,
            width: work.context.width,
            deepest: &work.deepest[self.index],
            follows: self.follower.is_some(),
            // What is adiabatic takes none of the losses either.
            conducting: self
                .law
                .conducting(self.table.uniform_entry_with(self.material))
                .filter(|_| work.conducts && self.share_of_heat > 0.0),
        }
    }

    /// Notes the deepest contact, if one is deeper than all before.
    fn note_deepest(&self, state: &mut State, search: DeepestSearch) {
        let Some(found) = search.found() else { return };
        let (particle, time) = (Named::at(&state.particles, found.first), state.clock.time);
        let boundary = Some(self.list(state).boundary);
        state.deepest.take(Deepest { overlap: found.overlap, time, particle, partner: None, boundary });
    }

    /// Adds the loads of the pieces to its boundary, in order.
    fn book<'a>(&self, state: &mut State, loads: impl Iterator<Item = &'a Load>) -> Result<(), RunError> {
        let number = state.walls[self.index].boundary as usize;
        let boundary = &mut state.boundaries[number];
        let mut behind = None;
        for load in loads {
            for axis in 0..3 {
                boundary.force[axis] += load.force[axis];
                boundary.moment[axis] += load.moment[axis];
            }
            boundary.conveying_power += load.conveying_power;
            behind = behind.or(load.behind);
            if let Some(losses) = &mut state.losses {
                load.lost.book(&self.law.law, losses);
            }
            if let Some(heat) = &mut state.heat {
                let boundary = &mut heat.boundaries[number];
                boundary.of_losses += load.heat;
                boundary.takes(load.heat_flow);
            }
        }
        match behind {
            None => Ok(()),
            // It goes in the next time step.
            Some(_) if self.removes => Ok(()),
            Some(slot) => Err(RunError::Behind {
                id: state.particles.id[slot as usize],
                boundary: self.name.clone(),
                time: state.clock.time,
                cause: Cause::NotSearched,
            }),
        }
    }
}

impl SurfacePass {
    /// The pass of the boundaries and laws of the scene that meet, in the order of their lists; `None` if none meet.
    pub(crate) fn of(scene: &Scene, meetings: &[(u32, u32)]) -> Option<Self> {
        let surface = |(index, &(boundary, law)): (usize, &(u32, u32))| {
            AtSurface::of(scene, index, (&scene.boundaries[boundary as usize], law as usize))
        };
        let surfaces: Vec<AtSurface> = meetings.iter().enumerate().map(surface).collect();
        (!surfaces.is_empty()).then(|| Self { surfaces, passing: Passing::of(scene), workspace: Mutex::default() })
    }
}

impl Pass for SurfacePass {
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        self.surfaces.iter().try_for_each(|surface| surface.follow(state))?;
        let mut workspace = self.workspace.lock().unwrap_or_else(PoisonError::into_inner);
        let (workspace, count) = (&mut *workspace, self.surfaces.len());
        let pieces = state.particles.len().div_ceil(PIECE);
        workspace.entries.clear();
        let lists = state.walls.iter_mut();
        workspace.entries.extend(
            lists.map(|it| Entries::of(&mut it.flags, it.history.rows(), it.history.all_mut(), &mut it.pair_constant)),
        );
        workspace.loads.clear();
        workspace.loads.resize(pieces * count, Load::default());
        workspace.contacts.resize_with(pieces * count, FeatureContacts::default);
        workspace.spare.resize_with(count, ColumnBuffer::default);
        workspace.deepest.clear();
        workspace.deepest.resize_with(count, || DeepestSearch::beyond(state.deepest.overlap));
        let particles = state.particles.len();
        let far = context.step > 0.0 && self.passing.went_far(state);
        let (mut of_losses, mut present): (&mut [f64], &mut [Row]) = (&mut [], &mut []);
        let mut warm: (&[BoundaryHeat], &[NodesHeat]) = (&[], &[]);
        if let Some(heat) = &mut state.heat {
            (of_losses, present) = (&mut heat.of_losses, &mut heat.slots);
            warm = (&heat.boundaries, &heat.nodes);
        }
        let work = Work {
            conducts: !present.is_empty(),
            heat: warm,
            walls: &state.walls,
            entries: &workspace.entries,
            boundaries: &state.boundaries,
            nodes: &state.nodes,
            particles: ParticleLoads::of(&mut state.particles, of_losses, present),
            passing: &self.passing,
            deepest: &workspace.deepest,
            far,
            context,
        };
        let (loads, contacts) = (Shared::new(&mut workspace.loads), Shared::new(&mut workspace.contacts));
        let evaluate = |piece: usize| {
            let slots = piece * PIECE..((piece + 1) * PIECE).min(particles);
            for (place, surface) in (piece * count..).zip(&self.surfaces) {
                // SAFETY: each piece is done once, and has places of its own.
                unsafe { *loads.at(place) = surface.piece(&work, slots.clone(), contacts.at(place)) };
            }
        };
        context.each(pieces, evaluate);
        let mut result = Ok(());
        for (place, surface) in self.surfaces.iter().enumerate() {
            if surface.has_features() {
                let found = || workspace.contacts.iter().skip(place).step_by(count);
                let (list, spare) = (&mut state.walls[surface.index], &mut workspace.spare[place]);
                features::replace(list, surface.kept_rows, spare, found());
                surface.load_nodes(state, found().map(FeatureContacts::held));
            }
            surface.note_deepest(state, std::mem::replace(&mut workspace.deepest[place], DeepestSearch::beyond(0.0)));
            if let Some(follower) = &surface.follower {
                let found = workspace.contacts.iter().skip(place).step_by(count);
                found.for_each(|piece| follower.book(piece.traces(), state));
            }
            result = result.and(surface.book(state, workspace.loads.iter().skip(place).step_by(count)));
        }
        state.through.look(&state.contacts, &state.particles, state.clock.time);
        result
    }

    fn check(&self, state: &State) -> Result<(), StateFault> {
        self.surfaces.iter().try_for_each(|surface| {
            let (list, constant) = (surface.list(state), surface.law.law.has_pair_constant());
            match &surface.touched {
                Touched::Plane(_) => list.check_columns(surface.kept_rows, constant),
                Touched::Features(_) | Touched::Nodes(_) => {
                    list.check_features(surface.kept_rows, constant, surface.touched.counts())
                }
            }
        })
    }

    fn has_torque(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.law.needs.torque)
    }

    fn source(&self) -> Source {
        Source::Walls
    }

    fn take_coefficients(&mut self, state: &State) {
        for surface in &mut self.surfaces {
            surface.table.take(&state.coefficients[state.walls[surface.index].law as usize]);
        }
    }

    fn let_go(&self, state: &mut State, goes: &[bool], _step: f64) -> f64 {
        self.surfaces.iter().for_each(|surface| surface.end_impacts(state, goes));
        0.0
    }

    fn prepare(&self, state: &mut State) {
        for surface in &self.surfaces {
            let (list, particles, law) = (&mut state.walls[surface.index], &state.particles, &surface.law.law);
            list.pair_constant.clear();
            if law.has_pair_constant() {
                let near = match &surface.touched {
                    Touched::Plane(_) => &list.particle,
                    Touched::Features(_) | Touched::Nodes(_) => &list.near.particle,
                };
                list.pair_constant.extend(near.iter().map(|&slot| {
                    let slot = slot as usize;
                    let row = surface.table.row(particles.material[slot], surface.material);
                    law.pair_constant(row, particles.position[slot][3], particles.velocity[slot][3])
                }));
            }
        }
        self.find_separated(state);
    }
}

impl Touched {
    /// How many parts, and how many features, there are.
    fn counts(&self) -> [usize; 2] {
        match self {
            Self::Plane(_) => [0; 2],
            Self::Features(shape) => shape.features().map_or([0; 2], |features| features.counts()),
            Self::Nodes(shape) => shape.read().unwrap_or_else(PoisonError::into_inner).features().counts(),
        }
    }
}

impl AtSurface {
    /// Whether it is touched feature by feature.
    fn has_features(&self) -> bool {
        !matches!(self.touched, Touched::Plane(_))
    }

    /// Its contacts, if it is a plane that does not turn.
    fn plane_list(&self, state: &State) -> Option<PlaneList<'_>> {
        let Touched::Plane(plane) = &self.touched else { return None };
        let plane = plane.at(&state.boundaries[self.list(state).boundary as usize]);
        Some(PlaneList { surface: self, plane })
    }
}
