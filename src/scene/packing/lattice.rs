//! Equal spheres in regular order.

use super::keys::{LatticeKind, LatticeTable};
use super::{Sphere, too_many};
use crate::base::document::Mistake;

/// A right-angled cell: its edges over the distance of neighbours, and the places in it over its edges.
struct Cell {
    /// Edges.
    edges: [f64; 3],
    /// Places.
    places: &'static [[f64; 3]],
}

/// The cell of a lattice.
fn cell(kind: LatticeKind) -> Cell {
    match kind {
        LatticeKind::SimpleCubic => Cell { edges: [1.0; 3], places: &[[0.0; 3]] },
        LatticeKind::BodyCentredCubic => {
            Cell { edges: [2.0 / 3.0_f64.sqrt(); 3], places: &[[0.0; 3], [0.5, 0.5, 0.5]] }
        }
        LatticeKind::FaceCentredCubic => {
            Cell { edges: [2.0_f64.sqrt(); 3], places: &[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]] }
        }
        LatticeKind::HexagonalClosePacked => Cell {
            edges: [1.0, 3.0_f64.sqrt(), (8.0_f64 / 3.0).sqrt()],
            places: &[[0.0; 3], [0.5, 0.5, 0.0], [0.0, 1.0 / 3.0, 0.5], [0.5, 5.0 / 6.0, 0.5]],
        },
    }
}

/// The spheres of a lattice, layer by layer; otherwise the key that is wrong.
pub(crate) fn lattice(table: &LatticeTable) -> Result<Vec<Sphere>, (&'static str, Mistake)> {
    let radius = table.radius.get();
    let spacing = table.spacing.map_or(2.0 * radius, crate::base::quantity::Positive::get);
    let Cell { edges, places } = cell(table.kind);
    let edges = edges.map(|edge| edge * spacing);
    let (origin, counts, bounds) = match (&table.r#box, &table.counts) {
        (Some(corners), None) if table.origin.is_none() => {
            let [lower, upper] = corners.0;
            // Rounding may not cost the last layer of a box that is an exact multiple of the spacing.
            let slack = 1e-9 * spacing;
            let (first, last) = (lower.map(|low| low + radius), upper.map(|high| high - radius + slack));
            let counts = std::array::from_fn(|axis| ((last[axis] - first[axis]) / edges[axis]).max(-1.0).floor() + 1.0);
            (first, counts, Some(last))
        }
        (None, Some(counts)) => (table.origin.unwrap_or_default().0, counts.0.map(f64::from), None),
        (Some(_), None) => {
            let (what, expected) = ("a box has its own origin".to_owned(), "leave origin out".to_owned());
            return Err(("lattice.origin", Mistake::InvalidCombination { what, expected }));
        }
        _ => {
            let found = if table.r#box.is_some() { "both" } else { "neither" }.to_owned();
            let expected = "one of box and counts".to_owned();
            return Err(("lattice", Mistake::Unexpected { found, expected }));
        }
    };
    let total = counts[0] * counts[1] * counts[2] * places.len() as f64;
    if let Some(expected) = too_many(total) {
        let found = format!("a lattice of {total:.3e} spheres");
        return Err(("lattice", Mistake::Unexpected { found, expected }));
    }
    Ok(filled(origin, counts.map(|count| count as usize), edges, places, bounds, radius))
}

/// The spheres in so many cells along each axis, up to the bounds.
fn filled(
    origin: [f64; 3],
    counts: [usize; 3],
    edges: [f64; 3],
    places: &[[f64; 3]],
    bounds: Option<[f64; 3]>,
    radius: f64,
) -> Vec<Sphere> {
    let mut spheres = Vec::with_capacity(counts.iter().product::<usize>() * places.len());
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                for place in places {
                    let number = [i, j, k];
                    let centre: [f64; 3] =
                        std::array::from_fn(|axis| origin[axis] + (number[axis] as f64 + place[axis]) * edges[axis]);
                    if bounds.is_none_or(|bounds| (0..3).all(|axis| centre[axis] <= bounds[axis])) {
                        spheres.push((centre, radius));
                    }
                }
            }
        }
    }
    spheres
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quantity::Corners;
    use crate::base::quantity::Counts;
    use crate::base::quantity::Positive;

    /// A lattice of unit spheres that touch.
    fn touching(kind: LatticeKind) -> LatticeTable {
        let radius = Positive::new(0.5).unwrap();
        LatticeTable { kind, radius, spacing: None, r#box: None, origin: None, counts: Some(Counts([3, 3, 3])) }
    }

    /// Distances of each two centres near 1, for the sphere nearest to the middle.
    fn neighbours(kind: LatticeKind) -> usize {
        let spheres = lattice(&touching(kind)).unwrap();
        let distance = |a: &Sphere, b: &Sphere| {
            (0..3).map(|axis| (a.0[axis] - b.0[axis]) * (a.0[axis] - b.0[axis])).sum::<f64>().sqrt()
        };
        let mut most = 0;
        for a in &spheres {
            let others = || spheres.iter().map(|b| distance(a, b)).filter(|distance| *distance > 0.0);
            assert!(others().all(|distance| distance > 1.0 - 1e-12), "{kind:?} overlaps");
            most = most.max(others().filter(|distance| *distance < 1.0 + 1e-12).count());
        }
        most
    }

    #[test]
    fn inner_spheres_touch_as_many_as_their_lattice_says() {
        assert_eq!(neighbours(LatticeKind::SimpleCubic), 6);
        assert_eq!(neighbours(LatticeKind::BodyCentredCubic), 8);
        assert_eq!(neighbours(LatticeKind::FaceCentredCubic), 12);
        assert_eq!(neighbours(LatticeKind::HexagonalClosePacked), 12);
    }

    #[test]
    fn a_box_is_filled_to_its_faces_and_not_beyond() {
        let corners = Some(Corners([[0.0; 3], [3.0, 2.0, 1.5]]));
        let table = LatticeTable { r#box: corners, counts: None, ..touching(LatticeKind::SimpleCubic) };
        let spheres = lattice(&table).unwrap();
        assert_eq!(spheres.len(), 6);
        assert_eq!(spheres[5].0, [2.5, 1.5, 0.5]);
    }

    #[test]
    fn a_box_smaller_than_a_sphere_stays_empty() {
        let corners = Some(Corners([[0.0; 3], [0.9, 2.0, 2.0]]));
        let table = LatticeTable { r#box: corners, counts: None, ..touching(LatticeKind::FaceCentredCubic) };
        assert_eq!(lattice(&table).unwrap().len(), 0);
    }
}
