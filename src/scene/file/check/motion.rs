//! What the axes of boundaries do, and what they can do together.

use super::tables;
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::base::number::Vector;
use crate::laws::motion::Keys;
use crate::laws::surface::Surface;
use crate::scene::{AxisMotion, Boundary, Damping, Source};

/// Sine of an angle below which a direction is that of a normal.
const ALONG: f64 = 1e-9;

/// What each axis does; an axis may be named once.
pub(super) fn axes(motion: &Keys, source: &Source, table: &str, faults: &mut Faults) -> [AxisMotion; 6] {
    let (axes, twice) =
        motion.axes(|axis, keys| tables::read(keys, axis, source, (table, "motion.prescribed"), faults));
    if motion.drives_nothing_by_velocity() {
        let (what, expected) = ("by = \"velocity\", and no axis is driven".to_owned(), "leave by out".to_owned());
        faults.add(table, "motion", Mistake::InvalidCombination { what, expected });
    }
    for axis in twice {
        let found = format!("{} twice", AxisMotion::WORDS[axis]);
        let expected = "each axis once: fixed, conveying, driven, prescribed, free, loaded or servo".to_owned();
        faults.add(table, "motion", Mistake::Unexpected { found, expected });
    }
    axes
}

/// Reports what the axes of a boundary cannot do together, or not with its shape.
pub(super) fn check(axes: &[AxisMotion; 6], shape: &dyn Surface, (table, key): (&str, &str), faults: &mut Faults) {
    if let Some(axis) = (3..6).find(|&axis| !axes[axis].is_fixed() && !shape.turns()) {
        let found = format!("{} of a {}", AxisMotion::WORDS[axis], shape.key());
        let expected = "rotations of a shape that turns".to_owned();
        faults.add(table, key, Mistake::Unexpected { found, expected });
        return;
    }
    if let Some(axis) = (3..6).find(|&axis| axes[axis].servo().is_some()) {
        let found = format!("one about {}, and a servo reaches forces only", AxisMotion::WORDS[axis]);
        faults.add(table, "motion", Mistake::Unexpected { found, expected: "servos along x, y or z".to_owned() });
        return;
    }
    conveying(axes, shape, table, faults);
    rotations(axes, table, faults);
}

/// A surface that runs in itself has one, and runs along it.
fn conveying(axes: &[AxisMotion; 6], shape: &dyn Surface, table: &str, faults: &mut Faults) {
    let Some(axis) = axes.iter().position(|motion| matches!(motion, AxisMotion::Conveying(_))) else { return };
    let velocity = Vector::from([0, 1, 2].map(|axis| axes[axis].conveys()));
    let mistake = if let Some(axis) = (3..6).find(|&axis| axes[axis].conveys() != 0.0) {
        let found = format!("one about {}", AxisMotion::WORDS[axis]);
        Mistake::Unexpected { found, expected: "velocities along x, y or z".to_owned() }
    } else if !shape.members().is_empty() {
        let found = format!("a group, which has no surface of its own to convey along {}", AxisMotion::WORDS[axis]);
        Mistake::Unexpected { found, expected: "a surface".to_owned() }
    } else if velocity == Vector::zero() {
        let what = format!("{} conveys at 0 m/s", AxisMotion::WORDS[axis]);
        Mistake::InvalidCombination { what, expected: "leave it out".to_owned() }
    } else if shape
        .plane()
        .is_some_and(|plane| velocity.cross(plane.normal.into()).length() < ALONG * velocity.length())
    {
        let found = "one along its normal".to_owned();
        Mistake::Unexpected { found, expected: "a velocity along the plane".to_owned() }
    } else {
        return;
    };
    faults.add(table, "motion.conveying", mistake);
}

/// Rotations go together where the group has one law of turning.
fn rotations(axes: &[AxisMotion; 6], table: &str, faults: &mut Faults) {
    let count = |chosen: fn(&AxisMotion) -> bool| axes[3..].iter().filter(|motion| chosen(motion)).count();
    let free = count(AxisMotion::is_free);
    let driven = count(AxisMotion::is_driven);
    let prescribed = count(AxisMotion::is_prescribed);
    let scheduled = count(|motion| !motion.is_steady());
    let (found, expected) = match (free, driven, prescribed) {
        (0, 0, 2..) if scheduled > 0 => {
            ("a schedule about one axis and something else about another", "one prescribed rotation")
        }
        (2, 0, 0) => ("two free rotations", "one free rotation or all three"),
        (1.., 1.., _) | (1.., _, 1..) => {
            ("free rotations beside others that are driven or prescribed", "free rotations with the others fixed")
        }
        (_, 1.., 1..) => ("driven and prescribed rotations", "driven or prescribed rotations with the others fixed"),
        _ => return,
    };
    faults.add(table, "motion", Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() });
}

/// Whether a body moves and turns, and does one of it by forces: then it turns about its mass centre.
pub(super) fn turns_about_its_centre(axes: &[AxisMotion; 6]) -> bool {
    let any = |axes: &[AxisMotion], chosen: fn(&AxisMotion) -> bool| axes.iter().any(chosen);
    let (free, held) = (AxisMotion::is_free, |it: &AxisMotion| !it.is_fixed());
    let (along, about) = axes.split_at(3);
    any(along, free) && any(about, held) || any(about, free) && any(along, held)
}

/// A body that moves and turns, and does one of it freely, does so about its mass centre; `referred`: the scene gives another point.
pub(super) fn reference(axes: &[AxisMotion; 6], referred: bool, table: &str, faults: &mut Faults) {
    if referred && turns_about_its_centre(axes) {
        let what = "what moves and turns, one of both freely, turns about its mass centre".to_owned();
        faults.add(table, "reference", Mistake::InvalidCombination { what, expected: "leave it out".to_owned() });
    }
}

/// Reports groups that forces move and whose spheres are not damped alike.
pub(super) fn damping(boundaries: &[Boundary], damping: &[Damping], faults: &mut Faults) {
    for boundary in boundaries.iter().filter(|boundary| boundary.axes.iter().any(AxisMotion::is_free)) {
        let members = boundary.shape.members();
        let alike = |each: &[f64]| members.windows(2).all(|two| each[two[0] as usize] == each[two[1] as usize]);
        if let Some(damping) = damping.iter().find(|it| !alike(&it.linear) || !alike(&it.angular)) {
            let found = format!("several in [damping.{}], while forces move the group as one body", damping.name);
            let expected = "one damping for all spheres of a group".to_owned();
            faults.add(&format!("boundary.{}", boundary.name), "motion", Mistake::Unexpected { found, expected });
        }
    }
}
