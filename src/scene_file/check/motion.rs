//! What the axes of boundaries do, and what they can do together.

use super::tables;
use crate::document::Faults;
use crate::document::Mistake;
use crate::motion::Keys;
use crate::number::Vector;
use crate::scene::{AxisMotion, Boundary, Damping, Source};
use crate::surface::Surface;

/// Sine of an angle below which a direction is that of a normal.
const ALONG: f64 = 1e-9;

/// What each axis does; an axis may be named once.
pub(super) fn axes(motion: &Keys, source: &Source, table: &str, faults: &mut Faults) -> [AxisMotion; 6] {
    let (axes, twice) = motion.axes(|axis, keys| tables::read(keys, axis, source, table, faults));
    if motion.drives_nothing_by_velocity() {
        let (what, right) = ("by = \"velocity\", and no axis is driven".to_owned(), "leave by out".to_owned());
        faults.add(table, "motion", Mistake::Senseless { what, right });
    }
    for axis in twice {
        let found = format!("{} twice", AxisMotion::WORDS[axis]);
        let right = "each axis once: fixed, conveying, driven, prescribed, free, loaded or servo".to_owned();
        faults.add(table, "motion", Mistake::Wrong { found, right });
    }
    axes
}

/// Reports what the axes of a boundary cannot do together, or not with its shape.
pub(super) fn check(axes: &[AxisMotion; 6], shape: &dyn Surface, table: &str, faults: &mut Faults) {
    if let Some(axis) = (3..6).find(|&axis| !axes[axis].is_fixed() && !shape.turns()) {
        let found = format!("{} of a {}", AxisMotion::WORDS[axis], shape.key());
        faults.add(table, "motion", Mistake::Wrong { found, right: "rotations of a shape that turns".to_owned() });
        return;
    }
    if let Some(axis) = (3..6).find(|&axis| axes[axis].servo().is_some()) {
        let found = format!("one about {}, and a servo reaches forces only", AxisMotion::WORDS[axis]);
        faults.add(table, "motion", Mistake::Wrong { found, right: "servos along x, y or z".to_owned() });
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
        Mistake::Wrong { found, right: "velocities along x, y or z".to_owned() }
    } else if !shape.members().is_empty() {
        let found = format!("a group, which has no surface of its own to convey along {}", AxisMotion::WORDS[axis]);
        Mistake::Wrong { found, right: "a surface".to_owned() }
    } else if velocity == Vector::zero() {
        let what = format!("{} conveys at 0 m/s", AxisMotion::WORDS[axis]);
        Mistake::Senseless { what, right: "leave it out".to_owned() }
    } else if shape
        .plane()
        .is_some_and(|plane| velocity.cross(plane.normal.into()).length() < ALONG * velocity.length())
    {
        let found = "one along its normal".to_owned();
        Mistake::Wrong { found, right: "a velocity along the plane".to_owned() }
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
    let (found, right) = match (free, driven, prescribed) {
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
    faults.add(table, "motion", Mistake::Wrong { found: found.to_owned(), right: right.to_owned() });
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
        faults.add(table, "reference", Mistake::Senseless { what, right: "leave it out".to_owned() });
    }
}

/// Reports groups that forces move and whose spheres are not damped alike.
pub(super) fn damping(boundaries: &[Boundary], damping: &[Damping], faults: &mut Faults) {
    for boundary in boundaries.iter().filter(|boundary| boundary.axes.iter().any(AxisMotion::is_free)) {
        let members = boundary.shape.members();
        let alike = |each: &[f64]| members.windows(2).all(|two| each[two[0] as usize] == each[two[1] as usize]);
        if let Some(damping) = damping.iter().find(|it| !alike(&it.linear) || !alike(&it.angular)) {
            let found = format!("several in [damping.{}], while forces move the group as one body", damping.name);
            let right = "one damping for all spheres of a group".to_owned();
            faults.add(&format!("boundary.{}", boundary.name), "motion", Mistake::Wrong { found, right });
        }
    }
}
