"""Ctrl-C acts where both sides of a coupling stand at the same time, not in the middle of a step."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_depth = 0
_caught: tuple[int, FrameType | None] | None = None
_usual: Any = None


@contextmanager
def held() -> Iterator[None]:
    """Holds an interrupt until the block ends, or until `check` is called in it; a second one acts at once."""
    global _depth, _usual
    mine = threading.current_thread() is threading.main_thread()
    if not mine:
        yield
        return
    if _depth == 0:
        usual = signal.getsignal(signal.SIGINT)
        if not callable(usual):
            yield
            return
        _usual = usual
        signal.signal(signal.SIGINT, _note)
    _depth += 1
    try:
        yield
    finally:
        _depth -= 1
        if _depth == 0:
            signal.signal(signal.SIGINT, _usual)
            _act()


def check() -> None:
    """Lets an interrupt act here that came in the meantime."""
    if _caught is not None and threading.current_thread() is threading.main_thread():
        _act()


def _note(number: int, frame: FrameType | None) -> None:
    """Remembers an interrupt; the second one acts."""
    global _caught
    if _caught is not None:
        _act()
    _caught = (number, frame)


def _act() -> None:
    """Does what the interrupt would have done."""
    global _caught
    caught, _caught = _caught, None
    act: Callable[[int, FrameType | None], Any] | None = _usual
    if caught is not None and act is not None:
        act(*caught)
