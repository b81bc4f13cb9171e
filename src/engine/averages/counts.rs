//! Particles by their centres in regions and cells of grids, and how far sets of them are mixed.

use super::look::Look;
use super::looks_at_regions;
use crate::base::number::Vector;
use crate::engine::simulation::Simulation;

/// Particles whose centre is in a region or a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Count {
    /// All grains.
    pub all: u64,
    /// Those of each set of the scene; who came later is of none.
    pub of_set: Vec<u64>,
}

/// The grains whose centre is in each cell of a grid of the scene.
pub fn counts(simulation: &Simulation, grid: usize) -> Vec<Count> {
    let (scene, state) = (simulation.scene(), simulation.state());
    counted(&Look::at_grid(&scene.grids[grid].shape, scene, state), simulation)
}

/// The grains whose centre is in each region of the scene.
pub fn counts_of_regions(simulation: &Simulation) -> Vec<Count> {
    looks_at_regions(simulation).iter().flat_map(|look| counted(look, simulation)).collect()
}

/// The particles whose centre is in each part of what is looked at.
fn counted(look: &Look, simulation: &Simulation) -> Vec<Count> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let mut counts = vec![Count { all: 0, of_set: vec![0; scene.sets.len()] }; look.count()];
    for grain in state.grains() {
        let set = scene.particles.get(grain.index as usize).map(|own| own.set.0 as usize);
        look.parts_at(Vector::from(*grain.position), |part| {
            counts[part].all += 1;
            if let Some(set) = set {
                counts[part].of_set[set] += 1;
            }
        });
    }
    counts
}

/// Lacey's mixing index of some cells, each with how many particles of a set and how many in all it has.
///
/// ```text
/// M = (S₀² − S²)/(S₀² − Sᵣ²)    S² = Σ nᵢ (pᵢ − p)²/N    S₀² = p (1 − p)    Sᵣ² = p (1 − p) C/N
/// ```
///
/// | | |
/// |---|---|
/// | nᵢ, N | particles in a cell, in all cells |
/// | pᵢ, p | share of the set in a cell, in all cells |
/// | C | cells that are not empty, so that N/C is the mean size of a sample |
/// | S₀², Sᵣ² | variance of what is apart, and of what is mixed at random |
///
/// P. M. C. Lacey, J. Appl. Chem. 4, 1954, 257, each cell weighted by its particles. 0 where all particles in the cells are of the set
/// or none is, and where no cell has two.
pub fn lacey_index(cells: impl Iterator<Item = [u64; 2]> + Clone) -> f64 {
    let filled = cells.filter(|[_, all]| *all > 0);
    let (count, [of_set, all]) = filled.clone().fold((0.0, [0.0; 2]), |(count, [set, all]), [more, in_all]| {
        (count + 1.0, [set + more as f64, all + in_all as f64])
    });
    let share = of_set / all;
    let apart = share * (1.0 - share);
    if !(apart > 0.0 && count < all) {
        return 0.0;
    }
    let off = |[set, all]: [u64; 2]| set as f64 / all as f64 - share;
    let variance = filled.map(|cell| cell[1] as f64 * off(cell) * off(cell)).sum::<f64>() / all;
    (1.0 - variance / apart) / (1.0 - count / all)
}

#[cfg(test)]
mod tests {
    use super::lacey_index;

    /// The index of some cells.
    fn index(cells: &[[u64; 2]]) -> f64 {
        lacey_index(cells.iter().copied())
    }

    #[test]
    fn what_is_apart_has_0_and_what_is_mixed_evenly_more_than_1() {
        assert_eq!(index(&[[8, 8], [0, 8]]), 0.0);
        // S² = 0, Sᵣ²/S₀² = 2/16: evener than at random.
        assert_eq!(index(&[[4, 8], [4, 8]]), 16.0 / 14.0);
    }

    #[test]
    fn a_mixture_between_is_as_worked_out_by_hand() {
        // p = 9/24; pᵢ = 1/2, 1/4, 3/8 of nᵢ = 8: S² = (1/64 + 1/64 + 0)/3, S₀² = 15/64, Sᵣ² = S₀²/8.
        let by_hand = (1.0 - 2.0 / 45.0) / (1.0 - 1.0 / 8.0);
        let found = index(&[[4, 8], [2, 8], [3, 8], [0, 0]]);
        assert!((found - by_hand).abs() < 1e-15, "{found} {by_hand}");
        // Of cells of unlike size the variance is weighted by it: p = 1/2, S² = (2·1/4 + 6·1/36)/8 = 1/12.
        let found = index(&[[2, 2], [2, 6]]);
        assert!((found - (1.0 - 4.0 / 12.0) / (1.0 - 2.0 / 8.0)).abs() < 1e-15, "{found}");
    }

    #[test]
    fn cells_that_cannot_tell_give_0() {
        for cells in [&[][..], &[[0, 0]], &[[3, 3], [2, 2]], &[[0, 4]], &[[1, 1], [0, 1]]] {
            assert_eq!(index(cells), 0.0, "{cells:?}");
        }
    }

    #[test]
    fn particles_thrown_at_random_have_about_1() {
        // 20 cells of 50, each particle of the set with a chance of 0.3: numbers of a generator of congruences.
        let mut seed = 7_u64;
        let mut cell = |_| {
            let mut of_set = 0;
            for _ in 0..50 {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                of_set += u64::from((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.3 < 0.0);
            }
            [of_set, 50]
        };
        let cells: Vec<[u64; 2]> = (0..20).map(&mut cell).collect();
        // S²/Sᵣ² has a standard deviation of √(2/19) = 0.32, of which 1/50 is seen.
        assert!((index(&cells) - 1.0).abs() < 3.0 * 0.32 / 50.0, "{}", index(&cells));
    }
}
