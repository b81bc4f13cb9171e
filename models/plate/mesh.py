"""The skins of the plate: meshes of triangles with shifted corners, so that they match no mesh of finite elements."""

from pathlib import Path

import numpy as np

SPAN = 0.12  # edge of the plate [m]
SKINS = {"coarse.obj": 8, "fine.obj": 36}  # cells along it


def write(path, cells):
    """Writes a skin of so many cells along an edge as OBJ."""
    grid = np.linspace(0.0, SPAN, cells + 1)
    x, y = (part.copy() for part in np.meshgrid(grid, grid, indexing="ij"))
    inside = (slice(1, -1), slice(1, -1))
    random = np.random.default_rng(1)
    for part in (x, y):
        part[inside] += 0.2 * SPAN / cells * random.uniform(-1.0, 1.0, part[inside].shape)
    lines = ["# The upper side of a plate, made by mesh.py; metres"]
    lines += [f"v {a:.6f} {b:.6f} 0.0" for a, b in zip(x.ravel(), y.ravel(), strict=True)]
    for i in range(cells):
        for j in range(cells):
            a, b = i * (cells + 1) + j + 1, (i + 1) * (cells + 1) + j + 1
            lines += [f"f {a} {b} {b + 1}", f"f {a} {b + 1} {a + 1}"]
    path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    for name, cells in SKINS.items():
        write(Path(__file__).with_name(name), cells)
