//! Triangles from files: STL, OBJ, VTK.

mod obj;
mod stl;
mod vtk;

use crate::base::memory;
use crate::base::number::Vector;

/// Corners of triangles as a file has them \[file's unit\].
pub(super) type Triangles = Vec<[[f64; 3]; 3]>;

/// A mistake in a file: what was found and what was expected.
pub(super) type Wrong = (String, String);

/// Memory that a byte of a file takes as it is read: nine numbers of 8 bytes over the shortest line of a face.
const READING: u64 = 8;

/// Memory that a triangle takes, with its edges and vertices and their places in the tree: measured with a mesh of 180,000
/// \[bytes\].
const TRIANGLE: u64 = 650;

/// Bends of a polygon below this count as flat: 1 − cosine of a tenth of a degree.
const FLAT: f64 = 1.5e-6;

/// The triangles of a file, or what is wrong with it. The ending of its name gives the format; without an ending it is STL.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<Triangles, Wrong> {
    has_room(READING, bytes.len())?;
    let lower = name.to_lowercase();
    let triangles = match lower.rsplit_once('.').map_or("stl", |(_, ending)| ending) {
        "stl" => stl::read(bytes),
        "obj" => obj::read(bytes),
        "vtk" | "vtp" | "vtu" => vtk::read(bytes),
        ending => Err((format!("a file that ends with .{ending}"), ".stl, .obj, .vtk, .vtp or .vtu".to_owned())),
    }?;
    has_room(TRIANGLE, triangles.len())?;
    Ok(triangles)
}

/// Refuses a file with so many entries of so much memory each \[bytes\], if there is not as much memory.
fn has_room(each: u64, count: usize) -> Result<(), Wrong> {
    let needed = each.saturating_mul(count as u64);
    memory::lacking(needed).map_or(Ok(()), |expected| {
        Err((format!("triangles that need about {:.2} GB of memory", needed as f64 / 1e9), expected))
    })
}

/// Adds a polygon as triangles; four corners are cut along the shorter diagonal. `face` counts from 1.
fn add_polygon(corners: &[[f64; 3]], face: usize, triangles: &mut Triangles) -> Result<(), Wrong> {
    let at = |corner: usize| Vector::from(corners[corner % corners.len()]);
    let start = match corners.len() {
        0..=2 => return Err((format!("face {face} of {} corners", corners.len()), "three corners or more".to_owned())),
        4 if (at(3) - at(1)).length() < (at(2) - at(0)).length() => 1,
        _ => 0,
    };
    let fan: Vec<[Vector; 3]> =
        (start + 1..start + corners.len() - 1).map(|corner| [at(start), at(corner), at(corner + 1)]).collect();
    let normal = |[a, b, c]: &[Vector; 3]| (*b - *a).cross(*c - *a);
    let sum = fan.iter().map(normal).fold(Vector::zero(), |sum, normal| sum + normal);
    let flat = |normal: Vector| normal.dot(sum) >= (1.0 - FLAT) * normal.length() * sum.length();
    if corners.len() > 3 && !fan.iter().map(normal).all(flat) {
        let found = format!("face {face}, whose {} corners are not convex in one plane", corners.len());
        return Err((found, "triangles".to_owned()));
    }
    triangles.extend(fan.iter().map(|corners| corners.map(Vector::to_array)));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_obj_files_name_corners_from_the_first_or_back_from_the_last() {
        let text = b"# a square and a triangle\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3 4\nf -4 -3 -1\n";
        let triangles = read("a.OBJ", text).unwrap();
        assert_eq!(triangles.len(), 3);
        assert_eq!(triangles[2], [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn obj_files_that_name_no_vertex_or_bent_faces_are_refused() {
        let wrong = |text: &str| read("a.obj", text.as_bytes()).unwrap_err().0;
        assert_eq!(wrong("v 0 0 0\nf 1 2 3\n"), "line 2: \"2\"");
        assert_eq!(wrong("v 0 0\n"), "line 1: v 0 0");
        assert_eq!(wrong("v 0 0 0\nv 1 0 0\nf 1 2\n"), "face 1 of 2 corners");
        let bent = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n";
        assert_eq!(wrong(bent), "face 1, whose 4 corners are not convex in one plane");
    }

    #[test]
    fn polygons_of_vtk_files_become_triangles() {
        let text = "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\
            <PolyData><Piece NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
            NumberOfPolys=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\
            0 0 0 2 0 0 2 1 0 0 1 0</DataArray></Points><Polys>\
            <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\
            <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray></Polys></Piece></PolyData></VTKFile>";
        assert_eq!(read("a.vtp", text.as_bytes()).unwrap().len(), 2);
        let legacy = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\n\
            POLYGONS 1 4\n3 0 1 2\n";
        assert_eq!(read("a.vtk", legacy.as_bytes()).unwrap(), [[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    }

    #[test]
    fn files_that_other_programs_wrote_give_the_same_square_of_eight_triangles() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/foreign/meshes");
        let mut count = 0;
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_str().unwrap();
            if name == "readme" {
                continue;
            }
            count += 1;
            let triangles =
                read(name, &std::fs::read(&path).unwrap()).unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"));
            assert_eq!(triangles.len(), 8, "{name}");
            // Each is half of a square of 0.02 m, and looks along z.
            for triangle in &triangles {
                let [a, b, c] = triangle.map(Vector::from);
                let area = (b - a).cross(c - a) * 0.5;
                assert!((area - Vector::from([0.0, 0.0, 2e-4])).length() < 1e-10, "{name}: {area:?}");
            }
            let sum =
                triangles.as_flattened().iter().fold([0.0; 3], |sum, it| [0, 1, 2].map(|axis| sum[axis] + it[axis]));
            assert!(sum.iter().all(|part| part.abs() < 1e-7), "{name}: {sum:?}");
        }
        assert!(count > 15, "{count}");
    }

    #[test]
    fn damaged_vtk_files_are_refused_in_words() {
        assert!(read("a.vtp", b"<VTKFile type=\"PolyData\"").unwrap_err().0.starts_with("a file that is no VTK file"));
        assert!(read("a.ply", b"").unwrap_err().0.ends_with(".ply"));
    }
}
