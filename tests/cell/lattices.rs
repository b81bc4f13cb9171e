//! Lattices of contacts and bonds carry the stress of their neighbours.

use super::scenes::{SMOOTH, STRAINS, cube, lattice, scene, sites};
use crate::support::{DRIVEN, assert_all_near, cell, spheres, start};

/// Stress of a lattice whose cubic cell has these edges, by the force of Hertz between neighbours.
fn stress_of_lattice(kind: &str, edges: [[f64; 3]; 3], radius: f64) -> [f64; 6] {
    let modulus = 1e7 / (2.0 * (1.0 - 0.25 * 0.25));
    let place = |part: [f64; 3]| [0, 1, 2].map(|axis| (0..3).map(|edge| part[edge] * edges[edge][axis]).sum::<f64>());
    let mut sum = [0.0; 6];
    let sites = sites(kind);
    for a in &sites {
        for b in &sites {
            for shift in 0..125 {
                let shift = [shift % 5 - 2, shift / 5 % 5 - 2, shift / 25 - 2];
                let apart = place([0, 1, 2].map(|edge| b[edge] + f64::from(shift[edge]) - a[edge]));
                let distance = apart.iter().map(|part| part * part).sum::<f64>().sqrt();
                let overlap = 2.0 * radius - distance;
                if overlap > 0.0 && distance > 0.0 {
                    let force = 4.0 / 3.0 * modulus * (0.5 * radius * overlap).sqrt() * overlap;
                    for (sum, [row, column]) in sum.iter_mut().zip(STRAINS) {
                        *sum -= 0.5 * force * apart[row] * apart[column] / distance;
                    }
                }
            }
        }
    }
    let volume = edges[0][0] * edges[1][1] * edges[2][2];
    sum.map(|sum| sum / volume)
}

#[test]
fn lattices_carry_the_stress_of_their_neighbours_however_they_are_strained() {
    let radius = 1e-3;
    for (kind, counts, size) in [
        ("sc", [1, 1, 1], 1.96e-3),
        ("sc", [3, 4, 2], 1.96e-3),
        ("bcc", [1, 1, 1], 2.26e-3),
        ("bcc", [2, 3, 2], 2.26e-3),
        ("fcc", [1, 1, 1], 2.77e-3),
        ("fcc", [3, 2, 2], 2.77e-3),
    ] {
        let mut simulation = start(&lattice(kind, counts, size, radius, DRIVEN));
        let cube = [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        let what = format!("{kind} {counts:?}");
        assert_all_near(&simulation.cell_stress(), &stress_of_lattice(kind, cube, radius), 1e-12, &what);
        let strain = [-0.01_f64, 0.004, -0.006, 0.012, -0.02, 0.008];
        (0..6).for_each(|component| simulation.set_strain(component, strain[component]));
        simulation.advance(2e-3).unwrap();
        let [x, y, z] = [0, 1, 2].map(|axis| size * strain[axis].exp());
        let [xy, xz, yz] = [strain[3] * y, strain[4] * z, strain[5] * z];
        let edges = [[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]];
        assert_all_near(&simulation.cell_stress(), &stress_of_lattice(kind, edges, radius), 1e-9, &what);
    }
}

#[test]
fn a_lattice_that_is_sheared_by_a_whole_edge_is_what_it_was() {
    let size = 1.96e-3;
    let text = |counts| lattice("sc", counts, size, 1e-3, "motion = { shear = \"xz\" }");
    let mut simulation = start(&text([1, 1, 1]));
    let before = simulation.cell_stress();
    for share in 1..=32 {
        simulation.set_strain(4, f64::from(share) / 24.0);
        simulation.advance(2e-3).unwrap();
        let strain = f64::from(share) / 24.0;
        let edges = [[size, 0.0, 0.0], [0.0, size, 0.0], [strain * size, 0.0, size]];
        assert_all_near(&simulation.cell_stress(), &stress_of_lattice("sc", edges, 1e-3), 1e-9, &format!("{strain}"));
    }
    // Rows that lie in each other's gaps buckle in the end: quickly, before rounding grows.
    let mut simulation = start(&text([4, 3, 3]));
    for edges in 1..=4 {
        simulation.set_strain(4, f64::from(edges));
        simulation.advance(1e-3).unwrap();
        assert_all_near(&simulation.cell_stress(), &before, 1e-6, &format!("{edges} edges"));
    }
    assert!(simulation.state().cell.as_ref().unwrap().edges[2][0].abs() < size);
}

#[test]
fn bonds_across_the_faces_carry_their_stiffness() {
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    let (size, radius, strain) = (2e-3, 1e-3, 1e-4_f64);
    for count in [1, 3] {
        let sites = (0..count * count * count).map(|place| {
            let at = [place % count, place / count % count, place / count / count];
            (at.map(|at| size * f64::from(at)), radius, [0.0; 3])
        });
        let edges = cube(size * f64::from(count));
        let rest = spheres(&sites.collect::<Vec<_>>()) + bond + &cell(edges, "motion = { driven = [\"xx\", \"zz\"] }");
        let mut simulation = start(&scene("", "", &rest).replace("[pair.glass.glass]\n\n", "").replace("1e-5", "1e-7"));
        assert_eq!(simulation.bonds().len(), 3 * (count as usize).pow(3));
        simulation.set_strain(0, strain);
        simulation.advance(2e-6).unwrap();
        let force = 1e12 * std::f64::consts::PI * radius * radius * size * strain.exp_m1();
        let expected = [force / (size * size), 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_all_near(&simulation.cell_stress(), &expected, 1e-9, &format!("{count}"));
    }
}

#[test]
fn a_bonded_lattice_has_the_moduli_of_its_bonds() {
    // Between nearest neighbours, which an even strain of a lattice with a centre of symmetry moves evenly.
    let (radius, [normal, tangential]) = (1e-3, [1e12, 4e11].map(|stiffness| stiffness * std::f64::consts::PI * 1e-6));
    for (kind, edge, around, moduli) in [
        ("sc", 2.0, 6, [normal, 0.0, 0.5 * tangential]),
        (
            "bcc",
            4.0 / 3.0_f64.sqrt(),
            8,
            [
                (2.0 * normal + 4.0 * tangential) / 3.0,
                2.0 * (normal - tangential) / 3.0,
                (2.0 * normal + tangential) / 3.0,
            ],
        ),
        ("fcc", 8.0_f64.sqrt(), 12, [2.0 * (normal + tangential), normal - tangential, normal + tangential]),
    ] {
        for counts in [[1, 1, 1], [2, 3, 2]] {
            let size = edge * radius;
            let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\n\
                        normal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
            let text = lattice(kind, counts, size, radius, &format!("{DRIVEN}\n{bond}"));
            let contacts = format!("[pair.glass.glass]\n{}\n{}\n", SMOOTH[1], SMOOTH[0]);
            let mut simulation = start(&text.replace(&contacts, "").replace("1e-5", "1e-7"));
            let particles = sites(kind).len() * counts.iter().product::<usize>();
            assert_eq!(simulation.bonds().len(), particles * around / 2);
            let strain = [1e-6, -4e-7, 7e-7, 9e-7, -1.1e-6, 5e-7];
            (0..6).for_each(|component| simulation.set_strain(component, strain[component]));
            simulation.advance(2e-6).unwrap();
            let [along, across, shear] = moduli.map(|modulus| modulus / size);
            let sum = strain[0] + strain[1] + strain[2];
            let expected = [0, 1, 2, 3, 4, 5].map(|component| match component {
                0..3 => across * sum + (along - across) * strain[component],
                _ => shear * strain[component],
            });
            assert_all_near(&simulation.cell_stress(), &expected, 1e-5, &format!("{kind} {counts:?}"));
        }
    }
}
