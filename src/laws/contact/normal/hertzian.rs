//! What all Hertzian models compute.

use crate::base::number::{Number, Row};
use crate::laws::contact::{Contact, NormalForm, Response, Roots, coefficients};

coefficients! {
    /// Stiffness and damping that grow with the radius of the contact.
    ///
    /// ```text
    /// a = √(R* δ)
    /// k_n = K_n a                        k_t = K_t a
    /// γ_n = C_n √(a m*) + D_n a m*       γ_t = C_t √(a m*) + D_t a m*
    /// ```
    ///
    /// The elastic force K_n √R* δ^(3/2) is Hertz's.
    pub struct Hertzian {
        /// K_n \[Pa\].
        normal_stiffness,
        /// K_t \[Pa\].
        tangential_stiffness,
        /// C_n \[√Pa\].
        normal_root_damping,
        /// C_t \[√Pa\].
        tangential_root_damping,
        /// D_n \[1/(m s)\].
        normal_mass_damping,
        /// D_t \[1/(m s)\].
        tangential_mass_damping,
    }
}

impl NormalForm for Hertzian {
    const HAS_ROOTS: bool = true;

    /// a and √(a m*).
    #[inline(always)]
    fn roots<N: Number>(overlap: N, radius: N, mass: N) -> Roots<N> {
        let contact_radius = (overlap * radius).sqrt();
        [contact_radius, (contact_radius * mass).sqrt()]
    }

    #[inline(always)]
    fn response_at<N: Number>(law: Hertzian<N>, contact: &Contact<N>, [contact_radius, root]: Roots<N>) -> Response<N> {
        let loaded_mass = contact_radius * contact.mass;
        Response {
            normal_stiffness: contact_radius * law.normal_stiffness,
            normal_damping: root * law.normal_root_damping + loaded_mass * law.normal_mass_damping,
            tangential_stiffness: contact_radius * law.tangential_stiffness,
            tangential_damping: root * law.tangential_root_damping + loaded_mass * law.tangential_mass_damping,
        }
    }

    fn elastic_energy(&self, contact: &Contact, offset: f64, _history: Row) -> f64 {
        // ∫ K √(R* δ) (δ − δ₀) dδ = K [√(R* δ) δ (2/5 δ − 2/3 δ₀)] from δ₀ to δ
        let below = |overlap: f64| (contact.radius * overlap).sqrt() * overlap * (0.4 * overlap - offset * 2.0 / 3.0);
        self.normal_stiffness * (below(contact.overlap) - below(offset))
    }

    fn tangent_stiffness(&self, contact: &Contact) -> f64 {
        1.5 * self.normal_stiffness * (contact.radius * contact.overlap).sqrt()
    }
}
