//! `modelDescription.xml`, from the interface alone: what both editions of the standard share, and FMI 2.0.

mod arrays;
mod scales;

use crate::interface::{Causality, Interface, Quantity, Standard, Type, Variability, Variable};
use crate::scene::Scene;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use scales::Scales;
use std::collections::BTreeMap;
use std::io;

/// What is described.
pub(super) struct Model<'a> {
    /// Name of the unit and its library.
    pub(super) identifier: &'a str,
    /// The unit's GUID.
    pub(super) identity: &'a str,
    /// The edition of the standard that it speaks.
    pub(super) standard: Standard,
    /// The scene.
    pub(super) scene: &'a Scene,
    /// Its variables.
    pub(super) interface: &'a Interface,
}

/// What the library can do, as `fmu/` does it; what is not named here is `false` or 0.
const CAPABILITIES: [(&str, &str); 5] = [
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canInterpolateInputs", "true"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "true"),
    ("canSerializeFMUstate", "true"),
];

/// The same by the names of FMI 3.0, which has no input derivatives.
const CAPABILITIES_3: [(&str, &str); 3] = [
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canGetAndSetFMUState", "true"),
    ("canSerializeFMUState", "true"),
];

/// Categories of messages, with what they are.
pub const LOG_CATEGORIES: [(&str, &str); 5] = [
    ("logAll", "everything below"),
    ("logStatusError", "refused calls; always reported"),
    ("logStatusDiscard", "communication steps that failed; always reported"),
    ("logStatusWarning", "frames that could not be written; always reported"),
    ("logEvents", "instances made and started, steps done"),
];

/// The writer of the description.
pub(super) type Xml = Writer<Vec<u8>>;

/// The whole file. Elements stand in the order that the standard's schema demands.
pub(super) fn write(model: &Model<'_>) -> io::Result<Vec<u8>> {
    let mut xml = new_xml()?;
    let (sentence, about) = (about(model.scene), &model.scene.about);
    let told = [
        ("author", &about.author),
        ("version", &about.version),
        ("copyright", &about.copyright),
        ("license", &about.license),
    ];
    let (version, identity) = match model.standard {
        Standard::Fmi2 => ("2.0", "guid"),
        Standard::Fmi3 => ("3.0", "instantiationToken"),
    };
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", version),
            ("modelName", model.identifier),
            (identity, model.identity),
            ("description", sentence.as_str()),
            ("generationTool", concat!("cograin ", env!("CARGO_PKG_VERSION"))),
            ("variableNamingConvention", "structured"),
        ])
        .with_attributes(told.into_iter().filter_map(|(name, text)| Some((name, text.as_deref()?))))
        .write_inner_content(|xml| {
            capabilities(xml, model)?;
            units(xml, model.interface)?;
            xml.create_element("LogCategories").write_inner_content(|xml| {
                for (name, description) in LOG_CATEGORIES {
                    xml.create_element("Category")
                        .with_attributes([("name", name), ("description", description)])
                        .write_empty()?;
                }
                Ok(())
            })?;
            default_experiment(xml, model.scene)?;
            match model.standard {
                Standard::Fmi2 => scalars(xml, model),
                Standard::Fmi3 => arrays::write(xml, model),
            }
        })?;
    Ok(xml.into_inner())
}

/// A writer that has written the declaration of XML.
pub(super) fn new_xml() -> io::Result<Xml> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    Ok(xml)
}

/// `CoSimulation`
fn capabilities(xml: &mut Xml, model: &Model<'_>) -> io::Result<()> {
    let (capabilities, derivatives): (&[_], _) = match model.standard {
        Standard::Fmi2 => (&CAPABILITIES, "providesDirectionalDerivative"),
        Standard::Fmi3 => (&CAPABILITIES_3, "providesDirectionalDerivatives"),
    };
    xml.create_element("CoSimulation")
        .with_attribute(("modelIdentifier", model.identifier))
        .with_attributes(capabilities.iter().copied())
        .with_attribute(("maxOutputDerivativeOrder", if model.interface.has_rates() { "1" } else { "0" }))
        .with_attribute((derivatives, if model.interface.has_derivatives() { "true" } else { "false" }))
        .write_empty()?;
    Ok(())
}

/// `ModelVariables` and `ModelStructure` of FMI 2.0.
fn scalars(xml: &mut Xml, model: &Model<'_>) -> io::Result<()> {
    let scales = Scales::of(model.scene);
    let variables = model.interface.variables();
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        variables.iter().enumerate().try_for_each(|(index, it)| variable(xml, index, it, &scales))
    })?;
    structure(xml, model)
}

/// One line about the scene.
pub(super) fn about(scene: &Scene) -> String {
    if let Some(description) = &scene.about.description {
        return description.clone();
    }
    format!("{} spheres and {} boundaries, discrete element method", scene.particles.len(), scene.boundaries.len())
}

/// `UnitDefinitions`: the units of the table, each once.
fn units(xml: &mut Xml, interface: &Interface) -> io::Result<()> {
    let quantities = interface.variables().iter().map(|variable| variable.quantity);
    let units: BTreeMap<&str, Quantity> =
        quantities.filter_map(|quantity| Some((quantity.unit()?, quantity))).collect();
    xml.create_element("UnitDefinitions").write_inner_content(|xml| {
        for (name, quantity) in &units {
            let base = quantity.base_units();
            let exponents = [
                ("kg", base.kilogram),
                ("m", base.metre),
                ("s", base.second),
                ("K", base.kelvin),
                ("rad", base.radian),
            ]
            .map(|(symbol, exponent)| (symbol, exponent.to_string()));
            let present = exponents.iter().filter(|(_, exponent)| exponent != "0");
            xml.create_element("Unit").with_attribute(("name", *name)).write_inner_content(|xml| {
                xml.create_element("BaseUnit")
                    .with_attributes(present.map(|(symbol, exponent)| (*symbol, exponent.as_str())))
                    .write_empty()?;
                if let Some((name, factor)) = shown_in(*quantity) {
                    xml.create_element("DisplayUnit")
                        .with_attributes([("name", name), ("factor", format!("{factor:?}").as_str())])
                        .write_empty()?;
                }
                Ok(())
            })?;
        }
        Ok(())
    })?;
    Ok(())
}

/// The unit that people read such a quantity in, if it is another one: how many of it are in one of the quantity's own.
fn shown_in(quantity: Quantity) -> Option<(&'static str, f64)> {
    match quantity {
        Quantity::Length => Some(("mm", 1000.0)),
        Quantity::Angle => Some(("deg", 1.0_f64.to_degrees())),
        Quantity::AngularVelocity => Some(("deg/s", 1.0_f64.to_degrees())),
        _ => None,
    }
}

/// Communication steps of a scene that names an end and no interval.
const STEPS: f64 = 100.0;

/// The communication step that a scene suggests \[s\]: that of its run.
pub(super) fn communication_step(scene: &Scene) -> Option<f64> {
    scene.output.history_interval.or(scene.run.end.map(|end| end / STEPS))
}

/// `DefaultExperiment`: from 0 to the scene's end, in the steps of its run.
fn default_experiment(xml: &mut Xml, scene: &Scene) -> io::Result<()> {
    let [stop, step] = [scene.run.end, communication_step(scene)].map(|time| time.map(|time| format!("{time:?}")));
    let times = [
        Some(("startTime", "0.0")),
        stop.as_ref().map(|stop| ("stopTime", stop.as_str())),
        step.as_ref().map(|step| ("stepSize", step.as_str())),
    ];
    xml.create_element("DefaultExperiment").with_attributes(times.into_iter().flatten()).write_empty()?;
    Ok(())
}

/// How a variable is given and when it changes, in words of the standard.
fn kind_of(variable: &Variable) -> Vec<(&'static str, &'static str)> {
    let causality = match variable.causality {
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::Parameter => "parameter",
    };
    let variability = match variable.variability {
        Variability::Constant => "constant",
        Variability::Fixed => "fixed",
        Variability::Tunable => "tunable",
        Variability::Discrete => "discrete",
        Variability::Continuous => "continuous",
    };
    let initial = match (variable.causality, variable.start) {
        (Causality::Input, _) => None,
        (Causality::Parameter, _) | (Causality::Output, Some(_)) => Some(("initial", "exact")),
        (Causality::Output, None) => Some(("initial", "calculated")),
    };
    [Some(("causality", causality)), Some(("variability", variability)), initial].into_iter().flatten().collect()
}

/// A value of a variable as it is written.
fn number(variable: &Variable, value: f64) -> String {
    if variable.quantity.of_type() == Type::Integer { format!("{value:.0}") } else { format!("{value:?}") }
}

/// What is measured, in which unit and between which bounds.
fn measured(variable: &Variable, scales: &Scales) -> Vec<(&'static str, String)> {
    let is_parameter = variable.causality == Causality::Parameter;
    let is_real = variable.quantity.of_type() == Type::Real;
    let nominal = scales.nominal(variable.quantity).filter(|_| !is_parameter && is_real);
    let bound = |bound: Option<f64>| bound.map(|bound| number(variable, bound));
    let told = [
        ("quantity", (variable.quantity.of_type() != Type::String).then(|| variable.quantity.name().to_owned())),
        ("unit", variable.quantity.unit().map(str::to_owned)),
        ("displayUnit", shown_in(variable.quantity).map(|(name, _)| name.to_owned())),
        ("nominal", nominal.map(|nominal| format!("{nominal:?}"))),
        ("min", bound(variable.minimum)),
        ("max", bound(variable.maximum)),
    ];
    told.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
}

/// One `ScalarVariable`; the value reference is the index in the table.
fn variable(xml: &mut Xml, index: usize, variable: &Variable, scales: &Scales) -> io::Result<()> {
    let reference = index.to_string();
    let start = variable.start.map(|start| number(variable, start)).or(variable.start_text().map(str::to_owned));
    let measured = measured(variable, scales);
    xml.create_element("ScalarVariable")
        .with_attributes([
            ("name", variable.name.as_str()),
            ("valueReference", reference.as_str()),
            ("description", variable.description.as_str()),
        ])
        .with_attributes(kind_of(variable))
        .write_inner_content(|xml| {
            xml.create_element(variable.quantity.of_type().name(Standard::Fmi2))
                .with_attributes(measured.iter().map(|(name, text)| (*name, text.as_str())))
                .with_attributes(start.as_ref().map(|start| ("start", start.as_str())))
                .write_empty()?;
            Ok(())
        })?;
    Ok(())
}

/// Places of variables in the list, from 1.
fn places<'a>(variables: impl Iterator<Item = (usize, &'a Variable)>) -> String {
    variables.map(|(index, _)| (index + 1).to_string()).collect::<Vec<_>>().join(" ")
}

/// `ModelStructure`. A continuous output depends on the inputs that were set for the communication step whose end it is of: it has
/// derivatives by them. Setting an input changes none before the next step; at the start it moves the boundary. What the unit is
/// made of, the parameters, decides all that is calculated at the start.
fn structure(xml: &mut Xml, model: &Model) -> io::Result<()> {
    let interface = model.interface;
    // Texts say what the unit does beside the simulation.
    let deciding = || interface.of_causality(Causality::Parameter).filter(|(_, it)| it.start_text().is_none());
    let parameters = places(deciding());
    // Without a list an unknown depends on all: nodes of a mesh and cells of a grid would make the lists as long as the square of their
    // number.
    let has_elements = interface.variables().iter().any(|variable| variable.element().is_some());
    let (inputs, given) = (places(interface.inputs()), places(interface.inputs().chain(deciding())));
    let [inputs, given] = [&inputs, &given].map(|list| (!has_elements).then_some(list.as_str()));
    let dependencies = |index: usize| if interface.is_continuous_output(index) { inputs } else { Some("") };
    let outputs: Vec<Unknown> =
        interface.outputs().map(|(index, _)| ((index + 1).to_string(), dependencies(index))).collect();
    let initial: Vec<Unknown> = interface
        .outputs()
        .filter(|(_, variable)| variable.start.is_none())
        .map(|(index, variable)| {
            ((index + 1).to_string(), if variable.follows_inputs_at_start { given } else { Some(parameters.as_str()) })
        })
        .collect();
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        unknowns(xml, "Outputs", &outputs)?;
        unknowns(xml, "InitialUnknowns", &initial)
    })?;
    Ok(())
}

/// Place of an unknown in the list of variables, from 1, and what it depends on; on all where nothing is said.
type Unknown<'a> = (String, Option<&'a str>);

/// A list of unknowns, each with what it depends on. An empty list is left out, as the schema demands.
fn unknowns(xml: &mut Xml, name: &str, unknowns: &[Unknown]) -> io::Result<()> {
    if unknowns.is_empty() {
        return Ok(());
    }
    xml.create_element(name).write_inner_content(|xml| {
        for (index, dependencies) in unknowns {
            xml.create_element("Unknown")
                .with_attribute(("index", index.as_str()))
                .with_attributes(dependencies.map(|dependencies| ("dependencies", dependencies)))
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}
