"""Suspensions settle in a closed box: their speeds over the porosity, beside Richardson and Zaki."""

import argparse
import re
from pathlib import Path

import numpy as np
from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import Column, FluidInterface
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


def course(unit, interval):
    """A suspension until it sinks steadily: porosity and speed [m/s] in the middle, evaluations a step."""
    side = FluidInterface(unit, "syrup")
    column = Column(side)
    coupling = Coupling(side, column, QuasiNewton(), interval)
    middle, found = slice(len(side.cells) // 4, -(len(side.cells) // 4)), []
    for row in coupling.steps(STEADY):
        if row.time > 0.5 * STEADY:
            porosity, flux = column.porosity[middle], side.response(side.force("mean")).solid_flux[middle, 0]
            found.append([porosity.mean(), -(flux / (1.0 - porosity)).mean()])
    return [*np.mean(found, axis=0), coupling.record["evaluations"].mean()]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/settling"))
    parser.add_argument("--counts", type=int, nargs="*", default=COUNTS, help="of beads in the suspensions")
    parser.add_argument("--interval", type=float, default=2e-3, help="communication step [s]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    program, rows = Program(options.program), []
    for count in options.counts:
        with Unit(export(program, options.output, count)) as unit:
            porosity, speed, evaluations = course(unit, options.interval)
        closed = porosity * slip(porosity)
        rows.append([count, porosity, speed, closed, richardson_zaki(porosity) * slip(1.0), evaluations])
        print(f"{count} beads, porosity {porosity:.4f}: {speed:.6f} m/s; closed form {closed:.6f}", end="; ")
        print(f"Richardson and Zaki {rows[-1][4]:.6f}; {evaluations:.1f} evaluations a step")
    header = "count,porosity,speed,closed_form,richardson_zaki,evaluations"
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=header, comments="", fmt="%.17g")
    if not options.no_picture:
        from picture import draw

        draw(options.output / "settling.png", np.array(rows), slip, richardson_zaki)


if __name__ == "__main__":
    main()
