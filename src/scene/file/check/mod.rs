//! Checks across tables: from tables that are right by themselves to a scene that is right as a whole.

mod body;
mod bonded_pairs;
mod bonds;
mod boundaries;
mod clumps;
mod columns;
mod consistency;
mod contacts;
mod damping;
mod exchange;
mod finding;
mod fluid;
mod following;
mod heat;
mod motion;
mod named_tables;
mod particles;
mod place;
mod properties;
pub(super) mod raw_tables;
mod selection;
mod set_reader;
mod tables;
mod values;

use super::tables::{RunTable, StepKey};
use crate::base::document::{Document, Faults, Mistake, SceneErrors};
use crate::laws::region;
use crate::laws::surface::Files;
use crate::scene::file::parameters;
use crate::scene::packing::{PackingProgress, Packings};
use crate::scene::{
    Accuracy, Cell, Derived, Grid, Models, Output, Probe, Region, Run, Scene, SceneDraft, Source, Step,
};
use crate::scene::{cell, clump, column, grid};
use finding::Finding;
use particles::ReadParticles;
use raw_tables::RawTables;

/// The scene that a source describes. Mistakes found so far are in `faults`.
pub(super) fn scene(
    source: &Source,
    document: &Document,
    mut faults: Faults,
    models: &Models,
    (made, tell): (&Packings, &mut dyn FnMut(PackingProgress)),
) -> Result<Scene, SceneErrors> {
    let written = RawTables::read(document, models, &mut faults);
    faults.so_far()?;
    let Some(written) = written else { return Err(SceneErrors { list: Vec::new() }) };
    let materials = contacts::materials(&written);
    let run = run(&written.run, &mut faults);
    check_output(&written.output, &mut faults);
    let pairs = contacts::pairs(&written, &materials, &mut faults);
    let laws = contacts::laws(&written.contacts, &materials, run.scheme, &mut faults);
    let asked = columns::asked(document, &written.columns);
    let born = particles::particles(&written, source, (&materials, &asked), &mut faults, (made, tell));
    faults.so_far()?;
    let columns = columns::starts(&written, &asked, &born, &mut faults);
    faults.so_far()?;
    let cell = cell_of(&written, &born, &mut faults);
    let boundaries = boundaries::boundaries(&written, source, &materials, (&born, &columns), &mut faults);
    let bonds = bonds::bonds(&written, source, (&born, cell.as_ref()), &boundaries, &run, &mut faults);
    let damping = damping::damping(&written, &materials, &born, &mut faults);
    motion::damping(&boundaries, &damping, &mut faults);
    let forces = damping::forces(&written, &born, &mut faults);
    let heat_sources = heat::sources(&written, &born, &mut faults);
    let fluid = fluid::fluid(&written, source, (&materials, &born, &columns), &mut faults);
    let regions = regions(&written, source, &mut faults);
    let grids = written.grids.iter().map(|(name, keys)| Grid::of(name, keys)).collect();
    let exchange::Parts { insertions, outlets, meters } =
        exchange::parts(&written, (&regions, &boundaries), (&materials, &born.shapes), &mut faults);
    let (probes, derived) = looks(&written, &born.sets, &mut faults);
    let mut draft = SceneDraft {
        about: written.about,
        bonds,
        run,
        gravity: written.gravity.0,
        materials,
        pairs,
        contacts: laws,
        sets: born.sets,
        particles: born.particles,
        columns,
        clump_shapes: born.shapes,
        clumps: born.clumps,
        boundaries,
        damping,
        forces,
        heat: written.heat.settings(),
        heat_sources,
        fluid,
        regions,
        grids,
        outside: written.domain.as_ref().and_then(|domain| domain.outside).unwrap_or_default(),
        domain: written.domain.map(|domain| domain.r#box.0),
        cell,
        insertions,
        outlets,
        meters,
        probes,
        derived,
        output: written.output,
        parameters: Vec::new(),
        fingerprint: source.fingerprint(),
        parts: source.parts(),
        packed: born.packed,
        unread: faults.all_unread().to_vec(),
    };
    draft.parameters = parameters::of_scene(&draft, document);
    relations(&mut draft, document, &mut faults);
    faults.finish().map(|()| Scene::of_checked(draft))
}

/// `[cell]`, beside the boxes of files.
fn cell_of(written: &RawTables, born: &ReadParticles, faults: &mut Faults) -> Option<Cell> {
    let from_file = born.boxes.first().map(|(.., around)| around.lattice);
    let mut report = |key: &str, mistake| faults.add("cell", key, mistake);
    let cell = written.cell.as_ref().and_then(|keys| keys.cell(from_file, &mut report));
    if written.cell.is_some() && cell.is_none() {
        return None;
    }
    for (table, file, around) in &born.boxes {
        if let Some([found, expected]) = cell::box_objection(cell.as_ref(), around) {
            faults.in_file(file, around.line, table, "", Mistake::Unexpected { found, expected });
        }
    }
    cell
}

impl SceneDraft {
    /// The scene, if it can be run: every number is one that its key takes, every index points at something, laws have their
    /// properties, particles are where they may be, boundaries can do what they are to do. Otherwise all mistakes, each with the table
    /// and the key that a scene file would have it in.
    pub fn build(mut self) -> Result<Scene, SceneErrors> {
        let document = Document::parse("", "")?;
        let mut faults = Faults::new(&document);
        // Who built it may have moved the particles.
        self.packed.clear();
        values::check(&self, &mut faults);
        faults.so_far()?;
        if let Some((table, key, mistake)) = clump::faults(&self) {
            faults.add(&table, key, mistake);
            faults.so_far()?;
        }
        boundaries::check(&self, &mut faults);
        bonds::check(&self, &mut faults);
        motion::damping(&self.boundaries, &self.damping, &mut faults);
        relations(&mut self, &document, &mut faults);
        faults.finish().map(|()| Scene::of_checked(self))
    }
}

/// Reports what the parts of a scene are not to each other.
fn relations(draft: &mut SceneDraft, document: &Document, faults: &mut Faults) {
    let repeated = cell::repeat_surfaces(draft);
    grid::repeat(&mut draft.grids, draft.cell.as_ref());
    // Losses that warm, and those of single impacts, are found by the book of losses.
    draft.output.losses |= draft.heat.warms() || draft.output.impacts.is_some();
    let draft = &*draft;
    if let Some([found, expected]) = draft.stiffness_objection() {
        faults.add("output", "stiffness", Mistake::Unexpected { found, expected });
    }
    let found =
        consistency::laws(draft).into_iter().chain(consistency::places(draft)).chain(exchange::objections(draft));
    let others = cell::objections(draft).into_iter().chain(repeated).chain(clump::objections(draft));
    let others = others
        .chain(column::objections(draft))
        .chain(crate::scene::heat::objections(draft))
        .chain(grid::objections(draft))
        .chain(crate::scene::fluid::objections(draft));
    let others = others.map(|(table, key, mistake)| Finding::at(table, key, mistake));
    for finding in found.chain(others) {
        report(finding, document, faults);
    }
}

/// Reports a mistake in the scene, at the line of its table in the text.
fn report(finding: Finding, document: &Document, faults: &mut Faults) {
    let Finding { mut table, key, otherwise, mistake } = finding;
    if !document.has(&table)
        && let [kind, a, b] = table.split('.').collect::<Vec<_>>()[..]
        && document.has(&format!("{kind}.{b}.{a}"))
    {
        table = format!("{kind}.{b}.{a}");
    }
    match document.has(&table) {
        true => faults.add(&table, &key, mistake),
        false => faults.at_line(document.line_of(&otherwise, ""), &table, &key, mistake),
    }
}

/// `[run]`
fn run(table: &RunTable, faults: &mut Faults) -> Run {
    let defaults = Run::default();
    let accuracy = table.accuracy.unwrap_or(defaults.accuracy);
    if let (Some(StepKey::Given(_)), Some(_)) = (table.step, table.safety) {
        let (what, expected) = ("a given step has no safety", "write step = \"auto\", or leave safety out");
        faults.add(
            "run",
            "safety",
            Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() },
        );
    }
    let unused = match (table.step, table.safety) {
        (Some(StepKey::Given(_)), _) => Some("a given step"),
        (_, Some(_)) => Some("a fraction of the stable step, safety,"),
        _ => None,
    };
    if let (Some(unused), Accuracy::Within(_)) = (unused, accuracy) {
        let expected = "a word, which chooses the scheme, or one of the two keys alone";
        faults.add(
            "run",
            "accuracy",
            Mistake::InvalidCombination {
                what: format!("{unused} follows no accuracy"),
                expected: expected.to_owned(),
            },
        );
    }
    if let (None | Some(StepKey::Automatic), Some(true)) = (table.step, table.allow_unstable) {
        let (what, expected) =
            ("an automatic step is never above the stable one", "give a step, or leave allow_unstable out");
        faults.add(
            "run",
            "allow_unstable",
            Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() },
        );
    }
    let strict = match (table.strict_step, table.step, table.allow_unstable) {
        (Some(true), None | Some(StepKey::Automatic), _) => {
            Some(("an automatic step is never above the stable one", "give a step, or leave strict_step out"))
        }
        (Some(true), _, Some(true)) => Some(("strict_step beside allow_unstable", "one of them")),
        _ => None,
    };
    if let Some((what, expected)) = strict {
        let (what, expected) = (what.to_owned(), expected.to_owned());
        faults.add("run", "strict_step", Mistake::InvalidCombination { what, expected });
    }
    if table.plane_particles.is_some() && table.plane.is_none() {
        let (what, expected) = ("plane_particles needs a plane", "write plane = \"xz\" beside it, or leave it out");
        faults.add(
            "run",
            "plane_particles",
            Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() },
        );
    }
    Run {
        end: table.end.map(crate::base::quantity::Positive::get),
        step: match table.step {
            Some(StepKey::Given(step)) => Step::Given(step),
            Some(StepKey::Automatic) | None => {
                table.safety.map_or(Step::Following, |safety| Step::Automatic { safety: safety.get() })
            }
        },
        accuracy,
        scheme: table.scheme.unwrap_or(accuracy.scheme()),
        allow_unstable: table.allow_unstable.unwrap_or(defaults.allow_unstable),
        strict_step: table.strict_step.unwrap_or(defaults.strict_step),
        threads: table.threads.map(|threads| threads.get() as usize),
        width: None,
        seed: table.seed.unwrap_or(defaults.seed),
        skin: table.skin.map(crate::base::quantity::Positive::get),
        settle_tolerance: table
            .settle_tolerance
            .map_or(defaults.settle_tolerance, crate::base::quantity::Positive::get),
        settle_damping: table.settle_damping.map(crate::base::quantity::Fraction::get),
        max_overlap: table.max_overlap.map_or(defaults.max_overlap, crate::base::quantity::NonNegative::get),
        plane: table.plane,
        central_derivatives: table.central_derivatives.unwrap_or(defaults.central_derivatives),
        derivative_displacement: table
            .derivative_displacement
            .map_or(defaults.derivative_displacement, crate::base::quantity::Positive::get),
    }
}

/// `[output]`
fn check_output(table: &Output, faults: &mut Faults) {
    let with_frames =
        [(table.contacts, "contacts"), (table.boundaries, "boundaries"), (table.compressed, "compressed files")];
    if let Some((_, what)) = with_frames.iter().find(|(wanted, _)| *wanted && table.frame_interval.is_none()) {
        let expected = format!("{what} are written with the frames");
        faults.add("output", "frame_interval", Mistake::Missing { expected });
    }
}

/// Probes and sums of outputs.
fn looks(written: &RawTables, sets: &[String], faults: &mut Faults) -> (Vec<Probe>, Vec<Derived>) {
    let mut probes = Vec::new();
    for (name, keys) in &written.probes {
        let table = format!("probe.{name}");
        probes.extend(Probe::of(name, keys, sets, &mut |key, mistake| faults.add(&table, key, mistake)));
    }
    let derived = written.derived.iter().map(|(name, keys)| Derived { name: name.clone(), sum: keys.sum.clone() });
    (probes, derived.collect())
}

/// All regions.
fn regions(written: &RawTables, source: &Source, faults: &mut Faults) -> Vec<Region> {
    let boundaries: Vec<&str> = written.boundaries.iter().map(|(name, _)| name.as_str()).collect();
    let mut region = |(name, keys): &(String, region::Keys)| {
        Region::of(name, keys, &boundaries, &mut WrittenRegion { table: format!("region.{name}"), source, faults })
    };
    written.regions.iter().filter_map(&mut region).collect()
}

/// A region as it is written, with what it refers to.
struct WrittenRegion<'a, 'b, 'c> {
    /// Its name, as `region.core`.
    table: String,
    /// The files of the scene.
    source: &'a Source,
    /// Where mistakes go.
    faults: &'a mut Faults<'b, 'c>,
}

impl Files for WrittenRegion<'_, '_, '_> {
    fn file(&self, name: &str) -> Option<&[u8]> {
        self.source.files.get(name).map(Vec::as_slice)
    }

    fn report(&mut self, key: &str, mistake: Mistake) {
        self.faults.add(&self.table, key, mistake);
    }
}
