"""Runs the wheel at several slips: sinkage, drawbar pull, torque and power, and a picture."""

import argparse
import csv
from pathlib import Path

import numpy as np
from cograin import Program

HERE = Path(__file__).resolve().parent
SPIN = 4.0  # of the wheel [rad/s], as in scene.toml
RADIUS = 0.021  # to the tops of the lugs [m]
CENTRE = 0.0515  # height of the axle at the start [m]
START, STEADY = 0.2, 0.5  # when it begins to turn, and from when on means are taken [s]
WEIGHT = 0.08 * 9.81  # [N]
RAMP = 0.05  # in which it comes to its speed [s]


def run(program, slip, folder):
    """The history of one slip; gives its columns by their names."""
    speed = SPIN * RADIUS * (1.0 - slip)
    way = "boundary.wheel.motion.prescribed"
    settings = [f"{way}.x.trapezoid.speed={speed!r}", f"{way}.x.trapezoid.acceleration={speed / RAMP!r}"]
    program(
        "run", HERE / "scene.toml", "--overwrite", "-o", folder, *[word for one in settings for word in ("--set", one)]
    )
    rows = list(csv.reader((folder / "history.csv").open()))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))


def level(folder, history):
    """Height of the bed before the wheel, where it is about to go, as the highest grains on average [m]."""
    from picture import frame

    points, radii, _ = frame(folder, START)
    ahead = history["wheel.displacement.x"][0] + 0.035 + 1.5 * RADIUS
    cells = [(points[:, 0] >= x) & (points[:, 0] < x + 5e-3) for x in np.arange(ahead, 0.125, 5e-3)]
    return float(np.mean([(points[cell, 2] + radii[cell]).max() for cell in cells]))


def means(history):
    """Means while the wheel goes steadily, by their names."""
    steady = history["time"] > STEADY
    return {name: column[steady].mean() for name, column in history.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/wheel"))
    parser.add_argument("--slips", type=float, nargs="+", default=[0.0, 0.2, 0.4, 0.6, 0.8])
    options = parser.parse_args()
    program, found = Program(options.program), []
    print("  slip  sinkage [mm]  pull [N]  pull/weight  torque [mN m]  power given by axle [mW]  by the pull [mW]")
    for slip in options.slips:
        folder = options.output / f"slip_{slip:.2f}"
        history = run(program, slip, folder)
        mean, bed = means(history), level(folder, history)
        sinkage = bed - (CENTRE + mean["wheel.displacement.z"] - RADIUS)
        pull, torque = mean["wheel.mean_force.x"], -mean["wheel.mean_moment.y"]
        speed = SPIN * RADIUS * (1.0 - slip)
        print(
            f"{slip:6.2f}  {1e3 * sinkage:12.2f}  {pull:8.3f}  {pull / WEIGHT:11.3f}  {1e3 * torque:13.2f}"
            f"  {1e3 * torque * SPIN:24.2f}  {1e3 * pull * speed:16.2f}"
        )
        found.append((slip, sinkage, pull, torque, history, folder))
    from picture import draw

    draw(options.output / "wheel.png", found, WEIGHT)


if __name__ == "__main__":
    main()
