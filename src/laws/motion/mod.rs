//! What an axis of a boundary does, whatever the shape of the boundary: one file and one row of [`AxisMotion`] a motion.
//!
//! If the scene or the host leads a motion, the motion says where its axis stands at the end of a time step. If it is free,
//! the forces on the boundary move it ([`crate::engine::boundaries`] does that).

mod conveying;
mod course;
mod driven;
mod fixed;
mod free;
mod keys;
mod loaded;
mod nodes;
mod prescribed;
mod schedule;
mod servo;
mod table;

pub use course::InputCourse;
pub(crate) use course::Progress;
pub(crate) use keys::{Axis, Keys, PrescribedMotion};
pub use nodes::NodeMotion;
pub use schedule::{Schedule, Sine, Trapezoid};
pub(crate) use servo::Felt;
pub use servo::Servo;
pub use table::Table;
pub(crate) use table::{FileKeys, TableKeys};

use std::sync::Arc;

/// What an axis of a boundary does.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisMotion {
    /// Stays.
    Fixed,
    /// Stays, while the surface moves along it like a conveyor belt, at this velocity \[m/s\].
    Conveying(f64),
    /// Follows the input `<boundary>.displacement.<axis>` or `<boundary>.rotation.<axis>`.
    Driven,
    /// Follows the input `<boundary>.velocity.<axis>` or `<boundary>.angular_velocity.<axis>`.
    VelocityDriven,
    /// Moves at this constant velocity \[m/s\] or angular velocity \[rad/s\].
    Prescribed(f64),
    /// Is where a schedule says.
    Scheduled(Schedule),
    /// Is where a table says.
    Tabulated(Arc<Table>),
    /// Moves by the forces on it.
    Free,
    /// Moves by the forces on it, an input among them: `<boundary>.applied_force.<axis>` or
    /// `<boundary>.applied_moment.<axis>`, which starts with this value \[N, N m\].
    Loaded(f64),
    /// Moves so that the particles press on it with the force of the input `<boundary>.target_force.<axis>`.
    Servo(Servo),
}

/// What every motion provides.
trait Motion {
    /// What the axis does, for a report, with the unit of a velocity; nothing where it stays.
    fn words(&self, unit: &str) -> Option<String>;

    /// Which of its variables the host sees.
    fn seen(&self) -> ShownVariables;

    /// Whether forces move it.
    fn is_free(&self) -> bool {
        false
    }

    /// The start value of its input, if it has one; in the unit of the input.
    fn first_input(&self) -> f64 {
        0.0
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at a time \[s\], if the scene alone determines them.
    fn at(&self, _time: f64) -> Option<[f64; 2]> {
        None
    }

    /// Displacement \[m, rad\] at the end of a time step, and velocity in it \[m/s, rad/s\], if the motion leads it through: tangential
    /// springs, which grow by the velocity, grow by the way.
    fn lead(&self, path: &AxisPath, progress: &Progress) -> Option<[f64; 2]> {
        self.at(progress.time).map(|[place, _]| {
            let place = path.target + place;
            [place, (place - path.before) / progress.step]
        })
    }
}

/// The path of a driven axis through a communication step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisPath {
    /// Where it began \[m, rad\].
    pub start: f64,
    /// Where it is to end; for a prescribed axis, where it stood at time 0 \[m, rad\].
    pub target: f64,
    /// Where it stands before the present time step \[m, rad\].
    pub before: f64,
    /// How it moves there.
    pub course: InputCourse,
    /// Its acceleration on the way, where its course has one \[m/s²\].
    pub acceleration: f64,
}

/// Which variables of an axis the host sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShownVariables {
    /// Nothing: it stays.
    Nothing,
    /// Its displacement is an input.
    Input,
    /// Its displacement is an output.
    Place,
    /// Its displacement and its velocity are outputs.
    PlaceAndRate,
    /// Its displacement and its velocity are outputs, and a load on it is an input.
    Load,
    /// Its displacement is an output, its velocity an input.
    Rate,
    /// Its displacement and the error of its force are outputs; the force of the particles that it is to reach is an input.
    Servo,
}

impl AxisMotion {
    /// The axes of a boundary in their order, as scenes and variables name them.
    pub const WORDS: [&str; 6] = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"];

    /// Calls the row of this motion.
    fn ask<T>(&self, question: impl FnOnce(&dyn Motion) -> T) -> T {
        match self {
            Self::Fixed => question(&fixed::Fixed),
            Self::Conveying(velocity) => question(&conveying::Conveying { velocity: *velocity }),
            Self::Driven => question(&driven::Driven),
            Self::VelocityDriven => question(&driven::VelocityDriven),
            Self::Prescribed(velocity) => question(velocity),
            Self::Scheduled(schedule) => question(schedule),
            Self::Tabulated(table) => question(&**table),
            Self::Free => question(&free::Free),
            Self::Servo(servo) => question(servo),
            Self::Loaded(start) => question(&loaded::Loaded { start: *start }),
        }
    }

    /// What the axis does, for a report, with the unit of a velocity; nothing where it stays.
    pub(crate) fn words(&self, unit: &str) -> Option<String> {
        self.ask(|row| row.words(unit))
    }

    /// Which of its variables the host sees.
    pub(crate) fn seen(&self) -> ShownVariables {
        self.ask(|row| row.seen())
    }

    /// Whether its input is a force or moment.
    pub(crate) fn takes_force(&self) -> bool {
        matches!(self.seen(), ShownVariables::Load | ShownVariables::Servo)
    }

    /// Whether its input is a load on the boundary.
    pub(crate) fn takes_load(&self) -> bool {
        self.seen() == ShownVariables::Load
    }

    /// Whether its input is its velocity.
    pub(crate) fn takes_velocity(&self) -> bool {
        self.seen() == ShownVariables::Rate
    }

    /// Whether its input is its displacement.
    pub(crate) fn takes_place(&self) -> bool {
        self.seen() == ShownVariables::Input
    }

    /// The servo that moves it.
    pub(crate) fn servo(&self) -> Option<&Servo> {
        match self {
            Self::Servo(servo) => Some(servo),
            _ => None,
        }
    }

    /// The start value of its input; 0 if it has none.
    pub(crate) fn first_input(&self) -> f64 {
        self.ask(|row| row.first_input())
    }

    /// Whether it stays.
    pub fn is_fixed(&self) -> bool {
        self.seen() == ShownVariables::Nothing
    }

    /// Velocity of the surface along it, like that of a conveyor belt \[m/s\].
    pub(crate) fn conveys(&self) -> f64 {
        match self {
            Self::Conveying(velocity) => *velocity,
            _ => 0.0,
        }
    }

    /// Whether an input leads it.
    pub fn is_driven(&self) -> bool {
        self.takes_place() || self.takes_velocity()
    }

    /// Whether the scene alone says where it is.
    pub fn is_prescribed(&self) -> bool {
        self.at(0.0).is_some()
    }

    /// Whether its velocity is always the same.
    pub(crate) fn is_steady(&self) -> bool {
        !matches!(self, Self::Scheduled(_) | Self::Tabulated(_))
    }

    /// Whether forces move it.
    pub fn is_free(&self) -> bool {
        self.ask(|row| row.is_free())
    }

    /// Displacement \[m, rad\] and velocity \[m/s, rad/s\] at a time \[s\], if the scene alone determines them.
    pub(crate) fn at(&self, time: f64) -> Option<[f64; 2]> {
        self.ask(|row| row.at(time))
    }

    /// Displacement \[m, rad\] at the end of a time step, and velocity in it \[m/s, rad/s\], if the motion leads it through.
    pub(crate) fn lead(&self, path: &AxisPath, progress: &Progress) -> Option<[f64; 2]> {
        self.ask(|row| row.lead(path, progress))
    }
}
