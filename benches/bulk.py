"""What a time step of the published bulk processes costs in their developed motion, by turns with LIGGGHTS and LAMMPS.

    PYTHONPATH=python python benches/bulk.py impact --from out/bulk_impact/bed_0.1_1/run_default [--time 7e-3]
    PYTHONPATH=python python benches/bulk.py silo --from out/bulk_silo/run
    PYTHONPATH=python python benches/bulk.py drum --from out/bulk_drum/run --time 2

All programs begin with the grains of one frame of a run of the model (models/bulk_*): that next to --time, or where the
run ended; contacts begin without history. Each makes a short and a long run with the same time step; a step costs the
difference of user CPU time over that of steps, the least of the repeats. Walls of the peers are planes and cylinders
where they have them, otherwise triangles (LIGGGHTS) or a region (LAMMPS, of 2022 or later for its damping).
"""

import argparse
import itertools
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cograin import Program
from cograin.results import Run

ROOT = Path(__file__).resolve().parents[1]
SIDES = 64  # of the silo in LIGGGHTS
MATERIALS = {  # density [kg/m3], Young's modulus [Pa]; as in the scenes of the models
    "m1": (2500.0, 1.0e9),
    "m2": (2000.0, 0.5e9),
    "steel": (7200.0, 2.1e11),
}
POISSONS_RATIO = 0.2
PAIRS = {  # restitution and friction
    ("m1", "m1"): (0.5, 0.3),
    ("m1", "m2"): (0.45, 0.2),
    ("m2", "m2"): (0.4, 0.4),
    ("m1", "steel"): (0.4, 0.2),
    ("m2", "steel"): (0.4, 0.2),
    ("steel", "steel"): (0.6, 0.5),
}


class Problem(NamedTuple):
    """A model, the types of the peers in the order of its materials, their box [m], and the time step [s]."""

    materials: tuple[str, ...]
    box: tuple[tuple[float, float], ...]
    step: float
    skin: float  # of the peers' lists [m]


PROBLEMS = {
    "impact": Problem(("m1", "steel"), ((-0.06, 0.06), (-0.04, 0.04), (-0.1, 0.2)), 5e-7, 4e-4),
    "silo": Problem(("m1", "steel"), ((-0.11, 0.11), (-0.11, 0.11), (-0.5, 0.4)), 2e-6, 8e-4),
    "drum": Problem(("m1", "m2", "steel"), ((-0.11, 0.11), (-0.04, 0.04), (-0.11, 0.11)), 1e-6, 4e-4),
}
SILO = ((0.03, -0.0554222), (0.1, 0.0145778), (0.1, 0.314578))  # radius and height along its wall [m]


def frame(program, name, source, time, folder):
    """The grains of a run at a time, or at its end, and the scene that begins with them."""
    scene = ROOT / f"models/bulk_{name}/scene.toml"
    if time is None:
        last = float(json.loads((source / "summary.json").read_text())["time"])
        values = ("--set", f"run.end={last + 1e-6!r}", "--set", "output.frame_interval=1e-6")
        values += ("--set", "output.history_interval=1e-6", "--set", "output.columns=[]")
        program("run", scene, "--from", source / "checkpoint.cograin", "-o", folder / "frames", "--overwrite", *values)
        at = Run(folder / "frames").frames[0]
    else:
        at = min(Run(source).frames, key=lambda it: abs(it.time - time))
    shutil.copy(at.folder / f"particles_{at.number:06}.vtu", folder / "grains.vtu")
    text = scene.read_text()
    # Grains come from the frame; probes and columns name sets that are no longer there, and the lid has fallen away.
    text = re.sub(r"^\[(particles|probe)\.\w+\].*\n(.+\n)*", "", text, flags=re.MULTILINE)
    text = re.sub(r"^\[boundary\.lid\].*\n(.+\n)*", "", text, flags=re.MULTILINE)
    text = re.sub(r"^(columns|frame_interval|history_interval) = .*\n", "", text, flags=re.MULTILINE)
    grains = at.particles
    used = sorted({int(kind) for kind in grains["material"].ravel()})
    kinds = ", ".join(f'{kind} = "{PROBLEMS[name].materials[kind]}"' for kind in used)
    text += f'\n[particles.grains]\nfile = "grains.vtu"\nmaterials = {{ {kinds} }}\n'
    (folder / "scene.toml").write_text(text)
    return grains


def data_file(path, grains, problem, style):
    """The grains for both peers."""
    kinds = grains["material"].ravel().astype(int)
    with path.open("w") as file:
        file.write(f"grains\n\n{len(kinds)} atoms\n{len(problem.materials)} atom types\n\n")
        for axis, (low, high) in zip("xyz", problem.box, strict=True):
            file.write(f"{low!r} {high!r} {axis}lo {axis}hi\n")
        file.write(f"\nAtoms{style}\n\n")
        for number, (kind, radius, place) in enumerate(
            zip(kinds, grains["radius"].ravel(), grains.points, strict=True), 1
        ):
            density = MATERIALS[problem.materials[kind]][0]
            x, y, z = place.tolist()
            file.write(f"{number} {kind + 1} {2.0 * float(radius)!r} {density} {x!r} {y!r} {z!r}\n")
        file.write("\nVelocities\n\n")
        moves = np.column_stack([grains["velocity"], grains["angular_velocity"]])
        for number, row in enumerate(moves.tolist(), 1):
            file.write(f"{number} {' '.join(map(repr, row))}\n")


def pair(one, other):
    return PAIRS.get((one, other)) or PAIRS[other, one]


def silo_triangles(path):
    """The wall of the silo."""
    turns = [2.0 * math.pi * side / SIDES for side in range(SIDES + 1)]
    rings = [[(r * math.cos(turn), r * math.sin(turn), z) for turn in turns] for r, z in SILO]
    with path.open("w") as file:
        file.write("solid wall\n")
        for low, high in itertools.pairwise(rings):
            for side in range(SIDES):
                quad = low[side], low[side + 1], high[side + 1], high[side]
                for corners in ((quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])):
                    rows = "".join("vertex {!r} {!r} {!r}\n".format(*corner) for corner in corners)
                    file.write(f"facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet\n")
        file.write("endsolid wall\n")


COMMON = "atom_modify map array\nboundary f f f\nnewton off\n"
GRAVITY = "fix g all gravity 9.81 vector 0 0 -1\nfix integrate all nve/sphere\n"
PLANES = (("x", -0.05), ("x", 0.05), ("y", -0.03), ("y", 0.03), ("z", -0.0902431))
ENDS = (-0.03, 0.03)  # of the drum along y [m]
SPEED = 2.0 * 0.1  # of its surface [m/s]


def liggghts(name, problem, folder):
    """The deck without its steps."""
    steel = problem.materials.index("steel") + 1
    both = range(len(problem.materials))
    properties = {
        "youngsModulus peratomtype": [MATERIALS[it][1] for it in problem.materials],
        "poissonsRatio peratomtype": [POISSONS_RATIO for _ in both],
    }
    for place, key in enumerate(("coefficientRestitution", "coefficientFriction")):
        values = [pair(one, other)[place] for one in problem.materials for other in problem.materials]
        properties[f"{key} peratomtypepair {len(both)}"] = values
    style = "model hertz tangential history"
    text = f"atom_style granular\n{COMMON}communicate single vel yes\nunits si\nhard_particles yes\n"
    text += "read_data liggghts.data\n"
    text += f"neighbor {problem.skin} bin\nneigh_modify delay 0\n"
    for number, (key, values) in enumerate(properties.items()):
        text += f"fix m{number} all property/global {key} {' '.join(map(str, values))}\n"
    text += f"pair_style gran {style}\npair_coeff * *\n"
    wall = f"all wall/gran {style} primitive type {steel}"
    if name == "impact":
        for number, (axis, place) in enumerate(PLANES):
            text += f"fix w{number} {wall} {axis}plane {place}\n"
    elif name == "drum":
        text += f"fix w {wall} ycylinder 0.1 0.0 0.0 shear y {-SPEED}\n"
        text += "".join(f"fix e{number} {wall} yplane {place}\n" for number, place in enumerate(ENDS))
    else:
        silo_triangles(folder / "wall.stl")
        text += f"fix wall all mesh/surface file wall.stl type {steel}\n"
        text += f"fix walls all wall/gran {style} mesh n_meshes 1 meshes wall\n"
    return text + GRAVITY


def lammps(name, problem, _folder):
    """The deck without its steps: `hertz/material` with `coeff_restitution`, the law that is nearest to ours."""
    ratio = math.sqrt(2.0 * (1.0 - POISSONS_RATIO) / (2.0 - POISSONS_RATIO))

    def law(one, other):
        restitution, friction = pair(one, other)
        # A contact of one material with itself has the modulus of the pair.
        joint = 2.0 / (1.0 / MATERIALS[one][1] + 1.0 / MATERIALS[other][1])
        normal = f"hertz/material {joint!r} {restitution} {POISSONS_RATIO}"
        return f"{normal} tangential mindlin NULL {ratio!r} {friction} damping coeff_restitution"

    text = f"units si\natom_style sphere\n{COMMON}comm_modify vel yes\nread_data lammps.data\n"
    text += f"neighbor {problem.skin} bin\nneigh_modify delay 0 every 1 check yes\npair_style granular\n"
    for at, one in enumerate(problem.materials):
        for beyond, other in enumerate(problem.materials[at:], at):
            text += f"pair_coeff {at + 1} {beyond + 1} {law(one, other)}\n"
    wall = law("m1", "steel")
    if name == "impact":
        for number, (axis, place) in enumerate(PLANES):
            ends = f"NULL {place}" if place > 0.0 else f"{place} NULL"
            text += f"fix w{number} all wall/gran granular {wall} {axis}plane {ends}\n"
    elif name == "drum":
        for number, (group, kind) in enumerate((("small", 1), ("large", 2))):
            text += f"group {group} type {kind}\nregion r{number} cylinder y 0.0 0.0 0.1 {ENDS[0]} {ENDS[1]}"
            text += " side in rotate v_angle 0 0 0 0 1 0\n"
            law_here = law(problem.materials[kind - 1], "steel")
            text += f"fix w{number} {group} wall/gran/region granular {law_here} region r{number}\n"
        text = "variable angle equal -2.0*time\n" + text
    else:
        (low, bottom), (wide, middle), (_, top) = SILO
        text += f"region cone cone z 0.0 0.0 {low} {wide} {bottom} {middle} side in open 1 open 2\n"
        text += f"region tube cylinder z 0.0 0.0 {wide} {middle} {top} side in open 1 open 2\n"
        for part in ("cone", "tube"):
            text += f"fix {part} all wall/gran/region granular {wall} region {part}\n"
    return text + GRAVITY


def seconds(command, folder):
    """User time of a command."""
    before = os.times().children_user
    done = subprocess.run([str(word) for word in command], cwd=folder, check=False, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{command[0]}: {(done.stdout + done.stderr)[-2000:]}")
    return os.times().children_user - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=list(PROBLEMS))
    parser.add_argument("--from", dest="source", type=Path, required=True, help="folder of a run of the model")
    parser.add_argument("--time", type=float, help="of a frame of that run [s]; where it ended if not given")
    parser.add_argument("--steps", type=int, nargs=2, default=[200, 1200], help="of the short and the long run")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--cograin", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--liggghts", default=shutil.which("liggghts"))
    parser.add_argument("--lammps", default=shutil.which("lmp"))
    options = parser.parse_args()
    problem = PROBLEMS[options.what]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        grains = frame(Program(options.cograin), options.what, options.source, options.time, folder)
        commands = {}
        for steps in options.steps:
            values = {"run.end": steps * problem.step, "run.step": problem.step, "run.threads": 1}
            words = [word for key, value in values.items() for word in ("--set", f"{key}={value!r}")]
            commands["cograin", steps] = [
                options.cograin,
                "run",
                "scene.toml",
                "-o",
                f"out{steps}",
                "--overwrite",
                *words,
            ]
        for peer, program, deck, style in (
            ("LIGGGHTS", options.liggghts, liggghts, ""),
            ("LAMMPS", options.lammps, lammps, " # sphere"),
        ):
            if not program:
                print(f"{peer} is not installed")
                continue
            data_file(folder / f"{peer.lower()}.data", grains, problem, style)
            text = deck(options.what, problem, folder)
            for steps in options.steps:
                ending = f"timestep {problem.step!r}\nthermo {steps}\nthermo_style custom step atoms ke\n"
                ending += "thermo_modify lost ignore norm no\n"
                (folder / f"{peer}{steps}").write_text(f"{text}{ending}run {steps}\n")
                commands[peer, steps] = [program, "-in", f"{peer}{steps}", "-log", "none"]
        least = {}
        for _ in range(options.repeats):
            for key, command in commands.items():
                least[key] = min(seconds(command, folder), least.get(key, math.inf))
        short, long = options.steps
        counts = json.loads((folder / f"out{long}/summary.json").read_text())["counts"]
        print(f"{counts['particles']} grains, {counts['mean_contacts']:.0f} contacts, steps of {problem.step:g} s")
        costs = {
            name: (least[name, long] - least[name, short]) / (long - short) for name, steps in least if steps == long
        }
        for name, cost in costs.items():
            each, over = 1e9 * cost / counts["particles"], cost / costs["cograin"]
            print(f"{name}: {1e3 * cost:.3f} ms a step, {each:.1f} ns a grain, {over:.2f} times cograin")


if __name__ == "__main__":
    main()
