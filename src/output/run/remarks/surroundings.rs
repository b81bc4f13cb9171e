//! On boundaries, grids and what is beyond them.

use crate::base::number::Vector;
use crate::engine::simulation::Simulation;
use crate::scene::{Boundary, Grid, Scene};

/// Width of a crack between triangles over the smallest radius, below which a sphere over it touches both sides as if each were
/// there alone.
const OF_A_CRACK: f64 = 0.1;

/// On edges of meshes that are nearly one.
pub(super) fn cracks(scene: &Scene) -> Vec<String> {
    let within = OF_A_CRACK * scene.radii().fold(f64::INFINITY, f64::min);
    let crack = |boundary: &Boundary| Some((boundary.name.clone(), boundary.shape.crack(within)?));
    let told = scene.boundaries.iter().filter_map(crack);
    told.map(|(name, crack)| format!("[boundary.{name}] mesh: {crack}; weld_distance above that makes them one"))
        .collect()
}

/// On particles that pass through boundaries because no law is for their contacts.
pub(super) fn passed_through(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let mut present: Vec<u32> = scene.particles.iter().map(|particle| particle.material.0).collect();
    present.extend(scene.insertions.iter().map(|insertion| insertion.material.0));
    present.sort_unstable();
    present.dedup();
    let mut remarks = Vec::new();
    for (index, boundary) in scene.boundaries.iter().enumerate() {
        let Some(material) = boundary.shape.material() else { continue };
        let bonded = scene.bonds.iter().any(|bond| bond.plane.is_some_and(|plane| plane.index() == index));
        let lawless = |particle: &&u32| {
            let entry = **particle as usize * count + material.index();
            !scene.contacts.iter().any(|law| law.between[entry])
        };
        if let Some(particle) = present.iter().find(lawless).filter(|_| !bonded) {
            let [particle, other] = [*particle as usize, material.index()].map(|index| &scene.materials[index].name);
            remarks.push(format!(
                "[boundary.{}]: particles of {particle} pass through it: expected a [contact] law for {particle} and {other}",
                boundary.name
            ));
        }
    }
    remarks
}

/// On particles that fall for ever.
pub(super) fn falling(scene: &Scene) -> Option<String> {
    let endless =
        scene.boundaries.is_empty() && scene.domain.is_none() && scene.gravity.iter().any(|part| *part != 0.0);
    endless.then(|| "gravity acts and there is no boundary and no [domain]: particles fall for ever".to_owned())
}

/// On grids whose cells are smaller than particles.
pub(super) fn cells(scene: &Scene) -> Vec<String> {
    let largest = 2.0 * scene.radii().fold(0.0, f64::max);
    let small = |grid: &Grid| {
        let least = grid.shape.edges().into_iter().fold(f64::INFINITY, f64::min);
        (least < largest).then(|| {
            format!(
                "[grid.{}] counts: cells are {least:.3e} m wide and particles up to {largest:.3e} m; fields show single particles there, \
                 cells of three diameters show the mean of many",
                grid.name
            )
        })
    };
    scene.grids.iter().filter_map(small).collect()
}

/// On particles outside of the box of a fluid.
pub(super) fn dry(simulation: &Simulation) -> Option<String> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let fluid = scene.fluid.as_ref()?;
    let grid = &scene.grids[fluid.grid?];
    let (all, centres) = (scene.particles.len(), grid.shape.centres());
    let slots = state.particles.slots();
    let outside = slots.filter(|&slot| !centres.holds(Vector::from(state.particles.position[slot]))).count();
    (outside > 0).then(|| {
        format!(
            "[fluid.{}] grid: the centres of {outside} of {all} particles are outside of [grid.{}]; no fluid acts there",
            fluid.name, grid.name
        )
    })
}
