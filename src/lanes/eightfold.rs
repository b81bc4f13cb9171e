//! Eight numbers, in as many registers as they fill.

use super::Lane;

/// Registers of `N` that hold eight numbers.
pub trait Eightfold<N>: Copy + Send + Sync + 'static {
    /// Makes them one by one.
    fn of(make: impl FnMut(usize) -> N) -> Self;

    /// One of them.
    fn at(&self, place: usize) -> N;

    /// Their sums with others.
    fn plus(self, other: Self) -> Self;

    /// Their differences from others.
    fn minus(self, other: Self) -> Self;

    /// Multiples of them.
    fn times(self, factor: N) -> Self;

    /// Multiples of them and of others, added.
    fn mixed(self, factor: N, other: Self, with: N) -> Self;
}

impl<N: Lane, const COUNT: usize> Eightfold<N> for [N; COUNT] {
    #[inline(always)]
    fn of(make: impl FnMut(usize) -> N) -> Self {
        std::array::from_fn(make)
    }

    #[inline(always)]
    fn at(&self, place: usize) -> N {
        self[place]
    }

    #[inline(always)]
    fn plus(mut self, other: Self) -> Self {
        for k in 0..COUNT {
            self[k] = self[k] + other[k];
        }
        self
    }

    #[inline(always)]
    fn minus(mut self, other: Self) -> Self {
        for k in 0..COUNT {
            self[k] = self[k] - other[k];
        }
        self
    }

    #[inline(always)]
    fn times(mut self, factor: N) -> Self {
        for number in &mut self {
            *number = *number * factor;
        }
        self
    }

    #[inline(always)]
    fn mixed(mut self, factor: N, other: Self, with: N) -> Self {
        for k in 0..COUNT {
            self[k] = self[k] * factor + other[k] * with;
        }
        self
    }
}

/// Reads eight numbers.
#[inline(always)]
pub fn load_eight<N: Lane>(numbers: &[f64; 8]) -> N::Eight {
    // SAFETY: the registers hold eight numbers in all.
    N::Eight::of(|place| unsafe { N::load(numbers.as_ptr().add(place * N::WIDTH)) })
}

/// Adds to eight numbers.
#[inline(always)]
pub fn add_eight<N: Lane>(numbers: &mut [f64; 8], registers: N::Eight) {
    let mut place = 0;
    while place * N::WIDTH < numbers.len() {
        // SAFETY: the registers hold eight numbers in all.
        unsafe {
            let at = numbers.as_mut_ptr().add(place * N::WIDTH);
            (N::load(at) + registers.at(place)).store(at);
        }
        place += 1;
    }
}

/// Writes eight numbers.
#[inline(always)]
pub fn store_eight<N: Lane>(numbers: &mut [f64; 8], registers: N::Eight) {
    let mut place = 0;
    while place * N::WIDTH < numbers.len() {
        // SAFETY: the registers hold eight numbers in all.
        unsafe { registers.at(place).store(numbers.as_mut_ptr().add(place * N::WIDTH)) };
        place += 1;
    }
}
