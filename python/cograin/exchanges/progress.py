"""One line on a terminal that shows the progress of a run."""

from __future__ import annotations

import sys
import time


class Progress:
    """Writes at most ten times a second, always on the same line; nothing if the output is not a terminal."""

    def __init__(self, begin: float, end: float, *, shown: bool | None = None) -> None:
        self._begin, self._end = begin, end
        self._shown = sys.stderr.isatty() if shown is None else shown
        self._started = self._written = time.monotonic()
        self._steps = self._evaluations = 0

    def step(self, now: float, evaluations: int) -> None:
        """Another step is done."""
        self._steps += 1
        self._evaluations += evaluations
        if not self._shown:
            return
        clock = time.monotonic()
        done = now >= self._end - 1e-9 * (self._end - self._begin)
        if clock - self._written < 0.1 and not done:
            return
        self._written = clock
        share = (now - self._begin) / (self._end - self._begin)
        left = (clock - self._started) * (1.0 - share) / share
        bar = "#" * round(30 * share)
        mean = self._evaluations / self._steps
        text = f"\r[{bar:<30}] {now:g} of {self._end:g} s, {mean:.2f} evaluations a step, {left:.0f} s left   "
        print(text, end="\n" if done else "", file=sys.stderr, flush=True)
