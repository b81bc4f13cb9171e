"""The cograin command: settles scenes and packages them as units."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterable
from pathlib import Path


class ProgramError(Exception):
    """The command ended with an error, whose message this is."""


class Program:
    """The command ``cograin``: the one that was installed with this package, else the first on the search path.

    ``path`` names another one.
    """

    def __init__(self, path: str | Path = "cograin") -> None:
        self.path = Path(path)
        # A path from here is not a name to look for, however it is written: "./cograin" is one, too.
        self.command = str(self.path.resolve()) if os.sep in str(path) else str(path)
        if str(path) == "cograin":
            # The scripts of an environment that was not activated are on no search path.
            beside = Path(sysconfig.get_path("scripts")) / ("cograin.exe" if sys.platform == "win32" else "cograin")
            if beside.is_file():
                self.path = beside
                self.command = str(beside)

    def __call__(self, *arguments: str | Path) -> str:
        """Runs the command with these arguments; returns what it printed."""
        try:
            done = subprocess.run([self.command, *map(str, arguments)], capture_output=True, text=True, check=False)
        except FileNotFoundError:
            raise ProgramError(f"{self.path}: not found; install it (pip install .), or name it") from None
        if done.returncode:
            raise ProgramError(f"cograin {' '.join(map(str, arguments))}: {(done.stderr or done.stdout).strip()}")
        return done.stdout

    def settle(self, scene: str | Path, checkpoint: str | Path) -> str:
        """Brings a scene to rest, in place of an earlier file; returns what the command printed."""
        return self("settle", scene, "-o", checkpoint, "--overwrite")

    def export(
        self, scene: str | Path, unit: str | Path, *, start: str | Path | None = None, platforms: Iterable[str] = ()
    ) -> Path:
        """Packages a scene, settled if a state is given, in place of an earlier file; returns the unit's path.

        ``platforms``, such as ``["linux64"]``, are those for which the unit carries a library; by default all that
        there are.
        """
        settled = () if start is None else ("--from", start)
        chosen = [word for name in platforms for word in ("--platform", name)]
        self("export", scene, *settled, *chosen, "-o", unit, "--overwrite")
        return Path(unit)
