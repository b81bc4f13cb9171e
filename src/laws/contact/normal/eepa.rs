//! Elasto-plastic spheres that stick where they were pressed.

use crate::base::document::keys;
use crate::base::number::{Number, Row};
use crate::laws::contact::{
    Adhesion, Contact, FrictionNeeds, HistoryRow, MaterialPair, Missing, Needs, Normal, NormalForce, NormalForm,
    Objection, Onset, Response, Roots, Switches, coefficients, property,
};
use serde::Deserialize;
use std::f64::consts::PI;

coefficients! {
    /// An edinburgh elasto-plastic adhesive contact: the overlap remembers, and the contact adheres.
    ///
    /// ```text
    /// n = 1:    k₁ = 2 E* R*           k_t = 2 E* √(R* δ)
    /// n = 3/2:  k₁ = 4/3 E* √R*        k_t = 8 G* √(R* δ)
    /// k₂ = k₁ (k₂/k₁)
    /// γ_n = γ_t = 2 |β| √(m* k₁)                       n = 1;  β = ln e/√(ln² e + π²)
    /// γ_n = γ_t = 2 √(5/6) |β| √(3/2 m* k₁ √δ)          n = 3/2
    ///
    /// δ_p ← max(δ_p, δ (1 − k₁/k₂)^(1/n))
    /// F = k₁ δⁿ                        loading: where k₂ (δⁿ − δ_pⁿ) is not below it
    /// F = k₂ (δⁿ − δ_pⁿ)               unloading and reloading: where it is above −k_a δ^χ
    /// F = −k_a δ^χ                     adhesion branch; δ > δ_o there: δ_p ← (δ_oⁿ + k_a/k₂ δ_o^χ)^(1/n), once more
    /// k_a = f/δ_m^χ     f = min(3/2 π γ a, ½ k₂ δ_pⁿ),  F = −f at δ_m on the line of unloading
    /// F_n = F − γ_n v_n − f₀           N = |F_n|
    /// ```
    ///
    /// | symbol   | meaning                                       | unit   | comes from                  |
    /// |----------|-----------------------------------------------|--------|-----------------------------|
    /// | δ, δ_o   | overlap, that of the evaluation before        | m      | the contact, the history    |
    /// | δ_p      | plastic overlap                               | m      | the history                 |
    /// | R*, m*   | effective radius and mass                     | m, kg  | the contact                 |
    /// | E*, G*   | effective moduli                              | Pa     | two materials               |
    /// | a        | radius of the patch that δ_p leaves: of the circle in which the spheres intersect there | m | the contact |
    /// | n        | 1 or 3/2                                      | 1      | `overlap_exponent`          |
    /// | χ        | 1, 3/2, 2, 3 or 5                             | 1      | `adhesion_exponent`         |
    /// | k₂/k₁    | stiffness of unloading over loading           | 1      | `unloading_stiffness_ratio` |
    /// | γ        | surface energy                                | J/m²   | `surface_energy`            |
    /// | f₀       | constant attraction while the bodies touch    | N      | `pull_off_force`            |
    /// | e        | restitution, lower where k₂ is above k₁       | 1      | `restitution`               |
    ///
    /// With `adhesion = "fixed"` (n = χ = 1) k_a is `adhesion_stiffness_ratio` times k₁ and δ_p is the largest overlap:
    ///
    /// ```text
    /// F = k₂ (δ − δ_p) + k₁ δ_p,  at most k₁ δ,  and at least −k_a δ: then δ_p = δ (k₂ + k_a)/(k₂ − k₁)
    /// ```
    ///
    /// `limit_force` cuts the pull of the dashpot where nothing adheres. k_n for the other sub-models is k₁ δ^(n − 1).
    /// Everything is forgotten when the bodies part. Give the time step for k₂ at the largest load.
    ///
    /// `engine_exact` does as the engine. Where f is ½ k₂ δ_pⁿ, δ_m = ½ δ_p, whatever n. At walls a = 0, so surface energy
    /// does not act there. k_n for the other sub-models is k₁, and γ_n that of n = 1, whatever n: numbers that depend on the
    /// units. `limit_force` does not see a fixed k_a and cuts it off.
    ///
    /// Source: J. P. Morrissey, PhD thesis, University of Edinburgh (2013); S. C. Thakur, J. P. Morrissey, J. Sun, J. F.
    /// Chen & J. Y. Ooi, *Granul. Matter* 16 (2014) 383–400; LIGGGHTS, model `edinburgh`.
    pub struct Eepa {
        /// E* \[Pa\].
        youngs_modulus,
        /// k_t/√(R* δ) \[Pa\].
        tangential_modulus,
        /// 4/(1 + (π/ln e)²).
        damping,
        /// k₂/k₁.
        unloading_ratio,
        /// (1 − k₁/k₂)^(1/n).
        plastic_ratio,
        /// 3/2 π γ \[J/m²\].
        pull_on_patch,
        /// f₀ \[N\].
        pull_off_force,
        /// n.
        overlap_exponent,
        /// χ.
        adhesion_exponent,
        /// 1 where k_a is fixed, otherwise 0.
        fixed,
        /// k_a/k₁ where it is fixed.
        adhesion_ratio,
        /// 1 with `engine_exact`, otherwise 0.
        engine,
    }
}

/// Where the stiffness of the adhesion branch comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AdhesionKind {
    /// The patch that the plastic overlap leaves.
    #[default]
    Patch,
    /// `adhesion_stiffness_ratio`.
    Fixed,
}

keys! {
    /// `[contact.<law>.normal.eepa]`
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// n: 1 or 1.5.
        pub overlap_exponent: f64 = "required",
        /// χ: 1, 1.5, 2, 3 or 5.
        pub adhesion_exponent: f64 = "required",
        /// Stiffness of the adhesion branch: from the patch that the plastic overlap leaves (`"patch"`), or given (`"fixed"`, with
        /// both exponents 1).
        #[serde(default)]
        pub adhesion: AdhesionKind = "`\"patch\"`",
        /// Whether walls, k_n and `limit_force` are as in the engine.
        #[serde(default)]
        pub engine_exact: bool = "`false`",
    }
}

impl Keys {
    /// Whether loading is Hertz's.
    fn is_hertzian(&self) -> bool {
        self.overlap_exponent > 1.25
    }
}

impl Normal for Eepa {
    const NAME: &'static str = "eepa";
    type Keys = Keys;
    type Form = Self;
    const DAMPED_AT_TOUCH: bool = true;

    fn onset(keys: &Keys) -> Onset {
        if keys.is_hertzian() && !keys.engine_exact { Onset::FourthRoot } else { Onset::Constant }
    }

    fn between(pair: &MaterialPair, keys: &Keys, friction: FrictionNeeds) -> Result<Self, Missing> {
        let (modulus, linear) = (pair.effective_youngs_modulus()?, !keys.is_hertzian());
        let tangential = match (friction.stiffness, linear) {
            (false, _) => 0.0,
            (true, true) => 2.0 * modulus,
            (true, false) => 8.0 * pair.effective_shear_modulus()?,
        };
        let log = libm::log(pair.get(&property::RESTITUTION)?);
        let ratio = pair.get(&property::UNLOADING_STIFFNESS_RATIO)?;
        let plastic = 1.0 - 1.0 / ratio;
        let root = libm::cbrt(plastic);
        let fixed = keys.adhesion == AdhesionKind::Fixed;
        let number = |yes: bool| if yes { 1.0 } else { 0.0 };
        Ok(Self::new(
            modulus,
            tangential,
            4.0 * log * log / (log * log + PI * PI),
            ratio,
            if linear { plastic } else { root * root },
            if fixed { 0.0 } else { 1.5 * PI * pair.get(&property::SURFACE_ENERGY)? },
            pair.get(&property::PULL_OFF_FORCE)?,
            keys.overlap_exponent,
            keys.adhesion_exponent,
            number(fixed),
            if fixed { pair.get(&property::ADHESION_STIFFNESS_RATIO)? } else { 0.0 },
            number(keys.engine_exact),
        ))
    }

    fn objection(keys: &Keys) -> Option<Objection> {
        let table = "normal";
        if ![1.0, 1.5].contains(&keys.overlap_exponent) {
            let reason = "expected 1 or 1.5, found another number";
            return Some(Objection { table, key: "overlap_exponent", reason });
        }
        if ![1.0, 1.5, 2.0, 3.0, 5.0].contains(&keys.adhesion_exponent) {
            let reason = "expected 1, 1.5, 2, 3 or 5, found another number";
            return Some(Objection { table, key: "adhesion_exponent", reason });
        }
        let linear = keys.overlap_exponent == 1.0 && keys.adhesion_exponent == 1.0;
        let reason = "expected overlap_exponent = 1 and adhesion_exponent = 1, or \"patch\", found \"fixed\", whose \
                      plastic overlap holds for linear branches alone";
        (keys.adhesion == AdhesionKind::Fixed && !linear).then_some(Objection { table, key: "adhesion", reason })
    }
}

/// One evaluation of the branches.
struct Branch<N> {
    /// F \[N\].
    force: N,
    /// Above 0 where it was looked at and adheres.
    adhesion: N,
    /// δ_p \[m\].
    plastic: N,
}

impl<N: Number> Eepa<N> {
    /// Whether n is 3/2.
    #[inline(always)]
    fn is_bent(&self) -> N::Mask {
        self.overlap_exponent.greater(N::splat(1.25))
    }

    /// xⁿ R*^(2 − n) of an x of 0 or above \[m²\]: the root is that of an area, so that its bits do not depend on the unit.
    #[inline(always)]
    fn raised(&self, x: N, radius: N) -> N {
        x * self.of_slope(x, radius)
    }

    /// x^(n − 1) R*^(2 − n) of an x of 0 or above \[m\].
    #[inline(always)]
    fn of_slope(&self, x: N, radius: N) -> N {
        N::select(self.is_bent(), (radius * x).sqrt(), radius)
    }

    /// The x that was raised to this area \[m\], by R* and 1/R*: the cube root is that of a number without unit.
    #[inline(always)]
    fn lowered(&self, area: N, [radius, curvature]: [N; 2]) -> N {
        let length = area.max(N::zero()) * curvature;
        let root = (length * curvature).cube_root();
        N::select(self.is_bent(), radius * (root * root), length)
    }

    /// x^χ of an x of 0 or above, with χ = 3/2 times √R*.
    #[inline(always)]
    fn adhering(&self, x: N, radius: N) -> N {
        let (chi, square) = (self.adhesion_exponent, x * x);
        let high = N::select(chi.greater(N::splat(4.0)), square * square * x, square * x);
        let middle = N::select(chi.greater(N::splat(2.5)), high, square);
        let low = N::select(chi.greater(N::splat(1.25)), x * (radius * x).sqrt(), x);
        N::select(chi.greater(N::splat(1.75)), middle, low)
    }

    /// k₁ over R*^(2 − n) \[Pa\].
    #[inline(always)]
    fn loading(&self) -> N {
        self.youngs_modulus * N::select(self.is_bent(), N::splat(4.0 / 3.0), N::splat(2.0))
    }

    /// Radius of the patch that a plastic overlap leaves \[m\].
    #[inline(always)]
    fn patch(&self, contact: &Contact<N>, plastic: N) -> N {
        let (one, two) = (N::splat(1.0), N::splat(2.0));
        let (share, radius) = (plastic * contact.per_reach, contact.radius);
        let square = plastic * (N::splat(4.0) * radius - two * plastic + plastic * share) * (two - share);
        let patch = square.max(N::zero()).sqrt() / (two * (one - share));
        let own = N::select(self.engine.greater(N::splat(0.5)), N::zero(), patch);
        N::select(contact.per_reach.greater(N::zero()), patch, own)
    }

    /// The branches where the patch sets the adhesion.
    #[inline(always)]
    fn branch(&self, contact: &Contact<N>, loading: N, [plastic, before]: [N; 2]) -> Branch<N> {
        /// Times that the plastic overlap is found anew where a contact reloads from the adhesion branch: the first
        /// is right but for rounding.
        const TURNS: usize = 8;
        let (overlap, radius, unloading) = (contact.overlap, contact.radius, loading * self.unloading_ratio);
        let radii = [radius, N::splat(1.0) / radius];
        let (raised, adhering) = (self.raised(overlap, radius), self.adhering(overlap, radius));
        let (before_raised, before_adhering) = (self.raised(before, radius), self.adhering(before, radius));
        let virgin = loading * raised;
        let mut found =
            Branch { force: virgin, adhesion: N::zero(), plastic: plastic.max(self.plastic_ratio * overlap) };
        let mut open = N::splat(1.0).greater(N::zero());
        let mut turn = 0;
        while turn < TURNS && N::any(open) {
            let pressed = unloading * self.raised(found.plastic, radius);
            let elastic = unloading * raised - pressed;
            let (pull, half) = (self.pull_on_patch * self.patch(contact, found.plastic), N::splat(0.5) * pressed);
            let (halved, own) = (pull.greater(half), self.engine.greater(N::splat(0.5)));
            let pull = N::select(halved, half, pull);
            let least = self.lowered((pressed - pull) / unloading, radii);
            let least = N::select(N::both(halved, own), N::splat(0.5) * found.plastic, least);
            let stiffness = N::select(least.greater(N::zero()), pull / self.adhering(least, radius), N::zero());
            let adhesive = -(stiffness * adhering);
            let below = virgin.greater(elastic);
            let swings = elastic.greater(adhesive);
            let force = N::select(below, N::select(swings, elastic, adhesive), virgin);
            found.force = N::select(open, force, found.force);
            found.adhesion = N::select(N::both(open, below), stiffness, found.adhesion);
            let sticks = N::select(below, N::select(swings, N::zero(), N::splat(1.0)), N::zero());
            let again = N::both(sticks.greater(N::zero()), overlap.greater(before));
            open = N::both(open, again);
            let anew = self.lowered(before_raised + stiffness / unloading * before_adhering, radii);
            found.plastic = N::select(open, anew, found.plastic);
            turn += 1;
        }
        found
    }

    /// The branches where the adhesion is fixed.
    #[inline(always)]
    fn fixed_branch(&self, contact: &Contact<N>, loading: N, plastic: N) -> Branch<N> {
        let loading = loading * contact.radius;
        let (overlap, unloading) = (contact.overlap, loading * self.unloading_ratio);
        let adhesion = loading * self.adhesion_ratio;
        let largest = plastic.max(overlap);
        let (virgin, adhesive) = (loading * overlap, -(adhesion * overlap));
        let elastic = unloading * (overlap - largest) + loading * largest;
        let below = virgin.greater(elastic);
        let swings = elastic.greater(adhesive);
        let force = N::select(below, N::select(swings, elastic, adhesive), virgin);
        let dented = overlap * ((unloading + adhesion) / (unloading - loading));
        let plastic = N::select(below, N::select(swings, largest, dented), largest);
        // The engine's limit of the force does not see this adhesion.
        let seen = N::select(self.engine.greater(N::splat(0.5)), N::zero(), adhesion);
        Branch { force, adhesion: seen, plastic }
    }
}

impl NormalForm for Eepa {
    const HISTORY: Option<HistoryRow> =
        Some(HistoryRow { name: "plastic overlap, overlap before", odd: [false; 4], fourth_is_free: true });
    const NEEDS: Needs = Needs { bodies: true, ..Needs::NONE };
    const ADHESION: Adhesion = Adhesion::InTouch;
    const LIMITS_ITSELF: bool = true;

    #[inline(always)]
    fn response_at<N: Number>(law: Eepa<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        /// ⁵⁄₆ of the slope ³⁄₂ k₁ √δ, over k₁ √δ.
        const OF_SLOPE: f64 = 1.25;
        let (one, bent, radius) = (N::splat(1.0), law.is_bent(), contact.radius);
        let own = law.engine.greater(N::splat(0.5));
        let mut slope = law.of_slope(contact.overlap, radius);
        if N::any(own) {
            slope = N::select(own, N::select(bent, radius.sqrt(), radius), slope);
        }
        let scaled = law.loading() * slope;
        let weight = N::select(own, one, N::select(bent, N::splat(OF_SLOPE), one));
        let damping = (law.damping * contact.mass * (weight * scaled)).sqrt();
        Response {
            normal_stiffness: scaled,
            normal_damping: damping,
            tangential_stiffness: law.tangential_modulus * (contact.radius * contact.overlap).sqrt(),
            tangential_damping: damping,
        }
    }

    #[inline(always)]
    fn force<N: Number>(
        law: Eepa<N>,
        switches: Switches<N>,
        contact: &Contact<N>,
        roots: Roots<N>,
        [plastic, before, _, fourth]: [N; 4],
        _step: N,
    ) -> (NormalForce<N>, [N; 4]) {
        let mut response = Self::response_at(law, contact, roots);
        response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
        let loading = law.loading();
        let is_fixed = law.fixed.greater(N::splat(0.5));
        // A law has one of them: the other is not evaluated.
        let branch = if N::any(is_fixed) {
            law.fixed_branch(contact, loading, plastic)
        } else {
            law.branch(contact, loading, [plastic, before])
        };
        let force = branch.force - response.normal_damping * contact.normal_velocity - law.pull_off_force;
        let adheres = N::either(branch.adhesion.greater(N::zero()), law.pull_off_force.greater(N::zero()));
        let force = N::select(adheres, force, force.max(switches.least_force));
        let history = [branch.plastic, contact.overlap, N::zero(), fourth];
        (NormalForce { response, force, seen: force }, history)
    }

    fn elastic_energy(&self, contact: &Contact, _offset: f64, [plastic, ..]: Row) -> f64 {
        // ∫ k₂ (xⁿ − δ_pⁿ) dx from δ_p to δ: what unloading gives back
        let unloading = self.loading() * self.unloading_ratio;
        let raised = |overlap: f64| self.raised(overlap, contact.radius);
        let plastic = match self.fixed == 1.0 {
            true => plastic * (1.0 - 1.0 / self.unloading_ratio),
            false => {
                // On the adhesion branch the stiff line through the present force is the one on which the contact would reload.
                let force = self.branch(contact, self.loading(), [plastic, contact.overlap]).force;
                let radii = [contact.radius, 1.0 / contact.radius];
                let reloading = self.lowered(raised(contact.overlap) - force / unloading, radii);
                if reloading < plastic { reloading } else { plastic }
            }
        };
        let whole = |overlap: f64| raised(overlap) * overlap / (self.overlap_exponent + 1.0);
        let (over, under) = (whole(contact.overlap) - whole(plastic), raised(plastic));
        unloading * (over - under * (contact.overlap - plastic))
    }

    fn tangent_stiffness(&self, contact: &Contact) -> f64 {
        let unloading = self.loading() * self.unloading_ratio;
        self.overlap_exponent * unloading * self.of_slope(contact.overlap, contact.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::laws::contact::NoKeys;
    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};

    /// E* = 1 Pa, k₂/k₁ = 4, elastic dashpot, surface energy or attraction as given.
    fn law(keys: Keys, surface_energy: f64) -> Eepa {
        let properties = properties().with(&property::RESTITUTION, 1.0).with(&property::SURFACE_ENERGY, surface_energy);
        with_pair(&properties, |pair| Eepa::between(pair, &keys, ALL)).unwrap()
    }

    /// Keys of these exponents.
    fn keys(overlap_exponent: f64, adhesion_exponent: f64) -> Keys {
        Keys { overlap_exponent, adhesion_exponent, adhesion: AdhesionKind::Patch, engine_exact: false }
    }

    /// Forces along a way of overlaps; R* = ¼ m.
    fn way(law: Eepa, overlaps: &[f64]) -> Vec<f64> {
        let mut history = [0.0; 4];
        let force = |&overlap: &f64| {
            let contact = Contact { overlap, ..contact() };
            let (normal, after) = Eepa::force(law, Switches::of(false, true), &contact, [0.0; 2], history, 0.5);
            history = after;
            normal.force
        };
        overlaps.iter().map(force).collect()
    }

    #[test]
    fn damps_a_hertzian_contact_as_hertz_does_and_the_engine_whatever_the_exponent() {
        let properties = properties().with(&property::RESTITUTION, 0.5);
        let damping = |keys: Keys| {
            let law = with_pair(&properties, |pair| Eepa::between(pair, &keys, ALL)).unwrap();
            Eepa::response(law, &contact()).normal_damping
        };
        let hertz = with_pair(&properties, |pair| super::super::hertz::Hertz::between(pair, &NoKeys {}, ALL)).unwrap();
        let expected = super::super::hertzian::Hertzian::response(hertz, &contact()).normal_damping;
        assert_close(damping(keys(1.5, 2.0)), expected, 1e-14);
        // k₁ of n = 3/2 in place of a stiffness: m* = 4 kg, E* = 1 Pa, R* = ¼ m
        let log = libm::log(0.5);
        let engine = (4.0 * log * log / (log * log + PI * PI) * 4.0 * (4.0 / 3.0 * 0.5)).sqrt();
        assert_close(damping(Keys { engine_exact: true, ..keys(1.5, 2.0) }), engine, 1e-14);
    }

    #[test]
    fn loads_softly_and_unloads_stiffly() {
        // n = 1: k₁ = ½ N/m, k₂ = 2 N/m, δ_p = ¾ of the largest overlap
        let found = way(law(keys(1.0, 1.0), 0.0), &[0.01, 0.02, 0.0175, 0.0175, 0.0190, 0.0225]);
        let expected = [0.005, 0.01, 0.005, 0.005, 0.008, 0.01125];
        for (found, expected) in found.into_iter().zip(expected) {
            assert_close(found, expected, 1e-13);
        }
        // n = 3/2: k₁ = 2/3 N/m^(3/2), δ_p^(3/2) = ¾ δ^(3/2)
        let found = way(law(keys(1.5, 5.0), 0.0), &[0.04, 0.0361]);
        assert_close(found[0], 2.0 / 3.0 * 0.008, 1e-13);
        assert_close(found[1], 8.0 / 3.0 * (0.006859 - 0.75 * 0.008), 1e-12);
    }

    #[test]
    fn pulls_on_the_patch_down_to_the_adhesion_branch_and_lets_go_at_zero() {
        let law = law(keys(1.0, 1.0), 1e-4);
        // δ_p = 0.015 m; the circle in which spheres of 1/per_reach = R_i + R_j = 1 m intersect there
        let patch = (0.015 * (1.0 - 0.03 + 0.000225) * (2.0 - 0.015)).sqrt() / (2.0 * 0.985);
        let pull = 1.5 * PI * 1e-4 * patch;
        let least = (2.0 * 0.015 - pull) / 2.0;
        let found = way(law, &[0.02, 0.5 * (0.015 + least), least, 0.5 * least, 0.0]);
        assert_close(found[1], -0.5 * pull, 1e-10);
        assert_close(found[2], -pull, 1e-10);
        assert_close(found[3], -0.5 * pull, 1e-12);
        assert_eq!(found[4].abs(), 0.0);
    }

    #[test]
    fn reloads_from_the_adhesion_branch_on_the_stiff_line() {
        let law = law(keys(1.0, 1.0), 1e-4);
        let found = way(law, &[0.02, 0.01, 0.0102]);
        assert_close(found[2] - found[1], 2.0 * 0.0002, 1e-9);
    }

    #[test]
    fn pulls_no_harder_than_half_of_what_pressed_it() {
        // n = 3/2: k₂ = 8/3 N/m^(3/2), δ_p^(3/2) = ¾ · 0.008; f = ½ k₂ δ_p^(3/2) at 2^(−2/3) δ_p
        let least = |engine_exact, chi| {
            let law = law(Keys { engine_exact, ..keys(1.5, chi) }, 10.0);
            let overlaps: Vec<f64> = (0..=400).map(|step| 0.04 - 1e-4 * f64::from(step)).collect();
            way(law, &overlaps).into_iter().fold(0.0, f64::min)
        };
        let pull = 0.5 * 8.0 / 3.0 * 0.75 * 0.008;
        for chi in [1.0, 1.5, 2.0, 3.0, 5.0] {
            let found = least(false, chi);
            assert!(found >= -pull && found < -0.99 * pull, "{chi}: {found}, {pull}");
            // The engine's branch goes through half of δ_p.
            assert!(least(true, chi) < -1.1 * pull, "{chi}");
        }
    }

    #[test]
    fn sticks_to_walls_but_not_in_the_engine() {
        let wall = |engine_exact| {
            let law = law(Keys { engine_exact, ..keys(1.0, 1.0) }, 1e-4);
            let mut history = [0.0; 4];
            for overlap in [0.02, 0.01] {
                let contact = Contact { overlap, per_reach: 0.0, ..contact() };
                let found = Eepa::force(law, Switches::of(false, true), &contact, [0.0; 2], history, 0.5);
                history = found.1;
                if overlap == 0.01 {
                    return found.0.force;
                }
            }
            0.0
        };
        assert!(wall(false) < 0.0);
        assert_eq!(wall(true).abs(), 0.0);
    }

    #[test]
    fn a_fixed_adhesion_is_a_share_of_the_loading_stiffness() {
        // k₁ = ½ N/m, k₂ = 2 N/m, k_a = ¼ N/m
        let law = law(Keys { adhesion: AdhesionKind::Fixed, ..keys(1.0, 1.0) }, 0.0);
        let found = way(law, &[0.02, 0.016, 0.008, 0.009]);
        assert_close(found[1], 2.0 * (0.016 - 0.02) + 0.5 * 0.02, 1e-13);
        assert_close(found[2], -0.25 * 0.008, 1e-13);
        // the largest overlap is now 0.008 · 2.25/1.5
        assert_close(found[3], 2.0 * (0.009 - 0.012) + 0.5 * 0.012, 1e-12);
    }

    #[test]
    fn limited_force_cuts_the_dashpot_where_nothing_adheres() {
        let law = Eepa { damping: 4.0, ..law(keys(1.0, 1.0), 0.0) };
        let contact = Contact { normal_velocity: 1.0, ..contact() };
        let of = |law, limit| Eepa::force(law, Switches::of(limit, true), &contact, [0.0; 2], [0.0; 4], 0.5).0.force;
        assert!(of(law, false) < 0.0);
        assert_eq!(of(law, true), 0.0);
        assert!(of(Eepa { pull_off_force: 1.0, ..law }, true) < 0.0);
    }

    #[test]
    fn gives_back_what_the_stiff_line_stores() {
        let law = law(keys(1.5, 5.0), 0.0);
        let at = |overlap| Contact { overlap, ..contact() };
        let (energy, by) = (|overlap: f64| law.elastic_energy(&at(overlap), 0.0, [0.03, 0.0, 0.0, 0.0]), 1e-5);
        let slope = (energy(0.04 + by) - energy(0.04 - by)) / (2.0 * by);
        assert_close(slope, 8.0 / 3.0 * (0.008 - 0.03 * 0.03_f64.sqrt()), 1e-7);
    }

    #[test]
    fn objects_to_exponents_that_are_not_offered() {
        assert_eq!(Eepa::objection(&keys(1.5, 5.0)), None);
        assert_eq!(Eepa::objection(&keys(1.2, 5.0)).unwrap().key, "overlap_exponent");
        assert_eq!(Eepa::objection(&keys(1.0, 4.0)).unwrap().key, "adhesion_exponent");
        let fixed = Keys { adhesion: AdhesionKind::Fixed, ..keys(1.5, 1.0) };
        assert_eq!(Eepa::objection(&fixed).unwrap().key, "adhesion");
    }
}
