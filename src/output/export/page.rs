//! `documentation/index.html`: what the unit is and how it is used, for people.

use super::description::{Model, about, communication_step};
use crate::engine::simulation::Simulation;
use crate::interface::{Causality, Standard, Variability, Variable};
use crate::scene::{Boundary, Grid, Scene, Source, Step};
use quick_xml::escape::escape;
use std::fmt::Write;

/// What the page tells of.
pub(super) struct Page<'a> {
    /// The unit.
    pub(super) model: &'a Model<'a>,
    /// Its text and files.
    pub(super) source: &'a Source,
    /// The platforms that the unit has libraries for.
    pub(super) platforms: &'a [&'a str],
    /// What [`steps`] says.
    pub(super) steps: String,
    /// Whether it has a picture.
    pub(super) has_picture: bool,
    /// Whether it begins in a state of its own.
    pub(super) has_state: bool,
    /// Whether it has a reference experiment.
    pub(super) has_experiment: bool,
}

/// Where the picture stands in the unit.
pub(super) fn picture(standard: Standard) -> &'static str {
    match standard {
        Standard::Fmi2 => "model.png",
        Standard::Fmi3 => "terminalsAndIcons/icon.png",
    }
}

/// How the page looks.
const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}\
    table{border-collapse:collapse}td,th{border-bottom:1px solid #ccc;padding:.2em .7em;text-align:left;vertical-align:top}\
    pre{background:#f4f4f4;padding:1em;overflow:auto}img{max-width:100%}";

/// How a master uses the unit, and the signs that it needs.
const USE: &str = "<h2>How to step it</h2>\n<ol>\n\
    <li>Set the inputs: what holds at the <em>end</em> of the next communication step. A displacement is reached there at constant \
    velocity; setting it changes no output before. A value set before the end of the initialisation mode is taken without motion.</li>\n\
    <li>Call <code>fmi2DoStep</code>.</li>\n\
    <li>Read the outputs.</li>\n</ol>\n\
    <p><strong>Signs.</strong> Forces and moments are those of the particles on the boundary: a bed that rests on a floor whose normal \
    points up gives a negative <code>force.z</code>. Moments are taken about the boundary's moved reference point, in global axes. Over \
    each communication step the change of <code>work</code> is &minus;<code>mean_force</code> times the change of displacement: a master \
    that moves its own side by <code>mean_force</code> exchanges exactly that energy.</p>\n\
    <p>States can be saved and restored, so a master may repeat a step until both sides agree. A step that fails returns \
    <code>fmi2Discard</code> and leaves the state of its beginning; the logger gets the reason.</p>\n";

/// How the variables below are those of FMI 3.0.
const ARRAYS: &str = "<p><strong>Arrays.</strong> Components that stand in one row below are one array where all are there: \
    <code>floor.force.x, .y, .z</code> is <code>floor.force</code> with three elements, <code>skin.node[1].force.x</code> and what \
    follows it <code>skin.node.force</code> with a row for each node.</p>\n";

impl Page<'_> {
    /// The page.
    pub(super) fn write(&self) -> String {
        let Self { model, .. } = self;
        let picture = if self.has_picture {
            let file = picture(model.standard);
            format!("<p><img src=\"../{file}\" alt=\"the particles and boundaries at the start\"></p>\n")
        } else {
            String::new()
        };
        let (usage, arrays) = match model.standard {
            Standard::Fmi2 => (USE.to_owned(), ""),
            Standard::Fmi3 => (USE.replace("fmi2", "fmi3"), ARRAYS),
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title><style>{STYLE}</style></head>\n\
             <body>\n<h1>{name}</h1>\n<p>{about}.</p>\n{picture}{facts}{usage}{arrays}{steps}\
             <h2>What to set</h2>\n{inputs}<h2>What to read</h2>\n{outputs}{elements}\
             <h2>Parameters</h2>\n<p>Fixed ones before the end of the initialisation mode, tunable ones also between steps.</p>\n{parameters}\
             {origin}</body>\n</html>\n",
            name = escape(model.identifier),
            about = escape(about(model.scene).trim_end_matches('.')),
            facts = self.facts(),
            steps = self.steps,
            inputs = self.table(Causality::Input),
            outputs = self.table(Causality::Output),
            parameters = self.table(Causality::Parameter),
            elements = elements(model.scene),
            origin = self.origin(),
        )
    }

    /// What made the unit, and which edition of the standard it speaks.
    fn made_by(&self) -> String {
        let edition = match self.model.standard {
            Standard::Fmi2 => "2.0",
            Standard::Fmi3 => "3.0",
        };
        format!("cograin {}, FMI {edition} co-simulation", env!("CARGO_PKG_VERSION"))
    }

    /// What the unit is, in a table.
    fn facts(&self) -> String {
        let scene = self.model.scene;
        let stated = [
            ("author", scene.about.author.clone()),
            ("version", scene.about.version.clone()),
            ("licence of the model", scene.about.license.clone()),
            ("copyright", scene.about.copyright.clone()),
            ("particles", Some(scene.particles.len().to_string())),
            ("boundaries", Some(list(scene.boundaries.iter().map(|boundary| boundary.name.as_str())))),
            ("platforms", Some(list(self.platforms.iter().copied()))),
            ("made by", Some(self.made_by())),
            ("GUID", Some(self.model.identity.to_owned())),
        ];
        let mut rows = String::new();
        for (name, text) in stated {
            if let Some(text) = text.filter(|text| !text.is_empty()) {
                // writing to a string does not fail
                let _ = writeln!(rows, "<tr><td>{name}</td><td>{}</td></tr>", escape(&text));
            }
        }
        format!("<table>\n{rows}</table>\n")
    }

    /// The variables of one causality, those of nodes and cells of grids once, and components of one quantity in one row.
    fn table(&self, causality: Causality) -> String {
        let shown = |variable: &&Variable| variable.element().is_none_or(|element| element == 0);
        let variables: Vec<&Variable> =
            self.model.interface.of_causality(causality).map(|(_, variable)| variable).filter(shown).collect();
        if variables.is_empty() {
            return "<p>None.</p>\n".to_owned();
        }
        let has_start = causality != Causality::Output;
        let start = if has_start { "<th>start</th>" } else { "" };
        let mut rows = format!("<tr><th>variable</th><th>unit</th>{start}<th>meaning</th></tr>\n");
        for (variables, meaning) in together(&variables) {
            let variable = variables[0];
            let mut names = format!("<code>{}</code>", escape(variable.name.as_str()));
            for more in &variables[1..] {
                let _ = write!(names, ", <code>.{}</code>", escape(component(more).1));
            }
            let start = variable.start.map(number).or(variable.start_text().map(str::to_owned));
            let start =
                if has_start { format!("<td>{}</td>", escape(start.unwrap_or_default())) } else { String::new() };
            let tunable = causality == Causality::Parameter && variable.variability == Variability::Tunable;
            let _ = writeln!(
                rows,
                "<tr><td>{names}</td><td>{}</td>{start}<td>{}{}{}</td></tr>",
                escape(variable.quantity.unit().unwrap_or("")),
                escape(meaning),
                escape(range(variable)),
                if tunable { "; tunable" } else { "" },
            );
        }
        format!("<table>\n{rows}</table>\n")
    }

    /// Where the unit came from and what else is in it.
    fn origin(&self) -> String {
        let files: Vec<String> =
            self.source.files.iter().map(|(name, bytes)| format!("{name} ({} bytes)", bytes.len())).collect();
        let files = if files.is_empty() {
            String::new()
        } else {
            format!(" It reads {}.", list(files.iter().map(String::as_str)))
        };
        let state = if self.has_state {
            " The unit begins in a state that was computed before: <code>resources/state.bin</code>."
        } else {
            ""
        };
        let experiment = if self.has_experiment {
            " A short experiment shows an importer whether it steps the unit rightly: \
             <a href=\"fmi-ls-ref.txt\">fmi-ls-ref.txt</a>."
        } else {
            ""
        };
        format!(
            "<h2>Where it came from</h2>\n<p>The scene, <code>resources/scene.toml</code>, as it was packaged.{}{state}{experiment} \
             Licences: <a href=\"licenses/license.txt\">licenses/license.txt</a>.</p>\n<pre>{}</pre>\n",
            escape(&files),
            escape(&self.source.text),
        )
    }
}

/// What is known of lengths of steps.
pub(super) fn steps(scene: &Scene, simulation: &Simulation) -> String {
    let (limit, step) = (simulation.limit(), simulation.state().clock.step);
    let by = limit.by.map_or_else(String::new, |by| format!(" ({})", simulation.words(&by)));
    let chosen = match scene.run.step {
        Step::Automatic { .. } | Step::Following => "chosen by the unit, which follows the stable one",
        Step::Given(_) => "given by the scene",
    };
    let stable = if limit.safe.is_finite() {
        format!("; the stable one is {:.3e} s at the start{by}", limit.safe)
    } else {
        String::new()
    };
    let suggested = communication_step(scene).map_or_else(String::new, |suggested| {
        format!(" The default experiment takes communication steps of {suggested:.3e} s.")
    });
    format!(
        "<h2>How long steps may be</h2>\n<p>Time step inside: {step:.3e} s, {chosen}{}. A communication step may have any \
         length; whole multiples of a given time step keep every bit.{suggested} How long it may be for a coupled \
         structure follows from both sides: an explicit exchange diverges where a light structure meets a stiff packing.</p>\n",
        escape(&stable),
    )
}

/// Words, one after the other.
fn list<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.collect::<Vec<_>>().join(", ")
}

/// Name of a variable up to its last dot, and what stands behind.
fn component(variable: &Variable) -> (&str, &str) {
    variable.name.rsplit_once('.').unwrap_or(("", &variable.name))
}

/// Variables in a row that are components of one quantity, and what they are: the words of the first, with all components in place of
/// its own.
fn together<'a>(variables: &[&'a Variable]) -> Vec<(Vec<&'a Variable>, String)> {
    /// In place of a component.
    const HERE: &str = "\u{fffc}";
    let meaning = |variable: &Variable| {
        let own = component(variable).1;
        let words = variable.description.split(' ').map(|word| match word.trim_end_matches([',', ';', ':']) {
            stem if stem == own => format!("{HERE}{}", &word[stem.len()..]),
            _ => word.to_owned(),
        });
        words.collect::<Vec<_>>().join(" ")
    };
    let shared = |variable: &Variable| {
        let words = meaning(variable);
        let stem = if words.contains(HERE) { component(variable).0 } else { variable.name.as_str() };
        (stem.to_owned(), words, variable.start)
    };
    let groups = variables.chunk_by(|one, other| shared(one) == shared(other));
    let all = |group: &[&Variable]| list(group.iter().map(|variable| component(variable).1));
    groups.map(|group| (group.to_vec(), meaning(group[0]).replace(HERE, &all(group)))).collect()
}

/// A number as people write it.
fn number(value: f64) -> String {
    let usual = value == 0.0 || (1e-3..1e5).contains(&value.abs());
    if usual { value.to_string() } else { format!("{value:e}") }
}

/// Between which bounds a variable is; where 0 or a maximum itself is not allowed, the bound is the number next to it.
fn range(variable: &Variable) -> String {
    let above = variable.minimum.map(|minimum| match minimum {
        f64::MIN_POSITIVE => "above 0".to_owned(),
        _ => format!("at least {}", number(minimum)),
    });
    let below = variable.maximum.map(|maximum| match maximum.next_up() {
        next if next == next.round() && maximum != maximum.round() => format!("below {}", number(next)),
        _ => format!("at most {}", number(maximum)),
    });
    match [above, below] {
        [None, None] => String::new(),
        [Some(bound), None] | [None, Some(bound)] => format!("; {bound}"),
        [Some(above), Some(below)] => format!("; {above}, {below}"),
    }
}

/// What is said of meshes whose nodes the outside moves and of grids.
fn elements(scene: &Scene) -> String {
    let meshes = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0);
    let line = |mesh: &Boundary| {
        format!(
            "<p><code>{name}</code> has {count} nodes, of which the tables show the first; <code>resources/{name}.nodes.csv</code> has \
             their numbers and places, <code>resources/{name}.triangles.csv</code> the triangles between them.</p>\n",
            name = mesh.name,
            count = mesh.driven_nodes()
        )
    };
    let grid = |grid: &Grid| {
        let ([nx, ny, nz], name) = (grid.shape.counts, &grid.name);
        format!(
            "<p><code>{name}</code> has {nx} × {ny} × {nz} cells, of which the tables show the first; <code>resources/{name}.cells.csv</code> has \
             their numbers, centres and volumes.</p>\n"
        )
    };
    meshes.map(line).chain(scene.grids.iter().map(grid)).collect()
}
