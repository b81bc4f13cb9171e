"""Other particle programs as sides of the same exchanges, each where it is installed.

They have no unit, and most have no saved state, so only explicit exchanges can be had of them. Each runs in a process
of its own: their libraries do not bear each other. Those that have an interpreter of their own are spoken to line by
line (`process.py`, `serving.py`).
"""

import json
import os
import subprocess
import sys
import tempfile
import time

from cograin import CouplingStopped
from worlds import OverFloor, Row

REFUSALS = (CouplingStopped, ValueError, ChildProcessError)  # which end a course with their words
FAR = 1.0  # no interface of the set goes as far [m]
NAMES = ("lammps", "liggghts", "yade", "kratos")


class ParticleSide:
    """What the sides have in common: their interface goes at constant velocity through a step.

    A side says how far the sphere that is watched has come, and its velocity.
    """

    can_restore = has_derivatives = False
    keeps_itself = True  # none discards a step
    ends_all = False  # whether its errors end the process that it is in
    worlds = (OverFloor, Row)  # that it can be driven in

    def __init__(self, problem):
        self.problem, self.world = problem, problem.world()
        self.names = (self.world.interface,)
        self.steps, self.displacement = 0, [0.0]
        #: Whether its energy says what work was done on it.
        self.keeps_account = hasattr(problem, "particle_energy")

    @property
    def time(self):
        """Where it stands [s]."""
        return self.steps * self.world.time_step

    @property
    def work(self):
        """Work of the interface on the particles, which is what they have where nothing is lost [J]."""
        if not self.keeps_account:
            return None
        return float(self.problem.particle_energy(*self.sphere(), float(self.displacement[0])))

    def bounded(self, displacement, step):
        """The displacement as a number; refused where the interface has left the problem behind."""
        place = float(displacement[0])
        if not abs(place) < FAR:
            raise ValueError(f"the interface is to be at {place:.3g} m at {step.end:g} s")
        return place

    def count(self, step):
        """How many time steps of its own make a step."""
        return round(step.length / self.world.time_step)


def taken_by(side):
    """Processor time so far, of this process and of the one that a side may have beside it [s]."""
    return time.process_time() + getattr(side, "processor", 0.0)


def apart(script, name, *words):
    """Rows that a script prints of one other program, from a process of its own; it is told its name by ``--peer``."""
    command = [sys.executable, script, "--peer", name, *map(str, words)]
    with tempfile.TemporaryFile("w+") as beside:
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=beside, text=True) as child:
            for line in child.stdout:
                if line.startswith("##"):
                    yield json.loads(line[2:])
        beside.seek(0)
        said = beside.read().strip().splitlines()
    if child.returncode:
        print(f"\n{name} is left out: {(said or ['it gives no reason'])[-1]}")


def apart_if_needed(side, course):
    """What a course gives, which it makes in a process of its own if the program ends that by its errors."""
    if not side.ends_all:
        return course()
    here, there = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(here)
        with os.fdopen(there, "w") as pipe:
            json.dump(course(), pipe, default=float)
        os._exit(0)
    os.close(there)
    with os.fdopen(here) as pipe:
        said = pipe.read()
    os.waitpid(child, 0)
    return json.loads(said) if said else None


def hand_over(rows):
    """Prints rows for `apart`."""
    for one in rows:
        print("##" + json.dumps(one, default=float), flush=True)
