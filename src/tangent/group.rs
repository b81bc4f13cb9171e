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

/// Entries of a list that are to be worked on, as soon as they fill a register.
pub(crate) struct Waiting<'a, const BODIES: usize> {
    /// The list's columns of bodies.
    columns: [&'a [u32]; BODIES],
    /// The entries.
    entries: [u32; 16],
    /// Their bodies.
    bodies: [[u32; 16]; BODIES],
    /// How many there are.
    count: usize,
    /// The first entry not yet looked at.
    next: usize,
}

impl<'a, const BODIES: usize> Waiting<'a, BODIES> {
    /// None of the entries of a list with these columns of bodies has been looked at.
    #[inline(always)]
    pub(crate) fn of(columns: [&'a [u32]; BODIES]) -> Self {
        Self { columns, entries: [0; 16], bodies: [[0; 16]; BODIES], count: 0, next: 0 }
    }

    /// The next entries to be looked at; none of them at the end, as long as some still wait.
    #[inline(always)]
    pub(crate) fn look<N: Lane>(&mut self) -> Option<Group<BODIES>> {
        if self.next < self.columns[0].len() {
            let here = Group::from::<N>(self.columns, self.next);
            self.next += here.count;
            return Some(here);
        }
        let first = Places::consecutive(0, 1);
        if self.count > 0 { Some(Group { entries: first, bodies: [first; BODIES], count: 0 }) } else { None }
    }

    /// Those of some entries wait whose bit is set.
    #[inline(always)]
    pub(crate) fn wait(&mut self, group: &Group<BODIES>, mut bits: u32) {
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            self.entries[self.count] = group.entries.at(lane) as u32;
            for (waiting, bodies) in self.bodies.iter_mut().zip(&group.bodies) {
                waiting[self.count] = bodies.at(lane) as u32;
            }
            self.count += 1;
            bits &= bits - 1;
        }
    }

    /// The next entries to be worked on, if they fill a register, or are the last.
    #[inline(always)]
    pub(crate) fn take<N: Lane>(&mut self) -> Option<Group<BODIES>> {
        if self.count < N::WIDTH && (self.count == 0 || self.next < self.columns[0].len()) {
            return None;
        }
        let (all, count) = (self.count, usize::min(self.count, N::WIDTH));
        let mut bodies = [Places::consecutive(0, 1); BODIES];
        for (bodies, waiting) in bodies.iter_mut().zip(&self.bodies) {
            *bodies = places::<N>(waiting, count);
        }
        let group = Group { entries: places::<N>(&self.entries, count), bodies, count };
        for place in count..all {
            self.entries[place - count] = self.entries[place];
            for waiting in &mut self.bodies {
                waiting[place - count] = waiting[place];
            }
        }
        self.count -= count;
        Some(group)
    }
}

/// The first of some places, so many. A whole register's worth is worth a way of its own: how many those are is known then.
#[inline(always)]
fn places<N: Lane>(some: &[u32], count: usize) -> Places {
    if count == N::WIDTH { Places::of(&some[..N::WIDTH]) } else { Places::of(&some[..count]) }
}
