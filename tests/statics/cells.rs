//! Moduli of lattices and packings in a cell.

use super::scenes::assert_same_by_iteration;
use crate::support::start;
use cograin::interface::{Derivatives, Interface, Value};
use cograin::statics::stiffness;
use cograin_sparse::factorise;

/// Bonded spheres on the sites of a cubic lattice whose next neighbours are `spacing` apart, in a cell of so many cubes.
fn crystal(sites: &[[f64; 3]], counts: [usize; 3], cube: f64, spacing: f64) -> String {
    let mut list = Vec::new();
    for place in 0..counts.iter().product() {
        let at = [place % counts[0], place / counts[0] % counts[1], place / counts[0] / counts[1]];
        for site in sites {
            let position = [0, 1, 2].map(|axis| cube * (at[axis] as f64 + site[axis] + 0.1));
            list.push(format!("{{ position = {position:?}, radius = {:?} }}", 0.5 * spacing));
        }
    }
    let [a, b, c] = counts.map(|count| cube * count as f64);
    format!(
        "[run]\nstep = 1.0e-7\nthreads = 1\n[material.ice]\ndensity = 900.0\n[particles.all]\nmaterial = \"ice\"\nlist = [{}]\n\
         [bond.neck]\nbetween = [\"all\", \"all\"]\ncreate_distance = {:?}\nnormal_stiffness = 1.0e10\ntangential_stiffness = 4.0e9\n\
         [cell]\nedges = [[{a:?}, 0.0, 0.0], [0.0, {b:?}, 0.0], [0.0, 0.0, {c:?}]]\n[output]\nstiffness = true\n",
        list.join(", "),
        1.01 * spacing
    )
}

#[test]
fn bonded_lattices_in_a_cell_have_the_moduli_of_their_springs() {
    let spacing = 0.01;
    let area = std::f64::consts::PI * 0.25 * spacing * spacing;
    let (normal, shear) = (1.0e10 * area / spacing, 4.0e9 * area / spacing);
    // Spheres turn with the mean rotation of the lattice, so springs across a bond feel the symmetric part of the strain.
    let root = 2.0_f64.sqrt();
    let cubic = [normal, 0.0, 0.5 * shear];
    let face_centred = [root * (normal + shear), (normal - shear) / root, (normal + shear) / root];
    let fcc = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    for (sites, counts, cube, [c11, c12, c44]) in
        [(&fcc[..1], [3, 4, 3], spacing, cubic), (&fcc[..], [2, 3, 2], root * spacing, face_centred)]
    {
        let simulation = start(&crystal(sites, counts, cube, spacing));
        let found = stiffness(&simulation, &[], Some(factorise)).unwrap();
        let cell = found.cell.as_ref().unwrap();
        for (row, entries) in cell.matrix.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                let expected = match (row, column) {
                    (0..3, 0..3) if row == column => c11,
                    (0..3, 0..3) => c12,
                    _ if row == column => c44,
                    _ => 0.0,
                };
                assert!((entry - expected).abs() < 1e-6 * c11, "{row} {column}: {entry} is not {expected}");
            }
        }
        assert!(found.loose.is_empty() && found.rattlers.is_empty(), "{found:?}");
        assert!(cell.residual < 1e-6, "{}", cell.residual);
        assert_same_by_iteration(&simulation, &found, 1e-7 * c11);
        let interface = Interface::of(simulation.scene());
        let index = interface.find("cell.stiffness.xz.xz").unwrap();
        let Value::Real(value) = interface.value(&simulation, index) else { panic!() };
        assert!((value / c44 - 1.0).abs() < 1e-6, "{value}");
    }
}

#[test]
fn the_derivative_of_the_stress_in_a_step_is_that_of_the_springs() {
    let text = crystal(&[[0.0; 3]], [3, 4, 3], 0.01, 0.01);
    let text =
        text.replace("[output]", "motion = { driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }\n[output]");
    let mut simulation = start(&text);
    simulation.advance_or_roll_back(1e-5).unwrap();
    let interface = Interface::of(simulation.scene());
    let find = |name: &str| interface.find(name).unwrap();
    let outputs = ["xx", "yy", "zz"].map(|name| find(&format!("cell.stress.{name}")));
    let normal = 1.0e10 * std::f64::consts::PI * 0.25 * 0.01;
    for (component, name) in ["xx", "yy", "zz"].into_iter().enumerate() {
        let direction = [(find(&format!("cell.strain.{name}")), 1.0)];
        let found =
            interface.derivatives(&mut simulation, &mut Derivatives::default(), (&outputs, &direction)).unwrap();
        for (row, found) in found.into_iter().enumerate() {
            let expected = if row == component { normal } else { 0.0 };
            assert!((found - expected).abs() < 1e-5 * normal, "{row} {component}: {found} is not {expected}");
        }
    }
}

#[test]
fn the_tangent_of_a_packing_in_a_cell_is_what_it_relaxes_to() {
    // Spheres of three sizes, pressed together from a lattice; a smaller one lies loose in a gap.
    let mut list = vec!["{ position = [0.011, 0.011, 0.011], radius = 0.002 }".to_owned()];
    for place in 0..27 {
        let at = [place % 3, place / 3 % 3, place / 9];
        let radius = [0.0101, 0.01005, 0.0102][(place * 7 + place / 3) % 3];
        let position = [0, 1, 2].map(|axis| 0.02 * f64::from(at[axis] as u32) + 0.001);
        list.push(format!("{{ position = {position:?}, radius = {radius:?} }}"));
    }
    let text = format!(
        "[run]\nstep = 1.0e-5\nthreads = 1\n[material.glass]\ndensity = 2500.0\nyoungs_modulus = 5.0e7\npoissons_ratio = 0.3\n\
         [pair.glass.glass]\nrestitution = 0.5\nfriction = 0.5\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n\
         [damping.all]\nlinear = 0.3\nangular = 0.3\n[particles.all]\nmaterial = \"glass\"\nlist = [{}]\n\
         [cell]\nedges = [[0.06, 0.0, 0.0], [0.0, 0.06, 0.0], [0.0, 0.0, 0.06]]\n\
         motion = {{ driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }}\n",
        list.join(", ")
    );
    let mut simulation = start(&text);
    simulation.advance(0.4).unwrap();
    let found = stiffness(&simulation, &[], Some(factorise)).unwrap();
    let cell = found.cell.as_ref().unwrap();
    assert_eq!(found.rattlers, [0], "the small one");
    assert!(cell.residual < 1e-3, "{}", cell.residual);
    assert_same_by_iteration(&simulation, &found, 1e-5 * cell.matrix[0][0]);
    let state = simulation.state().clone();
    for component in [0, 4] {
        let mut relaxed = |strain: f64| {
            simulation.restore(&state).unwrap();
            simulation.set_strain(component, strain);
            simulation.advance(0.01).unwrap();
            simulation.advance(0.3).unwrap();
            simulation.cell_stress()
        };
        let (there, back) = (relaxed(1e-8), relaxed(-1e-8));
        for (row, entries) in cell.matrix.iter().enumerate() {
            let expected = (there[row] - back[row]) / 2e-8;
            let off = (entries[component] - expected).abs() / cell.matrix[0][0];
            assert!(off < 1e-4, "{row} {component}: {} is not {expected}", entries[component]);
        }
    }
}
