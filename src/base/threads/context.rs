//! The threads that work on the loops of a time step, and the lane width.

use super::helpers::Threads;
use crate::base::lanes::{Shared, Width};

/// Particles in one piece of work. Sums over particles are taken piece by piece, in order, so that they do not
/// depend on the number of threads.
pub(crate) const CHUNK: usize = 1024;

/// What a loop of a time step tells a benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopEvent {
    /// It begins.
    Begin {
        /// How many pieces it has.
        pieces: usize,
        /// Whether those of odd number wait for their neighbours.
        in_slabs: bool,
    },
    /// This piece is done.
    Done(usize),
    /// It ends.
    End,
}

/// Who is told of the loops, in benchmarks.
pub type LoopWatch = fn(LoopEvent);

/// What a pass needs to know beside the state.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    /// Time since springs were last advanced \[s\]: the time step, or 0 in the evaluation before the first one.
    pub step: f64,
    /// Lane width.
    pub width: Width,
    /// The helper threads, if several threads work.
    pub threads: Option<&'a Threads>,
    /// Who is told of the loops, if anybody is.
    pub watch: Option<LoopWatch>,
}

impl Context<'static> {
    /// Of work that is too little to be divided.
    pub(crate) const ALONE: Self = Self { step: 0.0, width: Width::Least, threads: None, watch: None };
}

impl Context<'_> {
    /// Does pieces 0 to `count` − 1 of the work, in any order.
    pub(crate) fn each(&self, count: usize, piece: impl Fn(usize) + Sync + Send) {
        let piece = self.begin(count, false, piece);
        match self.threads {
            Some(threads) if count > 1 => threads.each(count, &piece),
            _ => (0..count).for_each(piece),
        }
        self.tell(LoopEvent::End);
    }

    /// Does something with each of these, piece by piece: whichever thread does, with the same bits.
    pub(crate) fn update<T: Send>(&self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync + Send) {
        let count = items.len();
        let items = Shared::new(items);
        self.each(count.div_ceil(CHUNK), |piece| {
            let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
            // SAFETY: pieces do not overlap.
            for (number, item) in (from..).zip(unsafe { items.part(from, to) }) {
                work(number, item);
            }
        });
    }

    /// Does slabs 0 to `count` − 1 of the work: those of even number in any order, each of odd number when both its
    /// neighbours are done. What two neighbours add to one place thus always comes in the same order, and what is
    /// near in space is near in time.
    pub(crate) fn slabs(&self, count: usize, work: impl Fn(usize) + Sync + Send) {
        let work = self.begin(count, true, work);
        match self.threads {
            Some(threads) if count > 2 => threads.slabs(count, &work),
            _ => (0..count).for_each(|turn| work(in_turn(turn, count))),
        }
        self.tell(LoopEvent::End);
    }

    /// Joins what the pieces 0 to `count` − 1 give, in order, without asking for memory.
    pub(crate) fn fold<T: Send, A>(
        &self,
        count: usize,
        piece: impl Fn(usize) -> T + Sync + Send,
        start: A,
        mut join: impl FnMut(A, T) -> A,
    ) -> A {
        /// Pieces that are done before their results are joined.
        const ROUND: usize = 128;
        let piece = self.begin(count, false, piece);
        let mut sum = start;
        if let Some(threads) = self.threads.filter(|_| count > 1) {
            for from in (0..count).step_by(ROUND) {
                let mut results = [const { None }; ROUND];
                let places = Shared::new(&mut results);
                // SAFETY: each piece has a place of its own.
                let keep = |number: usize| unsafe { *places.at(number) = Some(piece(from + number)) };
                threads.each(ROUND.min(count - from), &keep);
                sum = results.into_iter().flatten().fold(sum, &mut join);
            }
        } else {
            sum = (0..count).map(piece).fold(sum, join);
        }
        self.tell(LoopEvent::End);
        sum
    }

    /// What the pieces 0 to `count` − 1 give, in order.
    pub(crate) fn collect<T: Send>(&self, count: usize, piece: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        let piece = self.begin(count, false, piece);
        let all = if let Some(threads) = self.threads.filter(|_| count > 1) {
            let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
            let places = Shared::new(&mut results);
            // SAFETY: each piece has a place of its own.
            threads.each(count, &|number| unsafe { *places.at(number) = Some(piece(number)) });
            results.into_iter().flatten().collect()
        } else {
            (0..count).map(piece).collect()
        };
        self.tell(LoopEvent::End);
        all
    }

    /// Begins a loop of so many pieces, each of which is told when it is done.
    #[inline(always)]
    fn begin<T>(
        &self,
        pieces: usize,
        in_slabs: bool,
        piece: impl Fn(usize) -> T + Sync + Send,
    ) -> impl Fn(usize) -> T + Sync + Send {
        self.tell(LoopEvent::Begin { pieces, in_slabs });
        let watch = self.watch;
        move |number| {
            let done = piece(number);
            if let Some(watch) = watch {
                watch(LoopEvent::Done(number));
            }
            done
        }
    }

    /// Tells who watches, if anybody does.
    #[inline(always)]
    fn tell(&self, event: LoopEvent) {
        if let Some(watch) = self.watch {
            watch(event);
        }
    }
}

/// The slab that one thread works on in this turn: 0, 2, 1, 4, 3, ..
fn in_turn(turn: usize, count: usize) -> usize {
    match turn {
        0 => 0,
        turn if turn % 2 == 1 && turn + 1 < count => turn + 1,
        turn if turn % 2 == 1 => turn,
        turn => turn - 1,
    }
}
