#!/usr/bin/env python3
"""What a region or a grid costs: instructions of a time step of 20,000 spheres of a dense bed (scene s1_20k of peers.py) without one, with one that
nobody reads, and of each time that its outputs are read, for a box, a cylinder, a ball of so many triangles, and grids about all grains.

Counted by valgrind, so the load of the machine does not matter. Set-up is removed by two numbers of steps.
"""

import argparse
import json
import math
import re
import subprocess
import tempfile
from pathlib import Path

import peer_scenes

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (50, 350)  # steps of the short and the long run
EVERY = 10  # steps between rows of the history, where it is written
GRID = "[grid.core]\nbox = [[{{10}}, {{12}}, {{14}}], [{{11}}, {{13}}, {{15}}]]\ncounts = [{0}, {0}, {0}]\noutputs = [{1}]"
REGIONS = {
    "box": "[region.core]\nbox = [[{0}, {2}, {4}], [{1}, {3}, {5}]]",
    "cylinder": "[region.core]\ncylinder = {{ from = [{6}, {7}, {4}], to = [{6}, {7}, {5}], radius = {8} }}",
    "mesh": '[region.core]\nmesh = {{ file = "ball.obj", scale = {8}, offset = [{6}, {7}, {9}] }}',
    "grid of 10³ cells, porosity": GRID.format(10, '"porosity"'),
    "grid of 20³ cells, porosity": GRID.format(20, '"porosity"'),
    "grid of 20³ cells, all": GRID.format(20, '"porosity", "density", "velocity", "stress", "granular_temperature", "count"'),
}


def ball(path, around=100, high=51):
    """A ball of radius 1 as triangles."""
    lines = ["v 0 0 1", "v 0 0 -1"]
    for ring in range(1, high):
        polar = math.pi * ring / high
        for place in range(around):
            angle = 2.0 * math.pi * place / around
            lines.append(f"v {math.sin(polar) * math.cos(angle)!r} {math.sin(polar) * math.sin(angle)!r} {math.cos(polar)!r}")

    def at(ring, place):
        return 3 + (ring - 1) * around + place % around

    for place in range(around):
        lines += [f"f 1 {at(1, place)} {at(1, place + 1)}", f"f 2 {at(high - 1, place + 1)} {at(high - 1, place)}"]
        for ring in range(1, high - 1):
            a, b, c, d = at(ring, place), at(ring + 1, place), at(ring + 1, place + 1), at(ring, place + 1)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    path.write_text("\n".join([*lines, ""]))


def inner(walls):
    """Numbers of a region that has half of each edge of the bed, in its middle, then those of the bed."""
    bounds = [edge for low, high in walls for edge in (0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high)]
    middle = [0.5 * (low + high) for low, high in walls]
    return [*bounds, middle[0], middle[1], 0.25 * min(high - low for low, high in walls), middle[2], *(place for wall in walls for place in wall)]


def instructions(command, folder):
    """Instructions of a command."""
    counter = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    done = subprocess.run([*counter, *command], cwd=folder, check=True, capture_output=True, text=True)
    return int(re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)[1].replace(",", ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--regions", metavar="NAME", nargs="*", default=list(REGIONS))
    options = parser.parse_args()
    scene = peer_scenes.Scene("s1_20k", COUNTS)
    numbers = inner(peer_scenes.box(scene))

    def each_step(region, rows):
        """Instructions of a step, with a row of the history every so many steps, or none; a cell of a grid makes all of them."""
        counts = []
        for count in COUNTS:
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                arguments = peer_scenes.cograin(scene, count, 1, folder)
                path = folder / f"{count}.toml"
                text, step = path.read_text(), peer_scenes.time_step(scene)
                if rows:
                    columns = ["time_step.current", *(["core.cell[1].*" if "grid" in region else "core.*"] if region else [])]
                    text = re.sub("history_interval = .*", f"history_interval = {rows * step!r}\ncolumns = {json.dumps(columns)}", text)
                if region:
                    text += f"{REGIONS[region].format(*numbers)}\n"
                    ball(folder / "ball.obj")
                path.write_text(text)
                counts.append(instructions([options.cograin, *arguments], folder))
        return (counts[1] - counts[0]) / (COUNTS[1] - COUNTS[0])

    without, with_rows = each_step(None, None), each_step(None, EVERY)
    print(f"{without / 1e6:.3f} million instructions a step without a region", flush=True)
    for region in options.regions:
        idle, read = each_step(region, None), each_step(region, EVERY)
        reading = (read - idle - with_rows + without) * EVERY
        print(f"{region}: {(idle - without) / 1e6:+.3f} a step, {reading / 1e6:.3f} each time it is read", flush=True)


if __name__ == "__main__":
    main()
