//! The normal distribution, cut off at two places.

use std::f64::consts::SQRT_2;

/// A normal distribution cut off at two places, which are numbers of deviations above its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CutNormal([f64; 2]);

/// Halvings of an interval until its ends are neighbours among the numbers of 64 bits, with reserve.
const HALVINGS: usize = 100;

impl CutNormal {
    /// That between these places.
    pub(super) fn between(places: [f64; 2]) -> Self {
        Self(places)
    }

    /// Share of the whole distribution that lies between the places.
    pub(super) fn share(self) -> f64 {
        let [low, high] = self.0;
        (self.beyond(high) - self.beyond(low)).abs()
    }

    /// The place below which this share of what is left lies.
    pub(super) fn place(self, share: f64) -> f64 {
        let [mut low, mut high] = self.0;
        let [first, last] = [low, high].map(|place| self.beyond(place));
        let wanted = first + share * (last - first);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let is_below = (self.beyond(middle) < wanted) == (first < last);
            *(if is_below { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    }

    /// Share of the whole distribution beyond a place, on the side where it is small: sums keep their digits in a tail.
    fn beyond(self, place: f64) -> f64 {
        let side = if self.0[0] > 0.0 { 1.0 } else { -1.0 };
        0.5 * libm::erfc(side * place / SQRT_2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_places_are_those_of_tables() {
        // Φ(1) − Φ(−1), Φ(1.6448536) = 0.95.
        assert!((CutNormal::between([-1.0, 1.0]).share() - 0.682_689_492_137_086).abs() < 1e-14);
        let wide = CutNormal::between([-40.0, 40.0]);
        assert!((wide.place(0.95) - 1.644_853_626_951_472_7).abs() < 1e-12, "{}", wide.place(0.95));
        assert!(wide.place(0.5).abs() < 1e-12);
    }

    #[test]
    fn a_cut_in_a_tail_keeps_its_digits() {
        for cut in [[10.0, 11.0], [-11.0, -10.0]] {
            let tail = CutNormal::between(cut);
            // Half of what lies beyond 10 lies below 10.0684 (Φ(−10.0684) = ½ Φ(−10)); 11 is too far to matter.
            let place = tail.place(0.5);
            assert!((place.abs() - 10.068_4).abs() < 1e-4, "{place}");
            assert_eq!([tail.place(0.0), tail.place(1.0)].map(|end| (10.0 * end).round() / 10.0), cut);
        }
    }
}
