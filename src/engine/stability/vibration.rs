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
use super::bonded_motion::{Inertia, Twist, of_point, times};
use crate::base::number::Vector;
use crate::engine::bonds::clusters::{self, Clusters};
use crate::engine::state::ledger::Source;
use nalgebra::Matrix3;

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

impl System<'_> {
    /// Whether anything is bonded.
    pub(crate) fn is_bonded(&self) -> bool {
        self.state.is_bonded()
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
}
