//! Coefficients of a law in lanes.

use super::MOST_COEFFICIENTS;
use super::stage::Stage;
use crate::base::lanes::Lane;

/// Coefficients in lanes: some that stand side by side in the rows of the law.
pub(crate) struct Gathered<N> {
    /// The numbers.
    numbers: [N; MOST_COEFFICIENTS],
    /// Where the first of them stands in a row.
    from: usize,
    /// How many there are.
    count: usize,
}

impl<N: Lane> Gathered<N> {
    /// Those of a stage, if they are the same for all entries; otherwise room for them.
    #[inline(always)]
    pub(crate) fn of(stage: &Stage, from: usize, count: usize) -> Self {
        let mut numbers = [N::zero(); MOST_COEFFICIENTS];
        if let Some(row) = stage.uniform {
            let mut k = 0;
            while k < count {
                numbers[k] = N::splat(row[from + k]);
                k += 1;
            }
        }
        Self { numbers, from, count }
    }

    /// Those of a register's worth of entries; behind them zeros, so that the compiler knows how many numbers there are.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most the room of the buffer, and the rows there are of the table.
    #[inline(always)]
    pub(crate) unsafe fn at(&mut self, stage: &Stage, place: usize) -> &[N; MOST_COEFFICIENTS] {
        if stage.uniform.is_none() {
            let mut k = 0;
            while k < self.count {
                // SAFETY: the caller's promise; a row has the coefficients of all sub-models.
                self.numbers[k] = unsafe { stage.table.gather(self.from + k, stage.buffer.row.as_ptr().add(place)) };
                k += 1;
            }
        }
        &self.numbers
    }
}
