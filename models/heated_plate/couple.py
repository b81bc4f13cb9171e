"""Beads fall on a hot plate and carry its heat away: the plate by finite elements, the beads a unit, one heat for both."""

import argparse
import shutil
from pathlib import Path

import numpy as np
from cograin import Coupling, Interface, Program, Secant, Unit
from cograin.results import Table
from plate import Design, Plate

HERE = Path(__file__).resolve().parent
WATCH = ["energy.heat", "energy.heat_residual", "above.temperature", "feed.count", "domain.count"]
POWER = 25.0  # of the heater [W]


def course(unit, interval, end):
    """Plate and beads to the end [s]: the plate, and a table of their heats [J] and temperatures [K]."""
    plate = Plate(Design(), power=lambda time: POWER)
    coupling = Coupling(Interface(unit, "plate.temperature"), plate, Secant(), interval, watch=WATCH)
    rows, left, leaving = [], 0.0, plate.leaving()
    for row in coupling.steps(end):
        # The midpoint rule: the mean of what leaves at the begin and at the end of a step leaves in it.
        before, leaving = leaving, plate.leaving()
        left += 0.5 * (before + leaving) * row.length
        rows.append([row.time, plate.load_heat, plate.stored, left, plate.temperature.min(), plate.temperature.max()])
    print(coupling.record.summary)
    table = coupling.record.table
    names = ["time", "heater", "stored", "left", "coldest", "hottest"]
    units = {"heater": "J", "stored": "J", "left": "J", "coldest": "K", "hottest": "K"}
    added = dict(zip(names, np.array(rows).T, strict=True))
    return plate, Table({**table, **added}, {**{name: table.unit_of(name) for name in table}, **units})


def report(table):
    """Prints the book of the whole at the end."""
    heater, stored, left, beads = (table[name][-1] for name in ("heater", "stored", "left", "energy.heat"))
    print(f"at {table['time'][-1]:.2f} s: {table['feed.count'][-1]:.0f} beads came, {table['domain.count'][-1]:.0f} left")
    print(f"  the heater gave {heater:.9f} J; the plate stores {stored:+.9f} J, the draught took {left:.9f} J,")
    print(f"  the beads took {beads:.9f} J; what is left {heater - stored - left - beads:+.1e} J")
    exchanged = np.abs(table["plate.mean_heat_flow"] * table["length"]).sum()
    given = -(table["plate.mean_heat_flow"] * table["length"]).sum()
    print(f"  the beads' heat and what the plate gave differ by {beads - given:+.1e} J, {abs(beads - given) / exchanged:.1e}")
    half = table["time"] > 0.5 * table["time"][-1]
    print(f"second half: {-table['plate.mean_heat_flow'][half].mean():.2f} W into the beads,", end=" ")
    print(f"which are {table['above.temperature'][half].mean() - 300.0:.2f} K warm on the plate in the mean")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/heated_plate"))
    parser.add_argument("--end", type=float, default=1.6, help="[s]")
    parser.add_argument("--interval", type=float, default=1e-2, help="communication step [s]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    path = Program(options.program).export(HERE / "scene.toml", options.output / "heated_plate.fmu")
    frames = {}
    if not options.no_picture:
        shutil.rmtree(options.output / "frames", ignore_errors=True)
        frames = {"parameters": {"run.frames": str(options.output / "frames")}}
    with Unit(path, **frames) as unit:
        plate, table = course(unit, options.interval, options.end)
    rows = np.array([table[name] for name in table]).T
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    report(table)
    if not options.no_picture:
        from picture import draw

        draw(options.output / "heated_plate.png", options.output / "frames", plate, table)


if __name__ == "__main__":
    main()
