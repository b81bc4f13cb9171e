//! From found pairs to the lists of the contact laws, with what the laws remember of the pairs that touch.

use super::order::Order;
use super::pairs::{FoundPairs, Laws};
use crate::base::lanes::{self, Shared};
use crate::base::threads::Context;
use crate::engine::state::ContactList;
use crate::laws::contact::HistoryRow;

/// Pairs of the old list in one piece of work.
const PIECE: usize = 4096;

/// What making lists needs, kept from one time to the next.
#[derive(Debug, Default)]
pub(crate) struct ListBuilder {
    /// The list that was, of which the next one is made.
    spare: ContactList,
    /// First pair of each particle in the new list, and the number of pairs behind the last.
    starts: Vec<u32>,
}

impl ListBuilder {
    /// Replaces the list of a law by what was found. Flags and history go with the pair of particles.
    pub(crate) fn replace(
        &mut self,
        list: &mut ContactList,
        found: &[FoundPairs],
        (law, laws): (u32, &Laws),
        history: &[HistoryRow],
        (order, context): (&Order, &Context),
    ) {
        let new = &mut self.spare;
        let mine = |found: &FoundPairs| found.of_law[if laws.only.is_some() { 0 } else { law as usize }];
        new.slabs.clear();
        let mut sum = 0;
        for found in found {
            new.slabs.push(sum);
            sum += if laws.only.is_none_or(|only| only == law) { mine(found) } else { 0 };
        }
        new.slabs.push(sum);
        let count = sum as usize;
        new.first.resize(count, 0);
        new.second.resize(count, 0);
        new.flags.resize(count, 0);
        new.history.resize(history.len(), count);
        new.pair_constant.clear();
        self.starts.resize(order.slots.len() + 1, 0);
        self.fill(found, (law, laws), order, context);
        self.carry(list, history, order, context);
        std::mem::swap(list, &mut self.spare);
    }

    /// Writes the pairs, slabs side by side; nothing touches yet.
    fn fill(&mut self, found: &[FoundPairs], (law, laws): (u32, &Laws), order: &Order, context: &Context) {
        let new = &mut self.spare;
        let (first, second) = (Shared::new(&mut new.first), Shared::new(&mut new.second));
        let (flags, rows) = (Shared::new(&mut new.flags), new.history.rows());
        let history = Shared::new(new.history.all_mut());
        let starts = Shared::new(&mut self.starts);
        let (slabs, particles) = (&new.slabs, &order.slabs);
        context.each(found.len(), |slab| {
            let (from, to) = (slabs[slab] as usize, slabs[slab + 1] as usize);
            let (low, high) = (particles[slab] as usize, particles[slab + 1] as usize);
            let found = &found[slab];
            // SAFETY: pairs and particles of a slab are its own.
            unsafe {
                let (first, second) = (first.part(from, to), second.part(from, to));
                let starts = starts.part(low, high);
                if from == to {
                    starts.fill(from as u32);
                } else if laws.only.is_some() {
                    second.copy_from_slice(&found.second[..to - from]);
                    for (start, &place) in starts.iter_mut().zip(&found.starts) {
                        *start = from as u32 + place;
                    }
                    name_rows(first, low, &found.starts);
                } else {
                    let chosen = (0..found.count).filter(|&pair| found.law[pair] == law);
                    for ((first, second), pair) in first.iter_mut().zip(second).zip(chosen) {
                        (*first, *second) = (found.first[pair], found.second[pair]);
                    }
                    begin_rows(first, low, from, starts);
                }
                flags.part(from, to).fill(0);
                history.part(from * rows, to * rows).fill([0.0; 4]);
            }
        });
        if let Some(last) = self.starts.last_mut() {
            *last = new.first.len() as u32;
        }
    }

    /// Brings flags and history of pairs that have any from the old list, pieces side by side.
    fn carry(&mut self, old: &ContactList, kept: &[HistoryRow], order: &Order, context: &Context) {
        let (flags, rows) = (Shared::new(&mut self.spare.flags), self.spare.history.rows());
        let history = Shared::new(self.spare.history.all_mut());
        let (second, starts, new_slot) = (&self.spare.second[..], &self.starts[..], &order.new_slot[..]);
        context.each(old.first.len().div_ceil(PIECE), |piece| {
            let mut flagged = [0_u32; PIECE];
            let count = find_flagged(&old.flags, piece, &mut flagged);
            for &pair in &flagged[..count] {
                let pair = pair as usize;
                let (a, b) = (new_slot[old.first[pair] as usize], new_slot[old.second[pair] as usize]);
                let (i, j) = if a < b { (a, b) } else { (b, a) };
                let (from, end) = (starts[i as usize] as usize, starts[i as usize + 1] as usize);
                if let Some(place) = find(&second[from..], end - from, j).map(|place| from + place) {
                    // SAFETY: no other old pair is of these two particles.
                    unsafe {
                        *flags.at(place) = old.flags[pair];
                        let new = history.part(place * rows, (place + 1) * rows);
                        for ((new, old), kept) in new.iter_mut().zip(old.history.get(pair)).zip(kept) {
                            *new = if a < b { *old } else { kept.reversed(*old) };
                        }
                    }
                }
            }
        });
    }
}

/// Writes the pairs of a piece that have a flag, without a branch that cannot be foreseen. Returns how many.
fn find_flagged(flags: &[u8], piece: usize, flagged: &mut [u32; PIECE]) -> usize {
    let mut count = 0;
    for pair in piece * PIECE..((piece + 1) * PIECE).min(flags.len()) {
        flagged[count] = pair as u32;
        count += usize::from(flags[pair] != 0);
    }
    count
}

/// Where a number stands among the first `length`, if it does.
#[inline(always)]
fn find(numbers: &[u32], length: usize, wanted: u32) -> Option<usize> {
    let mut from = 0;
    // Eight are looked at together: a loop of unforeseen length costs more.
    while let Some(eight) = numbers[from..].first_chunk::<8>() {
        let bits = lanes::equal(eight, wanted);
        if bits != 0 || from + 8 >= length {
            let place = from + bits.trailing_zeros() as usize;
            return Some(place).filter(|&place| place < length);
        }
        from += 8;
    }
    numbers[from..length].iter().position(|&number| number == wanted).map(|place| from + place)
}

/// Writes the first particle of each pair: rows of the particles `low` and on begin at `starts`.
fn name_rows(first: &mut [u32], low: usize, starts: &[u32]) {
    for (row, &start) in starts.iter().enumerate() {
        let (name, mut place) = ((low + row) as u32, start as usize);
        let end = starts.get(row + 1).map_or(first.len(), |&end| end as usize);
        // Whole eights, where there is room: the next row overwrites what is too much.
        while place < end {
            match first[place..].first_chunk_mut::<8>() {
                Some(eight) => *eight = [name; 8],
                None => first[place..end].fill(name),
            }
            place += 8;
        }
    }
}

/// Notes where the pairs of each particle begin: `first` are those of particles `low` and on, and stand behind
/// `before` others.
fn begin_rows(first: &[u32], low: usize, before: usize, starts: &mut [u32]) {
    let mut particle = 0;
    for (pair, &i) in first.iter().enumerate() {
        while low + particle <= i as usize {
            starts[particle] = (before + pair) as u32;
            particle += 1;
        }
    }
    starts[particle..].fill((before + first.len()) as u32);
}
