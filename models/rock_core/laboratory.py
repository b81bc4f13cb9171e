"""What the tests of rock have in common: the units, a course until the specimen has failed, its files."""

import argparse
import csv
import shutil
import subprocess
import sys
import time
from pathlib import Path

import machine
import numpy as np
from cograin import CouplingStopped, Program

HERE = Path(__file__).resolve().parent


def arguments(text, name):
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=text)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out") / name, help="folder of all results")
    parser.add_argument("--importer", choices=["fmpy", "libcosimpy", "ecospy"], default="fmpy")
    exchanges = ["sequential", "parallel", "implicit"]
    parser.add_argument("--exchange", choices=exchanges, default="sequential", help="of fmpy; the others have parallel")
    parser.add_argument("--interval", type=float, default=1e-5, help="communication step [s]")
    parser.add_argument("--end", type=float, default=6e-3, help="simulated time at the most [s]")
    parser.add_argument("--until", type=float, default=0.2, help="ends when the load is this part of its peak")
    parser.add_argument("--speed", type=float, default=0.1, help="of the crosshead [m/s]")
    parser.add_argument("--stiffness", type=float, default=1e9, help="of the press [N/m]")
    parser.add_argument("--mass", type=float, default=20.0, help="of the platen [kg]")
    parser.add_argument("--damping-ratio", type=float, default=0.5, help="of the platen on the frame")
    parser.add_argument("--no-picture", action="store_true", help="leave out the replay and the picture")
    return parser.parse_args()


def units(program, scene, output):
    """The specimen and the press as units."""
    output.mkdir(parents=True, exist_ok=True)
    rock = Program(program).export(scene, output / f"{scene.parent.name}.fmu")
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", HERE / "press.py", "-d", output, "--handle-state"]
    subprocess.run(build, check=True)
    return rock, output / "Press.fmu"


def course(options, rock, press):
    """The rows of a test that ends when the specimen has failed, as a dictionary of columns."""
    parameters = {name: getattr(options, name) for name in ("speed", "stiffness", "mass", "damping_ratio")}
    if options.importer == "fmpy":
        rows = machine.with_fmpy(rock, press, parameters, options.interval, options.exchange)
    else:
        rows = getattr(machine, f"with_{options.importer}")(rock, press, parameters, options.interval)
    taken, peak, began = [], 0.0, time.monotonic()
    broken, load = machine.COLUMNS.index("bonds.broken"), machine.COLUMNS.index("lower.force.z")
    while True:
        try:
            row = next(rows)
        except (CouplingStopped, RuntimeError) as refusal:
            after = f"after {taken[-1][0]:.6f} s" if taken else "at once"
            sys.exit(f"the coupled run stopped {after}: {refusal}")
        taken.append(row)
        peak = max(peak, -row[load])
        if len(taken) % 50 == 0:
            print(f"t = {row[0]:.5f} s, load {-row[load]:.0f} N, {row[broken]} bonds broken", file=sys.stderr)
        if row[0] > options.end - 0.5 * options.interval or (row[broken] and -row[load] < options.until * peak):
            break
    rows.close()
    print(f"{len(taken)} communication steps with {options.importer} in {time.monotonic() - began:.0f} s")
    with open(options.output / "couple.csv", "w", newline="") as text:
        csv.writer(text).writerows([machine.COLUMNS, *taken])
    return dict(zip(machine.COLUMNS, np.array(taken, dtype=float).T, strict=True))


def replay(program, scene, output):
    """Runs the specimen by itself through the course in couple.csv, for what a unit does not write: where it broke."""
    folder = output / "replay"
    shutil.rmtree(folder, ignore_errors=True)
    inputs = output / "couple.csv"
    subprocess.run([program, "run", scene, "--inputs", inputs, "-o", folder], check=True)
    return folder


def balances(rows):
    """Prints what is held against what, whatever the specimen."""
    load = -rows["lower.force.z"]
    peak = int(np.argmax(load))
    apart = np.abs(rows["upper.force.z"] - load)
    rising = int(np.argmax(load >= 0.5 * load[peak]))
    early, late = (part.max(initial=0.0) / max(load[peak], 1e-300) for part in (apart[:rising], apart[rising : peak + 1]))
    print(f"loads of the two platens: {early:.2%} of the peak apart at most up to half of it, {late:.2%} up to the peak")
    last = {name: column[-1] for name, column in rows.items()}
    moved = np.diff(rows["upper.displacement.z"], prepend=0.0)
    of_rock = -float(rows["upper.mean_force.z"] @ moved)
    residual = last["press.drive_work"] + last["press.specimen_work"] - last["press.energy"] - last["press.loss"]
    print("energy books [J]")
    print(f"  press: drive {last['press.drive_work']:.6f} = specimen {-last['press.specimen_work']:.6f}", end="")
    print(f" + stored {last['press.energy']:.6f} + lost in its dashpot {last['press.loss']:.6f}; residual {residual:+.1e}")
    print(f"  rock: upper.work {last['upper.work']:.6f}, −Σ mean_force·Δdisplacement {of_rock:.6f}", end="")
    print(f"; difference {last['upper.work'] - of_rock:+.1e}")
    kinetic, elastic, dissipated = (last[f"energy.{kind}"] for kind in ("kinetic", "elastic", "dissipated"))
    print(f"  rock: kinetic {kinetic:.6f} + elastic {elastic:.6f} + dissipated {dissipated:.6f}", end="")
    print(f"; residual of its steps {last['energy.residual']:+.1e}")
    left = last["upper.work"] + last["press.specimen_work"]
    share = abs(left) / max(abs(last["upper.work"]), 1e-300)
    print(f"  between them {left:+.6f}, {share:.2%}: the exchange; an implicit one closes it")
    if share > 0.05:
        print("this exchange is not to be trusted: a heavier platen, more damping or a shorter interval is needed")
