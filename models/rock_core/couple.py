"""Unconfined compression of a bonded core in a press: makes both units, couples them, evaluates the test."""

import math
from pathlib import Path

import numpy as np
from laboratory import arguments, balances, course, replay, units
from picture import draw

SCENE = Path(__file__).resolve().parent / "scene.toml"
LENGTH, RADIUS = 0.1, 0.025  # of the core [m], as in scene.toml
AREA = math.pi * RADIUS**2  # [m²]


def evaluate(rows):
    """Strain, stress [Pa], index of the peak and Young's modulus at half of it [Pa]."""
    strain, stress = -rows["upper.displacement.z"] / LENGTH, -rows["lower.force.z"] / AREA
    peak = int(np.argmax(stress))
    rising = slice(0, peak + 1)
    near = (stress[rising] > 0.4 * stress[peak]) & (stress[rising] < 0.6 * stress[peak])
    modulus = float(np.polyfit(strain[rising][near], stress[rising][near], 1)[0]) if near.sum() > 1 else math.nan
    return strain, stress, peak, modulus


def main():
    options = arguments(__doc__, "rock_core")
    rock, press = units(options.program, SCENE, options.output)
    rows = course(options, rock, press)
    strain, stress, peak, modulus = evaluate(rows)
    broken = rows["bonds.broken"]
    print(f"unconfined compressive strength {stress[peak] / 1e6:.2f} MPa at a strain of {strain[peak]:.3e}")
    print(f"Young's modulus, tangent from 40 to 60 % of the peak: {modulus / 1e9:.2f} GPa")
    print(f"cracks: {broken[peak]:.0f} at the peak, {broken[-1]:.0f} at the end")
    balances(rows)
    if not options.no_picture:
        folder = replay(options.program, SCENE, options.output)
        path = options.output / "rock_core.png"
        draw(path, folder, rows, strain, stress, peak, modulus)
        print(f"{options.output / 'couple.csv'} and {path} written")


if __name__ == "__main__":
    main()
