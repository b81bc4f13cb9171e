"""Air lifts a bed of beads: the pressure drop over the velocity, beside Ergun's law and the weight."""

import argparse
import shutil
from pathlib import Path

import numpy as np
from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import Column, FluidInterface
from cograin.results import Table
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
DENSITY, VISCOSITY, SOLID, DIAMETER, GRAVITY = 1.2, 1.8e-5, 2500.0, 1e-3, 9.81
AREA = 25e-6  # of the column [m²]


def ergun(velocity, porosity):
    """Pressure drop over the height [Pa/m] of a bed at rest under this superficial velocity [m/s]."""
    solid = 1.0 - porosity
    viscous = 150.0 * solid**2 * VISCOSITY * velocity / (porosity**3 * DIAMETER**2)
    return viscous + 1.75 * solid * DENSITY * velocity**2 / (porosity**3 * DIAMETER)


def fixed(velocity, porosities, height):
    """Pressure drop [Pa] by that law of cells of this height [m] with these porosities."""
    return height * ergun(np.asarray(velocity)[..., None], porosities).sum(axis=-1)


def course(unit, interval, end, highest):
    """The velocity grows from 0 to the highest [m/s] at the end [s]: table, porosities, weight, height, gradients."""
    side = FluidInterface(unit, "air")
    column = Column(side, inflow=lambda time: highest * time / end)
    begun = solid(column)
    coupling = Coupling(side, column, QuasiNewton(), interval)
    rows, porosities, gradients, worst = [], [], [], 0.0
    for row in coupling.steps(end):
        rest = DENSITY * GRAVITY * column.height * len(column.porosity)
        drop = column.pressure_drop - rest
        # The drop is the mean of a step. The air is on a ramp: in the mean it has the velocity of the step's beginning.
        rows.append([row.time, column.inflow(row.time - row.length), drop, unit["floor.force.z"]])
        porosities.append(column.porosity)
        gradients.append(column.pressure_gradient + DENSITY * GRAVITY)
        worst = max(worst, abs(solid(column) - begun) / begun)
    print(coupling.record.summary)
    print(f"the volume of the beads in the cells changed by {worst:.1e} of itself")
    names = ["time", "velocity", "pressure_drop", "floor.force.z"]
    units = dict(zip(names, ["s", "m/s", "Pa", "N"], strict=True))
    table = Table(dict(zip(names, np.array(rows).T, strict=True)), units)
    weight = begun * (SOLID - DENSITY) * GRAVITY / AREA
    return table, np.array(porosities), weight, column.height, np.array(gradients)


def solid(column):
    """Volume of the beads in the cells [m³]."""
    return column.volume * (1.0 - column.porosity).sum()


def at_rest(table, porosities, weight):
    """Porosities of the bed [1] while the air carries less than its weight [Pa], and where that ends in the table."""
    crossing = int(np.argmax(table["pressure_drop"] > weight))
    return porosities[crossing // 3 : 2 * crossing // 3].mean(axis=0), crossing


def report(table, porosities, weight, height, gradients):
    """Prints what the bed did beside the closed forms, once the air carries its weight [Pa]."""
    velocity, drop = table["velocity"], table["pressure_drop"]
    carried = drop[velocity > 0.8 * velocity[-1]].mean()
    print(f"the beads weigh {weight:.1f} Pa in air; it carries {carried:.1f} Pa in the mean of the last fifth")
    if drop.max() < weight:
        return
    bed, crossing = at_rest(table, porosities, weight)
    rest = slice(crossing // 3, 2 * crossing // 3)
    inside = -gradients[rest, :3].sum(axis=1) * height / fixed(velocity[rest], bed[:3], height)
    ratio = drop[rest] / fixed(velocity[rest], bed, height)
    print(f"at rest: drop over Ergun's {inside.mean():.3f} ± {inside.std():.3f} below the surface", end=", ")
    print(f"{ratio.mean():.3f} ± {ratio.std():.3f} in all")
    least = brentq(lambda each: fixed(each, bed, height) - weight, 1e-3, 10.0)
    print(f"the drop meets the weight at {velocity[crossing]:.3f} m/s, Ergun's at {least:.3f} m/s")


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
        table, *bed = course(unit, options.interval, options.end, options.rate * options.end)
    rows = np.array([table[name] for name in table]).T
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    report(table, *bed)
    if not options.no_picture:
        from picture import draw

        draw(options.output / "fluidised_column.png", options.output / "frames", (table, *bed), (at_rest, fixed))


if __name__ == "__main__":
    main()
