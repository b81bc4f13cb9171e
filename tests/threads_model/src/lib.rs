//! The threads of a time step (`src/base/threads/helpers.rs`, the file itself) in all orders in which they may run, up to a number of
//! forced changes between them: loom tells of a deadlock, a lost wake-up, a data race, and of what the models below demand.

#[path = "../../../src/base/threads/helpers.rs"]
mod helpers;

/// What the file is written against: as in the library, from loom.
mod sync {
    pub(crate) use loom::cell::UnsafeCell;
    pub(crate) use loom::hint::spin_loop;
    pub(crate) use loom::sync::Mutex;
    pub(crate) use loom::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, AtomicUsize, fence};
    pub(crate) use loom::thread::{Thread, current, park, yield_now};

    /// A helper sleeps after its first look.
    pub(crate) const LOOKS: u32 = 1;

    /// Whoever waits lets others run.
    pub(crate) const PATIENCE: u32 = 1;
}

use helpers::Threads;
use loom::cell::UnsafeCell;
use loom::sync::Arc;

/// Cells that pieces of work write to: loom tells where two threads do so at a time, or where one does not see what the other wrote.
pub struct Cells(Vec<UnsafeCell<u32>>);

// SAFETY: loom looks after that.
unsafe impl Sync for Cells {}

impl Cells {
    /// So many.
    fn new(count: usize) -> Self {
        Self((0..count).map(|_| UnsafeCell::new(0)).collect())
    }

    /// Adds 1 to one of them.
    fn add(&self, place: usize) {
        // SAFETY: loom refuses what is not.
        self.0[place].with_mut(|cell| unsafe { *cell += 1 });
    }

    /// What is in one of them.
    fn get(&self, place: usize) -> u32 {
        // SAFETY: as above.
        self.0[place].with(|cell| unsafe { *cell })
    }
}

/// Runs work with one helper in every order with at most so many forced changes.
fn with_helper(changes: usize, work: impl Fn(&Threads) + Sync + Send + 'static) {
    let mut model = loom::model::Builder::new();
    model.preemption_bound = Some(changes);
    model.check(move || {
        let threads = Arc::new(Threads::of(2));
        let helper = {
            let threads = Arc::clone(&threads);
            loom::thread::spawn(move || threads.help(1))
        };
        work(&threads);
        threads.dismiss();
        helper.join().unwrap();
    });
}

/// Loops after loops: each piece is done once, and whoever opened the loop sees what was done.
pub fn every_piece_is_done_once_and_seen() {
    with_helper(3, |threads| {
        let cells = Cells::new(2);
        for turn in 1..=2 {
            threads.each(2, &|piece| cells.add(piece));
            assert!((0..2).all(|piece| cells.get(piece) == turn));
        }
    });
}

/// Slabs: one of odd number is done after both its neighbours, and sees what they did.
pub fn an_odd_slab_sees_what_its_neighbours_did() {
    with_helper(2, |threads| {
        let cells = Cells::new(3);
        threads.slabs(3, &|slab| {
            if slab == 1 {
                assert!(cells.get(0) == 1 && cells.get(2) == 1);
            }
            cells.add(slab);
        });
        assert!((0..3).all(|slab| cells.get(slab) == 1));
    });
}

/// Nothing to do: a helper that sleeps, or is about to, is woken to go.
pub fn a_helper_is_dismissed() {
    with_helper(4, |_| ());
}
