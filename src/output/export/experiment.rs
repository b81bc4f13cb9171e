//! The reference experiment: a few communication steps from the beginning, by which an importer checks itself.
//!
//! It stands in the unit as the layered standard FMI-LS-REF has it: tables of inputs and results, and a manifest that says what they
//! are.

use super::resources::Resource;
use crate::engine::simulation::{RunError, Simulation};
use crate::interface::{Causality, Findings, Interface};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;

/// The folder that the layered standard asks for.
const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";

/// Number of its communication steps.
const STEPS: usize = 10;

/// How many time steps of one particle it may take: a second or so.
const WORK: usize = 5_000_000;

/// Most time steps in a communication step.
const LONGEST: usize = 100;

/// As many particles cost as much as everything else in a time step of a small scene.
const SMALL: usize = 1000;

/// What stands in the tables.
pub(super) struct Experiment {
    /// Inputs at the communication points.
    inputs: String,
    /// Outputs there.
    results: String,
}

impl Experiment {
    /// Runs it: all inputs keep their start values. The simulation is used up.
    pub(super) fn run(mut simulation: Simulation, interface: &Interface) -> Result<Self, RunError> {
        let particles = simulation.state().particles.len();
        let count = (WORK / (STEPS * (particles + SMALL))).clamp(1, LONGEST);
        let step = simulation.state().clock.step * count as f64;
        let inputs: Vec<_> = interface.inputs().map(|(_, variable)| variable).collect();
        let recorded = || interface.recorded().filter(|(_, variable)| variable.causality == Causality::Output);
        let outputs: Vec<_> = recorded().map(|(index, _)| index).collect();
        let line = |time: f64, values: &mut dyn Iterator<Item = String>| {
            let mut line = format!("{time:?}");
            values.for_each(|value| line.extend([",", &value]));
            line + "\n"
        };
        let heading = |names: &mut dyn Iterator<Item = &str>| {
            let mut line = "time".to_owned();
            names.for_each(|name| line.extend([",", name]));
            line + "\n"
        };
        let mut experiment = Self {
            inputs: heading(&mut inputs.iter().map(|variable| variable.name.as_str())),
            results: heading(&mut recorded().map(|(_, variable)| variable.name.as_str())),
        };
        for point in 0..=STEPS {
            if point > 0 {
                simulation.advance(step)?;
            }
            let (time, found) = (step * point as f64, Findings::default());
            let starts = &mut inputs.iter().map(|variable| format!("{:?}", variable.start.unwrap_or(0.0)));
            experiment.inputs += &line(time, starts);
            let read = |index: &usize| interface.value_with(&simulation, &found, *index).to_string();
            experiment.results += &line(time, &mut outputs.iter().map(read));
        }
        Ok(experiment)
    }

    /// The manifest, the tables, and how they are used.
    pub(super) fn files(self) -> io::Result<Vec<Resource>> {
        let files = [
            ("fmi-ls-manifest.xml", manifest()?),
            ("inputs.csv", self.inputs.into_bytes()),
            ("results.csv", self.results.into_bytes()),
        ];
        let mut files: Vec<_> = files.map(|(name, bytes)| Resource::new(name, bytes).inside(FOLDER)).into();
        files.push(Resource::new("documentation/fmi-ls-ref.txt", HOW.to_owned()));
        Ok(files)
    }
}

/// How the experiment is repeated, where the layered standard asks for such words.
const HOW: &str = "\
A short experiment, by which an importer sees that it steps this unit rightly.

../extra/org.fmi-standard.fmi-ls-ref/inputs.csv   inputs at the communication points
../extra/org.fmi-standard.fmi-ls-ref/results.csv  outputs there

Parameters keep their start values. Set the inputs of the first row before the end of the initialisation mode; the outputs are
then those of the first row of the results. For each further row set its inputs, step to its time, and read the outputs. They
are the same to the last digit, on every platform and for any number of threads, if the communication steps are as long as the
first one.
";

/// What the manifest names: kind, place, role, and what it is.
const RELATED: [[&str; 4]; 4] = [
    ["text/csv", "inputs.csv", "experiment/smoke-test", "inputs at the communication points of a short experiment"],
    ["text/csv", "results.csv", "result", "outputs at these points"],
    ["application/toml", "../../resources/scene.toml", "model", "the scene that the unit computes"],
    ["text/html", "../../documentation/index.html", "document", "what to set, what to read, and how"],
];

/// `fmi-ls-manifest.xml`
fn manifest() -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element("fmiReferences")
        .with_attributes([
            ("xmlns:fmi-ls", "http://fmi-standard.org/fmi-ls-manifest"),
            ("fmi-ls:fmi-ls-name", "org.fmi-standard.fmi-ls-ref"),
            ("fmi-ls:fmi-ls-version", "1.0.0-alpha.1"),
            (
                "fmi-ls:fmi-ls-description",
                "Layered Standard providing information on related files included in an FMU.",
            ),
        ])
        .write_inner_content(|xml| {
            for [kind, source, role, description] in RELATED {
                xml.create_element("Related")
                    .with_attributes([("type", kind), ("source", source), ("role", role), ("description", description)])
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(xml.into_inner())
}
