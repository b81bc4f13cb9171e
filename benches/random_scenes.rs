//! Random scenes with the default time step against the same with a tenth of it. Prints each that differs, that stops or that
//! is refused, and how many there were: `cargo bench --bench random_scenes -- 1 200` tries seeds 1 to 200; a scheme may
//! follow.

#![allow(clippy::print_stdout, reason = "a program that prints figures")]

#[path = "../tests/random_scenes/compare.rs"]
mod compare;
#[path = "../tests/random_scenes/scenes.rs"]
mod scenes;

use compare::{ALLOWED, Outcome, judge};

fn main() {
    let seeds: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let &[first, last] = seeds.as_slice() else { return };
    let scheme = std::env::args().skip(1).find(|word| word.parse::<u64>().is_err() && !word.starts_with('-'));
    let lines = scheme.map_or(String::new(), |scheme| format!("scheme = \"{scheme}\""));
    let (mut agree, mut whole, mut differ, mut stopped, mut refused) = (0, 0, 0, 0, 0);
    let mut differences = Vec::new();
    for seed in first..=last {
        let (name, outcome) = judge(seed, 80, &lines);
        match &outcome {
            Outcome::Agrees(until, apart) => {
                agree += 1;
                whole += usize::from(*until >= 7.9e-3);
                differences.push(*apart);
            }
            Outcome::Differs(..) => differ += 1,
            Outcome::Stopped(_) => stopped += 1,
            Outcome::Refused(_) => refused += 1,
        }
        println!("{name} {outcome}");
    }
    differences.sort_by(f64::total_cmp);
    let middle = differences.get(differences.len() / 2).copied().unwrap_or(0.0);
    println!(
        "{agree} agree within {ALLOWED} ({whole} of them to the end, the others until chaos; median {middle:.1e}), \
         {differ} differ, {stopped} stop, {refused} are refused"
    );
}
