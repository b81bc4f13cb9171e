//! Heat sub-models: what conducts where two bodies touch, each in a file of its own.

pub mod constriction;
pub mod overlap_area;
pub mod transfer;

use super::HeatRow;
use crate::base::number::Number;
use std::f64::consts::PI;

/// The heat sub-models of the program.
pub(crate) const STANDARD: &[&HeatRow] = &[
    HeatRow::of::<constriction::Constriction>(),
    HeatRow::of::<overlap_area::OverlapArea>(),
    HeatRow::of::<transfer::Transfer>(),
];

/// Where two bodies touch, as heat sees it.
#[derive(Clone, Copy, Debug)]
pub struct Spot<N = f64> {
    /// Overlap δ \[m\].
    pub overlap: N,
    /// Radius of the circle of contact a, by the normal model \[m\].
    pub contact_radius: N,
    /// Radii of both bodies; that of the sphere twice at a wall \[m\].
    pub radii: [N; 2],
    /// R_j/(R_i + R_j) of two spheres, 1 at a wall.
    pub share: N,
    /// 1/(R_i + R_j) of two spheres, 0 at a wall \[1/m\].
    pub per_reach: N,
}

impl<N: Number> Spot<N> {
    /// Of two spheres of these radii \[m\].
    #[inline(always)]
    pub fn of_spheres(radii: [N; 2], overlap: N, contact_radius: N) -> Self {
        let per_reach = N::splat(1.0) / (radii[0] + radii[1]);
        Self { overlap, contact_radius, radii, share: radii[1] * per_reach, per_reach }
    }

    /// Of a sphere of this radius \[m\] and a wall.
    #[inline(always)]
    pub fn at_wall(radius: N, overlap: N, contact_radius: N) -> Self {
        Self { overlap, contact_radius, radii: [radius; 2], share: N::splat(1.0), per_reach: N::zero() }
    }

    /// Area of the circle in which the undeformed bodies of this overlap \[m\] intersect; that of the smaller sphere once it holds the
    /// centre of the other \[m²\].
    #[inline(always)]
    pub fn section(&self, overlap: N) -> N {
        let (one, two) = (N::splat(1.0), N::splat(2.0));
        let part = overlap * self.per_reach;
        let distance = one - part;
        let lens = overlap * (two * self.radii[0] - overlap) * (two * self.share - part) * (two - part);
        let lens = N::splat(0.25 * PI) * lens / (distance * distance);
        let smaller = self.radii[0].min(self.radii[1]);
        let deep = self.share.max(one - self.share).greater(distance);
        N::select(deep, N::splat(PI) * smaller * smaller, lens)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::assert_close;

    #[test]
    fn a_section_is_that_of_two_spheres() {
        // Spheres of 5 and 12 whose centres are 13 apart intersect in a circle of radius 5 × 12/13.
        let spot = Spot::of_spheres([5.0, 12.0], 4.0, 0.0);
        assert_close(spot.section(4.0), PI * (60.0_f64 / 13.0).powi(2), 1e-14);
        let swapped = Spot::of_spheres([12.0, 5.0], 4.0, 0.0);
        assert_close(swapped.section(4.0), PI * (60.0_f64 / 13.0).powi(2), 1e-14);
    }

    #[test]
    fn a_section_at_a_wall_is_a_cap_of_the_sphere() {
        // A sphere of radius 5 whose centre is 4 from a plane meets it in a circle of radius 3.
        assert_close(Spot::at_wall(5.0, 1.0, 0.0).section(1.0), PI * 9.0, 1e-14);
    }

    #[test]
    fn a_sphere_that_holds_the_centre_of_another_has_its_section() {
        assert_close(Spot::of_spheres([5.0, 12.0], 6.0, 0.0).section(6.0), PI * 25.0, 1e-15);
    }
}
