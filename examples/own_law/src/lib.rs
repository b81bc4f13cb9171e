//! What another crate adds to the program: a contact sub-model ([`bridge`]), a rule of breakage of bonds ([`quadratic_stress`]) and a
//! shape of boundaries ([`ball`]).
//!
//! Each is one file and one call in [`models`]. This file makes the library of units, too; `main.rs` is the program, which checks,
//! runs and exports scenes that name them (`scene.toml`).

pub mod ball;
pub mod bridge;
pub mod quadratic_stress;

use cograin::scene::Models;

/// What scenes of the program may name, and what this crate adds.
pub fn models() -> Models {
    Models::standard()
        .with_cohesion::<bridge::LiquidBridge>()
        .with_breakage::<quadratic_stress::QuadraticStress>()
        .with_shape::<ball::Keys>()
}

cograin_unit::unit!(crate::models());

#[cfg(test)]
mod tests {
    use cograin::interface::{Interface, Value};
    use cograin::scene::Source;
    use cograin::simulation::Simulation;
    use std::sync::Arc;

    /// A scene that names all three.
    pub(crate) const SCENE: &str = include_str!("../scene.toml");

    /// The scene's source with this text.
    fn source(text: &str) -> Source {
        Source { name: "scene.toml".into(), text: text.into(), ..Source::default() }
    }

    /// What speaks against a text.
    pub(crate) fn told(text: &str) -> String {
        crate::models().scene(&source(text), &[]).unwrap_err().to_string()
    }

    /// A boundary of the scene that is moved along x, seen from outside.
    pub(crate) struct Coupled {
        /// The scene in motion.
        pub(crate) simulation: Simulation,
        /// Its variables.
        interface: Interface,
        /// The boundary.
        name: &'static str,
    }

    impl Coupled {
        /// As the scene begins.
        pub(crate) fn new(name: &'static str) -> Self {
            let scene = crate::models().scene(&source(SCENE), &[]).unwrap_or_else(|errors| panic!("{errors}"));
            let interface = Interface::of(&scene);
            Self { simulation: Simulation::new(Arc::new(scene)).unwrap(), interface, name }
        }

        /// The force on it along x once it is displaced this far \[N\].
        pub(crate) fn at(&mut self, displacement: f64) -> f64 {
            let place = |what: &str| self.interface.find(&format!("{}.{what}.x", self.name)).unwrap();
            let (input, output) = (place("displacement"), place("force"));
            self.interface.set(&mut self.simulation, input, Value::Real(displacement)).unwrap();
            self.simulation.advance(2e-4).unwrap();
            self.interface.value(&self.simulation, output).number()
        }
    }

    /// Fails, with both values, unless they agree to this part.
    #[track_caller]
    pub(crate) fn assert_close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "found {found:e}, expected {expected:e}");
    }
}
