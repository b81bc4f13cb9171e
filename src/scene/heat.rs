//! Temperatures: of particles and boundaries at the start, and what warms particles from outside.

use super::{AxisMotion, Boundary, Cell, ContactLaw, SceneDraft};
use crate::base::document::Mistake;
use crate::laws::column::TEMPERATURE;
use crate::laws::contact::property::PULL_OFF_FORCE;
use crate::laws::contact::{Law, LossKind, MaterialPair, Missing, Warming};
use std::collections::BTreeSet;

/// The temperature of a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BoundaryTemperature {
    /// None: no heat flows into it. A group of particles keeps what its particles have.
    #[default]
    None,
    /// As the scene says \[K\].
    Held(f64),
    /// As the outside says, from this one on \[K\].
    Driven(f64),
    /// That of a body which takes up heat.
    Body {
        /// At the start \[K\].
        temperature: f64,
        /// Heat capacity \[J/K\].
        capacity: f64,
        /// Heat flow from the outside before another is given \[W\].
        applied: f64,
    },
}

impl BoundaryTemperature {
    /// The temperature at the start \[K\], if it has one.
    pub fn at_start(&self) -> Option<f64> {
        match *self {
            Self::None => None,
            Self::Held(temperature) | Self::Driven(temperature) | Self::Body { temperature, .. } => Some(temperature),
        }
    }
}

/// `[heat]`
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeatSettings {
    /// Whether heat flows while nothing moves.
    pub frozen: bool,
    /// Which losses of contacts warm the bodies, half each.
    pub from_losses: Warming,
    /// Which losses of bonds do.
    pub from_bonds: BondWarming,
}

/// Which losses of bonds warm the bodies, half each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BondWarming {
    /// What damping and relaxation take.
    pub damping: bool,
    /// What bonds hold that break.
    pub release: bool,
}

impl HeatSettings {
    /// Whether losses warm the bodies.
    pub(crate) fn warms(&self) -> bool {
        self.from_losses != Warming::default() || self.from_bonds != BondWarming::default()
    }
}

/// `[heat_source.<name>]`: what warms or cools each of some particles.
#[derive(Clone, Debug)]
pub struct HeatSource {
    /// Its name in the scene.
    pub name: String,
    /// Indices into [`SceneDraft::particles`], ascending.
    pub members: Vec<u32>,
    /// What it gives to each.
    pub gives: HeatGiven,
}

/// What a heat source gives to a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeatGiven {
    /// A heat flow \[W\].
    Power(f64),
    /// Exchange with surroundings: conductance × (their temperature − its own).
    Ambient {
        /// Temperature of the surroundings \[K\].
        temperature: f64,
        /// Conductance to each particle \[W/K\].
        conductance: f64,
    },
}

/// A table, a key, and what is wrong.
type Objection = (String, &'static str, Mistake);

impl ContactLaw {
    /// Coefficients of its heat sub-model for two materials; none where it has none or a property is missing.
    pub(crate) fn heat_between(&self, pair: &MaterialPair) -> Option<Vec<f64>> {
        self.heat?.between(pair).ok()
    }

    /// Coefficients of its heat sub-model for each two materials, row by row; zeros where nothing meets, which may lack properties.
    pub(crate) fn heat_rows(&self, scene: &SceneDraft) -> Vec<Vec<f64>> {
        let (Some(model), materials) = (self.heat, scene.materials.len()) else { return Vec::new() };
        let row = |entry: usize| {
            let (a, b) = (&scene.materials[entry / materials], &scene.materials[entry % materials]);
            let pair = MaterialPair { a, b, properties: &scene.pairs[entry] };
            let row = self.between[entry].then(|| self.heat_between(&pair)).flatten();
            row.unwrap_or_else(|| vec![0.0; model.count()])
        };
        (0..materials * materials).map(row).collect()
    }
}

impl SceneDraft {
    /// Whether bodies have a temperature.
    pub fn has_heat(&self) -> bool {
        let bonds = self.bonds.iter().any(|bond| bond.keys.conductivity.is_some());
        bonds
            || self.heat.warms()
            || !self.heat_sources.is_empty()
            || self.fluid.as_ref().is_some_and(|fluid| fluid.heat.is_some())
            || self.contacts.iter().any(|law| law.heat.is_some())
    }

    /// Temperatures of the particles at the start, where heat flows \[K\].
    pub(crate) fn temperatures(&self) -> Option<&[f64]> {
        Some(&self.columns[self.column(TEMPERATURE.name)?].particles)
    }

    /// Heat capacity of a particle by itself, where its material has a specific heat \[J/K\].
    pub(crate) fn heat_capacity(&self, particle: usize) -> Option<f64> {
        let particle = &self.particles[particle];
        Some(particle.mass() * self.materials[particle.material.index()].thermal.specific_heat?)
    }
}

/// What of heat is missing, or contradicts the rest of the scene.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<Objection> {
    if !scene.has_heat() {
        return without_heat(scene);
    }
    let mut found = unsupported(scene);
    found.extend(sources(scene));
    found.extend(laws(scene));
    if scene.temperatures().is_none() {
        let expected = "a temperature [K] of each particle: heat flows in this scene".to_owned();
        found.push(("particles".to_owned(), "temperature", Mistake::Missing { expected }));
    }
    for (index, material) in scene.materials.iter().enumerate() {
        let here = scene.particles.iter().map(|particle| particle.material);
        let mut present = here.chain(scene.insertions.iter().map(|insertion| insertion.material));
        let is_used = present.any(|material| material.index() == index);
        if is_used && material.thermal.specific_heat.is_none() {
            let expected = "particles of this material take up heat".to_owned();
            found.push((format!("material.{}", material.name), "specific_heat", Mistake::Missing { expected }));
        }
    }
    found
}

/// Temperatures where none flows.
fn without_heat(scene: &SceneDraft) -> Vec<Objection> {
    let boundaries = scene.boundaries.iter().filter(|it| it.temperature != BoundaryTemperature::None);
    let what = || {
        Mistake::InvalidCombination {
        what: "nothing conducts in this scene".to_owned(),
        expected:
            "a table [contact.<law>.heat.<model>] or [fluid.<name>.heat.<law>], a conductivity of bonds or a [heat_source.<name>], or leave it out"
                .to_owned(),
    }
    };
    let mut found: Vec<_> =
        boundaries.map(|boundary| (format!("boundary.{}", boundary.name), "temperature", what())).collect();
    if scene.heat.frozen {
        found.push(("heat".to_owned(), "frozen", what()));
    }
    found
}

/// What heat is not modelled with.
fn unsupported(scene: &SceneDraft) -> Vec<Objection> {
    let mut found: Vec<_> = attraction(scene).into_iter().collect();
    let mut refuse = |table: String, key, what: &str| {
        let message = format!("expected none where heat flows, found one: {what}");
        found.push((table, key, Mistake::Refused { message }));
    };
    if scene.particles.first().is_some_and(|particle| particle.shape != Default::default()) {
        refuse("run".to_owned(), "plane_particles", "conduction of discs is not modelled");
    }
    if let Some(insertion) = scene.insertions.first().filter(|_| scene.heat.frozen) {
        refuse(format!("insertion.{}", insertion.name), "", "nothing moves in a scene with [heat] frozen = true");
    }
    if scene.heat.frozen && scene.heat.warms() {
        refuse("heat".to_owned(), "from_losses", "nothing moves in a scene with [heat] frozen = true");
    }
    if scene.heat.frozen {
        let moves = |boundary: &&Boundary| {
            let stays = |axis: &AxisMotion| (axis.is_fixed() && axis.conveys() == 0.0) || axis.takes_place();
            !boundary.axes.iter().all(stays)
        };
        if let Some(boundary) = scene.boundaries.iter().find(moves) {
            refuse(
                format!("boundary.{}", boundary.name),
                "motion",
                "nothing moves in a scene with [heat] frozen = true",
            );
        }
        if scene.cell.as_ref().is_some_and(Cell::moves) {
            refuse("cell".to_owned(), "motion", "nothing moves in a scene with [heat] frozen = true");
        }
    }
    found
}

/// Attraction among the losses of plastic contacts: it comes back, and no contact knows which part it has taken.
fn attraction(scene: &SceneDraft) -> Option<Objection> {
    let law = scene.contacts.iter().find(|law| {
        let pulls = |entry: usize| scene.pairs[entry].get(&PULL_OFF_FORCE).is_some_and(|force| force > 0.0);
        let mut governed = (0..scene.pairs.len()).filter(|&entry| law.between[entry]);
        Law::of(&law.choice).is_plastic() && (law.choice.cohesion.row().is_active() || governed.any(pulls))
    });
    let law = law.filter(|_| scene.heat.from_losses[LossKind::Other as usize])?;
    let message = format!(
        "expected losses that do not come back, found \"plastic\": in the book of losses it has the attraction of [contact.{}], its \
         cohesion model or pull_off_force, too",
        law.name
    );
    Some(("heat".to_owned(), "from_losses", Mistake::Refused { message }))
}

/// Heat sources of particles that a boundary carries.
fn sources(scene: &SceneDraft) -> Vec<Objection> {
    let mut carried = vec![None; scene.particles.len()];
    for boundary in &scene.boundaries {
        boundary.shape.members().iter().for_each(|&member| carried[member as usize] = Some(&boundary.name));
    }
    let of_group = |source: &HeatSource| {
        let member = source.members.iter().find(|member| carried[**member as usize].is_some())?;
        let (id, name) = (scene.particles[*member as usize].id.0, carried[*member as usize]?);
        let found = format!("particle {id} of [boundary.{name}]");
        let expected =
            "particles that are in no boundary: its heat is given by its temperature or applied_heat".to_owned();
        Some((format!("heat_source.{}", source.name), "particles", Mistake::Unexpected { found, expected }))
    };
    scene.heat_sources.iter().filter_map(of_group).collect()
}

/// Properties that laws need of the materials between which heat flows, and laws that do not know the area of contact.
fn laws(scene: &SceneDraft) -> Vec<Objection> {
    let (count, mut told, mut found) = (scene.materials.len(), BTreeSet::new(), Vec::new());
    for (a, b) in conducting(scene) {
        let (first, second) = (&scene.materials[a], &scene.materials[b]);
        let Some(law) = scene.contacts.iter().find(|law| law.between[a * count + b]) else { continue };
        let Some(heat) = law.heat else { continue };
        let pair = MaterialPair { a: first, b: second, properties: &scene.pairs[a * count + b] };
        if let Err(Missing { table, key }) = heat.between(&pair)
            && told.insert((table.clone(), key))
        {
            let expected = format!("[contact.{}] needs it for {} and {}", law.name, first.name, second.name);
            found.push((table, key, Mistake::Missing { expected }));
        }
        let is_softened = |index: usize| scene.materials[index].thermal.real_youngs_modulus.is_some();
        if !law.choice.normal.row().does.elastic_spheres
            && let Some(softened) = [a, b].into_iter().find(|&index| is_softened(index))
        {
            let (table, model) = (format!("material.{}", scene.materials[softened].name), law.choice.normal.name());
            let what = format!("the normal model {model} of [contact.{}] does not follow from the moduli", law.name);
            let expected = "hertz, dmt or jkr, or leave it out".to_owned();
            found.push((table, "real_youngs_modulus", Mistake::InvalidCombination { what, expected }));
        }
    }
    found
}

/// Pairs of materials (the first not after the second) of bodies between which heat can flow.
fn conducting(scene: &SceneDraft) -> Vec<(usize, usize)> {
    let count = scene.materials.len();
    let (mut particles, mut walls) = (vec![false; count], vec![false; count]);
    scene.particles.iter().for_each(|particle| particles[particle.material.index()] = true);
    scene.insertions.iter().for_each(|insertion| particles[insertion.material.index()] = true);
    for boundary in scene.boundaries.iter().filter(|it| it.temperature != BoundaryTemperature::None) {
        boundary.shape.material().into_iter().for_each(|material| walls[material.index()] = true);
    }
    let meet = |a: usize, b: usize| particles[a] && (particles[b] || walls[b]) || particles[b] && walls[a];
    let several = scene.particles.len() > 1 || !scene.insertions.is_empty();
    let flows = |&(a, b): &(usize, usize)| meet(a, b) && (several || walls[a] || walls[b]);
    (0..count).flat_map(|a| (a..count).map(move |b| (a, b))).filter(flows).collect()
}
