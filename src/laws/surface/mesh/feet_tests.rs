//! The search for feet in short cuts against the whole rule.

use super::Mesh;
use super::topology::Topology;
use crate::base::geometry::rotation;
use crate::base::lanes::Width;
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use crate::laws::surface::feet::{Features, Feet, Foot, OnPlanes, TOGETHER};

/// A block of n × n × 1 squares of two triangles each, turned and rounded to single precision as an STL file would; or,
/// without `closed`, its lid alone, with a slot in it.
fn block(n: u32, closed: bool) -> Mesh {
    let turn = rotation::orientation(Vector::new(0.3, -0.5, 0.2));
    let at = |corner: [f64; 3]| turn.turn(Vector::from(corner)).to_array().map(|part| f64::from(part as f32));
    let mut triangles = Vec::new();
    let mut square = |corners: [[f64; 3]; 4]| {
        let [a, b, c, d] = corners.map(at);
        triangles.extend([[a, b, c], [a, c, d]]);
    };
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [x, y] = [f64::from(i), f64::from(j)];
        if closed {
            square([[x, y, 0.0], [x, y + 1.0, 0.0], [x + 1.0, y + 1.0, 0.0], [x + 1.0, y, 0.0]]);
        } else if (i, j) == (n / 2, n / 2) {
            continue;
        }
        square([[x, y, 1.0], [x + 1.0, y, 1.0], [x + 1.0, y + 1.0, 1.0], [x, y + 1.0, 1.0]]);
    }
    for i in (0..n).filter(|_| closed) {
        let (x, end) = (f64::from(i), f64::from(n));
        square([[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 0.0, 1.0], [x, 0.0, 1.0]]);
        square([[x + 1.0, end, 0.0], [x, end, 0.0], [x, end, 1.0], [x + 1.0, end, 1.0]]);
        square([[0.0, x + 1.0, 0.0], [0.0, x, 0.0], [0.0, x, 1.0], [0.0, x + 1.0, 1.0]]);
        square([[end, x, 0.0], [end, x + 1.0, 0.0], [end, x + 1.0, 1.0], [end, x, 1.0]]);
    }
    let topology = Topology::of(&triangles).unwrap_or_else(|triangle| panic!("triangle {triangle}"));
    Mesh::of(MaterialIndex(0), topology, None)
}

#[test]
fn feet_inside_of_flat_patches_are_those_of_the_whole_rule() {
    let turn = rotation::orientation(Vector::new(0.3, -0.5, 0.2));
    for (closed, flat) in [(true, 3 * 2 * (3 * 3 * 2 + 4 * 3) - 2 * (12 + 12 + 4)), (false, 3 * 16 - 12 - 4)] {
        let mesh = block(3, closed);
        assert_eq!(mesh.flat.edges.iter().map(|bits| bits.count_ones()).sum::<u32>(), flat);
        let parts: Vec<u32> = (0..mesh.faces.len() as u32).collect();
        let (mut quick, mut whole, mut met, mut flat) = (Feet::default(), Feet::default(), 0, 0);
        for number in 0..20_000_u32 {
            // Places as even as those of a lattice, none of which is like another.
            let part = |ratio: f64| (f64::from(number) * ratio).fract();
            let place =
                [part(0.754_877_67) * 4.0 - 0.5, part(0.569_840_29) * 4.0 - 0.5, part(0.430_159_71) * 2.0 - 0.5];
            let (centre, radius) = (turn.turn(Vector::from(place)), 0.1 + 0.7 * part(0.618_033_99));
            quick.clear();
            whole.clear();
            mesh.feet(centre, radius, &parts, &mut quick);
            mesh.feet_at_bends(centre, radius, &parts, &mut whole);
            assert_eq!(quick.list, whole.list, "{place:?}, radius {radius}");
            assert_eq!(quick.saddles, whole.saddles);
            met += usize::from(!whole.list.is_empty());
            flat += usize::from(whole.list.len() == 1);
        }
        assert!(met > 5000 && flat > 2000, "{met} {flat}");
    }
}

#[test]
fn one_triangle_of_a_plane_tells_what_all_of_them_do() {
    let turn = rotation::orientation(Vector::new(0.3, -0.5, 0.2));
    for closed in [true, false] {
        let mesh = block(7, closed);
        let [mut planes, mut told, mut touched] = [0; 3];
        let (mut whole, mut parts) = (Feet::default(), Vec::new());
        for number in 0..20_000_u32 {
            let part = |ratio: f64| (f64::from(number) * ratio).fract();
            let place = [part(0.754_877_67) * 7.0, part(0.569_840_29) * 7.0, 0.5 + part(0.430_159_71)];
            let (centre, radius, skin) = (turn.turn(Vector::from(place)), 0.2 + 0.4 * part(0.618_033_99), 0.1);
            parts.clear();
            mesh.near(centre, radius + skin, &mut parts);
            if mesh.plane(centre, radius + skin, &parts) != parts.first().map(|part| mesh.face(*part))
                || parts.is_empty()
            {
                continue;
            }
            planes += 1;
            // Wherever it goes until parts are looked for again, and whichever of them it has touched before.
            let way = [0.33, 0.21, 0.47].map(|ratio| (part(ratio) - 0.5) * skin);
            let (centre, last) = (centre + turn.turn(Vector::from(way)), parts[number as usize % parts.len()]);
            let width = Width::ALL[number as usize % Width::ALL.len()];
            let (mut spheres, place) = (OnPlanes::none(), number as usize % TOGETHER);
            (spheres.count, spheres.sphere[place]) = (place + 1, centre.row_with(radius));
            spheres.feature[place] = mesh.face(last);
            mesh.on_planes(&mut spheres, if width.offered() { width } else { Width::Least });
            let [touches, away] = [spheres.touching, spheres.away].map(|bits| bits >> place & 1);
            if touches == 0 && away == 0 {
                continue;
            }
            let [x, y, z, distance] = spheres.foot[place];
            let (feature, normal) = (spheres.feature[place], Vector::new(x, y, z));
            let found = (touches != 0).then_some(Foot { feature, distance, normal, weight: 1.0, slope: 1.0 });
            told += 1;
            whole.clear();
            mesh.feet_at_bends(centre, radius, &parts, &mut whole);
            assert_eq!(whole.list, Vec::from_iter(found), "{place:?}, radius {radius}");
            touched += whole.list.len();
        }
        assert!(planes > 5000 && told > 2000 && touched > 1000, "{planes} {told} {touched}");
    }
}

/// A ball of 512 triangles about (0.3, −0.2, 0.7), the corners counter-clockwise as seen from outside.
fn ball() -> Mesh {
    let unit = |v: Vector| v * (1.0 / v.length());
    let mut triangles = Vec::new();
    for [x, y, z] in [0, 1, 2, 3, 4, 5, 6, 7].map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { -1.0 } else { 1.0 }))
    {
        let corners = [Vector::new(x, 0.0, 0.0), Vector::new(0.0, y, 0.0), Vector::new(0.0, 0.0, z)];
        triangles.push(if x * y * z > 0.0 { corners } else { [corners[1], corners[0], corners[2]] });
    }
    for _ in 0..3 {
        let four = |[a, b, c]: [Vector; 3]| {
            let (d, e, f) = (unit(a + b), unit(b + c), unit(c + a));
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(four).collect();
    }
    let place = |corner: Vector| (corner + Vector::new(0.3, -0.2, 0.7)).to_array();
    let triangles: Vec<_> = triangles.into_iter().map(|corners| corners.map(place)).collect();
    let topology = Topology::of(&triangles).unwrap_or_else(|triangle| panic!("triangle {triangle}"));
    Mesh::of(MaterialIndex(0), topology, None)
}

#[test]
fn a_fluid_at_rest_pushes_a_closed_surface_up_by_the_weight_that_it_displaces() {
    for mesh in [block(3, true), ball()] {
        // The areas with their normals, the volume, and pressure that falls along z as if it stood at each centroid.
        let [mut areas, mut lift] = [Vector::zero(); 2];
        let [mut area, mut volume] = [0.0; 2];
        for (number, triangle) in (0..).zip(&mesh.topology.triangles) {
            let [a, b, c] = mesh.topology.corners(triangle);
            let own = (b - a).cross(c - a).length() / 2.0;
            let along = mesh.faces.at(number).normal * own;
            areas += along;
            lift += along * ((a + b + c).z / 3.0);
            volume += along.dot(a) / 3.0;
            area += own;
        }
        assert!(mesh.closed && areas.length() < 1e-14 * area, "{areas:?} of {area} m2");
        let apart = lift - Vector::new(0.0, 0.0, volume);
        assert!(volume > 1.0 && apart.length() < 1e-14 * area, "{apart:?} m3 of {volume} m3");
    }
}
