//! One target under libFuzzer, which the variable `TARGET` names: `tools/fuzz` sets it.

#![no_main]

use cograin_fuzz::{Mutator, Target};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use std::sync::LazyLock;

/// The target.
static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("TARGET").unwrap_or_default();
    cograin_fuzz::TARGETS.iter().find(|target| target.name == name).expect("TARGET names one of cograin_fuzz::TARGETS")
});

/// What changes its inputs.
static MUTATOR: LazyLock<Mutator> = LazyLock::new(|| Mutator::of(&TARGET));

fuzz_target!(|bytes: &[u8]| (TARGET.run)(bytes));

// Half of the changes are libFuzzer's own, which know what the library compares its input with; half know lines and numbers.
fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    if seed % 2 == 0 {
        return fuzzer_mutate(data, size, max_size);
    }
    let changed = MUTATOR.changed(&data[..size], u64::from(seed));
    let length = changed.len().min(max_size);
    data[..length].copy_from_slice(&changed[..length]);
    length
});
