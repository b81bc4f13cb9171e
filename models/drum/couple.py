"""A direct-current motor turns the drum: the motor here, the drum a unit. Power, and the slope of the grains."""

import argparse
import csv
import json
from pathlib import Path

import numpy as np
from cograin import Program, Unit
from mesh import with_mesh
from motor import INTERVAL, Motor

HERE = Path(__file__).resolve().parent
STEADY = 0.8  # from here on [s]
OUTPUTS = ["drum.rotation.x", "drum.angular_velocity.x", "drum.mean_moment.x", "energy.kinetic", "energy.elastic"]
OUTPUTS += ["energy.dissipated", "energy.residual"]
COLUMNS = ["time", "voltage", "current", "torque", *OUTPUTS]


def course(unit, end):
    """Motor and drum, one after the other, to the end [s]; rows as in COLUMNS and energies of the motor [J]."""
    motor, rows, energies = Motor(), [], []
    for count in range(1, round(end / INTERVAL) + 1):
        before = (count - 1) * INTERVAL
        voltage, torque = motor.step(before, unit["drum.angular_velocity.x"])
        unit["drum.applied_moment.x"] = torque
        unit.step(INTERVAL, until=count * INTERVAL)
        rows.append([count * INTERVAL, voltage, motor.current, torque, *unit.get(OUTPUTS)])
        energies.append([motor.given, motor.lost])
    return np.array(rows), np.array(energies)


def powers(rows, energies):
    """Prints the powers while the drum turns steadily."""
    first = int(np.searchsorted(rows[:, 0], STEADY))
    if first >= len(rows) - 1:
        return
    column = {name: rows[first:, place] for place, name in enumerate(COLUMNS)}
    length = column["time"][-1] - column["time"][0]
    given, lost = (energies[-1] - energies[first]) / length
    work = (column["torque"][1:] * np.diff(column["drum.rotation.x"])).sum() / length
    dissipated = (column["energy.dissipated"][-1] - column["energy.dissipated"][0]) / length
    speed = np.diff(column["drum.rotation.x"][[0, -1]])[0] / length
    print(f"from {column['time'][0]:.2f} to {column['time'][-1]:.2f} s, means:")
    print(f"  speed {speed:.3f} rad/s, torque {column['torque'].mean() * 1e3:.3f} mN m,", end=" ")
    print(f"moment of the grains {column['drum.mean_moment.x'].mean() * 1e3:.3f} mN m")
    print(f"  supply {given * 1e3:.3f} mW, copper {lost * 1e3:.3f} mW, shaft {work * 1e3:.3f} mW,", end=" ")
    print(f"taken in by the grains {dissipated * 1e3:.3f} mW")
    worst = np.abs(rows[:, COLUMNS.index("energy.residual")]).max()
    print(f"  largest residual of the energy book {worst:.1e} J")


def replay(program, scene, folder, rows):
    """Runs the scene by itself with the torques of the motor, for its frames; gives the times of these and their folder."""
    path = folder / "torque.csv"
    torques = [[0.0, 0.0], *([row[0] - 0.5 * INTERVAL, row[3]] for row in rows)]
    with path.open("w", newline="") as text:
        csv.writer(text).writerows([["time", "drum.applied_moment.x"], *torques])
    program("run", scene, "--overwrite", "--inputs", path, "-o", folder / "run", "--set", f"run.end={rows[-1][0]}")
    return folder / "run"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/drum"))
    parser.add_argument("--end", type=float, default=1.6, help="[s]")
    parser.add_argument("--facets", type=int, help="a mesh of so many facets in the place of the exact drum")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    scene = HERE / "scene.toml"
    if options.facets:
        scene = with_mesh(scene, options.facets, options.output)
    program = Program(options.program)
    with Unit(program.export(scene, options.output / "drum.fmu")) as unit:
        rows, energies = course(unit, options.end)
    with (options.output / "couple.csv").open("w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *rows.tolist()])
    powers(rows, energies)
    if not options.no_picture:
        from picture import draw, slopes

        run = replay(program, scene, options.output, rows)
        book = json.loads((run / "summary.json").read_text())["energy"]
        print(f"energy book of the run for the pictures: {book}")
        angles, centres = slopes(run, STEADY)
        print(f"slope of the surface {angles.mean():.1f}° ± {angles.std():.1f}°", end=", ")
        print(f"line from the axis to the centre of mass {centres.mean():.1f}° ± {centres.std():.1f}°")
        draw(options.output / "drum.png", run, rows, COLUMNS)


if __name__ == "__main__":
    main()
