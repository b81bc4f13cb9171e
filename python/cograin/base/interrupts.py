"""Ctrl-C acts where both sides of a coupling stand at the same time; it ends a step of a unit that is under way."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_depth = 0
_caught: tuple[int, FrameType | None] | None = None
_usual: Any = None
_before = -1  # who else was told of signals

#: What ends the steps of units that are under way.
_running: dict[int, Callable[[], Any]] = {}
_lock = threading.Lock()


@contextmanager
def held() -> Iterator[None]:
    """Holds an interrupt until the block ends, or until `check` is called in it; a second one acts at once."""
    global _depth, _usual, _before
    if not is_main():
        yield
        return
    if _depth == 0:
        usual = signal.getsignal(signal.SIGINT)
        if not callable(usual):
            yield
            return
        _usual = usual
        signal.signal(signal.SIGINT, _note)
        _watch()
        if _pipe is not None:
            _before = signal.set_wakeup_fd(_pipe[1], warn_on_full_buffer=False)
    _depth += 1
    try:
        yield
    finally:
        _depth -= 1
        if _depth == 0:
            signal.set_wakeup_fd(_before)
            signal.signal(signal.SIGINT, _usual)
            _act()


@contextmanager
def ending(cancel: Callable[[], Any]) -> Iterator[None]:
    """Within `held`: an interrupt calls this at once, in another thread, while the block waits for a unit."""
    check()
    key = threading.get_ident()
    _running[key] = cancel
    try:
        yield
    finally:
        # What ends this step must not come to a later call.
        with _lock:
            _running.pop(key, None)


#: Ends of the pipe through which the system tells a signal, while Python waits for a call of a library.
_pipe: tuple[int, int] | None = None


def _watch() -> None:
    """Begins to listen, in a thread of its own, in the first step of a process."""
    global _pipe
    if _pipe is None and is_main():
        _pipe = os.pipe()
        os.set_blocking(_pipe[1], False)
        threading.Thread(target=_listen, args=(_pipe[0],), name="cograin interrupts", daemon=True).start()


def _forget() -> None:
    """A process that was forked has no such thread."""
    global _pipe, _lock
    _pipe, _lock = None, threading.Lock()
    _running.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)


def _listen(told: int) -> None:
    """Ends the steps that are under way when an interrupt is told."""
    while signals := os.read(told, 64):
        if signal.SIGINT in signals:
            with _lock:
                for cancel in list(_running.values()):
                    cancel()


def is_main() -> bool:
    """Whether this is the thread in which interrupts act."""
    return threading.current_thread() is threading.main_thread()


def check() -> None:
    """Lets an interrupt act here that came in the meantime."""
    if _caught is not None and is_main():
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
