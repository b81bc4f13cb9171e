//! Eight numbers, in as many registers as they fill.
//!
//! Where they fill more than two, arithmetic with them is functions that are called: laws over numbers with eight slopes would
//! become several times as much code for processors that hardly anybody has.

use super::Lane;

/// Registers that an operation in line works on at most.
const MOST_IN_LINE: usize = 2;

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

/// [`Eightfold::plus`]
#[inline(always)]
fn plus<N: Lane, const COUNT: usize>(one: [N; COUNT], other: [N; COUNT]) -> [N; COUNT] {
    std::array::from_fn(|k| one[k] + other[k])
}

/// [`Eightfold::minus`]
#[inline(always)]
fn minus<N: Lane, const COUNT: usize>(one: [N; COUNT], other: [N; COUNT]) -> [N; COUNT] {
    std::array::from_fn(|k| one[k] - other[k])
}

/// [`Eightfold::times`]
#[inline(always)]
fn times<N: Lane, const COUNT: usize>(one: [N; COUNT], factor: N) -> [N; COUNT] {
    std::array::from_fn(|k| one[k] * factor)
}

/// [`Eightfold::mixed`]
#[inline(always)]
fn mixed<N: Lane, const COUNT: usize>(one: [N; COUNT], factor: N, other: [N; COUNT], with: N) -> [N; COUNT] {
    std::array::from_fn(|k| one[k] * factor + other[k] * with)
}

/// The same functions, called.
mod called {
    use super::Lane;

    /// [`Eightfold::plus`](super::Eightfold::plus)
    #[inline(never)]
    pub(super) fn plus<N: Lane, const COUNT: usize>(one: [N; COUNT], other: [N; COUNT]) -> [N; COUNT] {
        super::plus(one, other)
    }

    /// [`Eightfold::minus`](super::Eightfold::minus)
    #[inline(never)]
    pub(super) fn minus<N: Lane, const COUNT: usize>(one: [N; COUNT], other: [N; COUNT]) -> [N; COUNT] {
        super::minus(one, other)
    }

    /// [`Eightfold::times`](super::Eightfold::times)
    #[inline(never)]
    pub(super) fn times<N: Lane, const COUNT: usize>(one: [N; COUNT], factor: N) -> [N; COUNT] {
        super::times(one, factor)
    }

    /// [`Eightfold::mixed`](super::Eightfold::mixed)
    #[inline(never)]
    pub(super) fn mixed<N: Lane, const COUNT: usize>(
        one: [N; COUNT],
        factor: N,
        other: [N; COUNT],
        with: N,
    ) -> [N; COUNT] {
        super::mixed(one, factor, other, with)
    }
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
    fn plus(self, other: Self) -> Self {
        if COUNT > MOST_IN_LINE { called::plus(self, other) } else { plus(self, other) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        if COUNT > MOST_IN_LINE { called::minus(self, other) } else { minus(self, other) }
    }

    #[inline(always)]
    fn times(self, factor: N) -> Self {
        if COUNT > MOST_IN_LINE { called::times(self, factor) } else { times(self, factor) }
    }

    #[inline(always)]
    fn mixed(self, factor: N, other: Self, with: N) -> Self {
        if COUNT > MOST_IN_LINE { called::mixed(self, factor, other, with) } else { mixed(self, factor, other, with) }
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
pub fn store_eight<N: Lane>(registers: N::Eight) -> [f64; 8] {
    let mut numbers = [0.0; 8];
    let mut place = 0;
    while place * N::WIDTH < numbers.len() {
        // SAFETY: the registers hold eight numbers in all.
        unsafe { registers.at(place).store(numbers.as_mut_ptr().add(place * N::WIDTH)) };
        place += 1;
    }
    numbers
}
