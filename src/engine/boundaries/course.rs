//! How boundaries move, and what they feel.

use crate::base::geometry::{Quaternion, rotation};
use crate::base::number::Vector;
use crate::engine::bodies::{RigidBody, Turning};
use crate::engine::run_error::RunError;
use crate::engine::state::boundaries::Inertial;
use crate::engine::state::{BoundaryState, Orientation, State};
use crate::laws::motion::{self, AxisMotion, Felt, InputCourse, Progress};
use crate::scene::{Boundary, Scene};

/// Half a turn, less what rounding may hide \[rad\].
const HALF_A_TURN: f64 = std::f64::consts::PI - 1e-9;

/// Begins a communication step of `interval` \[s\]: driven axes now know where they go. Refuses half a turn
/// or more about several axes; nothing has changed then.
pub(crate) fn begin(scene: &Scene, state: &mut State, interval: f64) -> Result<(), RunError> {
    let time = state.clock.time;
    for (boundary, moved) in scene.boundaries.iter().zip(&state.boundaries) {
        turn_ahead(boundary, moved, interval, time)?;
    }
    for (boundary, moved) in scene.boundaries.iter().zip(&mut state.boundaries) {
        let turn = turn_ahead(boundary, moved, interval, time)?;
        moved.start = six(moved.displacement, moved.rotation);
        apply_inputs(boundary, moved);
        for axis in 0..6 {
            if boundary.axes[axis].takes_force() {
                moved.start[axis] = moved.target[axis];
            }
            moved.end[axis] = end_of(boundary, moved, axis, interval);
            moved.target[axis] += change(moved, axis, interval);
        }
        if boundary.axes[3..].iter().filter(|motion| motion.takes_velocity()).count() > 1 {
            let there = rotation::orientation(turn.into()) * Quaternion::from(moved.orientation);
            moved.end[3..].copy_from_slice(&rotation::vector_near(there, moved.rotation.into()).to_array());
        }
        // Others than those of quadratic motion are given none.
        moved.acceleration = std::mem::take(&mut moved.target_acceleration);
        moved.target_rate = [0.0; 6];
        moved.start_orientation = moved.orientation;
        moved.turn = turn;
        moved.fastest = fastest(boundary, moved, interval);
        moved.impulse = [0.0; 3];
        moved.first_moment = [0.0; 3];
        moved.angular_impulse = [0.0; 3];
    }
    Ok(())
}

/// Where an axis is to be at the end of a communication step of `interval` \[s\] \[m, rad\], or what is laid on it then \[N, N m\].
fn end_of(boundary: &Boundary, moved: &BoundaryState, axis: usize, interval: f64) -> f64 {
    match boundary.axes[axis].takes_velocity() {
        true => moved.start[axis] + mean_velocity(moved, axis, interval) * interval,
        false => moved.target[axis] + change(moved, axis, interval),
    }
}

/// How far an input goes on in a communication step of `interval` \[s\] by the derivatives that were given, in its unit.
fn change(moved: &BoundaryState, axis: usize, interval: f64) -> f64 {
    let bend = moved.target_acceleration.get(axis).map_or(0.0, |acceleration| 0.5 * acceleration * interval);
    (moved.target_rate[axis] + bend) * interval
}

/// The mean of a velocity that is given, over a communication step of `interval` \[s\] \[m/s, rad/s\].
fn mean_velocity(moved: &BoundaryState, axis: usize, interval: f64) -> f64 {
    moved.target[axis] + 0.5 * moved.target_rate[axis] * interval
}

/// Puts the loads that the outside gives, as they are to be from now on, on a boundary.
pub(crate) fn apply_inputs(boundary: &Boundary, moved: &mut BoundaryState) {
    for axis in (0..6).filter(|&axis| boundary.axes[axis].takes_load()) {
        let Inertial { load, couple, applied, .. } = &mut moved.inertial;
        let change = moved.target[axis] - applied[axis];
        *(if axis < 3 { &mut load[axis] } else { &mut couple[axis - 3] }) += change;
        applied[axis] = moved.target[axis];
    }
}

/// Largest speed of each axis that the outside moves on its way through a communication step of `interval` \[s\]: along it \[m/s\] and
/// about it \[rad/s\].
fn fastest(boundary: &Boundary, moved: &BoundaryState, interval: f64) -> [f64; 6] {
    let steepest = boundary.input.steepest();
    std::array::from_fn(|axis| {
        let way = if axis < 3 { moved.end[axis] - moved.start[axis] } else { moved.turn[axis - 3] };
        let motion = &boundary.axes[axis];
        let limit = motion.servo().map_or(0.0, motion::Servo::limit);
        if motion.is_driven() { steepest * way / interval } else { limit }
    })
}

/// Three numbers of x, y, z and three about them.
pub(super) fn six([x, y, z]: [f64; 3], [a, b, c]: [f64; 3]) -> [f64; 6] {
    [x, y, z, a, b, c]
}

/// The rotation vector that driven axes turn by in a communication step from `time` on \[rad\]: about one axis by
/// the change of its angle, about several at once by less than half a turn.
fn turn_ahead(boundary: &Boundary, moved: &BoundaryState, interval: f64, time: f64) -> Result<[f64; 3], RunError> {
    let driven = || (0..3_usize).filter(|axis| boundary.axes[3 + axis].is_driven());
    let target = |axis: usize| moved.target[3 + axis] + moved.target_rate[3 + axis] * interval;
    let mut turn = [0.0; 3];
    if boundary.axes[3..].iter().any(AxisMotion::takes_velocity) {
        for axis in driven() {
            turn[axis] = mean_velocity(moved, 3 + axis, interval) * interval;
        }
    } else if let (Some(axis), 1) = (driven().next(), driven().count()) {
        turn[axis] = target(axis) - moved.rotation[axis];
    } else if driven().next().is_some() {
        let mut rotation = [0.0; 3];
        for axis in driven() {
            rotation[axis] = target(axis);
        }
        let way = rotation::between(Quaternion::from(moved.orientation), rotation::orientation(rotation.into()));
        let angle = way.length();
        if angle > HALF_A_TURN {
            return Err(RunError::Turn { boundary: boundary.name.clone(), angle, time });
        }
        turn = way.to_array();
    }
    Ok(turn)
}

/// Ends a communication step after `elapsed` \[s\].
pub(crate) fn end(state: &mut State, elapsed: f64) {
    if elapsed <= 0.0 {
        return;
    }
    for boundary in &mut state.boundaries {
        boundary.mean_force = boundary.impulse.map(|impulse| impulse / elapsed);
        boundary.force_slope = boundary.first_moment.map(|moment| 12.0 * moment / (elapsed * elapsed * elapsed));
        boundary.mean_moment = boundary.angular_impulse.map(|impulse| impulse / elapsed);
    }
}

/// How far a boundary moved in a time step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BoundaryTravel {
    /// Along the axes that the outside or the scene moves, then about them \[m, rad\].
    pub(super) led: [f64; 6],
    /// No particle of it went further \[m\]; 0 where it carries none.
    pub carried: f64,
    /// No node of it went further \[m\]; 0 where nodes do not move by themselves.
    pub(super) bent: f64,
}

impl BoundaryTravel {
    /// How far the boundary went, or what it carries, or a surface at the distance `extent` from its point of reference
    /// \[m\].
    pub(crate) fn farthest(&self, extent: f64) -> f64 {
        let [x, y, z, u, v, w] = self.led;
        let swept = (u * u + v * v + w * w).sqrt() * extent;
        ((x * x + y * y + z * z).sqrt() + swept).max(self.carried).max(self.bent)
    }
}

/// Largest speed that each boundary has, or gets in the communication step that has begun, of the particles that it
/// carries or, where it is a surface that turns, may meet; what forces move gains speed by its load in a time step of this length
/// \[s\] \[m/s\].
pub(crate) fn speeds<'a>(
    scene: &'a Scene,
    bodies: &'a [Option<RigidBody>],
    state: &'a State,
    step: f64,
) -> impl Iterator<Item = f64> + 'a {
    let time = state.clock.time;
    let extents = state.neighbours.boundary_extent.iter().copied().chain(std::iter::repeat(0.0));
    let boundaries = scene.boundaries.iter().zip(bodies).zip(&state.boundaries).zip(extents);
    boundaries.enumerate().map(move |(place, (((boundary, body), moved), extent))| {
        // Of what an axis is known to do, the faster: as it moves, as it is about to, as the scene says.
        let speed = |axis: usize, now: f64| {
            let at = |time: f64| boundary.axes[axis].at(time).map_or(0.0, |[_, velocity]| velocity.abs());
            let said = at(time).max(at(time + step));
            now.abs().max(moved.fastest[axis].abs()).max(said)
        };
        let along = Vector::from([0, 1, 2].map(|axis| speed(axis, moved.velocity[axis]))).length();
        let about = Vector::from([0, 1, 2].map(|axis| speed(3 + axis, moved.angular_velocity[axis]))).length();
        let bent = state.nodes_of(place).map_or(0.0, |nodes| nodes.fastest);
        let Some(body) = body else { return along + bent };
        let extent = body.farthest.max(extent);
        let gained = if body.is_free() { step * body.acceleration(moved, extent) } else { 0.0 };
        along + about * extent + gained + bent
    })
}

/// Moves every boundary to where it stands at the end of the present time step, and notes how far it moved.
pub(crate) fn advance(
    scene: &Scene,
    bodies: &[Option<RigidBody>],
    state: &mut State,
    progress: Progress,
    travels: &mut Vec<BoundaryTravel>,
) {
    travels.clear();
    for ((boundary, body), moved) in scene.boundaries.iter().zip(bodies).zip(&mut state.boundaries) {
        moved.before = moved.stand();
        let before = moved.displacement;
        let mut travel = BoundaryTravel::default();
        if let Some(body) = body {
            body.kick(moved, progress.step);
            follow_inputs(boundary, moved, &progress);
        }
        for axis in 0..3 {
            if boundary.axes[axis].is_free() {
                moved.displacement[axis] += progress.step * moved.velocity[axis];
                continue;
            }
            if let Some(gone) = serve(boundary, moved, axis, &progress) {
                travel.led[axis] = gone;
                continue;
            }
            let (start, target, course) = (moved.start[axis], moved.end[axis], boundary.input);
            let acceleration = moved.acceleration[axis];
            let whole = motion::AxisPath { start, target, before: before[axis], course, acceleration };
            if let Some([displacement, velocity]) = boundary.axes[axis].lead(&whole, &progress) {
                (moved.displacement[axis], moved.velocity[axis]) = (displacement, velocity);
            }
            travel.led[axis] = moved.displacement[axis] - before[axis];
        }
        let shift = Vector::from(moved.displacement) - before.into();
        if let Some(body) = body {
            let turned = turn(boundary, body, moved, progress);
            if !body.spins() {
                travel.led[3..].copy_from_slice(&turned.to_array());
            }
            travel.carried = turned.length() * body.farthest;
        }
        if !boundary.shape.members().is_empty() {
            travel.carried += shift.length();
        }
        travels.push(travel);
    }
}

/// The force that is given after a share of a communication step \[N, N m\].
fn input_at(moved: &BoundaryState, axis: usize, share: f64) -> f64 {
    let (start, end) = (moved.start[axis], moved.end[axis]);
    if share < 1.0 { start + (end - start) * share } else { end }
}

/// Moves an axis towards the force that is given, and returns its way \[m\].
fn serve(boundary: &Boundary, moved: &mut BoundaryState, axis: usize, progress: &Progress) -> Option<f64> {
    let servo = boundary.axes[axis].servo()?;
    let target = input_at(moved, axis, progress.share(InputCourse::Ramp));
    let pressed = &mut moved.pressed[axis];
    let felt = Felt { impedance: pressed.impedance, stiffness: pressed.stiffness, way: pressed.way };
    moved.velocity[axis] = servo.velocity([moved.force[axis], target], &felt, progress.step);
    if pressed.stiffness == 0.0 {
        pressed.way = servo.further(pressed.way, progress.step);
    }
    let way = progress.step * moved.velocity[axis];
    moved.displacement[axis] += way;
    Some(way)
}

/// Brings the loads that the outside gives to the end of the present time step.
fn follow_inputs(boundary: &Boundary, moved: &mut BoundaryState, progress: &Progress) {
    let share = if progress.is_last() { 1.0 } else { progress.share(InputCourse::Ramp) };
    for axis in (0..6).filter(|&axis| boundary.axes[axis].takes_load()) {
        moved.inertial.applied[axis] = input_at(moved, axis, share);
    }
}

/// Turns a group. Returns the rotation vector of the time step \[rad\].
fn turn(boundary: &Boundary, body: &RigidBody, moved: &mut BoundaryState, progress: Progress) -> Vector {
    match body.turning {
        Turning::Still => Vector::zero(),
        Turning::About(_) | Turning::Freely => body.drift(moved, progress.step),
        Turning::Led => match prescribed_turn(boundary, &moved.target, progress.time) {
            Some([rotation, spin]) => {
                let (before, from) = (Vector::from(moved.rotation), Quaternion::from(moved.orientation));
                let orientation = rotation::orientation(rotation);
                moved.rotation = rotation.to_array();
                moved.orientation = Orientation::from(orientation);
                let turns = &boundary.axes[3..];
                let (turn, velocity) = match turns.iter().filter(|motion| !motion.is_fixed()).count() {
                    _ if turns.iter().all(AxisMotion::is_steady) => (spin * progress.step, spin),
                    1 => (rotation - before, (rotation - before) * (1.0 / progress.step)),
                    // About several axes, the way is no difference of rotation vectors.
                    _ => {
                        let way = rotation::between(from, orientation);
                        (way, way * (1.0 / progress.step))
                    }
                };
                moved.angular_velocity = velocity.to_array();
                turn
            }
            None => drive_turn(moved, boundary.input, progress),
        },
    }
}

/// Rotation vector \[rad\] and angular velocity \[rad/s\] at a time of a boundary that the scene turns, from where it stood
/// at time 0.
fn prescribed_turn(boundary: &Boundary, target: &[f64; 6], time: f64) -> Option<[Vector; 2]> {
    let at = |axis: usize| boundary.axes[axis].at(time).map(|[turned, spin]| [target[axis] + turned, spin]);
    let turn = [3, 4, 5].map(at);
    let part = |part: usize| Vector::from(turn.map(|about| about.map_or(0.0, |about| about[part])));
    turn.iter().any(Option::is_some).then(|| [part(0), part(1)])
}

/// Turns a boundary on its way through the communication step, at constant direction of its angular velocity.
fn drive_turn(moved: &mut BoundaryState, course: InputCourse, progress: Progress) -> Vector {
    let whole = Vector::from(moved.turn);
    let (before, share) = (progress.share_before(course), progress.share(course));
    if progress.is_last() {
        let [.., a, b, c] = moved.end;
        moved.rotation = [a, b, c];
        moved.orientation = Orientation::from(rotation::orientation(moved.rotation.into()));
    } else {
        let on_the_way = rotation::orientation(whole * share) * Quaternion::from(moved.start_orientation);
        moved.rotation = rotation::vector_near(on_the_way, moved.rotation.into()).to_array();
        moved.orientation = Orientation::from(on_the_way);
    }
    let turned = whole * (share - before);
    moved.angular_velocity = match course {
        InputCourse::Ramp => whole * (1.0 / progress.length),
        InputCourse::Smooth | InputCourse::Quadratic => turned * (1.0 / progress.step),
        InputCourse::Hold => Vector::zero(),
    }
    .to_array();
    turned
}
