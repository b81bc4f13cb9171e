#!/usr/bin/env python3
"""The dense packing at rest (scene s1_20k) in cograin and in LIGGGHTS, in one go: user CPU time of a contact and step.

  against_liggghts.py [--cograin target/release/cograin] [--liggghts liggghts] [--repeats 2] [--steps 100 600]

Both read the same 20,000 spheres, six plane walls, Hertz-Mindlin with history; one thread. Set-up is removed by running
two numbers of steps: cost of a step = (CPU of the longer run - CPU of the shorter) / (difference of steps), the least of
the repeats, the programs in turn. LIGGGHTS comes from Debian: apt-get install liggghts.
"""

import argparse
import gzip
import json
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STEP = 1.54807158678598e-5  # 10 % of the Rayleigh time [s]
SKIN = 0.001  # of LIGGGHTS, the best found for it [m]
BOX = ((0.0, 0.2448), (0.0, 0.2448), (0.0, 0.4))
AXES = "xyz"

SCENE = """gravity = [0.0, 0.0, -9.81]
[run]
end = {end!r}
step = {step!r}
threads = 1
[material.grain]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "grain"
file = "dense_20k.csv.gz"
"""

DECK = """atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
read_data particles.data
neighbor {skin} bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e7
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
{walls}fix g all gravity 9.81 vector 0 0 -1
fix integ all nve/sphere
timestep {step}
thermo {steps}
thermo_style custom step atoms ke
run {steps}
"""


def user_time(command, folder):
    """User CPU time of a command [s]; its output goes to a file beside it."""
    before = os.times().children_user
    with open(folder / "printed.txt", "w") as printed:
        subprocess.run(command, cwd=folder, check=True, stdout=printed, stderr=subprocess.STDOUT)
    return os.times().children_user - before


def prepare_cograin(folder, packing):
    """Scene with six walls, and the packing beside it."""
    (folder / "dense_20k.csv.gz").write_bytes(packing)
    text = SCENE
    for axis, (low, high) in enumerate(BOX):
        for name, position, sign in (("low", low, 1.0), ("high", high, -1.0)):
            point, normal = [0.0] * 3, [0.0] * 3
            point[axis], normal[axis] = position, sign
            text += f"[boundary.{AXES[axis]}_{name}]\nplane = {{ point = {point}, normal = {normal} }}\nmaterial = \"grain\"\n"
    return text


def prepare_liggghts(folder, packing):
    """Data file of the packing; returns the lines of the walls."""
    rows = [line.split(",") for line in gzip.decompress(packing).decode().splitlines()[1:]]
    with open(folder / "particles.data", "w") as data:
        data.write(f"particles\n\n{len(rows)} atoms\n1 atom types\n\n")
        for (low, high), axis in zip(BOX, AXES):
            data.write(f"{low - 0.01} {high + 0.01} {axis}lo {axis}hi\n")
        data.write("\nAtoms\n\n")
        for number, x, y, z, radius, density in rows:
            data.write(f"{number} 1 {2 * float(radius):.12f} {density} {x} {y} {z}\n")
    walls = ""
    for (low, high), axis in zip(BOX, AXES):
        for name, position in (("lo", low), ("hi", high)):
            walls += f"fix w{axis}{name} all wall/gran model hertz tangential history primitive type 1 {axis}plane {position}\n"
    return walls


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cograin", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--liggghts", default="liggghts")
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--steps", type=int, nargs=2, default=(100, 600))
    options = parser.parse_args()
    packing = (ROOT / "models/loaded_beam/dense_20k.csv.gz").read_bytes()
    short, long = options.steps
    best = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = prepare_cograin(folder, packing)
        walls = prepare_liggghts(folder, packing)
        for steps in (short, long):
            (folder / f"{steps}.toml").write_text(text.replace("{end!r}", repr(steps * STEP)).replace("{step!r}", repr(STEP)))
            (folder / f"{steps}.lig").write_text(DECK.format(skin=SKIN, walls=walls, step=STEP, steps=steps))
        for _ in range(options.repeats):
            for steps in (short, long):
                out = folder / "out"
                ours = [os.path.abspath(options.cograin), "run", f"{steps}.toml", "-o", str(out)]
                theirs = [options.liggghts, "-in", f"{steps}.lig", "-log", "none"]
                for program, command in (("cograin", ours), ("liggghts", theirs)):
                    subprocess.run(["rm", "-rf", str(out)], check=True)
                    key = (program, steps)
                    best[key] = min(best.get(key, float("inf")), user_time(command, folder))
                    if program == "cograin":
                        contacts = json.loads((out / "summary.json").read_text())["counts"]["contacts"]
    cost = {program: (best[program, long] - best[program, short]) / (long - short) / contacts * 1e9 for program in ("cograin", "liggghts")}
    for program, nanoseconds in cost.items():
        print(f"{program:9s} {nanoseconds:6.1f} ns of user CPU time per contact and step, {contacts} contacts")
    print(f"ratio {cost['liggghts'] / cost['cograin']:.2f}")


if __name__ == "__main__":
    main()
