"""Coupled problems with closed forms: what they are made of, what is exact, and what a course is off by."""

import gzip
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from cograin import Oscillator, Structure
from scipy.optimize import brentq
from worlds import DENSITY, GRAVITY, OverFloor, Row

HERE = Path(__file__).resolve().parent
RADIUS = 0.05  # of the sphere that falls [m]
MASS = 4.0 / 3.0 * math.pi * RADIUS**3 * DENSITY  # of it [kg]


@dataclass
class Measure:
    """What one course of a problem came to."""

    error: float  # against the closed form, relative
    energy: float  # change of the energy of all that should keep it, relative
    interface: float  # energy made or lost between both sides, over the work that was exchanged


class Drop:
    """A sphere falls on a plate on a spring, without loss: free flight and two modes in contact, by turns.

    Heights count from the plate's place at rest under its own weight, where the sphere is 5 cm above it.
    """

    name, scene, end = "drop", "drop.toml", 0.3
    height, contact, plate, spring = 0.05, 1.0e5, 1.0, 1.0e4
    steps = (1e-5, 5e-5, 1e-4, 5e-4, 1e-3, 2e-3)
    watch = ("ball.displacement.z", "ball.velocity.z")
    exact_error = "largest error of both displacements until just after the first separation"

    def partner(self):
        return Oscillator(self.plate, self.spring)

    def world(self):
        """For other programs."""
        return OverFloor([(0.0, 0.0, self.height + RADIUS, RADIUS)], 1e-5, self.contact)

    def exact(self, times):
        """Height and velocity of the sphere's lowest point, displacement and velocity of the plate; times of events."""
        state, begin, touching, found, events = np.array([self.height, 0.0, 0.0, 0.0]), 0.0, False, [], []
        times = list(times)
        while times:
            motion = self._contact if touching else self._flight
            event = self._event(motion, state, touching, times[-1] - begin)
            while times and times[0] - begin <= event:
                found.append(motion(state, times.pop(0) - begin))
            if not times:
                break
            state, begin, touching = motion(state, event), begin + event, not touching
            events.append(begin)
        return np.array(found), events

    def _flight(self, state, time):
        height, velocity, place, speed = state
        rate = math.sqrt(self.spring / self.plate)
        cosine, sine = math.cos(rate * time), math.sin(rate * time)
        fallen = height + velocity * time - 0.5 * GRAVITY * time**2
        swung = place * cosine + speed / rate * sine
        return np.array([fallen, velocity - GRAVITY * time, swung, speed * cosine - place * rate * sine])

    def _contact(self, state, time):
        matrix = np.array(
            [
                [self.contact / MASS, -self.contact / MASS],
                [-self.contact / self.plate, (self.spring + self.contact) / self.plate],
            ]
        )
        weight = MASS * GRAVITY
        rest = np.array([-weight / self.spring - weight / self.contact, -weight / self.spring])
        squares, shapes = np.linalg.eig(matrix)
        rates, back = np.sqrt(squares), np.linalg.inv(shapes)
        place, speed = back @ (state[[0, 2]] - rest), back @ state[[1, 3]]
        cosine, sine = np.cos(rates * time), np.sin(rates * time)
        displacement = shapes @ (place * cosine + speed / rates * sine) + rest
        velocity = shapes @ (speed * cosine - place * rates * sine)
        return np.array([displacement[0], velocity[0], displacement[1], velocity[1]])

    @staticmethod
    def _event(motion, state, touching, horizon):
        """Time from now until the sphere leaves or meets the plate."""

        def gap(time):
            now = motion(state, time)
            return (now[0] - now[2]) * (-1.0 if touching else 1.0)

        step = 1e-4
        for count in range(1, math.ceil(horizon / step) + 2):
            # Over the first step the gap begins at 0, or is far from it.
            if gap(count * step) < 0.0:
                low = (count - 1) * step or 1e-9
                return brentq(gap, low, count * step, xtol=1e-16)
        return math.inf

    def particle_energy(self, fallen, velocity, plate):
        """Of the sphere and its contact [J]."""
        height = self.height + fallen
        overlap = np.maximum(plate - height, 0.0)
        return 0.5 * MASS * velocity**2 + MASS * GRAVITY * height + 0.5 * self.contact * overlap**2

    def measure(self, record, names, speeds):
        """What the course is off by; `speeds` are those of the plate."""
        time, plate = record["time"], record[names[0]]
        height, velocity = self.height + record[names[1]], record[names[2]]
        exact, events = self.exact(time)
        first = time < events[1] + 1e-3
        error = 0.0
        for ours, theirs in ((height, exact[:, 0]), (plate, exact[:, 2])):
            error = max(error, np.abs(ours - theirs)[first].max() / np.abs(theirs).max())
        start = MASS * GRAVITY * self.height
        energy = self.particle_energy(record[names[1]], velocity, plate)
        total = energy + 0.5 * self.plate * speeds**2 + 0.5 * self.spring * plate**2
        return Measure(error, np.abs(total - start).max() / start, share(record))


class Rod:
    """A sphere meets a semi-infinite elastic rod, which is a dashpot Z = A √(E ρ) until a wave would come back."""

    name, scene, end = "rod", "rod.toml", 2e-3
    contact, speed = 1.0e7, 1.0
    area, youngs_modulus, density = 1e-4, 210e9, 7850.0
    steps = (1e-6, 1e-5, 5e-5)
    watch = ("ball.displacement.z", "ball.velocity.z")
    exact_error = "error of the coefficient of restitution"

    @property
    def impedance(self):
        """[N s/m]"""
        return self.area * math.sqrt(self.youngs_modulus * self.density)

    @property
    def restitution(self):
        """exp(−π ζ/√(1 − ζ²)) with ζ = √(k m)/(2 Z)."""
        ratio = math.sqrt(self.contact * MASS) / (2.0 * self.impedance)
        return math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))

    def partner(self):
        return Oscillator(0.0, 0.0, self.impedance)

    def world(self):
        """For other programs."""
        sphere = (0.0, 0.0, RADIUS, RADIUS)
        return OverFloor([sphere], 1e-6, self.contact, gravity=0.0, velocity=-self.speed)

    def particle_energy(self, height, velocity, end):
        """Of the sphere and its contact [J]."""
        return 0.5 * MASS * velocity**2 + 0.5 * self.contact * np.maximum(end - height, 0.0) ** 2

    def measure(self, record, names, speeds):
        """What the course is off by."""
        kept = record[names[2]][-1] / self.speed
        lost = 0.5 * MASS * self.speed**2 * (1.0 - self.restitution**2)
        partner = float(np.sum(record["exchanged_work"]))
        change = 0.5 * MASS * (record[names[2]][-1] ** 2 - self.speed**2)
        return Measure(abs(kept / self.restitution - 1.0), abs(change + partner) / lost, share(record))


class FiniteRod(Rod):
    """The same rod, 4 m of it in 400 finite elements of scikit-fem: no wave is back within 1.5 ms."""

    name, end = "rod of elements", 1.5e-3
    length, elements = 4.0, 400

    def partner(self):
        import skfem
        from skfem.helpers import dot, grad

        basis = skfem.Basis(skfem.MeshLine(np.linspace(0.0, self.length, self.elements + 1)), skfem.ElementLineP1())
        tension, weight = self.youngs_modulus * self.area, self.density * self.area
        stiffness = skfem.BilinearForm(lambda u, v, _: tension * dot(grad(u), grad(v))).assemble(basis)
        mass = skfem.BilinearForm(lambda u, v, _: weight * u * v).assemble(basis)
        first, last = basis.nodal_dofs[0, 0], basis.nodal_dofs[0, -1]
        return Structure(mass, stiffness, at=first, fixed=[last])


class TwoMasses:
    """1 kg and 1 kg between springs of 4 π², 16 π², 4 π² N/m: 1 Hz and 3 Hz. The left mass begins at 1 cm/s."""

    name, scene, end = "two masses", "oscillator.toml", 1.0
    steps = (5e-3, 1e-2, 2e-2, 4e-2)
    outer, middle, speed = 4.0 * math.pi**2, 16.0 * math.pi**2, 0.01
    interface, watch = "right.displacement.x", ("mass.displacement.x", "mass.velocity.x")
    exact_error = "largest error of both displacements"

    def partner(self):
        return Oscillator(1.0, self.outer)

    def world(self):
        """For other programs."""
        return Row(5e-4, self.outer, self.middle, self.speed)

    def particle_energy(self, place, velocity, right):
        """Of the left mass and the springs on both of its sides [J]."""
        return 0.5 * (velocity**2 + self.outer * place**2 + self.middle * (right - place) ** 2)

    def measure(self, record, names, speeds):
        """What the course is off by."""
        time, right, left, velocity = record["time"], *(record[name] for name in names)
        slow, fast = np.sin(2 * np.pi * time) / (2 * np.pi), np.sin(6 * np.pi * time) / (6 * np.pi)
        half = 0.5 * self.speed
        error = max(np.abs(left - half * (slow + fast)).max(), np.abs(right - half * (slow - fast)).max())
        energy = velocity**2 + speeds**2 + self.outer * (left**2 + right**2) + self.middle * (left - right) ** 2
        drift = abs(energy[-1] / self.speed**2 - 1.0)
        return Measure(error / (self.speed / (2 * np.pi)), drift, share(record))


class Bed:
    """1,000 spheres on a plate on a spring: in the end it sags by weight over stiffness."""

    name, scene, end = "bed", "bed.toml", 0.3
    spring = 1.0e4
    masses, steps = (0.1, 0.01, 0.001, 0.0), (5e-5, 2e-4, 1e-3)
    weight = 1000 * 4.0 / 3.0 * math.pi * 0.005**3 * DENSITY * GRAVITY
    watch = ()

    def world(self):
        """For other programs."""
        with gzip.open(HERE / "bed.csv.gz", "rt") as text:
            spheres = np.loadtxt(text, delimiter=",", skiprows=1).tolist()
        return OverFloor(spheres, 5e-5, 1.0e4, damping=1685.0, width=0.105)

    @property
    def sag(self):
        """[m]"""
        return self.weight / self.spring


def share(record):
    """Energy made or lost between both sides, at its largest, over the work that was exchanged."""
    return float(np.abs(np.cumsum(record["interface_energy"])).max() / max(record.exchanged_work, 1e-300))
