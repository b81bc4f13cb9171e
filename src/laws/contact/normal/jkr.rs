//! Sticky elastic spheres, soft or large: they pull beyond touch.

use super::sticky::{self, Damping, DampingKind};
use crate::base::document::keys;
use crate::base::number::{Number, Row};
use crate::laws::contact::{
    Adhesion, Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForce, NormalForm, Response, Roots,
    Switches, coefficients,
};
use serde::Deserialize;
use std::f64::consts::PI;

coefficients! {
    /// Johnson, Kendall and Roberts' spheres with surface energy.
    ///
    /// ```text
    /// δ    = a²/R* − 2 √(π γ a/E*)                      the contact radius a, in closed form
    /// F_e  = 4/3 E* a³/R* − 4 √(π γ E*) a^(3/2)
    /// F_po = 3 π γ R*
    /// F_n  = F_e − γ_n v_n          N = |F_e + 2 F_po|
    /// γ_n  = η m* a, η m* or η      γ_t = x_t γ_n
    /// k_n  = 4/3 E* a               k_t = 8 G* a        for the other sub-models
    /// ```
    ///
    /// | symbol | meaning                                   | unit | comes from                 |
    /// |--------|-------------------------------------------|------|----------------------------|
    /// | δ      | overlap, below 0 beyond touch             | m    | the contact                |
    /// | R*, m* | effective radius and mass                 | m, kg| the contact                |
    /// | E*, G* | effective moduli                          | Pa   | two materials              |
    /// | γ      | surface energy; work of adhesion is 2 γ   | J/m² | `surface_energy`           |
    /// | η      | damping                                   | as `damping` says | `damping_coefficient` |
    /// | x_t    | tangential over normal damping            | 1    | `tangential_damping_ratio` |
    /// | N      | normal force that friction and rolling see| N    |                            |
    ///
    /// A contact begins when the bodies touch (δ = 0), with a pull of 8/9 F_po, and lasts until they are δ_po apart,
    ///
    /// ```text
    /// δ_po = (3π²/16)^(1/3) (R* γ²/E*²)^(1/3)       tear_off = "largest_pull": F_po there
    /// δ_po = (27π²/16)^(1/3) (R* γ²/E*²)^(1/3)      tear_off = "whole_branch": 5/9 F_po there
    /// ```
    ///
    /// The second is where the curve itself ends: beyond the largest pull the neck thins while the pull falls. To part from touch then
    /// takes the work 7.09 (32 γ⁵ R\*⁴/E\*²)^(1/3), twice that of the first. Bodies that approach feel nothing before
    /// touch. For soft, large, sticky spheres (Tabor's number above 5); for hard small ones see `dmt`.
    ///
    /// With `engine_exact` the slip velocity has arms R instead of R − δ/2, and the torque at a wall too, as in the engine.
    /// The powers in velocity and torque then differ by δ/2R.
    ///
    /// Source: K. L. Johnson, K. Kendall & A. D. Roberts, *Proc. R. Soc. Lond. A* 324 (1971) 301–313; E. Parteli et al.,
    /// *Sci. Rep.* 4 (2014) 6227 (a in closed form); C. Thornton, *J. Phys. D* 24 (1991) 1942 (limit of friction); C. Thornton &
    /// Z. Ning, *Powder Technol.* 99 (1998) 154–162 (whole branch); LAMMPS manual, `pair_style granular`.
    pub struct Jkr {
        /// E* \[Pa\].
        youngs_modulus,
        /// γ \[J/m²\].
        surface_energy,
        /// k_t over the contact radius \[Pa\].
        tangential_modulus,
        /// η of γ_n = η m* a \[1/(m s)\].
        viscoelastic_damping,
        /// η of γ_n = η m* \[1/s\].
        mass_damping,
        /// η of γ_n = η \[kg/s\].
        plain_damping,
        /// x_t.
        tangential_damping_ratio,
        /// δ_po over (R* γ²/E*²)^(1/3).
        reach,
    }
}

/// Where a contact ends that is pulled apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TearOff {
    /// At the largest pull, as under a dead load.
    #[default]
    LargestPull,
    /// Where the curve of force and overlap ends, as between grips.
    WholeBranch,
}

impl TearOff {
    /// δ_po over (R* γ²/E*²)^(1/3).
    fn reach(self) -> f64 {
        let cube = match self {
            Self::LargestPull => 3.0,
            Self::WholeBranch => 27.0,
        };
        libm::cbrt(cube * PI * PI / 16.0)
    }
}

keys! {
    /// `[contact.<law>.normal.jkr]`
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// γ_n follows mass and contact radius (`"viscoelastic"`), mass (`"mass_velocity"`), or neither (`"velocity"`).
        #[serde(default)]
        pub damping: DampingKind = "`\"viscoelastic\"`",
        /// Whether k_t is `tangential_stiffness` \[Pa\] times the contact radius, not 8 G* times it.
        #[serde(default)]
        pub given_tangential_modulus: bool = "`false`",
        /// Whether slip is that of the undeformed spheres, and torques at walls have their arms, as in the engine.
        #[serde(default)]
        pub engine_exact: bool = "`false`",
        /// A contact ends at the `"largest_pull"`, or where the curve of force and overlap ends (`"whole_branch"`).
        #[serde(default)]
        pub tear_off: TearOff = "`\"largest_pull\"`",
    }
}

impl Keys {
    /// Those that it shares with other models.
    fn shared(&self) -> sticky::Keys {
        let Self { damping, given_tangential_modulus, engine_exact, .. } = *self;
        sticky::Keys { damping, given_tangential_modulus, engine_exact }
    }
}

impl<N: Number> Jkr<N> {
    /// What damps.
    #[inline(always)]
    fn damping(&self) -> Damping<N> {
        Damping {
            viscoelastic: self.viscoelastic_damping,
            mass: self.mass_damping,
            plain: self.plain_damping,
            tangential_ratio: self.tangential_damping_ratio,
        }
    }

    /// Contact radius a of an overlap \[m\]: found in effective radii, for the roots are those of numbers without unit.
    #[inline(always)]
    fn contact_radius(&self, overlap: N, radius: N) -> N {
        /// Keeps quotients of a contact without surface energy and overlap at 0.
        const LEAST: f64 = 1e-100;
        let number = N::splat;
        let per_radius = number(1.0) / radius;
        let overlap = overlap * per_radius;
        let energy = self.surface_energy / self.youngs_modulus * per_radius;
        let surface = energy * energy;
        let first = number(27.0 * PI * PI) * surface;
        let second = number(8.0) * overlap * overlap * overlap;
        let inner = (surface * (first + second + second)).max(N::zero()).sqrt();
        let cube = first + second + number(3.0 * SQRT_3 * PI) * inner;
        let root = cube.max(N::zero()).cube_root().max(number(LEAST));
        let sum = number(4.0) * overlap * overlap / root + root;
        let outer = (overlap + overlap + sum).max(N::zero()).sqrt().max(number(LEAST));
        let pull = number(6.0 * SQRT_6 * PI) * energy / outer;
        let inner = (number(4.0) * overlap - sum + pull).max(N::zero()).sqrt();
        radius * ((outer + inner) * number(1.0 / SQRT_6))
    }

    /// Force at a contact radius \[N\].
    #[inline(always)]
    fn elastic(&self, contact_radius: N, radius: N) -> N {
        let square = contact_radius * contact_radius;
        let pull = (N::splat(PI) * self.surface_energy * self.youngs_modulus * contact_radius).sqrt();
        N::splat(4.0 / 3.0) * self.youngs_modulus * square * contact_radius / radius
            - N::splat(4.0) * contact_radius * pull
    }
}

/// √3.
const SQRT_3: f64 = 1.732_050_807_568_877_2;
/// √6.
const SQRT_6: f64 = 2.449_489_742_783_178;

impl Jkr {
    /// Energy of a contact of this radius against one of radius 0: its derivative by the overlap is the force \[J\].
    fn energy(&self, contact_radius: f64, radius: f64) -> f64 {
        let (modulus, energy) = (self.youngs_modulus, self.surface_energy);
        let (a, root) = (contact_radius, (PI * energy * modulus * contact_radius).sqrt());
        8.0 / 15.0 * modulus * a * a * a * a * a / (radius * radius) - 8.0 / 3.0 * root * a * a * a / radius
            + 2.0 * PI * energy * a * a
    }
}

impl Normal for Jkr {
    const NAME: &'static str = "jkr";
    type Keys = Keys;
    type Form = Self;
    const ELASTIC_SPHERES: bool = true;

    fn between(pair: &MaterialPair, keys: &Keys, friction: FrictionNeeds) -> Result<Self, Missing> {
        let [modulus, energy, tangential, viscoelastic, mass, plain, ratio] =
            keys.shared().coefficients(pair, friction)?;
        Ok(Self::new(modulus, energy, tangential, viscoelastic, mass, plain, ratio, keys.tear_off.reach()))
    }

    fn has_undeformed_arms(keys: &Keys) -> bool {
        keys.engine_exact
    }
}

impl NormalForm for Jkr {
    const ADHESION: Adhesion = Adhesion::BeyondTouch;
    const HAS_PAIR_CONSTANT: bool = true;

    fn pair_constant(&self, radius: f64, _mass: f64) -> f64 {
        self.reach(radius)
    }

    fn reach(&self, radius: f64) -> f64 {
        let ratio = self.surface_energy / self.youngs_modulus / radius;
        self.reach * radius * libm::cbrt(ratio * ratio)
    }

    #[inline(always)]
    fn contact_radius<N: Number>(law: Jkr<N>, overlap: N, radius: N) -> N {
        law.contact_radius(overlap, radius)
    }

    #[inline(always)]
    fn response_at<N: Number>(law: Jkr<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        let contact_radius = law.contact_radius(contact.overlap, contact.radius);
        sticky::response(law.youngs_modulus, law.tangential_modulus, law.damping(), contact.mass, contact_radius)
    }

    #[inline(always)]
    fn force<N: Number>(
        law: Jkr<N>,
        switches: Switches<N>,
        contact: &Contact<N>,
        _roots: Roots<N>,
        history: [N; 4],
        _step: N,
    ) -> (NormalForce<N>, [N; 4]) {
        let contact_radius = law.contact_radius(contact.overlap, contact.radius);
        let response =
            sticky::response(law.youngs_modulus, law.tangential_modulus, law.damping(), contact.mass, contact_radius);
        let elastic = law.elastic(contact_radius, contact.radius);
        let pull_off = N::splat(3.0 * PI) * law.surface_energy * contact.radius;
        (sticky::force(response, switches, contact, elastic, pull_off), history)
    }

    fn elastic_energy(&self, contact: &Contact, _offset: f64, _history: Row) -> f64 {
        let at = |overlap: f64| self.energy(self.contact_radius(overlap, contact.radius), contact.radius);
        at(contact.overlap) - at(0.0)
    }

    fn tangent_stiffness(&self, contact: &Contact) -> f64 {
        // dF/dδ = 2 E* a (3 − 3 s)/(3 − s), s = (a_po/a)^(3/2), with a_po that of the largest pull; below 0 beyond that.
        let (modulus, radius) = (self.youngs_modulus, contact.radius);
        let a = self.contact_radius(contact.overlap, radius);
        let ratio = 1.5 * (PI * self.surface_energy / modulus / a).sqrt() * (radius / a);
        let slope = (3.0 - 3.0 * ratio) / (3.0 - ratio);
        if ratio < 1.0 { 2.0 * modulus * a * slope } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};

    /// E* = 1 Pa, γ = 1e-6 J/m²; R* = ¼ m.
    fn law() -> Jkr {
        with_pair(&properties(), |pair| Jkr::between(pair, &Keys::default(), ALL)).unwrap()
    }

    /// Elastic force at this overlap, without motion.
    fn force(overlap: f64) -> f64 {
        let contact = Contact { overlap, normal_velocity: 0.0, ..contact() };
        Jkr::force(law(), Switches::of(false, true), &contact, [0.0; 2], [0.0; 4], 0.0).0.force
    }

    /// 3 π γ R*.
    const PULL_OFF: f64 = 3.0 * PI * 1e-6 * 0.25;

    #[test]
    fn contact_radius_solves_the_equation_of_the_overlap() {
        for overlap in [1e-3, 1e-4, 1e-6, 0.0, -0.5 * law().reach(0.25), -0.999 * law().reach(0.25)] {
            let a = law().contact_radius(overlap, 0.25);
            let found = a * a / 0.25 - 2.0 * (PI * 1e-6 * a).sqrt();
            assert!((found - overlap).abs() <= 1e-13 * a, "{found:e} m, {overlap:e} m expected");
        }
    }

    #[test]
    fn pulls_with_eight_ninths_of_the_pull_off_force_at_touch_and_all_of_it_at_its_reach() {
        assert_close(force(0.0), -8.0 / 9.0 * PULL_OFF, 1e-13);
        // Where the slope is 0 the root of a rounding remains.
        assert_close(force(-law().reach(0.25)), -PULL_OFF, 1e-7);
    }

    #[test]
    fn the_whole_branch_ends_where_the_curve_does_with_five_ninths_of_the_pull_off_force() {
        let keys = Keys { tear_off: TearOff::WholeBranch, ..Keys::default() };
        let whole = with_pair(&properties(), |pair| Jkr::between(pair, &keys, ALL)).unwrap();
        let contact = Contact { overlap: -whole.reach(0.25), normal_velocity: 0.0, ..contact() };
        let found = Jkr::force(whole, Switches::of(false, true), &contact, [0.0; 2], [0.0; 4], 0.0).0.force;
        // a changes with the root of what is left of the overlap there.
        assert_close(found, -5.0 / 9.0 * PULL_OFF, 1e-6);
        assert_close(whole.reach(0.25), 3.0 * (PI * PI * 1e-12 * 0.25 / 16.0_f64).cbrt(), 1e-14);
        assert_eq!(whole.tangent_stiffness(&contact), 0.0);
    }

    #[test]
    fn is_hertz_without_surface_energy() {
        let smooth = Jkr { surface_energy: 0.0, ..law() };
        let contact = Contact { normal_velocity: 0.0, ..contact() };
        let found = Jkr::force(smooth, Switches::of(false, true), &contact, [0.0; 2], [0.0; 4], 0.0).0;
        assert_close(found.force, 4.0 / 3.0 / 256.0 / 16384.0, 1e-14);
        assert!(smooth.contact_radius(0.0, 0.25) < 1e-40);
    }

    #[test]
    fn friction_sees_the_elastic_force_and_twice_the_pull_off_force_without_the_dashpot() {
        let found = Jkr::force(law(), Switches::of(false, true), &contact(), [0.0; 2], [0.0; 4], 0.0).0;
        let elastic = force(contact().overlap);
        assert_close(found.seen, elastic + 2.0 * PULL_OFF, 1e-14);
        // η m* a of η = 2/(m s), m* = 4 kg, against ½ m/s
        let a = law().contact_radius(contact().overlap, 0.25);
        assert_close(found.force, elastic + 2.0 * 4.0 * a * 0.5, 1e-14);
    }

    #[test]
    fn force_is_the_slope_of_the_energy() {
        let at = |overlap| Contact { overlap, ..contact() };
        for overlap in [1e-4, -0.5 * law().reach(0.25)] {
            let by = 1e-4 * law().reach(0.25);
            let energy = |overlap| law().elastic_energy(&at(overlap), 0.0, [0.0; 4]);
            assert_close((energy(overlap + by) - energy(overlap - by)) / (2.0 * by), force(overlap), 1e-6);
            let slope = (force(overlap + by) - force(overlap - by)) / (2.0 * by);
            assert_close(law().tangent_stiffness(&at(overlap)), slope, 1e-6);
        }
        assert_eq!(law().elastic_energy(&at(0.0), 0.0, [0.0; 4]), 0.0);
    }
}
