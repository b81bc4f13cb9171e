"""One wheel brings the command, the library of units and the Python package, and needs nothing else of this tree."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def wheel(program, tmp_path_factory):
    """The wheel, with the program that the other tests use."""
    folder = tmp_path_factory.mktemp("wheel")
    backend = [sys.executable, ROOT / "tools/build/backend.py", folder, f"program={program.path}"]
    return folder / subprocess.run(backend, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture(scope="module")
def environment(wheel, tmp_path_factory):
    """The folder of programs of a fresh environment in which it is installed."""
    folder = tmp_path_factory.mktemp("environment") / "env"
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    programs = folder / ("Scripts" if os.name == "nt" else "bin")
    install = [programs / "python", "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", wheel]
    subprocess.run(install, check=True, capture_output=True)
    return programs


def test_it_names_every_file_and_every_licence(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        record = archive.read(next(name for name in names if name.endswith("RECORD"))).decode()
    assert {line.split(",")[0] for line in record.splitlines()} == set(names)
    for wanted in (
        "scripts/cograin",
        "licenses/third_party.txt",
        "cograin/py.typed",
        "cograin/study.py",
        "libcograin_fmu",
    ):
        assert any(wanted in name for name in names), wanted


def test_pip_hears_before_the_build_what_the_wheel_says(wheel, tmp_path):
    ask = "import sys, backend; print(backend.prepare_metadata_for_build_wheel(sys.argv[1]))"
    path = {**os.environ, "PYTHONPATH": str(ROOT / "tools/build")}
    asked = [sys.executable, "-c", ask, tmp_path]
    name = subprocess.run(asked, check=True, capture_output=True, text=True, env=path).stdout.strip()
    with zipfile.ZipFile(wheel) as archive:
        for file in ("METADATA", "WHEEL"):
            assert (tmp_path / name / file).read_bytes() == archive.read(f"{name}/{file}"), file


def test_the_command_makes_units_without_anything_else(environment, tmp_path):
    def cograin(*words):
        bare = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "COGRAIN", "PATH"))}
        done = subprocess.run([environment / "cograin", *words], cwd=tmp_path, env=bare, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert cograin("--version").startswith("cograin ")
    cograin("new", "drop")
    cograin("export", "drop/scene.toml", "-o", "drop.fmu")
    assert (tmp_path / "drop.fmu").stat().st_size > 100_000


def test_the_package_finds_the_command_that_came_with_it(environment, tmp_path):
    # What the package needs comes from the environment of the tests, which has another copy of it nowhere on this path.
    needed = str(Path(numpy.__file__).resolve().parents[1])
    (tmp_path / "fall.py").write_text(
        "import cograin\n"
        "program = cograin.Program()\n"
        "print(cograin.__file__, program.path, sep='\\n')\n"
        "program('new', 'drop')\n"
        "with cograin.Unit(program.export('drop/scene.toml', 'drop.fmu')) as unit:\n"
        "    unit.step(1e-3)\n"
        "    print(unit.time)\n"
    )
    clean = {**os.environ, "PYTHONPATH": needed}
    done = subprocess.run([environment / "python", "fall.py"], cwd=tmp_path, env=clean, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    package, command, time = done.stdout.split("\n")[:3]
    assert package.startswith(str(environment.parent)) and command.startswith(str(environment)) and time == "0.001"
