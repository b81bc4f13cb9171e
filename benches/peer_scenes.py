"""Common scenes, written for cograin, LIGGGHTS, LAMMPS and YADE: the same particles, laws, walls and time step for all."""

import gzip
import math
import random
from pathlib import Path
from typing import NamedTuple

PACKING = Path(__file__).resolve().parents[1] / "models/loaded_beam/dense_20k.csv.gz"
BOX = ((0.0, 0.2448), (0.0, 0.2448), (0.0, 0.4))  # walls of the packing [m]
YOUNGS_MODULUS, POISSONS_RATIO, DENSITY, RESTITUTION, FRICTION = 5.0e7, 0.3, 2500.0, 0.5, 0.5
ROLLING_FRICTION, COHESION_ENERGY_DENSITY = 0.1, 5.0e3
SKIN = 0.001  # of the peers in the packing, the best found for them [m]; cograin chooses its own
STEP = 1.54807158678598e-5  # 10 % of the Rayleigh time of the smallest sphere [s]
MEAN_RADIUS = 0.005  # [m]

# Bonded block: hexagonal close packing without contact, lowest layer held.
BLOCK = (20, 20, 25)
BLOCK_STEP, BLOCK_RADIUS, BLOCK_SPACING = 2.0e-6, 0.005, 0.01001
BOND_STIFFNESS, SHEAR_STIFFNESS, BOND_REACH = 1.0e10, 4.0e9, 0.0105
BLOCK_SPEED = 0.005  # [m/s]

# Spheres of 1 mm, closely packed about spheres of 5 mm that stand on a cubic lattice, in a box, with small random velocities.
SMALL, LARGE, PITCH, BIMODAL_EDGE, BIMODAL_SPEED = 0.001, 0.005, 0.016, 0.048, 0.01

# Spheres of 5 mm +- 20 % on a cubic lattice in a box, with random velocities and without gravity: they fill 7 % of it.
GAS_EDGE, GAS_PITCH, GAS_SPEED = 27, 0.02, 1.0
BIMODAL_SKIN, GAS_SKIN = 0.0004, 0.002  # of the peers, the best found for them [m]


class Scene(NamedTuple):
    """A scene and how long it is run to be timed."""

    name: str
    steps: tuple  # short and long run
    copies: int = 1  # of the packing along x, every second one mirrored
    rolling: bool = False  # with rolling friction and cohesion
    wide: float = 1.0  # how far the wall at high x stands away, over the width of the packing
    factor: float = 1.0  # time step over STEP
    bonds: str = ""  # formulation, in the bonded block
    spheres: str = ""  # bimodal or gas instead of the packing
    facet: float = 0.0  # edge of the facets of the walls [m]; 0: they are planes
    moving: bool = False  # whether walls of facets swing
    skin: float = SKIN  # of the peers [m]
    peers: tuple = ()  # those that can run it


SCENES = [
    Scene("s1_20k", (100, 1100), peers=("liggghts", "lammps", "yade")),
    Scene("s1_100k", (20, 220), copies=5, peers=("liggghts", "lammps", "yade")),
    Scene("s1_1M", (2, 22), copies=50),
    Scene("s2_20k", (100, 1100), rolling=True, peers=("liggghts", "lammps")),
    Scene("s3_incremental", (100, 1100), bonds="incremental", peers=("lammps", "yade")),
    Scene("s3_finite_rotation", (100, 1100), bonds="finite_rotation", peers=("lammps", "yade")),
    Scene("s1_20k_mesh", (100, 1100), facet=4.5e-3, peers=("liggghts",)),
    Scene("s4_20k", (500, 5500), wide=3.0, factor=1.5, peers=("liggghts", "lammps", "yade")),
    Scene("bimodal", (200, 2200), spheres="bimodal", factor=0.25, skin=BIMODAL_SKIN, peers=("liggghts", "lammps")),
    Scene("gas", (500, 5500), spheres="gas", skin=GAS_SKIN, peers=("liggghts", "lammps")),
]


def packing(copies):
    """Rows x, y, z, radius of the packing and its mirrored copies."""
    lines = gzip.decompress(PACKING.read_bytes()).decode().splitlines()[1:]
    rows = [tuple(map(float, line.split(",")[1:5])) for line in lines]
    width = BOX[0][1]
    return [
        (copy * width + (width - x if copy % 2 else x), y, z, radius)
        for copy in range(copies)
        for x, y, z, radius in rows
    ]


def block():
    """Rows x, y, z, radius and velocities of the bonded block."""
    height = BLOCK_SPACING * math.sqrt(6) / 3 * (BLOCK[2] - 1)
    rows = []
    for k in range(BLOCK[2]):
        for j in range(BLOCK[1]):
            for i in range(BLOCK[0]):
                x = BLOCK_SPACING * (i + 0.5 * ((j + k) % 2))
                y = BLOCK_SPACING * math.sqrt(3) / 2 * (j + (k % 2) / 3)
                z = BLOCK_SPACING * math.sqrt(6) / 3 * k
                s = math.sin(0.5 * math.pi * z / height) if k else 0.0
                velocity = (BLOCK_SPEED * s, 0.4 * BLOCK_SPEED * s * s, -0.3 * BLOCK_SPEED * s)
                rows.append((x, y, z, BLOCK_RADIUS, *velocity))
    return rows


def bimodal():
    """Rows x, y, z, radius and velocities of the large spheres and of the small ones between them, which just touch."""
    chance, spacing = random.Random(1), 2 * SMALL * (1 - 1e-3)

    def row(x, y, z, radius):
        return (x, y, z, radius, *(BIMODAL_SPEED * chance.uniform(-1, 1) for _ in range(3)))

    places = [PITCH * (number + 0.5) for number in range(round(BIMODAL_EDGE / PITCH))]
    large = [(x, y, z) for x in places for y in places for z in places]
    rows = [row(*centre, LARGE) for centre in large]
    high = BIMODAL_EDGE - SMALL
    for k in range(int((high - SMALL) / (spacing * math.sqrt(6) / 3)) + 1):
        z = SMALL + spacing * math.sqrt(6) / 3 * k
        for j in range(int((high - SMALL) / (spacing * math.sqrt(3) / 2)) + 1):
            y = SMALL + spacing * math.sqrt(3) / 2 * (j + (k % 2) / 3)
            for i in range(int((high - SMALL) / spacing) + 1):
                x = SMALL + spacing * (i + 0.5 * ((j + k) % 2))
                near = min(math.dist((x, y, z), centre) for centre in large)
                if max(x, y) <= high and near >= LARGE + SMALL * (1 - 1e-2):
                    rows.append(row(x, y, z, SMALL))
    return rows


def gas():
    """Rows x, y, z, radius and velocities of spheres that fly."""
    chance, places = random.Random(1), [GAS_PITCH * (number + 0.5) for number in range(GAS_EDGE)]
    return [
        (x, y, z, MEAN_RADIUS * chance.uniform(0.8, 1.2), *(GAS_SPEED * chance.uniform(-1, 1) for _ in range(3)))
        for x in places
        for y in places
        for z in places
    ]


def particles(scene):
    """Rows of the particles of a scene: x, y, z, radius, and velocities where they have any."""
    if scene.bonds:
        return block()
    return bimodal() if scene.spheres == "bimodal" else gas() if scene.spheres == "gas" else packing(scene.copies)


def gravity(scene):
    """Gravity of a scene [m/s2], downwards."""
    return 0.0 if scene.bonds or scene.spheres == "gas" else 9.81


def box(scene):
    """Walls of a scene [m]."""
    if scene.spheres:
        return [(0.0, BIMODAL_EDGE if scene.spheres == "bimodal" else GAS_EDGE * GAS_PITCH)] * 3
    (low, high), *others = BOX
    return [(low, high * scene.copies * scene.wide), *others]


def time_step(scene):
    """Its time step [s]."""
    return BLOCK_STEP if scene.bonds else STEP * scene.factor


def cograin(scene, steps, threads, folder):
    """Scene file and particles; returns the arguments of the program."""
    rows = particles(scene)
    columns = "x,y,z,radius,vx,vy,vz" if scene.bonds or scene.spheres else "x,y,z,radius"
    if not (folder / "bed.csv").exists():
        (folder / "bed.csv").write_text("\n".join([columns, *(",".join(map(repr, row)) for row in rows), ""]))
    step = time_step(scene)
    text = f"gravity = [0.0, 0.0, {0.0 - gravity(scene)}]\n[run]\nend = {steps * step!r}\nstep = {step!r}\n"
    text += f"threads = {threads}\n[material.grain]\nyoungs_modulus = {YOUNGS_MODULUS!r}\n"
    text += f"poissons_ratio = {POISSONS_RATIO}\ndensity = {DENSITY}\n"
    text += '[particles.bed]\nmaterial = "grain"\nfile = "bed.csv"\n'
    text += cograin_bonds(scene) if scene.bonds else cograin_contacts(scene, folder)
    text += f"[output]\nhistory_interval = {steps * step!r}\n"
    (folder / f"{steps}.toml").write_text(text)
    return ["run", f"{steps}.toml", "-o", "out"]


def cograin_contacts(scene, folder):
    """Contact law and walls."""
    text = f"[pair.grain.grain]\nrestitution = {RESTITUTION}\nfriction = {FRICTION}\n"
    if scene.rolling:
        text += f"rolling_friction = {ROLLING_FRICTION}\ncohesion_energy_density = {COHESION_ENERGY_DENSITY}\n"
    text += "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n"
    if scene.rolling:
        text += "[contact.touch.rolling.cdt]\n[contact.touch.cohesion.sjkr]\n"
    for axis, (low, high) in zip("xyz", box(scene)):
        for name, place, sign in (("low", low, 1.0), ("high", high, -1.0)):
            point = [place if other == axis else 0.0 for other in "xyz"]
            normal = [sign if other == axis else 0.0 for other in "xyz"]
            shape = f"plane = {{ point = {point}, normal = {normal} }}"
            if scene.facet:
                facets(folder / f"{axis}_{name}.stl", scene, "xyz".index(axis), place)
                shape = f'mesh = {{ file = "{axis}_{name}.stl" }}'
            text += f'[boundary.{axis}_{name}]\n{shape}\nmaterial = "grain"\n'
            if scene.moving:
                text += f"motion = {{ prescribed = {{ {axis} = {{ sine = {{ amplitude = 1e-6, frequency = 100.0 }} }} }} }}\n"
    return text


def facets(path, scene, axis, place):
    """A wall as an STL file: rectangles of about the edge of the scene's facets, each two triangles."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    walls = box(scene)

    def steps(along):
        low, high = walls[along]
        count = max(1, round((high - low) / scene.facet))
        return [low + (high - low) * number / count for number in range(count + 1)]

    def corner(one, other):
        at = [place] * 3
        at[first], at[second] = one, other
        return "vertex " + " ".join(map(repr, at))

    lines = ["solid wall"]
    ones, others = steps(first), steps(second)
    for a, b in zip(ones, ones[1:]):
        for c, d in zip(others, others[1:]):
            for corners in (((a, c), (b, c), (b, d)), ((a, c), (b, d), (a, d))):
                lines += ["facet normal 0 0 0", "outer loop", *(corner(*at) for at in corners), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid wall", ""]))


def cograin_bonds(scene):
    """Bonds and the layer that is held."""
    return (
        f'[bond.glue]\nformulation = "{scene.bonds}"\nbetween = ["bed", "bed"]\ncreate_distance = {BOND_REACH}\n'
        f"normal_stiffness = {BOND_STIFFNESS!r}\ntangential_stiffness = {SHEAR_STIFFNESS!r}\n"
        '[boundary.base]\nparticles = { set = "bed", box = [[-1.0, -1.0, -0.001], [1.0, 1.0, 0.001]] }\n'
    )


def data_file(path, rows, walls, style, held=None):
    """Data file of both peers; particles of the held layer are of type 2."""
    with open(path, "w") as file:
        file.write(f"particles\n\n{len(rows)} atoms\n{2 if held else 1} atom types\n")
        if held:
            file.write("1 bond types\n14 extra bond per atom\n60 extra special per atom\n")
        file.write("\n")
        for (low, high), axis in zip(walls, "xyz"):
            file.write(f"{low - 0.01!r} {high + 0.01!r} {axis}lo {axis}hi\n")
        file.write(f"\nAtoms{style}\n\n")
        for number, (x, y, z, radius, *_) in enumerate(rows, 1):
            kind = f"1 {2 if held(z) else 1}" if held else "1"
            file.write(f"{number} {kind} {2 * radius!r} {DENSITY} {x!r} {y!r} {z!r}\n")
        if len(rows[0]) > 4:
            file.write("\nVelocities\n\n")
            for number, row in enumerate(rows, 1):
                file.write(f"{number} {row[4]!r} {row[5]!r} {row[6]!r} 0 0 0\n")


def liggghts(scene, steps, _threads, folder):
    """Deck of LIGGGHTS; returns the arguments of the program."""
    data_file(folder / "particles.data", particles(scene), box(scene), "")
    style = "model hertz tangential history"
    properties = [
        ("youngsModulus", "peratomtype", YOUNGS_MODULUS),
        ("poissonsRatio", "peratomtype", POISSONS_RATIO),
        ("coefficientRestitution", "peratomtypepair 1", RESTITUTION),
        ("coefficientFriction", "peratomtypepair 1", FRICTION),
    ]
    if scene.rolling:
        style += " cohesion sjkr rolling_friction cdt"
        properties.append(("cohesionEnergyDensity", "peratomtypepair 1", COHESION_ENERGY_DENSITY))
        properties.append(("coefficientRollingFriction", "peratomtypepair 1", ROLLING_FRICTION))
    text = "atom_style granular\natom_modify map array\nboundary f f f\nnewton off\ncommunicate single vel yes\nunits si\n"
    text += f"read_data particles.data\nneighbor {scene.skin} bin\nneigh_modify delay 0\n"
    for number, (name, kind, value) in enumerate(properties):
        text += f"fix m{number} all property/global {name} {kind} {value}\n"
    text += f"pair_style gran {style}\npair_coeff * *\n"
    meshes = []
    for axis, ends in zip("xyz", box(scene)):
        for name, place in zip(("lo", "hi"), ends):
            if scene.facet:
                meshes.append(f"{axis}{name}")
                facets(folder / f"{axis}{name}.stl", scene, "xyz".index(axis), place)
                text += f"fix {axis}{name} all mesh/surface file {axis}{name}.stl type 1\n"
            else:
                text += f"fix w{axis}{name} all wall/gran {style} primitive type 1 {axis}plane {place!r}\n"
    if meshes:
        text += f"fix walls all wall/gran {style} mesh n_meshes {len(meshes)} meshes {' '.join(meshes)}\n"
    text += f"fix g all gravity {gravity(scene)} vector 0 0 -1\nfix integrate all nve/sphere\ntimestep {time_step(scene)!r}\n"
    text += f"thermo {steps}\nthermo_style custom step atoms ke\nrun {steps}\n"
    (folder / f"{steps}.lig").write_text(text)
    return ["-in", f"{steps}.lig", "-log", "none"]


def lammps(scene, steps, threads, folder):
    """Deck of LAMMPS; returns the arguments of the program."""
    text = lammps_bonds(folder) if scene.bonds else lammps_contacts(scene, folder)
    text += f"timestep {time_step(scene)!r}\nthermo {steps}\nthermo_style custom step atoms ke\nrun {steps}\n"
    (folder / f"{steps}.lmp").write_text(text)
    several = ["-sf", "omp", "-pk", "omp", str(threads)] if threads > 1 else []
    return ["-in", f"{steps}.lmp", "-log", "none", *several]


def lammps_contacts(scene, folder):
    """`gran/hertz/history`, its damping that of a typical contact; with rolling `granular`, which costs as much as the
    same physics would."""
    data_file(folder / "particles.data", particles(scene), box(scene), " # sphere")
    modulus, ratio = YOUNGS_MODULUS, POISSONS_RATIO
    tangential = math.sqrt(2 * (1 - ratio) / (2 - ratio))
    if scene.rolling:
        spring = 2.25 * ROLLING_FRICTION**2 * 4 / 3 * modulus / (2 * (1 - ratio**2)) * MEAN_RADIUS * 0.1
        wall = f"granular hertz/material {modulus} {RESTITUTION} {ratio} tangential mindlin NULL {tangential} {FRICTION}"
        wall += f" rolling sds {spring} 0.0 {ROLLING_FRICTION} damping coeff_restitution"
        pair = f"pair_style granular\npair_coeff * * {wall.removeprefix('granular ')}\n"
    else:
        beta = -math.log(RESTITUTION) / math.hypot(math.pi, math.log(RESTITUTION))
        radius, overlap = MEAN_RADIUS / 2, 2e-6
        mass = 0.5 * 4 / 3 * math.pi * MEAN_RADIUS**3 * DENSITY
        stiffness = modulus / (1 - ratio**2) * math.sqrt(radius * overlap)
        damping = 2 * math.sqrt(5 / 6) * beta * math.sqrt(stiffness * mass) / (mass * math.sqrt(radius * overlap))
        normal, shear = 2 * modulus / (3 * (1 - ratio**2)), 4 * modulus / (2 * (1 + ratio)) / (2 - ratio)
        law = f"hertz/history {normal} {shear} {damping} {damping * tangential} {FRICTION} 1"
        wall, pair = law, f"pair_style gran/{law}\npair_coeff * *\n"
    text = "units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\ncomm_modify vel yes\n"
    text += f"read_data particles.data\nneighbor {scene.skin} bin\nneigh_modify delay 0 every 1 check yes\n{pair}"
    for axis, (low, high) in zip("xyz", box(scene)):
        text += f"fix w{axis} all wall/gran {wall} {axis}plane {low!r} {high!r}\n"
    return text + f"fix g all gravity {gravity(scene)} vector 0 0 -1\nfix integrate all nve/sphere\n"


def lammps_bonds(folder):
    """`bpm/rotational` with the stiffness of our bonds."""
    rows = block()
    walls = [(min(row[k] for row in rows) - 0.02, max(row[k] for row in rows) + 0.02) for k in range(3)]
    data_file(folder / "particles.data", rows, walls, " # bpm/sphere", held=lambda z: z < 0.001)
    area, polar = math.pi * BLOCK_RADIUS**2, math.pi * BLOCK_RADIUS**4 / 2
    stiffness = (BOND_STIFFNESS * area, SHEAR_STIFFNESS * area, SHEAR_STIFFNESS * polar, BOND_STIFFNESS * polar / 2)
    return (
        "units si\natom_style bpm/sphere\natom_modify map array\nspecial_bonds lj 0.0 1.0 1.0 coul 0.0 1.0 1.0\n"
        "newton on off\nboundary f f f\ncomm_modify vel yes cutoff 0.02\nread_data particles.data\n"
        "neighbor 0.0005 bin\nneigh_modify delay 0 every 1 check yes\n"
        "pair_style gran/hertz/history 1e7 NULL 50 NULL 0.5 1\npair_coeff * *\n"
        "bond_style bpm/rotational break no smooth no\n"
        f"bond_coeff 1 {' '.join(map(repr, stiffness))} 1e20 1e20 1e20 1e20 0 0 0 0\n"
        f"create_bonds many all all 1 {1.9 * BLOCK_RADIUS!r} {BOND_REACH!r}\n"
        "group mobile type 1\nfix integrate mobile nve/bpm/sphere\n"
    )


def yade(scene, steps, threads, folder):
    """Script of YADE; returns the arguments of the program."""
    rows = block() if scene.bonds else packing(scene.copies)
    (folder / "particles.txt").write_text("\n".join(" ".join(map(repr, row)) for row in rows))
    text = 'rows = [tuple(map(float, line.split())) for line in open("particles.txt")]\n'
    text += f"O.dt = {time_step(scene)!r}\n{yade_bonds() if scene.bonds else yade_contacts(scene)}"
    text += f"O.run({steps}, True)\nprint(O.iter, utils.kineticEnergy(), flush=True)\n"
    (folder / f"{steps}.py").write_text(text)
    return ["-n", "-x", f"-j{threads}", f"{steps}.py"]


def yade_contacts(scene):
    """Hertz-Mindlin with the damping of the others. YADE takes R/2 for the effective radius at a wall instead of R: a
    stiffer material of the walls makes up for that, to 3 % along the wall and exactly across it."""
    beta = -math.log(RESTITUTION) / math.hypot(math.pi, math.log(RESTITUTION)) * math.sqrt(5 / 6)
    wall_ratio = 0.5
    wall_modulus = YOUNGS_MODULUS * (1 - wall_ratio**2) / (1 - POISSONS_RATIO**2) / (math.sqrt(2) - 1)
    text = ""
    for name, modulus, ratio in (("grain", YOUNGS_MODULUS, POISSONS_RATIO), ("wall", wall_modulus, wall_ratio)):
        text += f"{name} = O.materials.append(FrictMat(young={modulus!r}, poisson={ratio}, density={DENSITY}, "
        text += f"frictionAngle={math.atan(FRICTION)!r}))\n"
    text += "O.bodies.append([utils.sphere(row[:3], row[3], material=grain) for row in rows])\n"
    for axis, ends in enumerate(box(scene)):
        for place, side in zip(ends, (1, -1)):
            text += f"O.bodies.append(utils.wall({place!r}, {axis}, sense={side}, material=wall))\n"
    return text + (
        "O.engines = [\n    ForceResetter(),\n"
        f"    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist={SKIN / 2}),\n"
        "    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False), Ig2_Wall_Sphere_ScGeom()],\n"
        f"        [Ip2_FrictMat_FrictMat_MindlinPhys(betan={beta!r}, betas={beta!r})], [Law2_ScGeom_MindlinPhys_Mindlin()]),\n"
        "    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),\n]\n"
    )


def yade_bonds():
    """Cohesive contacts with a law for moments, its stiffnesses those of our bonds. They are made in the first step, in which
    nothing moves, by spheres that reach further than their radius; the gap of that step is where they are free of force."""
    modulus = BOND_STIFFNESS * math.pi * BLOCK_RADIUS  # stiffness of a pair over its radius
    ratio = SHEAR_STIFFNESS / BOND_STIFFNESS  # what YADE calls Poisson's ratio: shear over normal stiffness
    reach = BOND_REACH / (2 * BLOCK_RADIUS)
    return (
        f"ice = O.materials.append(CohFrictMat(young={modulus!r}, poisson={ratio}, density={DENSITY}, frictionAngle=0.5,\n"
        "    isCohesive=True, normalCohesion=1e30, shearCohesion=1e30, momentRotationLaw=True, etaRoll=-1, etaTwist=-1,\n"
        f"    alphaKr={0.25 / ratio}, alphaKtw=0.5))\n"
        "O.bodies.append([utils.sphere(row[:3], row[3], material=ice, fixed=row[2] < 0.001) for row in rows])\n"
        f"reach, meet = Bo1_Sphere_Aabb(aabbEnlargeFactor={reach}), Ig2_Sphere_Sphere_ScGeom6D(interactionDetectionFactor={reach})\n"
        "O.engines = [\n    ForceResetter(),\n    InsertionSortCollider([reach], verletDist=0.0005),\n"
        "    InteractionLoop([meet], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)],\n"
        "        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True)]),\n"
        "    NewtonIntegrator(damping=0),\n]\n"
        "step, O.dt = O.dt, 0.0\nO.step()\n"
        "O.dt, reach.aabbEnlargeFactor, meet.interactionDetectionFactor = step, 1.0, 1.0\n"
        "for bond in O.interactions:\n    bond.phys.unp = bond.geom.penetrationDepth\n"
        "for body, row in zip(O.bodies, rows):\n    body.state.vel = row[4:]\n"
    )
