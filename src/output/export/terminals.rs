//! `terminalsAndIcons.xml` of FMI 3.0: what belongs together at a boundary, so that one line connects it.

use super::description::{Model, Xml, new_xml};
use crate::interface::{Array, Causality, Quantity};
use std::io;

/// What a motion and a force is made of.
const MECHANICAL: [Quantity; 6] = [
    Quantity::Length,
    Quantity::Angle,
    Quantity::Velocity,
    Quantity::AngularVelocity,
    Quantity::Force,
    Quantity::Torque,
];

/// What heat is made of.
const THERMAL: [Quantity; 2] = [Quantity::Temperature, Quantity::HeatFlow];

/// Last part of the names of what flows out of the unit: sums of it vanish where units meet.
const FLOWS: [&str; 6] = ["force", "moment", "mean_force", "mean_moment", "heat_flow", "mean_heat_flow"];

/// A variable of a terminal.
struct Member<'a> {
    /// Its name.
    name: &'a str,
    /// The same without that of the boundary.
    own: &'a str,
    /// Whether it flows out.
    flows: bool,
}

/// The file; none where a scene has no boundary that gives or takes anything.
pub(super) fn write(model: &Model<'_>) -> io::Result<Option<Vec<u8>>> {
    let arrays = model.interface.arrays(model.scene);
    let mut xml = new_xml()?;
    let mut some = false;
    xml.create_element("fmiTerminalsAndIcons").with_attribute(("fmiVersion", "3.0")).write_inner_content(|xml| {
        xml.create_element("Terminals").write_inner_content(|xml| {
            for (place, boundary) in model.scene.boundaries.iter().enumerate() {
                let [mechanical, thermal] =
                    [&MECHANICAL[..], &THERMAL].map(|kinds| members(model, &arrays, (place, &boundary.name), kinds));
                if mechanical.is_empty() && thermal.is_empty() {
                    continue;
                }
                some = true;
                terminal(xml, &boundary.name, "motion and force of the boundary", &mechanical, |xml| {
                    if thermal.is_empty() {
                        return Ok(());
                    }
                    terminal(xml, "heat", "temperature and heat flow of the boundary", &thermal, |_| Ok(()))
                })?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(some.then(|| xml.into_inner()))
}

/// The inputs and outputs of a boundary, by its place and name, that measure one of these.
fn members<'a>(
    model: &Model<'_>,
    arrays: &'a [Array],
    (place, boundary): (usize, &str),
    kinds: &[Quantity],
) -> Vec<Member<'a>> {
    let exchanged = arrays.iter().filter(|array| {
        let variable = &model.interface.variables()[array.first];
        let is_exchanged = variable.causality != Causality::Parameter && kinds.contains(&variable.quantity);
        variable.boundary() == Some(place) && is_exchanged
    });
    let member = |array: &'a Array| {
        let own = array.name.strip_prefix(boundary).and_then(|own| own.strip_prefix('.')).unwrap_or(&array.name);
        let flows = own.split('.').any(|part| FLOWS.contains(&part));
        Member { name: &array.name, own, flows }
    };
    exchanged.map(member).collect()
}

/// One terminal with its variables and what else stands in it. An importer connects what both sides have.
fn terminal(
    xml: &mut Xml,
    name: &str,
    description: &str,
    members: &[Member<'_>],
    inner: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    xml.create_element("Terminal")
        .with_attributes([("name", name), ("matchingRule", "bus"), ("description", description)])
        .write_inner_content(|xml| {
            for member in members {
                xml.create_element("TerminalMemberVariable")
                    .with_attributes([
                        ("variableName", member.name),
                        ("memberName", member.own),
                        ("variableKind", if member.flows { "outflow" } else { "signal" }),
                    ])
                    .write_empty()?;
            }
            inner(xml)
        })?;
    Ok(())
}
