//! Every target over its corpus, and over changes of it for some seconds: no panic, no signal, no hang, no number that is not finite where
//! nothing was said. `tools/fuzz` looks for longer.

#![allow(
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "a unit in this process has silenced panics; the test's output tells"
)]

use cograin_fuzz::{Mutator, TARGETS, Target, kept_in};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::abort;
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Changed inputs of each target are tried for so long,
const TIME: Duration = Duration::from_secs(10);

/// but no more of them: what is tried does not depend on how fast a machine is.
const MOST: u64 = 1000;

/// One input takes no longer.
const LONGEST: Duration = Duration::from_secs(120);

/// Keeps an input, and says where.
fn keep(target: &Target, name: &str, bytes: &[u8]) -> String {
    let file = kept_in("found").join(format!("{}_{}", target.name, name.replace([' ', '/'], "_")));
    std::fs::write(&file, bytes).unwrap();
    file.display().to_string()
}

/// Tries inputs of a target; a thread beside it ends the process where one hangs.
fn try_all(target: &Target) {
    let (now, (begins, begun)) = (&Mutex::new((String::new(), Vec::new())), channel());
    std::thread::scope(move |scope| {
        scope.spawn(move || {
            loop {
                match begun.recv_timeout(LONGEST) {
                    Ok(()) => {}
                    Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) => {
                        let (name, bytes) = &*now.lock().unwrap();
                        eprintln!(
                            "{} takes more than {LONGEST:?} for {name}: {}",
                            target.name,
                            keep(target, name, bytes)
                        );
                        abort();
                    }
                }
            }
        });
        let run = |name: &str, bytes: &[u8]| {
            *now.lock().unwrap() = (name.to_owned(), bytes.to_vec());
            begins.send(()).unwrap();
            if catch_unwind(AssertUnwindSafe(|| (target.run)(bytes))).is_err() {
                eprintln!("{} fails on {name}: {}", target.name, keep(target, name, bytes));
                panic!("a target fails");
            }
        };
        let entries = target.entries();
        assert!(entries.len() > 3, "there is a corpus of {}", target.name);
        for (path, bytes) in &entries {
            run(&path.display().to_string(), bytes);
        }
        let (mutator, begun) = (Mutator::of(target), Instant::now());
        let mut seed = 0;
        while seed < MOST && begun.elapsed() < TIME {
            seed += 1;
            run(&format!("seed {seed}"), &mutator.changed(mutator.entry(seed), seed));
        }
        println!("{}: {} entries of the corpus and {seed} changes", target.name, entries.len());
    });
}

/// One test a target, and one that none is left out.
macro_rules! tests {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                try_all(TARGETS.iter().find(|target| target.name == stringify!($name)).unwrap());
            }
        )*

        #[test]
        fn every_target_is_tried() {
            assert!(TARGETS.iter().map(|target| target.name).eq([$(stringify!($name)),*]));
        }
    };
}

tests! { scene particles frames mesh state calls }
