"""Air lifts a bed of beads: the pressure drop over the velocity, beside Ergun's law and the weight."""

import argparse
import shutil
from pathlib import Path

import numpy as np
from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import Column, FluidInterface
from cograin.results import Table

HERE = Path(__file__).resolve().parent
DENSITY, VISCOSITY, SOLID, DIAMETER, GRAVITY = 1.2, 1.8e-5, 2500.0, 1e-3, 9.81
AREA = 25e-6  # of the column [m²]


def ergun(velocity, porosity):
    """Pressure drop over the height [Pa/m] of a bed at rest under this superficial velocity [m/s]."""
    solid = 1.0 - porosity
    viscous = 150.0 * solid**2 * VISCOSITY * velocity / (porosity**3 * DIAMETER**2)
    return viscous + 1.75 * solid * DENSITY * velocity**2 / (porosity**3 * DIAMETER)


def least(porosity):
    """Velocity [m/s] at which that carries the weight of the bed."""
    solid = 1.0 - porosity
    square = 1.75 * solid * DENSITY / (porosity**3 * DIAMETER)
    linear = 150.0 * solid**2 * VISCOSITY / (porosity**3 * DIAMETER**2)
    weight = solid * (SOLID - DENSITY) * GRAVITY
    return (-linear + np.sqrt(linear**2 + 4.0 * square * weight)) / (2.0 * square)


def course(unit, interval, end, highest):
    """The velocity grows from 0 to the highest [m/s] at the end [s]; a table, and porosities of the cells."""
    side = FluidInterface(unit, "air")
    column = Column(side, DENSITY, gravity=-GRAVITY, inflow=lambda time: highest * time / end)
    begun = solid(column)
    watch = {"floor.force.z": lambda: unit["floor.force.z"], "energy.lost.drag": lambda: unit.number("air.work")}
    coupling = Coupling(side, column, QuasiNewton(), interval, watch=watch)
    rows, porosities, worst = [], [], 0.0
    for row in coupling.steps(end):
        rest = DENSITY * GRAVITY * column.height * len(column.porosity)
        rows.append(
            [row.time, highest * row.time / end, column.pressure_drop - rest, unit["floor.force.z"], top(column)]
        )
        porosities.append(column.porosity)
        worst = max(worst, abs(solid(column) - begun) / begun)
    print(coupling.record.summary)
    print(f"the volume of the beads in the cells changed by {worst:.1e} of itself")
    names = ["time", "velocity", "pressure_drop", "floor.force.z", "height"]
    units = dict(zip(names, ["s", "m/s", "Pa", "N", "m"], strict=True))
    return Table(dict(zip(names, np.array(rows).T, strict=True)), units), np.array(porosities)


def solid(column):
    """Volume of the beads in the cells [m³]."""
    return column.volume * (1.0 - column.porosity).sum()


def top(column):
    """Height of the bed, were it as full everywhere as in its lower half [m]."""
    full = 1.0 - column.porosity
    return column.height * full.sum() / full[1:3].mean()


def report(table):
    """Prints what the bed did beside the closed forms."""
    velocity, drop = table["velocity"], table["pressure_drop"]
    weight = drop[velocity > 0.8 * velocity[-1]].mean()
    beads = -table["floor.force.z"][2:20].mean() / AREA
    print(f"the beads weigh {beads:.1f} Pa; the air carries {weight:.1f} Pa in the mean of the last fifth")
    height = table["height"][5:40].mean()
    porosity = 1.0 - weight / (height * (SOLID - DENSITY) * GRAVITY)
    packed = (velocity > 0.1 * velocity[-1]) & (drop < 0.7 * weight)
    ratio = drop[packed] / (height * ergun(velocity[packed], porosity))
    print(f"at rest: porosity {porosity:.3f}, drop over Ergun's {ratio.mean():.3f} ± {ratio.std():.3f}")
    crossing = velocity[np.argmax(drop > weight)] if (drop > weight).any() else np.nan
    print(
        f"the drop meets the weight at {crossing:.3f} m/s; Ergun's minimum of fluidisation is {least(porosity):.3f} m/s"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/fluidised_column"))
    parser.add_argument("--end", type=float, default=0.5, help="[s]")
    parser.add_argument("--interval", type=float, default=2e-3, help="communication step [s]")
    parser.add_argument("--rate", type=float, default=2.4, help="growth of the velocity [m/s²]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    path = Program(options.program).export(HERE / "scene.toml", options.output / "fluidised_column.fmu")
    frames = {}
    if not options.no_picture:
        shutil.rmtree(options.output / "frames", ignore_errors=True)
        frames = {"parameters": {"run.frames": str(options.output / "frames")}}
    with Unit(path, **frames) as unit:
        table, porosities = course(unit, options.interval, options.end, options.rate * options.end)
    rows = np.array([table[name] for name in table]).T
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    report(table)
    if not options.no_picture:
        from picture import draw

        draw(options.output / "fluidised_column.png", options.output / "frames", table, porosities, ergun)


if __name__ == "__main__":
    main()
