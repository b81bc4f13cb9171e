#!/usr/bin/env python3
"""Bends a bonded beam through its unit, lets another one ring, and holds both against theory.

The tip of the first beam goes down in steps and waits until its force stands; the second has a free tip and was
pushed. Writes couple.csv, ringing.csv and cantilever.png.
"""

import argparse
import csv
import math
from pathlib import Path

import numpy as np
from beam import Beam
from cograin import Program, Unit
from picture import draw

HERE = Path(__file__).resolve().parent
COLUMNS = ["time", "displacement", "force", "rotation", "clamp_moment", "work"]
MODES = 3


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--program", type=Path, default=Path("target/release/cograin"), help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/cantilever"), help="folder of the results")
    parser.add_argument("--deflection", type=float, default=4e-7, help="largest deflection of the tip [m]")
    parser.add_argument("--levels", type=int, default=4, help="steps in which it is reached")
    parser.add_argument("--interval", type=float, default=2e-3, help="communication step while it bends [s]")
    parser.add_argument("--periods", type=int, default=20, help="periods of the first mode that it rings; 0: none")
    return parser.parse_args()


def packaged(options, scene):
    """A scene of this folder as a unit."""
    return Unit(Program(options.program).export(HERE / f"{scene}.toml", options.output / f"{scene}.fmu"))


def bend(unit, options, most=200, tolerance=1e-10):
    """Lowers the tip level by level; gives a row of COLUMNS of each, once its force stands."""
    for level in range(1, options.levels + 1):
        deflection = options.deflection * level / options.levels
        force = math.inf
        for _ in range(most):
            before = force
            unit["tip.displacement.z"] = -deflection
            unit.step(options.interval)
            force = unit["tip.mean_force.z"]
            if abs(force - before) <= tolerance * abs(force):
                break
        else:
            raise RuntimeError(f"the force on the tip did not come to rest at a deflection of {deflection:g} m")
        names = ("tip.displacement.z", "tip.force.z", "tip.rotation.y", "clamp.moment.y", "tip.work")
        yield [unit.time, *unit.get(names)]


def report_bending(beam, rows):
    """Prints the forces beside those of theory."""
    print(f"bending: w/F = L³/(3EI) (1 − 1/(4N²)) + L/(κGA) = {beam.compliance():.9g} m/N for N = {beam.bonds} bonds")
    print("  deflection [m]   force [N]        theory [N]       off      moment at the clamp/(F L) − 1")
    for _, displacement, force, _, moment, _ in rows:
        theory = -displacement / beam.compliance()
        lever = abs(moment / (force * beam.length)) - 1.0
        print(f"  {-displacement:14.4g}   {force:.9e}  {theory:.9e}  {force / theory - 1.0:8.1e}  {lever:8.1e}")
    _, displacement, force, _, _, work = rows[-1]
    stored = 0.5 * abs(displacement * force)
    print(f"  work of the tip on the beam {work:.6e} J, stored F w/2 {stored:.6e} J, the rest damped")


def ring(unit, interval, count):
    """Displacement of the free tip after each of `count` communication steps [m]."""
    tip = np.empty(count)
    for k in range(count):
        unit.step(interval)
        tip[k] = unit["tip.displacement.z"]
    return tip


def frequency_near(signal, interval, guess):
    """The frequency of the peak near a guess [Hz]: from how far the phase moves on between two looks.

    The same window slides over the signal by a part of its length; what it sees of other modes falls with the third
    power of their distance.
    """
    length = 3 * len(signal) // 4
    shift = len(signal) - length
    window = np.hanning(length) ** 2
    turn = np.exp(-2j * np.pi * guess * interval * np.arange(len(signal)))
    first, second = (np.sum(window * (signal * turn)[k : k + length]) for k in (0, shift))
    return guess + np.angle(second / first) / (2.0 * np.pi * shift * interval)


def report_ringing(beam, found):
    """Prints the frequencies beside those of theory."""
    chain, timoshenko = beam.chain_frequencies(MODES), beam.timoshenko_frequencies(MODES)
    print("ringing: frequencies [Hz]")
    print("  mode   found       chain       off        Timoshenko, L = (N + ½) a   off")
    for mode, (rings, of_chain, of_beam) in enumerate(zip(found, chain, timoshenko, strict=True), 1):
        off, further = rings / of_chain - 1.0, rings / of_beam - 1.0
        print(f"  {mode}      {rings:9.4f}   {of_chain:9.4f}   {off:8.1e}   {of_beam:9.4f}   {further:23.1e}")


def write(path, names, rows):
    """Writes a table."""
    with open(path, "w", newline="") as text:
        csv.writer(text).writerows([names, *rows])


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    beam = Beam()
    with packaged(options, "scene") as unit:
        rows = list(bend(unit, options))
    write(options.output / "couple.csv", COLUMNS, rows)
    report_bending(beam, rows)
    if not options.periods:
        return

    chain = beam.chain_frequencies(MODES)
    step = 2.5e-7  # of ringing.toml [s]
    interval = step * math.floor(1.0 / (16.0 * chain[-1] * step))
    with packaged(options, "ringing") as unit:
        tip = ring(unit, interval, round(options.periods / (chain[0] * interval)))
    times = interval * np.arange(1, len(tip) + 1)
    write(options.output / "ringing.csv", ["time", "displacement"], zip(times, tip, strict=True))
    found = [frequency_near(tip, interval, guess) for guess in chain]
    report_ringing(beam, found)
    draw(options.output / "cantilever.png", beam, rows, times, tip, found)
    print(f"{options.output / 'couple.csv'}, ringing.csv and cantilever.png written")


if __name__ == "__main__":
    main()
