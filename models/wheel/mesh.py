"""Writes wheel.obj: a rigid wheel with lugs, closed, its axis along y, its centre at the origin."""

import math
from pathlib import Path

RIM, LUG = 0.018, 0.021  # radii of the rim and of the tops of the lugs [m]
WIDTH = 0.016  # [m]
LUGS = 12
EVERY = 2.0 * math.pi / LUGS


def outline():
    """Corners of one side, in x and z, with the sun: rim and lugs in turn, two flat pieces of rim between two lugs."""
    corners = []
    for lug in range(LUGS):
        for share, radius in ((0.0, RIM), (0.06, LUG), (0.24, LUG), (0.3, RIM), (0.65, RIM)):
            angle = (lug + share) * EVERY
            corners.append((radius * math.sin(angle), radius * math.cos(angle)))
    return corners


def main():
    corners = outline()
    count = len(corners)
    lines = ["# A wheel with lugs, made by mesh.py; metres"]
    for y in (-0.5 * WIDTH, 0.5 * WIDTH):
        lines += [f"v {x:.9f} {y:.9f} {z:.9f}" for x, z in corners]
        lines.append(f"v 0.0 {y:.9f} 0.0")
    left, right = count + 1, 2 * count + 2
    for k in range(count):
        this, other = k + 1, (k + 1) % count + 1
        far, far_other = this + count + 1, other + count + 1
        lines += [f"f {this} {far_other} {far}", f"f {this} {other} {far_other}"]
        lines += [f"f {left} {other} {this}", f"f {right} {far} {far_other}"]
    Path(__file__).with_name("wheel.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
