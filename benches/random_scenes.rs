//! Random scenes with the default time step against the same with a fine one. Prints each that differs, that stops or that
//! is refused, and how many there were: `cargo bench --bench random_scenes -- 1 200` tries seeds 1 to 200; another part of the
//! stable step (`0.8`) and a scheme may follow. Ends with status 1 where a scene stops, where one differs by more than 5 %, or where
//! more than one in fifty differs by more than 2 %.

#![allow(clippy::print_stdout, reason = "a program that prints figures")]

#[path = "../tests/support/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the tests use more of it")]
mod support;

#[path = "../tests/step/random_scenes/compare.rs"]
mod compare;
#[path = "../tests/step/random_scenes/scenes.rs"]
mod scenes;

use compare::{ALLOWED, Agreement, Outcome, judge};
use std::process::ExitCode;

/// The most that any scene may differ by, over the largest of its kind.
const MOST: f64 = 0.05;

/// One in so many scenes may differ by more than [`ALLOWED`].
const ONE_IN: u64 = 50;

fn main() -> ExitCode {
    let seeds: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let &[first, last] = seeds.as_slice() else { return ExitCode::SUCCESS };
    let others = || std::env::args().skip(1).filter(|word| word.parse::<u64>().is_err() && !word.starts_with('-'));
    let part = others().find_map(|word| word.parse().ok());
    let scheme = others().find(|word| word.parse::<f64>().is_err());
    let lines = scheme.map_or(String::new(), |scheme| format!("scheme = \"{scheme}\""));
    let (mut agree, mut whole, mut differ, mut stopped, mut refused) = (0, 0, 0, 0, 0);
    let (mut differences, mut of_means, mut errors, mut most) = (Vec::new(), Vec::new(), Vec::new(), 0.0_f64);
    for seed in first..=last {
        let (name, outcome) = judge(seed, 80, part, &lines);
        match &outcome {
            Outcome::Agrees(Agreement { apart, means, .. }) => {
                agree += 1;
                whole += usize::from(means.is_none());
                differences.push(*apart);
                of_means.extend(means.map(|[apart, _]| apart));
                errors.extend(means.map(|[_, error]| error));
            }
            Outcome::Differs(apart, ..) => {
                differ += 1;
                most = most.max(*apart);
            }
            Outcome::Stopped(_) => stopped += 1,
            Outcome::Refused(_) => refused += 1,
        }
        println!("{name} {outcome}");
    }
    println!(
        "{agree} agree within {ALLOWED} ({whole} of them run by run to the end, the others until chaos and then in the mean; median of the \
         largest difference {:.1e}, of means {:.1e} with an error of {:.1e}), {differ} differ, {stopped} stop, {refused} are refused",
        median(differences),
        median(of_means),
        median(errors)
    );
    let is_sound = stopped == 0 && most <= MOST && differ * ONE_IN <= last - first + 1;
    if is_sound { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The middle one; 0 of none.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}
