"""Load steps of a tenth of the carried load on a bonded block and on a bed at rest: evaluations of each exchange.

The other side is a light mass on a soft spring: the particles are ten times as stiff as the spring, and ten or a thousand
times as heavy as the mass.
"""

import argparse
import csv
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from cograin import (
    Aitken,
    Coupling,
    CouplingStopped,
    FixedPoint,
    Interface,
    Newton,
    Oscillator,
    Program,
    QuasiNewton,
    Secant,
    StepControl,
    Tolerance,
    Unit,
    stiffness,
)

HERE = Path(__file__).resolve().parent
EXCHANGES = {
    "Newton": Newton,
    "Newton, kept": lambda **named: Newton(keep=True, **named),
    "secant": Secant,
    "quasi-Newton": QuasiNewton,
    "Aitken": Aitken,
    "fixed point": FixedPoint,
}
STIFFNESS = 10.0  # of the particles over that of the spring
MASSES = (10.0, 1000.0)  # of the particles over that of the other side
SHARE = 0.1  # of the carried load in each load step
LOADS = 4  # load steps


@dataclass
class Case:
    """A unit whose boundary is carried."""

    name: str
    scene: str
    displacement: str
    mass: float  # of the particles [kg]
    carried: float  # load that is carried at rest [N]
    length: float  # of a communication step [s]
    slow: float  # in which the unit answers as at rest [s]


CASES = [
    Case("bonded block", "block.toml", "top.displacement.z", 1.2e-3, 10.0, 5e-5, 1e-3),
    Case("bed at rest", "bed.toml", "floor.displacement.z", 1.309, 12.841, 1e-3, 2e-2),
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/coupling_set"), help="folder of all results")
    parser.add_argument("--steps", type=int, default=10, help="communication steps in each load step")
    parser.add_argument("--exchanges", nargs="*", choices=list(EXCHANGES), help="all of them if not given")
    return parser.parse_args()


def course(unit, case, make, ratio, spring, count):
    """Evaluations of each step, steps that did not converge, interface energy, processor time [s]; or why it ended."""
    unit.reset()
    interface = Interface(unit, case.displacement)
    start = float(interface.force("end")[0])

    def load(now):
        steps = np.floor((now - 1e-9) / (count * case.length))
        return -start + SHARE * case.carried * max(steps, 0.0)

    partner = Oscillator(case.mass / ratio, spring, load=load)
    exchange = make(tolerance=Tolerance(None, force=1e-9 * case.carried))
    control = StepControl(unconverged="accept", halvings=0)
    coupling = Coupling(interface, partner, exchange, case.length, control=control)
    began = time.process_time()
    try:
        coupling.run(LOADS * count * case.length, progress=False)
    except CouplingStopped as refusal:
        return str(refusal)
    record, taken = coupling.record, time.process_time() - began
    share = record.interface_energy / max(record.exchanged_work, 1e-300)
    return record["evaluations"], len(record.unconverged), share, taken, getattr(exchange, "derivatives", 0)


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for case in CASES:
        path = Program(options.program).export(HERE / case.scene, options.output / f"{Path(case.scene).stem}.fmu")
        with Unit(path) as unit:
            stiff = float(stiffness(Interface(unit, case.displacement), case.slow, 1e-7)[0])
            print(f"{case.name}: {stiff:.4g} N/m in {case.slow} s", flush=True)
            for ratio in MASSES:
                for name in options.exchanges or EXCHANGES:
                    found = course(unit, case, EXCHANGES[name], ratio, stiff / STIFFNESS, options.steps)
                    if isinstance(found, str):
                        rows.append([case.name, ratio, name, *[""] * 8, found])
                        print(f"{name:14} masses {ratio:6g}: {found[:120]}", flush=True)
                        continue
                    counts, left, share, taken, asked = found
                    late = counts.reshape(LOADS, options.steps)[:, options.steps // 2 :]
                    rows.append([case.name, ratio, name, np.median(counts), counts.mean(), counts.max()])
                    rows[-1] += [np.median(late), left, share, asked, taken]
                    print(
                        f"{name:14} masses {ratio:6g}: median {np.median(counts):g}, mean {counts.mean():.2f}, most "
                        f"{counts.max():g}, late in a load step {np.median(late):g}; {left} not converged, interface "
                        f"{share:+.0e}, {asked} derivatives, {taken:.2f} s",
                        flush=True,
                    )
    columns = ["case", "mass_ratio", "exchange", "median", "mean", "most", "median_late", "unconverged", "interface"]
    with (options.output / "load_steps.csv").open("w", newline="") as text:
        csv.writer(text).writerows([[*columns, "derivatives", "processor", "said"], *rows])


if __name__ == "__main__":
    main()
