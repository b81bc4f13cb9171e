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
        let what = format!("axis {} is named twice", AxisMotion::WORDS[axis]);
        let right = "an axis is fixed, conveying, driven, prescribed, free, loaded or servo".to_owned();
        faults.add(table, "motion", Mistake::Senseless { what, right });
    }
    axes
}

/// Reports what the axes of a boundary cannot do together, or not with its shape.
pub(super) fn check(axes: &[AxisMotion; 6], shape: &dyn Surface, table: &str, faults: &mut Faults) {
    let mut refuse = |what: String, right: &str| {
        faults.add(table, "motion", Mistake::Senseless { what, right: right.to_owned() });
    };
    if let Some(axis) = (3..6).find(|&axis| !axes[axis].is_fixed() && !shape.turns()) {
        let what = format!("{}: {}s that turn are not there", AxisMotion::WORDS[axis], shape.key());
        return refuse(what, "a group of particles turns");
    }
    if let Some(axis) = (3..6).find(|&axis| axes[axis].servo().is_some()) {
        let what = format!("{} is a servo, which reaches forces only", AxisMotion::WORDS[axis]);
        return refuse(what, "servos along x, y or z are right");
    }
    conveying(axes, shape, table, faults);
    rotations(axes, table, faults);
}

/// A surface that runs in itself has one, and runs along it.
fn conveying(axes: &[AxisMotion; 6], shape: &dyn Surface, table: &str, faults: &mut Faults) {
    let Some(axis) = axes.iter().position(|motion| matches!(motion, AxisMotion::Conveying(_))) else { return };
    let velocity = Vector::from([0, 1, 2].map(|axis| axes[axis].conveys()));
    let (what, right) = if let Some(axis) = (3..6).find(|&axis| axes[axis].conveys() != 0.0) {
        (format!("{} conveys", AxisMotion::WORDS[axis]), "velocities along x, y or z are right")
    } else if !shape.members().is_empty() {
        (format!("{} conveys, and a group has no surface of its own", AxisMotion::WORDS[axis]), "a surface conveys")
    } else if velocity == Vector::zero() {
        (format!("{} conveys at 0 m/s", AxisMotion::WORDS[axis]), "leave it out")
    } else if shape
        .plane()
        .is_some_and(|plane| velocity.cross(plane.normal.into()).length() < ALONG * velocity.length())
    {
        ("it conveys along its normal".to_owned(), "a velocity along the plane is right")
    } else {
        return;
    };
    faults.add(table, "motion.conveying", Mistake::Senseless { what, right: right.to_owned() });
}

/// Rotations go together where the group has one law of turning.
fn rotations(axes: &[AxisMotion; 6], table: &str, faults: &mut Faults) {
    let count = |chosen: fn(&AxisMotion) -> bool| axes[3..].iter().filter(|motion| chosen(motion)).count();
    let free = count(AxisMotion::is_free);
    let driven = count(AxisMotion::is_driven);
    let prescribed = count(AxisMotion::is_prescribed);
    let scheduled = count(|motion| !motion.is_steady());
    let (what, right) = match (free, driven, prescribed) {
        (0, 0, 2..) if scheduled > 0 => {
            ("a schedule turns about one axis and something about another", "one prescribed rotation is right")
        }
        (2, 0, 0) => ("two rotations are free and one is fixed", "one free rotation or all three are right"),
        (1.., 1.., _) | (1.., _, 1..) => {
            ("some rotations are free and others are not", "free rotations with the others fixed are right")
        }
        (_, 1.., 1..) => (
            "some rotations are driven and others prescribed",
            "driven or prescribed ones with the others fixed are right",
        ),
        _ => return,
    };
    faults.add(table, "motion", Mistake::Senseless { what: what.to_owned(), right: right.to_owned() });
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
            let what =
                format!("[damping.{}] damps its spheres differently, but forces move it as one body", damping.name);
            let right = "one damping for all of them is right".to_owned();
            faults.add(&format!("boundary.{}", boundary.name), "motion", Mistake::Senseless { what, right });
        }
    }
}
