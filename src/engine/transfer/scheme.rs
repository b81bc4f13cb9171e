//! The stabilised explicit method of Meyer, Balsara and Aslam (2014), of second order, on Legendre polynomials: RKL2.
//!
//! With s stages, τ the time step and M the right-hand side, D_j = Y_j − Y_0 and p = s² + s − 2:
//!
//! ```text
//! D_1 = μ̃_1 τ M(Y_0)     D_j = μ_j D_{j−1} + ν_j D_{j−2} + τ (μ̃_j M(Y_{j−1}) + γ̃_j M(Y_0))
//! b_0 = b_1 = b_2 = 1/3   b_j = (j² + j − 2)/(2 j (j + 1))   w = 4/p
//! μ̃_1 = b_1 w   μ_j = (2j − 1) b_j/(j b_{j−1})   ν_j = −(j − 1) b_j/(j b_{j−2})   μ̃_j = w μ_j   γ̃_j = −(1 − b_{j−1}) μ̃_j
//! ```
//!
//! Stable where τ times the largest root is at most p/2. A linear equation is left with the error τ³ Y'''/6 (1 − 2 (p − 4)/(3 p)).

/// Most stages of a time step: p is then 10⁴ times what one step of Euler's method may have.
const MOST_STAGES: u64 = 201;

/// So many stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stages(u64);

/// The numbers of one stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    /// Of the increment of the last stage but none, and of that before it.
    pub(super) of_increments: [f64; 2],
    /// Of what flows now, and of what flowed at the beginning, over the time step.
    pub(super) of_flows: [f64; 2],
    /// The share of the time step to which the stage leads.
    pub(super) time: f64,
}

impl Stages {
    /// As many as a step of this length needs, in lengths of the longest one of Euler's method that is monotone, C/ΣH: half the bound of
    /// Gershgorin.
    pub(super) fn for_length(length: f64) -> Self {
        // Rounding up with an odd number keeps all that decays quickly from changing its sign.
        let mut stages = 3;
        while stages < MOST_STAGES && Self(stages).longest() < length {
            stages += 2;
        }
        Self(stages)
    }

    /// The longest step with so many stages, in the same unit.
    fn longest(self) -> f64 {
        0.25 * self.polynomial()
    }

    /// The longest step of all, in the same unit.
    pub(super) fn longest_of_all() -> f64 {
        Self(MOST_STAGES).longest()
    }

    /// s² + s − 2.
    fn polynomial(self) -> f64 {
        (self.0 * self.0 + self.0 - 2) as f64
    }

    /// The error of a step over τ³ Y'''.
    pub(super) fn error(self) -> f64 {
        let polynomial = self.polynomial();
        (1.0 - 2.0 * (polynomial - 4.0) / (3.0 * polynomial)) / 6.0
    }

    /// The stages, one after the other.
    pub(super) fn each(self) -> impl Iterator<Item = Stage> {
        let weight = 4.0 / self.polynomial();
        let mut times = [0.0; 2];
        (1..=self.0).map(move |number| {
            let b = |number: u64| {
                let j = number as f64;
                if number < 3 { 1.0 / 3.0 } else { (j * j + j - 2.0) / (2.0 * j * (j + 1.0)) }
            };
            let (of_increments, of_flows) = if number == 1 {
                ([0.0; 2], [0.0, b(1) * weight])
            } else {
                let j = number as f64;
                let last = (2.0 * j - 1.0) / j * (b(number) / b(number - 1));
                let before = -(j - 1.0) / j * (b(number) / b(number - 2));
                ([last, before], [last * weight, -(1.0 - b(number - 1)) * last * weight])
            };
            let ([last, before], [now, first]) = (of_increments, of_flows);
            let time = last * times[0] + before * times[1] + now + first;
            times = [time, times[0]];
            Stage { of_increments, of_flows, time }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Stages;

    /// What a step makes of y' = z y, y = 1.
    fn factor(stages: Stages, z: f64) -> f64 {
        let mut increments = [0.0; 2];
        for stage in stages.each() {
            let [last, before] = increments;
            let flows = stage.of_flows[0] * z * (1.0 + last) + stage.of_flows[1] * z;
            increments = [stage.of_increments[0] * last + stage.of_increments[1] * before + flows, last];
        }
        1.0 + increments[0]
    }

    #[test]
    fn the_last_stage_ends_the_step() {
        for stages in [3, 5, 21, 201] {
            let end = Stages(stages).each().last().unwrap().time;
            assert!((end - 1.0).abs() < 1e-12, "{stages} stages end at {end}");
        }
    }

    #[test]
    fn what_decays_decays_up_to_the_bound() {
        for count in (3..=201).step_by(2) {
            let (stages, bound) = (Stages(count), 0.5 * Stages(count).polynomial());
            for part in 1..=1000 {
                let found = factor(stages, -bound * f64::from(part) / 1000.0);
                assert!((0.0..1.0).contains(&found), "{count} stages, {part}/1000 of the bound: {found}");
            }
        }
    }

    #[test]
    fn the_error_of_a_short_step_is_what_is_said() {
        for count in [3, 5, 11, 51] {
            let (stages, z) = (Stages(count), -1e-2_f64);
            let found = (libm::exp(z) - factor(stages, z)) / (z * z * z);
            assert!((found / stages.error() - 1.0).abs() < 0.02, "{count} stages: {found}");
        }
    }

    #[test]
    fn there_are_as_many_stages_as_the_bound_asks_for() {
        assert_eq!(Stages::for_length(0.1), Stages(3));
        assert_eq!(Stages::for_length(2.5), Stages(3));
        assert_eq!(Stages::for_length(2.6), Stages(5));
        assert_eq!(Stages::for_length(1e9), Stages(201));
    }
}
