//! What the edges of a cell can be, and whether the box of a file is that of the cell.

use super::{AXES, Cell};
use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::brought_back;
use crate::scene::import::FileBox;

/// What was expected of edges instead of these, if anything.
pub(in crate::scene) fn fault_of(lattice: &Lattice) -> Option<&'static str> {
    let Lattice { origin, edges: [a, b, c], .. } = *lattice;
    let numbers = [origin, a, b, c];
    if !numbers.as_flattened().iter().all(|number| number.is_finite()) || !lattice.volume().is_normal() {
        return Some("finite numbers and a volume");
    }
    let upright = a[1] == 0.0 && a[2] == 0.0 && b[2] == 0.0 && a[0] > 0.0 && b[1] > 0.0 && c[2] > 0.0;
    (!upright).then_some("[[ax, 0, 0], [bx, by, 0], [cx, cy, cz]] with ax, by, cz above 0")
}

/// How far the edges of a box in a file may be from those of the cell, over the longest: texts have six digits.
const DIGITS: f64 = 1e-5;

/// What a cell, or a scene without one, has against the box of a file of particles: found and expected.
pub(in crate::scene) fn box_objection(cell: Option<&Cell>, around: &FileBox) -> Option<[String; 2]> {
    let names = |periodic: [bool; 3]| {
        let names: Vec<&str> = (0..3).filter(|&edge| periodic[edge]).map(|edge| AXES[edge]).collect();
        names.join(", ")
    };
    let Some(cell) = cell else {
        let expected = "a [cell] in the scene, which takes its edges from this file where it names none".to_owned();
        return around.is_periodic().then(|| ["a box that repeats".to_owned(), expected]);
    };
    let upright = |lattice: &Lattice| brought_back(lattice.edges, lattice.leaning());
    let [own, other] = [cell.lattice.periodic, around.lattice.periodic];
    if (0..3).any(|edge| other[edge] && !own[edge]) {
        let found = format!("a box that repeats along {}", names(other));
        return Some([found, format!("one that repeats as [cell] does, along {}", names(own))]);
    }
    let shared = [0, 1, 2].map(|edge| own[edge] && (other[edge] || !around.is_told));
    let [here, there] = [&cell.lattice, &around.lattice].map(|it| upright(&Lattice { periodic: shared, ..*it }));
    let longest = here.as_flattened().iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let differs = |edge: usize| (0..3).any(|axis| (here[edge][axis] - there[edge][axis]).abs() > DIGITS * longest);
    let found = || format!("a box with edges {:?} m", around.lattice.edges);
    (0..3)
        .any(|edge| shared[edge] && differs(edge))
        .then(|| [found(), format!("the edges of [cell], {:?} m", cell.lattice.edges)])
}
