#!/usr/bin/env python3
"""A block of 6,000 spheres with 17,000 bonds and overlaps under each contact policy: user CPU time of a time step.

Set-up is removed by two numbers of steps, each the least of the repeats.
"""

import argparse
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STEP = 2.0e-7  # [s]
SCENE = """
[run]
end = {end!r}
step = {step!r}
threads = {threads}
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "ice"
lattice = {{ kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [20, 20, 15], spacing = 2.0e-3, radius = 1.01e-3 }}
[bond.glue]
formulation = "incremental"
between = ["bed", "bed"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
contact = "{policy}"
"""


def user_time(command, folder):
    """User CPU time of a command [s]."""
    before = os.times().children_user
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return os.times().children_user - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--threads", metavar="N", type=int, default=1)
    parser.add_argument("--repeats", metavar="N", type=int, default=4)
    options = parser.parse_args()
    counts = (100, 700)
    for policy in ("parallel", "without_normal", "none"):
        with tempfile.TemporaryDirectory() as name:
            least = []
            for count in counts:
                text = SCENE.format(end=count * STEP, step=STEP, threads=options.threads, policy=policy)
                Path(name, "scene.toml").write_text(text)
                command = [options.cograin, "run", "scene.toml", "-o", "out", "--overwrite"]
                least.append(min(user_time(command, name) for _ in range(options.repeats)))
        print(f"{policy}: {(least[1] - least[0]) / (counts[1] - counts[0]) * 1e6:.0f} µs a step", flush=True)


if __name__ == "__main__":
    main()
