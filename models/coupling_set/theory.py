"""What linear algebra says of an exchange between two oscillators: growth from step to step, without running a unit.

The particles are one mass between a fixed spring and one to the interface, stepped by velocity Verlet while the
interface moves at constant velocity; the partner is the mass on a spring and dashpot of `cograin.Oscillator`.
"""

import math

import numpy as np
from problems import TwoMasses


ROUNDING = 1e-9  # of a largest eigenvalue


class Linear:
    """One communication step as a matrix on (position, velocity, partner's place, velocity, exchanged force)."""

    def __init__(self, exchange, mass, damping_ratio, time_step):
        problem = TwoMasses()
        self.exchange, self.mass, self.time_step = exchange, mass, time_step
        self.outer, self.middle = problem.outer, problem.middle
        self.damping = 2.0 * damping_ratio * math.sqrt(self.outer * mass)

    def particles(self, state, begin, end, count):
        """State of the mass after a ramp, force on the interface at its end and in its mean."""
        place, speed = state
        stiff, mean = self.outer + self.middle, 0.0
        for number in range(count):
            ends = [begin + (end - begin) * (number + part) / count for part in (0, 1)]
            force = self.middle * ends[0] - stiff * place
            pull = self.middle * (place - ends[0])
            speed += 0.5 * self.time_step * force
            place += self.time_step * speed
            speed += 0.5 * self.time_step * (self.middle * ends[1] - stiff * place)
            mean += 0.5 * (pull + self.middle * (place - ends[1])) / count
        return (place, speed), self.middle * (place - end), mean

    def partner(self, state, force, length):
        """The partner after a step of average acceleration under a force."""
        place, speed, half = *state, 0.5 * length
        held = self.mass + half * self.damping + half * half * self.outer
        mean = (self.mass * speed + half * (force - self.outer * place)) / held
        return place + length * mean, 2.0 * mean - speed

    def step(self, values, count):
        """All values one communication step later."""
        place, speed, there, moving, force = values
        length = count * self.time_step
        if self.exchange == "Gauss–Seidel":
            end, after = self.partner((there, moving), force, length)
            (place, speed), force, _ = self.particles((place, speed), there, end, count)
            return place, speed, end, after, force
        half = moving + 0.5 * length * (force - self.outer * there - self.damping * moving) / self.mass
        end = there + length * half
        (place, speed), force, _ = self.particles((place, speed), there, end, count)
        pushed = self.mass * half + 0.5 * length * (force - self.outer * end)
        after = pushed / (self.mass + 0.5 * length * self.damping)
        return place, speed, end, after, force

    def radius(self, count):
        """Largest growth of a communication step of so many time steps."""
        if self.exchange == "Jacobi":
            return self._lagging(count)
        columns = [self.step(unit, count) for unit in np.eye(5)]
        return float(np.abs(np.linalg.eigvals(np.array(columns).T)).max())

    def _lagging(self, count):
        """The same with one value more: where the units stand, a step behind the partner."""
        length = count * self.time_step

        def step(values):
            place, speed, there, moving, force, stood = values
            end, after = self.partner((there, moving), force, length)
            (place, speed), found, _ = self.particles((place, speed), stood, there, count)
            return place, speed, end, after, found, there

        return float(np.abs(np.linalg.eigvals(np.array([step(unit) for unit in np.eye(6)]).T)).max())

    def border(self, counts, growth=1.0):
        """The smallest step of so many time steps with more growth a step than this [s]; infinity where none has."""
        for count in counts:
            if self.radius(int(count)) > growth + ROUNDING:
                return count * self.time_step
        return np.inf


class FixedPointGain(Linear):
    """A repeated exchange without acceleration converges while its gain is below 1."""

    def radius(self, count):
        """Stiffness of the particles over the step × compliance of the partner over the step."""
        length = count * self.time_step
        _, _, mean = self.particles((0.0, 0.0), 0.0, 1.0, count)
        return abs(mean) * self.partner((0.0, 0.0), 1.0, length)[0]

    def border(self, counts, growth=1.0):
        """A step that does not converge is seen at once, however fast it grows."""
        return super().border(counts)
