#!/usr/bin/env python3
"""A bed at rest that heats for an hour from a plate: error over cost of Euler's method, which a given time step asks for, and of the stabilised one, whose steps
follow the error. 1,600 spheres of 0.25 mm in 100 layers; the largest error of a sphere in the 21st, over the hour, beside the closed modes of a chain of
layers, over the difference of temperature at the start. Cost is user time of the program; the shorter run of two counts.
"""

import argparse
import csv
import math
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RADIUS, OVERLAP, LAYERS = 2.5e-4, 1e-6, 100  # [m], [m]
DENSITY, SPECIFIC_HEAT, CONDUCTIVITY = 2500.0, 800.0, 5.0
COLD, HOT = 300.0, 400.0  # [K]
ROWS, HOUR = 12, 3600.0  # of the history; [s]
MIDDLE = 20  # layers below the sphere that is looked at
SCENE = """
[run]
end = {hour!r}
threads = 1
{step}[heat]
frozen = true
[material.glass]
density = {density!r}
youngs_modulus = 5.0e7
poissons_ratio = 0.3
conductivity = {conductivity!r}
specific_heat = {specific_heat!r}
[pair.glass.glass]
restitution = 0.5
friction = 0.5
[contact.all.normal.hertz]
[contact.all.heat.constriction]
[particles.all]
material = "glass"
temperature = {cold!r}
lattice = {{ kind = "simple_cubic", radius = {radius!r}, spacing = {spacing!r}, counts = [4, 4, {layers}], origin = [0.0, 0.0, 0.0] }}
[boundary.plate]
material = "glass"
plane = {{ point = [0.0, 0.0, {height!r}], normal = [0.0, 0.0, 1.0] }}
temperature = {hot!r}
[probe.middle]
particle = {middle!r}
[output]
history_interval = {interval!r}
columns = ["middle.temperature"]
"""
EULER = [0.5, 0.25, 0.125]  # time steps over C/ΣH


def conductances():
    """Conductance between two spheres, and of one and the plate [W/K]."""
    return [2.0 * CONDUCTIVITY * math.sqrt(radius * OVERLAP) for radius in (0.5 * RADIUS, RADIUS)]


def capacity():
    """Heat capacity of a sphere [J/K]."""
    return 4.0 / 3.0 * math.pi * RADIUS**3 * DENSITY * SPECIFIC_HEAT


def exact(times):
    """Temperatures of that layer [K]."""
    import numpy as np

    between, below = conductances()
    matrix = np.zeros((LAYERS, LAYERS))
    for layer in range(LAYERS - 1):
        matrix[layer : layer + 2, layer : layer + 2] += between * np.array([[1.0, -1.0], [-1.0, 1.0]])
    matrix[0, 0] += below
    roots, modes = np.linalg.eigh(matrix / capacity())
    amplitudes = modes.T @ np.full(LAYERS, COLD - HOT)
    return [HOT + float(modes[MIDDLE] @ (amplitudes * np.exp(-roots * time))) for time in times]


def run(program, step):
    """Largest error over the difference at the start, and user time [s]."""
    spacing = 2.0 * RADIUS - OVERLAP
    text = SCENE.format(
        hour=HOUR, step=step, density=DENSITY, conductivity=CONDUCTIVITY, specific_heat=SPECIFIC_HEAT, cold=COLD, hot=HOT, radius=RADIUS,
        spacing=spacing, layers=LAYERS, height=OVERLAP - RADIUS, middle=16 * MIDDLE + 1, interval=HOUR / ROWS,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([program, "run", "scene.toml", "-o", "out"], cwd=folder, check=True, capture_output=True)
        cost = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        with (folder / "out/history.csv").open() as file:
            rows = list(csv.DictReader(file))
    times = [float(row["time"]) for row in rows]
    found = [float(row["middle.temperature"]) for row in rows]
    return max(abs(one - other) for one, other in zip(found, exact(times), strict=True)) / (HOT - COLD), cost


def draw(found, path):
    """Error over cost, as a picture: name, error, cost [s] of each method."""
    from cograin.plot import style

    figure, [panel] = style.figure(width=5.0, height=3.2)
    euler, [stabilised] = found[:-1], found[-1:]
    panel.loglog([cost for *_, cost in euler], [error for _, error, _ in euler], "o-", color=style.COLOURS[0], label="Euler")
    for name, error, cost in euler:
        panel.annotate(name, (cost, error), (5, 4), textcoords="offset points", fontsize="small")
    panel.loglog(*reversed(stabilised[1:]), "s", color=style.COLOURS[1], label="stabilised, the default")
    panel.set(xlabel="user time in s", ylabel="error over first difference", xlim=(0.1, 10.0), ylim=(1e-6, 1e-4))
    panel.legend(frameon=False, loc="lower right")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--picture", metavar="FILE", help="draws error over cost")
    options = parser.parse_args()
    between, below = conductances()
    # A sphere at the plate has five neighbours, one inside six.
    longest = capacity() / max(6.0 * between, 5.0 * between + below)
    print(f"C/ΣH = {longest:.4g} s")
    told = []
    for share in [*EULER, None]:
        step = "" if share is None else f"step = {share * longest!r}\n"
        error, cost = min((run(options.cograin, step) for _ in range(2)), key=lambda found: found[1])
        name = "stabilised" if share is None else f"Euler, {share:g} C/ΣH"
        print(f"{name}: error {error:.2e}, {cost:.2f} s", flush=True)
        told.append((f"{share or 0:g} C/ΣH", error, cost))
    if options.picture:
        draw(told, options.picture)


if __name__ == "__main__":
    main()
