#!/usr/bin/env python3
"""What porosities miss that are held through a communication step: 2,000 beads of 1 mm that air lifts and spreads.

The velocity of the air between the beads is the same throughout, so nothing else depends on the step, which is the
interval of the history. Errors are beside a run whose communication steps are single time steps: of the whole drag,
which is the pressure drop of the bed, and of the drag cell by cell, means of 8 ms, r.m.s. over those of the reference.
Cost is user time of the program; the shorter run of two counts.
"""

import argparse
import csv
import resource
import subprocess
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
STEP, WINDOW, WINDOWS = 2e-5, 8e-3, 4  # time step, means, how many [s]
VELOCITY = 2.5  # of the air between the beads [m/s]
LENGTHS = [1, 5, 10, 25, 50, 100, 200, 400]  # of communication steps, in time steps
COUNTS = [3, 3, 16]  # of cells of 4 mm
DRAGS = [f"air.cell[{cell + 1}].mean_drag.z" for cell in range(int(np.prod(COUNTS)))]
SCENE = f"""
gravity = [0.0, 0.0, -9.81]
[run]
step = {STEP}
end = {WINDOWS * WINDOW}
seed = 1
threads = 1
[material.glass]
density = 2500.0
youngs_modulus = 5.0e6
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.8
friction = 0.3
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[cell]
edges = [[0.012, 0.0, 0.0], [0.0, 0.012, 0.0], [0.0, 0.0, 0.064]]
periodic = ["x", "y"]
[particles.beads]
material = "glass"
packing = {{ box = [[0.0, 0.0, 0.0], [0.012, 0.012, 0.0265]], count = 2000, radius = 0.5e-3 }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
[grid.column]
box = [[0.0, 0.0, 0.0], [0.012, 0.012, 0.064]]
counts = {COUNTS}
outputs = []
[fluid.air]
density = 1.2
viscosity = 1.8e-5
grid = "column"
velocity = [0.0, 0.0, {VELOCITY}]
[fluid.air.drag.di_felice]
[output]
columns = {DRAGS}
"""


def run(program, steps):
    """Drag along z of the windows, cell by cell [N], and user time [s], with so many time steps between rows."""
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "scene.toml").write_text(f"{SCENE}history_interval = {steps * STEP!r}\n".replace("'", '"'))
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([program, "run", "scene.toml", "-o", "out"], cwd=name, check=True, capture_output=True)
        cost = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        with (Path(name) / "out/history.csv").open() as file:
            rows = list(csv.DictReader(file))[1:]
    drags = np.array([[float(row[name]) for name in DRAGS] for row in rows])
    return drags.reshape(WINDOWS, -1, len(DRAGS)).mean(axis=1), cost


def apart(found, reference):
    """Root of the mean square of the difference over that of the reference."""
    return float(np.sqrt(np.mean((found - reference) ** 2) / np.mean(reference**2)))


def draw(rows, path):
    """Errors and cost over the length of the communication step, as a picture."""
    from cograin.plot import style

    length, whole, cells, cost = np.array(rows).T
    figure, [errors, costs] = style.figure(2, width=9.0, height=3.4)
    errors.loglog(1e3 * length[1:], whole[1:], "o-", color=style.COLOURS[0], label="whole drag, pressure drop")
    errors.loglog(1e3 * length[1:], cells[1:], "s-", color=style.COLOURS[1], label="cell by cell")
    errors.set(xlabel="communication step in ms", ylabel="error over the drag")
    errors.legend(frameon=False)
    costs.semilogx(1e3 * length, cost / (WINDOW * WINDOWS), "o-", color=style.COLOURS[2])
    costs.set(xlabel="communication step in ms", ylabel="processor time in s, over time", ylim=(0.0, None))
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--picture", metavar="FILE", help="draws errors and cost over the communication step")
    options = parser.parse_args()
    rows, reference = [], None
    for steps in LENGTHS:
        drags, cost = min((run(options.cograin, steps) for _ in range(2)), key=lambda found: found[1])
        reference = drags if reference is None else reference
        rows.append([steps * STEP, apart(drags.sum(axis=1), reference.sum(axis=1)), apart(drags, reference), cost])
        print("{:.2e} s: error {:.2e} in all, {:.2e} in cells; {:.2f} s".format(*rows[-1]), flush=True)
    if options.picture:
        draw(rows, options.picture)


if __name__ == "__main__":
    main()
