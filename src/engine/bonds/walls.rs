//! Bonds of particles to planes: one pass for each bond law between a set and a plane.
//!
//! The other body of a bond is its foot point, which moves with the plane. A particle stands once in a list, so pieces
//! of a list are worked on side by side; loads on the plane are summed piece by piece, in order.

use super::heat::BondHeat;
use super::{Done, begin_losses, body_of, book, end_gone, link_of, powers, shared_damping, stretched, whole_force};
use crate::base::lanes::Shared;
use crate::base::number::{Vector, add};
use crate::base::quantity::{BoundaryIndex, SetIndex};
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::RigidBody;
use crate::engine::contacts::BondRecord;
use crate::engine::contacts::{Kind, Link, Pass, SearchLimits, Stiffness, Telling};
use crate::engine::run_error::RunError;
use crate::engine::state::ledger::Source;
use crate::engine::state::{BoundaryState, Particles, Row, State, StateFault};
use crate::laws::bond::creation::{Creation, Moment, near_plane};
use crate::laws::bond::damping::LastDamping;
use crate::laws::bond::{Body, BondLoads, Coefficients, Law, MOST_ROWS, OneBond, Pair, Quaternion, Rows};
use crate::scene::{Boundary, Scene};
use std::sync::{Mutex, PoisonError};

/// The pass of one bond law at a plane.
pub(crate) struct WallBondPass {
    /// Which list of the state is its own; also the law's index in the scene.
    pub(super) index: usize,
    /// The law in numbers.
    pub(super) law: Law,
    /// Its formulation.
    one_bond: OneBond,
    /// When bonds are made.
    creation: Creation,
    /// Twice the distance of a centre below which it is bonded \[m\].
    create_distance: f64,
    /// Set of each of the scene's particles.
    sets: Vec<SetIndex>,
    /// The set that is bonded.
    set: SetIndex,
    /// The plane.
    pub(super) boundary: BoundaryIndex,
    /// A point on it at time 0 \[m\].
    point: Vector,
    /// Unit normal towards the particles.
    normal: Vector,
    /// Point about which the moment is taken, at time 0 \[m\].
    pub(super) reference: Vector,
    /// Mass of the plane, where forces move it along its normal \[kg\].
    mass: f64,
    /// Working space for the results of each piece of the list.
    pieces: Mutex<Vec<Piece>>,
    /// What of its losses warms the bodies.
    heat: BondHeat,
}

/// Results of a piece of a list.
struct Piece {
    /// Energies and breakage.
    done: Done,
    /// Force on the plane \[N\].
    force: Vector,
    /// Moment on the plane about its moved reference point \[N m\].
    moment: Vector,
}

impl Default for Piece {
    fn default() -> Self {
        Self { done: Done::default(), force: Vector::zero(), moment: Vector::zero() }
    }
}

impl WallBondPass {
    /// The pass of this bond of the scene; none where the boundary is not a plane.
    pub(crate) fn of(scene: &Scene, index: usize, boundary: BoundaryIndex) -> Option<Self> {
        let (bond, law) = (&scene.bonds[index], scene.bond_law(index));
        let Boundary { reference, .. } = &scene.boundaries[boundary.index()];
        let plane = scene.boundaries[boundary.index()].shifting_plane()?;
        let body = RigidBody::of(scene, &scene.boundaries[boundary.index()]);
        let mobility = body.map_or(0.0, |body| body.yields_along(plane.normal.into()));
        Some(Self {
            index,
            one_bond: law.one_bond(),
            law,
            creation: bond.keys.create.clone(),
            create_distance: bond.create_distance().unwrap_or(0.0),
            sets: scene.particles.iter().map(|particle| particle.set).collect(),
            set: bond.between[0],
            boundary,
            point: plane.point.into(),
            normal: plane.normal.into(),
            reference: (*reference).into(),
            mass: 1.0 / mobility,
            pieces: Mutex::default(),
            heat: BondHeat::of(scene, Some(boundary.index())),
        })
    }

    /// The foot of a bond as its second body.
    pub(super) fn foot(&self, foot: Row, plane: &BoundaryState) -> Body {
        Body {
            position: Vector::from(foot) + plane.displacement.into(),
            velocity: plane.velocity.into(),
            spin: Vector::zero(),
            orientation: Quaternion::identity(),
            radius: 0.0,
            mass: self.mass,
            inertia: f64::INFINITY,
        }
    }

    /// A listed bond's bodies.
    fn pair(&self, state: &State, bond: usize) -> Pair {
        let list = &state.bonds[self.index];
        let foot = self.foot(list.foot[bond], &state.boundaries[self.boundary.index()]);
        Pair::at_wall(&body_of(&state.particles, list.first[bond] as usize), &foot)
    }

    /// What a bond carries.
    fn carried(&self, state: &State, bond: usize) -> BondLoads {
        let mut rows = Rows::default();
        for (row, column) in rows.iter_mut().zip(&state.bonds[self.index].rows) {
            *row = column[bond];
        }
        self.law.carried(&self.pair(state, bond), &rows)
    }

    /// Particles to be bonded at this moment, with the feet of their bonds where the plane stood at time 0.
    fn wanted(&self, state: &State, moment: &Moment) -> Vec<(u32, Row)> {
        if !self.creation.bonds_near_pairs(moment) {
            return Vec::new();
        }
        self.unbonded(state, self.create_distance)
    }

    /// Particles without a bond that are this near, with their feet.
    fn unbonded(&self, state: &State, create_distance: f64) -> Vec<(u32, Row)> {
        let (particles, list) = (&state.particles, &state.bonds[self.index]);
        let displacement = Vector::from(state.boundaries[self.boundary.index()].displacement);
        let mut bonded = list.first.clone();
        bonded.sort_unstable();
        let near = |slot: usize| {
            let member = self.sets.get(particles.id[slot] as usize) == Some(&self.set);
            let position = Vector::from(particles.position[slot]) - displacement;
            let distance = (position - self.point).dot(self.normal);
            let free = member && distance > 0.0 && bonded.binary_search(&(slot as u32)).is_err();
            let [x, y, z] = (position - self.normal * distance).to_array();
            (free && near_plane(distance, create_distance)).then_some((slot as u32, [x, y, z, 0.0]))
        };
        (0..particles.len()).filter_map(near).collect()
    }
}

/// What all pieces of a list share.
struct Work<'a> {
    /// The pass.
    pass: &'a WallBondPass,
    /// The law at this step.
    coefficients: Coefficients,
    /// Rows of the list, each a column.
    rows: [Shared<Row>; MOST_ROWS],
    /// What damping left in the last evaluation, row by row; empty where there is nothing.
    damping: [Shared<Row>; LastDamping::MOST_ROWS],
    /// Energy that each bond lost; empty where none does.
    lost: Shared<f64>,
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
    /// The particle of each bond.
    first: &'a [u32],
    /// The foot of each bond.
    foot: &'a [Row],
    /// The particles.
    particles: &'a Particles,
    /// The plane.
    plane: &'a BoundaryState,
    /// Time since bonds were last advanced \[s\].
    step: f64,
}

/// A row of a bond out of each column; zeros if there is no column.
///
/// # Safety
/// The bond is in the list, and belongs to the piece that asks.
unsafe fn rows_of<const COUNT: usize>(columns: &[Shared<Row>; COUNT], bond: usize) -> [Row; COUNT] {
    // SAFETY: the caller's promise; a column has a row for each bond, or none.
    columns.map(|column| if column.length() > 0 { unsafe { *column.at(bond) } } else { [0.0; 4] })
}

impl Work<'_> {
    /// The law on a piece of the list. Each piece is for one thread only.
    fn piece(&self, from: usize, to: usize) -> Piece {
        let WallBondPass { law, one_bond, reference, .. } = self.pass;
        let mut piece = Piece::default();
        for bond in from..to {
            let slot = self.first[bond] as usize;
            let pair = Pair::at_wall(&body_of(self.particles, slot), &self.pass.foot(self.foot[bond], self.plane));
            // SAFETY: pieces do not overlap.
            let (rows, last) = unsafe { (rows_of(&self.rows, bond), rows_of(&self.damping, bond)) };
            let reaction = law.react(&self.coefficients, &pair, &rows, &LastDamping::from_rows(last));
            let damping = reaction.damping.to_rows();
            for (row, column) in damping.iter().zip(&self.damping).filter(|(_, column)| column.length() > 0) {
                // SAFETY: as above.
                unsafe { *column.at(bond) = *row };
            }
            if self.step > 0.0 {
                let changing = reaction.rows.iter().zip(&self.rows).take(one_bond.rows).skip(one_bond.fixed_rows);
                for (row, column) in changing {
                    // SAFETY: as above.
                    unsafe { *column.at(bond) = *row };
                }
            }
            // SAFETY: a particle stands once in a list.
            let (force, torque) = unsafe { (self.force.at(slot), self.torque.at(slot)) };
            let (push, turn) = (reaction.force.row_with(0.0), reaction.torque_i.row_with(0.0));
            add(force, &push);
            add(torque, &turn);
            let arm = Vector::from(self.foot[bond]) - *reference;
            piece.force += -reaction.force;
            piece.moment += reaction.torque_j - arm.cross(reaction.force);
            if self.lost.length() > 0 {
                // SAFETY: pieces do not overlap, and there is one for each bond.
                unsafe { *self.lost.at(bond) += reaction.relaxed + reaction.damped };
            }
            piece.done.add(bond as u32, &reaction);
        }
        piece
    }
}

impl Pass for WallBondPass {
    fn take_strengths(&mut self, scene: &Scene, state: &State) {
        if let Ok(law) = scene.tuned_law(self.index, &state.tuned) {
            self.law = law;
        }
    }

    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let list = &mut state.bonds[self.index];
        let count = list.first.len();
        self.heat.begin(list);
        let mut columns = list.rows.iter_mut();
        let mut column = || columns.next().map_or(Shared::new(&mut []), |column| Shared::new(column));
        let work = Work {
            pass: self,
            coefficients: self.law.elasticity.at_step(context.step),
            rows: [column(), column(), column()],
            damping: shared_damping(&mut list.damping),
            lost: Shared::new(&mut list.lost),
            force: Shared::new(&mut state.particles.force),
            torque: Shared::new(&mut state.particles.torque),
            first: &list.first,
            foot: &list.foot,
            particles: &state.particles,
            plane: &state.boundaries[self.boundary.index()],
            step: context.step,
        };
        let mut pieces = self.pieces.lock().unwrap_or_else(PoisonError::into_inner);
        pieces.clear();
        pieces.resize_with(count.div_ceil(CHUNK), Piece::default);
        let places = Shared::new(&mut pieces);
        context.each(count.div_ceil(CHUNK), |piece| {
            let done = work.piece(piece * CHUNK, ((piece + 1) * CHUNK).min(count));
            // SAFETY: each piece is done once, and has a place of its own.
            unsafe { *places.at(piece) = done };
        });
        let plane = &mut state.boundaries[self.boundary.index()];
        for piece in &*pieces {
            plane.force = (Vector::from(plane.force) + piece.force).to_array();
            plane.moment = (Vector::from(plane.moment) + piece.moment).to_array();
        }
        for piece in &mut *pieces {
            piece.done.release(context.step, |bond| self.carried(state, bond));
        }
        let results = pieces.iter().map(|piece| &piece.done);
        self.heat.end(&mut state.bonds[self.index], state.heat.as_mut(), results);
        book(state, self.index, pieces.iter().map(|piece| &piece.done))
    }

    fn create(&self, state: &mut State, moment: &Moment, step: f64) -> bool {
        let wanted = self.wanted(state, moment);
        let law = self.law.elasticity.at_step::<f64>(step);
        for &(slot, foot) in &wanted {
            let plane = &state.boundaries[self.boundary.index()];
            let pair = Pair::at_wall(&body_of(&state.particles, slot as usize), &self.foot(foot, plane));
            let rows = (self.one_bond.create)(&law, &pair);
            let list = &mut state.bonds[self.index];
            list.rows.resize(self.one_bond.rows, Vec::new());
            list.first.push(slot);
            list.foot.push(foot);
            begin_losses(list, &self.law, &law, &pair);
            state.particles.count_bond([state.particles.id[slot as usize]]);
            for (column, row) in list.rows.iter_mut().zip(rows) {
                column.push(row);
            }
        }
        state.bonds[self.index].made += wanted.len() as u64;
        !wanted.is_empty()
    }

    fn check(&self, state: &State) -> Result<(), StateFault> {
        state.bonds[self.index].check_columns(self.one_bond.rows, self.law.dissipates(), true)?;
        state.bonds[self.index].check_damping(self.law.damping_rows())
    }

    fn has_torque(&self) -> bool {
        true
    }

    fn needs_orientations(&self) -> bool {
        self.one_bond.needs_orientations
    }

    fn source(&self) -> Source {
        Source::Bonds
    }

    fn let_go(&self, state: &mut State, goes: &[bool], step: f64) -> f64 {
        let list = &state.bonds[self.index];
        let any = |bond: &usize| goes[list.first[*bond] as usize];
        let gone = (0..list.first.len()).filter(any);
        let of = |bond| (list.first[bond], powers(list, bond, &self.pair(state, bond), &self.carried(state, bond)));
        let gone: Vec<_> = gone.map(of).collect();
        end_gone(state, (self.index, &self.heat), &gone, 0.5 * step)
    }
}

impl Stiffness for WallBondPass {
    fn stiffness(&self, state: &State, ahead: &SearchLimits, _context: &Context, tell: &mut dyn FnMut(Link)) {
        for (bond, &first) in state.bonds[self.index].first.iter().enumerate() {
            let pair = self.pair(state, bond);
            let bodies = (first, None, Some(self.boundary.0));
            tell(link_of(&self.law, &pair, bodies, Kind::Bond));
            stretched(&pair, bodies, self.carried(state, bond).normal, tell);
        }
        if !ahead.window.as_ref().is_some_and(|window| self.creation.comes_within(window)) {
            return;
        }
        for (slot, foot) in self.unbonded(state, self.create_distance + 2.0 * ahead.margin.max(ahead.way)) {
            let plane = &state.boundaries[self.boundary.index()];
            let pair = Pair::at_wall(&body_of(&state.particles, slot as usize), &self.foot(foot, plane));
            tell(link_of(&self.law, &pair, (slot, None, Some(self.boundary.0)), Kind::ComingBond));
        }
    }
}

impl Telling for WallBondPass {
    fn bonds(&self, state: &State, tell: &mut dyn FnMut(BondRecord)) {
        let list = &state.bonds[self.index];
        for (bond, &slot) in list.first.iter().enumerate() {
            let carried = self.carried(state, bond);
            let foot = self.foot(list.foot[bond], &state.boundaries[self.boundary.index()]);
            let (first, other) = (state.particles.id[slot as usize], foot.position.to_array());
            let position = Vector::from(state.particles.position[slot as usize]).to_array();
            let dissipated = list.lost.get(bond).copied().unwrap_or(0.0);
            let law = self.index as u32;
            let force = whole_force(list, bond, &carried);
            tell(BondRecord { law, first, second: None, position, other, force, carried, dissipated });
        }
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        (0..state.bonds[self.index].first.len()).map(|bond| self.carried(state, bond).energy).sum()
    }
}
