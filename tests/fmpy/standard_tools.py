"""Every model as a unit in tools that are programs of their own: by hand, since no package of Python brings them.

    python tests/fmpy/standard_tools.py --program target/release/cograin \\
        --checker .../fmuCheck.linux64 --fmusim .../fmusim --fmi-sim .../fmi-sim

Prints the table of docs/fmu.md; a tool whose program is not named is left out. Each tool steps the unit by the course
of conftest.py, with inputs from a file. Outputs at every communication point are compared with those that fmpy gets,
in all the digits that the tool writes; fmusim also writes the unit's state at the end, which is compared byte for
byte. Ends with 1 where a tool finds something or a digit differs.

The tools: FMUComplianceChecker with FMI Library 2.0.3, which also judges `modelDescription.xml`; fmusim as it was in
the last revision of Reference-FMUs that held it; fmi-sim 0.7.0, a package of the registry of Rust.
"""

import argparse
import csv
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from cograin import Unit
from conftest import COURSES, MODELS, ROOT, Course, given


def sums(interval, steps):
    """Communication points of a clock that sums up intervals."""
    times = [0.0]
    for _ in range(steps):
        times.append(times[-1] + interval)
    return times


def multiples(interval, steps):
    """Communication points of a clock that multiplies."""
    return [step * interval for step in range(steps + 1)]


@dataclass
class Tool:
    """A program that steps units."""

    name: str
    option: str  # of this script, for its program
    digits: int  # that it writes; 17 are all of them
    clock: Callable  # its communication points: inputs between two rows would be interpolated
    command: Callable  # its arguments, of (unit, inputs, interval, end, folder)
    remarks: Callable  # warnings and errors, of what it said


def counted(said):
    """Warnings and errors in the summary of FMUComplianceChecker: of the unit, and its own."""
    return sum(map(int, re.findall(r"(\d+) (?:warning|Warning|Error)", said))) if "FMU check summary" in said else 1


def complained(said):
    """Lines of warnings and errors."""
    return len(re.findall(r"(?im)^.*\b(?:warn|warning|error|fatal|panicked)\b.*$", said))


TOOLS = [
    Tool(
        "FMUComplianceChecker",
        "checker",
        17,
        sums,
        lambda unit, inputs, interval, end, folder: (
            [*"-k cs -l 3 -n 0 -h".split(), repr(interval), "-s", repr(end), "-o", folder / "out.csv"]
            + [*(["-i", inputs] if inputs else []), unit]
        ),
        counted,
    ),
    Tool(
        "fmusim",
        "fmusim",
        16,
        multiples,
        lambda unit, inputs, interval, end, folder: (
            [*"--interface-type cs --logging-on --log-level warning --output-interval".split(), repr(interval)]
            + ["--stop-time", repr(end), "--final-fmu-state-file", folder / "state"]
            + ["--output-file", folder / "out.csv", *(["--input-file", inputs] if inputs else []), unit]
        ),
        complained,
    ),
    Tool(
        "fmi-sim",
        "fmi_sim",
        17,
        multiples,
        lambda unit, inputs, interval, end, folder: (
            ["-v", "--model", unit, "-o", folder / "out.csv", *(["-i", inputs] if inputs else []), "co-simulation"]
            + ["--step", repr(interval), "--output-interval", repr(interval), "-f", repr(end)]
        ),
        complained,
    ),
]


def course_of(model):
    """The course of conftest.py; fmusim takes times that are 10 µs apart for the same, so steps are longer."""
    course = COURSES.get(model, Course(interval=1e-3, steps=60))
    return Course(max(course.interval, 2e-5), course.steps, course.amplitude)


def with_fmpy(path, course, times=None):
    """Names of inputs and outputs, outputs at every communication point, and the state at the end, as bytes.

    The state holds the speed of a boundary, which follows from the length of the last step: where it is asked for, each
    length is the difference of these times, as the tool makes it.
    """
    with Unit(path) as unit:
        names, inputs = unit.names("output"), unit.names("input")
        values = [[given(name, course.displacement(step)) for name in inputs] for step in range(course.steps)]
        unit.reset(inputs=dict(zip(inputs, values[0], strict=True)))
        rows = [[unit[name] for name in names]]
        for step, row in enumerate(values):
            if inputs:
                unit.set(inputs, row)
            unit.step(times[step + 1] - times[step] if times else course.interval, until=times and times[step + 1])
            rows.append([unit[name] for name in names])
        return inputs, names, rows, unit.serialise(unit.save())


def write_inputs(path, names, course, times):
    """The course as a file, whose path it gives: each row holds until the next communication point."""
    with path.open("w", newline="\n") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["time", *names])
        for step, time in enumerate(times):
            rows.writerow([repr(time), *(repr(float(given(name, course.displacement(step)))) for name in names)])
    return path


def first_difference(names, ours, path, digits):
    """Where the tool's values are not those of fmpy, to the digits that it writes; `None` if nowhere."""
    if not path.is_file():
        return "wrote no outputs"
    rows = list(csv.reader(path.open()))
    if len(rows) != len(ours) + 1:
        return f"{len(rows) - 1} rows for {len(ours)} communication points"
    places = [rows[0].index(name) for name in names]
    for step, (row, other) in enumerate(zip(ours, rows[1:], strict=True)):
        for name, value, place in zip(names, row, places, strict=True):
            if float(f"{value:.{digits}g}") != float(other[place]):
                return f"step {step}, {name}: fmpy {value!r}, the tool {other[place]}"
    return None


def with_tool(tool, program, path, course, expected):
    """What is found in one run, in words; nothing is right."""
    inputs, names, rows, _state = expected
    with tempfile.TemporaryDirectory(prefix="cograin-") as name:
        folder = Path(name)
        times = tool.clock(course.interval, course.steps)
        driven = write_inputs(folder / "in.csv", inputs, course, times) if inputs else None
        command = [program, *tool.command(path, driven, course.interval, times[-1], folder)]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, cwd=folder)
        said = done.stdout + done.stderr
        found = [f"ended with {done.returncode}"] if done.returncode else []
        if remarks := tool.remarks(said):
            found.append(f"{remarks} remarks: {said.strip()[-400:]}")
        if difference := first_difference(names, rows, folder / "out.csv", tool.digits):
            found.append(difference)
        state = folder / "state"
        if state.is_file() and state.read_bytes() != with_fmpy(path, course, times)[-1]:
            found.append("another state at the end")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/cograin", help="the cograin command")
    for tool in TOOLS:
        parser.add_argument(f"--{tool.option.replace('_', '-')}", type=Path, help=f"program of {tool.name}")
    given_programs = vars(parser.parse_args())
    tools = [(tool, given_programs[tool.option]) for tool in TOOLS if given_programs[tool.option]]
    if not tools:
        parser.error("expected --checker, --fmusim or --fmi-sim with the path of its program, found none of them")
    print("| model | communication steps | outputs |", " | ".join(f"{tool.name}" for tool, _ in tools), "|")
    print("|---|---|---|" + "---|" * len(tools))
    failed = []
    with tempfile.TemporaryDirectory(prefix="cograin-") as folder:
        for model in MODELS:
            path = Path(folder) / f"{model}.fmu"
            scene = ROOT / "models" / model / "scene.toml"
            subprocess.run([given_programs["program"], "export", scene, "-o", path, "--overwrite"], check=True, capture_output=True)
            course = course_of(model)
            expected = with_fmpy(path, course)
            cells = []
            for tool, program in tools:
                found = with_tool(tool, program, path, course, expected)
                failed += [f"{model}, {tool.name}: {what}" for what in found]
                cells.append("differs" if found else "nothing found, same digits")
            steps = f"{course.steps} of {course.interval:g} s"
            print(f"| `{model}` | {steps} | {len(expected[1])} |", " | ".join(cells), "|", flush=True)
    print(*failed, sep="\n", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
