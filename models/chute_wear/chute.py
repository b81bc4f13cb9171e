"""The chute of scene.toml, and the picture of its wear.

python models/chute_wear/chute.py --write-mesh          # chute.stl
python models/chute_wear/chute.py --program target/release/cograin
"""

import argparse
import math
import struct
import subprocess
from pathlib import Path

import numpy as np

from cograin.plot import facets
from cograin.results import Run

HERE = Path(__file__).parent
DROP = [(0.0, 0.12), (0.10, 0.05)]  # the steep part, in the plane x z [m]
RADIUS, TURN = 0.06, 10  # of the bend [m], and its cells
WIDTH, ACROSS, ALONG = 0.04, 8, 8  # [m], cells


def profile():
    """The bottom of the chute: a steep plane, then a bend that leads to the level, then a level plane [m]."""
    (x0, z0), (x1, z1) = DROP
    steep = math.atan2(z0 - z1, x1 - x0)
    # The bend begins where the steep plane ends, with its slope.
    centre = (x1 + RADIUS * math.sin(steep), z1 + RADIUS * math.cos(steep))
    line = [(x0 + (x1 - x0) * k / ALONG, z0 + (z1 - z0) * k / ALONG) for k in range(ALONG)]
    angles = [steep * (1.0 - k / TURN) for k in range(TURN + 1)]
    bend = [(centre[0] - RADIUS * math.sin(a), centre[1] - RADIUS * math.cos(a)) for a in angles]
    level = [(bend[-1][0] + 0.08 * k / ALONG, bend[-1][1]) for k in range(1, ALONG + 1)]
    return line + bend + level


def write(path):
    """Writes the chute as triangles whose normals point up, and two sides."""
    bottom, side, high = profile(), 0.5 * WIDTH, 0.03
    corner = lambda k, y: np.array([bottom[k][0], y, bottom[k][1]])  # noqa: E731
    squares = []
    for k in range(len(bottom) - 1):
        for j in range(ACROSS):
            y = [-side + WIDTH * (j + n) / ACROSS for n in range(2)]
            squares.append([corner(k, y[0]), corner(k + 1, y[0]), corner(k + 1, y[1]), corner(k, y[1])])
        for y, turn in ((-side, 1), (side, -1)):
            up = np.array([0.0, 0.0, high])
            wall = [corner(k, y), corner(k, y) + up, corner(k + 1, y) + up, corner(k + 1, y)]
            squares.append(wall[::-turn])
    triangles = [triangle for a, b, c, d in squares for triangle in ((a, b, c), (a, c, d))]
    faces = (struct.pack("<12fH", 0.0, 0.0, 0.0, *np.concatenate(triangle), 0) for triangle in triangles)
    path.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + b"".join(faces))


def told(run):
    """What wore, and where."""
    frame = run.frames[-1]
    surfaces = frame.boundaries
    wear, depth = surfaces["wear"], surfaces["wear_depth"]
    centre = np.array([surfaces.points[cell].mean(axis=0) for cell in surfaces.cells])
    total = run.history["chute.wear"][-1]
    print(f"wear of the chute      {1e18 * total:.1f} µm³ in {frame.time:g} s; its facets {1e18 * wear.sum():.1f} µm³")
    print(f"deepest facet          {1e12 * depth.max():.3f} pm at x = {1e3 * centre[depth.argmax(), 0]:.0f} mm")
    for name, low, high in (("steep plane", -1.0, 0.10), ("bend", 0.10, 0.1345), ("level plane", 0.1345, 1.0)):
        part = wear[(centre[:, 0] > low) & (centre[:, 0] <= high)].sum() / wear.sum()
        print(f"{name:<22} {100 * part:.1f} % of the wear")


def main():
    """Runs the scene, tells the wear, draws it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="cograin")
    parser.add_argument("--output", type=Path, default=Path("out/chute_wear"))
    parser.add_argument("--write-mesh", action="store_true")
    arguments = parser.parse_args()
    if arguments.write_mesh:
        write(HERE / "chute.stl")
        return
    command = [arguments.program, "run", HERE / "scene.toml", "-o", arguments.output, "--overwrite"]
    subprocess.run(command, check=True)
    run = Run(arguments.output)
    told(run)
    facets(run.frames[-1], by="wear_depth", view="z").savefig(arguments.output / "chute_wear.png", dpi=110)


if __name__ == "__main__":
    main()
