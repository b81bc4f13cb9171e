"""Fills the drum, turns it, and draws how many grains of both kinds are in a quarter of it, beside others."""

import argparse
import csv
import re
from pathlib import Path

import numpy as np

from cograin import Program
from cograin.results import Run

HERE = Path(__file__).resolve().parent
STAGES = (1e-2, 1e-1, 1.0)  # parts of Young's moduli with which the filling settles, one after the other
MODULI = {"m1": 1.0e9, "m2": 0.5e9, "steel": 1.0e9}  # [Pa]; that of steel is its own in the last stage


def settings(values):
    """Words of the command line for other values of keys."""
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def filled(program, scene, folder, given, stages=STAGES, tolerance=5e-2):
    """The state of the filling at rest, and its time [s]. It settles soft, then harder: steps are longer."""
    folder.mkdir(parents=True, exist_ok=True)
    before, time = [], 0.0
    for number, part in enumerate(stages):
        values = {"run.safety": 0.8, "run.settle_tolerance": tolerance} | given
        if part < 1.0:
            values |= {f"material.{name}.youngs_modulus": part * modulus for name, modulus in MODULI.items()}
        state = folder / f"filled_{number}.cograin"
        said = program("settle", scene, *before, "-o", state, "--overwrite", *settings(values))
        # What settles from the scene is a state at time 0; what settles from a state goes on from its time.
        time = float(re.search(r"t = (\S+) s", said)[1]) if before else 0.0
        before = ["--from", state]
    return state, time


def turned(program, scene, folder, start, given, end):
    """Time since the drum turns [s], and grains of both kinds with x < 0 and z < 0: the small ones, the large ones."""
    state, time = start
    program("run", scene, "--from", state, "-o", folder, "--overwrite", *settings({"run.end": time + end} | given))
    return counted(folder, time)


def counted(folder, begin):
    """The same of a run that began at this time [s], as far as it got."""
    found = []
    for frame in Run(folder).frames:
        grains = frame.particles
        inside = (grains.points[:, 0] < 0.0) & (grains.points[:, 2] < 0.0)
        kind = grains["material"].ravel()
        found.append((frame.time - begin, *(int((inside & (kind == number)).sum()) for number in (0, 1))))
    return np.array(found).T


def published():
    """Time [s], and counts by their names."""
    rows = list(csv.reader((HERE / "published.csv").open()))
    values = np.array(rows[1:], dtype=float).T
    return values[0], dict(zip(rows[0][1:], values[1:], strict=True))


def draw(path, time, small, large):
    """A panel for each kind."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    when, curves = published()
    figure, panels = plt.subplots(1, 2, figsize=(11.0, 4.0), layout="constrained")
    for axes, kind, own, title in zip(
        panels, ("m1", "m2"), (small, large), ("30,000 grains of 2 mm", "8,000 grains of 4 mm"), strict=True
    ):
        for name, colour, line in (("LIGGGHTS", "0.3", "--"), ("MUSEN", "0.6", "-")):
            axes.plot(when, curves[f"{name}_{kind}"] / 1e3, line, color=colour, label=name)
        axes.plot(time, own / 1e3, "o-", color="#b5482a", markersize=3, label="cograin")
        axes.set(title=title, xlabel="time [s]", ylabel="in the quarter x < 0, z < 0 [thousands]", ylim=(0.0, None))
        axes.legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/bulk_drum"), help="folder of all results")
    parser.add_argument("--end", type=float, default=5.0, help="simulated time [s]")
    parser.add_argument("--safety", type=float, help="part of the stable step, beside the default step")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    given = {"run.threads": options.threads}
    program, scene = Program(options.program), HERE / "scene.toml"
    start = filled(program, scene, options.output, given)
    given |= {} if options.safety is None else {"run.safety": options.safety}
    time, small, large = turned(program, scene, options.output / "run", start, given, options.end)
    when, curves = published()
    for row in zip(time, small, large, strict=True):
        others = (f"{name} {np.interp(row[0], when, curve):.0f}" for name, curve in curves.items())
        print("{:.2f} s: {:.0f} small, {:.0f} large;".format(*row), *others)
    draw(options.output / "drum.png", time, small, large)


if __name__ == "__main__":
    main()
