"""Steps every library of a unit that this machine can run, and compares them digit by digit.

    python tests/platforms/platforms.py UNIT.fmu [--programs FOLDER --scene SCENE] [--compiler "python -m ziglang cc"]

A small host written in C steps the library for Linux, under QEMU that for Linux on Arm, and under Wine that for
Windows. All repeat the experiment that a unit of FMI 2.0 carries and get its numbers; then every displacement swings by
a thousandth of its usual magnitude, and they get the same numbers as each other. `--programs` names a folder with the
command for each platform, in a folder of its own: all run the scene, and leave the same bytes. What a platform lacks
(Wine, QEMU, a compiler) is said, and the platform left out. Not in CI.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from units import Unit, differences

HERE = Path(__file__).parent


class Platform:
    """A kind of machine: its names, what compiles C for it here, and what runs its programs."""

    def __init__(self, name, folder, compiler, runner=()):
        self.name = name  # as FMI 3.0 and zig have it
        self.folder = folder  # in a unit of FMI 2.0
        self.compiler = [compiler]
        self.runner = list(runner)
        self.windows = name.endswith("windows")

    def missing(self):
        """What must be installed to run its programs, if anything."""
        return next((it for it in [*self.runner[:1], self.compiler[0]] if not shutil.which(it)), None)

    def path(self, path):
        """A path as its programs have it: Wine shows the root as Z:."""
        return "Z:" + str(path).replace("/", "\\") if self.windows else str(path)

    def run(self, program, *words, **options):
        """Runs a program of the platform; ends where it fails."""
        # Wine's own library comes first, where it has one.
        environment = {**os.environ, "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "bcryptprimitives=b,n"}
        command = [*self.runner, str(program), *map(str, words)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False, **options)
        if done.returncode:
            raise SystemExit(f"{' '.join(command)}: ended with {done.returncode}: {done.stderr.strip()}")
        return done.stdout


PLATFORMS = [
    Platform("x86_64-linux", "linux64", "cc"),
    Platform(
        "aarch64-linux", "aarch64-linux", "aarch64-linux-gnu-gcc", ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"]
    ),
    Platform("x86_64-windows", "win64", "x86_64-w64-mingw32-gcc", ["wine"]),
]


def usable(compiler):
    """The platforms whose programs can be run here."""
    for platform in PLATFORMS:
        if compiler:
            platform.compiler = [*compiler, "-target", f"{platform.name}-gnu"]
        if missing := platform.missing():
            print(f"{platform.name}: {missing} not found; left out")
        else:
            yield platform


class Host:
    """The host for one platform, compiled."""

    def __init__(self, folder, platform):
        self.platform = platform
        self.folder = folder / platform.name
        self.folder.mkdir()
        self.program = self.folder / ("host.exe" if platform.windows else "host")
        self.compile("-O1", "-o", self.program, HERE / "host.c", *([] if platform.windows else ["-ldl"]))
        if platform.windows:
            stub = self.folder / "bcryptprimitives.dll"
            self.compile("-shared", "-o", stub, HERE / "bcryptprimitives.c", "-ladvapi32")

    def compile(self, *words):
        """Calls the compiler."""
        subprocess.run([*self.platform.compiler, *words], check=True)

    def step(self, unit, library, course):
        """Rows of outputs, as texts."""
        path = self.platform.path
        address = "file://" + str(unit.folder / "resources")
        if self.platform.windows:
            address = "file:///Z:" + str(unit.folder / "resources")
        # FMI 3.0 takes a path that ends with a separator.
        resources = address if unit.edition == 2 else path(f"{unit.folder / 'resources'}/")
        words = [unit.edition, path(library), resources, unit.token]
        return [line.split(",") for line in self.platform.run(self.program, *words, input=course).split()]


def step_all(unit, hosts):
    """Steps the libraries of a unit; says for each what it found, and whether any differs."""
    failed, first = False, None
    for host in hosts:
        name = host.platform.name if unit.edition == 3 else host.platform.folder
        if not (unit.folder / "binaries" / name).is_dir():
            print(f"{unit.path.name}: no library for {name}")
            continue
        library = next((unit.folder / "binaries" / name).iterdir())
        rows = host.step(unit, library, unit.swing())
        first = first or rows
        found = differences(unit.columns, first, rows)
        if not found and unit.results:
            # The experiment leaves out the nodes of meshes.
            kept = [(place, column) for place, column in enumerate(unit.columns) if column in unit.results[0]]
            expected = [[row[column] for _, column in kept] for row in unit.results]
            rest = [[row[place] for place, _ in kept] for row in host.step(unit, library, unit.at_rest())]
            found = differences([column for _, column in kept], expected, rest)
        failed = failed or found is not None
        forces = [place for place, column in enumerate(unit.columns) if "force" in column]
        largest = max(forces, key=lambda place: abs(float(rows[-1][place])), default=1)
        end = f"{unit.columns[largest]} {rows[-1][largest]} at the end"
        same = f"same digits in {len(unit.columns)} columns and {len(rows)} rows, {end}"
        print(f"{unit.path.name}, {name}: {found or same}", flush=True)
    return failed


def run_all(programs, scene, hosts):
    """Runs a scene with the command of each platform; says which files differ, and whether any does."""
    failed, first = False, None
    for host in hosts:
        platform = host.platform
        program = programs / platform.name / ("cograin.exe" if platform.windows else "cograin")
        if not program.is_file():
            print(f"{program}: not there; left out")
            continue
        # Windows looks for libraries beside the program.
        own = Path(shutil.copy(program, host.folder))
        out = host.folder / "out"
        platform.run(own, "run", platform.path(scene), "-o", platform.path(out), "--quiet")
        # The summary has wall times.
        files = {path.name: path.read_bytes() for path in sorted(out.iterdir()) if path.name != "summary.json"}
        first = files if first is None else first
        other = sorted(name for name in {**first, **files} if first.get(name) != files.get(name))
        failed = failed or bool(other)
        size = sum(map(len, files.values()))
        told = f"other bytes in {', '.join(other)}" if other else f"the same {size} bytes in {len(files)} files"
        print(f"{platform.name}, run {scene}: {told}", flush=True)
    return failed


def main():
    """Every unit named, and the programs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("units", nargs="+", type=Path, help="units, with a library for each platform")
    parser.add_argument("--programs", type=Path, help="a folder with the command for each platform")
    parser.add_argument("--scene", type=Path, help="what they run")
    parser.add_argument("--compiler", default="", help="compiles C for this machine, and with -target for others")
    options = parser.parse_args()
    if bool(options.programs) != bool(options.scene):
        parser.error("expected --programs and --scene together")
    failed = False
    with tempfile.TemporaryDirectory(prefix="cograin-") as name:
        folder = Path(name).resolve()
        hosts = [Host(folder, platform) for platform in usable(options.compiler.split())]
        for number, path in enumerate(options.units):
            failed = step_all(Unit(path, folder / str(number)), hosts) or failed
        if options.programs:
            failed = run_all(options.programs.resolve(), options.scene.resolve(), hosts) or failed
    return failed


if __name__ == "__main__":
    sys.exit(main())
