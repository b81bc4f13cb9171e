#!/usr/bin/env python3
"""What walls of triangles cost: 20,000 spheres of a dense bed (scene s1_20k of peers.py) between six planes, six meshes of two
triangles, 50,000 triangles at rest, and the same moving. User CPU time of a time step, one thread.

Set-up is removed by two numbers of steps. The walls run in turn, so that a load of the machine meets all of them; each figure is the
least of the repeats.
"""

import argparse
import os
import subprocess
import tempfile
from pathlib import Path

import peer_scenes

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (100, 600)  # steps of the short and the long run
WALLS = {
    "six planes": {},
    "six meshes of 2 triangles": {"facet": 1.0},
    "49,680 triangles": {"facet": 4.5e-3},
    "49,680 triangles, moving": {"facet": 4.5e-3, "moving": True},
}


def user_time(command, folder):
    """User CPU time of a command [s]."""
    before = os.times().children_user
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return os.times().children_user - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--repeats", metavar="N", type=int, default=3)
    options = parser.parse_args()
    least = {}
    with tempfile.TemporaryDirectory() as name:
        commands = {}
        for place, (walls, keys) in enumerate(WALLS.items()):
            folder = Path(name, str(place))
            folder.mkdir()
            scene = peer_scenes.Scene("s1_20k", COUNTS, **keys)
            for count in COUNTS:
                arguments = peer_scenes.cograin(scene, count, 1, folder)
                commands[walls, count] = ([options.cograin, *arguments, "--overwrite"], folder)
        for _ in range(options.repeats):
            for key, (command, folder) in commands.items():
                least[key] = min(least.get(key, float("inf")), user_time(command, folder))
    whole = {walls: (least[walls, COUNTS[1]] - least[walls, COUNTS[0]]) / (COUNTS[1] - COUNTS[0]) for walls in WALLS}
    for walls, seconds in whole.items():
        more = 100.0 * (seconds / whole["six planes"] - 1.0)
        print(f"{walls:28} {seconds * 1e6:8.0f} µs a step, {more:+6.1f} % over planes", flush=True)


if __name__ == "__main__":
    main()
