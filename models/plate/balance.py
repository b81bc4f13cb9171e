"""What a run is held against: the weight, the plate's closed solution under the forces of the grains, and the work."""

from dataclasses import dataclass

import meshio
import numpy as np
from plate import navier, navier_evenly

GRAVITY = 9.81  # [m/s²], as in scene.toml
LAST = 0.04  # time at the end over which means are taken [s]
FRAME = 5e-3  # between frames of the replay [s]


@dataclass
class Bed:
    """The grains and their contacts with the skin in one frame of a replay."""

    centres: np.ndarray  # [m]
    radii: np.ndarray  # [m]
    mass: float  # of all grains [kg]
    points: np.ndarray  # of the contacts with the skin [m]
    forces: np.ndarray  # on the skin there, upwards [N]

    @classmethod
    def read(cls, folder, number):
        """A frame by its number."""
        grains = meshio.read(folder / f"particles_{number:06d}.vtu")
        contacts = meshio.read(folder / f"contacts_{number:06d}.vtu")
        of = contacts.point_data
        skin = of["boundary"].ravel() == 0  # the first boundary of the scene
        push = of["normal_force"].reshape(-1, 1) * of["normal"] + of["tangential_force"]
        mass = float(grains.point_data["mass"].sum())
        radii = grains.point_data["radius"].ravel()
        return cls(grains.points, radii, mass, contacts.points[skin], -push[skin, 2])


def replayed(program, scene, settled, inputs, folder, options):
    """The frames of the last part of a run that repeats a course of the skin, without a unit."""
    settings = {
        "boundary.skin.mesh.file": f'"{options.skin}"',
        "run.end": round(options.end / options.interval) * options.interval,
        "output.history_interval": options.interval,
        "output.frame_interval": FRAME,
        "output.contacts": "true",
    }
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    program("run", scene, "--from", settled, "--inputs", inputs, "--overwrite", "-o", folder, *words)
    last = round(options.end / FRAME)
    return [Bed.read(folder, number) for number in range(last - round(LAST / FRAME) + 1, last + 1)]


def report(program, scene, settled, inputs, plate, rows, options):
    """Prints the comparisons of the page; gives the beds of the last frames and the reference of the deflection [m]."""
    beds = replayed(program, scene, settled, inputs, inputs.with_suffix(""), options)
    design, weight = plate.design, beds[-1].mass * GRAVITY
    time, deflection, force, jack, work, plate_work, _ = rows.T
    at_end = time > options.end - LAST + 1e-9
    print(f"  weight of the grains {weight:.5f} N, force on the skin {-force[at_end].mean():.5f} N", end="")
    print(f": {-force[at_end].mean() / weight - 1.0:+.1e}; last jack {jack[-1]:.1e} N")
    reference = np.mean([navier(design, bed.points, bed.forces) for bed in beds])
    evenly = navier_evenly(design, -weight)
    reached = deflection[at_end].mean()
    print(
        f"  deflection of the middle {1e6 * reached:.3f} µm, ± {1e6 * deflection[at_end].std():.3f} µm in the last 40 ms"
    )
    print(
        f"  after Navier, under the forces at the contacts {1e6 * reference:.3f} µm: {reached / reference - 1.0:+.2%}"
    )
    print(f"  after Navier, under the weight spread out evenly {1e6 * evenly:.3f} µm: {reached / evenly - 1.0:+.2%}")
    turnover = np.abs(force * np.diff(deflection, prepend=0.0)).sum()
    print(f"  work of the grains on the skin: unit {-work[-1]:.12e} J, plate {plate_work[-1]:.12e} J: ", end="")
    print(f"{(plate_work[-1] + work[-1]) / turnover:+.1e} of the turnover")
    gained = plate.energy + plate.loss - plate.correction
    print(f"  plate: {gained:.9e} J stored and lost, {plate.work + plate.load_work:.9e} J given by grains and jacks")
    return beds, reference
