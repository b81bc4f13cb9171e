//! Wear by sliding under load.

use super::{Rubbing, Wear};
use crate::base::document::keys;
use crate::base::quantity::Positive;

keys! {
    /// `[boundary.<name>.wear.archard]`
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// Volume over normal force and sliding distance, k \[1/Pa\].
        pub coefficient: Positive = "required",
    }
}

/// Wear by sliding under load.
///
/// ```text
/// V = k ∫ F_n ds          k = K/H
/// ```
///
/// | symbol | meaning                                             | unit | comes from    |
/// |--------|-----------------------------------------------------|------|---------------|
/// | V      | volume worn off the boundary                        | m³   |               |
/// | k      | wear coefficient K over the hardness H of the softer body | 1/Pa | `coefficient` |
/// | F_n    | normal force, where it presses                      | N    | the contact   |
/// | ds     | slip of the point of contact in the time step       | m    | the contact   |
///
/// Rolling without slip wears nothing. Holds for sliding without change of the surface's state: k of a pair of materials and an environment
/// is measured. The product k F_n is taken at the end of each time step, and the slip is that of the time step.
///
/// Source: J. F. Archard, *J. Appl. Phys.* 24 (1953) 981–988.
#[derive(Clone, Copy, Debug)]
pub struct Archard {
    /// k \[1/Pa\].
    coefficient: f64,
}

impl Wear for Archard {
    const NAME: &'static str = "archard";
    type Keys = Keys;
    const LOOKS_AT_TOUCH: bool = false;

    fn of(keys: &Keys) -> Self {
        Self { coefficient: keys.coefficient.get() }
    }

    fn volume(&self, rubbing: &Rubbing) -> f64 {
        self.coefficient * rubbing.force * rubbing.sliding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::wear::Touch;

    #[test]
    fn wears_the_coefficient_times_force_and_distance() {
        let law = Archard { coefficient: 0.5 };
        assert_eq!(law.volume(&Rubbing { force: 8.0, sliding: 0.25, touch: None }), 1.0);
    }

    #[test]
    fn a_touch_alone_wears_nothing() {
        let touch = Some(Touch { mass: 1.0, normal_speed: 1.0, tangential_speed: 1.0 });
        assert_eq!(Archard { coefficient: 0.5 }.volume(&Rubbing { force: 8.0, sliding: 0.0, touch }), 0.0);
    }
}
