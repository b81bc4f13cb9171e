//! Why a run stopped.

mod cause;

pub use cause::Cause;

use crate::base::geometry::lattice::STRAINS;
use crate::base::words::plain;
use crate::engine::state::clock::MOST_STEPS;

/// Why a run stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A particle would move further in one step than its neighbours were looked for.
    #[error("particle {id} would move {radii:.2} of its radius in one step at t = {time} s: {cause}", time = plain(*time))]
    Runaway {
        /// The particle.
        id: u32,
        /// Its way in one step, over its radius.
        radii: f64,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// A surface that forces move would pass particles in one step.
    #[error(
        "boundary {boundary} would move {way:.3e} m in one step, {radii:.2} of the radius of the smallest particle, at t = {time} s: {cause}", time = plain(*time))]
    SurfaceRunaway {
        /// The boundary.
        boundary: String,
        /// Its way in one step \[m\].
        way: f64,
        /// The same over the smallest radius.
        radii: f64,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// A number ceased to be finite.
    #[error("particle {id} has a {quantity} that is not finite at t = {time} s: {cause}", time = plain(*time))]
    NotFinite {
        /// The particle.
        id: u32,
        /// What is not finite.
        quantity: &'static str,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// A sum of the energy books ceased to be finite.
    #[error("what the energy books sum up is not finite at t = {time} s: {cause}", time = plain(*time))]
    Books {
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// The centre of a particle is behind a plane, or a surface or a group of particles went over it.
    #[error("particle {id} went through boundary {boundary} at t = {time} s: {cause}", time = plain(*time))]
    Behind {
        /// The particle.
        id: u32,
        /// The boundary.
        boundary: String,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// Two particles are pressed into each other deeper than any contact law is valid.
    #[error("particles {first} and {second} overlap by {overlap:.2} of the smaller radius at t = {time} s: {cause}", time = plain(*time))]
    Crushed {
        /// One particle.
        first: u32,
        /// The other.
        second: u32,
        /// Overlap over the smaller radius.
        overlap: f64,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// More energy came out of contacts and bonds than went in.
    #[error(
        "contacts and bonds gave {gained:.3e} J more than they got, of {turnover:.3e} J that were turned over, at t = {time} s: {cause}", time = plain(*time))]
    EnergyGain {
        /// Energy that came out of nothing \[J\].
        gained: f64,
        /// Sum of the magnitudes of all work \[J\].
        turnover: f64,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// A periodic cell is to go on in another scene.
    #[error("expected a state with a [cell] of the same origin where the scene has one, found another")]
    CellElsewhere,
    /// A strain of the cell is to be what no number is.
    #[error("cell: expected a finite strain {name}, found {strain} at t = {time} s", name = STRAINS[*component], time = plain(*time))]
    CellStrain {
        /// Which component.
        component: usize,
        /// What it is to be.
        strain: f64,
        /// Time \[s\].
        time: f64,
    },
    /// The cell would be deformed much in one time step.
    #[error("cell: a strain would change by {strain:.3e} in a time step of {step:.3e} s at t = {time} s; deform the cell more slowly", time = plain(*time))]
    CellStep {
        /// The change.
        strain: f64,
        /// The time step \[s\].
        step: f64,
        /// Time \[s\].
        time: f64,
    },
    /// The cell is narrower than the largest particle.
    #[error("cell: faces {height:.3e} m apart at t = {time} s, less than the largest radius, {radius:.3e} m", time = plain(*time))]
    CellNarrow {
        /// Distance of two faces \[m\].
        height: f64,
        /// The largest radius \[m\].
        radius: f64,
        /// Time \[s\].
        time: f64,
    },
    /// A particle left the domain.
    #[error("particle {id} left the [domain] at t = {time} s, at ({x:.3e}, {y:.3e}, {z:.3e}) m; likely a missing wall", time = plain(*time))]
    Escaped {
        /// The particle.
        id: u32,
        /// Time \[s\].
        time: f64,
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
        /// Position \[m\].
        z: f64,
    },
    /// A particle left the plane in which the scene says that all stay.
    #[error(
        "particle {id} left the [run] plane at t = {time} s: {quantity} is {value:e} {unit}; keep all forces and \
         motions in the plane, or leave this key out", time = plain(*time))]
    LeftPlane {
        /// The particle.
        id: u32,
        /// What shows it.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Time \[s\].
        time: f64,
    },
    /// A bond is bent further than its formulation can follow.
    #[error(
        "the bond of particle {first} and {} is bent beyond half a turn at t = {time} s: {cause}",
        second.map_or_else(|| "a plane".to_owned(), |second| format!("particle {second}")), time = plain(*time))]
    Overbent {
        /// One particle.
        first: u32,
        /// The other; none where it is a plane.
        second: Option<u32>,
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: Cause,
    },
    /// The given time step is too long.
    #[error(
        "the time step {step:.3e} s is above the stable one, {stable:.3e} s, at t = {time} s, limited by {by}; set [run] step below it, or \"auto\" (allow_unstable = true lets it run all the same)", time = plain(*time))]
    StepTooLong {
        /// The step given \[s\].
        step: f64,
        /// The stable step \[s\].
        stable: f64,
        /// What limits it.
        by: String,
        /// Time \[s\].
        time: f64,
    },
    /// Half a turn or more about several axes at once.
    #[error(
        "boundary {boundary}: expected less than half a turn (pi) about several axes in one communication step, \
         found {angle:.4} rad at t = {time} s", time = plain(*time))]
    Turn {
        /// The boundary.
        boundary: String,
        /// The turn \[rad\].
        angle: f64,
        /// Time \[s\].
        time: f64,
    },
    /// An input that moves a boundary where nothing moves.
    #[error(
        "boundary {boundary}: expected no motion in a scene with [heat] frozen = true, found a displacement to {value:e} at t = {time} \
         s", time = plain(*time))]
    Frozen {
        /// The boundary.
        boundary: String,
        /// Where it was to go \[m, rad\].
        value: f64,
        /// Time \[s\].
        time: f64,
    },
    /// More heat was taken from a body than it had.
    #[error(
        "{body} has a temperature of {temperature:.3e} K at t = {time} s: a [heat_source] or an applied heat takes more than it has; \
         take less, or for a shorter time", time = plain(*time))]
    Cold {
        /// The body.
        body: String,
        /// Its temperature \[K\].
        temperature: f64,
        /// Time \[s\].
        time: f64,
    },
    /// A triangle of a mesh whose nodes the outside moves has no area any more.
    #[error(
        "boundary {boundary}: expected displacements that leave every face its area, found face {face} without one \
         at t = {time} s: its nodes were moved onto a line or a point, or out of all bounds", time = plain(*time))]
    Collapsed {
        /// The boundary.
        boundary: String,
        /// The face: number of the triangle in the files, from 1.
        face: usize,
        /// Time \[s\].
        time: f64,
    },
    /// Bodies are put in the middle of their way in a scene whose planes remember something.
    #[error(
        "expected a scene without planes where bodies are put in the middle of their way, found boundary \
         {boundary}: what contacts and bonds at a plane remember is not put with them"
    )]
    PutAtPlane {
        /// The plane.
        boundary: String,
    },
    /// Lists for which there is not enough memory.
    #[error(
        "{pairs:.2e} {why} need about {:.1} GB of memory, and {:.1} GB are free; take a shorter one or fewer \
         particles",
        needed / 1e9, *free as f64 / 1e9
    )]
    Memory {
        /// How many pairs.
        pairs: f64,
        /// Bytes they need.
        needed: f64,
        /// Bytes that are free.
        free: u64,
        /// Which pairs, and why so many.
        why: String,
    },
    /// A sphere of a group where particles are taken away.
    #[error(
        "particle {id} of [boundary.{boundary}] is where {by} takes particles away, at t = {time} s, and a group \
         keeps all its particles; keep the group away from there", time = plain(*time))]
    GroupLeaves {
        /// The particle.
        id: u32,
        /// Its group.
        boundary: String,
        /// What takes particles away.
        by: String,
        /// Time \[s\].
        time: f64,
    },
    /// So many particles came that no number is left for another.
    #[error("all numbers of particles are used up at t = {time} s; number the particles from a lower one on", time = plain(*time))]
    NoNumberLeft {
        /// Time \[s\].
        time: f64,
    },
    /// A group of a scene that takes over another one's state would have to jump.
    #[error(
        "[boundary.{boundary}]: expected a group of the checkpoint's scene, of the same name and particles, or \
         particles that have not moved, found particle {id} moved by {way:.3e} m"
    )]
    GroupElsewhere {
        /// The group.
        boundary: String,
        /// One of its particles.
        id: u32,
        /// How far it would jump \[m\].
        way: f64,
    },
    /// A clump of a scene that takes over another one's state would have to jump.
    #[error(
        "expected clumps as the checkpoint's scene has them, found sphere {id} elsewhere in its clump, by {way:.3e} m"
    )]
    ClumpElsewhere {
        /// The sphere.
        id: u32,
        /// How far it would jump \[m\].
        way: f64,
    },
    /// A number of the state cannot be.
    #[error(
        "expected {expected} in {part}, found another at its place {place} at t = {time} s: values of the scene are too large or too small for \
         numbers of 64 bits", time = plain(*time))]
    Invalid {
        /// Which part of the state.
        part: &'static str,
        /// Which entry of that part.
        place: usize,
        /// What was expected.
        expected: &'static str,
        /// Time \[s\].
        time: f64,
    },
    /// The caller has asked to stop.
    #[error("stopped at t = {time} s, as asked for", time = plain(*time))]
    Stopped {
        /// Time \[s\].
        time: f64,
    },
    /// More time steps than a clock can count.
    #[error("expected at most {MOST_STEPS:e} time steps in {interval:e} s from t = {time} s on, found {count:.3e} of {step:e} s", time = plain(*time))]
    TooManySteps {
        /// The time step \[s\].
        step: f64,
        /// How many there would be.
        count: f64,
        /// What was to be divided \[s\].
        interval: f64,
        /// Time \[s\].
        time: f64,
    },
    /// A communication step so short that no clock tells it from none beside its time steps.
    #[error("expected at least 1/{MOST_STEPS:e} of a time step of {step:e} s from t = {time} s on, found {interval:e} s", time = plain(*time))]
    TooShort {
        /// What was asked for \[s\].
        interval: f64,
        /// The time step \[s\].
        step: f64,
        /// Time \[s\].
        time: f64,
    },
    /// An interval that is not a finite number above 0.
    #[error("expected an interval above 0 and finite, found {interval} s")]
    Interval {
        /// What was asked for \[s\].
        interval: f64,
    },
}
