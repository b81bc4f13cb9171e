//! Whether a state can be one of its scene.
//!
//! The passes trust the lists of a state: slots below the number of particles, columns of one length, pairs in order and
//! inside their slabs. What comes from outside (a saved state, a checkpoint) is therefore looked through once before
//! anything is done with it. Each part looks through itself; the passes add what their laws demand of their lists
//! ([`Pass::check`](crate::engine::contacts::Pass::check)).

use super::boundaries::Pressed;
use super::particles::{Entry, each_column};
use super::{BondList, BoundaryState, Clock, Columns, ContactList, Foresight, Ledger, Losses, Neighbours, Particles};
use super::{
    CellState, Clumps, Exchange, GONE, History, IMAGE, NearParts, Nodes, Pace, Row, State, Underway, WallContacts,
};

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
const FINITE: &str = "finite numbers";

/// How long a column has to be.
const LENGTH: &str = "as many entries as the list has, or none where the law keeps none";

/// Whether a column has an entry for each of a list's, or none at all.
fn column<T>(column: &[T], length: usize, kept: bool, part: &'static str) -> Result<(), StateFault> {
    demand(column.len() == if kept { length } else { 0 }, part, column.len(), LENGTH)
}

/// Whether rows are finite.
fn finite(rows: &[Row], part: &'static str) -> Result<(), StateFault> {
    demand_all(rows.iter().map(|row| row.iter().all(|number| number.is_finite())), part, FINITE)
}

/// Whether numbers are finite.
pub(super) fn all_finite(numbers: &[f64], part: &'static str) -> Result<(), StateFault> {
    demand_all(numbers.iter().map(|number| number.is_finite()), part, FINITE)
}

/// Whether ends go from 0 to the number of things without going back.
fn ends(ends: &[u32], count: usize, part: &'static str) -> Result<(), StateFault> {
    let expected = "ascending from 0 to the number of entries";
    demand(ends.first() == Some(&0) && ends.last().is_some_and(|&end| end as usize == count), part, 0, expected)?;
    demand_all(ends.windows(2).map(|pair| pair[0] <= pair[1]), part, expected)
}

/// Whether pairs of slots stand in order, the first of each in its slab and the second no further than the next.
fn in_slabs(
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
        self.ledger.iter().try_for_each(|ledger| ledger.check(self.boundaries.len(), self.clumps.len()))?;
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

impl Clock {
    /// Whether this can be one.
    fn check(&self) -> Result<(), StateFault> {
        let numbers = [self.time, self.lost, self.step, self.last_step, self.speed];
        all_finite(&numbers, "clock")?;
        let lengths = self.step > 0.0 && self.last_step >= 0.0 && self.stable > 0.0 && self.speed >= 0.0;
        demand(lengths, "clock", 0, "a step above 0 and a speed of 0 or above")?;
        demand(
            [self.steps, self.rebuilds, self.divided].iter().all(|count| *count < MOST),
            "clock",
            1,
            "a count that can be reached",
        )
    }
}

impl Underway {
    /// Whether this can be one.
    fn check(&self) -> Result<(), StateFault> {
        let Self { begun, done, count, step, passed, length, boundary_speed } = *self;
        all_finite(&[step, passed, length, boundary_speed], "underway")?;
        let lengths = step > 0.0 && length > 0.0 && (0.0..1.0).contains(&passed) && boundary_speed >= 0.0;
        demand(lengths, "underway", 0, "steps above 0 and a share from 0 to 1")?;
        demand(begun < MOST, "underway", 2, "a count that can be reached")?;
        demand(done < count, "underway", 1, "time steps that are left")
    }
}

impl Foresight {
    /// Whether this can be one. What is not foreseen may be infinite.
    fn check(&self) -> Result<(), StateFault> {
        let Self { root, counter, looks, travel, reach, strained, strain_reach, speed, fastest, bonds, until: _, to } =
            *self;
        let numbers =
            [root, travel, reach, strained, strain_reach, speed, fastest, to].iter().all(|number| !number.is_nan());
        demand(numbers, "foresight", 0, "numbers")?;
        let counts = [counter, looks, bonds[0], bonds[1]].iter().all(|&count| count < MOST);
        demand(counts, "foresight", 1, "a count that can be reached")
    }
}

impl Pace {
    /// Whether this can be one.
    fn check(&self) -> Result<(), StateFault> {
        let Self { share, packed, whole_at, until, rebuilds, speed, vibration } = *self;
        demand((0.0..=1.0).contains(&share), "pace", 0, "a share from 0 to 1")?;
        demand([packed, speed, until, vibration].iter().all(|it| *it >= 0.0), "pace", 1, "numbers of 0 or above")?;
        demand(whole_at < MOST && rebuilds < MOST, "pace", 2, "a count that can be reached")
    }
}

impl Particles {
    /// Whether these can be particles, each in one slot.
    fn check(&self) -> Result<(), StateFault> {
        let count = self.len();
        let expected = "one for each particle";
        let may_be_absent = self.orientation.is_empty();
        each_column!(self, |name, _images, column| {
            let is_absent = may_be_absent && name == "orientation";
            demand(column.len() == count || is_absent, name, column.len(), expected)?;
            demand_all(column.iter().map(Entry::is_finite), name, FINITE)?;
        });
        demand(self.bonds.is_empty() || self.bonds.len() == self.slot.len(), "bonds", self.bonds.len(), expected)?;
        self.check_places()?;
        let numbers = self.id.iter().enumerate().map(|(slot, &id)| match self.owner[slot] {
            IMAGE => self
                .slot
                .get(id as usize)
                .is_some_and(|&slot| self.owner.get(slot as usize).is_some_and(|&it| it != IMAGE)),
            _ => self.slot.get(id as usize) == Some(&(slot as u32)),
        });
        demand_all(numbers, "id", "each particle in one slot")?;
        self.check_energy()
    }

    /// Whether the kinetic energy of all is a number: a spin of 1e300 rad/s is one, its energy is none.
    fn check_energy(&self) -> Result<(), StateFault> {
        let energy = |row: &Row| row[3] * (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        let mut sum = 0.0;
        for (rows, part) in [(&self.velocity, "velocity"), (&self.angular_velocity, "angular_velocity")] {
            demand_all(
                rows.iter().map(|row| {
                    sum += energy(row);
                    sum.is_finite()
                }),
                part,
                "a kinetic energy that is a number",
            )?;
        }
        Ok(())
    }

    /// Whether places that no particle has are marked as such, and those of the later ones can be taken again.
    fn check_places(&self) -> Result<(), StateFault> {
        let there = self.slot.iter().filter(|slot| **slot != GONE).count();
        demand(there + self.images() == self.len(), "slot", there, "a slot of each particle, and of no other")?;
        demand(
            self.numbers.len() <= self.slot.len(),
            "numbers",
            self.numbers.len(),
            "one for each particle that came",
        )?;
        let own = self.slot.len() - self.numbers.len();
        let mut free = self.free.clone();
        free.sort_unstable();
        let empty = (own..self.slot.len()).filter(|&index| self.slot[index] == GONE).map(|index| index as u32);
        demand(free.into_iter().eq(empty), "free", 0, "the places that are free, each once")
    }

    /// Whether they are these particles somewhere else. Both have been checked.
    fn check_same(&self, other: &Self) -> Result<(), StateFault> {
        let expected = "one for each of the scene's particles";
        let own = |of: &Self| of.len() - of.images();
        demand(own(self) == own(other), "particles", own(self), expected)?;
        demand(self.bonds.len() == other.bonds.len(), "bonds", self.bonds.len(), expected)?;
        let same = |slot: usize| {
            let there = other.slot[self.id[slot] as usize] as usize;
            let constants = |of: &Self, at: usize| {
                [of.position[at][3], of.velocity[at][3], of.angular_velocity[at][3]].map(f64::to_bits)
            };
            constants(self, slot) == constants(other, there)
                && self.material[slot] == other.material[there]
                && [other.owner[there], IMAGE].contains(&self.owner[slot])
        };
        demand_all((0..self.len()).map(same), "particles", "the scene's radius, mass, inertia, material and group")
    }
}

impl Clumps {
    /// Whether these can be clumps of these particles, which have been checked, behind so many boundaries.
    fn check(&self, particles: &Particles, boundaries: usize) -> Result<(), StateFault> {
        self.check_rows()?;
        let mut start = 0;
        for (clump, &end) in self.ends.iter().enumerate() {
            let spheres = self.spheres.get(start..end as usize).unwrap_or_default();
            let is_member = |&sphere: &u32| {
                let slot = particles.slot_of(sphere);
                slot.is_some_and(|slot| particles.owner[slot] as usize == boundaries + 1 + clump)
            };
            demand(!spheres.is_empty() && spheres.iter().all(is_member), "clumps", clump, "spheres of its own")?;
            start = end as usize;
        }
        let owned = |owner: &&u32| **owner as usize > boundaries && **owner != IMAGE;
        let whole = start == self.spheres.len() && particles.owner.iter().filter(owned).count() == start;
        demand(whole, "clumps", 0, "each sphere once")?;
        demand(self.number.windows(2).all(|two| two[0] < two[1]), "clumps", 0, "ascending numbers")
    }

    /// Whether the rows are of one length, and of finite numbers.
    fn check_rows(&self) -> Result<(), StateFault> {
        let Self { position, moments, velocity, orientation, .. } = self;
        let Self { angular_momentum, angular_velocity, force, moment, braking, .. } = self;
        let rows = [position, moments, velocity, orientation, angular_momentum, angular_velocity, force, moment];
        let lengths = rows.iter().map(|rows| rows.len() == self.len());
        demand_all(lengths, "clumps", "columns of one length")?;
        let more = [self.scale.len(), self.shape.len(), self.number.len(), self.ends.len()];
        demand_all(more.iter().map(|length| *length == self.len()), "clumps", "columns of one length")?;
        all_finite(&self.scale, "clumps")?;
        rows.into_iter().try_for_each(|rows| finite(rows, "clumps"))?;
        let braked = braking.is_empty() || braking.len() == self.len();
        demand(
            braked && braking.as_flattened().as_flattened().iter().all(|part| part.is_finite()),
            "clumps",
            0,
            FINITE,
        )?;
        let length = |row: &Row| row.iter().map(|part| part * part).sum::<f64>();
        demand_all(orientation.iter().map(|row| (length(row) - 1.0).abs() < 1e-6), "clumps", "unit quaternions")?;
        let energies = velocity.iter().zip(angular_momentum.iter().zip(angular_velocity));
        let energies =
            energies.map(|(v, (l, w))| v[3] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + length(l) + length(w));
        demand_all(energies.map(f64::is_finite), "clumps", "a kinetic energy that is a number")
    }
}

impl CellState {
    /// Whether it can be one of these particles, which have been checked.
    fn check(&self, particles: &Particles) -> Result<(), StateFault> {
        let edges = [self.reference, self.edges];
        let triangular = edges.iter().all(|[a, b, c]| {
            a[0] > 0.0 && b[1] > 0.0 && c[2] > 0.0 && [a[1], a[2], b[2]].iter().all(|part| *part == 0.0)
        });
        demand(triangular, "cell", 0, "edges [ax, 0, 0], [bx, by, 0], [cx, cy, cz] with ax, by, cz above 0")?;
        let squares = [self.reference, self.edges, self.gradient, self.virial, self.kinetic];
        all_finite(squares.as_flattened().as_flattened(), "cell")?;
        let sixes = [self.strain, self.rate, self.start, self.end, self.target, self.target_rate];
        all_finite(sixes.as_flattened(), "cell")?;
        let means = [self.stress_sum, self.mean_stress, self.conjugate_stress];
        all_finite(means.as_flattened(), "cell")?;
        all_finite([self.stiffness, self.held_rate, self.action].as_flattened(), "cell")?;
        all_finite(&self.impulse, "cell")?;
        all_finite(&[self.inertia, self.volume_before, self.work], "cell")?;
        let count = self.images.len();
        let columns = self.originals.len() == count && self.displaced.len() == count;
        demand(columns && count == particles.images(), "images", count, "an entry for each image")?;
        let away = self.edges_away.len();
        demand(away == particles.slot.len(), "edges_away", away, "one for each particle")?;
        let counts = self.edges_away.iter().chain(&self.displaced).flatten();
        demand_all(counts.map(|edges| edges.unsigned_abs() < MOST), "edges_away", "counts that can be reached")?;
        let mut seen = vec![false; particles.len()];
        let sound = self.images.iter().zip(&self.originals).map(|(&image, &original)| {
            let (image, original) = (image as usize, original as usize);
            let is_image = particles.owner.get(image) == Some(&IMAGE) && !std::mem::replace(&mut seen[image], true);
            is_image
                && particles.owner.get(original).is_some_and(|&it| it != IMAGE)
                && particles.id[image] == particles.id[original]
        });
        demand_all(sound, "images", "an image of the particle of its number, each once")
    }
}

impl Exchange {
    /// Whether it has as many insertions, outlets, boundaries and flow meters as another.
    fn check_same(&self, other: &Self) -> Result<(), StateFault> {
        let expected = "as many as the scene has";
        demand(self.feeds.len() == other.feeds.len(), "feeds", self.feeds.len(), expected)?;
        demand(self.outlets.len() == other.outlets.len(), "outlets", self.outlets.len(), expected)?;
        demand(self.passed.len() == other.passed.len(), "passed", self.passed.len(), expected)?;
        demand(self.meters.len() == other.meters.len(), "meters", self.meters.len(), expected)
    }
}

impl Neighbours {
    /// Whether the lists can have been made for so many particles and boundaries.
    fn check(&self, particles: usize, boundaries: usize, clock: &Clock) -> Result<(), StateFault> {
        all_finite(&[self.skin, self.travel], "neighbours")?;
        demand(self.skin >= 0.0 && self.travel >= 0.0, "neighbours", 0, "a skin and a way of 0 or above")?;
        demand(self.made_at <= clock.steps, "neighbours", 1, "a step in which the lists were made that is past")?;
        let Columns { x, y, z, radius } = &self.reference;
        let same = [y, z, radius].into_iter().all(|column| column.len() == x.len());
        let fits = x.is_empty() || x.len() >= particles;
        demand(same && fits, "reference", x.len(), "a place for each particle")?;
        for column in [x, y, z, radius] {
            all_finite(column, "reference")?;
        }
        let there = self.boundary_reference.len();
        demand(there == 0 || there == boundaries, "boundary_reference", there, "one for each boundary")?;
        let others = [self.boundary_orientation.len(), self.boundary_extent.len()];
        demand_all(others.iter().map(|other| *other == there), "boundary_reference", "one for each boundary")?;
        finite(&self.boundary_orientation, "boundary_orientation")?;
        let extents = self.boundary_extent.iter().map(|extent| *extent >= 0.0);
        demand_all(extents, "boundary_extent", "0 or above")?;
        demand_all(self.boundary_reference.iter().flatten().map(|it| it.is_finite()), "boundary_reference", FINITE)?;
        if self.slabs.is_empty() { Ok(()) } else { ends(&self.slabs, particles, "slabs") }
    }
}

impl ContactList {
    /// Whether the list can stand in these slabs of particles.
    fn check(&self, particles: &[u32]) -> Result<(), StateFault> {
        let count = self.first.len();
        let equal = self.second.len() == count && self.flags.len() == count;
        demand(equal, "contacts", count, "columns of one length")?;
        if self.slabs.is_empty() {
            return demand(count == 0, "contacts", count, "no pair where there is no slab");
        }
        ends(&self.slabs, count, "contacts")?;
        in_slabs(|pair| (self.first[pair], self.second[pair]), &self.slabs, particles, "contacts")?;
        finite(self.history.all(), "history")?;
        all_finite(&self.pair_constant, "pair_constant")
    }

    /// Whether it has the columns of a law that remembers so many rows of each contact.
    pub(crate) fn check_columns(&self, history: usize, pair_constant: bool) -> Result<(), StateFault> {
        let columns = (&self.history, history, &self.pair_constant[..], pair_constant);
        remembered(columns, self.first.len())
    }
}

impl WallContacts {
    /// Whether the list can be one of so many particles.
    fn check(&self, particles: usize) -> Result<(), StateFault> {
        demand(self.flags.len() == self.particle.len(), "walls", self.flags.len(), "columns of one length")?;
        let order = self.particle.windows(2).map(|pair| pair[0] <= pair[1]);
        demand_all(order, "walls", "ascending order")?;
        let last = self.particle.last().is_none_or(|&last| (last as usize) < particles);
        demand(last, "walls", self.particle.len(), "slots of particles")?;
        self.near.check(particles)?;
        finite(self.history.all(), "history")?;
        all_finite(&self.pair_constant, "pair_constant")
    }

    /// Whether it has the columns of a law that remembers so many rows of each contact.
    pub(crate) fn check_columns(&self, history: usize, pair_constant: bool) -> Result<(), StateFault> {
        let columns = (&self.history, history, &self.pair_constant[..], pair_constant);
        remembered(columns, self.particle.len())?;
        let once = self.particle.windows(2).map(|pair| pair[0] < pair[1]);
        demand_all(once, "walls", "each particle once")?;
        demand(self.feature.is_empty() && self.near.particle.is_empty(), "feature", 0, "no feature at a plane")
    }

    /// The same of a list at a surface of so many parts and features. Pair constants are kept of the near particles.
    pub(crate) fn check_features(
        &self,
        history: usize,
        pair_constant: bool,
        [parts, features]: [usize; 2],
    ) -> Result<(), StateFault> {
        remembered((&self.history, history, &[], false), self.particle.len())?;
        column(&self.pair_constant, self.near.particle.len(), pair_constant, "pair_constant")?;
        column(&self.feature, self.particle.len(), true, "feature")?;
        let there = self.feature.iter().map(|&feature| (feature as usize) < features);
        demand_all(there, "feature", "features of the surface")?;
        let there = self.near.parts.iter().map(|&part| (part as usize) < parts);
        demand_all(there, "near", "parts of the surface")
    }
}

impl ContactList {
    /// Whether it has as many rows as its law remembers, if there is one.
    pub(crate) fn check_history(&self, rows: Option<usize>) -> Result<(), StateFault> {
        has_rows((&self.history, rows), self.first.len())
    }
}

impl WallContacts {
    /// The same.
    pub(crate) fn check_history(&self, rows: Option<usize>) -> Result<(), StateFault> {
        let feature = self.feature.is_empty() || self.feature.len() == self.particle.len();
        demand(feature, "feature", self.feature.len(), "one for each contact, or none")?;
        has_rows((&self.history, rows), self.particle.len())
    }
}

impl BondList {
    /// Whether it has as many rows as its formulation, if there is one, and a foot or a second body of each bond.
    pub(crate) fn check_rows(&self, rows: Option<usize>, at_plane: bool) -> Result<(), StateFault> {
        let count = self.first.len();
        column(&self.foot, count, at_plane, "foot")?;
        column(&self.second, count, !at_plane, "second")?;
        demand([0, count].contains(&self.lost.len()), "lost", self.lost.len(), "one for each bond, or none")?;
        described((&self.rows, rows), count)
    }
}

/// Whether a list of so many entries has as many rows as a description of its law says.
fn described((found, rows): (&[Vec<Row>], Option<usize>), count: usize) -> Result<(), StateFault> {
    let fits = Some(found.len()) == rows || count == 0;
    demand(fits, "history", found.len(), "the rows of a law that is described")?;
    found.iter().try_for_each(|row| column(row, count, true, "history"))
}

/// Whether so many contacts have as many rows as a law remembers, if there is one.
fn has_rows((history, rows): (&History, Option<usize>), count: usize) -> Result<(), StateFault> {
    let fits = Some(history.rows()) == rows || (count == 0 && history.rows() == 0);
    demand(fits, "history", history.rows(), "the rows of the law")?;
    column(history.all(), count * history.rows(), true, "history")
}

/// Whether a list of so many contacts has the rows that its law remembers, and the pair constants that it keeps or not.
fn remembered(
    (history, rows, pair_constant, kept): (&History, usize, &[f64], bool),
    count: usize,
) -> Result<(), StateFault> {
    has_rows((history, Some(rows)), count)?;
    column(pair_constant, count, kept, "pair_constant")
}

impl NearParts {
    /// Whether the lists can be of so many particles.
    fn check(&self, particles: usize) -> Result<(), StateFault> {
        ascending(&self.particle, particles, "near")?;
        demand(self.plane.len() == self.particle.len(), "near", self.plane.len(), "a plane or none for each particle")?;
        if self.starts.is_empty() {
            return demand(self.particle.is_empty() && self.parts.is_empty(), "near", 0, "no part without a start");
        }
        demand(self.starts.len() == self.particle.len() + 1, "near", self.starts.len(), "a start for each particle")?;
        ends(&self.starts, self.parts.len(), "near")
    }
}

/// Whether slots ascend below a number, none twice.
fn ascending(slots: &[u32], count: usize, part: &'static str) -> Result<(), StateFault> {
    demand_all(slots.windows(2).map(|pair| pair[0] < pair[1]), part, "ascending order")?;
    demand(slots.last().is_none_or(|&last| (last as usize) < count), part, slots.len(), "slots of particles")
}

impl BondList {
    /// Whether the list can be one of so many particles in these slabs.
    fn check(&self, count: usize, particles: &[u32]) -> Result<(), StateFault> {
        let numbers = [self.relaxed, self.damped, self.released];
        all_finite(&numbers, "bonds")?;
        all_finite(&self.lost, "lost")?;
        demand(
            [self.made, self.broken, self.removed].iter().all(|count| *count < MOST),
            "bonds",
            0,
            "a count that can be reached",
        )?;
        for column in self.rows.iter().chain(&self.damping).chain([&self.foot]) {
            finite(column, "bonds")?;
        }
        let bonds = self.first.len();
        if !self.slabs.is_empty() {
            ends(&self.slabs, bonds, "bonds")?;
        }
        if self.second.is_empty() {
            return ascending(&self.first, count, "bonds");
        }
        demand(self.second.len() == bonds, "bonds", self.second.len(), "columns of one length")?;
        demand(!self.slabs.is_empty(), "bonds", 1, "slabs")?;
        let pair = |bond: usize| {
            let (i, j) = (self.first[bond], self.second[bond]);
            (i.min(j), i.max(j))
        };
        in_slabs(pair, &self.slabs, particles, "bonds")
    }

    /// Whether it has the columns of a law: rows of state, what each lost, and a foot or a second body.
    pub(crate) fn check_columns(&self, rows: usize, lost: bool, at_plane: bool) -> Result<(), StateFault> {
        let count = self.first.len();
        column(&self.foot, count, at_plane, "foot")?;
        column(&self.second, count, !at_plane, "second")?;
        column(&self.lost, count, lost, "lost")?;
        if count > 0 {
            demand(self.rows.len() == rows, "rows", self.rows.len(), "the rows of the law")?;
        }
        self.rows.iter().try_for_each(|row| column(row, count, true, "rows"))
    }

    /// Whether it has as many columns of what damping leaves as its law has rows.
    pub(crate) fn check_damping(&self, rows: usize) -> Result<(), StateFault> {
        let fits = self.damping.len() == rows || self.damping.is_empty() && self.first.is_empty();
        demand(fits, "damping", self.damping.len(), "a column for each row of the law's damping")?;
        self.damping.iter().try_for_each(|row| column(row, self.first.len(), true, "damping"))
    }
}

impl BoundaryState {
    /// Whether every number is finite.
    fn is_finite(&self) -> bool {
        let Self {
            displacement, velocity, rotation, angular_velocity, orientation, pivot, start, target, fastest, ..
        } = self;
        let Self { target_rate, start_orientation, turn, inertial, force, moment, impulse, .. } = self;
        let Self { angular_impulse, mean_force, mean_moment, total_impulse, work, .. } = self;
        let Self { target_acceleration, acceleration, first_moment, force_slope, .. } = self;
        let Self { force_before, moment_before, before, brought_back, .. } = self;
        let triples = [
            displacement,
            velocity,
            rotation,
            angular_velocity,
            pivot,
            turn,
            force,
            moment,
            impulse,
            angular_impulse,
            mean_force,
            mean_moment,
            total_impulse,
            target_acceleration,
            acceleration,
            first_moment,
            force_slope,
            force_before,
            moment_before,
            &before.displacement,
            brought_back,
            &inertial.angular_momentum,
            &inertial.load,
            &inertial.couple,
            &inertial.braking_force,
            &inertial.braking_moment,
            &inertial.kick,
            &inertial.spin_kick,
        ];
        let sixes = [
            start,
            &self.end,
            target,
            target_rate,
            fastest,
            &inertial.applied,
            &inertial.support,
            &inertial.applied_impulse,
            &inertial.support_impulse,
        ];
        let rows = [orientation.0, start_orientation.0, before.orientation.0];
        triples.into_iter().flatten().chain(sixes.into_iter().flatten()).all(|number| number.is_finite())
            && rows.iter().flatten().all(|number| number.is_finite())
            && work.is_finite()
            && self.pressed.iter().all(Pressed::is_finite)
    }
}

impl Pressed {
    /// Whether all numbers are finite.
    fn is_finite(&self) -> bool {
        let Self { impedance, stiffness, force, way } = *self;
        [impedance, stiffness, force, way].iter().all(|number| number.is_finite())
    }
}

impl Nodes {
    /// Whether the columns have one length and finite numbers.
    fn check(&self) -> Result<(), StateFault> {
        let count = self.target.len();
        let lengths = self.columns().map(|column| column.len() == count);
        demand_all(lengths.into_iter(), "nodes", "columns of one length")?;
        self.columns().into_iter().try_for_each(|column| finite(column, "nodes"))?;
        demand(self.fastest.is_finite() && self.fastest >= 0.0, "nodes", 0, "a speed of 0 or above")
    }
}

impl Ledger {
    /// Whether the book can be one of a scene with so many boundaries and clumps.
    fn check(&self, boundaries: usize, clumps: usize) -> Result<(), StateFault> {
        let Self { initial_kinetic, initial_elastic, turnover, power_turned_over, .. } = *self;
        all_finite(&[initial_kinetic, initial_elastic, turnover, power_turned_over], "ledger")?;
        for powers in [&self.work, &self.power, &self.growth] {
            all_finite(powers, "ledger")?;
        }
        for loads in &self.on_bodies {
            let expected = "one for each boundary and clump, or none";
            demand(loads.is_empty() || loads.len() == boundaries + clumps, "loads", loads.len(), expected)?;
            loads.iter().try_for_each(|load| all_finite(load, "loads"))?;
        }
        Ok(())
    }
}

impl Losses {
    /// Whether all its numbers are finite.
    fn check(&self) -> Result<(), StateFault> {
        let Self { initial_kinetic, initial_elastic, initial_potential, given_to_bodies, .. } = self;
        all_finite(&[*initial_kinetic, *initial_elastic, *initial_potential, *given_to_bodies], "losses")?;
        all_finite(&self.initial_held, "losses")?;
        all_finite(&self.taken, "losses")?;
        all_finite(&self.braking, "losses")
    }
}
