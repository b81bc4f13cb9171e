"""A bed that settles (settling_bed.toml): the default step beside LIGGGHTS with a fifth of the Rayleigh time, by turns.

    PYTHONPATH=python python3 benches/settling_bed.py [--seeds 1 2 3] [--cograin FILE] [--liggghts FILE] [-o DIR]

A line for each seed and program: user time, time steps, and the largest and the last kinetic energy of the grains.
"""

import argparse
import csv
import json
import math
import os
import subprocess
from pathlib import Path

from cograin.results import Run

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "benches/settling_bed.toml"
END, EDGE, DENSITY = 0.5, 0.2448, 2500.0  # of the scene [s], [m], [kg/m3]
YOUNGS_MODULUS, POISSONS_RATIO, RESTITUTION, FRICTION = 5.0e7, 0.3, 0.5, 0.5
PART = 0.2  # of the Rayleigh time of the smallest grain


def timed(command, folder):
    """User time [s] of a command, and what it printed."""
    before = os.times().children_user
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return os.times().children_user - before, done.stdout


def ours(options, seed, folder):
    """User time, time steps, and both energies with the default step."""
    command = [options.cograin, "run", SCENE, "-o", "out", "--overwrite", "--set", f"run.seed={seed}"]
    seconds, _ = timed(command, folder)
    rows = list(csv.DictReader((folder / "out/history.csv").open()))
    energies = [float(row["energy.kinetic"]) for row in rows]
    steps = json.loads((folder / "out/summary.json").read_text())["steps"]
    return seconds, steps, max(energies), energies[-1]


def deck(options, seed, folder):
    """Writes the same scene for LIGGGHTS, beginning with the same grains."""
    first = ["--set", "run.end=1e-9", "--set", "output.frame_interval=1e-9", "--set", f"run.seed={seed}"]
    timed([options.cograin, "run", SCENE, "-o", "start", "--overwrite", *first], folder)
    grains = Run(folder / "start").frames[0].particles
    rows = list(zip(grains.points.tolist(), grains["radius"].ravel().tolist(), strict=True))
    shear = YOUNGS_MODULUS / (2.0 * (1.0 + POISSONS_RATIO))
    least = min(radius for _, radius in rows)
    rayleigh = math.pi * least * math.sqrt(DENSITY / shear) / (0.1631 * POISSONS_RATIO + 0.8766)
    steps = math.ceil(END / (PART * rayleigh))
    with (folder / "grains.data").open("w") as file:
        file.write(f"grains\n\n{len(rows)} atoms\n1 atom types\n\n")
        for axis, high in zip("xyz", (EDGE, EDGE, 0.7), strict=True):
            file.write(f"-0.01 {high + 0.01} {axis}lo {axis}hi\n")
        file.write("\nAtoms\n\n")
        for number, ((x, y, z), radius) in enumerate(rows, 1):
            file.write(f"{number} 1 {2.0 * radius!r} {DENSITY} {x!r} {y!r} {z!r}\n")
    style = "model hertz tangential history"
    text = "atom_style granular\natom_modify map array\nboundary f f f\nnewton off\ncommunicate single vel yes\n"
    text += "units si\nread_data grains.data\nneighbor 0.001 bin\nneigh_modify delay 0\n"
    for number, (name, kind, value) in enumerate(
        (
            ("youngsModulus", "peratomtype", YOUNGS_MODULUS),
            ("poissonsRatio", "peratomtype", POISSONS_RATIO),
            ("coefficientRestitution", "peratomtypepair 1", RESTITUTION),
            ("coefficientFriction", "peratomtypepair 1", FRICTION),
        )
    ):
        text += f"fix m{number} all property/global {name} {kind} {value}\n"
    text += f"pair_style gran {style}\npair_coeff * *\n"
    for name, axis, place in (("a", "x", 0.0), ("b", "x", EDGE), ("c", "y", 0.0), ("d", "y", EDGE), ("e", "z", 0.0)):
        text += f"fix {name} all wall/gran {style} primitive type 1 {axis}plane {place}\n"
    text += f"fix g all gravity 9.81 vector 0 0 -1\nfix integrate all nve/sphere\ntimestep {END / steps!r}\n"
    text += f"compute spin all erotate/sphere\nthermo {steps // 100}\nthermo_style custom step ke c_spin\nrun {steps}\n"
    (folder / "deck").write_text(text)
    return steps


def theirs(options, steps, folder):
    """User time, time steps, and both energies of LIGGGHTS."""
    seconds, printed = timed([options.liggghts, "-in", "deck", "-log", "none"], folder)
    numbers = []
    for line in printed.splitlines():
        words = line.split()
        if len(words) == 3 and words[0].isdigit():
            numbers.append(float(words[1]) + float(words[2]))
    return seconds, steps, max(numbers), numbers[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--cograin", type=Path, default=ROOT / "target/release/cograin")
    parser.add_argument("--liggghts", default="liggghts")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/settling_bed"))
    options = parser.parse_args()
    options.cograin = options.cograin.resolve()
    print("| seed | program | user time | time steps | largest kinetic energy | last |")
    for seed in options.seeds:
        folder = options.output.resolve() / str(seed)
        folder.mkdir(parents=True, exist_ok=True)
        steps = deck(options, seed, folder)
        found = {"cograin": ours(options, seed, folder), "LIGGGHTS": theirs(options, steps, folder)}
        for name, (seconds, made, most, last) in found.items():
            print(f"| {seed} | {name} | {seconds:.1f} s | {made} | {most:.4g} J | {last:.3g} J |", flush=True)
        print(f"    LIGGGHTS over cograin: {found['LIGGGHTS'][0] / found['cograin'][0]:.2f}", flush=True)


if __name__ == "__main__":
    main()
