"""Other particle programs as sides of the same exchanges, each where it is installed.

They have no unit, and most have no saved state, so only explicit exchanges can be had of them; a sphere falls on a
driven floor. Each runs in a process of its own: their libraries do not bear each other. Those that have an interpreter
of their own are spoken to line by line (`process.py`, `serving.py`).
"""

NAMES = ("lammps", "liggghts", "yade", "kratos")


class FallingSphere:
    """What the sides have in common: one sphere over a floor that goes at constant velocity through a step.

    A side keeps `time_step` \\[s\\] and says height and velocity of the sphere's lowest point.
    """

    names = ("floor.displacement.z",)
    can_restore = has_derivatives = False
    keeps_itself = True

    def __init__(self, problem, time_step):
        self.problem, self.time_step = problem, time_step
        self.steps, self.displacement = 0, [0.0]

    @property
    def time(self):
        """Where it stands [s]."""
        return self.steps * self.time_step

    @property
    def work(self):
        """Work of the floor on the sphere: what the sphere and its contact have, as nothing is lost [J]."""
        height, velocity = self.sphere()
        return float(self.problem.sphere_energy(height, velocity, float(self.displacement[0])))
