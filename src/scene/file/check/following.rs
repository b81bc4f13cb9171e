//! Boundaries that move with another one, as parts of one machine.

use super::named_tables::Named;
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::BoundaryIndex;
use crate::scene::file::tables::BoundaryTable;
use crate::scene::{AxisMotion, Boundary, NodeMotion};

/// The key.
const KEY: &str = "moves_with";

/// Lets boundaries move as those that they are written to move with.
pub(super) fn resolve(written: &Named<BoundaryTable>, boundaries: &mut [Boundary], faults: &mut Faults) {
    for (name, keys) in written {
        let Some(leader) = &keys.moves_with else { continue };
        let table = format!("boundary.{name}");
        own_motion(keys, leader, &table, faults);
        if let Err(mistake) = may_lead(written, name, leader) {
            faults.add(&table, KEY, mistake);
            continue;
        }
        let place = |name: &str| boundaries.iter().position(|boundary| boundary.name == name);
        // One that is wrong by itself is not there.
        let (Some(own), Some(leader)) = (place(name), place(leader)) else { continue };
        if let Some(mistake) = unfit(&boundaries[leader]) {
            faults.add(&table, KEY, mistake);
            continue;
        }
        let (axes, reference, input) =
            (led_axes(&boundaries[leader]), boundaries[leader].reference, boundaries[leader].input);
        let moves_with = Some(BoundaryIndex(leader as u32));
        boundaries[own] = Boundary { axes, reference, input, moves_with, ..boundaries[own].clone() };
    }
}

/// Reports a boundary of a draft that does not move as the one it is to move with.
pub(super) fn check(boundary: &Boundary, all: &[Boundary], faults: &mut Faults) {
    let Some(leader) = boundary.moves_with else { return };
    let table = format!("boundary.{}", boundary.name);
    let Some(leader) = all.get(leader.index()) else {
        let (found, expected) = (format!("number {}", leader.index()), "the number of a boundary".to_owned());
        return faults.add(&table, KEY, Mistake::Unexpected { found, expected });
    };
    if let Some(mistake) = unfit(leader) {
        return faults.add(&table, KEY, mistake);
    }
    let alike = boundary.axes == led_axes(leader) && boundary.input == leader.input;
    if !alike || boundary.reference != leader.reference || leader.moves_with.is_some() {
        let found = format!("others than [boundary.{}] has", leader.name);
        let expected = "its axes, input and point of reference".to_owned();
        faults.add(&table, KEY, Mistake::Unexpected { found, expected });
    }
}

/// The axes of what moves with a boundary: a surface that runs in itself does so alone.
fn led_axes(leader: &Boundary) -> [AxisMotion; 6] {
    leader.axes.clone().map(|axis| if matches!(axis, AxisMotion::Conveying(_)) { AxisMotion::Fixed } else { axis })
}

/// Reports what is said of a motion that another boundary has.
fn own_motion(keys: &BoundaryTable, leader: &str, table: &str, faults: &mut Faults) {
    let given =
        [("motion", keys.motion.is_some()), ("reference", keys.reference.is_some()), ("input", keys.input.is_some())];
    for (key, _) in given.into_iter().filter(|(_, given)| *given) {
        let what = format!("its {key} is that of [boundary.{leader}], with which it moves");
        faults.add(table, key, Mistake::InvalidCombination { what, expected: "leave it out".to_owned() });
    }
}

/// Whether the boundary of this name may lead that of another name.
fn may_lead(written: &Named<BoundaryTable>, name: &str, leader: &str) -> Result<(), Mistake> {
    let Some((_, keys)) = written.iter().find(|(known, _)| known == leader) else {
        let known = written.iter().map(|(known, _)| known.clone()).filter(|known| known != name).collect();
        return Err(Mistake::UnknownName { found: leader.to_owned(), kind: "boundary", known });
    };
    let (found, expected) = match &keys.moves_with {
        _ if leader == name => ("its own name".to_owned(), "the name of another boundary".to_owned()),
        Some(first) => (format!("{leader:?}, which moves with another one"), format!("{first:?}")),
        None => return Ok(()),
    };
    Err(Mistake::Unexpected { found, expected })
}

/// Why nothing can move with a boundary.
fn unfit(leader: &Boundary) -> Option<Mistake> {
    let (name, axes) = (&leader.name, &leader.axes);
    let by_forces = |axis: &AxisMotion| axis.is_free() || axis.servo().is_some();
    let (what, expected) = if axes.iter().any(by_forces) {
        let what = format!("forces move [boundary.{name}]");
        (what, "make such a body one boundary: a mesh of several files (joined), or a group")
    } else if leader.nodes != NodeMotion::Rigid {
        (format!("the nodes of [boundary.{name}] move one by one"), "leave it out")
    } else if axes.iter().all(AxisMotion::is_fixed) {
        (format!("[boundary.{name}] stays"), "give that a motion, or leave moves_with out")
    } else {
        return None;
    };
    Some(Mistake::InvalidCombination { what, expected: expected.to_owned() })
}
