//! Random scenes with the default time step against the same with a tenth of it: energies, momenta and impulses on walls
//! agree, or the run stops in words. `cargo bench --bench random_scenes` tries 200 of them.
//!
//! The scenes have driven boundaries, bonds with dashpots and bonds that are made later.

mod compare;
mod scenes;

use compare::{Agreement, Outcome, judge};

#[test]
fn agree_with_a_tenth_of_the_default_step() {
    // In 20 and 172 a spring that its dashpot stretches backwards would make the rebound depend on the step.
    for seed in (1..=8).chain([20, 172]) {
        let (name, outcome) = judge(seed, 40, None, "");
        // Run by run: none of these is chaotic so early.
        let agrees = matches!(outcome, Outcome::Agrees(Agreement { means: None, .. }) | Outcome::Stopped(_));
        assert!(agrees, "{name} {outcome}");
    }
}
