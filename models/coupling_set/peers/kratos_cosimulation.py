"""What the coupling that Kratos has itself makes of the drop: by its own exchanges, which repeat a step or do not."""

import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from problems import GRAVITY, MASS

from peers.kratos_side import PYTHON
from peers.process import HERE

EXCHANGES = {
    "CoSimulation, weak": (False, None),
    "CoSimulation, strong": (True, None),
    "CoSimulation, Aitken": (True, "aitken"),
    "CoSimulation, MVQN": (True, "mvqn"),
}


def steps(problem, name):
    """Its communication steps, which are its time steps. The strong ones fail, and short steps of them take minutes."""
    if problem.name != "drop":
        return ()
    return problem.steps if name == "CoSimulation, weak" else tuple(step for step in problem.steps if step >= 1e-4)


class Record(dict):
    """Its course under the names of our own records. The plate keeps its energy, so what both sides have is the check.

    Where its plate does not move at all, the work is that of the sphere.
    """

    unconverged = ()

    def __init__(self, problem, step, rows):
        height, velocity, place, speed, evaluations = np.array(rows)[:, :5].T
        sphere = problem.particle_energy(height - problem.height, velocity, place)
        plate = 0.5 * problem.plate * speed**2 + 0.5 * problem.spring * place**2
        start = MASS * GRAVITY * problem.height
        whole = np.concatenate([[start], sphere + plate])
        sizes = [np.abs(np.diff(side, prepend=begin)).sum() for side, begin in ((plate, 0.0), (sphere, start))]
        super().__init__(time=step * np.arange(1, len(rows) + 1), floor=place, height=height - problem.height)
        self.update(velocity=velocity, speed=speed, evaluations=evaluations, interface_energy=np.diff(whole))
        self.exchanged_work = float(sizes[0] or sizes[1])


def course(problem, name, step):
    """One course: its measure, evaluations in all and in contact, steps left; processor time; or why there is none."""
    strong, accelerator = EXCHANGES[name]
    settings = problem.world().told() | {"time_step": step, "strong": strong, "accelerator": accelerator}
    settings |= {"plate": problem.plate, "spring": problem.spring, "end": problem.end}
    command = [PYTHON, str(HERE / "kratos_cosimulation_program.py"), json.dumps(settings)]
    with tempfile.TemporaryDirectory(prefix="cograin-") as folder:
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=Path(folder))
    rows = [json.loads(line[2:]) for line in done.stdout.splitlines() if line.startswith("##")]
    if done.returncode or len(rows) < 2 or not np.isfinite(rows).all():
        said = (done.stderr.strip().splitlines() or ["it ended without a word"])[-1]
        return None, 0.0, f"ends after {len(rows) * step:g} s: {said}"
    record = Record(problem, step, rows)
    measure = problem.measure(record, ["floor", "height", "velocity"], record["speed"])
    touched = record["height"] + problem.height < record["floor"]
    counts = record["evaluations"]
    mean = float(counts[touched].mean()) if touched.any() else 0.0
    left = int(np.sum(counts >= 20)) if strong else 0
    return (measure, float(counts.mean()), mean, left), rows[-1][5] - rows[0][5], ""
