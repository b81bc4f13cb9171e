//! Boundaries as rigid bodies: what they weigh, and how forces move their free axes.

use super::implicit::{self, Triangle};
use super::inertia::{Matrix, sphere_inertia};
use crate::geometry::Quaternion;
use crate::geometry::rotation::vector_near;
use crate::number::Vector;
use crate::scene::{Boundary, Scene};
use crate::state::{BoundaryState, Orientation, Particles, State};

/// Most iterations in which the rotation of a time step is found. Each gains a factor of about the angle of the step.
const ITERATIONS: usize = 40;

/// Change of an angular velocity, over its length, that is no change.
const STANDS: f64 = 4.0 * f64::EPSILON;

/// How a body turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turning {
    /// It does not.
    Still,
    /// As the outside or the scene says.
    Led,
    /// By the moment about this axis through the reference point, held against the others.
    About(usize),
    /// As a free body.
    Freely,
}

/// A boundary that turns, or that forces move.
#[derive(Clone, Debug)]
pub(crate) struct RigidBody {
    /// Indices into the scene's particles; empty for a surface.
    pub members: Vec<u32>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass centre at time 0, from the reference point \[m\].
    pub offset: Vector,
    /// Inertia about the reference point in the orientation of time 0 \[kg m²\].
    inertia: Matrix,
    /// Its inverse.
    inverse: Matrix,
    /// Which of x, y, z are free.
    pub moves: [bool; 3],
    /// How it turns.
    pub turning: Turning,
    /// From the reference point to the centre furthest away \[m\]; 0 for a surface.
    pub farthest: f64,
    /// Radius of its smallest sphere, for a surface of the smallest that it may touch \[m\].
    pub smallest: f64,
    /// Radius of its largest sphere \[m\].
    pub largest: f64,
    /// Springs to the ground \[N/m, N m/rad\].
    stiffness: [f64; 6],
    /// Dashpots to the ground \[N s/m, N m s/rad\].
    damping: [f64; 6],
}

/// A motion: velocity of the reference point \[m/s\] and angular velocity \[rad/s\].
pub(crate) type Motion = [Vector; 2];

/// What half a kick makes of the free axes.
struct Kick {
    /// Their motion afterwards.
    motion: Motion,
    /// Angular momentum afterwards \[kg m²/s\].
    momentum: Vector,
    /// Impulse and angular impulse of what stiff contacts add to the inertia \[N s, N m s\].
    added: [f64; 6],
}

/// The bodies of a scene; `None` for boundaries that only stand or shift.
pub(crate) fn of(scene: &Scene) -> Vec<Option<RigidBody>> {
    scene.boundaries.iter().map(|boundary| RigidBody::of(scene, boundary)).collect()
}

impl RigidBody {
    /// The body of a boundary, if it needs one.
    pub(crate) fn of(scene: &Scene, boundary: &Boundary) -> Option<Self> {
        let members = boundary.shape.members();
        let moves = [0, 1, 2].map(|axis| boundary.axes[axis].is_free());
        let turning = turning(boundary);
        if moves == [false; 3] && turning == Turning::Still {
            return None;
        }
        let crate::scene::Body { stiffness, damping, .. } = boundary.body;
        let mut body = Self {
            members: members.to_vec(),
            mass: 0.0,
            offset: Vector::zero(),
            inertia: Matrix::default(),
            inverse: Matrix::default(),
            moves,
            turning,
            farthest: 0.0,
            smallest: f64::INFINITY,
            largest: 0.0,
            stiffness,
            damping,
        };
        if members.is_empty() {
            body.fill_surface(scene, boundary);
            return Some(body);
        }
        for particle in members.iter().map(|&member| &scene.particles[member as usize]) {
            let (mass, radius) = (particle.mass(), particle.radius);
            let arm = Vector::from(particle.position) - boundary.reference.into();
            body.mass += mass;
            body.offset += arm * mass;
            body.inertia.add_sphere(mass, radius, arm);
            body.farthest = body.farthest.max(arm.length());
            body.smallest = body.smallest.min(radius);
            body.largest = body.largest.max(radius);
        }
        body.offset = body.offset * (1.0 / body.mass);
        body.inverse = body.inertia.inverse();
        Some(body)
    }

    /// Takes over what the scene gives for a surface.
    fn fill_surface(&mut self, scene: &Scene, boundary: &Boundary) {
        let crate::scene::Body { mass, centre, inertia, .. } = boundary.body;
        (self.mass, self.inertia) = (mass, Matrix(inertia));
        if !self.is_free() {
            return;
        }
        self.offset = Vector::from(centre) - boundary.reference.into();
        self.inertia.add_point(mass, self.offset);
        self.inverse = self.inertia.inverse();
        self.smallest = scene.particles.iter().map(|particle| particle.radius).fold(f64::INFINITY, f64::min);
    }

    /// Whether forces move any of its axes.
    pub(crate) fn is_free(&self) -> bool {
        self.moves != [false; 3] || self.spins()
    }

    /// Whether moments turn it.
    pub(crate) fn spins(&self) -> bool {
        matches!(self.turning, Turning::About(_) | Turning::Freely)
    }

    /// The components of a force along its free axes.
    pub(crate) fn along_free(&self, force: [f64; 3]) -> Vector {
        Vector::from([0, 1, 2].map(|axis| if self.moves[axis] { force[axis] } else { 0.0 }))
    }

    /// The components of a moment about its free axes.
    pub(crate) fn about_free(&self, moment: [f64; 3]) -> Vector {
        Vector::from(match self.turning {
            Turning::Still | Turning::Led => [0.0; 3],
            Turning::About(axis) => [0, 1, 2].map(|k| if k == axis { moment[k] } else { 0.0 }),
            Turning::Freely => moment,
        })
    }

    /// The angular velocity that an angular momentum gives it in an orientation \[rad/s\].
    pub(crate) fn spin(&self, orientation: Quaternion, momentum: Vector) -> Vector {
        match self.turning {
            Turning::Still | Turning::Led => Vector::zero(),
            Turning::About(axis) => {
                let share = momentum.to_array()[axis] / self.inertia.0[axis][axis];
                Vector::from([0, 1, 2].map(|k| if k == axis { share } else { 0.0 }))
            }
            Turning::Freely => orientation.turn(self.inverse.times(orientation.conjugate().turn(momentum))),
        }
    }

    /// Whether stiff contacts add to its inertia: a surface may be far lighter than what touches it.
    pub(crate) fn is_implicit(&self) -> bool {
        self.members.is_empty() && self.is_free()
    }

    /// Which of its six freedoms are free.
    fn freedoms(&self) -> [bool; 6] {
        let [x, y, z] = self.moves;
        let [a, b, c] = match self.turning {
            Turning::Still | Turning::Led => [false; 3],
            Turning::About(axis) => [0, 1, 2].map(|k| k == axis),
            Turning::Freely => [true; 3],
        };
        [x, y, z, a, b, c]
    }

    /// Half a kick to the free axes.
    pub(crate) fn kick(&self, moved: &mut BoundaryState, step: f64) {
        let Kick { motion: [velocity, spin], momentum, added } = self.kicked(moved, step);
        let before = moved.angular_velocity;
        for axis in 0..3 {
            if self.moves[axis] {
                moved.inertial.kick[axis] = velocity.to_array()[axis] - moved.velocity[axis];
                moved.velocity[axis] = velocity.to_array()[axis];
            }
        }
        if self.spins() {
            moved.inertial.angular_momentum = momentum.to_array();
            moved.angular_velocity = spin.to_array();
            moved.inertial.spin_kick = (spin - before.into()).to_array();
        }
        self.book(moved, added, step);
    }

    /// Books what half a kick gave beside the particles, weight and damping.
    fn book(&self, moved: &mut BoundaryState, added: [f64; 6], step: f64) {
        let inertial = &mut moved.inertial;
        let freedoms = self.freedoms();
        for axis in (0..6).filter(|&axis| freedoms[axis]) {
            inertial.applied_impulse[axis] += 0.5 * step * inertial.applied[axis];
            inertial.support_impulse[axis] += 0.5 * step * inertial.support[axis];
            inertial.added_impulse[axis] += added[axis];
        }
    }

    /// Angular momentum that half a kick gives \[kg m²/s\].
    fn twist(&self, moved: &BoundaryState, step: f64) -> Vector {
        self.about_free(moved.inertial.couple) * (0.5 * step)
    }

    /// Half a kick with the present load.
    fn kicked(&self, moved: &BoundaryState, step: f64) -> Kick {
        let (orientation, inertial) = (Quaternion::from(moved.orientation), &moved.inertial);
        let before = Vector::from(inertial.angular_momentum);
        let added = implicit::added(&inertial.stiffness, &inertial.damping, self.freedoms(), step);
        if added == [0.0; 21] {
            let per_mass = if self.moves == [false; 3] { 0.0 } else { 0.5 * step / self.mass };
            let velocity = self.along_free(moved.velocity) + self.along_free(inertial.load) * per_mass;
            let momentum = before + self.twist(moved, step);
            return Kick { motion: [velocity, self.spin(orientation, momentum)], momentum, added: [0.0; 6] };
        }
        let [shift, turn, impulse] = self.kicked_implicitly(moved, &added, step);
        let velocity = self.along_free(moved.velocity) + shift;
        let momentum = before + self.about_free(self.inertia.turned(orientation).times(turn).to_array());
        let [x, y, z] = impulse.to_array();
        let [a, b, c] = (momentum - before - self.twist(moved, step)).to_array();
        Kick { motion: [velocity, self.spin(orientation, momentum)], momentum, added: [x, y, z, a, b, c] }
    }

    /// The change of velocity and of angular velocity by half a kick, and the impulse of what is added to the mass.
    fn kicked_implicitly(&self, moved: &BoundaryState, added: &Triangle, step: f64) -> [Vector; 3] {
        let free = self.freedoms();
        let mut matrix = *added;
        let inertia = self.inertia.turned(Quaternion::from(moved.orientation));
        for row in 0..6 {
            let held = if free[row] { 0.0 } else { 1.0 };
            for column in 0..=row {
                let own = match (row, column) {
                    (0..3, _) if row == column => self.mass,
                    (3..6, 3..6) => inertia.0[row - 3][column - 3],
                    _ => 0.0,
                };
                let both = free[row] && free[column];
                matrix[row * (row + 1) / 2 + column] += if both {
                    own
                } else if row == column {
                    held
                } else {
                    0.0
                };
            }
        }
        let force = self.along_free(moved.inertial.load) * (0.5 * step);
        let [[x, y, z], [a, b, c]] = [force, self.twist(moved, step)].map(Vector::to_array);
        let [x, y, z, a, b, c] = implicit::solve(matrix, [x, y, z, a, b, c]);
        let shift = Vector::new(x, y, z);
        [shift, Vector::new(a, b, c), shift * self.mass - force]
    }

    /// Puts what springs and dashpots to the ground do.
    pub(crate) fn support(&self, moved: &mut BoundaryState) {
        let places = [moved.displacement, moved.rotation].concat();
        let rates = [moved.velocity, moved.angular_velocity].concat();
        for axis in 0..6 {
            moved.inertial.support[axis] = -self.stiffness[axis] * places[axis] - self.damping[axis] * rates[axis];
        }
    }

    /// Starts a sum of what resists its motion: springs and dashpots to the ground.
    pub(crate) fn supports(&self) -> [Triangle; 2] {
        [self.stiffness, self.damping].map(|parts| {
            let mut block = [0.0; 21];
            implicit::add_diagonal(&mut block, parts);
            block
        })
    }

    /// Power of what is added to its inertia, as work of the half kick that is about to be made \[J\].
    pub(crate) fn added_work(&self, moved: &BoundaryState, step: f64) -> f64 {
        let [x, y, z, a, b, c] = self.kicked(moved, step).added;
        let [drift, turn] = self.mean_motion(moved, step);
        drift.dot(Vector::new(x, y, z)) + turn.dot(Vector::new(a, b, c))
    }

    /// Mean of the motion of the free axes before and after half a kick with the present load.
    pub(crate) fn mean_motion(&self, moved: &BoundaryState, step: f64) -> Motion {
        let after = self.kicked(moved, step).motion;
        let before = self.kicked(moved, 0.0).motion;
        [0, 1].map(|part| (before[part] + after[part]) * 0.5)
    }

    /// Largest speed that one of its spheres can have after half a kick with the present load \[m/s\].
    pub(crate) fn coming_speed(&self, moved: &BoundaryState, step: f64) -> f64 {
        let [velocity, spin] = self.kicked(moved, step).motion;
        velocity.length() + spin.length() * self.farthest
    }

    /// Kinetic energy of the free axes \[J\].
    pub(crate) fn kinetic(&self, moved: &BoundaryState) -> f64 {
        let [velocity, spin] = self.kicked(moved, 0.0).motion;
        0.5 * self.mass * velocity.dot(velocity) + 0.5 * spin.dot(moved.inertial.angular_momentum.into())
    }

    /// Turns the free axes by a drift of `step` \[s\]. Returns the rotation vector of the drift \[rad\].
    pub(crate) fn drift(&self, moved: &mut BoundaryState, step: f64) -> Vector {
        let orientation = Quaternion::from(moved.orientation);
        let momentum = Vector::from(moved.inertial.angular_momentum);
        let spin = self.drift_spin(orientation, momentum, step);
        let orientation = orientation.turned(spin, step);
        moved.orientation = Orientation::from(orientation);
        moved.rotation = match self.turning {
            Turning::Freely => vector_near(orientation, moved.rotation.into()).to_array(),
            Turning::About(_) => (Vector::from(moved.rotation) + spin * step).to_array(),
            Turning::Still | Turning::Led => moved.rotation,
        };
        moved.angular_velocity = self.spin(orientation, momentum).to_array();
        spin * step
    }

    /// The angular velocity \[rad/s\] that turns the body through a drift of `step` \[s\] with this angular momentum.
    ///
    /// ```text
    /// w = (w₀ + w₁)/2,  w₁ = J⁻¹ R(w Δt)ᵀ J w₀        (in axes that turn with the body)
    /// ```
    ///
    /// A turn about the mean of the angular velocities before and after leaves the component of J w along it as it
    /// is, hence the kinetic energy w · J w/2, too; the angular momentum in space does not change (Simo and Wong
    /// 1991). The map is of second order and its own inverse in reversed time. For a sphere it is exact.
    fn drift_spin(&self, orientation: Quaternion, momentum: Vector, step: f64) -> Vector {
        let before = self.spin(orientation, momentum);
        if self.turning != Turning::Freely {
            return before;
        }
        let mut mean = before;
        for _ in 0..ITERATIONS {
            let turned = orientation.turned(mean, step);
            // The angular velocity afterwards, carried back by the turn: what the body itself sees.
            let seen = self.inverse.times(turned.conjugate().turn(momentum));
            let next = (before + orientation.turn(seen)) * 0.5;
            let change = (next - mean).length();
            mean = next;
            if change <= STANDS * next.length() {
                break;
            }
        }
        mean
    }

    /// The acceleration that unit forces and moments give to its free axes: 1/mass \[1/kg\] and the inverse of the
    /// inertia in global axes \[1/(kg m²)\].
    pub(crate) fn mobility(&self, moved: &BoundaryState) -> [[f64; 6]; 6] {
        let mut mobility = [[0.0; 6]; 6];
        let orientation = Quaternion::from(moved.orientation);
        for axis in 0..3 {
            mobility[axis][axis] = if self.moves[axis] { 1.0 / self.mass } else { 0.0 };
            let unit = Vector::from([0, 1, 2].map(|k| f64::from(u8::from(k == axis))));
            let spin = self.spin(orientation, self.about_free(unit.to_array())).to_array();
            for (k, part) in spin.into_iter().enumerate() {
                mobility[3 + k][3 + axis] = part;
            }
        }
        mobility
    }

    /// Starts with the momentum and angular momentum that its spheres have; a surface starts at rest.
    pub(crate) fn begin(&self, scene: &Scene, boundary: &Boundary, moved: &mut BoundaryState) {
        if self.members.is_empty() {
            return;
        }
        let (mut momentum, mut angular) = (Vector::zero(), Vector::zero());
        for particle in self.members.iter().map(|&member| &scene.particles[member as usize]) {
            let (mass, radius) = (particle.mass(), particle.radius);
            let arm = Vector::from(particle.position) - boundary.reference.into();
            let push = Vector::from(particle.velocity) * mass;
            momentum += push;
            let roll = Vector::from(particle.angular_velocity) * sphere_inertia(mass, radius);
            angular += roll + arm.cross(push);
        }
        let velocity = (momentum * (1.0 / self.mass)).to_array();
        for axis in (0..3).filter(|&axis| self.moves[axis]) {
            moved.velocity[axis] = velocity[axis];
        }
        if self.spins() {
            let angular = self.about_free(angular.to_array());
            moved.inertial.angular_momentum = angular.to_array();
            moved.angular_velocity = self.spin(Quaternion::from(moved.orientation), angular).to_array();
        }
    }
}

/// How the axes of a boundary make it turn.
fn turning(boundary: &Boundary) -> Turning {
    let turns = &boundary.axes[3..];
    let free = |axis: &usize| turns[*axis].is_free();
    match (0..3).filter(free).collect::<Vec<_>>()[..] {
        [] if turns.iter().all(|motion| motion.is_fixed()) => Turning::Still,
        [] => Turning::Led,
        [axis] => Turning::About(axis),
        _ => Turning::Freely,
    }
}

/// Puts the particles of groups where their boundary stands, with the motion that it has.
pub(crate) fn place_groups(scene: &Scene, bodies: &[Option<RigidBody>], state: &mut State) {
    let State { boundaries, particles, .. } = state;
    for ((boundary, body), moved) in scene.boundaries.iter().zip(bodies).zip(boundaries) {
        moved.pivot = (Vector::from(boundary.reference) + moved.displacement.into()).to_array();
        let members = boundary.shape.members();
        if body.as_ref().is_some_and(|body| body.turning != Turning::Still) {
            place_turned(scene, boundary, moved, members, particles);
            continue;
        }
        for &member in members {
            let slot = particles.slot[member as usize] as usize;
            let home = scene.particles[member as usize].position;
            for axis in 0..3 {
                particles.position[slot][axis] = home[axis] + moved.displacement[axis];
                particles.velocity[slot][axis] = moved.velocity[axis];
            }
        }
    }
}

/// Puts the particles of a group that turns where it stands.
fn place_turned(scene: &Scene, boundary: &Boundary, moved: &BoundaryState, members: &[u32], particles: &mut Particles) {
    let orientation = Quaternion::from(moved.orientation);
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let home = Vector::from(scene.particles[member as usize].position) - boundary.reference.into();
        let place = Vector::from(moved.pivot) + orientation.turn(home);
        particles.position[slot][..3].copy_from_slice(&place.to_array());
        if let Some(row) = particles.orientation.get_mut(slot) {
            *row = moved.orientation.0;
        }
    }
    give_motion(moved, members, particles);
}

/// Gives the particles of a group the motion of their body.
fn give_motion(moved: &BoundaryState, members: &[u32], particles: &mut Particles) {
    let (velocity, spin) = (Vector::from(moved.velocity), Vector::from(moved.angular_velocity));
    for &member in members {
        let slot = particles.slot[member as usize] as usize;
        let arm = Vector::from(particles.position[slot]) - moved.pivot.into();
        particles.velocity[slot][..3].copy_from_slice(&(velocity + spin.cross(arm)).to_array());
        particles.angular_velocity[slot][..3].copy_from_slice(&spin.to_array());
    }
}

/// The second half of the kick to all free axes. Returns the largest speed of a sphere of theirs at the middle of the
/// next step \[m/s\]; not a number where a load is none.
pub(crate) fn kick_again(bodies: &[Option<RigidBody>], state: &mut State, step: f64) -> f64 {
    let mut fastest = 0.0;
    for (index, body) in bodies.iter().enumerate() {
        let Some(body) = body.as_ref().filter(|body| body.is_free()) else { continue };
        let moved = &mut state.boundaries[index];
        body.kick(moved, step);
        fastest = larger(fastest, body.coming_speed(moved, step));
        give_free_motion(body, moved, &mut state.particles);
    }
    fastest
}

/// Largest speed of a sphere of a free group at the middle of a step of this length \[m/s\].
pub(crate) fn coming_speed(bodies: &[Option<RigidBody>], state: &State, step: f64) -> f64 {
    let free = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| Some((body.as_ref()?, moved)));
    free.fold(0.0, |most, (body, moved)| larger(most, body.coming_speed(moved, step)))
}

/// The larger of two numbers, or the second where it is none.
fn larger(most: f64, one: f64) -> f64 {
    if one > most || one.is_nan() { one } else { most }
}

/// Gives the spheres of a group the motion that it has after a kick.
fn give_free_motion(body: &RigidBody, moved: &BoundaryState, particles: &mut Particles) {
    if body.turning != Turning::Still {
        return give_motion(moved, &body.members, particles);
    }
    for &member in &body.members {
        let slot = particles.slot[member as usize] as usize;
        particles.velocity[slot][..3].copy_from_slice(&moved.velocity);
    }
}
