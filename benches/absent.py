#!/usr/bin/env python3
"""What particles that come, go and are looked at cost a scene: instructions of a time step of 1,000 spheres that press each other in a box with nothing of it, and what
each table adds where nothing comes, goes or passes; a periodic cell stands in place of the box. With --other also those of another build of the program, such as one from
before there was any of it.

Counted by valgrind, so the load of the machine does not matter. Set-up is removed by two numbers of steps.
"""

import argparse
import tempfile
from pathlib import Path

from regions import instructions

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (100, 500)  # steps of the short and the long run
STEP = 2e-5  # [s]
SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
end = {end!r}
step = {step!r}
threads = 1
[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3
conductivity = 1.0
specific_heat = 800.0
[pair.glass.glass]
restitution = 0.5
friction = 0.5
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.all]
material = "glass"
lattice = {{ kind = "simple_cubic", radius = 0.005, spacing = 0.00999, counts = [10, 10, 10], origin = [0.0, 0.0, 0.0] }}
{walls}[output]
checkpoint_interval = {end!r}
"""
WALLS = "".join(
    f'[boundary.{axis}_{side}]\nplane = {{ point = {[place * (k == at) for k in range(3)]}, normal = {[way * (k == at) for k in range(3)]} }}\n'
    'material = "glass"\n'
    for at, axis in enumerate("xyz")
    for side, place, way in (("low", -0.004995, 1.0), ("high", 9 * 0.00999 + 0.004995, -1.0))
)
BOX = "box = [[0.3, 0.3, 0.3], [0.4, 0.4, 0.4]]"
ADDED = {
    "region": f"[region.aside]\n{BOX}\n",
    "grid": f"[grid.aside]\n{BOX}\ncounts = [10, 10, 10]\n",
    "insertion": f'[region.aside]\n{BOX}\n[insertion.feed]\nregion = "aside"\nmaterial = "glass"\nsizes = {{ radius = 0.005 }}\ncount_rate = 0.0\n',
    "outlet": f'[region.aside]\n{BOX}\n[outlet.drain]\nregion = "aside"\n',
    "flow meter": "[flow_meter.gate]\npolygon = [[0.3, 0.3, 0.3], [0.4, 0.3, 0.3], [0.4, 0.4, 0.3]]\n",
    "domain": '[domain]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\noutside = "remove"\n',
    "mesh with fixed nodes": '[boundary.skin]\nmesh = { file = "skin.obj", sides = 2 }\nmaterial = "glass"\n',
    "mesh with driven nodes": '[boundary.skin]\nmesh = { file = "skin.obj", sides = 2 }\nmaterial = "glass"\nnodes = "driven"\n',
}
CONDUCTION = "[contact.all.heat.constriction]\n"
WARM = "temperature = 300.0\n"  # of the particles, whose table is open there
CELL = "[cell]\nedges = [[0.0999, 0.0, 0.0], [0.0, 0.0999, 0.0], [0.0, 0.0, 0.0999]]\n"
SKIN = "v 0.3 0.3 0.3\nv 0.4 0.3 0.3\nv 0.4 0.4 0.3\nv 0.3 0.4 0.3\nf 1 2 3\nf 1 3 4\n"


def each_step(program, added, walls=WALLS):
    """Instructions of a time step of the scene with what is added."""
    counted = []
    for count in COUNTS:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "skin.obj").write_text(SKIN)
            (folder / "scene.toml").write_text(SCENE.format(end=count * STEP, step=STEP, walls=walls) + added)
            counted.append(instructions([program, "run", "scene.toml", "-o", "out"], folder))
    return (counted[1] - counted[0]) / (COUNTS[1] - COUNTS[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--other", metavar="FILE", help="another build of the program")
    options = parser.parse_args()
    without = each_step(options.cograin, "")
    print(f"{without:.0f} instructions a step with nothing", flush=True)
    if options.other:
        other = each_step(options.other, "")
        print(f"{other:.0f} by the other build: {100.0 * (without / other - 1.0):+.2f} %", flush=True)
    scenes = {name: (added, WALLS) for name, added in ADDED.items()}
    scenes |= {"conduction": (CONDUCTION, WARM + WALLS), "a cell for the box": (CELL, "")}
    for name, scene in scenes.items():
        more = each_step(options.cograin, *scene) - without
        print(f"{name}: {more:+.0f}, {100.0 * more / without:+.2f} %", flush=True)


if __name__ == "__main__":
    main()
