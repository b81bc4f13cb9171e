"""How fast a flat-bottomed silo runs out: spheres per second through orifices of several diameters.

A silo is filled with spheres of 4 mm; they come to rest, then an orifice is opened and a flow meter counts. There are two silos:

narrow  64 mm, 5,000 spheres: the silo of which LIGGGHTS 3.8.0 emptied 456, 1265 and 2542 spheres per second through orifices of 4.5, 6
        and 7.5 diameters (48-sided meshes, one packing). Rates are fitted between a tenth and six tenths of the spheres.
wide    144 mm, 29,000 spheres: orifices of 6 to 15 diameters, of which the widest is 2.4 times narrower than the silo. Rates are fitted
        from 0.2 s after the opening, until 0.8 s or until four tenths of the spheres are out.

    python3 benches/silo.py [narrow | wide] [--orifices 4.5 6 7.5] [--seeds 0 1 2] [--shape revolved | meshed] [--cograin FILE]
    python3 benches/silo.py narrow --liggghts liggghts [--orifices 4.5 6 7.5] [--seeds 0 1 2]

With --liggghts the same packings come to rest and run out in LIGGGHTS (apt-get install liggghts), between the walls of --shape meshed
and with the same time step. Needs meshio.

Beverloo's law (Chem. Eng. Sci. 15 (1961) 260-269), W = C rho sqrt(g) (D - k d)^2.5, is fitted where there are three orifices or more.
"""

import argparse
import csv
import math
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

DIAMETER, DENSITY, GRAVITY = 4e-3, 2500.0, 9.81
SOLID_FRACTION = 0.55  # of the packing before it has come to rest
BULK_DENSITY = 1450.0  # of the bed at rest [kg/m3]
REST = 0.8  # how long the packing gets for that [s]
STEP = 2e-5  # half of the stable one [s]
SIDES = 48  # of the meshed silo
LIGGGHTS = {4.5: 456.0, 6.0: 1265.0, 7.5: 2542.0}  # spheres per second, narrow silo


@dataclass
class Silo:
    """Its size, and when its rate is fitted."""

    radius: float  # [m]
    height: float  # of the packing before it has come to rest [m]
    orifices: tuple  # [diameters of a sphere]
    counted: tuple  # from and to which part of the spheres
    after: float = 0.0  # from when, after the opening [s]
    until: float = math.inf  # and until when [s]


SILOS = {
    "narrow": Silo(32e-3, 94.7e-3, tuple(LIGGGHTS), (0.1, 0.6)),
    "wide": Silo(72e-3, 108e-3, (6.0, 8.0, 10.0, 12.0, 15.0), (0.0, 0.4), 0.2, 0.8),
}

HEAD = f"""
gravity = [0.0, 0.0, -{GRAVITY}]
[run]
end = END
step = {STEP}
seed = SEED
threads = 1
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
cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, HEIGHT], radius = PACKED }}
solid_fraction = {SOLID_FRACTION}
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


def revolved(silo, hole):
    """Wall and bottom as surfaces of revolution, exact; the orifice is closed if `hole` is 0."""
    shapes = [
        ("wall", f"cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.2], radius = {silo.radius} }}"),
        (
            "bottom",
            f"disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = {silo.radius + 1e-4}"
            + (f", hole = {hole} }}" if hole else " }"),
        ),
    ]
    return "".join(f'[boundary.{name}]\n{shape}\nmaterial = "glass"\n' for name, shape in shapes)


def ring(radius, height):
    """The corners of a polygon around the axis [m]."""
    turns = [2.0 * math.pi * side / SIDES for side in range(SIDES + 1)]
    return [(radius * math.cos(turn), radius * math.sin(turn), height) for turn in turns]


def between(one, other):
    """Triangles between two rings."""
    both = (((one[k], one[k + 1], other[k + 1]), (one[k], other[k + 1], other[k])) for k in range(SIDES))
    return [triangle for pair in both for triangle in pair]


def meshed(silo, hole, folder):
    """The same of triangles, as one STL file for each boundary."""
    low, high = ring(silo.radius, 0.0), ring(silo.radius, 0.2)
    if hole:
        bottom = between(ring(hole, 0.0), low)
    else:
        bottom = [((0.0, 0.0, 0.0), low[k], low[k + 1]) for k in range(SIDES)]
    parts = {"wall": between(low, high), "bottom": bottom}
    text = ""
    for name, triangles in parts.items():
        facets = (
            "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in triangle) + "endloop\nendfacet\n"
            for triangle in triangles
        )
        (folder / f"{name}.stl").write_text(f"solid {name}\n{''.join(facets)}endsolid {name}\n")
        text += f'[boundary.{name}]\nmesh = {{ file = "{name}.stl" }}\nmaterial = "glass"\n'
    return text


def slope(times, counts):
    """Of the line of least squares."""
    middle, mean = sum(times) / len(times), sum(counts) / len(counts)
    along = sum((time - middle) ** 2 for time in times)
    return sum((time - middle) * (count - mean) for time, count in zip(times, counts)) / along


def head_of(silo, shape, seed):
    """The scene without its walls, and the number of its spheres; END stands for its end."""
    # The polygon of a meshed wall is inside of the circle.
    packed = silo.radius * (math.cos(math.pi / SIDES) if shape == "meshed" else 1.0)
    head = HEAD.replace("SEED", str(seed)).replace("PACKED", repr(packed)).replace("HEIGHT", repr(silo.height))
    return head, SOLID_FRACTION * math.pi * packed**2 * silo.height / (math.pi / 6.0 * DIAMETER**3)


def lasts(silo, diameters, spheres):
    """How long an orifice is open [s]."""
    expected = LIGGGHTS.get(diameters, 34.0 * (diameters - 1.4) ** 2.5)
    return min(silo.until, (silo.counted[1] + 0.1) * spheres / expected)


def fitted(silo, spheres, passed):
    """Spheres per second of rows of time after the opening [s] and spheres that are out."""
    least, most = (part * spheres for part in silo.counted)
    return slope(*zip(*((time, count) for time, count in passed if time > silo.after and least < count < most)))


def call(command, folder=None):
    """Runs a program; ends with what it says if it fails. Returns what it says."""
    done = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    return done.stdout


def run_scene(program, folder, name, text, *options):
    """Runs a scene, whose results are in the folder of its name."""
    scene = folder / f"{name}.toml"
    scene.write_text(text)
    call([program, "run", scene, "-o", folder / name, "--overwrite", *options])


class Filled:
    """A silo full of spheres at rest, of which orifices are opened."""

    def __init__(self, program, silo, shape, seed, folder):
        self.program, self.silo, self.shape, self.folder = program, silo, shape, folder
        self.head, self.spheres = head_of(silo, shape, seed)
        run_scene(program, folder, "fill", self.head.replace("END", str(REST)) + self.surfaces(0.0))

    def surfaces(self, hole):
        """The boundaries of the scene."""
        return meshed(self.silo, hole, self.folder) if self.shape == "meshed" else revolved(self.silo, hole)

    def rate(self, diameters):
        """Spheres per second through an orifice of so many diameters."""
        silo = self.silo
        end = REST + lasts(silo, diameters, self.spheres)
        text = self.head.replace("END", str(end)) + self.surfaces(diameters * DIAMETER / 2) + OUT
        run_scene(self.program, self.folder, "flow", text, "--from", self.folder / "fill" / "checkpoint.cograin")
        rows = list(csv.DictReader((self.folder / "flow" / "history.csv").open()))
        return fitted(silo, self.spheres, [(float(row["time"]) - REST, float(row["orifice.count"])) for row in rows])


DECK = f"""atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
SPHERES
neighbor 0.001 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
fix wall all mesh/surface file wall.stl type 1
fix BOTTOM all mesh/surface file bottom.stl type 1
fix walls all wall/gran model hertz tangential history mesh n_meshes 2 meshes wall BOTTOM
fix g all gravity {GRAVITY} vector 0 0 -1
fix integrate all nve/sphere
timestep {STEP!r}
thermo_style custom step atoms ke
thermo_modify lost ignore norm no
thermo 1000
run STEPS
"""


class Peer:
    """The same silo in LIGGGHTS, between meshes: what has fallen out of the domain is counted."""

    def __init__(self, program, cograin, silo, seed, folder):
        import meshio

        self.program, self.silo, self.folder = program, silo, folder
        head, self.spheres = head_of(silo, "meshed", seed)
        walls = meshed(silo, 0.0, folder)
        run_scene(cograin, folder, "start", head.replace("END", repr(STEP)) + f"frame_interval = {STEP!r}\n" + walls)
        points = meshio.read(folder / "start" / "particles_000000.vtu").points.tolist()
        side = silo.radius + 0.01
        text = f"spheres\n\n{len(points)} atoms\n1 atom types\n\n{-side} {side} xlo xhi\n{-side} {side} ylo yhi\n"
        text += "-0.02 0.25 zlo zhi\n\nAtoms\n\n"
        rows = (f"{number} 1 {DIAMETER} {DENSITY} {x!r} {y!r} {z!r}\n" for number, (x, y, z) in enumerate(points, 1))
        (folder / "spheres.data").write_text(text + "".join(rows))
        self.run("read_data spheres.data", "bottom", REST, "write_restart full.restart\n")

    def run(self, spheres, bottom, time, then=""):
        """Runs a deck for a time [s]; returns rows of steps and spheres."""
        deck = DECK.replace("SPHERES", spheres).replace("BOTTOM", bottom).replace("STEPS", str(round(time / STEP)))
        (self.folder / "deck.in").write_text(deck + then)
        words = (line.split() for line in call([self.program, "-in", "deck.in", "-log", "none"], self.folder).splitlines())
        return [(int(row[0]), int(row[1])) for row in words if len(row) == 3 and row[0].isdigit() and row[1].isdigit()]

    def rate(self, diameters):
        """Spheres per second through an orifice of so many diameters."""
        meshed(self.silo, diameters * DIAMETER / 2, self.folder)
        # A mesh of the name that it had when the silo was full would be the closed bottom.
        rows = self.run("read_restart full.restart", "orifice", lasts(self.silo, diameters, self.spheres))
        passed = [((step - rows[0][0]) * STEP, rows[0][1] - spheres) for step, spheres in rows]
        return fitted(self.silo, self.spheres, passed)


def beverloo(rates):
    """C and k of the line W^(2/5) over D, and how far the rate that is furthest from it is away, as a part of the line."""
    mass = DENSITY * math.pi / 6.0 * DIAMETER**3
    places = [diameters * DIAMETER for diameters in rates]
    roots = [(found * mass) ** 0.4 for found in rates.values()]
    line = slope(places, roots)
    start = sum(roots) / len(roots) - line * sum(places) / len(places)
    furthest = max(abs(root / (start + line * place) - 1.0) for place, root in zip(places, roots))
    return line**2.5 / (BULK_DENSITY * math.sqrt(GRAVITY)), -start / line / DIAMETER, furthest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("silo", choices=list(SILOS), nargs="?", default="narrow")
    parser.add_argument("--cograin", metavar="FILE", default=str(Path(__file__).resolve().parents[1] / "target/release/cograin"))
    parser.add_argument("--orifices", metavar="D", type=float, nargs="+")
    parser.add_argument("--seeds", metavar="N", type=int, nargs="+", default=[0])
    parser.add_argument("--liggghts", metavar="FILE", help="the program of that name, which runs in place of cograin")
    parser.add_argument("--shape", choices=["revolved", "meshed"], default="revolved")
    options = parser.parse_args()
    silo = SILOS[options.silo]
    rates = {diameters: [] for diameters in options.orifices or silo.orifices}
    for seed in options.seeds:
        with tempfile.TemporaryDirectory() as folder:
            if options.liggghts:
                filled = Peer(options.liggghts, options.cograin, silo, seed, Path(folder))
            else:
                filled = Filled(options.cograin, silo, options.shape, seed, Path(folder))
            print(f"seed {seed}, {filled.spheres:.0f} spheres", flush=True)
            for diameters, found in rates.items():
                found.append(filled.rate(diameters))
                print(f"  {diameters} d: {found[-1]:.0f} per second", flush=True)
    means = {diameters: sum(found) / len(found) for diameters, found in rates.items()}
    for diameters, mean in means.items():
        spread = max(rates[diameters]) - min(rates[diameters])
        peer = f", {mean / LIGGGHTS[diameters] - 1.0:+.1%} of the first packing in LIGGGHTS" if options.silo == "narrow" and diameters in LIGGGHTS else ""
        print(f"{diameters} d: mean {mean:.0f} per second, spread {spread:.0f}{peer}")
    if len(means) > 2:
        print("C = {:.3f}, k = {:.2f}, furthest from the line {:.2%}".format(*beverloo(means)))


if __name__ == "__main__":
    main()
