//! What makes a surface of triangles count twice somewhere, though each triangle is right.

use super::topology::Topology;
use crate::base::number::Vector;

/// What is wrong with a surface, if anything: vertices in the middle of edges, triangles that lie on one another.
pub(super) fn found(topology: &Topology) -> Option<String> {
    junction(topology).or_else(|| coincident(topology))
}

/// A vertex that stands on a free edge without being its end: the edge counts as free there, and so does its neighbour.
fn junction(topology: &Topology) -> Option<String> {
    let at = |vertex: u32| topology.vertices[vertex as usize];
    let free = |edge: &usize| topology.at_edge[*edge].len() == 1;
    let mut rim: Vec<u32> = (0..topology.edges.len()).filter(free).flat_map(|edge| topology.edges[edge]).collect();
    rim.sort_unstable();
    rim.dedup();
    rim.sort_by(|a, b| at(*a).x.total_cmp(&at(*b).x));
    for edge in (0..topology.edges.len()).filter(free) {
        let [a, b] = topology.edges[edge];
        let (from, way) = (at(a), at(b) - at(a));
        let (low, high) = (at(a).x.min(at(b).x) - topology.tolerance, at(a).x.max(at(b).x) + topology.tolerance);
        let start = rim.partition_point(|vertex| at(*vertex).x < low);
        for vertex in rim[start..].iter().take_while(|vertex| at(**vertex).x <= high) {
            let share = (at(*vertex) - from).dot(way) / way.dot(way);
            let beside = (at(*vertex) - from - way * share).length();
            if *vertex != a && *vertex != b && (0.0..=1.0).contains(&share) && beside <= topology.tolerance {
                let (position, triangle) =
                    (at(*vertex).to_array(), topology.numbers[topology.at_edge[edge][0] as usize]);
                return Some(format!(
                    "a vertex at {position:?} m on an edge of triangle {triangle} that does not end there"
                ));
            }
        }
    }
    None
}

/// Two triangles in one plane that cover one another in part. Found along the axis on which the surface is longest.
fn coincident(topology: &Topology) -> Option<String> {
    let places: Vec<[Vector; 3]> =
        topology.triangles.iter().map(|it| it.map(|vertex| topology.vertices[vertex as usize])).collect();
    let bounds: Vec<[[f64; 3]; 2]> = places.iter().map(bounds).collect();
    let extent = |axis: usize| {
        let low = bounds.iter().map(|it| it[0][axis]).fold(f64::INFINITY, f64::min);
        bounds.iter().map(|it| it[1][axis]).fold(f64::NEG_INFINITY, f64::max) - low
    };
    let along = (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest });
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| bounds[*a][0][along].total_cmp(&bounds[*b][0][along]));
    for (rank, &a) in order.iter().enumerate() {
        for &b in order[rank + 1..].iter().take_while(|b| bounds[**b][0][along] <= bounds[a][1][along]) {
            let apart =
                (0..3).any(|axis| bounds[a][0][axis] > bounds[b][1][axis] || bounds[b][0][axis] > bounds[a][1][axis]);
            if !apart && lie_on_one_another(&places[a], &places[b], topology.tolerance) {
                let [a, b] = [a.min(b), a.max(b)].map(|place| topology.numbers[place]);
                return Some(format!("triangles {a} and {b} that lie on one another"));
            }
        }
    }
    None
}

/// The smallest box around a triangle.
fn bounds(corners: &[Vector; 3]) -> [[f64; 3]; 2] {
    let [a, b, c] = corners.map(Vector::to_array);
    [[0, 1, 2].map(|axis| a[axis].min(b[axis]).min(c[axis])), [0, 1, 2].map(|axis| a[axis].max(b[axis]).max(c[axis]))]
}

/// Whether two triangles are in one plane and no side of either parts them.
fn lie_on_one_another(one: &[Vector; 3], other: &[Vector; 3], tolerance: f64) -> bool {
    let unit = |way: Vector| way * (1.0 / way.length());
    let normal = |[a, b, c]: &[Vector; 3]| unit((*b - *a).cross(*c - *a));
    let flat = |of: &[Vector; 3], it: &[Vector; 3]| {
        let normal = normal(of);
        it.iter().all(|corner| (*corner - of[0]).dot(normal).abs() <= tolerance)
    };
    let parted = |of: &[Vector; 3], it: &[Vector; 3]| {
        (0..3).any(|side| {
            let outward = unit((of[(side + 1) % 3] - of[side]).cross(normal(of)));
            it.iter().all(|corner| (*corner - of[side]).dot(outward) >= -tolerance)
        })
    };
    flat(one, other) && flat(other, one) && !parted(one, other) && !parted(other, one)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is wrong with these triangles.
    fn of(corners: &[[[f64; 3]; 3]]) -> String {
        found(&Topology::of(corners).unwrap()).unwrap_or_default()
    }

    #[test]
    fn a_square_of_two_triangles_is_right_and_so_is_a_fold() {
        let lower = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(of(&[lower, [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]]), "");
        assert_eq!(of(&[lower, [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.9, 0.1, 0.5]]]), "");
    }

    #[test]
    fn a_vertex_in_the_middle_of_an_edge_is_named() {
        let large = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let small = [[0.0, 0.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.0, 0.0]];
        assert_eq!(
            of(&[large, small]),
            "a vertex at [1.0, 0.0, 0.0] m on an edge of triangle 1 that does not end there"
        );
    }

    #[test]
    fn triangles_that_cover_one_another_are_named_by_their_numbers() {
        let one = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let other = [[0.2, 0.2, 0.0], [0.3, 2.0, 0.0], [2.0, 0.3, 0.0]];
        assert_eq!(of(&[one, one, other]), "triangles 1 and 3 that lie on one another");
    }

    #[test]
    fn triangles_are_turned_until_they_agree_and_a_surface_with_one_side_is_told() {
        let lower = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let upper = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let mut square = Topology::of(&[lower, upper]).unwrap();
        assert_eq!(square.turn_alike(), Ok(()));
        assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
        // Möbius' band of five triangles.
        let angle = |k: usize| 2.0 * std::f64::consts::PI * k as f64 / 5.0;
        let point = |k: usize| [libm::cos(angle(k)), libm::sin(angle(k)), 0.3 * (k % 5) as f64 * (k % 3) as f64];
        let band: Vec<_> = (0..5).map(|k| [point(k % 5), point((k + 1) % 5), point((k + 2) % 5)]).collect();
        assert!(Topology::of(&band).unwrap().turn_alike().is_err());
    }
}
