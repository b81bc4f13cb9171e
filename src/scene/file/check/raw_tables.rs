//! Every table of the text as its own type; from here on only relations between tables can be wrong.

use super::columns;
use super::named_tables::{Named, all, names};
use super::properties;
use crate::base::document::Mistake;
use crate::base::document::messages;
use crate::base::document::{Document, Faults, Part};
use crate::laws::bond::keys::{BreakageChoice, Keys};
use crate::laws::column::Column;
use crate::laws::contact::{
    CohesionModel, HeatModel, Model, ModelRow, NoKeys, NormalModel, Properties, Property, RollingModel, TangentialModel,
};
use crate::laws::convection::ConvectionModel;
use crate::laws::drag::DragModel;
use crate::laws::law_row::{LawModel, LawRow};
use crate::laws::lift::LiftModel;
use crate::laws::region;
use crate::laws::surface::{ShapeRow, mesh};
use crate::laws::wear::WearModel;
use crate::scene::cell::CellKeys;
use crate::scene::clump::ClumpKeys;
use crate::scene::exchange::{InsertionKeys, MeterKeys, OutletKeys};
use crate::scene::file::tables::{
    BoundaryTable, ContactTable, DampingTable, DomainTable, FluidTable, ForceTable, HeatSourceTable, HeatTable,
    MaterialTable, ParticlesTable, RunTable, TABLES, Triple,
};
use crate::scene::grid::GridKeys;
use crate::scene::{About, AxisMotion, DRY, DerivedKeys, Models, Output, ProbeKeys, ROLLING_FREELY, SMOOTH};
use std::collections::BTreeMap;

/// The whole text.
pub(in crate::scene::file) struct RawTables {
    /// `[about]`
    pub(super) about: About,
    /// `[run]`
    pub(super) run: RunTable,
    /// `gravity`
    pub(super) gravity: Triple,
    /// `[material.<name>]`
    pub(super) materials: Named<MaterialTable>,
    /// `[pair.<a>.<b>]`
    pub(super) pairs: Vec<([String; 2], Properties)>,
    /// `[contact.<name>]`
    pub(super) contacts: Named<Law>,
    /// `[bond.<name>]`
    pub(super) bonds: Named<Keys>,
    /// `[clump.<name>]`
    pub(super) clumps: Named<ClumpKeys>,
    /// `[particles.<name>]`
    pub(super) particles: Named<ParticlesTable>,
    /// `[boundary.<name>]`
    pub(super) boundaries: Named<BoundaryTable>,
    /// Columns that scenes may ask for.
    pub(super) columns: Vec<&'static Column>,
    /// How the key of each shape is written.
    pub(super) hints: Vec<&'static str>,
    /// `[damping.<name>]`
    pub(super) damping: Named<DampingTable>,
    /// `[force.<name>]`
    pub(super) forces: Named<ForceTable>,
    /// `[heat]`
    pub(super) heat: HeatTable,
    /// `[heat_source.<name>]`
    pub(super) heat_sources: Named<HeatSourceTable>,
    /// `[fluid.<name>]`, with its laws
    pub(super) fluid: Option<FluidTables>,
    /// `[region.<name>]`
    pub(super) regions: Named<region::Keys>,
    /// `[grid.<name>]`
    pub(super) grids: Named<GridKeys>,
    /// `[insertion.<name>]`
    pub(super) insertions: Named<InsertionKeys>,
    /// `[outlet.<name>]`
    pub(super) outlets: Named<OutletKeys>,
    /// `[flow_meter.<name>]`
    pub(super) meters: Named<MeterKeys>,
    /// `[domain]`
    pub(super) domain: Option<DomainTable>,
    /// `[cell]`
    pub(super) cell: Option<CellKeys>,
    /// `[output]`
    pub(super) output: Output,
    /// `[probe.<name>]`
    pub(super) probes: Named<ProbeKeys>,
    /// `[derived.<name>]`
    pub(super) derived: Named<DerivedKeys>,
}

/// A contact law and its sub-models.
pub(super) struct Law {
    /// What stands in the table itself.
    pub(super) table: ContactTable,
    /// Normal sub-model.
    pub(super) normal: NormalModel,
    /// Tangential sub-model.
    pub(super) tangential: TangentialModel,
    /// Rolling sub-model.
    pub(super) rolling: RollingModel,
    /// Cohesion sub-model.
    pub(super) cohesion: CohesionModel,
    /// Heat sub-model, where heat flows.
    pub(super) heat: Option<HeatModel>,
}

/// How many materials a scene may have: what each two have in common is kept as a square.
const MOST_MATERIALS: usize = 256;

/// A file that a scene names: the table, the key, and the name.
pub(in crate::scene::file) type FileName = (String, String, String);

/// The files that a scene names.
pub(in crate::scene::file) fn files(document: &Document, models: &Models) -> Vec<FileName> {
    let mut keys = vec![("particles", "file".to_owned()), ("clump", "file".to_owned())];
    keys.push(("bond", "create.file".to_owned()));
    let shapes = models.shapes.iter().map(|row| ("boundary", *row));
    for (kind, row) in shapes.chain([("region", ShapeRow::of::<mesh::Keys>())]) {
        keys.extend(row.files.iter().map(|key| (kind, format!("{}.{key}", row.key))));
    }
    let mut files = Vec::new();
    for (kind, key) in keys {
        for name in document.names(kind) {
            let table = format!("{kind}.{name}");
            for file in document.texts(&format!("{table}.{key}")) {
                files.push((table.clone(), key.clone(), file.to_owned()));
            }
        }
    }
    for (kind, key) in [("boundary", "motion.prescribed"), ("fluid", "velocity.prescribed")] {
        for name in document.names(kind) {
            let table = format!("{kind}.{name}");
            for axis in AxisMotion::WORDS {
                // A rotation is a quoted key.
                let quoted = if axis.contains('.') { format!("\"{axis}\"") } else { axis.to_owned() };
                let law = format!("{table}.{key}.{quoted}.table");
                if let Some(file) = document.text(&law).or_else(|| document.text(&format!("{law}.file"))) {
                    files.push((table.clone(), key.to_owned(), file.to_owned()));
                }
            }
        }
    }
    files
}

impl RawTables {
    /// Reads all tables; `None` if any has a mistake.
    pub(super) fn read(document: &Document, models: &Models, faults: &mut Faults) -> Option<Self> {
        unknown_tables(document, faults);
        let about = document.read("about", faults);
        let run = document.read("run", faults);
        let gravity = match document.has("gravity") {
            true => document.read_key("", "gravity", faults),
            false => Some(Triple::default()),
        };
        let count = document.names("material").len();
        if count > MOST_MATERIALS {
            let (found, expected) = (format!("{count}"), format!("at most {MOST_MATERIALS} materials"));
            faults.add("material", "", Mistake::Unexpected { found, expected });
            return None;
        }
        let materials = properties::materials(document, &models.material_properties(), faults);
        let pairs = pairs(document, &models.pair_properties(), faults);
        let contacts = laws(document, models, faults);
        let bonds = bonds(document, models, faults);
        let clumps = all(document, "clump", faults);
        let particles = columns::particles(document, &models.columns, faults);
        let boundaries = boundaries(document, models, faults);
        let damping = all(document, "damping", faults);
        let forces = all(document, "force", faults);
        let heat = document.read("heat", faults);
        let heat_sources = all(document, "heat_source", faults);
        let fluid = fluid(document, models, faults);
        let regions = all(document, "region", faults);
        let grids = all(document, "grid", faults);
        let insertions = columns::insertions(document, &models.columns, faults);
        let outlets = all(document, "outlet", faults);
        let meters = all(document, "flow_meter", faults);
        let domain = document.has("domain").then(|| document.read("domain", faults));
        let cell = document.has("cell").then(|| document.read("cell", faults)).flatten();
        let output = document.read("output", faults);
        let probes = all(document, "probe", faults);
        let derived = all(document, "derived", faults);
        if faults.count() > 0 {
            return None;
        }
        let (about, run, gravity, heat, output) = (about?, run?, gravity?, heat?, output?);
        let domain = domain.flatten();
        Some(Self {
            about,
            run,
            gravity,
            materials,
            pairs,
            contacts,
            bonds,
            clumps,
            particles,
            boundaries,
            columns: models.columns.clone(),
            hints: models.shapes.iter().map(|row| row.hint).collect(),
            damping,
            forces,
            heat,
            heat_sources,
            fluid,
            regions,
            grids,
            insertions,
            outlets,
            meters,
            domain,
            cell,
            output,
            probes,
            derived,
        })
    }
}

/// Reports tables and keys at the top that have no meaning.
fn unknown_tables(document: &Document, faults: &mut Faults) {
    for name in document.names("") {
        if TABLES.contains(&name.as_str()) {
            continue;
        }
        let known = TABLES.map(str::to_owned).to_vec();
        let mistake = messages::absent(&name).unwrap_or(match document.is_table_below("", &name) {
            true => Mistake::UnknownTable { found: name.clone(), known },
            false => Mistake::UnknownKey { found: name.clone(), known },
        });
        let line = document.line_of_name("", &name);
        match document.is_table_below("", &name) {
            true => faults.at_line(line, &name, "", mistake),
            false => faults.at_line(line, "", &name, mistake),
        }
    }
}

/// All properties of pairs; both orders of one pair must say the same.
fn pairs(document: &Document, keys: &[&'static Property], faults: &mut Faults) -> Vec<([String; 2], Properties)> {
    let mut pairs: Vec<([String; 2], Properties)> = Vec::new();
    let mut known: BTreeMap<[String; 2], usize> = BTreeMap::new();
    for a in names(document, "pair", faults) {
        for b in names(document, &format!("pair.{a}"), faults) {
            let Some(properties) = properties::of_pair(document, &format!("pair.{a}.{b}"), keys, faults) else {
                continue;
            };
            let mirrored = [b.clone(), a.clone()];
            match known.get(&mirrored) {
                Some(place) if pairs[*place].1 != properties => asymmetric(document, &a, &b, faults),
                Some(_) => {}
                None => {
                    known.insert([a.clone(), b.clone()], pairs.len());
                    pairs.push(([a.clone(), b], properties));
                }
            }
        }
    }
    pairs
}

/// Reports each key in which `[pair.<a>.<b>]` differs from `[pair.<b>.<a>]`.
fn asymmetric(document: &Document, a: &str, b: &str, faults: &mut Faults) {
    let (here, there) = (format!("pair.{a}.{b}"), format!("pair.{b}.{a}"));
    let value = |table: &str, key: &str| match document.written(&format!("{table}.{key}")) {
        "" => "nothing".to_owned(),
        value => value.to_owned(),
    };
    let number = |text: &str| text.replace('_', "").parse::<f64>().ok();
    let mut keys = document.names(&here);
    keys.extend(document.names(&there).into_iter().filter(|key| !document.has(&format!("{here}.{key}"))));
    for key in keys {
        let (found, other) = (value(&here, &key), value(&there, &key));
        if number(&found).is_none() || number(&found) != number(&other) {
            faults.add(&here, &key, Mistake::Asymmetric { found, other, table: there.clone() });
        }
    }
}

/// All contact laws.
fn laws(document: &Document, models: &Models, faults: &mut Faults) -> Named<Law> {
    let mut laws = Vec::new();
    for name in names(document, "contact", faults) {
        let path = format!("contact.{name}");
        let table = document.read(&path, faults);
        let normal = model(document, &path, "normal", &models.normal, faults);
        if table.is_some() && !document.has(&format!("{path}.normal")) {
            let expected = format!("a table [{path}.normal.<model>]");
            faults.add(&path, "normal", Mistake::Missing { expected });
        }
        let tangential = model(document, &path, "tangential", &models.tangential, faults);
        let rolling = model(document, &path, "rolling", &models.rolling, faults);
        let cohesion = model(document, &path, "cohesion", &models.cohesion, faults);
        let heat = model(document, &path, "heat", &models.heat, faults);
        if let (Some(table), Some(normal)) = (table, normal) {
            let law = Law {
                table,
                normal,
                tangential: tangential.unwrap_or(SMOOTH),
                rolling: rolling.unwrap_or(ROLLING_FREELY),
                cohesion: cohesion.unwrap_or(DRY),
                heat,
            };
            laws.push((name, law));
        }
    }
    laws
}

/// All bond laws.
fn bonds(document: &Document, models: &Models, faults: &mut Faults) -> Named<Keys> {
    let mut bonds = Vec::new();
    for name in names(document, "bond", faults) {
        let path = format!("bond.{name}");
        let keys: Option<Keys> = document.read_part(&path, "", Part::Except(&["breakage"]), faults);
        let breakage = breakage(document, &path, models, faults);
        bonds.extend(keys.map(|keys| (name, Keys { breakage, ..keys })));
    }
    bonds
}

/// The rules of breakage of a bond law.
fn breakage(document: &Document, bond: &str, models: &Models, faults: &mut Faults) -> Vec<BreakageChoice> {
    let (path, before) = (format!("{bond}.breakage"), faults.count());
    if !document.has(&path) {
        return Vec::new();
    }
    let known: Vec<&str> = models.breakage.iter().flat_map(|row| row.keys()).copied().collect();
    document.read_part::<NoKeys>(bond, "breakage", Part::Except(&known), faults);
    let mut rules = Vec::new();
    for row in &models.breakage {
        if row.keys().iter().any(|key| document.has(&format!("{path}.{key}"))) {
            rules.extend(row.read(document, bond, faults));
        }
    }
    if rules.is_empty() && faults.count() == before {
        let limits: Vec<&str> = models.breakage.iter().flat_map(|row| row.limits()).copied().collect();
        let message = format!("expected {} or no table, found no limit", limits.join(", "));
        faults.add(bond, "breakage", Mistake::Refused { message });
    }
    rules
}

/// All boundaries.
fn boundaries(document: &Document, models: &Models, faults: &mut Faults) -> Named<BoundaryTable> {
    let known: Vec<&str> = models.shapes.iter().map(|row| row.key).chain(["wear"]).collect();
    let mut boundaries = Vec::new();
    for name in names(document, "boundary", faults) {
        let path = format!("boundary.{name}");
        let table: Option<BoundaryTable> = document.read_part(&path, "", Part::Except(&known), faults);
        let there = models.shapes.iter().filter(|row| document.has(&format!("{path}.{}", row.key)));
        let shapes = there.filter_map(|row| Some((*row, (row.read)(document, &path, faults)?))).collect();
        let wear = wear(document, &path, models, faults);
        boundaries.extend(table.map(|table| (name, BoundaryTable { shapes, wear, ..table })));
    }
    boundaries
}

/// `[fluid.<name>]` as it is written.
pub(super) struct FluidTables {
    /// Its name.
    pub(super) name: String,
    /// Its keys.
    pub(super) keys: FluidTable,
    /// The law of its drag.
    pub(super) drag: DragModel,
    /// The laws of its lift.
    pub(super) lift: Vec<LiftModel>,
    /// The law of its convection, if heat flows into it.
    pub(super) convection: Option<ConvectionModel>,
}

/// The fluid, if there is one.
fn fluid(document: &Document, models: &Models, faults: &mut Faults) -> Option<FluidTables> {
    let names = names(document, "fluid", faults);
    if names.len() > 1 {
        let (found, expected) = (names.join(" and "), "one fluid: two would overlap".to_owned());
        faults.add(&format!("fluid.{}", names[1]), "", Mistake::Unexpected { found, expected });
        return None;
    }
    let name = names.into_iter().next()?;
    let path = format!("fluid.{name}");
    let table = document.read(&path, faults);
    let there = |kind: &str| document.has(&format!("{path}.{kind}"));
    let drag = one_law(document, (&path, "drag"), &models.drag, faults)?;
    let lift = if there("lift") { laws_of_fluid(document, (&path, "lift"), &models.lift, faults)? } else { Vec::new() };
    let convects = there("heat");
    let convection =
        if convects { Some(one_law(document, (&path, "heat"), &models.convection, faults)?) } else { None };
    Some(FluidTables { name, keys: table?, drag, lift, convection })
}

/// The one law of a kind that a fluid names.
fn one_law<F: ?Sized>(
    document: &Document,
    (path, kind): (&str, &'static str),
    rows: &[&'static LawRow<F>],
    faults: &mut Faults,
) -> Option<LawModel<F>> {
    let laws = laws_of_fluid(document, (path, kind), rows, faults)?;
    let [law] = laws[..] else {
        let found = laws.iter().map(LawModel::name).collect::<Vec<_>>().join(" and ");
        faults.add(&format!("{path}.{kind}"), "", Mistake::Unexpected { found, expected: format!("one {kind} law") });
        return None;
    };
    Some(law)
}

/// The laws of a kind that a fluid names, one at least.
fn laws_of_fluid<F: ?Sized>(
    document: &Document,
    (path, kind): (&str, &'static str),
    rows: &[&'static LawRow<F>],
    faults: &mut Faults,
) -> Option<Vec<LawModel<F>>> {
    let laws = format!("{path}.{kind}");
    if !document.is_table(&laws) {
        let expected = format!("a table [{laws}.<law>]");
        let mistake = match document.has(&laws) {
            true => Mistake::Unexpected { found: document.written(&laws).to_owned(), expected },
            false => Mistake::Missing { expected },
        };
        faults.add(path, kind, mistake);
        return None;
    }
    let chosen = document.names(&laws);
    if chosen.is_empty() {
        let (found, expected) = ("none".to_owned(), format!("one {kind} law"));
        faults.add(&laws, "", Mistake::Unexpected { found, expected });
        return None;
    }
    let mut models = Vec::new();
    for law in chosen {
        let Some(row) = rows.iter().find(|row| row.name() == law) else {
            let known = rows.iter().map(|row| row.name().to_owned()).collect();
            faults.add(&format!("{laws}.{law}"), "", Mistake::UnknownModel { found: law, kind, known });
            return None;
        };
        models.push(row.read(document, &laws, faults)?);
    }
    Some(models)
}

/// The models of wear of a boundary.
fn wear(document: &Document, boundary: &str, models: &Models, faults: &mut Faults) -> Vec<WearModel> {
    let path = format!("{boundary}.wear");
    if !document.has(&path) {
        return Vec::new();
    }
    let names = if document.is_table(&path) { document.names(&path) } else { Vec::new() };
    if names.is_empty() {
        let found = if document.is_table(&path) { "no model" } else { document.written(&path) };
        let expected = format!("a table [{path}.<model>]");
        faults.add(boundary, "wear", Mistake::Unexpected { found: found.to_owned(), expected });
    }
    let read = |name: &String| {
        let Some(row) = models.wear.iter().find(|row| row.name() == name) else {
            let known = models.wear.iter().map(|row| row.name().to_owned()).collect();
            let mistake = Mistake::UnknownModel { found: name.clone(), kind: "wear", known };
            faults.add(&format!("{path}.{name}"), "", mistake);
            return None;
        };
        row.read(document, &path, faults)
    };
    names.iter().filter_map(read).collect()
}

/// The sub-model of a kind, if the law names one.
fn model<F>(
    document: &Document,
    law: &str,
    kind: &'static str,
    known: &[&'static ModelRow<F>],
    faults: &mut Faults,
) -> Option<Model<F>> {
    let path = format!("{law}.{kind}");
    if !document.has(&path) {
        return None;
    }
    if !document.is_table(&path) {
        let (found, expected) = (document.written(&path).to_owned(), format!("a table [{path}.<model>]"));
        faults.add(law, kind, Mistake::Unexpected { found, expected });
        return None;
    }
    let models = document.names(&path);
    let [name] = &models[..] else {
        let found = if models.is_empty() { "no model".to_owned() } else { models.join(" and ") };
        faults.add(&path, "", Mistake::Unexpected { found, expected: format!("one {kind} model") });
        return None;
    };
    let Some(row) = known.iter().find(|row| row.name() == name) else {
        let known = known.iter().map(|row| row.name().to_owned()).collect();
        let unknown = || Mistake::UnknownModel { found: name.clone(), kind, known };
        faults.add(&format!("{path}.{name}"), "", messages::absent(name).unwrap_or_else(unknown));
        return None;
    };
    row.read(document, &path, faults)
}
