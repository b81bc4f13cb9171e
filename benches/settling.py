"""How many time steps `cograin settle` takes with its own damping, over those of the best damping chosen by hand, for kinds of scenes.

    python3 benches/settling.py [--count 1000] [--only NAME] [--damping 0.2 0.4 0.6 0.8] [--safety 0.8] [--seed 1] [--cograin FILE]

A line for each kind: steps of the default (for `bonded` iterations of Newton's method), steps of each damping, and the ratio of the default to the least. `-` did not settle; why is
told below the line.
"""

import argparse
import re
import subprocess
import tempfile
from pathlib import Path

HEAD = """
gravity = [0.0, 0.0, -9.81]
[run]
threads = 1
[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.5
friction = {friction}
rolling_friction = 0.1
rolling_viscous_damping = 0.3
"""
LAW = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n"
GRAINS = """
[particles.grains]
material = "glass"
packing = {{ box = [[0.0, 0.0, 0.0], [{side!r}, {side!r}, {height!r}]], solid_fraction = {fraction}, radius = [0.8e-3, 1.2e-3] }}
[boundary]
floor = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}, material = "glass" }}
left = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}, material = "glass" }}
right = {{ plane = {{ point = [{side!r}, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}, material = "glass" }}
front = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }}, material = "glass" }}
back = {{ plane = {{ point = [0.0, {side!r}, 0.0], normal = [0.0, -1.0, 0.0] }}, material = "glass" }}
"""
VOLUME = 4.0 / 3.0 * 3.141592653589793 * 1.04e-9  # of a grain, mean [m3]


def bed(fraction, friction=0.5, rolling=""):
    """A scene of about so many grains in a box half as high again as it is wide."""

    def text(count):
        solid = min(fraction, 0.6 if count >= 1000 else 0.55)  # walls keep a small bed looser
        side = (count * VOLUME / solid / 1.5) ** (1.0 / 3.0)
        law = LAW + (f"[contact.touch.rolling.{rolling}]\n" if rolling else "")
        return HEAD.format(friction=friction) + law + GRAINS.format(side=side, height=1.5 * side, fraction=solid)

    return text


def bonded(count):
    """A block of bonded spheres, four times as long as it is wide, of which one end is held: it sags."""
    wide = max(round((count / 4) ** (1.0 / 3.0)), 2)
    end = (4 * wide - 1) * 2e-3
    return (
        HEAD.format(friction=0.5)
        + f"""
[particles.block]
material = "glass"
lattice = {{ kind = "simple_cubic", radius = 1.0e-3, counts = [{4 * wide}, {wide}, {wide}] }}
[boundary.clamp]
particles = {{ set = "block", box = [[-1e-3, -1.0, -1.0], [1e-3, 1.0, 1.0]] }}
[bond.glue]
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e11
tangential_stiffness = 4.0e10
""",
        end,
    )[0]


KINDS = {
    "dense": bed(0.6),
    "dense, smooth": bed(0.6, friction=0.0),
    "loose": bed(0.4),
    "loose, epsd2": bed(0.4, rolling="epsd2"),
    "dense, epsd": bed(0.6, rolling="epsd"),
    "dense, cdt": bed(0.6, rolling="cdt"),
    "bonded": bonded,
}


def settle(options, scene, damping=None):
    """Steps until the scene is at rest, or none and why not."""
    command = [options.cograin, "settle", scene, "-o", scene.with_suffix(".cograin"), "--overwrite", "--quiet"]
    command += ["--set", f"run.safety={options.safety}"] if options.safety else []
    command += ["--set", f"run.settle_damping={damping}"] if damping is not None else []
    command += ["--steps", str(options.steps), "--set", f"run.seed={options.seed}"]
    done = subprocess.run([word for word in command if word != "--quiet"], capture_output=True, text=True, check=False)
    found = re.search(r"settled after (\d+) (?:step|iteration)", done.stdout)
    return (int(found[1]), "") if found else (None, done.stderr.strip().splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--only", default="")
    parser.add_argument("--damping", type=float, nargs="*", default=[0.1, 0.3, 0.5, 0.8, 0.9])
    parser.add_argument("--safety", type=float)
    parser.add_argument("--steps", type=int, default=200_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cograin", default=str(Path(__file__).resolve().parents[1] / "target/release/cograin"))
    options = parser.parse_args()
    print("| kind | default |", " | ".join(map(str, options.damping)), "| over the least |")
    for name, text in KINDS.items():
        if options.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.toml"
            scene.write_text(text(options.count))
            results = [settle(options, scene, damping) for damping in (None, *options.damping)]
        steps = [found for found, _ in results]
        least = min((found for found in steps if found), default=None)
        ratio = f"{steps[0] / least:.2f}" if steps[0] else "-"
        print(f"| {name} |", " | ".join(str(found or "-") for found in steps), f"| {ratio} |", flush=True)
        for why in dict.fromkeys(why for _, why in results if why):
            print(f"    {why}")


if __name__ == "__main__":
    main()
