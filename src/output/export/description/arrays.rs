//! Variables and their structure in FMI 3.0: arrays, and the time.

use super::{Model, Scales, Xml, kind_of, measured, number};
use crate::interface::{Array, Causality, Standard, Variable};
use std::io;

/// `ModelVariables` and `ModelStructure` of FMI 3.0.
pub(super) fn write(xml: &mut Xml, model: &Model<'_>) -> io::Result<()> {
    let scales = Scales::of(model.scene);
    let arrays = model.interface.arrays(model.scene);
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        for (reference, array) in arrays.iter().enumerate() {
            let elements = &model.interface.variables()[array.first..array.first + array.count()];
            variable(xml, (reference, array), elements, &scales)?;
        }
        time(xml, arrays.len())
    })?;
    structure(xml, model, &arrays)
}

/// One variable; the value reference is its place in the list.
fn variable(
    xml: &mut Xml,
    (reference, array): (usize, &Array),
    elements: &[Variable],
    scales: &Scales,
) -> io::Result<()> {
    let (first, reference) = (&elements[0], reference.to_string());
    let (kind, measured) = (first.quantity.of_type(), measured(first, scales));
    let starts: Vec<String> = elements.iter().filter_map(|it| it.start.map(|start| number(it, start))).collect();
    // One start value is that of all elements.
    let start = if starts.iter().all(|start| *start == starts[0]) { starts.get(..1) } else { Some(&starts[..]) };
    let start = start.map(|starts| starts.join(" "));
    let element = xml
        .create_element(kind.name(Standard::Fmi3))
        .with_attributes([
            ("name", array.name.as_str()),
            ("valueReference", reference.as_str()),
            ("description", array.description.as_str()),
        ])
        .with_attributes(kind_of(first))
        .with_attributes(measured.iter().map(|(name, text)| (*name, text.as_str())))
        .with_attributes(start.as_ref().map(|start| ("start", start.as_str())));
    if array.dimensions.is_empty() && first.start_text().is_none() {
        element.write_empty()?;
        return Ok(());
    }
    element.write_inner_content(|xml| {
        for length in &array.dimensions {
            xml.create_element("Dimension").with_attribute(("start", length.to_string().as_str())).write_empty()?;
        }
        if let Some(text) = first.start_text() {
            xml.create_element("Start").with_attribute(("value", text)).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

/// The independent variable.
fn time(xml: &mut Xml, reference: usize) -> io::Result<()> {
    xml.create_element("Float64")
        .with_attributes([
            ("name", "time"),
            ("valueReference", reference.to_string().as_str()),
            ("description", "time of the host"),
            ("causality", "independent"),
            ("variability", "continuous"),
            ("quantity", "Time"),
            ("unit", "s"),
        ])
        .write_empty()?;
    Ok(())
}

/// `ModelStructure`: the same dependencies as in FMI 2.0, array by array.
fn structure(xml: &mut Xml, model: &Model<'_>, arrays: &[Array]) -> io::Result<()> {
    let first = |array: &Array| &model.interface.variables()[array.first];
    let list = |wanted: &dyn Fn(&Variable) -> bool| {
        let known = arrays.iter().enumerate().filter(|(_, array)| wanted(first(array)));
        known.map(|(reference, _)| reference.to_string()).collect::<Vec<_>>().join(" ")
    };
    let is_input = |it: &Variable| it.causality == Causality::Input;
    let decides = |it: &Variable| it.causality == Causality::Parameter && it.start_text().is_none();
    let (inputs, parameters) = (list(&is_input), list(&decides));
    let given = list(&|it| is_input(it) || decides(it));
    let outputs = || arrays.iter().enumerate().filter(|(_, array)| first(array).causality == Causality::Output);
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for (reference, array) in outputs() {
            let continuous = model.interface.is_continuous_output(array.first);
            unknown(xml, "Output", reference, if continuous { &inputs } else { "" })?;
        }
        for (reference, array) in outputs().filter(|(_, array)| first(array).start.is_none()) {
            let follows = first(array).follows_inputs_at_start;
            unknown(xml, "InitialUnknown", reference, if follows { &given } else { &parameters })?;
        }
        Ok(())
    })?;
    Ok(())
}

/// One unknown and what it depends on.
fn unknown(xml: &mut Xml, element: &str, reference: usize, dependencies: &str) -> io::Result<()> {
    xml.create_element(element)
        .with_attributes([("valueReference", reference.to_string().as_str()), ("dependencies", dependencies)])
        .write_empty()?;
    Ok(())
}
