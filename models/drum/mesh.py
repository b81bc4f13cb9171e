"""The drum of scene.toml as a mesh of facets."""

import math

RADIUS, ENDS = 0.04, (-0.001, 0.013)  # as in scene.toml [m]


def facets(path, count):
    """Writes a pipe of so many facets, inwards, as OBJ; the mean of its inner and outer radius is that of the drum."""
    outer = 2.0 * RADIUS / (1.0 + math.cos(math.pi / count))
    angles = [2.0 * math.pi * k / count for k in range(count)]
    lines = [f"v {x!r} {outer * math.cos(a)!r} {outer * math.sin(a)!r}" for a in angles for x in ENDS]
    for k in range(count):
        near, next_one = 2 * k + 1, 2 * ((k + 1) % count) + 1
        lines.append(f"f {near} {near + 1} {next_one + 1} {next_one}")
    path.write_text("\n".join(lines) + "\n")


def with_mesh(scene, count, folder):
    """Writes the scene with such a mesh in the place of its profile into a folder; gives its path."""
    facets(folder / "drum.obj", count)
    lines = scene.read_text().splitlines()
    place = next(number for number, line in enumerate(lines) if line.startswith("revolution"))
    lines[place] = 'mesh = { file = "drum.obj" }\nreference = [0.0, 0.0, 0.0]'
    path = folder / "mesh.toml"
    path.write_text("\n".join(lines) + "\n")
    return path
