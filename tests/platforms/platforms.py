"""Steps every library of a unit that this machine can run, and compares them digit by digit.

    python tests/platforms/platforms.py UNIT.fmu [--compiler "python -m ziglang cc"]

The library for Linux runs in a small host written in C, the one for Windows in the same host under Wine. Both repeat
the experiment that the unit carries and get its numbers; then every displacement swings by a thousandth of its usual
magnitude, and they get the same numbers as each other. Nothing but Python, a C compiler and, for Windows, Wine is
needed: where Wine or a compiler for Windows is missing, that is said and the library is left out. Not in CI.
"""

import argparse
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

HERE = Path(__file__).parent
EXPERIMENT = "extra/org.fmi-standard.fmi-ls-ref"
#: Communication steps of the swing, and how long it takes to come back.
STEPS, PERIOD = 40, 8


class Host:
    """The host for one platform: how it is compiled, and how it is run."""

    def __init__(self, folder, platform, compiler):
        self.windows = platform == "win64"
        self.program = folder / ("host.exe" if self.windows else "host")
        options = ["-O1", "-o", self.program, HERE / "host.c", *([] if self.windows else ["-ldl"])]
        subprocess.run([*compiler, *options], check=True)
        if self.windows:
            stub = ["-shared", "-o", folder / "bcryptprimitives.dll", HERE / "bcryptprimitives.c", "-ladvapi32"]
            subprocess.run([*compiler, *stub], check=True)

    def run(self, unit, course):
        """Rows of outputs, as texts."""
        library = next((unit.folder / "binaries" / ("win64" if self.windows else "linux64")).iterdir())
        # Wine shows the root as Z:.
        resources = ("file:///Z:" if self.windows else "file://") + str(unit.folder / "resources")
        command = [*(["wine"] if self.windows else []), self.program, library, resources, unit.guid]
        # Wine's own library comes first, where it has one.
        environment = {**os.environ, "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "bcryptprimitives=b,n"}
        words = list(map(str, command))
        done = subprocess.run(words, input=course, capture_output=True, text=True, env=environment, check=False)
        if done.returncode:
            raise SystemExit(f"{library}: ended with {done.returncode}: {done.stderr.strip()}")
        return [line.split(",") for line in done.stdout.split()]


class Unit:
    """What its description says."""

    def __init__(self, path, folder):
        self.folder = folder
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        description = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.guid = description.get("guid")
        reals = [it for it in description.iter("ScalarVariable") if it.find("Real") is not None]
        self.inputs = [it for it in reals if it.get("causality") == "input"]
        self.outputs = [it for it in reals if it.get("causality") == "output"]
        with (folder / EXPERIMENT / "results.csv").open() as text:
            self.results = list(csv.DictReader(text))

    def course(self, length, rows):
        """The text for the host."""
        references = [it.get("valueReference") for it in self.inputs + self.outputs]
        values = [value for row in rows for value in row]
        head = [len(self.inputs), len(self.outputs), len(rows) - 1, repr(length)]
        return " ".join(map(str, [*head, *references, *values]))

    def at_rest(self):
        """The experiment that the unit carries."""
        with (self.folder / EXPERIMENT / "inputs.csv").open() as text:
            rows = list(csv.DictReader(text))
        names = [it.get("name") for it in self.inputs]
        return self.course(self.length, [[row[name] for name in names] for row in rows])

    def swing(self):
        """Every displacement goes to and fro by a thousandth of its usual magnitude; other inputs stay."""
        rows = []
        for step in range(STEPS + 1):
            share = (PERIOD / 2 - abs(step % PERIOD - PERIOD / 2)) / (PERIOD / 2)
            rows.append([repr(self.start(it) + share * self.reach(it)) for it in self.inputs])
        return self.course(self.length, rows)

    @property
    def length(self):
        """Length of a communication step [s]."""
        return float(self.results[1]["time"])

    @staticmethod
    def start(variable):
        """Its start value."""
        return float(variable.find("Real").get("start"))

    @staticmethod
    def reach(variable):
        """How far it swings."""
        moved = ".displacement." in variable.get("name")
        return 0.001 * float(variable.find("Real").get("nominal", 0.0)) if moved else 0.0


def differences(names, ours, theirs):
    """The first place where two lists of rows part, in words; nothing where they are the same."""
    for step, (one, other) in enumerate(zip(ours, theirs, strict=True)):
        for name, value, found in zip(names, one, other, strict=True):
            if float(value) != float(found):
                return f"step {step}, {name}: expected {value}, found {found}"
    return None


def compilers(given):
    """A command of each platform that can be run here."""
    usable = {}
    if sys.platform.startswith("linux"):
        usable["linux64"] = given or [next((name for name in ("cc", "gcc", "clang") if shutil.which(name)), "cc")]
    for_windows = [*given, "-target", "x86_64-windows-gnu"] if given else ["x86_64-w64-mingw32-gcc"]
    for needed in ("wine", for_windows[0]):
        if not shutil.which(needed):
            print(f"{needed}: not found; libraries for Windows are not stepped")
            return usable
    usable["win64"] = for_windows
    return usable


def main():
    """Every unit named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("units", nargs="+", type=Path, help="units, with a library for each platform")
    parser.add_argument("--compiler", default="", help="compiles C for this machine, and with -target for Windows")
    options = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory(prefix="cograin-") as name:
        folder = Path(name).resolve()
        hosts = {it: Host(folder, it, compiler) for it, compiler in compilers(options.compiler.split()).items()}
        for number, path in enumerate(options.units):
            unit = Unit(path, folder / str(number))
            columns = ["time", *(it.get("name") for it in unit.outputs)]
            # The experiment leaves out the nodes of meshes.
            kept = [(place, column) for place, column in enumerate(columns) if column in unit.results[0]]
            expected = [[row[column] for _, column in kept] for row in unit.results]
            first = None
            for platform, host in hosts.items():
                if not (unit.folder / "binaries" / platform).is_dir():
                    print(f"{path.name}: no library for {platform}")
                    continue
                rest = [[row[place] for place, _ in kept] for row in host.run(unit, unit.at_rest())]
                rows = host.run(unit, unit.swing())
                first = first or rows
                found = differences([column for _, column in kept], expected, rest) or differences(columns, first, rows)
                failed = failed or found is not None
                forces = [place for place, column in enumerate(columns) if ".force." in column]
                largest = max(forces, key=lambda place: abs(float(rows[-1][place])), default=1)
                same = f"same digits in {len(columns)} columns, {columns[largest]} {rows[-1][largest]} at the end"
                print(f"{path.name}, {platform}: {found or same}", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
