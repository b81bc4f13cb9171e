"""A hopper whose gate a bang-bang controller opens and shuts: both are units. Holds the mass in the bin near a set point."""

import argparse
import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
from balance import report
from cograin import Program, Unit

HERE = Path(__file__).resolve().parent
READ = ["bin_filling.mass", "hopper_filling.mass", "everything.mass", "below_the_gate.mass", "feed.mass"]
READ += ["drain.mass", "spilt.mass"]
COLUMNS = ["time", "gate", "wanted", *READ]


def arguments():
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/hopper"), help="folder of all results")
    parser.add_argument("--end", type=float, default=3.0, help="simulated time [s]")
    parser.add_argument("--interval", type=float, default=1e-3, help="communication step [s]")
    parser.add_argument("--low", type=float, default=0.065, help="mass in the bin below which the gate opens [kg]")
    parser.add_argument("--high", type=float, default=0.070, help="mass above which it shuts [kg]")
    parser.add_argument("--speed", type=float, default=0.5, help="of the gate [m/s]")
    parser.add_argument("--begin", type=float, default=0.2, help="time before which the gate stays shut [s]")
    parser.add_argument("--no-picture", action="store_true", help="leave out the replay and the picture")
    return parser.parse_args()


def course(hopper, controller, options):
    """Controller and hopper in turn; rows of COLUMNS, one a communication step."""
    rows = [[0.0, 0.0, 0.0, *hopper.get(READ)]]
    for count in range(1, round(options.end / options.interval) + 1):
        controller["mass"] = hopper["bin_filling.mass"]
        controller.step(options.interval, until=count * options.interval)
        hopper["gate.displacement.x"] = controller["position"]
        hopper.step(options.interval, until=count * options.interval)
        rows.append([hopper.time, *controller.get(["position", "wanted"]), *hopper.get(READ)])
    return np.array(rows)


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    program, scene = Program(options.program), HERE / "scene.toml"
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", HERE / "controller.py", "-d", options.output]
    subprocess.run(build, check=True, capture_output=True)
    given = {name: getattr(options, name) for name in ("low", "high", "speed", "begin")}
    bulk = program.export(scene, options.output / "hopper.fmu")
    with Unit(bulk) as hopper, Unit(options.output / "Controller.fmu", parameters=given) as controller:
        rows = course(hopper, controller, options)
        stroke = controller["stroke"]
    with (options.output / "couple.csv").open("w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *rows.tolist()])
    bounds = report(dict(zip(COLUMNS, rows.T, strict=True)), options, stroke)
    if not options.no_picture:
        from picture import draw, replay

        folder = replay(program, scene, options.output, rows, options)
        draw(options.output / "hopper.png", folder, rows, COLUMNS, options, bounds)


if __name__ == "__main__":
    main()
