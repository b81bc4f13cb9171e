#!/usr/bin/env python3
"""What LIGGGHTS needs to make neighbour lists of the mixtures of `cargo bench --bench neighbours`.

Large spheres on a cubic lattice, small ones of 1 mm on a finer lattice in what is left. Lists are made in every step;
cost = (user CPU of the longer run - that of the shorter) / (difference of steps), as nothing touches almost all of it.
LIGGGHTS: apt-get install liggghts.
"""

import argparse
import itertools
import os
import subprocess
import tempfile
from pathlib import Path

import peers

SMALL = 1e-3  # radius [m]
MIXTURES = [(1.0, 100_000), (2.0, 100_000), (5.0, 100_000), (20.0, 100_000)]

DECK = """atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
read_data particles.data
neighbor 1e-4 {style}
neigh_modify delay 0 every 1 check no one 20000 page 2000000
fix m1 all property/global youngsModulus peratomtype 5e7
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
fix integrate all nve/sphere
timestep 1e-6
thermo {steps}
run {steps}
"""


def mixture(ratio, count):
    """Rows x, y, z, radius, and the width of the box."""
    large = ratio * SMALL
    fine, coarse = 2.05 * SMALL, 2.4 * large
    void = 1.0 - 4.19 * ((large + SMALL) / coarse) ** 3 if ratio > 1 else 1.0
    width = max(round((count * fine**3 / max(void, 0.2)) ** (1 / 3) / coarse), 1) * coarse
    rows = []
    if ratio > 1:
        along = [(k + 0.5) * coarse for k in range(int(width / coarse))]
        rows += [(*point, large) for point in itertools.product(along, repeat=3)]
    along = [(k + 0.5) * fine for k in range(int(width / fine))]
    offset = {x: x - (x // coarse + 0.5) * coarse for x in along}
    for point in itertools.product(along, repeat=3):
        if ratio == 1 or sum(offset[x] ** 2 for x in point) > (large + SMALL) ** 2:
            rows.append((*point, SMALL))
    return rows, width


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--liggghts", metavar="FILE", help="LIGGGHTS; by default `liggghts`")
    parser.add_argument("--style", default="bin")
    parser.add_argument("--steps", type=int, nargs=2, default=(3, 13))
    options = parser.parse_args()
    liggghts = peers.found("LIGGGHTS", options.liggghts or "liggghts", "liggghts", "it comes with apt-get install liggghts")
    for ratio, count in MIXTURES:
        rows, width = mixture(ratio, count)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            text = f"particles\n\n{len(rows)} atoms\n1 atom types\n\n"
            text += "".join(f"-0.01 {width + 0.01} {axis}lo {axis}hi\n" for axis in "xyz") + "\nAtoms\n\n"
            text += "".join(f"{n} 1 {2 * row[3]} 2500 {row[0]} {row[1]} {row[2]}\n" for n, row in enumerate(rows, 1))
            (folder / "particles.data").write_text(text)
            times = []
            for steps in options.steps:
                (folder / "deck").write_text(DECK.format(steps=steps, style=options.style))
                before = os.times().children_user
                subprocess.run([liggghts, "-in", "deck", "-log", "none"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
                times.append(os.times().children_user - before)
        short, long = options.steps
        cost = (times[1] - times[0]) / (long - short)
        print(f"1 to {ratio:g}: {cost * 1e3:.1f} ms, {cost / len(rows) * 1e9:.0f} ns a particle; {len(rows)} particles", flush=True)


if __name__ == "__main__":
    main()
