//! What an axis of a boundary does, whatever the shape of the boundary: one file and one row of [`AxisMotion`] a motion.
//!
//! A motion that the scene or the outside leads says where its axis stands at the end of a time step; one that is free is
//! moved by the forces on the boundary ([`crate::boundaries`] does that).

mod course;
mod driven;
mod fixed;
mod free;
mod keys;
mod prescribed;
mod schedule;

pub use course::InputCourse;
pub(crate) use course::Progress;
pub(crate) use keys::Keys;
pub use schedule::{Schedule, Sine, Trapezoid};

/// What an axis of a boundary does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisMotion {
    /// Stays.
    Fixed,
    /// Follows the input `<boundary>.displacement.<axis>` or `<boundary>.rotation.<axis>`.
    Driven,
    /// Moves at this constant velocity \[m/s\] or angular velocity \[rad/s\].
    Prescribed(f64),
    /// Is where a schedule has it.
    Scheduled(Schedule),
    /// Moves by the forces on it.
    Free,
}

/// What is asked of every motion.
trait Motion {
    /// What the axis does, for a report, with the unit of a velocity; nothing where it stays.
    fn words(&self, unit: &str) -> Option<String>;

    /// What the outside sees of it.
    fn seen(&self) -> Seen;

    /// Whether forces move it.
    fn is_free(&self) -> bool {
        false
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at a time \[s\], where the scene alone says them.
    fn at(&self, _time: f64) -> Option<[f64; 2]> {
        None
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at the end of a time step, where it is led through it.
    fn lead(&self, way: &Way, progress: &Progress) -> Option<[f64; 2]> {
        self.at(progress.time).map(|[place, rate]| [way.target + place, rate])
    }
}

/// The way of a driven axis through a communication step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// Where it began \[m, rad\].
    pub start: f64,
    /// Where it is to end; of a prescribed axis where it stood at time 0 \[m, rad\].
    pub target: f64,
    /// Where it stands before the present time step \[m, rad\].
    pub before: f64,
    /// How it goes there.
    pub course: InputCourse,
}

/// What the outside sees of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seen {
    /// Nothing: it stays.
    Nothing,
    /// Its displacement is an input.
    Input,
    /// Its displacement is an output.
    Place,
    /// Its displacement and its velocity are outputs.
    PlaceAndRate,
}

impl AxisMotion {
    /// The axes of a boundary in their order, as scenes and variables name them.
    pub const WORDS: [&str; 6] = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"];

    /// The row of this motion.
    fn row(&self) -> &dyn Motion {
        match self {
            Self::Fixed => &fixed::Fixed,
            Self::Driven => &driven::Driven,
            Self::Prescribed(velocity) => velocity,
            Self::Scheduled(schedule) => schedule,
            Self::Free => &free::Free,
        }
    }

    /// What the axis does, for a report, with the unit of a velocity; nothing where it stays.
    pub(crate) fn words(&self, unit: &str) -> Option<String> {
        self.row().words(unit)
    }

    /// What the outside sees of it.
    pub(crate) fn seen(&self) -> Seen {
        self.row().seen()
    }

    /// Whether it stays.
    pub fn is_fixed(&self) -> bool {
        self.seen() == Seen::Nothing
    }

    /// Whether it follows an input.
    pub fn is_driven(&self) -> bool {
        self.seen() == Seen::Input
    }

    /// Whether the scene alone says where it is.
    pub fn is_prescribed(&self) -> bool {
        self.at(0.0).is_some()
    }

    /// Whether its velocity is always the same.
    pub(crate) fn is_steady(&self) -> bool {
        !matches!(self, Self::Scheduled(_))
    }

    /// Whether forces move it.
    pub fn is_free(&self) -> bool {
        self.row().is_free()
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at a time \[s\], where the scene alone says them.
    pub(crate) fn at(&self, time: f64) -> Option<[f64; 2]> {
        self.row().at(time)
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at the end of a time step, where it is led through it.
    pub(crate) fn lead(&self, way: &Way, progress: &Progress) -> Option<[f64; 2]> {
        self.row().lead(way, progress)
    }
}
