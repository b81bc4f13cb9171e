//! Wear by impacts that cut.

use super::{Rubbing, Wear};
use crate::base::document::keys;
use crate::base::quantity::Positive;

keys! {
    /// `[boundary.<name>.wear.finnie]`
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// Plastic flow stress of the surface, p \[Pa\].
        pub flow_stress: Positive = "required",
        /// Length of the contact over the depth of the cut, ψ.
        pub depth_ratio: Option<Positive> = "2",
        /// Vertical over horizontal force at the cutting edge, K.
        pub force_ratio: Option<Positive> = "2",
    }
}

/// ψ and K of Finnie (1960).
const STANDARD_RATIO: f64 = 2.0;

/// Wear by hard particles that cut a ductile surface as they strike it.
///
/// ```text
/// V = m v²/(p ψ K) · (sin 2α − 6/K sin² α)      tan α ≤ K/6: the particle leaves while it cuts
/// V = m v²/(p ψ K) · K/6 cos² α                 tan α ≥ K/6: it stops along the surface before it leaves
/// ```
///
/// | symbol | meaning                                               | unit | comes from                    |
/// |--------|-------------------------------------------------------|------|-------------------------------|
/// | V      | volume worn off the boundary by one touch             | m³   |                               |
/// | m      | mass of the particle; the effective one where forces move the boundary | kg | the contact    |
/// | v, α   | relative speed at first touch, and its angle to the surface | m/s, 1 | the contact            |
/// | p      | plastic flow stress of the surface                    | Pa   | `flow_stress`                 |
/// | ψ      | length of the contact over the depth of the cut       | 1    | `depth_ratio`, 2 by default   |
/// | K      | vertical over horizontal force at the cutting edge    | 1    | `force_ratio`, 2 by default   |
///
/// Both branches agree at tan α = K/6 (18.4° for K = 2). Impacts along the normal wear nothing: real surfaces lose more at steep angles, by
/// other ways than cutting. Holds for many particles of which each cuts; where a share of them does, divide the flow stress by it.
///
/// Source: I. Finnie, *Wear* 3 (1960) 87–103.
#[derive(Clone, Copy, Debug)]
pub struct Finnie {
    /// 1/(p ψ K) \[1/Pa\].
    compliance: f64,
    /// K/6.
    steep: f64,
}

impl Wear for Finnie {
    const NAME: &'static str = "finnie";
    type Keys = Keys;
    const LOOKS_AT_TOUCH: bool = true;

    fn of(keys: &Keys) -> Self {
        let [depth, force] = [keys.depth_ratio, keys.force_ratio].map(|key| key.map_or(STANDARD_RATIO, Positive::get));
        Self { compliance: 1.0 / (keys.flow_stress.get() * depth * force), steep: force / 6.0 }
    }

    fn volume(&self, rubbing: &Rubbing) -> f64 {
        let Some(touch) = rubbing.touch else { return 0.0 };
        // v sin α and v cos α: the angle itself is not needed.
        let (normal, along) = (touch.normal_speed, touch.tangential_speed);
        let cut = if normal <= self.steep * along {
            2.0 * normal * along - normal * normal / self.steep
        } else {
            self.steep * along * along
        };
        self.compliance * touch.mass * cut
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::assert_close;
    use crate::laws::wear::Touch;

    /// The volume of one touch of a kilogram \[m³\] where p ψ K is 4 Pa and K is 2.
    fn volume(normal_speed: f64, tangential_speed: f64) -> f64 {
        let law = Finnie { compliance: 0.25, steep: 1.0 / 3.0 };
        law.volume(&Rubbing { touch: Some(Touch { mass: 1.0, normal_speed, tangential_speed }), ..Rubbing::default() })
    }

    #[test]
    fn a_flat_impact_is_that_of_the_first_branch() {
        // tan α = 1/4 < 1/3, v² = 17: sin 2α = 8/17, sin² α = 1/17.
        assert_close(volume(1.0, 4.0), 0.25 * 17.0 * (8.0 / 17.0 - 3.0 / 17.0), 1e-14);
    }

    #[test]
    fn a_steep_impact_is_that_of_the_second_branch() {
        // tan α = 4/3, v² = 25: cos² α = 9/25.
        assert_close(volume(4.0, 3.0), 0.25 * 25.0 * (9.0 / 25.0) / 3.0, 1e-14);
    }

    #[test]
    fn both_branches_agree_where_they_meet() {
        assert_close(volume(1.0, 3.0), volume(1.0 + 1e-12, 3.0), 1e-11);
    }

    #[test]
    fn impacts_along_the_normal_and_contacts_that_last_wear_nothing() {
        assert_eq!(volume(5.0, 0.0), 0.0);
        let law = Finnie { compliance: 0.25, steep: 1.0 / 3.0 };
        assert_eq!(law.volume(&Rubbing { force: 5.0, sliding: 2.0, touch: None }), 0.0);
    }

    #[test]
    fn ratios_are_those_of_finnie_unless_others_are_given() {
        let keys = Keys { flow_stress: Positive::new(1e9).unwrap(), depth_ratio: None, force_ratio: None };
        let Finnie { compliance, steep } = Finnie::of(&keys);
        assert_eq!((compliance, steep), (1.0 / 4e9, 2.0 / 6.0));
    }
}
