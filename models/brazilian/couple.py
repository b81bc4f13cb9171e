"""Splitting of a bonded disc across its diameter (Brazilian test) in the press of models/rock_core."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "rock_core"))

from laboratory import arguments, balances, course, replay, units  # noqa: E402

DIAMETER, THICKNESS = 0.05, 0.025  # of the disc [m], as in scene.toml


def main():
    options = arguments(__doc__, "brazilian")
    rock, press = units(options.program, HERE / "scene.toml", options.output)
    rows = course(options, rock, press)
    load, broken = -rows["lower.force.z"], rows["bonds.broken"]
    peak = int(np.argmax(load))
    strength = 2.0 * load[peak] / (math.pi * DIAMETER * THICKNESS)
    print(f"tensile strength 2P/(πDt): {strength / 1e6:.2f} MPa at a load of {load[peak] / 1e3:.2f} kN")
    print(f"cracks: {broken[peak]:.0f} at the peak, {broken[-1]:.0f} at the end")
    balances(rows)
    if not options.no_picture:
        from split import draw

        folder = replay(options.program, HERE / "scene.toml", options.output)
        path = options.output / "brazilian.png"
        draw(path, folder, rows, peak, strength)
        print(f"{options.output / 'couple.csv'} and {path} written")


if __name__ == "__main__":
    main()
