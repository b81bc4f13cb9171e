//! Clumps during a time step.
//!
//! Their spheres are rows among the particles, whose owner is the clump (behind the boundaries): lists and passes need not know. A clump
//! gathers the loads of its spheres (`loads`), moves as a rigid body and puts its spheres where they belong (`motion`).

mod energy;
mod loads;
mod motion;
mod strikers;

pub(crate) use energy::{book_losses, book_work, kinetic, note_loads};
pub(crate) use loads::{force_on, mass_of};
pub(crate) use strikers::Striker;

use crate::base::geometry::Quaternion;
use crate::base::number::{Vector, larger};
use crate::base::threads::CHUNK;
use crate::engine::state::{Clumps, Row, State, StateFault, demand};
use crate::scene::{Clump, Scene};
use nalgebra::Matrix6;

/// Clumps in one piece of work.
const PIECE: usize = CHUNK / 4;

/// What never changes of the clumps of a scene.
pub(crate) struct ClumpBodies {
    /// First sphere of each (index of the particle), and behind the last one where the last ends.
    starts: Vec<u32>,
    /// First sphere of each among the arms, and their number.
    arm_starts: Vec<u32>,
    /// From the mass centre to each sphere, in principal axes \[m\], clump by clump.
    arms: Vec<Row>,
    /// Principal axes at time 0, where spheres have an orientation.
    begun: Vec<Row>,
    /// What stands for them where impacts are foreseen.
    strikers: Vec<Striker>,
}

/// The spheres of a clump: the first particle, and their arms.
type Spheres<'a> = (usize, &'a [Row]);

impl ClumpBodies {
    /// Those of a scene, if it has any.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let clumps = &scene.clumps;
        let mut bodies = Self {
            starts: clumps.iter().map(|clump| clump.first).collect(),
            arm_starts: vec![0],
            arms: Vec::new(),
            begun: clumps.iter().map(|clump| clump.orientation).collect(),
            strikers: strikers::of(scene),
        };
        for clump in clumps {
            let shape = &scene.clump_shapes[clump.shape as usize];
            let spheres = scene.spheres_of(clump);
            bodies.arms.extend((0..spheres.len()).map(|sphere| {
                let [x, y, z] = clump.arm(shape, sphere);
                [x, y, z, 0.0]
            }));
            bodies.arm_starts.push(bodies.arms.len() as u32);
        }
        (!clumps.is_empty()).then_some(bodies)
    }

    /// The clumps of a scene at time 0.
    pub(crate) fn begun(scene: &Scene) -> Clumps {
        let mut begun = Clumps::default();
        for clump in &scene.clumps {
            let shape = &scene.clump_shapes[clump.shape as usize];
            let length = |sphere: usize| Vector::from(clump.arm(shape, sphere)).length();
            let farthest = (0..shape.spheres.len()).map(length).fold(0.0, f64::max);
            let Clump { position, velocity, orientation, angular_velocity, mass, .. } = *clump;
            let turn = Quaternion::from_row(orientation);
            let [a, b, c] = turn.conjugate().turn(angular_velocity.into()).to_array();
            let [x, y, z] = clump.moments;
            let momentum = turn.turn(Vector::new(x * a, y * b, z * c));
            let smallest =
                scene.particles[scene.spheres_of(clump)].iter().map(|it| it.radius).fold(f64::INFINITY, f64::min);
            begun.position.push(Vector::from(position).row_with(farthest));
            begun.moments.push([x, y, z, smallest]);
            begun.velocity.push(Vector::from(velocity).row_with(mass));
            begun.orientation.push(orientation);
            begun.angular_momentum.push(momentum.row_with(0.0));
            begun.angular_velocity.push(Vector::from(angular_velocity).row_with(0.0));
            begun.force.push([0.0; 4]);
            begun.moment.push([0.0; 4]);
        }
        begun
    }

    /// Whether a state from outside has the clumps of the scene.
    pub(crate) fn check(&self, state: &State, first: &State) -> Result<(), StateFault> {
        let (clumps, begun) = (&state.clumps, &first.clumps);
        let same = |(one, other): (&Row, &Row)| one[3].to_bits() == other[3].to_bits();
        let moments = clumps.moments.iter().flatten().map(|it| it.to_bits());
        let kept = clumps.position.iter().zip(&begun.position).all(same)
            && clumps.velocity.iter().zip(&begun.velocity).all(same)
            && moments.eq(begun.moments.iter().flatten().map(|it| it.to_bits()));
        demand(kept, "clumps", 0, "the clumps of the scene")
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len()
    }

    /// The spheres of a clump.
    #[inline(always)]
    pub(crate) fn spheres(&self, clump: usize) -> Spheres<'_> {
        let (from, to) = (self.arm_starts[clump] as usize, self.arm_starts[clump + 1] as usize);
        (self.starts[clump] as usize, &self.arms[from..to])
    }

    /// Largest speed of a sphere after half a kick of a step of this length \[s\], or above \[m/s\].
    pub(crate) fn coming_speed(&self, clumps: &Clumps, step: f64) -> f64 {
        (0..self.count()).map(|clump| self.speed_after(clumps, clump, step)).fold(0.0, larger)
    }

    /// The same of one clump.
    pub(crate) fn speed_after(&self, clumps: &Clumps, clump: usize, step: f64) -> f64 {
        let [velocity, spin] = self.motion_after(clumps, clump, step);
        velocity.length() + spin.length() * clumps.position[clump][3]
    }

    /// Velocity and angular velocity after half a kick of a step of this length \[s\].
    pub(crate) fn motion_after(&self, clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
        let half = 0.5 * step;
        let velocity = Vector::from(clumps.velocity[clump]);
        let kick = Vector::from(clumps.force[clump]) * (half / clumps.velocity[clump][3]);
        let momentum = Vector::from(clumps.angular_momentum[clump]) + Vector::from(clumps.moment[clump]) * half;
        [velocity + kick, spin(clumps, clump, momentum)]
    }

    /// What stands for all where impacts are foreseen.
    pub(crate) fn strikers(&self) -> &[Striker] {
        &self.strikers
    }

    /// L of the acceleration L Lᵀ that unit loads give to a clump, linear and angular ones larger by these factors.
    pub(crate) fn root(&self, clumps: &Clumps, clump: usize, [linear, angular]: [f64; 2]) -> Matrix6<f64> {
        let mut root = Matrix6::zeros();
        let axes = motion::axes(Quaternion::from_row(clumps.orientation[clump]));
        for axis in 0..3 {
            root[(axis, axis)] = (linear / clumps.velocity[clump][3]).sqrt();
            let along = axes[axis] * (angular / clumps.moments[clump][axis]).sqrt();
            for (row, part) in along.to_array().into_iter().enumerate() {
                root[(3 + row, 3 + axis)] = part;
            }
        }
        root
    }

    /// How many pieces of work there are.
    fn pieces(&self) -> usize {
        self.count().div_ceil(PIECE)
    }

    /// The clumps of a piece.
    #[inline(always)]
    fn piece(&self, piece: usize) -> std::ops::Range<usize> {
        piece * PIECE..((piece + 1) * PIECE).min(self.count())
    }
}

/// The angular velocity that an angular momentum gives to a clump \[rad/s\].
fn spin(clumps: &Clumps, clump: usize, momentum: Vector) -> Vector {
    motion::turning(Quaternion::from_row(clumps.orientation[clump]), Vector::from(clumps.moments[clump]), momentum)
}

/// Finds the angular velocity of a clump from its angular momentum.
pub(crate) fn set_spin(clumps: &mut Clumps, clump: usize) {
    let momentum = Vector::from(clumps.angular_momentum[clump]);
    clumps.angular_velocity[clump] = spin(clumps, clump, momentum).row_with(0.0);
}

/// What half a kick of a step of this length \[s\] with the present load gives to the motion of a clump \[m/s, rad/s\].
pub(crate) fn last_kick(clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
    let half = 0.5 * step;
    let kick = Vector::from(clumps.force[clump]) * (half / clumps.velocity[clump][3]);
    [kick, spin(clumps, clump, Vector::from(clumps.moment[clump]) * half)]
}
