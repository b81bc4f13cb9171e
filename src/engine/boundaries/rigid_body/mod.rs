//! Boundaries as rigid bodies: their mass and inertia, and how forces move their free axes.

mod groups;
mod kick;

pub(crate) use groups::{came_to, coming_speed, kick_again, place_groups};

use super::inertia;
use crate::base::geometry::Quaternion;
use crate::base::geometry::rotation::vector_near;
use crate::base::number::Vector;
use crate::engine::state::{BoundaryState, Orientation};
use crate::scene::{Boundary, Scene};
use nalgebra::{Matrix3, Matrix6, Vector6};

/// Most iterations in which the rotation of a time step is found. Each gains a factor of about the angle of the step.
const ITERATIONS: usize = 40;

/// Change of an angular velocity, over its length, below which the iteration ends.
const STANDS: f64 = 4.0 * f64::EPSILON;

/// How a body turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turning {
    /// It does not.
    Still,
    /// As the host or the scene says.
    Led,
    /// By the moment about this axis through the reference point; it does not turn about the others.
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
    inertia: Matrix3<f64>,
    /// Its inverse.
    inverse: Matrix3<f64>,
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
            inertia: Matrix3::zeros(),
            inverse: Matrix3::zeros(),
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
            inertia::add_particle(&mut body.inertia, mass, particle.inertia(), arm);
            body.farthest = body.farthest.max(arm.length());
            body.smallest = body.smallest.min(radius);
            body.largest = body.largest.max(radius);
        }
        body.offset = body.offset * (1.0 / body.mass);
        body.inverse = body.inertia.try_inverse().unwrap_or_default();
        Some(body)
    }

    /// Takes over what the scene gives for a surface.
    fn fill_surface(&mut self, scene: &Scene, boundary: &Boundary) {
        let crate::scene::Body { mass, centre, inertia, .. } = boundary.body;
        (self.mass, self.inertia) = (mass, inertia.into());
        if !self.is_free() {
            return;
        }
        self.offset = Vector::from(centre) - boundary.reference.into();
        inertia::add_particle(&mut self.inertia, mass, 0.0, self.offset);
        self.inverse = self.inertia.try_inverse().unwrap_or_default();
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
                let share = momentum.to_array()[axis] / self.inertia[(axis, axis)];
                Vector::from([0, 1, 2].map(|k| if k == axis { share } else { 0.0 }))
            }
            Turning::Freely => orientation.turn(inertia::times(&self.inverse, orientation.conjugate().turn(momentum))),
        }
    }

    /// Whether it is a surface, not a group of particles.
    pub(crate) fn is_surface(&self) -> bool {
        self.members.is_empty()
    }

    /// The acceleration along a normal by a unit force along it, where the body does not turn \[1/kg\].
    pub(crate) fn yields_along(&self, normal: Vector) -> f64 {
        let free = self.along_free(normal.to_array());
        if self.moves == [false; 3] { 0.0 } else { free.dot(free) / self.mass }
    }

    /// The acceleration that its present load gives to its points this far from the point of reference \[m\], at most \[m/s²\].
    pub(crate) fn acceleration(&self, moved: &BoundaryState, extent: f64) -> f64 {
        let [along, about] = self.answer(moved);
        along.length() + about.length() * extent
    }

    /// The acceleration of its point of reference \[m/s²\] and the angular one \[rad/s²\] that its present load gives.
    pub(crate) fn answer(&self, moved: &BoundaryState) -> Motion {
        let ([x, y, z], [a, b, c]) = (moved.inertial.load, moved.inertial.couple);
        let answer = self.mobility(moved) * Vector6::new(x, y, z, a, b, c);
        [Vector::new(answer[0], answer[1], answer[2]), Vector::new(answer[3], answer[4], answer[5])]
    }

    /// Which of its six freedoms are free.
    pub(crate) fn freedoms(&self) -> [bool; 6] {
        let [x, y, z] = self.moves;
        let [a, b, c] = match self.turning {
            Turning::Still | Turning::Led => [false; 3],
            Turning::About(axis) => [0, 1, 2].map(|k| k == axis),
            Turning::Freely => [true; 3],
        };
        [x, y, z, a, b, c]
    }

    /// Sets the loads of springs and dashpots to the ground.
    pub(crate) fn support(&self, moved: &mut BoundaryState) {
        let places = [moved.displacement, moved.rotation].concat();
        let rates = [moved.velocity, moved.angular_velocity].concat();
        for axis in 0..6 {
            moved.inertial.support[axis] = -self.stiffness[axis] * places[axis] - self.damping[axis] * rates[axis];
        }
    }

    /// Stiffness of the springs to the ground \[N/m, N m/rad\].
    pub(crate) fn springs(&self) -> [f64; 6] {
        self.stiffness
    }

    /// Dashpots to the ground along the free axes \[N s/m\] and about them \[N m s\].
    fn dashpots(&self) -> [Vector; 2] {
        let [x, y, z, a, b, c] = self.damping;
        [self.along_free([x, y, z]), self.about_free([a, b, c])]
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
            let seen = inertia::times(&self.inverse, turned.conjugate().turn(momentum));
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
    pub(crate) fn mobility(&self, moved: &BoundaryState) -> Matrix6<f64> {
        let mut mobility = Matrix6::zeros();
        let orientation = Quaternion::from(moved.orientation);
        for axis in 0..3 {
            mobility[(axis, axis)] = if self.moves[axis] { 1.0 / self.mass } else { 0.0 };
            let unit = Vector::from([0, 1, 2].map(|k| f64::from(u8::from(k == axis))));
            let spin = self.spin(orientation, self.about_free(unit.to_array())).to_array();
            for (k, part) in spin.into_iter().enumerate() {
                mobility[(3 + k, 3 + axis)] = part;
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
            let arm = Vector::from(particle.position) - boundary.reference.into();
            let push = Vector::from(particle.velocity) * particle.mass();
            momentum += push;
            let roll = Vector::from(particle.angular_velocity) * particle.inertia();
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
