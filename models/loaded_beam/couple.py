"""20,000 grains on a plate that an elastic beam carries: settles the bed, exports its unit, and couples the two.

A jack holds the plate where the beam is straight and is then lowered: the beam sags and the bed follows.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np
from balance import report
from beam import Beam, Design
from cograin import (
    Coupling,
    CouplingStopped,
    GaussSeidel,
    Interface,
    Program,
    Secant,
    Step,
    StepControl,
    Unit,
    stiffness,
)
from loads import GRAVITY, jack_force, particles, weight_of
from picture import draw

HERE = Path(__file__).resolve().parent
FLOOR = "floor.displacement.z"
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
    sources = [scene, HERE / "dense_20k.csv.gz", *(path for path in [program.path] if path.exists())]
    if not unit.exists() or unit.stat().st_mtime < max(path.stat().st_mtime for path in sources):
        print(program.settle(scene, settled), flush=True)
        program.export(scene, unit, start=settled)
    return unit


def coupling(design, bed, exchange, load, options):
    """Beam and bed from the present state; `load` is what the jack carries at first [N]."""
    plate_weight = options.plate_mass * GRAVITY
    beam = Beam(design, lambda now: jack_force(load, now, options.lowering) - plate_weight)
    watched = ["floor.force.z", "floor.mean_force.z", "floor.work", *WALLS]
    return Coupling(Interface(bed, FLOOR), beam, exchange, options.interval, watch=watched)


def rows(record, load, options):
    """Rows of COLUMNS, one a communication step."""
    middles = record["time"] - 0.5 * record["length"]
    jack = [jack_force(load, now, options.lowering) for now in middles]
    walls = sum(record[name] for name in WALLS)
    names = ["time", FLOOR, "floor.force.z", "floor.mean_force.z"]
    columns = [*(record[name] for name in names), walls, jack, record["floor.work"], record["evaluations"]]
    return np.array(columns).T


def margins(design, bed, interval):
    """Prints how near the explicit exchange is to its limit; gives the interface stiffness at `interval`."""
    print("\nexplicit exchange: a change of the force comes back multiplied by the gain, and grows above 1")
    print("  interval   stiffness of the bed   compliance of the beam     gain")
    stiffnesses = {}
    for trial in sorted({0.25 * interval, 0.5 * interval, interval, 2.0 * interval, 4.0 * interval}):
        compliance = Beam(design).compliance(Step(0.0, trial, trial))[0, 0]
        stiffnesses[trial] = stiffness(Interface(bed, FLOOR), trial)[0]
        gain = stiffnesses[trial] * compliance
        verdict = "grows" if gain > 1.0 else "decays"
        figures = f"{stiffnesses[trial]:12.4g} N/m   {compliance:16.4g} m/N   {gain:10.2f} {verdict}"
        print(f"  {trial * 1e3:5.2f} ms   {figures}")
    return stiffnesses[interval]


def tenths(values):
    """The values in ten parts of the same length, in order; fewer if there are not ten."""
    return [part for part in np.array_split(values, 10) if len(part)]


def failing(design, bed, load, options, weight):
    """Runs the explicit exchange until its oscillation is past doubt; gives its rows, and goes back."""
    start = bed.save()
    run = coupling(design, bed, GaussSeidel("mean"), load, options)
    run.control = StepControl(halvings=0)
    ending = "it did not grow: this setting does not fail"
    before = -weight
    try:
        for row in run.steps(round(0.2 / options.interval) * options.interval):
            swing, before = abs(row.force[0] - before), row.force[0]
            if swing > weight:
                ending = f"stopped at t = {row.time:.3f} s: the force on the floor jumps by {swing:.0f} N in one step"
                break
    except CouplingStopped as refusal:
        ending = f"stopped after t = {run.time:.3f} s: {refusal}"
    found = rows(run.record, load, options)
    swings = np.abs(np.diff(found[:, 3]))
    print(f"\nexplicit exchange at {options.interval * 1e3:g} ms, for comparison")
    jumps = " ".join(f"{max(part):.3g}" for part in tenths(swings))
    print(f"  largest jump of the floor force in each tenth of that time [N]: {jumps}")
    print(f"  {ending}")
    bed.restore(start)
    return found.tolist()


def main():
    options = arguments()
    began = time.monotonic()
    options.output.mkdir(parents=True, exist_ok=True)
    design = Design(plate_mass=options.plate_mass, height=options.height)
    packing = particles()
    weight = weight_of(packing)

    bed = Unit(packaged(Program(options.program), options.output))
    at_start = -bed["floor.force.z"]
    load = at_start + options.plate_mass * GRAVITY
    print(f"bed: {len(packing)} grains, weight {weight:.3f} N, {at_start:.3f} N on the floor at the start")
    print(f"beam: {1.0 / design.compliance:.4g} N/m at its middle, plate {options.plate_mass:g} kg")
    guess = margins(design, bed, options.interval)
    failed = [] if options.no_failure else failing(design, bed, load, options, at_start)

    print(f"\nimplicit exchange at {options.interval * 1e3:g} ms: steps repeated until both sides agree", flush=True)
    run = coupling(design, bed, Secant(stiffness=guess), load, options)
    record = run.run(round(options.end / options.interval) * options.interval)
    print(record.summary)
    beam, found = run.partner, rows(record, load, options)

    with open(options.output / "couple.csv", "w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *found])
    reference = report(design, beam, found, weight)
    draw(options.output / "loaded_beam.png", design, packing, beam, found, failed, reference, weight)
    print(f"\n{options.output / 'couple.csv'} and {options.output / 'loaded_beam.png'} written")
    print(f"{time.monotonic() - began:.0f} s in all")
    bed.close()


if __name__ == "__main__":
    main()
