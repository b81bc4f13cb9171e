"""The bed of models/loaded_beam as a problem of the set: 20,000 spheres on a plate that an elastic beam carries."""

import sys
from pathlib import Path

import numpy as np
from cograin import Unit
from problems import GRAVITY, Measure, share
from worlds import Rough

MODEL = Path(__file__).resolve().parents[1] / "loaded_beam"
sys.path.append(str(MODEL))

from balance import LAST  # noqa: E402
from beam import Beam, Design  # noqa: E402
from loads import jack_force, particles, weight_of  # noqa: E402


class LoadedBeam:
    """A jack lowers the plate within an eighth of a second; then the beam sags by weight × its compliance."""

    name, scene, end = "loaded beam", "loaded_beam.toml", 0.25
    steps, lowering = (2e-3,), 0.125
    exchanges = ("Gauss–Seidel", "Verlet", "secant", "quasi-Newton")
    watch = tuple(f"{wall}.force.z" for wall in ("x_low", "x_high", "y_low", "y_high"))
    exact_error = "error of the sag at the end, against (weight of bed and plate − force on the walls) × ℓ³/(48 E I)"
    design = Design()

    def open(self, command, folder):
        """The settled bed as a unit."""
        settled = folder / "loaded_beam.checkpoint"
        print(command.settle(MODEL / "scene.toml", settled), flush=True)
        unit = Unit(command.export(MODEL / "scene.toml", folder / "loaded_beam.fmu", start=settled))
        self.hold(-unit["floor.force.z"])
        return unit

    def hold(self, force):
        """Takes note of what weighs on the floor as it begins [N]."""
        self.held = force
        self.weight = weight_of(particles())  # of the bed [N]
        self.plate = self.design.plate_mass * GRAVITY

    def world(self):
        """For other programs."""
        spheres = particles()[:, :4].tolist()
        return Rough(spheres, 2e-5, 5e7, 0.3, 0.5, 0.5, width=0.2448, settling=1000)

    def watched(self, side):
        """Forces on the walls, which are smooth, in a program that does not say them."""
        return (0.0,) * len(self.watch)

    def partner(self):
        load = self.held + self.plate
        self.beam = Beam(self.design, lambda now: jack_force(load, now, self.lowering) - self.plate)
        return self.beam

    def measure(self, record, names, speeds):
        """What the course is off by: the sag and the book of the beam."""
        late = record["time"] > record["time"][-1] - LAST
        on_walls = -sum(record[name][late].mean() for name in self.watch)
        sag = -record[names[0]][late].mean()
        beam = self.beam
        left = beam.work + beam.load_work + beam.correction - beam.energy - beam.loss
        expected = (self.weight - on_walls + self.plate) * self.design.compliance
        turned = np.abs(beam.work) + np.abs(beam.load_work)
        return Measure(abs(sag / expected - 1.0), abs(left) / turned, share(record))
