"""A program with an interpreter of its own as a side: it runs beside this process and is spoken to line by line."""

import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from peers import ParticleSide

HERE = Path(__file__).resolve().parent


class Process(ParticleSide):
    """Spheres in a process that runs `serving.serve`; a saved state where it says that it has some."""

    def __init__(self, command, problem):
        super().__init__(problem)
        self.folder = tempfile.TemporaryDirectory(prefix="cograin-")
        with (Path(self.folder.name) / "said").open("w") as said:
            self.child = subprocess.Popen(
                list(map(str, command)),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=said,
                text=True,
                cwd=self.folder.name,
            )
        #: Processor time of that process, less that of the words on this side: a program is not to pay for them [s].
        self.values, self.processor, self.there = [], 0.0, 0.0
        self._ask(**self.world.told())

    def _ask(self, **words):
        """One line to it, and its answer: forces, way and velocity, and the processor time it has had [s]."""
        begin, before = time.process_time(), self.there
        self._say(words)
        *self.values, self.there = self._hear()
        self.processor += self.there - before - (time.process_time() - begin)

    def _say(self, words):
        """One line to it."""
        try:
            self.child.stdin.write(json.dumps(words) + "\n")
            self.child.stdin.flush()
        except BrokenPipeError:
            pass  # why it ended is said where its answer is awaited

    def _hear(self):
        """The numbers of its next answer."""
        for line in self.child.stdout:
            if line.startswith("##"):
                return json.loads(line[2:])
        said = (Path(self.folder.name) / "said").read_text().strip().splitlines()
        raise ChildProcessError(said[-1] if said else "it ended without a word")

    def force(self, kind):
        """Force of the spheres on the interface [N]: at the end of the last step, or its mean."""
        return np.array([self.values[1 if kind == "mean" else 0]])

    def advance(self, displacement, step, kind):
        """Moves the interface there during a step."""
        count = self.count(step)
        self._ask(place=self.bounded(displacement, step), count=count)
        if not np.isfinite(self.values).all():
            raise ValueError(f"the sphere is at {self.values[2]} m after {step.end:g} s")
        self.steps += count
        self.displacement = displacement
        return self.force(kind)

    def sphere(self):
        """How far the sphere that is watched has come, and its velocity [m, m/s]."""
        return tuple(self.values[2:4])

    def save(self):
        """Saves its state in place of the one saved before."""
        self._ask(state="save")
        self.saved = self.steps, self.displacement, list(self.values)

    def restore(self):
        """Restores the saved state."""
        self._ask(state="restore")
        self.steps, self.displacement, self.values = self.saved[0], self.saved[1], list(self.saved[2])

    def close(self):
        """Ends it."""
        self.child.stdin.close()
        self.child.wait()
        self.child.stdout.close()
        self.folder.cleanup()
