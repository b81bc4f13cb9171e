"""Where units are unpacked: one folder in a process for all instances of one file, which then share its library."""

from __future__ import annotations

import functools
import os
import shutil
import tempfile
import weakref
from pathlib import Path

import fmpy

from cograin.base.identity import of_file

#: So many files stay unpacked while no instance of them is open.
KEPT = 8


class Unpacked:
    """A unit's files in a folder, which goes when nobody has this object any more."""

    def __init__(self, path: str) -> None:
        #: Where they are.
        self.folder = Path(tempfile.mkdtemp(prefix="cograin-"))
        self._end = weakref.finalize(self, _remove, self.folder, os.getpid())
        fmpy.extract(path, unzipdir=str(self.folder))


def unpacked(path: Path) -> Unpacked:
    """The files of a unit. A file that was written anew since is another one."""
    # A process that was forked has files of its own: those of its parent go with the parent.
    return _of_content(str(path), of_file(path), os.getpid())


@functools.lru_cache(maxsize=KEPT)
def _of_content(path: str, _content: str, _process: int) -> Unpacked:
    """The files of a unit of this content."""
    return Unpacked(path)


def _remove(folder: Path, process: int) -> None:
    """Removes a folder, in the process that made it."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)
