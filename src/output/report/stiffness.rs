//! The condensed static stiffness of the boundaries, for people.

use crate::base::geometry::lattice::STRAINS;
use crate::base::quantity::BoundaryIndex;
use crate::base::words::counted;
use crate::engine::statics::{self, Factorise, Stiffness};
use crate::output::results::Refusal;
use crate::scene::Scene;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// How many particles are named of a kind.
const NAMED: usize = 8;

/// The stiffness of each boundary and of the cell of a scene at its start. Displays as text for a person.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessReport {
    /// What was found.
    found: Stiffness,
    /// Names of the boundaries.
    names: Vec<String>,
    /// Rattlers and loose particles, by their numbers in the scene.
    unheld: [Vec<u32>; 2],
}

/// Takes a scene to its start and finds the stiffness of its boundaries and its cell, which is that of a packing at rest.
pub fn stiffness(
    scene: &Arc<Scene>,
    scene_name: &str,
    from: Option<&Path>,
    factorise: Option<Factorise>,
) -> Result<StiffnessReport, Refusal> {
    let (simulation, _) = super::begin(scene, scene_name, from)?;
    let boundaries: Vec<_> = (0..scene.boundaries.len()).map(|index| BoundaryIndex(index as u32)).collect();
    let refused = |source| Refusal::Stiffness { scene: scene_name.to_owned(), source };
    let found = statics::stiffness(&simulation, &boundaries, factorise).map_err(refused)?;
    let number = |list: &Vec<u32>| list.iter().map(|&index| simulation.number(index)).collect();
    let unheld = [&found.rattlers, &found.loose].map(number);
    let names = scene.boundaries.iter().map(|boundary| boundary.name.clone()).collect();
    Ok(StiffnessReport { found, names, unheld })
}

impl fmt::Display for StiffnessReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Stiffness { freedoms, asymmetry, boundaries, cell, .. } = &self.found;
        write!(
            formatter,
            "stiffness  of {freedoms} freedoms at rest, mirrored entries differ by {asymmetry:.1e} of the largest"
        )?;
        for (name, one) in self.names.iter().zip(boundaries) {
            for (axis, row) in ["x", "y", "z"].iter().zip(&one.matrix) {
                let [x, y, z] = row;
                write!(formatter, "\nstiffness  {name}.force.{axis} to x, y, z: {x:.6e} {y:.6e} {z:.6e} N/m")?;
            }
            write!(
                formatter,
                "\nresidual   {name}: {:.1e} of the load that its displacement puts on a body",
                one.residual
            )?;
        }
        if let Some(cell) = cell {
            for (name, row) in STRAINS.iter().zip(&cell.matrix) {
                write!(formatter, "\nstiffness  cell.stress.{name} to strains {}:", STRAINS.join(", "))?;
                row.iter().try_for_each(|entry| write!(formatter, " {entry:.6e}"))?;
                write!(formatter, " Pa")?;
            }
            write!(formatter, "\nresidual   cell: {:.1e} of the load that its strain puts on a body", cell.residual)?;
        }
        for (what, list) in [
            "held by nothing, or by one contact, and left out",
            "loose in some direction, alone or together, and held along it",
        ]
        .iter()
        .zip(&self.unheld)
        {
            if !list.is_empty() {
                let named: Vec<_> = list.iter().take(NAMED).map(u32::to_string).collect();
                let more = if list.len() > NAMED { ", .." } else { "" };
                write!(
                    formatter,
                    "\nremark     {} {} {what}: {}{more}",
                    counted(list.len(), "particle"),
                    if list.len() == 1 { "is" } else { "are" },
                    named.join(", ")
                )?;
            }
        }
        Ok(())
    }
}
