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

/// Share of a free edge within which a free vertex of another one makes a crack: one edge of two triangles was meant.
const CRACK: f64 = 0.01;

/// A free vertex so near to a free edge of another triangle that both count for a sphere on the crack between them, though they are
/// not one: nearer than `within` \[m\]. Told in words.
pub(super) fn crack(topology: &Topology, within: f64) -> Option<String> {
    let at = |vertex: u32| topology.vertices[vertex as usize];
    let free: Vec<usize> = (0..topology.edges.len()).filter(|edge| topology.at_edge[*edge].len() == 1).collect();
    let mut rim: Vec<(u32, usize)> =
        free.iter().flat_map(|&edge| topology.edges[edge].map(|end| (end, edge))).collect();
    rim.sort_by(|a, b| at(a.0).x.total_cmp(&at(b.0).x).then(a.cmp(b)));
    for &edge in &free {
        let [a, b] = topology.edges[edge];
        let (from, way) = (at(a), at(b) - at(a));
        let reach = within.min(CRACK * way.length());
        let (low, high) = (at(a).x.min(at(b).x) - reach, at(a).x.max(at(b).x) + reach);
        let start = rim.partition_point(|(vertex, _)| at(*vertex).x < low);
        for &(vertex, other) in rim[start..].iter().take_while(|(vertex, _)| at(*vertex).x <= high) {
            let share = ((at(vertex) - from).dot(way) / way.dot(way)).clamp(0.0, 1.0);
            let apart = (at(vertex) - from - way * share).length();
            if ![a, b].contains(&vertex) && apart <= reach {
                let [one, two] = [edge, other].map(|edge| topology.numbers[topology.at_edge[edge][0] as usize]);
                let [one, two] = [one.min(two), one.max(two)];
                return Some(format!(
                    "free edges of triangles {one} and {two} are {apart:.1e} m apart: a sphere over this crack touches both"
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
    fn edges_that_are_nearly_one_are_a_crack_and_neighbours_of_a_fine_rim_are_none() {
        let lower = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let upper = |gap: f64| [[1.0 + gap, 0.0, 0.0], [1.0 + gap, 1.0, 0.0], [gap, 1.0, 0.0]];
        let told = |gap: f64, within: f64| crack(&Topology::of(&[lower, upper(gap)]).unwrap(), within);
        let expected = "free edges of triangles 1 and 2 are 3.5e-3 m apart: a sphere over this crack touches both";
        assert_eq!(told(5e-3, 0.1).as_deref(), Some(expected));
        assert_eq!(told(5e-3, 1e-3), None, "it is wide for the spheres of the scene");
        assert_eq!(told(0.05, 0.1), None, "a slot");
        let fan = |k: u32| [[0.0, 0.0, 0.0], [1.0, 0.05 * f64::from(k), 0.0], [1.0, 0.05 * f64::from(k + 1), 0.0]];
        assert_eq!(crack(&Topology::of(&[0, 1, 2, 3].map(fan)).unwrap(), 0.1), None);
        let welded = Topology::welded(&[lower, upper(5e-3)], Some(6e-3)).unwrap();
        assert_eq!((welded.vertices.len(), crack(&welded, 0.1)), (4, None));
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
