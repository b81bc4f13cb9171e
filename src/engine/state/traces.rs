//! What contacts leave behind: wear and losses on the facets of boundaries, and impacts that ended.

use super::check::{all_finite, demand, demand_all};
use super::in_place::clone_in_place;
use super::{Named, StateFault, plain};
use serde::{Deserialize, Serialize};

/// What contacts have left behind since counting began.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Traces {
    /// On the boundaries, in the scene's order.
    pub boundaries: Vec<FacetTraces>,
    /// Impacts that ended, by who met and by the energy that was lost, ascending.
    pub bins: Vec<ImpactBin>,
    /// Impacts that ended since the present communication step began, where the scene asks for each.
    pub impacts: Vec<Impact>,
}

clone_in_place!(Traces { boundaries, bins, impacts });

/// What contacts have left on each facet of a boundary; of a group of particles on the whole of it.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FacetTraces {
    /// Volume worn off \[m³\].
    #[serde(with = "plain")]
    pub wear: Vec<f64>,
    /// Energy that its contacts lost along the normal \[J\].
    #[serde(with = "plain")]
    pub normal: Vec<f64>,
    /// Energy that they lost across it \[J\].
    #[serde(with = "plain")]
    pub tangential: Vec<f64>,
}

clone_in_place!(FacetTraces { wear, normal, tangential });

/// Impacts of the same bodies that lost about as much.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpactBin {
    /// Who met: a boundary, or behind the boundaries two materials, row by row.
    pub between: u32,
    /// The bin of the energy; [`ImpactBin::NOTHING`] where none was lost.
    pub bin: i32,
    /// How many there were.
    pub count: u64,
    /// What they lost along the normal and across it \[J\].
    pub lost: [f64; 2],
    /// Largest normal force of any \[N\].
    pub largest_force: f64,
}

impl ImpactBin {
    /// The bin of impacts that lost nothing, or gained.
    pub const NOTHING: i32 = i32::MIN;
}

/// One impact, from touch to parting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// When the bodies had parted \[s\].
    pub time: f64,
    /// The particle.
    pub particle: Named,
    /// The other one; none at a surface.
    pub partner: Option<Named>,
    /// Who met, as in [`ImpactBin::between`].
    pub between: u32,
    /// What happened.
    pub record: ImpactRecord,
}

/// What happened in an impact so far, as its contact remembers it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpactRecord {
    /// What was lost along the normal and across it \[J\].
    pub lost: [f64; 2],
    /// Largest normal force \[N\].
    pub largest_force: f64,
    /// How long the bodies have touched \[s\].
    pub duration: f64,
    /// Speeds along the normal and across it at touch; 0 where they touched before time 0 \[m/s\].
    pub speed: [f64; 2],
    /// Whether it has begun.
    pub begun: bool,
}

impl ImpactRecord {
    /// The same in rows of the history of a contact.
    pub(crate) fn to_rows(self) -> [[f64; 4]; 2] {
        let Self { lost: [along, across], largest_force, duration, speed: [normal, tangential], begun } = self;
        [[along, across, largest_force, duration], [normal, tangential, f64::from(u8::from(begun)), 0.0]]
    }

    /// What rows of the history of a contact hold.
    pub(crate) fn of_rows([lost, touch]: [[f64; 4]; 2]) -> Self {
        let [along, across, largest_force, duration] = lost;
        let [normal, tangential, begun, _] = touch;
        Self { lost: [along, across], largest_force, duration, speed: [normal, tangential], begun: begun != 0.0 }
    }
}

impl Traces {
    /// Nothing yet, on boundaries of so many facets.
    pub(crate) fn of(facets: impl Iterator<Item = usize>) -> Self {
        let none =
            |count| FacetTraces { wear: vec![0.0; count], normal: vec![0.0; count], tangential: vec![0.0; count] };
        Self { boundaries: facets.map(none).collect(), ..Self::default() }
    }

    /// Counts an impact that ended, in this bin of the energy.
    pub(crate) fn count(&mut self, impact: &Impact, bin: i32) {
        let key = (impact.between, bin);
        let place = match self.bins.binary_search_by_key(&key, |it| (it.between, it.bin)) {
            Ok(place) => place,
            Err(place) => {
                let (between, bin) = key;
                self.bins.insert(place, ImpactBin { between, bin, ..ImpactBin::default() });
                place
            }
        };
        let (found, record) = (&mut self.bins[place], &impact.record);
        found.count += 1;
        (0..2).for_each(|part| found.lost[part] += record.lost[part]);
        found.largest_force = found.largest_force.max(record.largest_force);
    }

    /// How many impacts have ended.
    pub fn ended(&self) -> u64 {
        self.bins.iter().map(|bin| bin.count).sum()
    }

    /// Counts from here.
    pub(super) fn begin_counting(&mut self) {
        for facets in &mut self.boundaries {
            [&mut facets.wear, &mut facets.normal, &mut facets.tangential].into_iter().for_each(|it| it.fill(0.0));
        }
        self.bins.clear();
        self.impacts.clear();
    }

    /// All sums.
    pub(super) fn sums(&self) -> impl Iterator<Item = f64> + '_ {
        let facets = self.boundaries.iter().flat_map(|it| it.wear.iter().chain(&it.normal).chain(&it.tangential));
        facets.copied().chain(self.bins.iter().flat_map(|bin| bin.lost))
    }

    /// Whether these can be traces of a scene of which `other` are, with so many indices of particles.
    pub(super) fn check(&self, other: &Self, particles: usize) -> Result<(), StateFault> {
        let lengths = |it: &Self| -> Vec<[usize; 3]> {
            it.boundaries.iter().map(|it| [&it.wear, &it.normal, &it.tangential].map(Vec::len)).collect()
        };
        demand(lengths(self) == lengths(other), "traces", 0, "the facets of the scene's boundaries")?;
        let sums: Vec<f64> = self.sums().collect();
        all_finite(&sums, "traces")?;
        let ascends = self.bins.is_sorted_by(|a, b| (a.between, a.bin) < (b.between, b.bin));
        demand(ascends, "traces", 1, "bins that ascend")?;
        let counts = self.bins.iter().map(|bin| bin.count < super::check::MOST && bin.largest_force.is_finite());
        demand_all(counts, "traces", "a count that can be reached, and a finite force")?;
        let there = |named: &Named| (named.index as usize) < particles;
        let known = self.impacts.iter().map(|it| there(&it.particle) && it.partner.as_ref().is_none_or(there));
        demand_all(known, "traces", "particles of the scene")
    }
}
