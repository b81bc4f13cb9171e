//! The stable step, and what limits it, have the same bits for any number of threads: of lattices in which every body limits the step,
//! and of those in which a few do.

use super::scenes::{Sphere, block, cubic, damped_hertz, free, noise};
use crate::support::checked;
use cograin::simulation::Simulation;
use std::sync::Arc;

/// The limit with so many threads.
fn limit(text: &str, threads: usize) -> (u64, String) {
    let scene = checked(&text.replace("threads = 1\n", &format!("threads = {threads}\n")));
    let simulation = Simulation::new(Arc::new(scene)).expect("it starts");
    assert_eq!(simulation.threads(), threads, "so many are asked for");
    let limit = simulation.limit();
    (limit.safe.to_bits(), format!("{:?}, {:e}", limit.by, simulation.state().clock.stable))
}

#[test]
fn any_number_of_threads_finds_the_same_and_names_the_same() {
    let even = cubic(27, 1.998e-3);
    let uneven: Vec<Sphere> = cubic(14, 1.998e-3)
        .into_iter()
        .enumerate()
        .map(|(index, [x, y, z, radius])| [x, y, z, radius * (1.0 + 5e-4 * noise(index))])
        .collect();
    for (name, spheres) in [("even", even), ("uneven", uneven)] {
        let text = block(&spheres, free, &damped_hertz(0.3));
        let one = limit(&text, 1);
        for threads in [2, 3] {
            assert_eq!(limit(&text, threads), one, "{name} lattice, {threads} threads");
        }
    }
}
