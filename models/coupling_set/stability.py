"""Where exchanges hold: a bed of 1,000 spheres on ever lighter plates, and the border of two masses beside theory.

Writes bed.csv, border.csv and stability.png.
"""

import argparse
import csv
import time
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
BED_COLUMNS = [
    "exchange",
    "mass",
    "step",
    "reached",
    "largest",
    "mean",
    "evaluations",
    "most",
    "unconverged",
    "residual",
]
BED_COLUMNS += ["refused", "interface", "processor", "said"]
RATIOS = np.logspace(-2, 3, 11)  # mass of the particles over that of the partner
DAMPING = 0.05  # damping ratio of the partner on its own spring
STEPS = 400  # that a course has to bear without growing
LIMIT = 1.0  # displacement at which it has grown [m]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/coupling_set"), help="folder of all results")
    parser.add_argument("--exchanges", nargs="*", choices=BED, help="of the bed; all of them if not given")
    parser.add_argument("--no-bed", action="store_true", help="leave the bed out")
    parser.add_argument("--no-border", action="store_true", help="leave the two masses out")
    return parser.parse_args()


def cell(unit, problem, make, mass, step):
    """One run of the bed, as figures of BED_COLUMNS."""
    unit.reset()
    control = StepControl(unconverged="accept", halvings=0)
    began, said = time.process_time(), ""
    coupling = None
    try:
        coupling = Coupling(
            Interface(unit, "floor.displacement.z"), Oscillator(mass, problem.spring), make(), step, control=control
        )
        for row in coupling.steps(round(problem.end / step) * step):
            if not abs(row.displacement[0]) < 1000 * problem.sag:
                said = "it grows without bound"
                break
    except (CouplingStopped, ValueError) as refusal:
        said = str(refusal)
    taken = time.process_time() - began
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
                    found = [name, mass, step, *cell(unit, problem, BED[name], mass, step)]
                    yield found
                    print(told(found), flush=True)


def told(found):
    """A cell in words."""
    name, mass, step, reached, largest, mean, evaluations, most, unconverged, residual, _, share, taken, said = found
    head = f"{name:20} M = {mass:5g} kg, H = {step:7.0e} s"
    if reached == "":
        return f"{head}: {said[:90]}"
    course = (
        f"to {reached:.3f} s, largest {largest:8.3g}, mean {mean if mean == '' else f'{mean:.4f}'} of the static sag"
    )
    counts = f"{evaluations:.2f} evaluations, at most {most:.0f}, {unconverged} not converged (up to {residual:.0e} m)"
    return f"{head}: {course}; {counts}; interface {share:+.0e}; {taken:.1f} s {said[:60]}"


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
    options.output.mkdir(parents=True, exist_ok=True)
    cells, lines = [], []
    if not options.no_bed:
        cells = list(bed(options))
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
