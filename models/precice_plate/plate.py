"""The plate as a participant of preCICE: the finite elements of models/plate, under the forces of the grains."""

import argparse
import csv
import importlib.util
import math
from pathlib import Path

import numpy as np

from cograin import Step

HERE = Path(__file__).resolve().parent
LOWERING = 0.05  # time in which the jacks let go [s]


def elements():
    """The module of models/plate."""
    found = importlib.util.spec_from_file_location("plate_elements", HERE.parent / "plate" / "plate.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def jacks(held):
    """What holds the plate straight at first, and then lets go, as a function of time [N]."""
    return lambda time: 0.5 * held * (1.0 + math.cos(math.pi * min(time / LOWERING, 1.0)))


def run(participant, cells=12):
    """Takes part until the end; time and deflection of the middle [m] for each time window."""
    parts, mesh, time, rows, kept = elements(), "Plate-Mesh", 0.0, [], None
    plate = parts.Plate(parts.Design(), cells)
    vertices = participant.set_mesh_vertices(mesh, plate.places)
    participant.set_mesh_triangles(mesh, np.asarray(vertices)[plate.triangles])
    participant.initialize()

    def forces(length):
        return participant.read_data(mesh, "Force", vertices, length).reshape(-1, 3)[plate.inside, 2]

    plate = parts.Plate(parts.Design(), cells, jacks(-forces(0.0)))
    while participant.is_coupling_ongoing():
        if participant.requires_writing_checkpoint():
            kept = time, plate.memory()
        length = participant.get_max_time_step_size()
        step, force = Step(time, time + length, length), forces(length)
        plate.advance(force, plate.predict(force, step), step)
        moved = np.zeros_like(plate.places)
        moved[:, 2] = plate.deflections
        participant.write_data(mesh, "Displacement", vertices, moved)
        participant.advance(length)
        time = step.end
        if participant.requires_reading_checkpoint():
            time, memory = kept
            plate.recall(memory)
        else:
            rows.append((time, plate.deflections[plate.middle]))
    participant.finalize()
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default=HERE / "precice-config.xml", help="configuration of preCICE")
    parser.add_argument("--output", type=Path, default=Path("out/precice_plate"), help="folder of all results")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    import precice

    rows = run(precice.Participant("Plate", str(options.config), 0, 1))
    with open(options.output / "plate.csv", "w", newline="") as text:
        csv.writer(text).writerows([["time", "deflection"], *rows.tolist()])


if __name__ == "__main__":
    main()
