"""Suspensions settle in a closed box: their speeds beside Richardson and Zaki, and what becomes of one of them."""

import argparse
import re
import shutil
from pathlib import Path

import numpy as np
from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import Column, FluidInterface
from cograin.results import Table
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
DENSITY, VISCOSITY, SOLID, DIAMETER, GRAVITY = 1000.0, 0.05, 2500.0, 1e-3, 9.81
COUNTS = [200, 490, 980, 1300]
STEADY = 0.03  # when the speeds are taken, long after the beads were let go [s]


def slip(porosity):
    """Velocity between fluid and beads [m/s] at which the drag of Di Felice is ε V (ρₚ − ρ) g."""

    def left(velocity):
        reynolds = DENSITY * DIAMETER * porosity * velocity / VISCOSITY
        power = 3.7 - 0.65 * np.exp(-0.5 * (1.5 - np.log10(reynolds)) ** 2)
        factor = (0.63 * np.sqrt(reynolds) + 4.8) ** 2 / 24.0 * porosity**-power
        drag = 3.0 * np.pi * VISCOSITY * DIAMETER * porosity * velocity * factor
        return drag - porosity * np.pi / 6.0 * DIAMETER**3 * (SOLID - DENSITY) * GRAVITY

    return brentq(left, 1e-9, 10.0)


def richardson_zaki(porosity):
    """Speed of a suspension over that of a single bead."""
    reynolds = DENSITY * DIAMETER * slip(1.0) / VISCOSITY
    # 4.65 where viscosity rules, 2.4 where inertia does.
    power = 4.65 if reynolds < 0.2 else 4.35 * reynolds**-0.03 if reynolds < 1.0 else 4.45 * reynolds**-0.1
    return porosity**power


def export(program, folder, count):
    """A unit with so many beads."""
    text = re.sub(r"count = \d+", f"count = {count}", (HERE / "scene.toml").read_text())
    scene = folder / f"scene{count}.toml"
    scene.write_text(text)
    return program.export(scene, folder / f"settling{count}.fmu")


def course(unit, interval, end):
    """The box to the end [s]: a table, and porosities of the cells."""
    side = FluidInterface(unit, "syrup")
    column = Column(side, DENSITY, gravity=-GRAVITY)
    coupling = Coupling(side, column, QuasiNewton(), interval, watch=["syrup.work", "floor.force.z"])
    rows, porosities, worst, begun = [], [column.porosity], 0.0, (1.0 - column.porosity).sum()
    for row in coupling.steps(end):
        response = side.response(side.force("mean"))
        solid = 1.0 - column.porosity
        middle = slice(len(solid) // 4, -(len(solid) // 4))
        speed = -(response.solid_flux[middle, 0] / solid[middle]).mean()
        worst = max(worst, abs(solid.sum() / begun - 1.0))
        rows.append([row.time, speed, column.porosity[middle].mean(), column.pressure_drop, row.evaluations])
        porosities.append(column.porosity)
    print(f"{coupling.record.summary}; the volume of the beads changes by {worst:.1e} of itself")
    names = ["time", "speed", "porosity", "pressure_drop", "evaluations"]
    units = dict(zip(names, ["s", "m/s", "1", "Pa", "1"], strict=True))
    return Table(dict(zip(names, np.array(rows).T, strict=True)), units), np.array(porosities)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/settling"))
    parser.add_argument("--counts", type=int, nargs="*", default=COUNTS, help="of beads in suspensions that are timed")
    parser.add_argument("--end", type=float, default=0.8, help="of the box that settles [s]")
    parser.add_argument("--interval", type=float, default=2e-3, help="communication step [s]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    program, found = Program(options.program), []
    for count in options.counts:
        with Unit(export(program, options.output, count)) as unit:
            table, _ = course(unit, options.interval, STEADY)
        half = table["time"] > 0.5 * STEADY
        porosity, speed = table["porosity"][half].mean(), table["speed"][half].mean()
        law = porosity * slip(porosity)
        found.append([porosity, speed, law])
        print(f"porosity {porosity:.4f}: {speed:.6f} m/s; closed form {law:.6f}", end="; ")
        print(f"over a single bead {speed / slip(1.0):.4f}, Richardson and Zaki {richardson_zaki(porosity):.4f}")
    frames = {}
    if not options.no_picture:
        shutil.rmtree(options.output / "frames", ignore_errors=True)
        frames = {"parameters": {"run.frames": str(options.output / "frames")}}
    with Unit(export(program, options.output, COUNTS[2]), **frames) as unit:
        table, porosities = course(unit, options.interval, options.end)
    rows = np.array([table[name] for name in table]).T
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    if not options.no_picture:
        from picture import draw

        closed = (slip, richardson_zaki)
        draw(options.output / "settling.png", options.output / "frames", (table, porosities), np.array(found), closed)


if __name__ == "__main__":
    main()
