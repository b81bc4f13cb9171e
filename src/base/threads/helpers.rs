//! Threads that work on the pieces of one loop after the other.
//!
//! A time step has some ten parallel loops of 5 to 500 µs. To wake a thread takes as long as the shorter ones, hence
//! helpers look for the next loop for a while before they sleep. Each thread begins with the same share of every loop:
//! what it works on is in its cache; a thread that has finished takes from the end of the shares of others.

use super::sync::{
    AtomicBool, AtomicU8, AtomicU64, AtomicUsize, LOOKS, Mutex, PATIENCE, Thread, UnsafeCell, current, fence, park,
    spin_loop, yield_now,
};
use std::sync::PoisonError;
use std::sync::atomic::Ordering::{AcqRel, Acquire, Relaxed, Release, SeqCst};

/// In the gate: pieces of the present loop may be taken.
const OPEN: u64 = 1;

/// In the gate: one helper is at work.
const INSIDE: u64 = 2;

/// A slab of odd number has been taken.
const TAKEN: u8 = u8::MAX;

/// In the gate: where the number of the loop begins.
const LOOP: u32 = 32;

/// What is to be done with each piece of a loop.
type Work<'a> = dyn Fn(usize) + Sync + 'a;

/// The first thread of a simulation and its helpers. Between communication steps the helpers sleep.
pub(crate) struct Threads {
    /// Number of the loop, helpers at work, and whether pieces may be taken.
    gate: AtomicU64,
    /// What is to be done; looked at by helpers inside the gate alone.
    work: UnsafeCell<Option<&'static Work<'static>>>,
    /// The share of each thread, the first one's first.
    shares: Vec<Share>,
    /// The same of slabs of even number.
    even: Vec<Share>,
    /// How many neighbours of each slab of odd number are done. Locked by the first thread, which lends it to the
    /// helpers for a loop.
    done: Mutex<Vec<AtomicU8>>,
    /// Whether helpers may go.
    dismissed: AtomicBool,
    /// Whether a piece of work panicked.
    failed: AtomicBool,
    /// How many helpers sleep or are about to.
    asleep: AtomicUsize,
    /// The helpers that sleep or are about to.
    sleepers: Mutex<Vec<Thread>>,
}

// SAFETY: `work` is written by the first thread while nobody is inside the gate, and read inside the gate.
unsafe impl Sync for Threads {}

/// Pieces that are still to be done: the first one in the upper half, the one behind the last in the lower. Each share
/// has a line of the cache of its own.
#[repr(align(128))]
struct Share(AtomicU64);

impl Share {
    /// Becomes the share of one of some threads.
    fn give(&self, count: usize, place: usize, threads: usize) {
        let [from, to] = [place, place + 1].map(|place| (count * place / threads) as u64);
        self.0.store((from << 32) | to, Relaxed);
    }

    /// Takes the first piece, or the last one.
    fn take(&self, first: bool) -> Option<usize> {
        let mut share = self.0.load(Relaxed);
        loop {
            let (from, to) = (share >> 32, share & u64::from(u32::MAX));
            if from >= to {
                return None;
            }
            let (left, piece) = if first { (((from + 1) << 32) | to, from) } else { (share - 1, to - 1) };
            match self.0.compare_exchange_weak(share, left, Relaxed, Relaxed) {
                Ok(_) => return Some(piece as usize),
                Err(now) => share = now,
            }
        }
    }
}

/// A helper inside the gate; it is out when this is dropped, however that comes about.
struct Inside<'a>(&'a Threads);

impl Drop for Inside<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.failed.store(true, Relaxed);
        }
        self.0.gate.fetch_sub(INSIDE, Release);
    }
}

/// The open gate; it is shut and everybody is out when this is dropped.
struct Open<'a>(&'a Threads);

impl Drop for Open<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.failed.store(true, Relaxed);
        }
        self.0.gate.fetch_and(!OPEN, AcqRel);
        let mut looks = 0;
        while self.0.gate.load(Acquire) & ((1 << LOOP) - 1) != 0 {
            look_again(&mut looks);
        }
    }
}

impl Threads {
    /// The threads of a simulation, this many.
    pub(crate) fn of(threads: usize) -> Self {
        let shares = || (0..threads).map(|_| Share(AtomicU64::new(0))).collect();
        Self {
            gate: AtomicU64::new(0),
            work: UnsafeCell::new(None),
            shares: shares(),
            even: shares(),
            done: Mutex::new(Vec::new()),
            dismissed: AtomicBool::new(false),
            failed: AtomicBool::new(false),
            asleep: AtomicUsize::new(0),
            sleepers: Mutex::new(Vec::new()),
        }
    }

    /// How many threads work.
    pub(crate) fn count(&self) -> usize {
        self.shares.len()
    }

    /// Lets the helpers go.
    pub(crate) fn dismiss(&self) {
        self.dismissed.store(true, Release);
        self.wake();
    }

    /// Does pieces 0 to `count` − 1 of a loop with the helpers that are awake. For the first thread, and not from
    /// inside another loop.
    pub(crate) fn each(&self, count: usize, work: &Work) {
        let (threads, before) = (self.shares.len(), self.gate.load(Relaxed));
        debug_assert!(before & ((1 << LOOP) - 1) == 0, "a loop inside a loop");
        for (place, share) in self.shares.iter().enumerate() {
            share.give(count, place, threads);
        }
        // SAFETY: nobody is inside the gate. What is lent here for longer than it lives is looked at inside the gate
        // alone, and everybody is out before this function ends.
        let lent = unsafe { std::mem::transmute::<&Work<'_>, &'static Work<'static>>(work) };
        // SAFETY: as above.
        self.work.with_mut(|work| unsafe { *work = Some(lent) });
        self.gate.store((((before >> LOOP) + 1) << LOOP) | OPEN, Release);
        self.wake();
        let open = Open(self);
        take_all(&self.shares, 0, work);
        drop(open);
        assert!(!self.failed.load(Relaxed), "a helper panicked");
    }

    /// Does slabs 0 to `count` − 1: those of even number in any order, each of odd number when both its neighbours are
    /// done. A thread that has finished the even ones does odd ones that others have not yet reached.
    pub(crate) fn slabs(&self, count: usize, work: &Work) {
        let threads = self.shares.len();
        for (place, share) in self.even.iter().enumerate() {
            share.give(count.div_ceil(2), place, threads);
        }
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.clear();
        done.resize_with(count, || AtomicU8::new(0));
        let (shares, done) = (&self.even, &done[..]);
        let awaited = |odd: usize| if odd + 1 < count { 2 } else { 1 };
        let do_if_ready = |odd: usize| {
            if done[odd].compare_exchange(awaited(odd), TAKEN, AcqRel, Acquire).is_ok() {
                work(odd);
            }
        };
        self.each(threads, &|place| {
            take_all(shares, place, &|piece| {
                work(2 * piece);
                let neighbours = [(2 * piece).wrapping_sub(1), 2 * piece + 1];
                let neighbours = neighbours.into_iter().filter(|&odd| odd < count);
                // What was done before is seen by who takes it.
                for odd in neighbours.clone() {
                    done[odd].fetch_add(1, AcqRel);
                }
                neighbours.for_each(do_if_ready);
            });
            let taken = || (1..count).step_by(2).all(|odd| done[odd].load(Acquire) == TAKEN);
            let mut looks = 0;
            while !taken() && !self.failed.load(Relaxed) {
                (1..count).step_by(2).for_each(do_if_ready);
                look_again(&mut looks);
            }
        });
    }

    /// Wakes the helpers that sleep, after something was stored that they wait for.
    fn wake(&self) {
        // Either this sees that somebody sleeps, or who falls asleep sees what was stored: see `sleep`.
        fence(SeqCst);
        if self.asleep.load(Relaxed) > 0 {
            let mut sleepers = self.sleepers.lock().unwrap_or_else(PoisonError::into_inner);
            sleepers.drain(..).for_each(|sleeper| sleeper.unpark());
        }
    }

    /// Helps with every loop until the threads are dismissed.
    pub(crate) fn help(&self, place: usize) {
        let (mut done, mut looks) = (0, 0);
        while !self.dismissed.load(Acquire) {
            let gate = self.gate.load(Acquire);
            if gate & OPEN == 0 || gate >> LOOP == done {
                looks += 1;
                if looks < LOOKS {
                    spin_loop();
                } else {
                    self.sleep(gate >> LOOP);
                    looks = 0;
                }
            } else if self.gate.compare_exchange(gate, gate + INSIDE, AcqRel, Relaxed).is_ok() {
                let _inside = Inside(self);
                (done, looks) = (gate >> LOOP, 0);
                // SAFETY: inside the gate it is not written, and lives.
                if let Some(work) = self.work.with(|work| unsafe { *work }) {
                    take_all(&self.shares, place, work);
                }
            }
        }
    }

    /// Sleeps until there is another loop than this, which is over or done here, or for less.
    fn sleep(&self, last: u64) {
        self.sleepers.lock().unwrap_or_else(PoisonError::into_inner).push(current());
        self.asleep.fetch_add(1, Relaxed);
        // Whoever opens the gate after this look sees that somebody sleeps.
        fence(SeqCst);
        if self.gate.load(Acquire) >> LOOP == last && !self.dismissed.load(Acquire) {
            park();
        }
        self.asleep.fetch_sub(1, Relaxed);
    }
}

/// Waits a moment for a thread that is at work; in the long run yields the processor.
fn look_again(looks: &mut u32) {
    *looks += 1;
    if *looks < PATIENCE { spin_loop() } else { yield_now() }
}

/// Does the share of this place from its front, then what others have left from the back.
fn take_all(shares: &[Share], place: usize, work: &Work) {
    while let Some(piece) = shares[place].take(true) {
        work(piece);
    }
    let (before, behind) = shares.split_at(place);
    for share in behind[1..].iter().chain(before) {
        while let Some(piece) = share.take(false) {
            work(piece);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Does something with so many threads.
    fn with_threads(count: usize, act: impl FnOnce(&Threads)) {
        let threads = &Threads::of(count);
        std::thread::scope(|scope| {
            for place in 1..count {
                scope.spawn(move || threads.help(place));
            }
            let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| act(threads)));
            threads.dismiss();
            result.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        });
    }

    #[test]
    fn every_piece_of_every_loop_is_done_once() {
        with_threads(3, |threads| {
            for count in (0..200).chain([5000]) {
                let done: Vec<AtomicUsize> = (0..count).map(|_| AtomicUsize::new(0)).collect();
                threads.each(count, &|piece| {
                    done[piece].fetch_add(1, Relaxed);
                });
                assert!(done.iter().all(|done| done.load(Relaxed) == 1), "{count} pieces");
                if count % 50 == 0 {
                    // Long enough for helpers to fall asleep.
                    std::thread::sleep(std::time::Duration::from_millis(2));
                }
            }
        });
    }

    /// The number of the last loop may be above that of the last one that the helper did.
    #[test]
    fn a_helper_that_came_too_late_for_the_last_loop_sleeps() {
        let threads = &Threads::of(2);
        for _ in 0..3 {
            threads.each(5, &|_| ());
        }
        std::thread::scope(|scope| {
            scope.spawn(|| threads.help(1));
            let begun = std::time::Instant::now();
            while threads.asleep.load(SeqCst) == 0 && begun.elapsed().as_secs() < 20 {
                std::thread::yield_now();
            }
            let asleep = threads.asleep.load(SeqCst);
            threads.dismiss();
            assert_eq!(asleep, 1);
        });
    }

    #[test]
    fn an_odd_slab_is_done_after_both_its_neighbours() {
        for threads in [1, 2, 4] {
            with_threads(threads, |threads| {
                for count in 1..60 {
                    let turn = AtomicUsize::new(1);
                    let turns: Vec<AtomicUsize> = (0..count).map(|_| AtomicUsize::new(0)).collect();
                    threads.slabs(count, &|slab| turns[slab].store(turn.fetch_add(1, SeqCst), SeqCst));
                    let turns: Vec<usize> = turns.into_iter().map(AtomicUsize::into_inner).collect();
                    assert_eq!(turn.into_inner(), count + 1, "each once");
                    for odd in (1..count).step_by(2) {
                        let after = |other: Option<&usize>| other.is_none_or(|&other| turns[odd] > other);
                        assert!(after(turns.get(odd - 1)) && after(turns.get(odd + 1)), "{odd} of {turns:?}");
                    }
                }
            });
        }
    }

    #[test]
    fn a_piece_that_panics_is_told_and_nobody_waits_for_ever() {
        for threads in [1, 3] {
            let result = std::panic::catch_unwind(|| {
                with_threads(threads, |threads| threads.slabs(40, &|slab| assert!(slab != 22, "a slab panics")));
            });
            assert!(result.is_err(), "{threads} threads");
        }
    }
}
