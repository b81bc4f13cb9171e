//! Particles by their centres in the cells of grids.

use super::look::Look;
use crate::engine::simulation::Simulation;

/// Particles whose centre is in a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Count {
    /// All, a clump as one.
    pub all: u64,
    /// Those of each set of the scene; who came later is of none.
    pub of_set: Vec<u64>,
}

/// The particles whose centre is in each cell of a grid of the scene, clumps by their mass centre.
pub fn counts(simulation: &Simulation, grid: usize) -> Vec<Count> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let look = Look::at_grid(&scene.grids[grid].shape, scene, state);
    let mut counts = vec![Count { all: 0, of_set: vec![0; scene.sets.len()] }; look.count()];
    let particles = &state.particles;
    let mut add = |index: u32, [x, y, z, _]: [f64; 4]| {
        let set = scene.particles.get(index as usize).map(|own| own.set.0 as usize);
        look.parts_at([x, y, z].into(), |cell| {
            counts[cell].all += 1;
            if let Some(set) = set {
                counts[cell].of_set[set] += 1;
            }
        });
    };
    for slot in particles.slots().filter(|&slot| state.clump(slot).is_none()) {
        add(particles.id[slot], particles.position[slot]);
    }
    for clump in 0..state.clumps.len() {
        add(state.clumps.spheres_of(clump)[0], state.clumps.position[clump]);
    }
    counts
}
