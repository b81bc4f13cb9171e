//! Whether a state can be one of its scene.
//!
//! The passes trust the lists of a state: slots below the number of particles, columns of one length, pairs in order and
//! inside their slabs. What comes from outside (a saved state, a checkpoint) is therefore looked through once before
//! anything is done with it. Each part looks through itself; the passes add what their laws demand of their lists
//! ([`Pass::check`](crate::engine::contacts::Pass::check)).

use super::{BoundaryState, Exchange, History, Losses, Nodes, Row, State, Underway};

/// Steps, bonds and the like are counted up to here; more cannot be, and sums of them must not overflow.
pub(super) const MOST: u64 = 1 << 48;

/// Why a state cannot be one of its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("invalid state, {part}[{place}]: expected {expected}")]
pub struct StateFault {
    /// Which part of it.
    pub part: &'static str,
    /// Which entry of that part.
    pub place: usize,
    /// What was expected.
    pub expected: &'static str,
}

/// Whether something holds of an entry of a part.
pub(crate) fn demand(holds: bool, part: &'static str, place: usize, expected: &'static str) -> Result<(), StateFault> {
    if holds { Ok(()) } else { Err(StateFault { part, place, expected }) }
}

/// Whether something holds of every entry of a part.
pub(crate) fn demand_all(
    mut holds: impl Iterator<Item = bool>,
    part: &'static str,
    expected: &'static str,
) -> Result<(), StateFault> {
    match holds.position(|holds| !holds) {
        None => Ok(()),
        Some(place) => Err(StateFault { part, place, expected }),
    }
}

/// What a number has to be.
pub(super) const FINITE: &str = "finite numbers";

/// How long a column has to be.
const LENGTH: &str = "as many entries as the list has, or none where the law keeps none";

/// Whether a column has an entry for each of a list's, or none at all.
pub(super) fn column<T>(column: &[T], length: usize, kept: bool, part: &'static str) -> Result<(), StateFault> {
    demand(column.len() == if kept { length } else { 0 }, part, column.len(), LENGTH)
}

/// Whether rows are finite.
pub(super) fn finite(rows: &[Row], part: &'static str) -> Result<(), StateFault> {
    demand_all(rows.iter().map(|row| row.iter().all(|number| number.is_finite())), part, FINITE)
}

/// Whether numbers are finite.
pub(super) fn all_finite(numbers: &[f64], part: &'static str) -> Result<(), StateFault> {
    demand_all(numbers.iter().map(|number| number.is_finite()), part, FINITE)
}

/// Whether ends go from 0 to the number of things without going back.
pub(super) fn ends(ends: &[u32], count: usize, part: &'static str) -> Result<(), StateFault> {
    let expected = "ascending from 0 to the number of entries";
    demand(ends.first() == Some(&0) && ends.last().is_some_and(|&end| end as usize == count), part, 0, expected)?;
    demand_all(ends.windows(2).map(|pair| pair[0] <= pair[1]), part, expected)
}

/// Whether pairs of slots stand in order, the first of each in its slab and the second no further than the next.
pub(super) fn in_slabs(
    pair: impl Fn(usize) -> (u32, u32),
    slabs: &[u32],
    particles: &[u32],
    part: &'static str,
) -> Result<(), StateFault> {
    demand(slabs.len() == particles.len(), part, slabs.len(), "as many slabs as the particles have")?;
    let mut before = (0, 0);
    for slab in 1..slabs.len() {
        let (from, to) = (particles[slab - 1], particles[slab]);
        let beyond = particles[(slab + 1).min(particles.len() - 1)];
        for place in slabs[slab - 1] as usize..slabs[slab] as usize {
            let (first, second) = pair(place);
            demand((from..to).contains(&first), part, place, "a first particle of this slab")?;
            demand(
                first < second && second < beyond,
                part,
                place,
                "a second particle behind it, of this slab or the next",
            )?;
            demand(before <= (first, second), part, place, "ascending order")?;
            before = (first, second);
        }
    }
    Ok(())
}

impl State {
    /// Whether this can be a state of the simulation that `other` is one of, as far as it shows without the laws.
    pub(crate) fn check(&self, other: &Self) -> Result<(), StateFault> {
        self.check_lists()?;
        demand(
            self.exchange.is_some() == other.exchange.is_some(),
            "exchange",
            0,
            "particles that come and go where the scene has any",
        )?;
        if let (Some(exchange), Some(other)) = (&self.exchange, &other.exchange) {
            exchange.check_same(other)?;
        } else {
            self.particles.check_same(&other.particles)?;
        }
        demand(self.heat.is_some() == other.heat.is_some(), "heat", 0, "temperatures where heat flows")?;
        if let (Some(heat), Some(other)) = (&self.heat, &other.heat) {
            heat.check(other, self.particles.slot.len(), self.exchange.is_none())?;
        }
        demand(self.fluid.is_some() == other.fluid.is_some(), "fluid", 0, "a fluid where the scene has one")?;
        if let (Some(fluid), Some(other)) = (&self.fluid, &other.fluid) {
            fluid.check_same(other)?;
        }
        demand(self.traces.is_some() == other.traces.is_some(), "traces", 0, "traces where the scene asks for them")?;
        if let (Some(traces), Some(other)) = (&self.traces, &other.traces) {
            traces.check(other, self.particles.slot.len())?;
        }
        let same = "as many as the scene has";
        let declared = self.particles.declared.len();
        demand(declared == other.particles.declared.len(), "declared", declared, same)?;
        let stay = self.exchange.is_some() || self.clumps.len() == other.clumps.len();
        demand(stay, "clumps", self.clumps.len(), same)?;
        demand(self.contacts.len() == other.contacts.len(), "contacts", self.contacts.len(), same)?;
        demand(self.walls.len() == other.walls.len(), "walls", self.walls.len(), same)?;
        demand(self.bonds.len() == other.bonds.len(), "bonds", self.bonds.len(), same)?;
        demand(self.boundaries.len() == other.boundaries.len(), "boundaries", self.boundaries.len(), same)?;
        let nodes = |state: &Self| -> Vec<_> { state.nodes.iter().map(|it| (it.boundary, it.target.len())).collect() };
        demand(nodes(self) == nodes(other), "nodes", 0, "the nodes of the scene's meshes")?;
        demand(self.tuned.len() == other.tuned.len(), "tuned", self.tuned.len(), same)?;
        let lengths = self.coefficients.iter().map(Vec::len).eq(other.coefficients.iter().map(Vec::len));
        demand(lengths, "coefficients", 0, "a row for each two materials of each law")?;
        for (list, same) in self.walls.iter().zip(&other.walls) {
            let expected = "the plane and the law of the scene";
            demand((list.boundary, list.law) == (same.boundary, same.law), "walls", 0, expected)?;
        }
        let cell = |state: &Self| state.cell.as_ref().map(|cell| cell.origin);
        demand(cell(self) == cell(other), "cell", 0, "the cell of the scene, if it has one")?;
        let expected = "a book where the scene asks for it";
        demand(self.losses.is_some() == other.losses.is_some(), "losses", 0, expected)?;
        demand(self.ledger.is_some() == other.ledger.is_some(), "ledger", 0, expected)
    }

    /// Whether this can be a state of any scene: lengths and order of its lists, slots of particles, finite numbers.
    pub(crate) fn check_lists(&self) -> Result<(), StateFault> {
        self.clock.check()?;
        self.underway.iter().try_for_each(Underway::check)?;
        self.foresight.check()?;
        self.pace.check()?;
        self.particles.check()?;
        self.clumps.check(&self.particles, self.boundaries.len())?;
        let count = self.particles.len();
        self.neighbours.check(count, self.boundaries.len(), &self.clock)?;
        for rows in &self.coefficients {
            demand_all(rows.iter().map(|number| !number.is_nan()), "coefficients", "numbers")?;
        }
        all_finite(&self.tuned, "tuned")?;
        for list in &self.contacts {
            list.check(&self.neighbours.slabs)?;
        }
        for list in &self.walls {
            list.check(count)?;
        }
        for list in &self.bonds {
            list.check(count, &self.neighbours.slabs)?;
        }
        let broken = |it: &super::Break| {
            let bodies = [it.first].into_iter().chain(it.second);
            (it.law as usize) < self.bonds.len()
                && bodies.into_iter().all(|body| (body as usize) < self.particles.slot.len())
        };
        demand_all(self.breaks.iter().map(broken), "breaks", "a bond law and particles of the scene")?;
        demand_all(self.boundaries.iter().map(BoundaryState::is_finite), "boundaries", FINITE)?;
        let there = self.nodes.iter().map(|nodes| (nodes.boundary as usize) < self.boundaries.len());
        demand_all(there, "nodes", "a boundary of the scene")?;
        self.nodes.iter().try_for_each(Nodes::check)?;
        self.ledger.iter().try_for_each(|ledger| ledger.check(self.owners()))?;
        self.losses.iter().try_for_each(Losses::check)?;
        self.fluid.iter().try_for_each(super::FluidState::check)?;
        self.check_dashpots()?;
        all_finite(&[self.deepest.overlap, self.deepest.time], "deepest")?;
        let is_there = self.deepest.boundary.is_none_or(|boundary| (boundary as usize) < self.boundaries.len());
        demand(is_there, "deepest", 0, "a boundary of the scene")?;
        let sound = self.through.is_sound(&self.contacts, self.boundaries.len());
        demand(sound, "through", 0, "contacts of the lists and boundaries of the scene")?;
        all_finite(&self.damping_force, "damping_force")?;
        all_finite(&self.damping_impulse, "damping_impulse")?;
        let sound = self.exchange.as_ref().is_none_or(Exchange::is_sound);
        demand(sound, "exchange", 0, FINITE)?;
        let images = self.particles.images();
        match &self.cell {
            None => demand(images == 0, "owner", images, "no image without a periodic cell")?,
            Some(cell) => cell.check(&self.particles)?,
        }
        let stay = self.exchange.is_some() || self.particles.slot.len() + images == count;
        demand(stay, "slot", self.particles.slot.len(), "one for each particle")
    }
}

impl State {
    /// Whether loads have dashpots to the ground where there is a fluid alone, and none that drives.
    fn check_dashpots(&self) -> Result<(), StateFault> {
        let loads = [&self.particles.force, &self.particles.torque, &self.clumps.force, &self.clumps.moment];
        let flows = self.fluid.is_some();
        let sound = loads.into_iter().flatten().map(|row| row[3] == 0.0 || (flows && row[3] > 0.0));
        demand_all(sound, "force", "0 behind each load, or in a fluid a dashpot above 0")
    }
}

/// Whether a list of so many entries has as many rows as a description of its law says.
pub(super) fn described((found, rows): (&[Vec<Row>], Option<usize>), count: usize) -> Result<(), StateFault> {
    let fits = Some(found.len()) == rows || count == 0;
    demand(fits, "history", found.len(), "the rows of a law that is described")?;
    found.iter().try_for_each(|row| column(row, count, true, "history"))
}

/// Whether so many contacts have as many rows as a law remembers, if there is one.
pub(super) fn has_rows((history, rows): (&History, Option<usize>), count: usize) -> Result<(), StateFault> {
    let fits = Some(history.rows()) == rows || (count == 0 && history.rows() == 0);
    demand(fits, "history", history.rows(), "the rows of the law")?;
    column(history.all(), count * history.rows(), true, "history")
}

/// Whether a list of so many contacts has the rows that its law remembers, and the pair constants that it keeps or not.
pub(super) fn remembered(
    (history, rows, pair_constant, kept): (&History, usize, &[f64], bool),
    count: usize,
) -> Result<(), StateFault> {
    has_rows((history, Some(rows)), count)?;
    column(pair_constant, count, kept, "pair_constant")
}

/// Whether slots ascend below a number, none twice.
pub(super) fn ascending(slots: &[u32], count: usize, part: &'static str) -> Result<(), StateFault> {
    demand_all(slots.windows(2).map(|pair| pair[0] < pair[1]), part, "ascending order")?;
    demand(slots.last().is_none_or(|&last| (last as usize) < count), part, slots.len(), "slots of particles")
}
