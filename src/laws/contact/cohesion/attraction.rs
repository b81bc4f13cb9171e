//! What all attractions of touching bodies compute.

use crate::base::number::Number;
use crate::laws::contact::{CohesionForm, Contact, coefficients};

coefficients! {
    /// Attraction in proportion to the section of the overlapping bodies, exact or linearised.
    ///
    /// ```text
    /// F_c = −(c₁ A + c₂ R_s δ)
    /// ```
    ///
    /// A is the area of the circle in which the bodies intersect, R_s its radius of linearisation
    /// ([`Contact::section_radius`]), δ the overlap.
    pub struct Attraction {
        /// c₁ \[J/m³\].
        on_section,
        /// c₂ \[J/m³\].
        on_overlap,
        /// How much of the force friction sees: 1 with `tangential_reduce`, otherwise 0.
        seen_by_friction,
    }
}

impl CohesionForm for Attraction {
    #[inline(always)]
    fn force<N: Number>(law: Attraction<N>, contact: &Contact<N>) -> N {
        -(law.on_section * contact.section_area + law.on_overlap * contact.section_radius * contact.overlap)
    }

    #[inline(always)]
    fn seen_by_friction<N: Number>(law: Attraction<N>, force: N) -> N {
        law.seen_by_friction * force
    }
}
