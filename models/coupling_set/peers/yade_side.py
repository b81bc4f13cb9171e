"""YADE, a program with an interpreter of its own: the floor is a wall that moves at constant velocity."""

import shutil

from peers.process import HERE, Process
from worlds import OverFloor, Rough, Row

PROGRAM = shutil.which("yade")
if PROGRAM is None:
    raise ImportError("no program yade on the path")


class Side(Process):
    """Spheres in YADE. It can restore a state of its memory, so it can be had in repeated exchanges, too."""

    can_restore = True
    worlds = (OverFloor, Rough, Row)

    def __init__(self, problem):
        super().__init__([PROGRAM, "-j1", "-n", "-x", HERE / "yade_program.py", HERE], problem)
