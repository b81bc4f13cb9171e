//! What of a list is worked on together.

use crate::lanes::{Lane, Places};

/// Some entries of a list, as many as there are lanes; where there are fewer, the first one is repeated. Each has one body or two.
#[derive(Clone, Copy)]
pub(crate) struct Group<const BODIES: usize> {
    /// The entries.
    pub entries: Places,
    /// Their bodies (slots).
    pub bodies: [Places; BODIES],
    /// How many there are.
    pub count: usize,
}

impl<const BODIES: usize> Group<BODIES> {
    /// Those from one on, of a list with these columns of bodies.
    #[inline(always)]
    pub(crate) fn from<N: Lane>(columns: [&[u32]; BODIES], first: usize) -> Self {
        let count = if N::WIDTH == 1 { 1 } else { usize::min(N::WIDTH, columns[0].len() - first) };
        let mut bodies = [Places::consecutive(0, 1); BODIES];
        for (bodies, column) in bodies.iter_mut().zip(columns) {
            *bodies = places::<N>(&column[first..], count);
        }
        Self { entries: Places::consecutive(first, count), bodies, count }
    }
}

/// The first of some places, so many. A whole register's worth is worth a way of its own: how many those are is known then.
#[inline(always)]
fn places<N: Lane>(some: &[u32], count: usize) -> Places {
    if count == N::WIDTH { Places::of(&some[..N::WIDTH]) } else { Places::of(&some[..count]) }
}
