//! Bonds between particles: one pass for each bond law.
//!
//! Like contacts, bonds are evaluated slab by slab and batch by batch: the law on several bonds at once, results added one by
//! one in the order of the list. Every listed bond lives; broken bonds are removed, in order, at the end of
//! the pass.

mod after;
mod batch;
mod book;
pub(crate) mod clusters;
mod heat;
mod pipeline_buffer;
pub(crate) mod walls;

pub(crate) use book::{Done, book};

use crate::base::lanes::Shared;
use crate::base::number::Vector;
use crate::base::quantity::SetIndex;
use crate::base::threads::Context;
use crate::engine::contacts::BondRecord;
use crate::engine::contacts::{Kind, Link, Pass, SearchLimits, Stiffness, Telling};
use crate::engine::neighbours::PairCache;
use crate::engine::neighbours::bonds::is_bonded;
use crate::engine::neighbours::near_pairs;
use crate::engine::run_error::RunError;
use crate::engine::state::ledger::Source;
use crate::engine::state::{BondList, CellState, IMAGE, Particles, Row, State, StateFault};
use crate::laws::bond::creation::{Creation, Moment, near_pair};
use crate::laws::bond::damping::LastDamping;
use crate::laws::bond::{Body, BondLoads, Coefficients, Law, OneBond, Pair, Quaternion, Rows};
use crate::scene::Scene;
use after::After;
use batch::{SlabOf, TakeSlabs, Work};
use heat::BondHeat;
use std::sync::{Mutex, PoisonError};

/// The pass of one bond law between particles.
pub(crate) struct BondPass {
    /// Which list of the state is its own; also the law's index in the scene.
    index: usize,
    /// The law in numbers.
    law: Law,
    /// Its formulation for one bond.
    one_bond: OneBond,
    /// Its formulation for a slab of bonds.
    slab: SlabOf,
    /// Its damping and breakage for several bonds at a time.
    after: After,
    /// When bonds are made.
    creation: Creation,
    /// Centres nearer than this are bonded \[m\].
    create_distance: f64,
    /// Set of each of the scene's particles.
    sets: Vec<SetIndex>,
    /// Between which sets.
    between: [SetIndex; 2],
    /// Listed pairs: indices into the scene's particles.
    pairs: Vec<[u32; 2]>,
    /// Pairs that may be near, where bonds are made in every step.
    near: Mutex<PairCache>,
    /// Working space for the results of each slab.
    results: Mutex<Vec<Done>>,
    /// What of its losses warms the bodies.
    heat: BondHeat,
}

impl BondPass {
    /// The pass of this bond of the scene.
    pub(crate) fn of(scene: &Scene, index: usize) -> Self {
        let (bond, law) = (&scene.bonds[index], scene.bond_law(index));
        Self {
            index,
            one_bond: law.one_bond(),
            slab: law.formulation.visit(law.asked(), TakeSlabs),
            after: After::of(&law),
            law,
            creation: bond.keys.create.clone(),
            create_distance: bond.create_distance().unwrap_or(0.0),
            sets: scene.particles.iter().map(|particle| particle.set).collect(),
            between: bond.between,
            pairs: bond.pairs.clone(),
            near: Mutex::default(),
            results: Mutex::default(),
            heat: BondHeat::of(scene, None),
        }
    }

    /// Whether these two particles (indices into the scene's) may be bonded by this law.
    fn may_bond(&self, a: u32, b: u32) -> bool {
        // Particles that come later are of no set.
        let (Some(&a), Some(&b)) = (self.sets.get(a as usize), self.sets.get(b as usize)) else { return false };
        [a, b] == self.between || [b, a] == self.between
    }

    /// What a bond carries.
    fn carried(&self, state: &State, bond: usize) -> BondLoads {
        let list = &state.bonds[self.index];
        let mut rows = Rows::default();
        for (row, column) in rows.iter_mut().zip(&list.rows) {
            *row = column[bond];
        }
        let [i, j] = [list.first[bond], list.second[bond]].map(|slot| slot as usize);
        self.law.carried(&pair_of(&state.particles, i, j), &rows)
    }

    /// Pairs without a bond that may be bonded before the stable time step is found again.
    fn coming(&self, state: &State, ahead: &SearchLimits) -> Vec<[u32; 2]> {
        if !ahead.window.as_ref().is_some_and(|window| self.creation.comes_within(window)) {
            return Vec::new();
        }
        let (particles, list) = (&state.particles, &state.bonds[self.index]);
        let mut pairs = Vec::new();
        near_pairs(particles, self.create_distance + ahead.margin.max(ahead.way), |a, b, _| {
            let [first, second] = [a, b].map(|slot| particles.id[slot as usize]);
            if !are_images(particles, a, b) && self.may_bond(first, second) && !is_bonded(list, a, b) {
                pairs.push([a, b]);
            }
        });
        pairs
    }

    /// Pairs without a bond that are to be bonded at this moment, as slots of i and j; i has the smaller id.
    fn wanted(&self, state: &State, moment: &Moment) -> Vec<[u32; 2]> {
        let particles = &state.particles;
        let mut pairs = Vec::new();
        if moment.number == 0 {
            pairs.extend(self.pairs.iter().map(|pair| match &state.cell {
                None => pair.map(|index| particles.slot[index as usize]),
                Some(cell) => nearest(particles, cell, *pair),
            }));
        }
        let list = &state.bonds[self.index];
        let hand = |a: u32, b: u32, distance: f64| {
            let ids = [particles.id[a as usize], particles.id[b as usize]];
            if near_pair(distance, self.create_distance)
                && !are_images(particles, a, b)
                && !state.are_of_one_body(a, b)
                && self.may_bond(ids[0], ids[1])
                && !is_bonded(list, a, b)
            {
                pairs.push([a, b]);
            }
        };
        // What is remembered goes by particles, which does not tell an image.
        let remembers = self.creation.is_continual() && state.cell.is_none();
        if remembers && self.creation.bonds_near_pairs(moment) {
            let mut near = self.near.lock().unwrap_or_else(PoisonError::into_inner);
            near.pairs(particles, self.create_distance, hand);
        } else if self.creation.bonds_near_pairs(moment) {
            near_pairs(particles, self.create_distance, hand);
        }
        for pair in &mut pairs {
            pair.sort_unstable_by_key(|&slot| (particles.id[slot as usize], slot));
        }
        pairs.sort_unstable_by_key(|pair| pair.map(|slot| (particles.id[slot as usize], slot)));
        pairs.dedup();
        pairs
    }
}

impl Pass for BondPass {
    fn take_strengths(&mut self, scene: &Scene, state: &State) {
        if let Ok(law) = scene.tuned_law(self.index, &state.tuned) {
            self.after = After::of(&law);
            self.law = law;
        }
    }

    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let list = &mut state.bonds[self.index];
        let particles = &mut state.particles;
        let slabs = list.slabs.len().saturating_sub(1);
        self.heat.begin(list);
        let mut columns = list.rows.iter_mut();
        let mut column = || columns.next().map_or(Shared::new(&mut []), |column| Shared::new(column));
        let work = Work {
            elasticity: &self.law.elasticity,
            after: &self.after,
            first: &list.first,
            second: &list.second,
            rows: [column(), column(), column()],
            damping: shared_damping(&mut list.damping),
            lost: Shared::new(&mut list.lost),
            position: &particles.position,
            velocity: &particles.velocity,
            angular_velocity: &particles.angular_velocity,
            orientation: &particles.orientation,
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
            step: context.step,
        };
        let ends = &list.slabs;
        let mut results = self.results.lock().unwrap_or_else(PoisonError::into_inner);
        results.clear();
        results.resize(slabs, Done::default());
        let places = Shared::new(&mut results);
        context.slabs(slabs, |slab| {
            let done = (self.slab)(&work, ends[slab] as usize, ends[slab + 1] as usize, context.width);
            // SAFETY: each slab is done once, and has a place of its own.
            unsafe { *places.at(slab) = done };
        });
        for done in &mut *results {
            done.release(context.step, |bond| self.carried(state, bond));
        }
        self.heat.end(&mut state.bonds[self.index], state.heat.as_mut(), results.iter());
        book(state, self.index, results.iter())
    }

    fn create(&self, state: &mut State, moment: &Moment, step: f64) -> bool {
        let wanted = self.wanted(state, moment);
        let law = self.law.elasticity.at_step::<f64>(step);
        let list = &mut state.bonds[self.index];
        list.rows.resize(self.one_bond.rows, Vec::new());
        for &[i, j] in &wanted {
            let pair = pair_of(&state.particles, i as usize, j as usize);
            let rows = (self.one_bond.create)(&law, &pair);
            list.first.push(i);
            list.second.push(j);
            begin_losses(list, &self.law, &law, &pair);
            for (column, row) in list.rows.iter_mut().zip(rows) {
                column.push(row);
            }
            let bodies = [i, j].map(|slot| state.particles.id[slot as usize]);
            state.particles.count_bond(bodies);
        }
        list.made += wanted.len() as u64;
        !wanted.is_empty()
    }

    fn check(&self, state: &State) -> Result<(), StateFault> {
        state.bonds[self.index].check_columns(self.one_bond.rows, self.law.dissipates(), false)?;
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
        let any = |bond: &usize| goes[list.first[*bond] as usize] || goes[list.second[*bond] as usize];
        let gone = (0..list.first.len()).filter(any).map(|bond| {
            let slots @ [i, j] = [list.first[bond], list.second[bond]];
            let pair = pair_of(&state.particles, i as usize, j as usize);
            let stays = slots.into_iter().find(|slot| !goes[*slot as usize]).unwrap_or(i);
            (stays, powers(list, bond, &pair, &self.carried(state, bond)))
        });
        let gone: Vec<_> = gone.collect();
        end_gone(state, (self.index, &self.heat), &gone, 0.5 * step)
    }
}

impl Stiffness for BondPass {
    fn stiffness(&self, state: &State, ahead: &SearchLimits, _context: &Context, tell: &mut dyn FnMut(Link)) {
        let (list, particles) = (&state.bonds[self.index], &state.particles);
        for (bond, (&i, &j)) in list.first.iter().zip(&list.second).enumerate() {
            let pair = pair_of(particles, i as usize, j as usize);
            let bodies = (i, Some(j), None);
            tell(link_of(&self.law, &pair, bodies, Kind::Bond));
            stretched(&pair, bodies, self.carried(state, bond).normal, tell);
        }
        for [i, j] in self.coming(state, ahead) {
            let pair = pair_of(particles, i as usize, j as usize);
            tell(link_of(&self.law, &pair, (i, Some(j), None), Kind::ComingBond));
        }
    }
}

impl Telling for BondPass {
    fn elastic_energy(&self, state: &State) -> f64 {
        (0..state.bonds[self.index].first.len()).map(|bond| self.carried(state, bond).energy).sum()
    }

    fn bonds(&self, state: &State, tell: &mut dyn FnMut(BondRecord)) {
        let (list, particles) = (&state.bonds[self.index], &state.particles);
        for (bond, (&i, &j)) in list.first.iter().zip(&list.second).enumerate() {
            let carried = self.carried(state, bond);
            let [first, second] = [i, j].map(|slot| particles.id[slot as usize]);
            let [position, other] = [i, j].map(|slot| Vector::from(particles.position[slot as usize]).to_array());
            let dissipated = list.lost.get(bond).copied().unwrap_or(0.0);
            let force = whole_force(list, bond, &carried);
            let (law, second) = (self.index as u32, Some(second));
            tell(BondRecord { law, first, second, position, other, force, carried, dissipated });
        }
    }
}

/// Whether both are images: their particles, or one of them and an image of the other, are the same pair.
fn are_images(particles: &Particles, a: u32, b: u32) -> bool {
    [a, b].iter().all(|&slot| particles.owner[slot as usize] == IMAGE)
}

/// The slots of two particles (indices into the scene's), or of one and an image of the other, that are nearest to each other.
fn nearest(particles: &Particles, cell: &CellState, pair: [u32; 2]) -> [u32; 2] {
    let [i, j] = pair.map(|index| particles.slot[index as usize]);
    let of = |original: u32| {
        let images = cell.images.iter().zip(&cell.originals);
        images.filter(move |(_, of)| **of == original).map(|(&image, _)| image)
    };
    let square = |[a, b]: &[u32; 2]| {
        let apart = Vector::from(particles.position[*a as usize]) - particles.position[*b as usize].into();
        apart.dot(apart)
    };
    let with_images = of(j).map(|image| [i, image]).chain(of(i).map(|image| [image, j]));
    with_images.fold([i, j], |least, next| if square(&next) < square(&least) { next } else { least })
}

/// The columns of what damping leaves.
pub(crate) fn shared_damping(columns: &mut [Vec<Row>]) -> [Shared<Row>; LastDamping::MOST_ROWS] {
    let mut columns = columns.iter_mut();
    [(); LastDamping::MOST_ROWS].map(|()| columns.next().map_or(Shared::new(&mut []), |column| Shared::new(column)))
}

/// Force on body i of a bond that carries this, with that of damping in the last evaluation \[N\].
pub(crate) fn whole_force(list: &BondList, bond: usize, carried: &BondLoads) -> [f64; 3] {
    let damping = list.damping.first().map_or([0.0; 4], |rows| rows[bond]);
    (Vector::from(carried.force) + Vector::from(damping)).to_array()
}

/// Rates at which a bond gives elastic energy to its bodies, and at which its damping takes energy from them, by its loads in the last
/// evaluation \[W\].
pub(crate) fn powers(list: &BondList, bond: usize, pair: &Pair, carried: &BondLoads) -> [f64; 2] {
    let moving = [pair.velocity, pair.spin_i, pair.spin_j];
    let taken = list.damping.iter().zip(moving).map(|(rows, moving)| -Vector::from(rows[bond]).dot(moving));
    [carried.power, taken.sum()]
}

/// Books the time \[s\] in which bonds of a law act whose bodies go: what remains of each (slot) and its [`powers`]. Returns the elastic energy
/// that they give \[J\].
fn end_gone(state: &mut State, (law, heat): (usize, &BondHeat), gone: &[(u32, [f64; 2])], time: f64) -> f64 {
    let [given, damped] = [0, 1].map(|part: usize| time * gone.iter().map(|(_, powers)| powers[part]).sum::<f64>());
    state.bonds[law].damped += damped;
    heat.let_go(state, gone, time);
    given
}

/// Adds to a list what is kept of a new bond where its law loses energy.
pub(crate) fn begin_losses(list: &mut BondList, law: &Law, coefficients: &Coefficients, pair: &Pair) {
    if law.dissipates() {
        list.lost.push(0.0);
    }
    list.damping.resize(law.damping_rows(), Vec::new());
    for (column, row) in list.damping.iter_mut().zip(law.first_damping(coefficients, pair).to_rows()) {
        column.push(row);
    }
}

/// A bond of these bodies (two slots, or a slot and a boundary) as springs and dashpots.
pub(crate) fn link_of(
    law: &Law,
    pair: &Pair,
    (first, second, boundary): (u32, Option<u32>, Option<u32>),
    kind: Kind,
) -> Link {
    let distance = pair.connection.length();
    let [stiffness, damping] = law.linear(pair);
    let normal = pair.connection * (1.0 / distance);
    let arms = [pair.share_i * distance, pair.share_j * distance];
    Link { kind, first, second, boundary, normal, arms, stiffness, damping }
}

/// Tells the stiffness across its axis that a bond has by its tension alone, as a string has: force over length, at the
/// centres.
pub(crate) fn stretched(
    pair: &Pair,
    (first, second, boundary): (u32, Option<u32>, Option<u32>),
    normal_force: f64,
    tell: &mut dyn FnMut(Link),
) {
    if normal_force >= 0.0 {
        return;
    }
    let per_distance = 1.0 / pair.connection.length();
    let (normal, stiffness) = (pair.connection * per_distance, [0.0, -normal_force * per_distance, 0.0, 0.0]);
    let (kind, arms, damping) = (Kind::Bond, [0.0; 2], [0.0; 4]);
    tell(Link { kind, first, second, boundary, normal, arms, stiffness, damping });
}

/// Two particles as bodies of a bond.
pub(crate) fn pair_of(particles: &Particles, i: usize, j: usize) -> Pair {
    Pair::of_spheres(&body_of(particles, i), &body_of(particles, j))
}

/// A particle as a body of a bond.
pub(crate) fn body_of(particles: &Particles, slot: usize) -> Body {
    let orientation = particles.orientation.get(slot).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
    let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
    Body {
        position: particles.position[slot].into(),
        velocity: velocity.into(),
        spin: spin.into(),
        orientation: Quaternion::from_row(orientation),
        radius: particles.position[slot][3],
        mass: velocity[3],
        inertia: spin[3],
    }
}
