"""Makes the wheel: the command, the library of units and the Python package, in one.

What `pip install .` calls (PEP 517). The command and the library are built by cargo, unless they are built already and
named: `--config-settings program=PATH`, or the environment variable COGRAIN_PROGRAM; the library is then the one beside
it. `libraries=FOLDER` takes the libraries in its folders instead, each of which has the name of a platform.
`--config-settings platform=TAG` names another platform than that of this machine.

An editable wheel has the Python package alone: whoever changes the tree builds the command with cargo.
"""

import base64
import hashlib
import json
import os
import stat
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
INFORMATION = f"{NAME}.dist-info"
LICENSES = ["LICENSE-MIT", "LICENSE-APACHE", "fmu/library/third_party.txt"]
# Names of the library of units on Linux, macOS and Windows.
LIBRARIES = ["libcograin_fmu.so", "libcograin_fmu.dylib", "cograin_fmu.dll"]
# The same bytes whenever it is made: the earliest time that a zip file knows.
TIME = (1980, 1, 1, 0, 0, 0)


def get_requires_for_build_wheel(config_settings=None):
    """Nothing but Python and cargo."""
    return []


get_requires_for_build_sdist = get_requires_for_build_editable = get_requires_for_build_wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """What the wheel will say of itself: pip asks for it first, and need not wait for cargo."""
    for path, data in information(tag(config_settings or {})).items():
        place = Path(metadata_directory) / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)
    return INFORMATION


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The whole wheel."""
    settings = config_settings or {}
    named = settings.get("program") or os.environ.get("COGRAIN_PROGRAM")
    program = built_before(Path(named)) if named else built_now()
    folder = settings.get("libraries")
    libraries = libraries_below(ROOT / folder) if folder else {"": library_in(program.parent)}
    python = ROOT / "python"
    package = [path for path in sorted(python.glob("cograin/**/*")) if path.is_file() and path.suffix != ".pyc"]
    files = {path.relative_to(python).as_posix(): path.read_bytes() for path in package}
    programs = {f"{NAME}.data/scripts/{program.name}": program.read_bytes()}
    for platform, library in libraries.items():
        place = PurePosixPath(f"{NAME}.data/data/lib/cograin", platform, library.name)
        programs[str(place)] = library.read_bytes()
    return write(Path(wheel_directory), tag(settings), files, programs)


def tag(settings):
    """Which Python and which machines the wheel is for."""
    platform = settings.get("platform") or sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"py3-none-{platform}"


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """A wheel that points to the package in this tree."""
    return write(Path(wheel_directory), "py3-none-any", {"cograin.pth": f"{ROOT / 'python'}\n".encode()}, {})


def build_sdist(sdist_directory, config_settings=None):
    """Everything that is kept under version control."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout
    path = Path(sdist_directory) / f"{NAME}.tar.gz"
    with tarfile.open(path, "w:gz") as archive:
        for name in filter(None, listed.decode().split("\0")):
            archive.add(ROOT / name, f"{NAME}/{name}", recursive=False)
        information = Path(sdist_directory) / "PKG-INFO"
        information.write_text(metadata(), encoding="utf-8")
        archive.add(information, f"{NAME}/PKG-INFO")
        information.unlink()
    return path.name


def built_now():
    """The program, built by cargo with the library beside it."""
    cargo = os.environ.get("CARGO", "cargo")
    command = [cargo, "build", "--release", "--locked", "--package", "cograin-command", "--package", "cograin-fmu"]
    try:
        subprocess.run(command, cwd=ROOT, check=True)
    except FileNotFoundError:
        raise SystemExit(
            "cargo: not found; install Rust 1.95 or later (rustup.rs), or take a wheel that tools/release has made"
        ) from None
    except subprocess.CalledProcessError:
        raise SystemExit("cargo did not build the program; its reasons stand above") from None
    described = subprocess.run(
        [cargo, "metadata", "--format-version", "1", "--no-deps"], cwd=ROOT, check=True, capture_output=True
    )
    folder = Path(json.loads(described.stdout)["target_directory"]) / "release"
    return folder / ("cograin.exe" if os.name == "nt" else "cograin")


def built_before(program):
    """The program at a path from the root."""
    program = ROOT / program
    if not program.is_file():
        raise SystemExit(f"{program}: expected the cograin command, found no file")
    return program


def library_in(folder):
    """The library of units in a folder."""
    found = [folder / name for name in LIBRARIES if (folder / name).is_file()]
    if not found:
        raise SystemExit(f"{folder}: expected the library of units, found none of {', '.join(LIBRARIES)}")
    return found[0]


def libraries_below(folder):
    """The libraries of units in the folders of a folder, by the names of those."""
    found = {path.parent.name: path for name in LIBRARIES for path in sorted(folder.glob(f"*/{name}"))}
    if not found:
        raise SystemExit(f"{folder}: expected folders with libraries of units, found none of {', '.join(LIBRARIES)}")
    return found


def metadata():
    """What the wheel says of itself."""
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {PROJECT['name']}",
        f"Version: {PROJECT['version']}",
        f"Summary: {PROJECT['description']}",
        f"Requires-Python: {PROJECT['requires-python']}",
        f"License-Expression: {PROJECT['license']}",
        *(f"License-File: {Path(path).name}" for path in LICENSES),
        *(f"Requires-Dist: {requirement}" for requirement in PROJECT["dependencies"]),
    ]
    for extra, requirements in PROJECT["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {requirement}; extra == "{extra}"' for requirement in requirements]
    lines += ["Description-Content-Type: text/markdown", "", (ROOT / PROJECT["readme"]).read_text(encoding="utf-8")]
    return "\n".join(lines)


def information(tag):
    """The files of the wheel that tell of it."""
    pure = "true" if tag.endswith("any") else "false"
    wheel = f"Wheel-Version: 1.0\nGenerator: cograin\nRoot-Is-Purelib: {pure}\nTag: {tag}\n"
    return {
        **{f"{INFORMATION}/licenses/{Path(path).name}": (ROOT / path).read_bytes() for path in LICENSES},
        f"{INFORMATION}/METADATA": metadata().encode(),
        f"{INFORMATION}/WHEEL": wheel.encode(),
    }


def write(folder, tag, files, programs):
    """Writes the wheel with these files, and with programs that may be run."""
    files = {**files, **information(tag)}
    record = "".join(f"{path},sha256={digest(data)},{len(data)}\n" for path, data in {**files, **programs}.items())
    files[f"{INFORMATION}/RECORD"] = f"{record}{INFORMATION}/RECORD,,\n".encode()
    path = folder / f"{NAME}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for mode, entries in ((0o755, programs), (0o644, files)):
            for name, data in entries.items():
                entry = zipfile.ZipInfo(name, TIME)
                entry.external_attr = (stat.S_IFREG | mode) << 16
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, data)
    return path.name


def digest(data):
    """As RECORD has it."""
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


if __name__ == "__main__":  # python tools/build/backend.py FOLDER [KEY=VALUE ...]: the wheel without pip
    print(build_wheel(sys.argv[1], dict(word.split("=", 1) for word in sys.argv[2:])))
