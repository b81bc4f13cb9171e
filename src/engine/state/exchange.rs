//! The state of particles that come and go: counts, rates, random generators, and their part in the energy books.

use super::check::{StateFault, demand};
use super::in_place::clone_in_place;
use serde::{Deserialize, Serialize};

/// Everything of particles that come and go which changes. Scenes whose number of particles stays have none.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    /// A bound of how far anything has moved since outlets were looked at \[m\].
    pub travel: f64,
    /// The number of the next particle that comes.
    pub next: u32,
    /// That of the next clump.
    pub next_clump: u32,
    /// What comes, in the order of the scene's insertions.
    pub feeds: Vec<InsertionProgress>,
    /// What went, in the order of the scene's outlets.
    pub outlets: Vec<ParticleCount>,
    /// What left the domain.
    pub outside: ParticleCount,
    /// What came through each boundary and was taken away, in the scene's order.
    pub passed: Vec<ParticleCount>,
    /// What passed, in the order of the scene's flow meters.
    pub meters: Vec<MeterCount>,
    /// What came less what went.
    pub net: NetExchange,
}

clone_in_place!(Exchange { travel, next, next_clump, feeds, outlets, outside, passed, meters, net });

/// A number of particles and their mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParticleCount {
    /// How many, spheres of clumps among them.
    pub count: u64,
    /// How many clumps.
    pub clumps: u64,
    /// Their mass \[kg\].
    pub mass: f64,
}

impl ParticleCount {
    /// Counts a particle, or a clump of so many spheres, of this mass \[kg\].
    pub(crate) fn add(&mut self, spheres: Option<usize>, mass: f64) {
        self.count += spheres.unwrap_or(1) as u64;
        self.clumps += u64::from(spheres.is_some());
        self.mass += mass;
    }
}

/// What comes by one insertion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InsertionProgress {
    /// What came.
    pub came: ParticleCount,
    /// How much is to come in each second, as last given, in the unit of the scene's rate; 0 where a mass is to come.
    pub rate: f64,
    /// Its change in each second, in the next communication step.
    pub rate_of_rate: f64,
    /// How much comes in each second of the present communication step.
    pub present: f64,
    /// What is due and has not come: a number or a mass \[kg\].
    pub owed: f64,
    /// What found no room and is not made up for, in the same unit.
    pub dropped: f64,
    /// Numbers drawn from the generator so far.
    pub draws: u64,
    /// Radius of what comes next, of a clump that of its bounding sphere; 0 where it has not been drawn \[m\].
    pub radius: f64,
    /// Its kind among those of the insertion.
    pub kind: u32,
    /// How the own frame of a clump is turned, as a unit quaternion.
    pub orientation: [f64; 4],
    /// Time step in which it was tried last.
    pub tried: u64,
    /// Whether there was no room then.
    pub full: bool,
    /// A bound of how far anything has moved since then \[m\].
    pub travel: f64,
}

/// What passed a flow meter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeterCount {
    /// Particles that passed towards the front, and back, spheres of clumps among them.
    pub counts: [u64; 2],
    /// Clumps that did.
    pub clumps: [u64; 2],
    /// Mass that passed towards the front less what went back \[kg\].
    pub mass: f64,
    /// The same when the present communication step began \[kg\].
    pub mass_before: f64,
    /// Mean mass flow of the last communication step \[kg/s\].
    pub mass_flow: f64,
}

impl MeterCount {
    /// Counts a particle, or a clump of so many spheres, of this mass \[kg\] that passed towards the front or back.
    pub(crate) fn add(&mut self, forward: bool, spheres: Option<usize>, mass: f64) {
        let place = usize::from(!forward);
        self.counts[place] += spheres.unwrap_or(1) as u64;
        self.clumps[place] += u64::from(spheres.is_some());
        self.mass += if forward { mass } else { -mass };
    }

    /// How many particles passed towards the front, less those that went back.
    pub fn net_count(&self) -> i32 {
        net(self.counts)
    }

    /// How many clumps did.
    pub fn net_clumps(&self) -> i32 {
        net(self.clumps)
    }
}

/// The first count less the second.
fn net(counts: [u64; 2]) -> i32 {
    let [forth, back] = counts.map(|count| i64::try_from(count).unwrap_or(i64::MAX));
    i32::try_from(forth - back).unwrap_or(if forth > back { i32::MAX } else { i32::MIN })
}

/// What came less what went: what balances of mass, momentum and energy have to know.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NetExchange {
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass times the time from which on it is there \[kg s\].
    pub mass_time: f64,
    /// Momentum \[kg m/s\].
    pub momentum: [f64; 3],
    /// Constant forces on it \[N\].
    pub applied: [f64; 3],
    /// These times the time from which on they act \[N s\].
    pub applied_time: [f64; 3],
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// Elastic energy of its contacts \[J\].
    pub elastic: f64,
    /// Potential of gravity and constant forces \[J\].
    pub potential: f64,
    /// Sum of the magnitudes of kinetic energies that came and went \[J\].
    pub turnover: f64,
}

impl NetExchange {
    /// Energy that came less what went \[J\].
    pub fn energy(&self) -> f64 {
        self.kinetic + self.elastic + self.potential
    }

    /// All its numbers.
    fn numbers(&self) -> [f64; 15] {
        let Self { mass, mass_time, momentum: [a, b, c], applied: [d, e, f], .. } = *self;
        let Self { applied_time: [g, h, i], kinetic, elastic, potential, turnover, .. } = *self;
        [mass, mass_time, a, b, c, d, e, f, g, h, i, kinetic, elastic, potential, turnover]
    }
}

impl Exchange {
    /// Counts from here. What is due, the generators and the numbers that were given stay.
    pub(super) fn begin_counting(&mut self) {
        let outside = std::iter::once(&mut self.outside);
        self.outlets
            .iter_mut()
            .chain(outside)
            .chain(&mut self.passed)
            .for_each(|tally| *tally = ParticleCount::default());
        for feed in &mut self.feeds {
            (feed.came, feed.dropped) = (ParticleCount::default(), 0.0);
        }
        self.meters.iter_mut().for_each(|passed| *passed = MeterCount::default());
        self.net = NetExchange::default();
    }

    /// Whether all numbers are finite, and those that are of 0 or above are.
    pub(super) fn is_sound(&self) -> bool {
        let tallies = self.outlets.iter().chain([&self.outside]).chain(&self.passed);
        let tallies = tallies.chain(self.feeds.iter().map(|feed| &feed.came));
        let feeds =
            self.feeds.iter().flat_map(|feed| [feed.owed, feed.dropped, feed.radius, feed.travel, feed.present]);
        let meters = self.meters.iter().flat_map(|passed| [passed.mass, passed.mass_before, passed.mass_flow]);
        let rates = self.feeds.iter().flat_map(|feed| [feed.rate, feed.rate_of_rate]);
        let length = |feed: &InsertionProgress| feed.orientation.iter().map(|part| part * part).sum::<f64>();
        self.feeds.iter().all(|feed| (length(feed) - 1.0).abs() < 1e-6)
            && self.travel >= 0.0
            && self.travel.is_finite()
            && tallies.map(|tally| tally.mass).chain(feeds).all(|number| number >= 0.0 && number.is_finite())
            && meters.chain(rates).chain(self.net.numbers()).all(f64::is_finite)
    }
}

impl Exchange {
    /// Whether it has as many insertions, outlets, boundaries and flow meters as another.
    pub(super) fn check_same(&self, other: &Self) -> Result<(), StateFault> {
        let expected = "as many as the scene has";
        demand(self.feeds.len() == other.feeds.len(), "feeds", self.feeds.len(), expected)?;
        demand(self.outlets.len() == other.outlets.len(), "outlets", self.outlets.len(), expected)?;
        demand(self.passed.len() == other.passed.len(), "passed", self.passed.len(), expected)?;
        demand(self.meters.len() == other.meters.len(), "meters", self.meters.len(), expected)
    }
}
