"""The same grains on the same plate by `cograin.couple`, for comparison with preCICE."""

import argparse
import csv
from pathlib import Path

import numpy as np
from plate import elements, jacks

from cograin import Coupling, Interface, QuasiNewton, Tolerance, Unit


def couple(path, end=0.02, step=1e-3, cells=12):
    """Time and deflection of the middle [m] after each step, and where the skin stands at last."""
    parts = elements()
    with Unit(path) as unit:
        skin = unit.nodes("skin")
        lifts = [name for name in skin.names("displacement") if name.endswith(".z")]
        interface = Interface(unit, lifts, through=parts.Plate(parts.Design(), cells).through(skin.places))
        plate = parts.Plate(parts.Design(), cells, jacks(-interface.force("end")))
        exchange = QuasiNewton(tolerance=Tolerance(relative=1e-6), reuse=8)
        coupling = Coupling(interface, plate, exchange, step)
        rows = [(row.time, plate.deflections[plate.middle]) for row in coupling.steps(end)]
        print(coupling.record.summary)
        return np.array(rows), skin.displacement


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("out/precice_plate"), help="folder of the results of both")
    options = parser.parse_args()
    with open(options.output / "plate.csv", newline="") as text:
        found = np.array(list(csv.reader(text))[1:], dtype=float)
    expected, _ = couple(options.output / "grains.fmu", end=found[-1, 0])
    apart = np.abs(found[:, 1] - expected[:, 1]).max() / np.abs(expected[:, 1]).max()
    print(f"deflection at {found[-1, 0]:g} s: {found[-1, 1]:.6e} m by preCICE, {expected[-1, 1]:.6e} m by couple")
    print(f"largest difference: {apart:.1e} of the deflection")


if __name__ == "__main__":
    main()
