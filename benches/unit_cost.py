#!/usr/bin/env python3
"""What a unit costs beside its time steps: fmi2DoStep, fmi2GetReal, states, units that come and go.

  cargo build --release && benches/unit_cost.py [SCENE ...]

A small host in C (unit_cost.c, built with cc) calls the unit's library directly, so nothing of an importer is measured. Each
figure is the least processor time of several repeats. "Over the engine" is what one call of one time step takes more than a hundredth of a
call of a hundred. Without scenes: the smallest (two spheres, one held), models/ice_beam, 10,000 spheres, and 1,000
units with two threads each in one process, one after the other and side by side; at last, counted by valgrind, 20,000 spheres beside
`cograin run`.
"""

import argparse
import re
import subprocess
import tempfile
import zipfile
from pathlib import Path

import peer_scenes
from regions import instructions

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (50, 150)  # time steps of the short and the long run that are counted: set-up is removed
PROGRAM = ROOT / "target/release/cograin"

SMALLEST = """
[run]
end = 1.0
step = 1.0e-5
threads = 1

[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3

[pair.glass.glass]
restitution = 0.9

[contact.touch.normal.hertz]

[particles.pair]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.0, 0.0, 0.02], radius = 0.01 }]

[boundary.grip]
particles = { set = "pair", box = [[-1.0, -1.0, 0.015], [1.0, 1.0, 1.0]] }
motion = { driven = ["z"] }
"""

LATTICE = """
[run]
end = 1.0
step = 1.0e-6
threads = THREADS

[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3

[pair.glass.glass]
restitution = 0.5
friction = 0.4

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.bed]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.01, spacing = 0.01999, origin = [0.0, 0.0, 0.0], counts = COUNTS }

[boundary.floor]
particles = { set = "bed", box = [[-1.0, -1.0, -1.0], [100.0, 100.0, 0.005]] }
motion = { driven = ["z"] }
"""


def lattice(counts, threads):
    """A block of touching spheres."""
    return LATTICE.replace("COUNTS", str(counts)).replace("THREADS", str(threads))


def build(folder):
    """The host."""
    host = folder / "unit_cost"
    source = Path(__file__).with_name("unit_cost.c")
    subprocess.run(["cc", "-O2", "-o", host, source, "-ldl"], check=True)
    return host


def unpack(folder, scene):
    """The unit of a scene: what the host has to know of it."""
    unit = folder / f"{scene.stem}.fmu"
    subprocess.run([PROGRAM, "export", scene, "-o", unit, "--overwrite"], check=True)
    place = folder / scene.stem
    with zipfile.ZipFile(unit) as archive:
        archive.extractall(place)
    text = (place / "modelDescription.xml").read_text()
    guid = re.search(r'guid="([^"]+)"', text)[1]
    library = next((place / "binaries/linux64").glob("*.so"))
    output = re.search(r'name="[^"]+\.force\.z" valueReference="(\d+)"', text)[1]
    step = re.search(r"^step = ([\d.e+-]+)", scene.read_text(), re.MULTILINE)[1]
    return library, place / "resources", guid, step, output


def measure(host, folder, scene, steps, many=0):
    """What calls of the unit of a scene cost: a figure for each name."""
    *unit, output = unpack(folder, scene)
    command = [host, *unit, str(steps), output, str(many)]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\n")
    return {name: float(value) for name, value in (line.split() for line in lines if line)}


def report(title, found):
    """A table of what was measured."""
    engine = found["step_100"] / 100
    over = found["step_1"] - engine
    print(f"\n{title}")
    print(f"  fmi2DoStep of 1, 10, 100 time steps {found['step_1']:.3f}, {found['step_10']:.3f}, {found['step_100']:.3f} us")
    print(f"  one step over the engine            {over:.3f} us ({100 * over / engine:.1f} %)")
    print(f"  fmi2GetReal, of 10,000 values       {found['value']:.2f} ns each; one alone {found['read_one']:.3f} us")
    print(
        f"  state, {found['bytes']:.0f} bytes: get {found['get_state']:.1f} us, over an old one {found['get_state_again']:.1f} us, "
        f"set {found['set_state']:.1f} us, to bytes {found['serialize']:.1f} us, from bytes {found['deserialize']:.1f} us"
    )
    if "threads" in found:
        print(
            f"  memory after a tenth of the units {found['memory_after_tenth']:.0f} kB, after all {found['memory_after_all']:.0f} kB; "
            f"{found['threads']:.0f} thread"
        )
        print(f"  as many side by side: {found['memory_together']:.0f} kB, {found['threads_together']:.0f} threads")


def beside_run(host, folder):
    """Instructions of a time step of 20,000 spheres: `cograin run`, and the unit with 10 time steps in each call."""
    scene, length = peer_scenes.Scene("s1_20k", COUNTS), 10
    runs = {steps: [str(PROGRAM), *peer_scenes.cograin(scene, steps, 1, folder), "--overwrite"] for steps in COUNTS}
    *unit, output = unpack(folder, folder / f"{COUNTS[0]}.toml")
    calls = {steps: [str(host), *map(str, unit), str(steps), output, "0", str(length)] for steps in COUNTS}
    short, long = COUNTS
    alone, called = (
        (instructions(of[long], folder) - instructions(of[short], folder)) / (long - short) for of in (runs, calls)
    )
    print(f"\n20,000 spheres, {length} time steps in each call")
    print(f"  a time step of cograin run {alone / 1e6:.3f}, of the unit {called / 1e6:.3f} million instructions ({100 * (called / alone - 1):+.2f} %)")


def main():
    """The scenes that are named, or those of the docs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", type=Path)
    scenes = parser.parse_args().scene
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        host = build(folder)
        for scene in scenes:
            report(scene, measure(host, folder, scene.resolve(), 2000))
        if scenes:
            return
        texts = [
            ("smallest", "two spheres, one held", SMALLEST, 500000, 0),
            ("block", "10,000 spheres in contact", lattice([25, 20, 20], 1), 200, 0),
            ("many", "1,000 units of 4,096 spheres with two threads each", lattice([16, 16, 16], 2), 200, 1000),
        ]
        for stem, title, text, steps, many in texts:
            (folder / f"{stem}.toml").write_text(text)
            report(title, measure(host, folder, folder / f"{stem}.toml", steps, many))
        report("models/ice_beam", measure(host, folder, ROOT / "models/ice_beam/scene.toml", 2000))
        beside_run(host, folder)


if __name__ == "__main__":
    main()
