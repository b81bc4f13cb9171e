"""One wheel brings the command, the library of units and the Python package, and needs nothing else of this tree."""

import os
import platform
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy
import pytest

from cograin import Program, ProgramError

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


def test_a_wheel_with_libraries_of_several_platforms_makes_units_for_all_of_them(program, tmp_path):
    own = Path(program.path).resolve().parent / "libcograin_fmu.so"
    if not own.is_file() or platform.machine() != "x86_64":
        pytest.skip("the header below is that of Linux on x86-64")
    # The same code with the number of another processor in its header (ELF: two bytes at 18; 183 is AArch64).
    other = bytearray(own.read_bytes())
    other[18:20] = (183).to_bytes(2, "little")
    for folder, library in (("x86_64-linux", own.read_bytes()), ("aarch64-linux", bytes(other))):
        (tmp_path / "made" / folder).mkdir(parents=True)
        (tmp_path / "made" / folder / own.name).write_bytes(library)
    words = [f"program={program.path}", f"libraries={tmp_path / 'made'}"]
    backend = [sys.executable, ROOT / "tools/build/backend.py", tmp_path, *words]
    wheel = tmp_path / subprocess.run(backend, check=True, capture_output=True, text=True).stdout.strip()
    # What pip does with programs and data: their folders go to bin and to the root of an environment.
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            if found := re.fullmatch(r"cograin-[^/]*\.data/(scripts|data)/(.*)", name):
                path = tmp_path / "env" / ("bin" if found[1] == "scripts" else "") / found[2]
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(archive.read(name))
                path.chmod(0o755)
    command = Program(tmp_path / "env" / "bin" / "cograin")
    command("new", "drop", "-o", tmp_path / "drop")
    scene, unit = tmp_path / "drop" / "scene.toml", tmp_path / "drop.fmu"
    for words, folders in (
        ([], {"linux64", "aarch64-linux"}),
        (["--fmi", "3", "--platform", "linux64"], {"x86_64-linux"}),
    ):
        command("export", scene, "-o", unit, "--overwrite", *words)
        with zipfile.ZipFile(unit) as archive:
            found = {name.split("/")[1] for name in archive.namelist() if name.startswith("binaries/")}
        assert found == folders, words
    with pytest.raises(ProgramError, match=r"\(aarch64-linux, linux64\), found win64"):
        command.export(scene, unit, platforms=["win64"])


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
