"""Fills the silo, lets it run out, prints grains per second, draws those that are left beside the published curves."""

import argparse
import csv
import re
from pathlib import Path

import numpy as np

from cograin import Program

HERE = Path(__file__).resolve().parent
STAGES = (
    1e7,
    1e8,
    None,
)  # Young's moduli with which the filling settles, one after the other [Pa]; the last are the scene's own
MODULI = ("material.m1.youngs_modulus", "material.steel.youngs_modulus")
LARGE = {}  # the orifice of the scene
SMALL = {  # that of 40 mm, under a steeper cone
    "boundary.wall.revolution.origin": [0.0, 0.0, -0.0593008],
    "boundary.wall.revolution.profile": [[0.02, 0.0], [0.1, 0.08], [0.1, 0.38]],
    "boundary.lid.disc.centre": [0.0, 0.0, -0.0597786],
    "flow_meter.lip.polygon": [
        [x, y, -0.0593008] for x, y in ((-0.05, -0.05), (-0.05, 0.05), (0.05, 0.05), (0.05, -0.05))
    ],
    "particles.grains.packing.cylinder.from": [0.0, 0.0, 0.0206992],
    "particles.grains.packing.cylinder.to": [0.0, 0.0, 0.2206992],
}


def settings(values):
    """Words of the command line for other values of keys."""
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def filled(program, scene, folder, given, stages=STAGES, tolerance=5e-2):
    """The state of the filling at rest on the lid, and its time [s]. It settles soft, then harder: steps are longer."""
    folder.mkdir(parents=True, exist_ok=True)
    before, time = [], 0.0
    for number, modulus in enumerate(stages):
        values = {"run.safety": 0.8, "run.settle_tolerance": tolerance} | given
        values |= {} if modulus is None else dict.fromkeys(MODULI, modulus)
        state = folder / f"filled_{number}.cograin"
        said = program("settle", scene, *before, "-o", state, "--overwrite", *settings(values))
        # What settles from the scene is a state at time 0; what settles from a state goes on from its time.
        time = float(re.search(r"t = (\S+) s", said)[1]) if before else 0.0
        before = ["--from", state]
    return state, time


def emptied(program, scene, folder, start, given, end):
    """Time since the lid falls [s], and grains that are out."""
    state, time = start
    values = {"run.end": time + end, "boundary.lid.motion.prescribed.z.trapezoid.start": time} | given
    program("run", scene, "--from", state, "-o", folder, "--overwrite", *settings(values))
    rows = np.genfromtxt(folder / "history.csv", delimiter=",", skip_header=1)
    return rows[:, 0] - time, rows[:, 1]


def rate(time, out, begin):
    """Grains per second from a time [s] on, by least squares."""
    later = time >= begin
    return float(np.polyfit(time[later], out[later], 1)[0])


def draw(path, time, out):
    """Grains that are left over time, beside LIGGGHTS and MUSEN."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = list(csv.reader((HERE / "published.csv").open()))
    values = np.array(rows[1:], dtype=float)
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    for place, colour, line in ((1, "0.3", "--"), (2, "0.6", "-")):
        axes.plot(values[:, 0], values[:, place] / 1e3, line, color=colour, label=rows[0][place].split("_")[0])
    axes.plot(time, (values[0, 1] - out) / 1e3, color="#b5482a", linewidth=2, label="cograin")
    axes.set(xlabel="time [s]", ylabel="grains above the lip [thousands]", xlim=(0.0, 4.4), ylim=(0.0, None))
    if time[-1] < 0.5 * values[-1, 0]:
        inset = axes.inset_axes([0.52, 0.5, 0.44, 0.42])
        for line in axes.lines:
            inset.plot(*line.get_data(), line.get_linestyle(), color=line.get_color(), linewidth=line.get_linewidth())
        shown = slice(None, int(np.searchsorted(values[:, 0], time[-1])) + 1)
        inset.set(xlim=(0.0, time[-1]), ylim=(values[shown, 1:].min() / 1e3 - 0.5, 100.5))
    axes.legend(frameon=False, loc="lower left")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/bulk_silo"), help="folder of all results")
    parser.add_argument("--orifice", choices=["large", "small"], default="large")
    parser.add_argument("--end", type=float, default=0.5, help="simulated time [s]; the silo is empty after 4.4")
    parser.add_argument("--begin", type=float, default=0.15, help="from when on the rate is fitted [s]")
    parser.add_argument("--safety", type=float, help="part of the stable step, beside the default step")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    given = (SMALL if options.orifice == "small" else LARGE) | {"run.threads": options.threads}
    program, scene = Program(options.program), HERE / "scene.toml"
    start = filled(program, scene, options.output, given)
    given |= {} if options.safety is None else {"run.safety": options.safety}
    time, out = emptied(program, scene, options.output / "run", start, given, options.end)
    print(f"{rate(time, out, options.begin):.0f} grains per second from {options.begin} s to {options.end} s")
    if options.orifice == "large":
        draw(options.output / "silo.png", time, out)


if __name__ == "__main__":
    main()
