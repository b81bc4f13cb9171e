//! What must be known of a scene to understand a state that it has reached.

use crate::engine::state::{State, StateFault, demand};
use crate::laws::bond::{self, formulation::FormulationChoice};
use crate::scene::exchange::Amount;
use crate::scene::packing::made::Packed;
use crate::scene::{Boundary, Insertion, Output, Scene, SceneDraft};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use xxhash_rust::xxh3::Xxh3;

/// This program.
const PROGRAM: &str = concat!("cograin ", env!("CARGO_PKG_VERSION"));

/// A scene, as far as its states refer to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// The program that wrote it.
    pub program: String,
    /// File name of the scene.
    pub scene: String,
    /// Time of the state \[s\].
    pub time: f64,
    /// Fingerprint of the scene.
    pub fingerprint: u64,
    /// The text of the scene and every file that it names, each with a fingerprint of its own.
    #[serde(default)]
    parts: Vec<(String, u64)>,
    /// Digest of the table of inputs of the run, if it has one.
    #[serde(default)]
    pub inputs: Option<u64>,
    /// Fingerprint of everything that decides how the scene goes on.
    course: u64,
    /// Numbers of the particles, ascending: first and count of each series.
    particles: Vec<[u32; 2]>,
    /// Random packings, whose spheres stand between this and the state.
    #[serde(default)]
    pub(crate) packings: Vec<Packed>,
    /// Declared columns of the particles: names.
    columns: Vec<String>,
    /// Materials: names.
    materials: Vec<String>,
    /// Insertions: name, and what is to come, without the value of a rate.
    insertions: Vec<(String, String)>,
    /// Boundaries: name and shape.
    boundaries: Vec<(String, String)>,
    /// Contact laws: name, and names of what they remember of a contact.
    contacts: Vec<(String, Vec<String>)>,
    /// Bond laws: name, formulation, and the plane if they are at one.
    bonds: Vec<(String, String, Option<String>)>,
}

impl Description {
    /// The description of a scene with this file name.
    pub fn of(scene: &Scene, name: &str, time: f64) -> Self {
        let mut particles: Vec<[u32; 2]> = Vec::new();
        for particle in &scene.particles {
            match particles.last_mut() {
                Some([first, count]) if u64::from(*first) + u64::from(*count) == u64::from(particle.id.0) => {
                    *count += 1;
                }
                _ => particles.push([particle.id.0, 1]),
            }
        }
        let bonds = scene.bonds.iter().map(|bond| {
            let plane = bond.plane.map(|plane| scene.boundaries[plane.index()].name.clone());
            (bond.name.clone(), format!("{:?}", bond.keys.formulation), plane)
        });
        Self {
            program: PROGRAM.to_owned(),
            scene: name.to_owned(),
            time,
            fingerprint: scene.fingerprint,
            parts: scene.parts.clone(),
            inputs: None,
            course: course(scene),
            particles,
            packings: Packed::of(scene),
            columns: scene.columns.iter().map(|start| start.column.name.to_owned()).collect(),
            materials: scene.materials.iter().map(|material| material.name.clone()).collect(),
            insertions: scene.insertions.iter().map(|it| (it.name.clone(), amount(it))).collect(),
            boundaries: scene.boundaries.iter().map(|it| (it.name.clone(), shape(it).to_owned())).collect(),
            contacts: (0..scene.contacts.len())
                .map(|law| (scene.contacts[law].name.clone(), memory(scene, law)))
                .collect(),
            bonds: bonds.collect(),
        }
    }

    /// The same of a run with a table of inputs of this digest.
    pub(crate) fn with_inputs(self, inputs: Option<u64>) -> Self {
        Self { inputs, ..self }
    }

    /// Whether a scene goes on in the same way: it differs in its end and its outputs at most.
    pub fn goes_on_as(&self, scene: &Scene) -> bool {
        self.course == course(scene)
    }

    /// In which parts a scene differs, in words.
    pub(crate) fn differing_parts(&self, scene: &Scene) -> String {
        let of = |parts: &[(String, u64)], name: &str| parts.iter().find(|(known, _)| known == name).map(|(_, it)| *it);
        let names = self.parts.iter().chain(&scene.parts).map(|(name, _)| name);
        let mut differing: Vec<&str> = Vec::new();
        for name in names.filter(|name| of(&self.parts, name) != of(&scene.parts, name)) {
            if !differing.contains(&name.as_str()) {
                differing.push(name);
            }
        }
        if self.program != PROGRAM {
            differing.push("the program");
        }
        if differing.is_empty() { "text, files, settings or program".to_owned() } else { differing.join(", ") }
    }

    /// Whether a state can be one of this scene, as far as the description tells: what [`Simulation::taken_over`] trusts.
    ///
    /// [`Simulation::taken_over`]: crate::engine::simulation::Simulation::taken_over
    pub(crate) fn check(&self, state: &State) -> Result<(), StateFault> {
        state.check_lists()?;
        let ends = self.particles.iter().map(|&[first, count]| [u64::from(first), u64::from(first) + u64::from(count)]);
        let ends: Vec<u64> = ends.flatten().collect();
        let ascend = ends.windows(2).all(|pair| pair[0] <= pair[1]) && ends.last().is_none_or(|&end| end <= 1 << 32);
        demand(ascend, "particles", 0, "ascending numbers")?;
        let same = "as many as are described";
        let count = self.particles.iter().map(|&[_, count]| u64::from(count)).sum::<u64>();
        let own = state.particles.slot.len() - state.particles.numbers.len();
        demand(count == own as u64, "particles", own, same)?;
        let declared = state.particles.declared.len();
        demand(declared == self.columns.len(), "declared", declared, same)?;
        let known = state.particles.material.iter().all(|&material| (material as usize) < self.materials.len());
        demand(known, "material", 0, "materials of the scene")?;
        let feeds = state.exchange.as_ref().map_or(0, |exchange| exchange.feeds.len());
        demand(feeds == self.insertions.len(), "feeds", feeds, same)?;
        demand(state.boundaries.len() == self.boundaries.len(), "boundaries", state.boundaries.len(), same)?;
        demand(state.contacts.len() == self.contacts.len(), "contacts", state.contacts.len(), same)?;
        demand(state.bonds.len() == self.bonds.len(), "bonds", state.bonds.len(), same)?;
        let rows = |law: usize| self.contacts.get(law).map(|(_, rows)| rows.len());
        for (law, list) in state.contacts.iter().enumerate() {
            list.check_history(rows(law))?;
        }
        for list in &state.walls {
            let there = (list.boundary as usize) < self.boundaries.len();
            demand(there, "walls", list.boundary as usize, "a boundary of the scene")?;
            list.check_history(rows(list.law as usize))?;
        }
        for ((_, formulation, plane), list) in self.bonds.iter().zip(&state.bonds) {
            let known = FormulationChoice::ALL.iter().copied().find(|it| format!("{it:?}") == *formulation);
            list.check_rows(known.map(bond::rows), plane.is_some())?;
        }
        Ok(())
    }

    /// Numbers of the particles, ascending.
    pub(super) fn ids(&self) -> impl Iterator<Item = u32> + '_ {
        self.particles.iter().flat_map(|&[first, count]| (0..count).map(move |k| first + k))
    }

    /// Names of the declared columns of the particles.
    pub(super) fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The place here of each of the other scene's materials that has a name of this scene's.
    pub(super) fn material_here(&self, scene: &Scene, there: u32) -> Option<u32> {
        let name = self.materials.get(there as usize)?;
        scene.materials.iter().position(|material| material.name == *name).map(|place| place as u32)
    }

    /// Place of the insertion that has this one's name and lets come what it does.
    pub(super) fn insertion(&self, insertion: &Insertion) -> Option<usize> {
        self.insertions.iter().position(|(name, what)| *name == insertion.name && *what == amount(insertion))
    }

    /// Place of the boundary that has this one's name and shape.
    pub(super) fn boundary(&self, boundary: &Boundary) -> Option<usize> {
        self.boundaries.iter().position(|(name, kind)| *name == boundary.name && kind == shape(boundary))
    }

    /// Name and shape of a boundary.
    pub(super) fn boundary_at(&self, place: usize) -> Option<&(String, String)> {
        self.boundaries.get(place)
    }

    /// The contact laws: name, and names of what they remember of a contact.
    pub(super) fn contacts(&self) -> &[(String, Vec<String>)] {
        &self.contacts
    }

    /// The bond laws: name, formulation, and the plane if they are at one.
    pub(super) fn bonds(&self) -> &[(String, String, Option<String>)] {
        &self.bonds
    }

    /// What differs from a scene in a way that its author should know, in words.
    pub(super) fn differences(&self, scene: &Scene) -> Vec<String> {
        let mut left = Vec::new();
        let here = |id: u32| scene.particles.binary_search_by_key(&id, |particle| particle.id.0).is_ok();
        let (mut all, mut known) = (0, 0);
        for id in self.ids() {
            all += 1;
            known += usize::from(here(id));
        }
        if known < all {
            left.push(format!(
                "{} of {all} particles of {} are not in this scene and stay behind",
                all - known,
                self.scene
            ));
        }
        if known < scene.particles.len() {
            let new = scene.particles.len() - known;
            left.push(format!(
                "{new} particles of this scene are not in {}; they begin as this scene has them",
                self.scene
            ));
        }
        for (name, kind) in &self.boundaries {
            if !scene.boundaries.iter().any(|it| it.name == *name && shape(it) == kind) {
                left.push(format!(
                    "[boundary.{name}] of {} has no {kind} of its name here and stays behind",
                    self.scene
                ));
            }
        }
        for (name, rows) in &self.contacts {
            let kept = |row: &&String| !(0..scene.contacts.len()).any(|law| memory(scene, law).contains(row));
            for row in rows.iter().filter(kept) {
                left.push(format!("the {row} of [contact.{name}] of {} has no law here that keeps it", self.scene));
            }
        }
        for boundary in scene.boundaries.iter().filter(|it| self.boundary(it).is_none()) {
            left.push(format!("[boundary.{}] is new and begins where this scene has it", boundary.name));
        }
        left
    }
}

/// Names of what is kept of a contact of a law.
fn memory(scene: &Scene, law: usize) -> Vec<String> {
    scene.kept_rows(law).iter().map(|row| row.name.to_owned()).collect()
}

/// What an insertion lets come: a mass, or by which kind of rate.
fn amount(insertion: &Insertion) -> String {
    match insertion.amount {
        Amount::MassRate(_) => "mass_rate".to_owned(),
        Amount::CountRate(_) => "count_rate".to_owned(),
        Amount::Mass(mass) => format!("mass {mass:?}"),
    }
}

/// The shape of a boundary, in one word.
fn shape(boundary: &Boundary) -> &'static str {
    boundary.shape.key()
}

/// Takes text into a fingerprint.
struct Hashed(Xxh3);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// A fingerprint of all of a scene that decides how a state of it goes on: not when it ends, nor what is written.
fn course(scene: &Scene) -> u64 {
    let mut hashed = Hashed(Xxh3::new());
    for particle in &scene.particles {
        hashed.0.update(&particle.id.0.to_le_bytes());
        hashed.0.update(&particle.material.0.to_le_bytes());
        let [position, velocity, spin] = [particle.position, particle.velocity, particle.angular_velocity];
        for number in [position, velocity, spin].as_flattened().iter().chain(&[particle.radius, particle.mass()]) {
            hashed.0.update(&number.to_bits().to_le_bytes());
        }
    }
    let mut rest = SceneDraft {
        particles: Vec::new(),
        fingerprint: 0,
        parts: Vec::new(),
        packed: Vec::new(),
        unread: Vec::new(),
        ..SceneDraft::clone(scene)
    };
    rest.run.end = None;
    (rest.run.threads, rest.run.width) = (None, None);
    rest.run.plane = None;
    // Their numbers stand in the laws; what may be tuned is part of the state.
    for parameter in scene.tunables() {
        hashed.0.update(parameter.name.as_bytes());
    }
    rest.parameters = Vec::new();
    (rest.probes, rest.derived) = (Vec::new(), Vec::new());
    let defaults = crate::scene::Run::default();
    rest.run.settle_tolerance = defaults.settle_tolerance;
    rest.run.settle_damping = defaults.settle_damping;
    rest.run.max_overlap = defaults.max_overlap;
    rest.run.central_derivatives = defaults.central_derivatives;
    rest.run.derivative_displacement = defaults.derivative_displacement;
    let Output { energy, losses, impacts, .. } = scene.output;
    rest.output = Output { energy, losses, impacts, ..Output::default() };
    // Writing to a fingerprint has no way to fail.
    let _ = write!(hashed, "{rest:?}");
    hashed.0.digest()
}
