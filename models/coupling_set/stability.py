"""Where exchanges hold: a bed of 1,000 spheres on ever lighter plates, and the border of two masses beside theory.

Writes bed.csv, border.csv and stability.png.
"""

import argparse
import csv
from contextlib import closing
from functools import partial
from importlib import import_module
from pathlib import Path

import numpy as np
from cograin import (
    Aitken,
    Coupling,
    CouplingStopped,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Newton,
    Oscillator,
    Program,
    QuasiNewton,
    Secant,
    StepControl,
    Unit,
    Verlet,
)
from peers import NAMES, REFUSALS, apart, apart_if_needed, hand_over, taken_by
from problems import Bed, TwoMasses
from theory import FixedPointGain, Linear

HERE = Path(__file__).resolve().parent
BED = {
    "Gauss–Seidel": GaussSeidel,
    "Verlet": Verlet,
    "fixed point": FixedPoint,
    "Aitken": Aitken,
    "secant": Secant,
    "quasi-Newton": QuasiNewton,
    "Newton, differences": lambda: Newton("differences"),
}
BORDER = {"Gauss–Seidel": GaussSeidel, "Jacobi": Jacobi, "Verlet": Verlet, "fixed point": FixedPoint, "secant": Secant}
EXPLICIT = ("Gauss–Seidel", "Verlet")
BEDS = tuple(name for name in NAMES if name != "kratos")  # programs that have the bed
PEERS = (*EXPLICIT, "secant")  # of other programs, the last where it can be had
LONG = (2e-4, 1e-3)  # steps of the secant there: to save and to restore takes tens of milliseconds [s]
BED_COLUMNS = ["program", "exchange", "mass", "step", "reached", "largest", "mean", "evaluations", "most"]
BED_COLUMNS += ["unconverged", "residual", "refused", "interface", "processor", "said"]
RATIOS = np.logspace(-2, 3, 11)  # mass of the particles over that of the partner
DAMPING = 0.05  # damping ratio of the partner on its own spring
STEPS = 400  # that a course has to bear without growing
LIMIT = 1.0  # displacement at which it has grown [m]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/coupling_set"), help="folder of all results")
    parser.add_argument("--exchanges", nargs="*", choices=BED, help="of the bed; all of them if not given")
    parser.add_argument("--no-peers", action="store_true", help="leave the other programs out")
    parser.add_argument("--peer", choices=NAMES, help=argparse.SUPPRESS)
    parser.add_argument("--no-bed", action="store_true", help="leave the bed out")
    parser.add_argument("--no-border", action="store_true", help="leave the two masses out")
    return parser.parse_args()


def cell(side, problem, make, mass, step):
    """One run of the bed, as figures of BED_COLUMNS."""
    began, said = taken_by(side), ""
    coupling = None
    try:
        coupling = Coupling(side, Oscillator(mass, problem.spring), make(), step)
        for row in coupling.steps(round(problem.end / step) * step):
            if not abs(row.displacement[0]) < 1000 * problem.sag:
                said = "it grows without bound"
                break
    except REFUSALS as refusal:
        said = str(refusal)
    taken = taken_by(side) - began
    if coupling is None or not len(coupling.record):
        return [*[""] * 10, said]
    record = coupling.record
    sags = -record["floor.displacement.z"] / problem.sag
    late = sags[record["time"] > 0.8 * problem.end]
    left = max((row.residual for row in record.unconverged), default=0.0)
    counts, share = record["evaluations"], record.interface_energy / max(record.exchanged_work, 1e-300)
    figures = [record["time"][-1], np.abs(sags).max(), late.mean() if len(late) else "", counts.mean(), counts.max()]
    return [*figures, len(record.unconverged), left, int(record["refusals"].sum()), share, taken, said]


def bed(options):
    """Rows of BED_COLUMNS, as they come."""
    problem = Bed()
    path = Program(options.program).export(HERE / problem.scene, options.output / "bed.fmu")
    with Unit(path) as unit:
        for name in options.exchanges or BED:
            for mass in problem.masses:
                for step in problem.steps:
                    unit.reset()
                    side = Interface(unit, "floor.displacement.z")
                    yield ["cograin", name, mass, step, *cell(side, problem, BED[name], mass, step)]
    for name in () if options.no_peers else BEDS:
        yield from apart(__file__, name, *(["--exchanges", *options.exchanges] if options.exchanges else []))


def bed_of_peer(options):
    """Rows of BED_COLUMNS by another program."""
    problem, side = Bed(), import_module(f"peers.{options.peer}_side").Side
    for name in PEERS if side.can_restore else EXPLICIT:
        for mass in problem.masses if name in (options.exchanges or BED) else ():
            for step in problem.steps if name in EXPLICIT else LONG:
                course = partial(cell_of_peer, side, problem, BED[name], mass, step)
                ended = [*[""] * 10, "the program ends with an error"]
                yield [options.peer, name, mass, step, *(apart_if_needed(side, course) or ended)]


def cell_of_peer(side, problem, make, mass, step):
    """One run of the bed by another program, as figures of BED_COLUMNS."""
    with closing(side(problem)) as opened:
        return cell(opened, problem, make, mass, step)


def told(found):
    """A cell in words."""
    one = dict(zip(BED_COLUMNS, found, strict=True))
    head = f"{one['program']:9} {one['exchange']:20} M = {one['mass']:5g} kg, H = {one['step']:7.0e} s"
    if one["reached"] == "":
        return f"{head}: {one['said'][:90]}"
    mean = one["mean"] if one["mean"] == "" else f"{one['mean']:.4f}"
    course = f"to {one['reached']:.3f} s, largest {one['largest']:8.3g}, mean {mean} of the static sag"
    left = f"{one['unconverged']} not converged (up to {one['residual']:.0e} m)"
    counts = f"{one['evaluations']:.2f} evaluations, at most {one['most']:.0f}, {left}"
    return f"{head}: {course}; {counts}; interface {one['interface']:+.0e}; {one['processor']:.1f} s {one['said'][:60]}"


def grows(unit, make, mass, step):
    """Whether a course of two masses becomes ever larger, or does not converge, with this partner and step."""
    problem = TwoMasses()
    partner = Oscillator(mass, problem.outer, 2.0 * DAMPING * np.sqrt(problem.outer * mass))
    unit.reset()
    control = StepControl(unconverged="stop", halvings=0)
    coupling = Coupling(Interface(unit, "right.displacement.x"), partner, make(), step, control=control)
    try:
        for _ in range(STEPS):
            if not abs(coupling.advance().displacement[0]) < LIMIT:
                return True
    except CouplingStopped:
        return True
    return False


def measured(unit, make, mass, steps, near):
    """The step at which it grows, and does not at the one before, nearest to the place `near` [s].

    Bands of growth may lie apart, so that a search of the whole range need not find the first one.
    """
    place = near
    if grows(unit, make, mass, steps[place]):
        while place > 0 and grows(unit, make, mass, steps[place - 1]):
            place -= 1
        return steps[place]
    while place + 1 < len(steps):
        place += 1
        if grows(unit, make, mass, steps[place]):
            return steps[place]
    return np.inf


def border(options):
    """Rows of exchange, ratio of the masses, border by theory of any growth and of one that is seen, measured [s]."""
    path = Program(options.program).export(HERE / "oscillator.toml", options.output / "oscillator.fmu")
    time_step = 5e-4
    counts = np.unique(np.round(np.logspace(0, np.log10(600), 120)).astype(int))
    # From the amplitude that the left mass brings to the limit within the steps of a course.
    seen = (LIMIT / (TwoMasses.speed / (2.0 * np.pi))) ** (1.0 / STEPS)
    with Unit(path) as unit:
        for name, make in BORDER.items():
            for ratio in RATIOS:
                mass = 1.0 / ratio
                theory = FixedPointGain if name == "fixed point" else Linear
                linear = None if name == "secant" else theory(name, mass, DAMPING, time_step)
                any_growth, expected = (linear.border(counts, it) if linear else np.inf for it in (1.0, seen))
                near = min(int(np.searchsorted(counts, expected / time_step - 0.5)), len(counts) - 1)
                found = measured(unit, make, mass, counts * time_step, near)
                yield [name, ratio, any_growth, expected, found]
                share = f"{found / expected:.2f}" if np.isfinite(expected) and np.isfinite(found) else "–"
                borders = f"any growth {any_growth:9.4g} s, theory {expected:9.4g} s, measured {found:9.4g} s"
                print(f"{name:14} masses {ratio:8.3g}: {borders}, measured over theory {share}", flush=True)


def main():
    options = arguments()
    if options.peer:
        hand_over(bed_of_peer(options))
        return
    options.output.mkdir(parents=True, exist_ok=True)
    cells, lines = [], []
    if not options.no_bed:
        for found in bed(options):
            cells.append(found)
            print(told(found), flush=True)
        with (options.output / "bed.csv").open("w", newline="") as text:
            csv.writer(text).writerows([BED_COLUMNS, *cells])
    if not options.no_border:
        lines = list(border(options))
        with (options.output / "border.csv").open("w", newline="") as text:
            csv.writer(text).writerows([["exchange", "mass_ratio", "any_growth", "theory", "measured"], *lines])
        from stability_picture import draw

        draw(options.output / "stability.png", lines)


if __name__ == "__main__":
    main()
