"""Clumps of three spheres that fall into a box: what a step costs beside the same spheres loose, and LAMMPS beside it.

    python benches/clumps.py cost --program target/release/cograin       some three minutes
    python benches/clumps.py lammps --program target/release/cograin --peer lmp
    python benches/clumps.py yade --program target/release/cograin --peer yade

`cost` lets 7,128 clumps settle, then the same spheres loose from the same places, and times 800 further steps of each
by turns. `lammps` runs 216 clumps in `fix rigid/small` too and tells how far spheres are apart, over their radius.
`yade` runs them in YADE until they rest, and tells energies and heights, too, and those of four other seeds of cograin.
"""

import argparse
import resource
import subprocess
import tempfile
from pathlib import Path

import meshio
import numpy as np

SCENE = """
gravity = [0.0, 0.0, -9.81]
[run]
step = {step}
end = {end}
threads = 1
{more}
[material.a]
density = 2500.0
[pair.a.a]
normal_stiffness = 2000.0
normal_damping = {damping}
{tangential}
[contact.touch.normal.hooke_stiffness]
{friction}
[clump.bent]
spheres = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.004, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.004, 0.004, 0.0], radius = 0.002 }},
]
[particles.bent]
material = "a"
{particles}
[boundary]
floor = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}, material = "a" }}
west = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}, material = "a" }}
east = {{ plane = {{ point = [{width}, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}, material = "a" }}
south = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }}, material = "a" }}
north = {{ plane = {{ point = [0.0, {width}, 0.0], normal = [0.0, -1.0, 0.0] }}, material = "a" }}
[output]
frame_interval = {frames}
"""
CLUMPS = """clump = "bent"
orientation = "random"
velocity = [0.1, 0.05, -0.5]
[particles.bent.lattice]
kind = "simple_cubic"
origin = [0.006, 0.006, 0.0065]
counts = {counts}
radius = 0.0047
spacing = 0.0102
"""
ROUGH = {
    "tangential": "tangential_stiffness = 1000.0\ntangential_damping = 10.0\nfriction = 0.4",
    "friction": "[contact.touch.tangential.history]",
}


def run(program, scene, output, *more):
    """Runs a scene; returns user seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = [program, "run", scene, "-o", output, "--overwrite", "--quiet", *more]
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def cost(program, folder):
    """Milliseconds of a step of both beds."""
    common = {"step": 1e-5, "more": "", "damping": 20.0, "width": 0.1857, "frames": 1.0, **ROUGH}
    places = CLUMPS.format(counts=[18, 18, 22])
    (folder / "clumps.toml").write_text(SCENE.format(end=0.5, particles=places, **common))
    run(program, folder / "clumps.toml", folder / "clumps")
    last = sorted((folder / "clumps").glob("particles_*.vtu"))[-1]
    spheres = meshio.read(last)
    np.savetxt(
        folder / "loose.csv",
        np.column_stack([spheres.points, spheres.point_data["radius"]]),
        "%.17g",
        ",",
        header="x,y,z,radius",
        comments="",
    )
    (folder / "loose.toml").write_text(SCENE.format(end=0.4, particles='file = "loose.csv"', **common))
    run(program, folder / "loose.toml", folder / "loose")
    least = {}
    for _ in range(3):
        for name, begin in (("clumps", 0.5), ("loose", 0.4)):
            for steps in (50, 850):
                start = ["--from", folder / name / "checkpoint.cograin", "--set", f"run.end={begin + 1e-5 * steps!r}"]
                seconds = run(program, folder / f"{name}.toml", folder / "timed", *start)
                least[name, steps] = min(seconds, least.get((name, steps), np.inf))
    for name in ("clumps", "loose"):
        print(f"{name}: {1e3 * (least[name, 850] - least[name, 50]) / 800:.3f} ms a step")


INPUT = """units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
fix mol all property/atom mol ghost yes
read_data bed.data fix mol NULL Molecules
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes exclude molecule/intra all
pair_style gran/hooke/history {law}
pair_coeff * *
fix g all gravity 9.81 vector 0 0 -1
fix r all rigid/small molecule
fix w1 all wall/gran hooke/history {law} zplane 0.0 NULL
fix w2 all wall/gran hooke/history {law} xplane 0.0 {width}
fix w3 all wall/gran hooke/history {law} yplane 0.0 {width}
timestep 5.0e-6
compute ke all ke/rigid r
thermo_style custom step c_ke
dump d all custom 1000 bed.dump id x y z
dump_modify d sort id format float %20.15g
run 4000
"""


def lammps(program, folder, peer):
    """How far spheres are apart in both programs, with and without friction."""
    smooth = {"tangential": "friction = 0.0", "friction": "[contact.touch.tangential.none]"}
    rough = {name: text.replace("= 10.0", "= 250.0") for name, text in ROUGH.items()}
    for name, friction, law in (
        ("smooth", smooth, "2000.0 0.0 500.0 0.0 0.0 0"),
        ("rough", rough, "2000.0 1000.0 500.0 250.0 0.4 1"),
    ):
        common = {
            "step": 5e-6,
            "end": 0.02,
            "more": 'scheme = "engine"',
            "damping": 500.0,
            "width": 0.0633,
            "frames": 0.005,
        }
        scene = SCENE.format(particles=CLUMPS.format(counts=[6, 6, 6]), **common, **friction)
        (folder / "bed.toml").write_text(scene)
        run(program, folder / "bed.toml", folder / "bed")
        frames = [meshio.read(path) for path in sorted((folder / "bed").glob("particles_*.vtu"))]
        first = frames[0]
        count, radius = len(first.points), float(first.point_data["radius"][0])
        rows = [
            f"clumps\n\n{count} atoms\n1 atom types\n-0.05 0.15 xlo xhi\n-0.05 0.15 ylo yhi\n-0.05 0.2 zlo zhi",
            "\nAtoms\n",
        ]
        rows += [
            f"{index + 1} 1 {2 * radius:.17g} 2500 {x:.17g} {y:.17g} {z:.17g}"
            for index, (x, y, z) in enumerate(first.points)
        ]
        rows += ["\nVelocities\n"]
        velocities = first.point_data["velocity"]
        rows += [f"{index + 1} {x:.17g} {y:.17g} {z:.17g} 0 0 0" for index, (x, y, z) in enumerate(velocities)]
        rows += ["\nMolecules\n"]
        rows += [f"{index + 1} {int(clump) + 1}" for index, clump in enumerate(first.point_data["clump"])]
        (folder / "bed.data").write_text("\n".join(rows) + "\n")
        (folder / "in.bed").write_text(INPUT.format(law=law, width=common["width"]))
        subprocess.run([peer, "-in", "in.bed", "-log", "none", "-screen", "none"], cwd=folder, check=True)
        texts = (folder / "bed.dump").read_text().split("ITEM: TIMESTEP\n")[1:]
        for index, (frame, text) in enumerate(zip(frames, texts, strict=True)):
            found = np.array([row.split()[1:4] for row in text.split("\n")[8 : 8 + count]], dtype=float)
            apart = np.linalg.norm(frame.points - found, axis=1).max() / radius
            print(f"{name}, {0.005 * index:.3f} s: {apart:.1e} of a radius at the most")


YADE = """
import numpy as np
rows = np.loadtxt("bed.txt")
rock = O.materials.append(ViscElMat(kn={kn!r}, cn={cn!r}, ks={ks!r}, cs=0.0, frictionAngle={angle!r}, density=2500.0))
spheres = [utils.sphere(row[:3], row[3], material=rock) for row in rows]
clumps, members = [], []
for first in range(0, len(rows), 3):
    clump, three = O.bodies.appendClumped(spheres[first : first + 3])
    clumps.append(clump)
    members += three
    # It holds the velocity of half a step before.
    O.bodies[clump].state.vel = rows[first, 4:] + [0.0, 0.0, 0.5 * 9.81 * {step!r}]
for axis, place, sense in ((0, 0.0, 1), (0, {width!r}, -1), (1, 0.0, 1), (1, {width!r}, -1), (2, 0.0, 1)):
    O.bodies.append(utils.wall(place, axis, sense=sense, material=rock))
O.dt = {step!r}
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.5e-3),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
        [Law2_ScGeom_ViscElPhys_Basic()],
    ),
    NewtonIntegrator(damping=0.0, gravity=(0.0, 0.0, -9.81), exactAsphericalRot=True),
]
told = []
for sample, steps in enumerate({samples}):
    O.run(steps - O.iter, True)
    # The energies of clumps; members have none of their own.
    kinetic = 0.0
    for body in clumps:
        state = O.bodies[body].state
        spin = state.ori.conjugate() * state.angVel
        kinetic += 0.5 * (state.mass * state.vel.squaredNorm() + sum(state.inertia[k] * spin[k] ** 2 for k in range(3)))
    told.append(kinetic)
    np.savetxt("yade_%d.txt" % sample, [list(O.bodies[body].state.pos) for body in members], "%.17g")
np.savetxt("yade.txt", told, "%.17g")
"""


def yade(program, folder, peer):
    """Places, heights and energies until the clumps rest; dashpots know no masses, and forces never pull."""
    step, samples, width, viscosity = 1e-5, [500, 1000, 2000, 5000, 10000, 20000, 40000], 0.0633, 0.15
    for name, friction, tangential in (("smooth", 0.0, ""), ("rough", 0.4, ROUGH["friction"])):
        values = {"step": step, "end": step * samples[-1], "more": 'scheme = "engine"', "damping": viscosity}
        values |= {"width": width, "frames": 500 * step, "friction": f"absolute_damping = true\n{tangential}"}
        shear = "tangential_stiffness = 1000.0\nabsolute_tangential_damping = 0.0\n" if friction else ""
        scene = SCENE.format(
            particles=CLUMPS.format(counts=[6, 6, 6]), tangential=f"{shear}friction = {friction}", **values
        )
        scene = scene.replace("\nnormal_damping", "\nabsolute_normal_damping")
        scene = scene.replace("[contact.touch.normal", "[contact.touch]\nlimit_force = true\n[contact.touch.normal")
        scene += f"history_interval = {500 * step!r}\n"
        (folder / "bed.toml").write_text(scene)
        run(program, folder / "bed.toml", folder / "bed")
        frames = [meshio.read(path) for path in sorted((folder / "bed").glob("particles_*.vtu"))]
        energies = np.genfromtxt(folder / "bed" / "history.csv", delimiter=",", names=True, deletechars="")
        first = frames[0]
        order = np.argsort(first.point_data["clump"], kind="stable")
        columns = [first.points, first.point_data["radius"], first.point_data["velocity"]]
        np.savetxt(folder / "bed.txt", np.column_stack(columns)[order], "%.17g")
        # The springs of two equal bodies are in series.
        text = YADE.format(
            kn=4000.0,
            cn=2 * viscosity,
            ks=2000.0 * bool(friction),
            angle=float(np.arctan(friction)),
            width=width,
            step=step,
            samples=samples,
        )
        (folder / "bed.py").write_text(text)
        subprocess.run([peer, "-n", "-x", "-j1", "bed.py"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        kinetic, radius = np.loadtxt(folder / "yade.txt"), float(first.point_data["radius"][0])
        for sample, steps in enumerate(samples):
            own, theirs = frames[steps // 500].points[order], np.loadtxt(folder / f"yade_{sample}.txt")
            apart = np.linalg.norm(own - theirs, axis=1).max() / radius
            heights = [1e3 * places[:, 2].mean() for places in (own, theirs)]
            print(
                f"{name}, {steps * step:.3f} s: {apart:.1e} of a radius at the most; mean height {heights[0]:.3f} and"
                f" {heights[1]:.3f} mm; kinetic energy {energies['energy.kinetic'][steps // 500]:.4e} and"
                f" {kinetic[sample]:.4e} J",
                flush=True,
            )
        for seed in range(2, 6):
            run(program, folder / "bed.toml", folder / "bed", "--set", f"run.seed={seed}")
            last = meshio.read(sorted((folder / "bed").glob("particles_*.vtu"))[-1])
            print(f"{name}, seed {seed}: mean height {1e3 * last.points[:, 2].mean():.3f} mm at the end", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["cost", "lammps", "yade"])
    parser.add_argument(
        "--program", type=lambda path: Path(path).resolve(), default=Path("target/release/cograin").resolve()
    )
    parser.add_argument("--peer", help="the other program; by default lmp or yade")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if options.what == "cost":
            cost(options.program, Path(folder))
        elif options.what == "lammps":
            lammps(options.program, Path(folder), options.peer or "lmp")
        else:
            yade(options.program, Path(folder), options.peer or "yade")


if __name__ == "__main__":
    main()
