//! Boundaries as rigid bodies: their mass and inertia, and how forces move their free axes.

mod inertia;
mod kick;
mod members;

pub(crate) use members::{kick_again, place_groups};

use super::{Body, Rigid};
use crate::base::geometry::Quaternion;
use crate::base::geometry::principal::principal;
use crate::base::geometry::rotation::vector_near;
use crate::base::number::Vector;
use crate::engine::state::{BoundaryState, CellState, Orientation};
use crate::scene::{Boundary, Scene};
use nalgebra::Matrix3;

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
    /// The turn of the axes of time 0 into the principal axes, where it turns freely.
    frame: Quaternion,
    /// Moments of inertia about these; infinite where nothing turns it \[kg m²\].
    moments: Vector,
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
            frame: Quaternion::identity(),
            moments: Vector::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
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
            body.find_axes();
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
        body.find_axes();
        Some(body)
    }

    /// Finds the axes about which moments turn it, and the inertia about them.
    fn find_axes(&mut self) {
        match self.turning {
            Turning::Still | Turning::Led => {}
            Turning::About(axis) => {
                let about = |k: usize| if k == axis { self.inertia[(k, k)] } else { f64::INFINITY };
                self.moments = Vector::from([0, 1, 2].map(about));
            }
            Turning::Freely => {
                let (moments, frame) = principal(self.inertia.transpose().into());
                (self.moments, self.frame) = (moments.into(), frame);
            }
        }
    }

    /// How its free axes move now. What does not shift has neither force nor velocity here, and its mass may not be given.
    pub(crate) fn rigid(&self, moved: &BoundaryState) -> Rigid {
        let orientation = Quaternion::from(moved.orientation);
        Rigid {
            velocity: self.along_free(moved.velocity),
            mass: if self.moves == [false; 3] { 1.0 } else { self.mass },
            turn: if self.turning == Turning::Freely { orientation * self.frame } else { self.frame },
            inertia: self.moments,
            momentum: self.about_free(moved.inertial.angular_momentum),
            force: self.along_free(moved.inertial.load),
            moment: self.about_free(moved.inertial.couple),
            dashpots: [0.0; 2],
        }
    }

    /// What the others see of it.
    pub(super) fn of_boundary<'a>(
        &'a self,
        number: usize,
        moved: &'a BoundaryState,
        cell: Option<&'a CellState>,
    ) -> Body<'a> {
        let orientation = Quaternion::from(moved.orientation);
        Body {
            number,
            rigid: self.rigid(moved),
            moves: self.moves,
            point: moved.pivot.into(),
            mass_centre: orientation.turn(self.offset),
            members: &self.members,
            reach: self.farthest,
            smallest: self.smallest,
            braking: [moved.inertial.braking_force.into(), moved.inertial.braking_moment.into()],
            boundary: Some((self, moved)),
            cell,
        }
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

    /// Whether it is a surface, not a group of particles.
    pub(crate) fn is_surface(&self) -> bool {
        self.members.is_empty()
    }

    /// The acceleration along a normal by a unit force along it, where the body does not turn \[1/kg\].
    pub(crate) fn yields_along(&self, normal: Vector) -> f64 {
        let free = self.along_free(normal.to_array());
        if self.moves == [false; 3] { 0.0 } else { free.dot(free) / self.mass }
    }

    /// The acceleration of each freedom by a unit load along it \[1/kg, 1/(kg m²)\].
    pub(crate) fn yields(&self, moved: &BoundaryState) -> [f64; 6] {
        let [a, b, c] = self.turned_by_units(moved).map(Vector::to_array);
        let [x, y, z] = self.moves.map(|is_free| if is_free { 1.0 / self.mass } else { 0.0 });
        [x, y, z, a[0], b[1], c[2]]
    }

    /// The largest acceleration \[1/kg\] and angular acceleration \[1/(kg m²)\] that unit loads at this arm \[m\] give, or above, times
    /// these factors.
    pub(crate) fn answers(&self, arm: f64, [linear, angular]: [f64; 2]) -> [f64; 2] {
        let shift = if self.moves == [false; 3] { 0.0 } else { 1.0 / self.mass };
        let spin = angular * self.moments.to_array().map(|moment| 1.0 / moment).iter().sum::<f64>();
        [linear * shift + spin * arm * arm, spin]
    }

    /// The acceleration that its present load gives to its points this far from the point of reference \[m\], at most \[m/s²\].
    pub(crate) fn acceleration(&self, moved: &BoundaryState, extent: f64) -> f64 {
        let [along, about] = self.rigid(moved).answer();
        along.length() + about.length() * extent
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
        let rigid = self.rigid(moved);
        let spin = match self.turning {
            Turning::Freely => rigid.turn.turn(rigid.mean_spin(0.5 * step)),
            _ => rigid.spin(),
        };
        let orientation = Quaternion::from(moved.orientation).turned(spin, step);
        moved.orientation = Orientation::from(orientation);
        moved.rotation = match self.turning {
            Turning::Freely => vector_near(orientation, moved.rotation.into()).to_array(),
            Turning::About(_) => (Vector::from(moved.rotation) + spin * step).to_array(),
            Turning::Still | Turning::Led => moved.rotation,
        };
        moved.angular_velocity = self.rigid(moved).spin().to_array();
        spin * step
    }

    /// The angular accelerations that unit moments about x, y, z give to its free axes \[1/(kg m²)\].
    pub(crate) fn turned_by_units(&self, moved: &BoundaryState) -> [Vector; 3] {
        let rigid = self.rigid(moved);
        [0, 1, 2].map(|axis| {
            let unit = [0, 1, 2].map(|k| f64::from(u8::from(k == axis)));
            Rigid { momentum: self.about_free(unit), ..rigid }.spin()
        })
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
            moved.inertial.angular_momentum = self.about_free(angular.to_array()).to_array();
            moved.angular_velocity = self.rigid(moved).spin().to_array();
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
