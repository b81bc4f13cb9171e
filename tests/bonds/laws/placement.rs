//! Two bodies in any placement, and a reproducible source of random ones.

use cograin::bond::{Body, Elastic, Elasticity, Formulation, Pair, Quaternion, Rows};
use cograin::number::Vector;

/// Radii of the test pair \[m\].
pub(crate) const RADII: [f64; 2] = [1.0, 0.6];

/// A linear congruential generator (Knuth's constants): enough for test placements.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number in −1 … 1.
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A vector of the cube −1 … 1.
    pub(crate) fn vector(&mut self) -> Vector {
        Vector::new(self.number(), self.number(), self.number())
    }

    /// A turn by up to this angle \[rad\].
    pub(crate) fn turn(&mut self, angle: f64) -> Quaternion {
        let axis = self.vector();
        turn(axis * (angle * self.number() / axis.length()))
    }
}

/// The turn by this rotation vector \[rad\], independent of the program's own map.
pub(crate) fn turn(rotation: Vector) -> Quaternion {
    let angle = rotation.length();
    let share = if angle > 0.0 { libm::sin(angle / 2.0) / angle } else { 0.5 };
    Quaternion { scalar: libm::cos(angle / 2.0), vector: rotation * share }
}

/// Where two bodies are.
#[derive(Clone, Copy)]
pub(crate) struct Placement {
    /// Positions \[m\].
    pub(crate) position: [Vector; 2],
    /// Orientations.
    pub(crate) orientation: [Quaternion; 2],
}

impl Placement {
    /// Two bodies at about the distance of touch.
    pub(crate) fn random(random: &mut Random) -> Self {
        let direction = random.vector();
        let connection = direction * (1.65 / direction.length());
        let position = random.vector();
        Self { position: [position + connection, position], orientation: [random.turn(3.0), random.turn(3.0)] }
    }

    /// The same with both bodies moved and turned on their own.
    pub(crate) fn disturbed(mut self, random: &mut Random, distance: f64, angle: f64) -> Self {
        for body in 0..2 {
            self.position[body] += random.vector() * distance;
            self.orientation[body] = random.turn(angle) * self.orientation[body];
        }
        self
    }

    /// The same turned as a whole about the origin.
    pub(crate) fn turned(self, whole: Quaternion) -> Self {
        Self {
            position: self.position.map(|position| whole.turn(position)),
            orientation: self.orientation.map(|orientation| whole * orientation),
        }
    }

    /// The pair at rest in this placement.
    pub(crate) fn pair(&self) -> Pair {
        let body = |index: usize| Body {
            position: self.position[index],
            velocity: Vector::zero(),
            spin: Vector::zero(),
            orientation: self.orientation[index],
            radius: RADII[index],
            mass: 1.0,
            inertia: 1.0,
        };
        Pair::of_spheres(&body(0), &body(1))
    }
}

/// What a formulation answers to a placement, nothing moving.
pub(crate) fn answer<F: Formulation>(law: &Elasticity, placement: &Placement, rows: &Rows) -> Elastic<f64> {
    F::respond(&law.at_step(0.0), &placement.pair(), rows).1
}

/// The state of a bond that is made in this placement.
pub(crate) fn created<F: Formulation>(law: &Elasticity, placement: &Placement) -> Rows {
    F::create(&law.at_step(0.0), &placement.pair())
}

/// A law with four different stiffnesses of like size.
pub(crate) fn law() -> Elasticity {
    Elasticity { torsion: 1.7, shear: 2.3, ..Elasticity::of(0.9, 3.1, 2.0) }
}
