//! Two bodies in any placement, and a reproducible source of random ones.

use crate::bond::{Body, Elastic, Formulation, Law, Motion, Pair, Quaternion, Rows};
use crate::number::Vector;

/// Radii of the trial pair \[m\].
pub(super) const RADII: [f64; 2] = [1.0, 0.6];

/// A linear congruential generator (Knuth's constants): enough for trial placements.
pub(super) struct Random(pub(super) u64);

impl Random {
    /// A number in −1 … 1.
    pub(super) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A vector of the cube −1 … 1.
    pub(super) fn vector(&mut self) -> Vector {
        Vector::new(self.number(), self.number(), self.number())
    }

    /// A turn by up to this angle \[rad\].
    pub(super) fn turn(&mut self, angle: f64) -> Quaternion {
        let axis = self.vector();
        turn(axis * (angle * self.number() / axis.length()))
    }
}

/// The turn by this rotation vector \[rad\], independent of the program's own map.
pub(super) fn turn(rotation: Vector) -> Quaternion {
    let angle = rotation.length();
    let share = if angle > 0.0 { libm::sin(angle / 2.0) / angle } else { 0.5 };
    Quaternion { scalar: libm::cos(angle / 2.0), vector: rotation * share }
}

/// Where two bodies are.
#[derive(Clone, Copy)]
pub(super) struct Placement {
    /// Positions \[m\].
    pub(super) position: [Vector; 2],
    /// Attitudes.
    pub(super) attitude: [Quaternion; 2],
}

impl Placement {
    /// Two bodies at about the distance of touch.
    pub(super) fn random(random: &mut Random) -> Self {
        let direction = random.vector();
        let connection = direction * (1.65 / direction.length());
        let position = random.vector();
        Self { position: [position + connection, position], attitude: [random.turn(3.0), random.turn(3.0)] }
    }

    /// The same with both bodies moved and turned on their own.
    pub(super) fn disturbed(mut self, random: &mut Random, distance: f64, angle: f64) -> Self {
        for body in 0..2 {
            self.position[body] += random.vector() * distance;
            self.attitude[body] = random.turn(angle) * self.attitude[body];
        }
        self
    }

    /// The same turned as a whole about the origin.
    pub(super) fn turned(self, whole: Quaternion) -> Self {
        Self {
            position: self.position.map(|position| whole.turn(position)),
            attitude: self.attitude.map(|attitude| whole * attitude),
        }
    }

    /// The pair at rest in this placement.
    pub(super) fn pair(&self) -> Pair {
        let body = |index: usize| Body {
            position: self.position[index],
            velocity: Vector::zero(),
            spin: Vector::zero(),
            attitude: self.attitude[index],
            radius: RADII[index],
            mass: 1.0,
            inertia: 1.0,
        };
        Pair::of_spheres(&body(0), &body(1))
    }
}

/// What a formulation answers to a placement, nothing moving.
pub(super) fn answer<F: Formulation>(law: &Law, placement: &Placement, rows: &Rows) -> Elastic<f64> {
    let (law, pair) = (law.coefficients(0.0), placement.pair());
    let motion: Motion = F::motion(&law, &pair);
    F::respond(&law, &pair, &motion, rows)
}

/// The state of a bond that is made in this placement.
pub(super) fn created<F: Formulation>(law: &Law, placement: &Placement) -> Rows {
    F::create(&law.coefficients(0.0), &placement.pair())
}

/// A law with four different stiffnesses of like size.
pub(super) fn law() -> Law {
    Law { torsion: 1.7, shear: 2.3, ..Law::elastic(0.9, 3.1, 2.0) }
}
