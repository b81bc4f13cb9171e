"""Heaps of grains with several rolling frictions, each with a probe; and one grain on a slope, for the rolling law."""

import argparse
import json
import math
from pathlib import Path

import numpy as np
from cograin import Program
from heap import DENSITY, GRAVITY, PROBE, history, penetration, slope, slope_by_mass

HERE = Path(__file__).resolve().parent
ROLLING = "pair.grain.grain.rolling_friction"


def arguments():
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/pile_and_probe"), help="folder of all results")
    parser.add_argument("--rolling", type=float, nargs="+", default=[0.0, 0.1, 0.2], help="rolling frictions")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2], help="of what comes")
    parser.add_argument("--no-picture", action="store_true", help="draw nothing")
    return parser.parse_args()


def rolls(program, folder, friction, steepness):
    """Speed after half a second of one grain that begins at rest on a slope of this tangent [m/s]."""
    angle = math.atan(steepness)
    gravity = f"gravity=[{GRAVITY * math.sin(angle)!r}, 0.0, {-GRAVITY * math.cos(angle)!r}]"
    settings = ["--set", gravity, "--set", f"{ROLLING}={friction}"]
    program("run", HERE / "grain.toml", "--overwrite", "-o", folder / "grain", *settings)
    return history(folder / "grain")["way.velocity.x"][-1]


def law(program, folder, friction):
    """Prints whether one grain stays a little below the slope of its rolling friction, and its speed a little above."""
    below, above = (rolls(program, folder, friction, share * friction) for share in (0.98, 1.02))
    angle = math.atan(1.02 * friction)
    expected = 5.0 / 7.0 * GRAVITY * (math.sin(angle) - friction * math.cos(angle)) * 0.5
    print(
        f"  rolling friction {friction:g}: {below:.1e} m/s where tan = {0.98 * friction:.4f}; {above:.5f} m/s", end=""
    )
    print(f" where tan = {1.02 * friction:.4f}, {expected:.5f} by 5/7 g (sin − friction cos)")


def stages(program, folder, friction, seed):
    """Both stages of the protocol; their folders."""
    both = ["--overwrite", "--set", f"{ROLLING}={friction}", "--set", f"run.seed={seed}"]
    pile, probe = folder / "1_pile", folder / "2_probe"
    program("run", HERE / "scene.toml", "--inputs", HERE / "input.csv", "-o", pile, *both)
    start = pile / "checkpoint.cograin"
    program("run", HERE / "probe.toml", "--from", start, "--inputs", HERE / "probe.csv", "-o", probe, *both)
    return pile, probe


def report(friction, seed, pile, probe):
    """Prints what is held against what; gives the angle [°]."""
    angle, spread, top = slope(pile)
    rows, later = history(pile), history(probe)
    came, stay, went = (rows[f"{name}.mass"][-1] for name in ("feed", "everything", "over_the_rim"))
    weight = later["heap.mass"][20] * GRAVITY
    borne = -later["plate.force.z"][20] / weight - 1.0
    book = json.loads((probe / "summary.json").read_text())["energy"]["relative_residual"]
    print(
        f"  rolling friction {friction:g}, seed {seed}: slope {angle:.1f}° ± {spread:.1f}°, by mass {slope_by_mass(rows):.1f}°",
        end="",
    )
    print(
        f"; came − stayed − went {came - stay - went:.1e} kg of {came:.4f}; plate over weight − 1 {borne:.1e}; book {book:.1e}"
    )
    depth, force = penetration(probe, HERE / "probe.csv", top)
    bulk = DENSITY * (1.0 - rows["core.porosity"][-1])
    inside = (depth > 0.4 * top) & (depth < 0.6 * top)
    factor = np.mean(force[inside] / (bulk * GRAVITY * math.pi * PROBE**2 * depth[inside]))
    print(
        f"    probe at {0.4 * top * 1e3:.1f} to {0.6 * top * 1e3:.1f} mm: {force[inside].mean() * 1e3:.0f} mN", end=""
    )
    print(f", {factor:.0f} times the weight of what it displaces; density of the bed {bulk:.0f} kg/m³")
    return angle


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    program, found = Program(options.program), []
    print("one grain on a slope, half a second after it began at rest:")
    for friction in options.rolling:
        if friction > 0.0:
            law(program, options.output, friction)
    print("heaps:")
    for friction in options.rolling:
        for seed in options.seeds:
            pile, probe = stages(program, options.output / f"{friction:g}_{seed}", friction, seed)
            found.append((friction, seed, pile, probe, report(friction, seed, pile, probe)))
    if not options.no_picture:
        from picture import draw

        draw(options.output / "pile_and_probe.png", found, HERE / "probe.csv")


if __name__ == "__main__":
    main()
