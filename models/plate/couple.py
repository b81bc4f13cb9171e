"""Grains on an elastic plate: settles and exports them, couples the nodes of their skin with finite elements, compares.

The skin of the unit and the elements of the plate have meshes that do not match. Jacks hold the plate straight at first
and then let go: it sags under the grains, and they follow.
"""

import argparse
import csv
import math
from pathlib import Path

import numpy as np
from balance import report
from cograin import Coupling, Interface, Program, QuasiNewton, Tolerance, Unit
from plate import Design, Plate

HERE = Path(__file__).resolve().parent
COLUMNS = ["time", "deflection", "mean_force", "jack_force", "work", "plate_work", "evaluations"]


def arguments():
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/plate"), help="folder of all results")
    parser.add_argument("--cells", type=int, nargs="+", default=[24, 40], help="elements along an edge of the plate")
    parser.add_argument("--skin", default="fine.obj", help="mesh of the skin: fine.obj or coarse.obj")
    parser.add_argument("--end", type=float, default=0.2, help="simulated time [s]")
    parser.add_argument("--interval", type=float, default=1e-3, help="communication step [s]")
    parser.add_argument("--lowering", type=float, default=0.05, help="time in which the jacks let go [s]")
    parser.add_argument("--no-replay", action="store_true", help="leave out the comparison and the picture")
    return parser.parse_args()


def run(options, unit, cells):
    """The coupled run with a plate of so many elements: plate, rows of COLUMNS, names and rows of the course of the skin."""
    skin = unit.nodes("skin")
    lifts = [name for name in skin.names("displacement") if name.endswith(".z")]
    through = Plate(Design(), cells).through(skin.places)
    interface = Interface(unit, lifts, through=through)
    held = -interface.force("end")  # what the jacks carry at first [N]

    def jacks(time):
        return 0.5 * held * (1.0 + math.cos(math.pi * min(time / options.lowering, 1.0)))

    plate = Plate(Design(), cells, jacks)
    exchange = QuasiNewton(tolerance=Tolerance(displacement=1e-9), reuse=8)
    coupling = Coupling(interface, plate, exchange, options.interval)
    rows, courses = [], []
    for row in coupling.steps(round(options.end / options.interval) * options.interval):
        force, middle = skin.mean_force[:, 2].sum(), plate.deflections[plate.middle]
        jack = jacks(row.time - 0.5 * row.length).sum()
        rows.append([row.time, middle, force, jack, unit["skin.work"], plate.work, row.evaluations])
        courses.append([row.time, *unit.get(lifts)])
    print(coupling.record.summary)
    return plate, np.array(rows, dtype=float), (["time", *lifts], courses)


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    program, scene = Program(options.program), HERE / "scene.toml"
    settled = options.output / "settled.checkpoint"
    skin = ["--set", f'boundary.skin.mesh.file="{options.skin}"']
    print(program("settle", scene, *skin, "-o", settled, "--overwrite"), end="", flush=True)
    path = options.output / "plate.fmu"
    program("export", scene, *skin, "--from", settled, "-o", path, "--overwrite")
    found = []
    with Unit(path) as unit:
        start = unit.save()
        for cells in options.cells:
            unit.restore(start)
            print(f"\n{cells} × {cells} elements under a skin of {len(unit.nodes('skin'))} nodes", flush=True)
            plate, rows, course = run(options, unit, cells)
            with open(options.output / f"couple_{cells}.csv", "w", newline="") as text:
                csv.writer(text).writerows([COLUMNS, *rows.tolist()])
            inputs = options.output / f"course_{cells}.csv"
            with open(inputs, "w", newline="") as text:
                csv.writer(text).writerows([course[0], *course[1]])
            if not options.no_replay:
                found.append((plate, rows, *report(program, scene, settled, inputs, plate, rows, options)))
    if found:
        from picture import draw

        draw(options.output / "plate.png", found)


if __name__ == "__main__":
    main()
