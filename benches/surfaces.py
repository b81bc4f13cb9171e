#!/usr/bin/env python3
"""What walls of triangles cost: 20,000 spheres of a dense bed (scene s1_20k of peers.py) between six planes, six meshes of two
triangles, 50,000 triangles at rest, and the same moving. One thread.

    python3 benches/surfaces.py [--rounds N] [--cograin FILE]
    python3 benches/surfaces.py --instructions [--cograin FILE]

The time of a step is the program's own (`stepping_time` in summary.json). The walls run in turn, round by round, so that a load of the
machine meets all of them; told are the least of the rounds, and the median of the ratios to the planes of the same round. With
--instructions valgrind counts, which no load disturbs; set-up is removed by two numbers of steps.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

import peer_scenes
from regions import instructions

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (50, 150)  # steps of the short and the long run; times are those of the long one
WALLS = {
    "six planes": {},
    "six meshes of 2 triangles": {"facet": 1.0},
    "49,680 triangles": {"facet": 4.5e-3},
    "49,680 triangles, moving": {"facet": 4.5e-3, "moving": True},
}


def commands(program, folder):
    """The command of each wall and number of steps, with the folder in which it runs."""
    found = {}
    for number, (walls, keys) in enumerate(WALLS.items()):
        here = folder / str(number)
        here.mkdir()
        scene = peer_scenes.Scene("s1_20k", COUNTS, **keys)
        for count in COUNTS:
            found[walls, count] = ([program, *peer_scenes.cograin(scene, count, 1, here), "--overwrite"], here)
    return found


def count(found):
    """Tells the instructions of a step."""
    for walls in WALLS:
        short, long = (instructions(*found[walls, steps]) for steps in COUNTS)
        each = (long - short) / (COUNTS[1] - COUNTS[0])
        planes = each if walls == "six planes" else planes
        print(f"{walls:28} {each / 1e6:8.2f} million instructions a step, {100 * (each / planes - 1):+6.1f} % over planes", flush=True)


def clock(found, rounds):
    """Tells the time of a step."""
    times = {walls: [] for walls in WALLS}
    for _ in range(rounds):
        for walls, measured in times.items():
            command, folder = found[walls, COUNTS[1]]
            subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
            summary = json.loads((folder / "out" / "summary.json").read_text())
            measured.append(summary["stepping_time"] / COUNTS[1])
    planes = times["six planes"]
    for walls, measured in times.items():
        over = 100 * (min(measured) / min(planes) - 1)
        median = 100 * (statistics.median(one / other for one, other in zip(measured, planes)) - 1)
        print(f"{walls:28} {min(measured) * 1e6:6.0f} µs a step, {over:+6.1f} % over planes, median of the ratios {median:+6.1f} %", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--rounds", metavar="N", type=int, default=24)
    parser.add_argument("--instructions", action="store_true", help="count instructions in place of time")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        found = commands(str(Path(options.cograin).resolve()), Path(name))
        if options.instructions:
            count(found)
        else:
            clock(found, options.rounds)


if __name__ == "__main__":
    main()
