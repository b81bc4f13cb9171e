"""How fast a flat-bottomed silo runs out: spheres per second through orifices of several diameters.

A silo of 64 mm is filled with 5,000 spheres of 4 mm; they come to rest, then the orifice is opened and a flow meter counts. Rates are
fitted between a tenth and six tenths of the spheres. LIGGGHTS 3.8.0 gave 456, 1265 and 2542 per second for the same silo of 48-sided
meshes, at 4.5, 6 and 7.5 diameters.

    python3 benches/silo.py [--cograin FILE] [--orifices 4.5 6 7.5] [--seed 0] [--shape revolved | meshed]

Beverloo's law (Chem. Eng. Sci. 15 (1961) 260-269), W = C rho sqrt(g) (D - k d)^2.5, is fitted where there are three orifices or more.
"""

import argparse
import csv
import math
import subprocess
import tempfile
from pathlib import Path

DIAMETER, SILO, DENSITY, GRAVITY = 4e-3, 64e-3, 2500.0, 9.81
HEIGHT = 94.7e-3  # of the packing before it has come to rest [m]
REST = 0.8  # how long it gets for that [s]
SIDES = 48  # of the meshed silo
LIGGGHTS = {4.5: 456.0, 6.0: 1265.0, 7.5: 2542.0}  # spheres per second

HEAD = f"""
gravity = [0.0, 0.0, -{GRAVITY}]
[run]
end = END
step = 1e-5
seed = SEED
[material.glass]
youngs_modulus = 5e6
poissons_ratio = 0.25
density = {DENSITY}
[pair.glass.glass]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.grains]
material = "glass"
[particles.grains.packing]
cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, {HEIGHT}], radius = PACKED }}
solid_fraction = 0.55
radius = [{DIAMETER / 2}, {DIAMETER / 2}]
[output]
history_interval = 0.02
"""

OUT = """
[outlet.below]
beyond = { point = [0.0, 0.0, -0.02], normal = [0.0, 0.0, 1.0] }
[flow_meter.orifice]
polygon = [[-0.04, -0.04, -0.006], [-0.04, 0.04, -0.006], [0.04, 0.04, -0.006], [0.04, -0.04, -0.006]]
"""


def revolved(hole, closed):
    """Wall and bottom as surfaces of revolution, exact; a gate closes the orifice."""
    shapes = [
        ("wall", f"cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.2], radius = {SILO / 2} }}"),
        ("bottom", f"disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = {SILO / 2 + 1e-4}, hole = {hole} }}"),
    ]
    if closed:
        shapes.append(("gate", f"disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = {hole} }}"))
    return "".join(f'[boundary.{name}]\n{shape}\nmaterial = "glass"\n' for name, shape in shapes)


def ring(radius, height):
    """The corners of a polygon around the axis [m]."""
    turns = [2.0 * math.pi * side / SIDES for side in range(SIDES + 1)]
    return [(radius * math.cos(turn), radius * math.sin(turn), height) for turn in turns]


def between(one, other):
    """Triangles between two rings."""
    both = (((one[k], one[k + 1], other[k + 1]), (one[k], other[k + 1], other[k])) for k in range(SIDES))
    return [triangle for pair in both for triangle in pair]


def meshed(hole, closed, folder):
    """The same of triangles, as one STL file for each boundary."""
    low, high, inner = ring(SILO / 2, 0.0), ring(SILO / 2, 0.2), ring(hole, 0.0)
    parts = {"wall": between(low, high), "bottom": between(inner, low)}
    if closed:
        parts["gate"] = [((0.0, 0.0, 0.0), inner[k], inner[k + 1]) for k in range(SIDES)]
    text = ""
    for name, triangles in parts.items():
        facets = (
            "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in triangle) + "endloop\nendfacet\n"
            for triangle in triangles
        )
        (folder / f"{name}.stl").write_text(f"solid {name}\n{''.join(facets)}endsolid {name}\n")
        text += f'[boundary.{name}]\nmesh = {{ file = "{name}.stl" }}\nmaterial = "glass"\n'
    return text


def run(program, scene, folder, *options):
    """Runs a scene; ends with what the program says if it refuses."""
    done = subprocess.run([program, "run", scene, "-o", folder, *options], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)


def slope(times, counts):
    """Of the line of least squares."""
    middle, mean = sum(times) / len(times), sum(counts) / len(counts)
    along = sum((time - middle) ** 2 for time in times)
    return sum((time - middle) * (count - mean) for time, count in zip(times, counts)) / along


def rate(program, diameters, shape, seed, folder):
    """Spheres per second through an orifice of so many diameters, and how many spheres there were."""
    hole = diameters * DIAMETER / 2
    # The polygon of a meshed wall is inside of the circle.
    packed = SILO / 2 * (math.cos(math.pi / SIDES) if shape == "meshed" else 1.0)

    def surfaces(closed):
        return meshed(hole, closed, folder) if shape == "meshed" else revolved(hole, closed)

    text = HEAD.replace("SEED", str(seed)).replace("PACKED", repr(packed))
    fill, flow = folder / "fill.toml", folder / "flow.toml"
    fill.write_text(text.replace("END", str(REST)) + surfaces(True))
    run(program, fill, folder / "fill")
    expected = LIGGGHTS.get(diameters, 4.0 * (diameters - 1.4) ** 2.5 * 8.5)
    flow.write_text(text.replace("END", str(REST + 0.7 * 5000.0 / expected)) + surfaces(False) + OUT)
    run(program, flow, folder / "flow", "--from", folder / "fill" / "checkpoint.cograin")
    rows = list(csv.DictReader((folder / "flow" / "history.csv").open()))
    passed = [(float(row["time"]), float(row["orifice.count"])) for row in rows]
    all_of_them = 0.55 * math.pi * packed**2 * HEIGHT / (math.pi / 6.0 * DIAMETER**3)
    steady = [(time, count) for time, count in passed if 0.1 * all_of_them < count < 0.6 * all_of_them]
    return slope(*zip(*steady)), all_of_them


def beverloo(rates):
    """C and k of the line W^(2/5) over D."""
    mass = DENSITY * math.pi / 6.0 * DIAMETER**3
    bulk = 1450.0  # of the bed [kg/m3]
    places = [diameters * DIAMETER for diameters in rates]
    roots = [(found * mass) ** 0.4 for found in rates.values()]
    line = slope(places, roots)
    start = sum(roots) / len(roots) - line * sum(places) / len(places)
    return line**2.5 / (bulk * math.sqrt(GRAVITY)), -start / line / DIAMETER


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(Path(__file__).resolve().parents[1] / "target/release/cograin"))
    parser.add_argument("--orifices", metavar="D", type=float, nargs="+", default=list(LIGGGHTS))
    parser.add_argument("--seed", metavar="N", type=int, default=0)
    parser.add_argument("--shape", choices=["revolved", "meshed"], default="revolved")
    options = parser.parse_args()
    rates = {}
    for diameters in options.orifices:
        with tempfile.TemporaryDirectory() as folder:
            found, count = rate(options.cograin, diameters, options.shape, options.seed, Path(folder))
        rates[diameters] = found
        peer = f", {found / LIGGGHTS[diameters] - 1.0:+.1%} of LIGGGHTS'" if diameters in LIGGGHTS else ""
        print(f"{diameters} d, {count:.0f} spheres: {found:.0f} per second{peer}", flush=True)
    if len(rates) > 2:
        print("C = {:.3f}, k = {:.2f}".format(*beverloo(rates)))


if __name__ == "__main__":
    main()
