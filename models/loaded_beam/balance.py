"""What the run is held against: the weight, the static sag, and the energy on both sides of the interface."""

import numpy as np
from loads import GRAVITY

LAST = 0.05  # time at the end over which forces are averaged [s]


def report(design, beam, rows, weight):
    """Prints the balances of a run and its error; gives the static reference of the floor's displacement [m]."""
    time, height, _, mean_force, walls, jack, work, _ = rows.T
    settled = time > time[-1] - LAST
    plate_weight = design.plate_mass * GRAVITY
    walls = walls[settled].mean()
    forces(-mean_force[settled].mean(), -walls, weight)
    reference = -(weight + walls + plate_weight) * design.compliance
    sag(design, beam, height[-1], reference)

    moved = np.diff(height, prepend=0.0)
    of_grains, of_others = float(mean_force @ moved), float((jack - plate_weight) @ moved)
    energy(beam, work[-1], of_grains, of_others)
    return reference


def forces(floor, walls, weight):
    """Floor + walls = weight."""
    print(f"\nforces on the boundaries, mean of the last {LAST * 1e3:g} ms [N]")
    error = (floor + walls) / weight - 1.0
    print(f"  floor {floor:.4f} + walls {walls:.4f} = {floor + walls:.4f}")
    print(f"  weight of the bed {weight:.4f}, relative error {error:+.1e}")


def sag(design, beam, height, reference):
    """The floor beside the static reference."""
    elements = beam.static_compliance
    print("\nstatic reference: (weight of bed and plate − vertical force on the walls) × compliance of the beam")
    print(f"  compliance {design.compliance:.6e} m/N; of the finite elements {elements:.6e} m/N")
    error = height / reference - 1.0
    print(f"  sag {-reference * 1e3:.5f} mm, reached {-height * 1e3:.5f} mm, relative error {error:+.1e}")


def energy(beam, work, of_grains, of_others):
    """What the grains did to the floor, from both sides; and where the beam has it."""
    print("\nenergy books [J]")
    print(f"  interface: floor.work {work:+.12f}, −Σ mean_force·Δdisplacement {-of_grains:+.12f}")
    print(f"             difference {work + of_grains:+.1e}")
    print(f"  beam: work of the grains {of_grains:+.9f}, of jack and plate's weight {of_others:+.9f}")
    print(f"        stored {beam.energy:.9f}, lost in damping {beam.loss:.9f}")
    residual = of_grains + of_others - beam.energy - beam.loss
    print(f"        residual {residual:+.1e}: what the tolerance of the exchange lets through")
