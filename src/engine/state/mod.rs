//! The numbers that change, and nothing else: a run that continues from a restored state gives the same bits.
//!
//! No physics here. Particles stand in the order of the present neighbour list, which follows space;
//! [`Particles::id`] and [`Particles::slot`] translate between that order and the scene's.

pub mod bonds;
pub mod boundaries;
pub mod cell;
mod check;
pub mod clock;
pub mod clumps;
pub mod contacts;
pub mod deepest;
pub mod exchange;
pub mod fluid;
pub mod foresight;
pub mod heat;
mod history;
mod in_place;
pub mod ledger;
pub mod losses;
pub mod nodes;
mod number;
pub mod pace;
pub mod particles;
mod plain;
pub mod snapshot;
pub mod through;
pub mod traces;

pub use bonds::{BondList, Break};
pub use boundaries::{BoundaryState, Orientation, Stand};
pub use cell::CellState;
pub use check::StateFault;
pub(crate) use check::demand;
pub use clock::{Clock, Underway};
pub use clumps::{ClumpRows, Clumps};
pub use contacts::{Columns, ContactList, NearParts, Neighbours, WallContacts};
pub use deepest::{Deepest, Named};
pub use exchange::Exchange;
pub use fluid::FluidState;
pub use foresight::Foresight;
pub use heat::Heat;
pub use history::History;
pub use ledger::Ledger;
pub use losses::{Loss, Losses};
pub use nodes::Nodes;
pub use number::InsertedParticle;
pub use pace::Pace;
pub use particles::{GONE, IMAGE, Particles};
pub use through::{Separated, Through, TouchedThrough};
pub use traces::{FacetTraces, Impact, ImpactBin, ImpactRecord, Traces};

pub use crate::base::number::Row;

use in_place::clone_in_place;
use serde::{Deserialize, Serialize};

/// Everything that changes while a scene runs.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time and counters.
    pub clock: Clock,
    /// The communication step of which a part has been made; none at a communication point.
    pub underway: Option<Underway>,
    /// For which conditions the stable time step was computed.
    pub foresight: Foresight,
    /// What the automatic time step knows of the contacts.
    pub pace: Pace,
    /// Positions, velocities, forces.
    pub particles: Particles,
    /// Clumps, whose spheres are among them.
    pub clumps: Clumps,
    /// When and for where the lists below were made.
    pub neighbours: Neighbours,
    /// Coefficients of each contact law: a row for each two materials, row by row; zeros where it does not govern them.
    #[serde(with = "plain::lists")]
    pub coefficients: Vec<Vec<f64>>,
    /// Values of the tunable parameters, in the order of the scene's.
    #[serde(with = "plain")]
    pub tuned: Vec<f64>,
    /// Near pairs of particles and their springs, a list for each contact law.
    pub contacts: Vec<ContactList>,
    /// Near particles of each plane and their springs, a list for each plane and contact law that meet.
    pub walls: Vec<WallContacts>,
    /// The deepest contact since time 0.
    pub deepest: Deepest,
    /// Pairs of particles with a surface between them.
    pub through: Through,
    /// Living bonds, a list for each bond law.
    pub bonds: Vec<BondList>,
    /// Bonds that broke since the present communication step began.
    pub breaks: Vec<Break>,
    /// Motion and loads of the boundaries, in the scene's order.
    pub boundaries: Vec<BoundaryState>,
    /// Nodes of the meshes among them whose nodes the outside moves, in the scene's order.
    pub nodes: Vec<Nodes>,
    /// The algorithmic energy book, if the scene asks for it.
    pub ledger: Option<Ledger>,
    /// The physical energy book, if the scene asks for it.
    pub losses: Option<Losses>,
    /// Sum of the global damping forces at the present time \[N\].
    pub damping_force: [f64; 3],
    /// Impulse of global damping on the particles since time 0 \[N s\].
    pub damping_impulse: [f64; 3],
    /// Particles that come and go, where the scene has any.
    pub exchange: Option<Exchange>,
    /// The periodic cell, where the scene has one.
    pub cell: Option<CellState>,
    /// Temperatures, where heat flows.
    pub heat: Option<Heat>,
    /// The fluid around the particles, where the scene has one.
    pub fluid: Option<FluidState>,
    /// What contacts leave behind, where the scene asks for it.
    pub traces: Option<Traces>,
}

clone_in_place!(State {
    clock,
    underway,
    foresight,
    pace,
    particles,
    clumps,
    neighbours,
    coefficients,
    tuned,
    contacts,
    walls,
    deepest,
    through,
    bonds,
    breaks,
    boundaries,
    nodes,
    ledger,
    losses,
    damping_force,
    damping_impulse,
    exchange,
    cell,
    heat,
    fluid,
    traces
});

impl State {
    /// The nodes of a boundary, if the outside moves them.
    pub(crate) fn nodes_of(&self, boundary: usize) -> Option<&Nodes> {
        self.nodes.iter().find(|nodes| nodes.boundary as usize == boundary)
    }

    /// The same, to be changed.
    pub(crate) fn nodes_of_mut(&mut self, boundary: usize) -> Option<&mut Nodes> {
        self.nodes.iter_mut().find(|nodes| nodes.boundary as usize == boundary)
    }

    /// The clump to which the particle in a slot belongs.
    pub(crate) fn clump(&self, slot: usize) -> Option<usize> {
        if self.clumps.is_empty() { None } else { self.particles.group(slot)?.checked_sub(self.boundaries.len()) }
    }

    /// Whether anything is bonded.
    pub(crate) fn is_bonded(&self) -> bool {
        self.bonds.iter().any(|list| !list.first.is_empty())
    }

    /// Whether the particle in a slot moves by the forces on it, by itself or with a clump.
    pub(crate) fn is_loose(&self, slot: usize) -> bool {
        self.particles.owner[slot] == 0 || self.clump(slot).is_some()
    }

    /// How many bodies of several parts there may be: boundaries, and behind them clumps.
    pub(crate) fn owners(&self) -> usize {
        self.boundaries.len() + self.clumps.len()
    }

    /// Whether two particles (slots) are spheres of one body that needs no bond: of a clump.
    pub(crate) fn are_of_one_body(&self, a: u32, b: u32) -> bool {
        let of = |slot: u32| self.clump(slot as usize);
        of(a).is_some() && of(a) == of(b)
    }

    /// The point of what stands in a slot that a periodic cell carries along \[m\]: its centre or, of a sphere of a clump, the mass centre of
    /// the clump, as it is to an image of the sphere.
    #[inline(always)]
    pub(crate) fn carried_point(&self, slot: usize) -> Row {
        if self.clumps.is_empty() { self.particles.position[slot] } else { self.point_of_clump(slot) }
    }

    /// The same where there are clumps \[m\].
    fn point_of_clump(&self, slot: usize) -> Row {
        let place = self.particles.position[slot];
        let original = self.particles.original(slot as u32) as usize;
        let Some(clump) = self.clump(original) else { return place };
        let (sphere, centre) = (self.particles.position[original], self.clumps.position[clump]);
        [0, 1, 2, 3]
            .map(|axis| if original == slot { centre[axis] } else { place[axis] + (centre[axis] - sphere[axis]) })
    }

    /// Where the mass centre of a clump has come to without being brought back into a periodic cell; elsewhere where it is \[m\].
    pub(crate) fn unwrapped_clump(&self, clump: usize) -> [f64; 3] {
        let [x, y, z, _] = self.clumps.position[clump];
        let Some(cell) = &self.cell else { return [x, y, z] };
        let [u, v, w] = cell.displacement(self.clumps.spheres_of(clump)[0]);
        [x + u, y + v, z + w]
    }

    /// Where the particle in a slot has come to without being brought back into a periodic cell; elsewhere where it is \[m\].
    pub(crate) fn unwrapped(&self, slot: usize) -> [f64; 3] {
        let [x, y, z, _] = self.particles.position[slot];
        let Some(cell) = &self.cell else { return [x, y, z] };
        let [u, v, w] = cell.displacement(self.particles.id[slot]);
        [x + u, y + v, z + w]
    }

    /// Work of each boundary, and of the periodic cell, on the particles since time 0 \[J\].
    pub(crate) fn works(&self) -> impl Iterator<Item = f64> + '_ {
        self.boundaries.iter().map(|boundary| boundary.work).chain(self.cell.iter().map(|cell| cell.work))
    }

    /// Whether every sum of entries of the energy books is finite: that of all their magnitudes is.
    pub(crate) fn has_finite_books(&self) -> bool {
        let ledgers = self.ledger.iter().flat_map(|book| {
            let others = [book.turnover, book.initial_kinetic, book.initial_elastic];
            book.work.into_iter().chain(others)
        });
        let losses = self.losses.iter().flat_map(|book| {
            let others = [book.given_to_bodies, book.initial_kinetic, book.initial_elastic, book.initial_potential];
            book.taken.into_iter().chain(book.initial_held).chain(others)
        });
        let bonds = self.bonds.iter().flat_map(|list| [list.relaxed, list.damped, list.released]);
        let net = self.exchange.iter().map(|exchange| &exchange.net);
        let exchanged = net.flat_map(|net| [net.kinetic, net.elastic, net.potential, net.turnover]);
        let traces = self.traces.iter().flat_map(Traces::sums);
        let all = ledgers.chain(losses).chain(bonds).chain(exchanged).chain(traces).chain(self.works());
        let fluid = self.fluid.iter().map(|fluid| fluid.work);
        all.chain(fluid).map(f64::abs).sum::<f64>().is_finite()
    }

    /// Sets every count and sum that began at time 0 to zero: bonds made and broken, energy that left them, impulses, work.
    /// The caller sets the energies with which an energy book begins, and the mean loads.
    pub fn begin_counting(&mut self) {
        self.deepest = Deepest::default();
        self.through.first = None;
        self.breaks.clear();
        self.damping_impulse = [0.0; 3];
        self.boundaries.iter_mut().for_each(BoundaryState::begin_counting);
        if let Some(ledger) = &mut self.ledger {
            ledger.begin_counting();
        }
        if let Some(losses) = &mut self.losses {
            losses.begin_counting();
        }
        if let Some(exchange) = &mut self.exchange {
            exchange.begin_counting();
        }
        if let Some(cell) = &mut self.cell {
            cell.begin_counting();
        }
        if let Some(heat) = &mut self.heat {
            heat.begin_counting();
        }
        if let Some(fluid) = &mut self.fluid {
            fluid.begin_counting();
        }
        if let Some(traces) = &mut self.traces {
            traces.begin_counting();
        }
        self.particles.bonds.fill([0; 2]);
        for list in &mut self.bonds {
            list.begin_counting();
            for &slot in list.first.iter().chain(&list.second) {
                self.particles.count_bond([self.particles.id[slot as usize]]);
            }
        }
        // How many bonds there may be before the stable time step is found again was told in the old count.
        self.foresight.bonds = [self.bonds.iter().map(|list| list.made).sum(), 0];
    }
}
