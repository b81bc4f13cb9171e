"""A motor turns the drum, and what grains and shell rub away warms them: the motor's work beside the heat."""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from cograin import Program, Unit
from cograin.results import Run, Table

HERE = Path(__file__).resolve().parent
sys.path.insert(1, str(HERE.parent / "drum"))

from motor import INTERVAL, Motor  # noqa: E402

GRAVITY = 9.81  # as in scene.toml [m/s²]
SPECIFIC_HEAT, SHELL = 800.0, 2.0  # of the grains [J/(kg K)], heat capacity of the shell [J/K]; as in scene.toml
WARMING = ["normal_damping", "tangential_damping", "sliding", "rolling"]  # as in scene.toml
FURTHER = ["tangential_stiffness", "projection", "parting"]  # lost by the model of the spring, no heat
OUTPUTS = ["drum.rotation.x", "drum.angular_velocity.x", "drum.temperature", "drum.heat", "energy.heat"]
OUTPUTS += ["energy.heat_residual", "energy.kinetic", "energy.elastic", "energy.physical_residual", "bed.position.z"]
OUTPUTS += [f"energy.lost.{cause}" for cause in WARMING + FURTHER]
COLUMNS = ["time", "torque", "motor", *OUTPUTS]


def course(unit, end):
    """Motor and drum, one after the other, to the end [s]; a table of COLUMNS. ``motor`` is the work of the torque [J]."""
    motor, rows, work = Motor(), [], 0.0
    rows.append([0.0, 0.0, 0.0, *unit.get(OUTPUTS)])
    for count in range(1, round(end / INTERVAL) + 1):
        before, angle = (count - 1) * INTERVAL, unit["drum.rotation.x"]
        _, torque = motor.step(before, unit["drum.angular_velocity.x"])
        unit["drum.applied_moment.x"] = torque
        unit.step(INTERVAL, until=count * INTERVAL)
        work += torque * (unit["drum.rotation.x"] - angle)
        rows.append([count * INTERVAL, torque, work, *unit.get(OUTPUTS)])
    return Table(dict(zip(COLUMNS, np.array(rows).T, strict=True)), {"torque": "N.m", "motor": "J"})


def books(table, mass):
    """Where the motor's work is, by the row [J]: heat, motion and springs, other losses, error of the time stepping."""
    heat = table["energy.heat"] + table["drum.heat"]
    motion = table["energy.kinetic"] + table["energy.elastic"]
    potential = mass * GRAVITY * table["bed.position.z"]
    further = np.sum([table[f"energy.lost.{cause}"] for cause in FURTHER], axis=0)
    found = {"heat": heat, "motion and springs": motion, "height": potential, "lost otherwise": further}
    return {name: values - values[0] for name, values in found.items()}


def lost(table):
    """What dashpots, friction and rolling took [J]."""
    return np.sum([table[f"energy.lost.{cause}"] for cause in WARMING], axis=0)


def report(table, book, mass):
    """Prints the two books at the end."""
    heat, gone, work = book["heat"][-1], lost(table)[-1], table["motor"][-1]
    print(f"at {table['time'][-1]:.2f} s, {table['drum.rotation.x'][-1] / (2.0 * np.pi):.2f} turns:")
    print(f"  heat of grains {table['energy.heat'][-1]:.9e} J and shell {table['drum.heat'][-1]:.9e} J")
    print(f"  less what friction, dashpots and rolling took {gone:.9e} J: {heat - gone:+.1e} J, {(heat - gone) / gone:+.1e}")
    grains, shell = table["energy.heat"][-1] / (mass * SPECIFIC_HEAT), table["drum.heat"][-1] / SHELL
    print(f"  grains warmer by {1e6 * grains:.3f} µK, shell by {1e6 * shell:.3f} µK")
    print(f"motor {work:.9e} J =")
    for name, values in book.items():
        print(f"  {name:20s} {values[-1]:+.9e} J")
    residual = table["energy.physical_residual"][-1]
    left = work - sum(values[-1] for values in book.values()) + residual
    print(f"  error of the time stepping {-residual:+.3e} J, {abs(residual) / work:.1e} of it; what is left {left:+.1e} J")


def replay(program, folder, table):
    """Runs the scene by itself with the torques of the motor, for its frames; gives their folder."""
    path = folder / "torque.csv"
    with path.open("w", newline="") as text:
        rows = [[0.0, 0.0], *zip((table["time"][1:] - 0.5 * INTERVAL).tolist(), table["torque"][1:].tolist(), strict=True)]
        csv.writer(text).writerows([["time", "drum.applied_moment.x"], *rows])
    end = f"run.end={table['time'][-1]}"
    program("run", HERE / "scene.toml", "--overwrite", "--inputs", path, "-o", folder / "run", "--set", end)
    return folder / "run"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/drum_heat"))
    parser.add_argument("--end", type=float, default=1.6, help="[s]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    program = Program(options.program)
    unit_path = program.export(HERE / "scene.toml", options.output / "drum_heat.fmu")
    with Unit(unit_path) as unit:
        table = course(unit, options.end)
    with (options.output / "couple.csv").open("w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *np.array([table[name] for name in COLUMNS]).T.tolist()])
    run = replay(program, options.output, table)
    mass = float(Run(run).frames[0].particles["mass"].sum())
    book = books(table, mass)
    report(table, book, mass)
    if not options.no_picture:
        from picture import draw

        draw(options.output / "drum_heat.png", run, table, book)


if __name__ == "__main__":
    main()
