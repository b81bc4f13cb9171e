"""The coupling set: problems with closed forms, by every exchange, and by other programs where they are installed.

Writes results.csv and coupling_set.png: error and interface energy against processor time, which other work
on the machine changes least.
"""

import argparse
import csv
from functools import partial
from importlib import import_module
from pathlib import Path

from cograin import (
    Aitken,
    Coupling,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Newton,
    Program,
    Quadratic,
    QuasiNewton,
    Secant,
    StepControl,
    Unit,
    Verlet,
)
from beam_problem import LoadedBeam
from peers import NAMES, REFUSALS, apart, hand_over, taken_by
from problems import Drop, FiniteRod, Rod, TwoMasses

HERE = Path(__file__).resolve().parent
PROBLEMS = (Drop(), Rod(), FiniteRod(), TwoMasses(), LoadedBeam())
EXCHANGES = {
    "Gauss–Seidel": GaussSeidel,
    "Jacobi": Jacobi,
    "Verlet": Verlet,
    "fixed point": FixedPoint,
    "Aitken": Aitken,
    "secant": Secant,
    "secant, two at most": lambda: Secant(limit=2),
    "quasi-Newton": QuasiNewton,
    "quadratic": Quadratic,
    "Newton, differences": lambda: Newton("differences"),
}
LONG = 10.0  # a course that takes longer is made once [s]
COLUMNS = ["problem", "program", "exchange", "step", "error", "energy", "interface", "evaluations", "in_contact"]
COLUMNS += ["unconverged", "processor", "said"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/coupling_set"), help="folder of all results")
    parser.add_argument(
        "--problems", nargs="*", choices=[one.name for one in PROBLEMS], help="all of them if not given"
    )
    parser.add_argument("--repeats", type=int, default=3, help="runs of which the fastest counts")
    parser.add_argument("--no-peers", action="store_true", help="leave the other programs out")
    parser.add_argument("--peer", choices=NAMES, help=argparse.SUPPRESS)
    return parser.parse_args()


def run(problem, side, sphere, exchange, step):
    """A course of a problem: its measure, and what it took; `sphere` says the watched values of the particles."""
    partner = problem.partner()
    watch = read_once(problem.watch, sphere)
    watch["speed"] = lambda: partner.velocity[0]
    began, said = taken_by(side), ""
    try:
        # What makes two evaluations at most is taken as it is; everything else has the defaults.
        control = StepControl(unconverged="accept") if getattr(exchange, "limit", 0) == 2 else None
        coupling = Coupling(side, partner, exchange, step, control=control, watch=watch)
        coupling.run(round(problem.end / step) * step, progress=False)
    except REFUSALS as refusal:
        return None, 0.0, str(refusal)
    taken = taken_by(side) - began
    record = coupling.record
    measure = problem.measure(record, [side.names[0], *problem.watch], record["speed"])
    touched = record[record.names[9]] != 0.0
    counts = record["evaluations"]
    mean = float(counts[touched].mean()) if touched.any() else 0.0
    return (measure, float(counts.mean()), mean, len(record.unconverged)), taken, said


def read_once(names, read):
    """Functions for values that are read together: the first one reads, the others take what it found."""
    found = []

    def first():
        found[:] = read()
        return found[0]

    return {name: (lambda place=place: found[place]) if place else first for place, name in enumerate(names)}


def ours(problem, unit, name, step):
    """One course by the unit."""
    unit.reset()
    side = Interface(unit, getattr(problem, "interface", "floor.displacement.z"))
    return run(problem, side, lambda: unit.get(problem.watch), EXCHANGES[name](), step)


def theirs(problem, open_side, name, step):
    """One course by another program."""
    side = open_side(problem)
    if hasattr(problem, "hold"):
        problem.hold(-float(side.force("end")[0]))
    watched = partial(problem.watched, side) if hasattr(problem, "watched") else side.sphere
    try:
        return run(problem, side, watched, EXCHANGES[name](), step)
    finally:
        side.close()


def row(problem, program, name, step, course, repeats):
    """The fastest of several courses as a row; the numbers of all are the same. A long one is not repeated."""
    courses = [course()]
    while len(courses) < repeats and courses[-1][1] < LONG:
        courses.append(course())
    figures, taken, said = min(courses, key=lambda one: one[1])
    if figures is None:
        return [problem.name, program, name, step, *[""] * 7, said]
    measure, mean, touched, unconverged = figures
    numbers = [measure.error, measure.energy, measure.interface, mean, touched, unconverged, taken]
    return [problem.name, program, name, step, *numbers, said]


def chosen(options):
    """The problems that were asked for."""
    return [one for one in PROBLEMS if not options.problems or one.name in options.problems]


def of_peer(options):
    """Rows of one other program."""
    module = import_module(f"peers.{options.peer}_side")
    own = import_module(f"peers.{module.OWN}") if hasattr(module, "OWN") else None
    for problem in chosen(options):
        for name in exchanges_of(module.Side, problem):
            for step in problem.steps:
                course = lambda n=name, s=step, p=problem: theirs(p, module.Side, n, s)  # noqa: E731
                yield row(problem, options.peer, name, step, course, options.repeats)
        for name in own.EXCHANGES if own else ():
            for step in own.steps(problem, name):
                course = lambda n=name, s=step, p=problem: own.course(p, n, s)  # noqa: E731
                yield row(problem, options.peer, name, step, course, options.repeats)


def exchanges_of(side, problem):
    """Names of the exchanges that another program can be had in."""
    if not hasattr(problem, "world") or not isinstance(problem.world(), side.worlds):
        return ()
    # A dashpot has no mass for velocity Verlet.
    explicit = ("Gauss–Seidel",) if problem.name == "rod" else ("Gauss–Seidel", "Verlet")
    return (*explicit, "secant") if side.can_restore else explicit


def of_peers(options):
    """Rows of all other programs."""
    words = ["--repeats", options.repeats, "--problems", *[one.name for one in chosen(options)]]
    for name in NAMES:
        yield from apart(__file__, name, *words)


def opened(problem, command, folder):
    """The unit of a problem; some prepare it in their own way."""
    if hasattr(problem, "open"):
        return problem.open(command, folder)
    return Unit(command.export(HERE / problem.scene, folder / f"{Path(problem.scene).stem}.fmu"))


def rows(options):
    """Rows of COLUMNS, as they come."""
    command = Program(options.program)
    for problem in chosen(options):
        print(f"\n{problem.name}: {problem.exact_error}")
        with opened(problem, command, options.output) as unit:
            for name in getattr(problem, "exchanges", EXCHANGES):
                for step in problem.steps:
                    course = lambda n=name, s=step, p=problem, u=unit: ours(p, u, n, s)  # noqa: E731
                    yield row(problem, "cograin", name, step, course, options.repeats)
    if not options.no_peers:
        print("\nother programs")
        yield from of_peers(options)


def told(one):
    """A row in words."""
    problem, program, name, step, error, energy, interface, mean, touched, unconverged, taken, said = one
    if said:
        return f"  {program:9} {name:20} {step:7.0e}  {said}"
    figures = f"error {error:8.1e}  energy {energy:8.1e}  interface {interface:8.1e}"
    counts = f"evaluations {mean:5.2f}, in contact {touched:5.2f}"
    left = f"  {unconverged} steps not converged" if unconverged else ""
    name = name if program == "cograin" else f"{problem}, {name}"
    return f"  {program:9} {name:20} {step:7.0e}  {figures}  {counts}  {taken:7.3f} s{left}"


def main():
    options = arguments()
    if options.peer:
        hand_over(of_peer(options))
        return
    options.output.mkdir(parents=True, exist_ok=True)
    table = []
    for one in rows(options):
        table.append(one)
        print(told(one), flush=True)
    with (options.output / "results.csv").open("w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *table])
    from picture import draw

    draw(options.output / "coupling_set.png", COLUMNS, table)
    print(f"\n{options.output / 'results.csv'} and coupling_set.png written")


if __name__ == "__main__":
    main()
