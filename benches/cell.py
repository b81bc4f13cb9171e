"""A periodic cell of a few hundred grains, strained in cograin and beside it in another program.

    python benches/cell.py lammps --program target/release/cograin --peer lmp      a minute
    python benches/cell.py yade --program target/release/cograin --peer yade       three minutes

The grains are pressed to 100 kPa by cograin; both programs begin with these places, at rest. Then the cell is pressed
together by 1 % along each axis, or sheared at constant volume until it has been written anew twice (shear 1.2).
The tables tell how far the stress is apart (largest component, over the mean pressure), how many contacts both have,
and how far grains are apart (largest, over the mean radius).
"""

import argparse
import csv
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import meshio
import numpy as np

STIFFNESS, SHEAR_STIFFNESS, DAMPING, FRICTION, DENSITY = 1.0e5, 5.0e4, 1.0e4, 0.4, 2500.0
QUIET = 0.2  # Cundall's damping beside YADE
STEP, SAMPLES = 1e-6, 60  # time step [s]; how often results are compared
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
PRESS, SHEAR = {"xx": -1.0, "yy": -1.0, "zz": -1.0}, {"xy": 10.0}  # rates [1/s]


class Case(NamedTuple):
    """A strain path."""

    name: str
    rates: dict  # of each component [1/s]
    most: float  # strain at the end
    rough: bool = False  # with friction
    wide: float = 1.0  # edges over those of the pressed cell; above 1 the grains are a gas

    def end(self):
        """Its duration [s]."""
        return self.most / max(abs(rate) for rate in self.rates.values())

    def strain(self, part):
        """Strains after a part of the path."""
        return {name: rate * self.end() * part for name, rate in self.rates.items()}

    def gradient(self):
        """Rates as the gradient of the velocity."""
        gradient = np.zeros((3, 3))
        for name, rate in self.rates.items():
            gradient[PLACES[COMPONENTS.index(name)]] = rate
        return gradient


CASES = [
    Case("compression without friction", PRESS, 6e-4),
    Case("shear without friction", SHEAR, 6e-3),
    Case("gas that is sheared", {"xy": 300.0}, 0.9, wide=1.6),
    Case("compression with friction", PRESS, 0.012, rough=True),
    Case("shear with friction", SHEAR, 1.2, rough=True),
]

SCENE = """
[run]
end = {end!r}
step = {step}
scheme = "engine"
max_overlap = 0.2
threads = 1
[material.sand]
density = {density!r}
[pair.sand.sand]
normal_stiffness = {stiffness!r}
{pair}
[contact.touch.normal.hooke_stiffness]
{law}
[particles.sand]
material = "sand"
{particles}
[cell]
edges = {edges}
motion = {{ {motion} }}
[output]
history_interval = {interval!r}
frame_interval = {interval!r}
{more}
"""
LAMMPS = """units si
atom_style sphere
boundary p p p
newton off
comm_modify vel yes
box tilt large
read_data cell.data
neighbor 0.0003 bin
neigh_modify delay 0 every 1 check yes
pair_style gran/hooke/history {law}
pair_coeff * *
timestep {step}
fix move all nve/sphere
fix strain all deform 1 {strain} remap {remap}
compute thermal all temp{deform}
compute stress all pressure thermal
compute touching all contact/atom
compute touches all reduce sum c_touching
thermo {every}
thermo_style custom step c_stress[1] c_stress[2] c_stress[3] c_stress[4] c_stress[5] c_stress[6] c_touches
thermo_modify format float %20.15g norm no
dump all all custom {every} cell.dump id x y z
dump_modify all sort id format float %20.15g
run {steps}
"""
YADE = """
import numpy as np
rows = np.loadtxt("grains.csv", delimiter=",", skiprows=1)
O.periodic = True
O.cell.hSize = Matrix3({edges})
sand = O.materials.append(FrictMat(density={density!r}))
kn, ks, angle = (MatchMaker(matches=((0, 0, value),)) for value in ({kn!r}, {ks!r}, {angle!r}))
O.bodies.append([utils.sphere(row[:3], row[3], material=sand) for row in rows])
O.dt = {step}
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.15e-3),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False)],
        [Ip2_FrictMat_FrictMat_FrictPhys(kn=kn, ks=ks, frictAngle=angle)],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping={damping!r}),
]
O.cell.velGrad = Matrix3({gradient})
told = []
for sample in range({samples} + 1):
    if sample:
        O.run({every}, True)
    stress = getStress()
    touching = sum(1 for pair in O.interactions if pair.isReal and pair.geom.penetrationDepth > 0.0)
    stress = 0.5 * (stress + stress.transpose())
    told.append([stress[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))] + [touching])
    np.savetxt("yade_%d.txt" % sample, [list(body.state.pos) for body in O.bodies], "%.17g")
np.savetxt("yade.txt", told, "%.17g")
"""


def strained(edges, strain):
    """Edges (columns) after strains from none: stretches first, then shears."""
    stretch = np.exp([strain.get(name, 0.0) for name in ("xx", "yy", "zz")])
    shear = np.eye(3)
    shear[0, 1], shear[0, 2], shear[1, 2] = (strain.get(name, 0.0) for name in ("xy", "xz", "yz"))
    return shear @ np.diag(stretch) @ edges


def frames(folder):
    """Frames of a run of cograin."""
    return [meshio.read(path) for path in sorted(folder.glob("particles_*.vtu"))]


def history(folder):
    """Columns of its history."""
    with open(folder / "history.csv") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def run(program, folder, name, **values):
    """Runs a scene of cograin."""
    values = {"density": DENSITY, "stiffness": STIFFNESS, "step": repr(STEP), "more": "", **values}
    (folder / f"{name}.toml").write_text(SCENE.format(**values))
    inputs = ["--inputs", f"{name}.csv"] if (folder / f"{name}.csv").exists() else []
    command = [program, "run", f"{name}.toml", "-o", name, "--overwrite", "--quiet", *inputs]
    subprocess.run([str(part) for part in command], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def pressed(program, folder):
    """Places and radii of grains at 100 kPa, and the edges of their cell (columns)."""
    side = 0.0142
    box = "[[0.0, 0.0, 0.0], [0.014, 0.014, 0.014]]"
    packing = f"packing = {{ box = {box}, solid_fraction = 0.55, radius = [0.8e-3, 1.2e-3] }}"
    servo = ", ".join(f"{name} = {{ stress = -1e5, max_rate = 5.0 }}" for name in COMPONENTS[:3])
    run(
        program,
        folder,
        "pressed",
        end=0.05,
        step='"auto"',
        pair=f"normal_damping = {DAMPING!r}",
        law="",
        particles=packing,
        edges=np.diag([side] * 3).tolist(),
        motion=f"servo = {{ {servo} }}",
        interval=0.05,
        more="[damping.quiet]\nlinear = 0.4\nangular = 0.4\ngravity_damped = false\napplied_forces_damped = false",
    )
    last, course = frames(folder / "pressed")[-1], history(folder / "pressed")
    edges = strained(np.diag([side] * 3), {name: course[f"cell.strain.{name}"][-1] for name in COMPONENTS[:3]})
    return last.points, last.point_data["radius"], edges


class Course:
    """Stress, contacts and places of one program, sample by sample."""

    def __init__(self, stress, contacts, places):
        self.stress, self.contacts, self.places = np.array(stress), np.array(contacts), places


def own(program, folder, case, pair, law, edges, more=""):
    """The course in cograin."""
    names = list(case.rates)
    rows = [[0.0] * (len(names) + 1), [case.end(), *case.strain(1.0).values()]]
    text = ",".join(["time", *(f"cell.strain.{name}" for name in names)])
    (folder / "own.csv").write_text("\n".join([text, *(",".join(map(repr, row)) for row in rows), ""]))
    motion = f"driven = {names}".replace("'", '"')
    values = {"end": case.end(), "interval": case.end() / SAMPLES, "pair": pair, "law": law, "more": more}
    run(program, folder, "own", edges=edges.T.tolist(), motion=motion, particles='file = "grains.csv"', **values)
    found = history(folder / "own")
    stress = np.column_stack([found[f"cell.stress.{name}"] for name in COMPONENTS])
    return Course(stress, found["contacts.count"], [frame.points for frame in frames(folder / "own")])


def compare(case, what, own, peer, edges, radius):
    """Prints how far both are apart."""
    print(f"{case.name}: {what}")
    print("  strain  pressure kPa  shear kPa  stress apart  contacts  of the peer  grains apart")
    for sample in range(SAMPLES // 6, SAMPLES + 1, SAMPLES // 6):
        now = strained(edges, case.strain(sample / SAMPLES))
        apart = np.linalg.solve(now, (own.places[sample] - peer.places[sample]).T)
        apart -= np.round(apart)
        apart -= apart.mean(axis=1, keepdims=True)  # edges go out from a corner, in LAMMPS from the middle
        apart = np.linalg.norm(now @ apart, axis=0).max() / np.mean(radius)
        pressure = -own.stress[sample, :3].mean()
        stress = np.abs(own.stress[sample] - peer.stress[sample]).max() / pressure
        print(
            f"  {case.most * sample / SAMPLES:6.4f}  {pressure / 1e3:12.3f}  {own.stress[sample, 3] / 1e3:9.3f}"
            f"  {stress:12.1e}  {own.contacts[sample]:8.0f}  {peer.contacts[sample]:11.0f}  {apart:12.1e}"
        )
    means = []
    for course in (own, peer):
        pressure, shear, contacts = -course.stress[:, :3].mean(axis=1), course.stress[:, 3], course.contacts
        pressure, shear, contacts = (column[SAMPLES // 2 :].mean() for column in (pressure, shear, contacts))
        means.append(f"{pressure / 1e3:.2f} kPa, {shear / 1e3:.2f} kPa, {contacts:.1f} contacts")
    print(f"  means of the second half: {means[0]}; of the peer {means[1]}", flush=True)


def lammps(program, folder, peer):
    """All paths, with what LAMMPS does as it is and with what explains the difference."""
    points, radius, edges = pressed(program, folder)
    for case in CASES:
        places, cell = case.wide * points, case.wide * edges
        velocity = np.zeros_like(places)
        if case.wide > 1.0:
            velocity = np.random.default_rng(1).normal(size=places.shape)
            mass = radius[:, None] ** 3
            velocity -= (mass * velocity).sum(axis=0) / mass.sum()
        columns = np.column_stack([places, radius, velocity])
        np.savetxt(folder / "grains.csv", columns, "%.17g", ",", header="x,y,z,radius,vx,vy,vz", comments="")
        pair, law, peer_law = f"normal_damping = {DAMPING!r}", "", f"{STIFFNESS} 0.0 {DAMPING} 0.0 0.0 0"
        if case.rough:
            pair += f"\ntangential_stiffness = {SHEAR_STIFFNESS!r}\ntangential_damping = 0.0\nfriction = {FRICTION!r}"
            law = "[contact.touch.tangential.history]"
            peer_law = f"{STIFFNESS} {SHEAR_STIFFNESS} {DAMPING} 0.0 {FRICTION} 0"
        mine = own(program, folder, case, pair, law, cell)
        for what, remap, ahead in (
            ("remap v, box one step ahead", "v", 1),
            ("remap v", "v", 0),
            ("remap x", "x", 0),
        ):
            begin = strained(cell, {name: rate * STEP * ahead for name, rate in case.rates.items()})
            streaming = places @ case.gradient().T * (remap == "v")
            data(folder / "cell.data", places, radius, velocity + streaming, begin)
            strain = [
                f"{name[0]} trate {rate}" if name[0] == name[1] else f"{name} erate {rate}"
                for name, rate in case.rates.items()
            ]
            every = round(case.end() / STEP) // SAMPLES
            values = {"law": peer_law, "step": STEP, "strain": " ".join(strain), "remap": remap, "every": every}
            deform = "/deform" if remap == "v" else ""
            (folder / "in.cell").write_text(LAMMPS.format(deform=deform, steps=every * SAMPLES, **values))
            subprocess.run([peer, "-in", "in.cell", "-log", "cell.log", "-screen", "none"], cwd=folder, check=True)
            compare(case, what, mine, lammps_course(folder, len(points)), cell, radius)


def data(file, points, radius, velocity, edges):
    """A data file of LAMMPS."""
    rows = [f"cell\n\n{len(points)} atoms\n1 atom types"]
    rows += [f"0.0 {edges[axis, axis]:.17g} {name}lo {name}hi" for axis, name in enumerate("xyz")]
    rows += [f"{edges[0, 1]:.17g} {edges[0, 2]:.17g} {edges[1, 2]:.17g} xy xz yz", "\nAtoms\n"]
    rows += [
        f"{index + 1} 1 {2 * size:.17g} {DENSITY} {x:.17g} {y:.17g} {z:.17g}"
        for index, ((x, y, z), size) in enumerate(zip(points, radius, strict=True))
    ]
    rows += ["\nVelocities\n"]
    rows += [f"{index + 1} {x:.17g} {y:.17g} {z:.17g} 0 0 0" for index, (x, y, z) in enumerate(velocity)]
    file.write_text("\n".join(rows) + "\n")


def lammps_course(folder, count):
    """What LAMMPS wrote."""
    lines = (folder / "cell.log").read_text().splitlines()
    begin = next(index for index, line in enumerate(lines) if line.split()[:1] == ["Step"]) + 1
    rows = [line.split() for line in lines[begin : begin + SAMPLES + 1]]
    found = np.array(rows, dtype=float)
    texts = (folder / "cell.dump").read_text().split("ITEM: TIMESTEP\n")[1:]
    places = [np.array([row.split()[1:4] for row in text.split("\n")[8 : 8 + count]], dtype=float) for text in texts]
    return Course(-found[:, 1:7], found[:, 7] / 2, places)


def yade(program, folder, peer):
    """The slow paths, with Cundall's damping and no dashpots. YADE gives grains the spin of the flow at the start."""
    points, radius, edges = pressed(program, folder)
    for case in CASES:
        if case.wide > 1.0:
            continue
        gradient = case.gradient()
        twist = 0.5 * (gradient - gradient.T)
        turning = [twist[2, 1], twist[0, 2], twist[1, 0]]
        columns = np.column_stack([points, radius, np.tile(turning, (len(points), 1))])
        np.savetxt(folder / "grains.csv", columns, "%.17g", ",", header="x,y,z,radius,wx,wy,wz", comments="")
        pair, law = "normal_damping = 0.0", ""
        if case.rough:
            pair += f"\ntangential_stiffness = {SHEAR_STIFFNESS!r}\ntangential_damping = 0.0\nfriction = {FRICTION!r}"
            law = "[contact.touch.tangential.history]"
        quiet = f"linear = {QUIET}\nangular = {QUIET}\ngravity_damped = false\napplied_forces_damped = false"
        mine = own(program, folder, case, pair, law, edges, more=f"[damping.quiet]\n{quiet}")
        every = round(case.end() / STEP) // SAMPLES
        for what, ahead in (("cell one step ahead", 1), ("as it is", 0)):
            begin = strained(edges, {name: rate * STEP * ahead for name, rate in case.rates.items()})
            text = YADE.format(
                edges=", ".join(repr(float(part)) for part in begin.flatten()),
                gradient=", ".join(repr(float(part)) for part in gradient.flatten()),
                kn=STIFFNESS,
                ks=SHEAR_STIFFNESS * case.rough,
                angle=float(np.arctan(FRICTION)) * case.rough,
                damping=QUIET,
                density=DENSITY,
                step=STEP,
                samples=SAMPLES,
                every=every,
            )
            (folder / "cell.py").write_text(text)
            subprocess.run([peer, "-n", "-x", "-j1", "cell.py"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            found = np.loadtxt(folder / "yade.txt")
            places = [np.loadtxt(folder / f"yade_{sample}.txt") for sample in range(SAMPLES + 1)]
            compare(case, what, mine, Course(found[:, :6], found[:, 6], places), edges, radius)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["lammps", "yade"])
    parser.add_argument(
        "--program", type=lambda path: Path(path).resolve(), default=Path("target/release/cograin").resolve()
    )
    parser.add_argument("--peer", help="the other program; by default lmp or yade")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if options.what == "lammps":
            lammps(options.program, Path(folder), options.peer or "lmp")
        else:
            yade(options.program, Path(folder), options.peer or "yade")


if __name__ == "__main__":
    main()
