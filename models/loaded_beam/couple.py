"""20,000 grains on a plate that an elastic beam carries: settles the bed, exports its unit, and couples the two.

A jack holds the plate where the beam is straight and is then lowered: the beam sags and the bed follows.
"""

import argparse
import csv
import gzip
import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from balance import report
from beam import Beam, Design
from fmpy.fmi1 import FMICallException
from master import Explicit, Grains, Implicit
from picture import draw

HERE = Path(__file__).resolve().parent
GRAVITY = 9.81  # [m/s²], as in scene.toml
WALLS = [f"{wall}.force.z" for wall in ("x_low", "x_high", "y_low", "y_high")]
COLUMNS = ["time", "displacement", "force", "mean_force", "wall_force", "jack_force", "work", "evaluations"]


def arguments():
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/loaded_beam"), help="folder of all results")
    parser.add_argument("--end", type=float, default=0.5, help="simulated time [s]")
    parser.add_argument("--interval", type=float, default=2e-3, help="communication step [s]")
    parser.add_argument("--lowering", type=float, default=0.125, help="time in which the jack goes down [s]")
    parser.add_argument("--plate-mass", type=float, default=Design.plate_mass, help="mass of the floor plate [kg]")
    parser.add_argument("--height", type=float, default=Design.height, help="height of the beam's section [m]")
    parser.add_argument("--no-failure", action="store_true", help="leave out the explicit exchange")
    return parser.parse_args()


def packaged(program, output):
    """The settled bed as a unit; made anew only when the scene, its particles or the program is newer."""
    unit, settled = output / "loaded_beam.fmu", output / "settled.checkpoint"
    scene = HERE / "scene.toml"
    sources = [scene, HERE / "dense_20k.csv.gz", *(path for path in [Path(program)] if path.exists())]
    if not unit.exists() or unit.stat().st_mtime < max(path.stat().st_mtime for path in sources):
        subprocess.run([program, "settle", scene, "-o", settled], check=True)
        subprocess.run([program, "export", scene, "--from", settled, "-o", unit], check=True)
    return unit


def particles():
    """The packing: rows of x, y, z, radius, density."""
    with gzip.open(HERE / "dense_20k.csv.gz", "rt") as text:
        return np.loadtxt(text, delimiter=",", skiprows=1, usecols=(1, 2, 3, 4, 5))


def jack_force(load, now, lowering):
    """Force of the jack on the plate [N]: all the load at first, none once it is down."""
    return 0.5 * load * (1.0 + math.cos(math.pi * min(now / lowering, 1.0)))


def couple(beam, grains, exchange, load, options, end):
    """Rows of COLUMNS, one a communication step, as they come; `load` is what the jack carries at first [N]."""
    plate_weight = options.plate_mass * GRAVITY
    interval = exchange.interval
    for step in range(round(end / interval)):
        jack = jack_force(load, (step + 0.5) * interval, options.lowering)
        done = exchange.exchange(beam, grains, jack - plate_weight)
        force, work, *walls = grains.read("floor.force.z", "floor.work", *WALLS)
        yield [(step + 1) * interval, done.height, force, done.force, sum(walls), jack, work, done.evaluations]


def margins(design, grains, interval):
    """Prints how near the explicit exchange is to its limit; gives the interface stiffness at `interval`."""
    print("\nexplicit exchange: a change of the force comes back multiplied by the gain, and grows above 1")
    print("  interval   stiffness of the bed   compliance of the beam     gain")
    stiffness = {}
    for trial in sorted({0.25 * interval, 0.5 * interval, interval, 2.0 * interval, 4.0 * interval}):
        beam = Beam(design)
        beam.prepare(trial)
        stiffness[trial] = grains.interface_stiffness(trial)
        gain = stiffness[trial] * beam.step_compliance
        verdict = "grows" if gain > 1.0 else "decays"
        figures = f"{stiffness[trial]:12.4g} N/m   {beam.step_compliance:16.4g} m/N   {gain:10.2f} {verdict}"
        print(f"  {trial * 1e3:5.2f} ms   {figures}")
    return stiffness[interval]


def tenths(values):
    """The values in ten parts of the same length, in order; fewer if there are not ten."""
    return [part for part in np.array_split(values, 10) if len(part)]


def failing(design, grains, load, options):
    """Runs the explicit exchange until its oscillation is past doubt; gives its rows, and goes back."""
    beam = Beam(design)
    beam.prepare(options.interval)
    exchange = Explicit(options.interval, grains.read("floor.force.z")[0])
    weight = -exchange.force
    grains.save()
    rows = []
    ending = "it did not grow: this setting does not fail"
    try:
        for row in couple(beam, grains, exchange, load, options, 0.2):
            rows.append(row)
            swing = abs(row[3] - rows[-2][3]) if len(rows) > 1 else 0.0
            if swing > weight:
                ending = f"stopped at t = {row[0]:.3f} s: the force on the floor jumps by {swing:.0f} N in one step"
                break
    except FMICallException as refusal:
        ending = f"stopped after t = {rows[-1][0]:.3f} s: the unit refused the step (status {refusal.status})"
    swings = np.abs(np.diff([row[3] for row in rows]))
    print(f"\nexplicit exchange at {options.interval * 1e3:g} ms, for comparison")
    jumps = " ".join(f"{max(part):.3g}" for part in tenths(swings))
    print(f"  largest jump of the floor force in each tenth of that time [N]: {jumps}")
    print(f"  {ending}")
    grains.restore()
    return rows


def progress(done, steps, evaluations, began):
    """One line that says how far the run is; on a terminal it is written over and over."""
    left = (time.monotonic() - began) * (steps / done - 1.0)
    text = f"step {done} of {steps}, {evaluations / done:.2f} evaluations a step, {left:.0f} s left"
    if sys.stderr.isatty():
        print(f"\r{text}   ", end="\n" if done == steps else "", file=sys.stderr, flush=True)
    elif done % 50 == 0:
        print(text, file=sys.stderr, flush=True)


def main():
    options = arguments()
    began = time.monotonic()
    options.output.mkdir(parents=True, exist_ok=True)
    design = Design(plate_mass=options.plate_mass, height=options.height)
    packing = particles()
    weight = float(np.sum(4.0 / 3.0 * np.pi * packing[:, 3] ** 3 * packing[:, 4])) * GRAVITY

    grains = Grains(packaged(options.program, options.output))
    at_start = -grains.read("floor.force.z")[0]
    load = at_start + options.plate_mass * GRAVITY
    print(f"bed: {len(packing)} grains, weight {weight:.3f} N, {at_start:.3f} N on the floor at the start")
    print(f"beam: {1.0 / design.compliance:.4g} N/m at its middle, plate {options.plate_mass:g} kg")
    stiffness = margins(design, grains, options.interval)
    failed = [] if options.no_failure else failing(design, grains, load, options)

    print(f"\nimplicit exchange at {options.interval * 1e3:g} ms: steps repeated until both sides agree", flush=True)
    beam = Beam(design)
    beam.prepare(options.interval)
    exchange = Implicit(options.interval, stiffness, forces=[-at_start])
    rows, evaluations, started = [], 0, time.monotonic()
    for row in couple(beam, grains, exchange, load, options, options.end):
        rows.append(row)
        evaluations += row[-1]
        progress(len(rows), round(options.end / options.interval), evaluations, started)

    with open(options.output / "couple.csv", "w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *rows])
    reference = report(design, beam, rows, weight)
    draw(options.output / "loaded_beam.png", design, packing, beam, rows, failed, reference, weight)
    print(f"\n{options.output / 'couple.csv'} and {options.output / 'loaded_beam.png'} written")
    print(f"{evaluations / len(rows):.2f} evaluations a step; {time.monotonic() - began:.0f} s in all")


if __name__ == "__main__":
    main()
