"""Friction and rolling friction of grains from an angle of repose and an oedometer curve, with their uncertainty.

A study runs both tests over a grid of the coefficients. Quadratic surfaces through its results stand for the tests, and
`scipy.optimize.least_squares` finds where they meet what was measured. What the surfaces miss, chance of the packings
included, and the errors of the measurement make the uncertainty.
"""

import argparse
import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from cograin.results import read_table
from cograin.study import SceneRun, Study, grid
from scipy.optimize import least_squares

HERE = Path(__file__).resolve().parent
KEYS = ("pair.grain.grain.friction", "pair.grain.grain.rolling_friction")
AREA, HEIGHT = 0.02 * 0.02, 0.02  # of the lid [m²], of the box [m]
STRESSES = (2e3, 10e3, 30e3)  # at which the void ratio is read [Pa]


def heap(run):
    """The mean slope of the heap [°], from the middle of the grains and their spread, so that each of them counts.

    A wedge of height h and half width b has its middle at h/3 and the variance b²/6 of x.
    """
    grains = run.frames[-1].particles
    volume = grains["radius"].ravel() ** 3
    x, z = (grains.points[:, axis] for axis in (0, 2))
    middle = np.average(x, weights=volume)
    spread = np.average((x - middle) ** 2, weights=volume)
    return {"angle": math.degrees(math.atan(3.0 * np.average(z, weights=volume) / math.sqrt(6.0 * spread)))}


def oedometer(run):
    """Void ratios at each of the stresses."""
    history, course = run.history, read_table(HERE / "press.csv")
    grains = 4.0 / 3.0 * math.pi * float(np.sum(run.frames[-1].particles["radius"].ravel() ** 3))
    height = HEIGHT + np.interp(history["time"], course["time"], course["lid.displacement.z"])
    # The lid only goes down; the largest stress so far is passed once.
    stress = np.maximum.accumulate(history["lid.force.z"] / AREA)
    if stress[-1] < STRESSES[-1]:
        raise ValueError(f"expected a stress of {STRESSES[-1]:g} Pa, found at most {stress[-1]:g} Pa")
    found = np.interp(STRESSES, stress, AREA * height / grains - 1.0)
    return {f"void_ratio_{level / 1e3:g}": ratio for level, ratio in zip(STRESSES, found, strict=True)}


@dataclass
class BothTests:
    """What is done with a row of the study: both tests."""

    program: str = "cograin"

    def runs(self):
        """Both tests by name."""
        press = ("--inputs", HERE / "press.csv")
        return {
            "heap": SceneRun(HERE / "heap.toml", read=heap, program=self.program),
            "oedometer": SceneRun(HERE / "oedometer.toml", read=oedometer, program=self.program, options=press),
        }

    def identity(self, row):
        """What makes their results, so that kept ones count as long as it is the same."""
        return {f"{name}.{key}": value for name, run in self.runs().items() for key, value in run.identity(row).items()}

    def __call__(self, row):
        """Angle and void ratios."""
        return {key: value for run in self.runs().values() for key, value in run(row).items()}


def terms(friction, rolling):
    """Terms of a quadratic surface."""
    return np.array([np.ones_like(friction), friction, rolling, friction**2, friction * rolling, rolling**2])


@dataclass
class Surface:
    """A result over the two coefficients, and the scatter of the runs about it."""

    weights: np.ndarray
    scatter: float

    @classmethod
    def through(cls, friction, rolling, values):
        """By least squares."""
        columns = terms(friction, rolling).T
        weights = np.linalg.lstsq(columns, values, rcond=None)[0]
        free = max(len(values) - columns.shape[1], 1)
        return cls(weights, math.sqrt(float(np.sum((columns @ weights - values) ** 2)) / free))

    def __call__(self, point):
        """The result at a point."""
        return float(self.weights @ terms(*point))


def calibrate(columns, measured):
    """Coefficients and their covariance, from the columns of a study and {name: (value, standard error)}."""
    points = [np.array(columns[key], dtype=float) for key in KEYS]
    surfaces = {name: Surface.through(*points, np.array(columns[name], dtype=float)) for name in measured}
    errors = {name: math.hypot(error, surfaces[name].scatter) for name, (_, error) in measured.items()}

    def residuals(point):
        return np.array([(surfaces[name](point) - value) / errors[name] for name, (value, _) in measured.items()])

    low, high = ([pick(each) for each in points] for pick in (np.min, np.max))
    starts = [
        np.array([one, other]) for one in np.linspace(low[0], high[0], 4) for other in np.linspace(low[1], high[1], 4)
    ]
    inside = [np.clip(start, np.add(low, 1e-9), np.subtract(high, 1e-9)) for start in starts]
    best = min((least_squares(residuals, start, bounds=(low, high)) for start in inside), key=lambda found: found.cost)
    return best.x, np.linalg.pinv(best.jac.T @ best.jac), 2.0 * best.cost


def read_measured(path):
    """What was measured: name, value and standard error a row."""
    with open(path, newline="") as text:
        return {row["name"]: (float(row["value"]), float(row["standard_error"])) for row in csv.DictReader(text)}


def measure(work, folder, seeds):
    """The stand-in of a laboratory: the tests with coefficients of which the calibration knows nothing."""
    rows = grid(**{KEYS[0]: [0.45], KEYS[1]: [0.12], "run.seed": seeds})
    table = Study(rows, work, folder).run(shown=True)
    found = {name: np.array([result.values[name] for result in table]) for name in table[0].values}
    return {name: (values.mean(), values.std(ddof=1) / math.sqrt(len(values))) for name, values in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument(
        "--output", type=Path, default=Path("out/calibration"), help="folder of the study; continues it"
    )
    parser.add_argument("--measured", type=Path, default=HERE / "measured.csv", help="name, value and standard_error")
    parser.add_argument("--measure", action="store_true", help="make measured.csv anew by runs with other seeds")
    parser.add_argument("--seeds", type=int, default=1, help="packings for each pair of coefficients")
    options = parser.parse_args()
    work = BothTests(options.program)
    if options.measure:
        found = measure(work, options.output / "laboratory", [101, 102])
        lines = [f"{name},{value:.4f},{error:.4f}\n" for name, (value, error) in found.items()]
        options.measured.write_text("".join(["name,value,standard_error\n", *lines]))
    seeds = list(range(1, options.seeds + 1))
    rows = grid(**{KEYS[0]: [0.1, 0.3, 0.5, 0.8], KEYS[1]: [0.0, 0.1, 0.25], "run.seed": seeds})
    study = Study(rows, work, options.output)
    failed = [result for result in study.run() if result.failed]
    for result in failed:
        print(f"{result.row}: {result.error}")
    done = [place for place, error in enumerate(study.columns["error"]) if not error]
    columns = {name: [values[place] for place in done] for name, values in study.columns.items()}
    point, covariance, misfit = calibrate(columns, read_measured(options.measured))
    deviations = np.sqrt(np.diag(covariance))
    for name, value, deviation in zip(("friction", "rolling friction"), point, deviations, strict=True):
        print(f"{name}: {value:.3f} ± {deviation:.3f}")
    print(
        f"correlation {covariance[0, 1] / deviations.prod():+.2f}, misfit {misfit:.1f} of {len(STRESSES) - 1} expected"
    )


if __name__ == "__main__":
    main()
