//! How fast bonded bodies vibrate: what the automatic time step follows where bonds carry the motion.
//!
//! Rayleigh's quotient of a motion u of a network, uᵀ K u over uᵀ M u, is the mean of the squared angular frequencies of its
//! modes, by their energies. For u the velocities v of the moment are taken less those of the cluster as a rigid body, and
//! the accelerations a likewise, so that no moment is one without motion: an oscillation has
//!
//! ```text
//! ω² = (vᵀ K v + aᵀ K a/ω²)/(vᵀ M v + aᵀ M a/ω²),     energy  E = ½ vᵀ M v + ½ aᵀ M a/ω²
//! ```
//!
//! at any phase. A cluster that only holds a load has neither.

use super::System;
use crate::base::number::Vector;
use crate::engine::bodies;
use crate::engine::bonds::clusters::{self, Clusters};
use crate::engine::contacts::{Frame, Link, SearchLimits};
use crate::engine::state::ledger::Source;
use nalgebra::{Matrix3, Vector3};

/// Velocity and angular velocity, or their derivatives in time.
type Twist = [Vector; 2];

/// Times that the frequency by which accelerations count is found again.
const TURNS: usize = 2;

/// Energy of a vibration over that of the whole motion of its cluster below which it may be one of rounding.
const ROUNDING: f64 = 1e-15;

/// Clusters, and what was summed over each. Kept, so that a look requests no memory.
#[derive(Debug, Default)]
pub(crate) struct Vibrations {
    /// The clusters.
    pub(crate) clusters: Clusters,
    /// Their sums.
    sums: Vec<Sums>,
}

/// What is summed over the bodies and bonds of a cluster, about its first body.
#[derive(Clone, Debug)]
struct Sums {
    /// Mass \[kg\].
    mass: f64,
    /// Its first moment \[kg m\].
    first: Vector,
    /// Moments of inertia \[kg m²\].
    second: Matrix3<f64>,
    /// Momentum and angular momentum, and their derivatives in time.
    momenta: [Twist; 2],
    /// The body that it hangs on, and whether forces move that one.
    support: Option<(bool, usize)>,
    /// Where its motion as a rigid body is told of: its mass centre, or what it hangs on \[m\].
    centre: Vector,
    /// That motion there: velocity and acceleration.
    rigid: [Twist; 2],
    /// Kinetic energy of everything \[J\].
    kinetic: f64,
    /// ½ vᵀ M v \[J\] and ½ aᵀ M a \[J/s²\] beside that.
    inertial: [f64; 2],
    /// ½ vᵀ K v \[J/s²\] and ½ aᵀ K a \[J/s⁴\] beside that.
    elastic: [f64; 2],
    /// Elastic energy of its bonds \[J\].
    stored: f64,
}

impl Sums {
    /// Of nothing yet.
    fn zero() -> Self {
        let still = [[Vector::zero(); 2]; 2];
        Self {
            mass: 0.0,
            first: Vector::zero(),
            second: Matrix3::zeros(),
            momenta: still,
            support: None,
            centre: Vector::zero(),
            rigid: still,
            kinetic: 0.0,
            inertial: [0.0; 2],
            elastic: [0.0; 2],
            stored: 0.0,
        }
    }

    /// Adds the mass of a body at this place, with these motions.
    fn add(&mut self, inertia: &Inertia, place: Vector, motions: &[Twist; 2]) {
        let mass = inertia.mass[0];
        self.mass += mass;
        self.first += place * mass;
        self.second += inertia.turning + of_point(mass, place);
        for ([momentum, angular], [velocity, spin]) in self.momenta.iter_mut().zip(motions) {
            *momentum += *velocity * mass;
            *angular += times(&inertia.turning, *spin) + place.cross(*velocity * mass);
        }
    }

    /// The motion as a rigid body that has its momentum and, where it turns freely, its angular momentum.
    fn follow_momentum(&mut self, turns: bool) {
        if self.mass <= 0.0 {
            return;
        }
        let centre = self.first * (1.0 / self.mass);
        let moments = self.second - of_point(self.mass, centre);
        let inverse = moments.try_inverse().filter(|_| turns);
        let turn = |angular: Vector| inverse.map_or(Vector::zero(), |it| times(&it, angular));
        let [[momentum, angular], [force, moment]] = self.momenta;
        let spin = turn(angular - centre.cross(momentum));
        let gyration = spin.cross(times(&moments, spin));
        let per_mass = 1.0 / self.mass;
        self.centre = centre;
        self.rigid = [[momentum * per_mass, spin], [force * per_mass, turn(moment - centre.cross(force) - gyration)]];
    }

    /// What is left of a motion at this place.
    fn beside(&self, place: Vector, motions: &[Twist; 2]) -> [Twist; 2] {
        let arm = place - self.centre;
        let spin = self.rigid[0][1];
        // What turns is accelerated towards its axis.
        let inwards = [Vector::zero(), spin.cross(spin.cross(arm))];
        [0, 1].map(|k| {
            let ([velocity, spin], [rigid, turn]) = (motions[k], self.rigid[k]);
            [velocity - rigid - turn.cross(arm) - inwards[k], spin - turn]
        })
    }

    /// Energy of its vibration \[J\], the mean square of the angular frequency \[1/s²\], and the energy that its bonds hold beside it \[J\].
    fn vibration(&self) -> Option<[f64; 3]> {
        let ([kinetic, changing], [rate, of_rate]) = (self.inertial, self.elastic);
        let ratio = |up: f64, down: f64| if down > 0.0 { up / down } else { 0.0 };
        let mut square = ratio(rate, kinetic).max(ratio(of_rate, changing));
        for _ in 0..TURNS {
            square = ratio(square * rate + of_rate, square * kinetic + changing);
        }
        let potential = ratio(changing, square);
        let energy = kinetic + potential;
        let holds = square.is_finite() && square > 0.0 && energy.is_finite() && energy > 0.0;
        holds.then(|| [energy, square, (self.stored - potential).max(0.0) + ROUNDING * self.kinetic])
    }
}

/// How a body resists motion.
struct Inertia {
    /// Mass along each axis, 0 along those that forces do not move \[kg\].
    mass: [f64; 3],
    /// Moments of inertia about its point of reference, 0 where it does not turn \[kg m²\].
    turning: Matrix3<f64>,
    /// Whether forces move it along and about all axes; along some; or not at all.
    support: Option<bool>,
}

impl Inertia {
    /// What of a motion is along and about axes along and about which it has inertia: others are led.
    fn moved(&self, [along, about]: Twist) -> Twist {
        let turns = self.turning.diagonal();
        let of = |vector: Vector, holds: [bool; 3]| {
            let parts = vector.to_array();
            Vector::from([0, 1, 2].map(|axis| if holds[axis] { parts[axis] } else { 0.0 }))
        };
        [of(along, self.mass.map(|mass| mass > 0.0)), of(about, [0, 1, 2].map(|axis| turns[axis] > 0.0))]
    }

    /// Half of the mass times the square of a motion.
    fn half_square(&self, [along, about]: Twist) -> f64 {
        let [x, y, z] = along.to_array();
        let [a, b, c] = self.mass;
        0.5 * (a * x * x + b * y * y + c * z * z + about.dot(times(&self.turning, about)))
    }
}

/// A bond between two bodies.
struct Joint {
    /// The bodies.
    bodies: [usize; 2],
    /// From the point of reference of each to where it acts \[m\].
    points: [Vector; 2],
    /// Its axis.
    normal: Vector,
    /// Stiffness.
    stiffness: Frame,
}

impl Joint {
    /// Half of the stiffness times the square of these motions of its bodies.
    fn half_square(&self, [[velocity, spin], [other, turn]]: [Twist; 2]) -> f64 {
        let slip = velocity + spin.cross(self.points[0]) - other - turn.cross(self.points[1]);
        let turning = spin - turn;
        let parts = |vector: Vector| {
            let along = vector.dot(self.normal);
            [along * along, (vector.dot(vector) - along * along).max(0.0)]
        };
        let ([along, across], [twist, bend]) = (parts(slip), parts(turning));
        let [kn, kt, kz, kb] = self.stiffness;
        0.5 * (kn * along + kt * across + kz * twist + kb * bend)
    }
}

/// A matrix times a vector.
fn times(matrix: &Matrix3<f64>, vector: Vector) -> Vector {
    let [x, y, z] = vector.to_array();
    let found = matrix * Vector3::new(x, y, z);
    Vector::new(found.x, found.y, found.z)
}

/// Moments of inertia of a mass \[kg\] at this place \[m\].
fn of_point(mass: f64, place: Vector) -> Matrix3<f64> {
    let [x, y, z] = place.to_array();
    let place = Vector3::new(x, y, z);
    (Matrix3::identity() * place.norm_squared() - place * place.transpose()) * mass
}

impl System<'_> {
    /// Whether anything is bonded.
    pub(crate) fn is_bonded(&self) -> bool {
        self.state.bonds.iter().any(|list| !list.first.is_empty())
    }

    /// Finds the clusters of bonded bodies.
    pub(crate) fn find_clusters(&self, clusters: &mut Clusters) {
        clusters.begin(clusters::bodies(self.state));
        self.each_joint(&mut |joint| {
            let [a, b] = joint.points;
            clusters.unite(joint.bodies, a - b);
        });
        clusters.number();
    }

    /// The mean square of the angular frequency with which bonded bodies vibrate \[1/s²\]: of each cluster times the share that its
    /// vibration has in the energy of its bonds, by the energies of the vibrations. 0 where none vibrates.
    pub(crate) fn vibration(&self, vibrations: &mut Vibrations) -> f64 {
        let Vibrations { clusters, sums } = vibrations;
        sums.clear();
        sums.resize(clusters.len(), Sums::zero());
        self.find_rigid_motions(clusters, sums);
        self.sum_vibrations(clusters, sums);
        let (mut all, mut sum) = (0.0, 0.0);
        for [energy, square, held] in sums.iter().filter_map(Sums::vibration) {
            all += energy;
            sum += energy * square * (energy / (energy + held));
        }
        if all > 0.0 { sum / all } else { 0.0 }
    }

    /// Finds how each cluster moves as a rigid body: with what it hangs on or, in space, by its momentum.
    fn find_rigid_motions(&self, clusters: &Clusters, sums: &mut [Sums]) {
        for body in 0..clusters::bodies(self.state) {
            let Some(cluster) = clusters.of(body) else { continue };
            let inertia = self.inertia(body);
            let sums = &mut sums[cluster];
            match inertia.support {
                None => sums.add(&inertia, clusters.place(body), &self.motions(body)),
                // What stands or is led comes before what forces move along some axes.
                Some(moved) if sums.support.is_none_or(|(other, _)| other && !moved) => {
                    sums.support = Some((moved, body));
                }
                Some(_) => {}
            }
        }
        for (cluster, sums) in sums.iter_mut().enumerate() {
            match sums.support {
                None => sums.follow_momentum(!clusters.goes_around(cluster)),
                Some((_, body)) => {
                    let place = clusters.place(body);
                    let turns = if clusters.goes_around(cluster) { 0.0 } else { 1.0 };
                    sums.centre = place;
                    sums.rigid = self.motions(body).map(|[velocity, spin]| [velocity, spin * turns]);
                }
            }
        }
    }

    /// Sums what the bodies and bonds of each cluster do beside that.
    fn sum_vibrations(&self, clusters: &Clusters, sums: &mut [Sums]) {
        for body in 0..clusters::bodies(self.state) {
            let Some(cluster) = clusters.of(body) else { continue };
            let (inertia, sums) = (self.inertia(body), &mut sums[cluster]);
            let motions = self.motions(body);
            sums.kinetic += inertia.half_square(motions[0]);
            let beside = sums.beside(clusters.place(body), &motions);
            for (sum, motion) in sums.inertial.iter_mut().zip(beside) {
                *sum += inertia.half_square(motion);
            }
        }
        self.each_joint(&mut |joint| {
            let Some(cluster) = clusters.of(joint.bodies[0]) else { return };
            let sums = &mut sums[cluster];
            // From one body to the next, so that a cluster that goes around a cell has no jump.
            let place = clusters.place(joint.bodies[0]);
            let places = [place, place + joint.points[0] - joint.points[1]];
            let [first, second] = [0, 1].map(|end| {
                let body = joint.bodies[end];
                let inertia = self.inertia(body);
                sums.beside(places[end], &self.motions(body)).map(|motion| inertia.moved(motion))
            });
            for k in 0..2 {
                sums.elastic[k] += joint.half_square([first[k], second[k]]);
            }
        });
        for pass in self.passes.iter().filter(|pass| pass.source() == Source::Bonds) {
            pass.bonds(self.state, &mut |bond| {
                let slot = self.state.particles.slot[bond.first as usize];
                if let Some(cluster) = clusters.of(clusters::mover(self.state, slot)) {
                    sums[cluster].stored += bond.carried.energy;
                }
            });
        }
    }

    /// Tells every bond, and once more what its tension adds.
    fn each_joint(&self, tell: &mut dyn FnMut(Joint)) {
        let present = SearchLimits::default();
        for pass in self.passes.iter().filter(|pass| pass.source() == Source::Bonds) {
            pass.stiffness(self.state, &present, &mut |link| tell(self.joint(&link)));
        }
    }

    /// A bond as one between the bodies that move its particles.
    fn joint(&self, link: &Link) -> Joint {
        let (normal, stiffness) = (link.normal, link.stiffness);
        let first = self.end(link.first, normal * -link.arms[0]);
        let other = match (link.second, link.boundary) {
            (Some(second), _) => self.end(second, normal * link.arms[1]),
            (None, Some(boundary)) => {
                let body = self.state.particles.len() + boundary as usize;
                let centre = Vector::from(self.state.particles.position[link.first as usize]);
                (body, centre + normal * -link.arms[0] - self.reference(body))
            }
            (None, None) => first,
        };
        Joint { bodies: [first.0, other.0], points: [first.1, other.1], normal, stiffness }
    }

    /// The body that moves a particle (slot), and from its point of reference to a point that is there from the centre of the particle \[m\].
    fn end(&self, slot: u32, from_centre: Vector) -> (usize, Vector) {
        let body = clusters::mover(self.state, slot);
        if body < self.state.particles.len() {
            return (body, from_centre);
        }
        let original = self.state.particles.original(slot) as usize;
        let centre = match self.state.clump(original) {
            // A clump is brought back into a cell with its mass centre, a group stays where its pivot is.
            Some(_) => Vector::from(self.state.particles.position[original]),
            None => self.state.unwrapped(original).into(),
        };
        (body, centre - self.reference(body) + from_centre)
    }

    /// The point of reference of a body \[m\].
    fn reference(&self, body: usize) -> Vector {
        let (particles, boundaries) = (self.state.particles.len(), self.state.boundaries.len());
        match body.checked_sub(particles) {
            None => self.state.particles.position[body].into(),
            Some(group) if group < boundaries => self.state.boundaries[group].pivot.into(),
            Some(group) => self.state.clumps.position[group - boundaries].into(),
        }
    }

    /// Velocity and acceleration of a body, with what it turns by.
    fn motions(&self, body: usize) -> [Twist; 2] {
        let (particles, boundaries) = (&self.state.particles, &self.state.boundaries);
        let Some(group) = body.checked_sub(particles.len()) else {
            let (velocity, spin) = (particles.velocity[body], particles.angular_velocity[body]);
            let (force, torque) = (Vector::from(particles.force[body]), Vector::from(particles.torque[body]));
            return [[velocity.into(), spin.into()], [force * (1.0 / velocity[3]), torque * (1.0 / spin[3])]];
        };
        if group < boundaries.len() {
            let moved = &boundaries[group];
            let velocity = [moved.velocity.into(), moved.angular_velocity.into()];
            let Some(body) = self.bodies[group].as_ref().filter(|body| body.is_free()) else {
                return [velocity, [Vector::zero(); 2]];
            };
            return [velocity, body.rigid(moved).answer()];
        }
        let (clumps, clump) = (&self.state.clumps, group - boundaries.len());
        let velocity = [clumps.velocity[clump].into(), clumps.angular_velocity[clump].into()];
        let answer = bodies::numbered(self.bodies, self.state, group).map_or([Vector::zero(); 2], |body| body.answer());
        [velocity, answer]
    }

    /// How a body resists motion.
    fn inertia(&self, body: usize) -> Inertia {
        let (particles, boundaries) = (&self.state.particles, &self.state.boundaries);
        let Some(group) = body.checked_sub(particles.len()) else {
            let (mass, moment) = (particles.velocity[body][3], particles.angular_velocity[body][3]);
            return Inertia { mass: [mass; 3], turning: Matrix3::identity() * moment, support: None };
        };
        let root = bodies::numbered(self.bodies, self.state, group).map(|body| body.root([1.0; 2])).unwrap_or_default();
        let inverse = (root * root.transpose()).fixed_view::<3, 3>(3, 3).into_owned();
        if group < boundaries.len() {
            let Some(body) = self.bodies[group].as_ref().filter(|body| body.is_free()) else {
                return Inertia { mass: [0.0; 3], turning: Matrix3::zeros(), support: Some(false) };
            };
            let freedoms = body.freedoms();
            let of_axis = inverse.map(|part| if part > 0.0 { 1.0 / part } else { 0.0 });
            let turning = inverse.try_inverse().unwrap_or_else(|| Matrix3::from_diagonal(&of_axis.diagonal()));
            let mass = [0, 1, 2].map(|axis| if freedoms[axis] { body.mass } else { 0.0 });
            return Inertia { mass, turning, support: (freedoms != [true; 6]).then_some(true) };
        }
        let (clumps, clump) = (&self.state.clumps, group - boundaries.len());
        let turning = inverse.try_inverse().unwrap_or_else(Matrix3::zeros);
        Inertia { mass: [clumps.velocity[clump][3]; 3], turning, support: None }
    }
}
