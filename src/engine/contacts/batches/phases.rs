//! The phases of a batch.

use super::parting::Parting;
use super::{Batches, Bodies, Chosen, Entries};
use crate::base::lanes::{Kernel, Lane};
use crate::base::memory::prefetch;
use crate::engine::state::contacts::{LASTING, RELEASED, SLIDING, TOUCHING};
use crate::laws::contact::Needs;
use crate::laws::contact::batch::{BATCH, Buffer};

/// Phase 1: fills the batch with touching entries and ends the contacts that came apart. BEYOND: for laws that hold
/// bodies together beyond touch, as far as their pair constant says. CHOSEN: some of the entries alone.
pub(crate) struct TouchPhase<'a, 'b, B: Bodies, const BEYOND: bool, const CHOSEN: bool> {
    /// The list.
    pub(crate) work: &'a Batches<'a, B>,
    /// Which entries.
    pub(crate) chosen: Chosen,
    /// Behind the last entry.
    pub(crate) to: usize,
    /// The first entry not yet looked at.
    pub(crate) next: &'b mut usize,
    /// Where the touching ones go.
    pub(crate) buffer: &'b mut Buffer,
    /// What is summed up.
    pub(crate) sum: &'b mut B::Sum,
}

impl<B: Bodies, const BEYOND: bool, const CHOSEN: bool> Kernel for TouchPhase<'_, '_, B, BEYOND, CHOSEN> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, chosen, to, next, buffer, sum } = self;
        let Batches { bodies, entries, .. } = work;
        let (firsts, seconds) = (bodies.first().as_ptr(), bodies.second().as_ptr());
        let (mut entry, mut count) = (*next, buffer.count);
        while entry < to && count < BATCH {
            // SAFETY: entries up to `to` are in the lists and belong to this piece; the buffer has room for a register
            // behind a batch.
            unsafe {
                let (mut first, mut second) = (firsts.add(entry), seconds.add(entry));
                let (mut some_first, mut some_second) = ([*first; 8], [*second; 8]);
                let here = if to - entry < N::WIDTH { to - entry } else { N::WIDTH };
                let mut wanted = u32::MAX;
                if CHOSEN {
                    wanted = find_chosen(entries, entry, here, chosen);
                    if wanted == 0 {
                        entry += here;
                        continue;
                    }
                }
                if here < N::WIDTH {
                    let mut lane = 0;
                    while lane < here {
                        some_first[lane] = *first.add(lane);
                        some_second[lane] = *second.add(lane);
                        lane += 1;
                    }
                    (first, second) = (some_first.as_ptr(), some_second.as_ptr());
                }
                let mut reaches = [0.0; 8];
                if BEYOND {
                    let mut lane = 0;
                    while lane < here {
                        if *entries.flags.pointer().add(entry + lane) & TOUCHING != 0 {
                            reaches[lane] = *entries.pair_constant.at(entry + lane);
                        }
                        lane += 1;
                    }
                }
                let beyond = if BEYOND { Some(N::load(reaches.as_ptr())) } else { None };
                let (touching, found) = bodies.touch::<N>(first, second, beyond, sum);
                let bits = touching & wanted & ((1 << here) - 1);
                let parting = Parting { work, losses: &mut buffer.losses, sum: &mut *sum };
                if CHOSEN {
                    end_chosen(parting, entry, here, [wanted, bits]);
                } else if here == N::WIDTH {
                    end(parting, entry, N::WIDTH, bits);
                } else {
                    end(parting, entry, here, bits);
                }
                let mut rows = entries.history.pointer().wrapping_add(entry * entries.kept);
                let mut kept = 0;
                while kept < entries.kept {
                    let mut lane = 0;
                    while lane < N::WIDTH {
                        prefetch(rows.wrapping_add(lane));
                        lane += 2;
                    }
                    rows = rows.wrapping_add(N::WIDTH);
                    kept += 1;
                }
                N::compact(first, bits, buffer.first.as_mut_ptr().add(count));
                N::compact(second, bits, buffer.second.as_mut_ptr().add(count));
                let start = entry as u32;
                let all = [start, start + 1, start + 2, start + 3, start + 4, start + 5, start + 6, start + 7];
                N::compact(all.as_ptr(), bits, buffer.entry.as_mut_ptr().add(count));
                let mut column = 0;
                while column < B::FOUND {
                    found[column].store_compact(bits, buffer.found[column].as_mut_ptr().add(count));
                    column += 1;
                }
                count += bits.count_ones() as usize;
                entry += here;
            }
        }
        // The whole column, since its length is known: behind the last entry stands anything.
        for (history, entry) in buffer.history.iter_mut().zip(&buffer.entry) {
            *history = entry.wrapping_mul(entries.kept as u32);
        }
        (*next, buffer.count) = (entry, count);
    }
}

/// A bit in each byte.
const ONES: u64 = 0x0101_0101_0101_0101;

/// Brings bit k into byte k: each byte gets all bits, keeps its own, and is 1 where that is set.
#[inline(always)]
fn bytes(bits: u32) -> u64 {
    let kept = u64::from(bits & 0xff).wrapping_mul(ONES) & 0x8040_2010_0804_0201;
    (kept + 0x7f * ONES) >> 7 & ONES
}

/// The flags of some entries, a byte each.
///
/// # Safety
/// The entries, at most 8, belong to this piece of the list.
#[inline(always)]
unsafe fn flags_of(entries: &Entries, entry: usize, count: usize) -> u64 {
    let mut flags = [0; 8];
    // SAFETY: the caller's promise.
    unsafe { std::ptr::copy_nonoverlapping(entries.flags.pointer().add(entry), flags.as_mut_ptr(), count) };
    u64::from_le_bytes(flags)
}

/// Which of some entries are chosen, a bit for each.
///
/// # Safety
/// As for [`flags_of`].
#[inline(always)]
unsafe fn find_chosen(entries: &Entries, entry: usize, count: usize, chosen: Chosen) -> u32 {
    // SAFETY: the caller's promise.
    let flags = unsafe { flags_of(entries, entry, count) };
    let other = (flags & (u64::from(chosen.mask) * ONES)) ^ (u64::from(chosen.value) * ONES);
    // The lowest bit of each byte that is zero; their product with the powers comes together in the highest byte.
    let same = !((((other & (0x7f * ONES)) + 0x7f * ONES) | other) >> 7) & ONES;
    ((same.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32) & ((1 << count) - 1)
}

/// Writes the flags of the chosen ones among some entries of which those touch whose bit is set. Where bodies do not touch,
/// what is kept ends, but for a lasting offset.
///
/// # Safety
/// As for [`flags_of`].
#[inline(always)]
unsafe fn end_chosen<B: Bodies>(mut parting: Parting<B>, entry: usize, count: usize, [chosen, bits]: [u32; 2]) {
    let entries = &parting.work.entries;
    // SAFETY: the caller's promise.
    let before = unsafe { flags_of(entries, entry, count) };
    let (mine, now) = (bytes(chosen), bytes(bits));
    let after = (before & !(mine * u64::from(TOUCHING | SLIDING))) | now;
    // SAFETY: the caller's promise.
    unsafe {
        let flags = entries.flags.pointer().add(entry);
        std::ptr::copy_nonoverlapping(after.to_le_bytes().as_ptr(), flags, count);
    }
    let mut ended = (before | before >> 7) & mine & !now;
    while ended != 0 {
        let lane = ended.trailing_zeros() as usize / 8;
        // SAFETY: the caller's promise; there is a row for each entry.
        unsafe {
            parting.tell(entry + lane);
            end_one(entries, entry + lane);
        }
        ended &= ended - 1;
    }
}

/// Ends what is kept of an entry whose bodies do not touch, but for a lasting offset.
///
/// # Safety
/// As for [`flags_of`].
unsafe fn end_one(entries: &Entries, entry: usize) {
    // SAFETY: the caller's promise.
    let (flags, history) = unsafe { (entries.flags.at(entry), entries.history(entry)) };
    let Some((offset, remembered)) = history.split_last_mut() else { return };
    remembered.fill([0.0; 4]);
    let lasts = *flags & LASTING != 0;
    *offset = [0.0, 0.0, 0.0, if lasts { offset[3] } else { 0.0 }];
    if offset[3] == 0.0 {
        *flags &= !RELEASED;
    }
}

/// Writes the flags of some entries of which those touch whose bit is set; ends the contacts that came apart.
///
/// # Safety
/// The entries, at most 8, belong to this piece of the list.
#[inline(always)]
unsafe fn end<B: Bodies>(mut parting: Parting<B>, entry: usize, count: usize, bits: u32) {
    let entries = &parting.work.entries;
    let now = bytes(bits);
    let mut before = [0; 8];
    // SAFETY: the caller's promise.
    unsafe {
        let flags = entries.flags.pointer().add(entry);
        std::ptr::copy_nonoverlapping(flags, before.as_mut_ptr(), count);
        std::ptr::copy_nonoverlapping(now.to_le_bytes().as_ptr(), flags, count);
    }
    let mut ended = u64::from_le_bytes(before) & (u64::from(TOUCHING) * ONES) & !now;
    while ended != 0 {
        let lane = ended.trailing_zeros() as usize / 8;
        // SAFETY: the caller's promise.
        unsafe {
            parting.tell(entry + lane);
            entries.history(entry + lane).fill([0.0; 4]);
        }
        ended &= ended - 1;
    }
}

/// Phase 2: geometry and relative motion. RARE: with what few laws look at; without it, registers are left for the rest.
pub(crate) struct GeometryPhase<'b, B, const TORQUE: bool, const RARE: bool> {
    /// Which bodies meet.
    pub(crate) bodies: B,
    /// What of it the law needs.
    pub(crate) needs: Needs,
    /// The batch.
    pub(crate) buffer: &'b mut Buffer,
    /// The largest overlap over the smaller radius so far.
    pub(crate) so_far: f64,
    /// Bits where one is larger.
    pub(crate) deeper: &'b mut u32,
}

impl<B: Bodies, const TORQUE: bool, const RARE: bool> Kernel for GeometryPhase<'_, B, TORQUE, RARE> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { bodies, mut needs, buffer, so_far, deeper } = self;
        let (so_far, mut excess) = (N::splat(so_far), N::zero());
        if !RARE {
            needs = needs.without_rare();
        }
        let mut done = 0;
        // SAFETY: there is room for a register behind the batch.
        let mut roots = B::roots(&unsafe { buffer.found::<N>(0, B::FOUND) });
        while done < buffer.ready {
            // SAFETY: the slots are filled up to a whole register, for which there is room.
            unsafe {
                let (first, second) = (buffer.first.as_ptr().add(done), buffer.second.as_ptr().add(done));
                let found = buffer.found::<N>(done, B::FOUND);
                let next = B::roots(&buffer.found::<N>(done + N::WIDTH, B::FOUND));
                let geometry = bodies.meet::<N, TORQUE>(first, second, found, roots);
                let smaller = B::smaller_radius(found, geometry.contact.radius);
                excess = excess.max(geometry.contact.overlap - smaller * so_far);
                buffer.put::<N, TORQUE>(done, &geometry, needs);
                roots = next;
            }
            done += N::WIDTH;
        }
        *deeper = N::bits(excess.greater(N::zero()));
    }
}

/// Phase 4.
pub(crate) struct ScatterPhase<'b, B: Bodies> {
    /// Which bodies meet.
    pub(crate) bodies: B,
    /// What the law does to the bodies.
    pub(crate) needs: Needs,
    /// The batch.
    pub(crate) buffer: &'b Buffer,
    /// What is summed up.
    pub(crate) sum: &'b mut B::Sum,
}

impl<B: Bodies> Kernel for ScatterPhase<'_, B> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        self.bodies.spread(&self.buffer.touching(), self.needs, self.sum);
    }
}
