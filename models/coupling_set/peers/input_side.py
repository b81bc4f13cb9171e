"""Programs that read an input language line by line, as LAMMPS and LIGGGHTS do: what is the same in both."""

import math

import numpy as np
from worlds import Row

from peers import ParticleSide

CALMING = 0.5  # of spheres that come to rest, as by a fluid [kg/s]

# Where the driven end of a row, or a floor, stands: a step moves it from `begin` on at a constant `rate` for each time
# step.
PLACE = """
    variable begin equal 0
    variable rate equal 0
    variable first equal 0
    variable place equal v_begin+(step-v_first)*v_rate
"""


class InputSide(ParticleSide):
    """A side that has `command` for a line, and `atoms` for what it knows of its spheres, a line for each."""

    def __init__(self, problem):
        super().__init__(problem)
        self.row = isinstance(self.world, Row)
        self.weight, self.mean = 0.0, 0.0
        if self.row:
            self.axis, self.watched = 0, 1
            self._open_row()
        else:
            self.axis, self.watched = 2, 0
            self._open_floor()
        self.command("thermo 1000000")
        self.command(f"timestep {self.world.time_step!r}")
        if not self.row:
            self.weight = float(self.masses().sum()) * self.world.gravity
        self.command("run 0 post no")
        self.start = self.atoms("x")[self.watched, self.axis]

    def say(self, text):
        """Several lines of its input."""
        for line in text.strip().splitlines():
            self.command(line.strip())

    def _open_row(self):
        """Three points of mass with springs, which both programs have as a fix."""
        world, apart = self.world, 2.0 * self.world.radius
        self.say(f"""
            units si
            atom_style atomic
            atom_modify map array sort 0 0.0
            boundary f f f
            {self.space}
            create_box 1 space
            mass 1 {world.mass}
            neighbor 0.002 bin
        """)
        for number, name in enumerate(("fixed", "mass", "driven")):
            self.command(f"create_atoms 1 single {number * apart!r} 0 0 units box")
            self.command(f"group {name} id {number + 1}")
        self.say(PLACE)
        self.say(f"""
            velocity mass set {world.speed!r} 0 0 units box
            fix outer mass spring couple fixed {world.outer!r} {-apart!r} 0 0 0
            fix middle mass spring couple driven {world.middle!r} {apart!r} 0 0 0
            fix motion mass nve
            variable speed equal v_rate/{world.time_step!r}
            fix driven driven move variable v_place NULL NULL v_speed NULL NULL
        """)

    def settle(self):
        """Lets the spheres come to rest as in a fluid, if the world asks for it."""
        steps = getattr(self.world, "settling", 0)
        if steps:
            self.say(f"""
                timestep {self.world.time_step!r}
                fix calm all viscous {CALMING}
                run {steps} post no
                unfix calm
            """)

    def place_by_variables(self, place, count):
        """Says where the floor or the driven end goes in this many time steps."""
        begin = float(self.displacement[0])
        self.command(f"variable begin equal {begin!r}")
        self.command(f"variable rate equal {(place - begin) / count!r}")
        self.command(f"variable first equal {self.steps}")

    def advance(self, displacement, step, kind):
        """Moves the interface there during a step."""
        place, count = self.bounded(displacement, step), self.count(step)
        momentum = 0.0 if self.keeps_account else self._momentum()
        self.go(place, count, step.length)
        if not self.keeps_account:
            # Smooth walls carry nothing, so what the spheres lack of their weight's impulse is the floor's.
            self.mean = (momentum - self._momentum()) / step.length - self.weight
        self.steps += count
        self.displacement = displacement
        return self.force(kind)

    def force(self, kind):
        """Force of the spheres on the interface [N]: that of now, or the mean of the last step."""
        if kind == "mean":
            return np.array([self.mean])
        forces = self.atoms("f")
        return np.array([forces[2, 0] if self.row else -(forces[:, 2].sum() + self.weight)])

    def sphere(self):
        """How far the sphere that is watched has come, and its velocity [m, m/s]."""
        place = self.atoms("x")[self.watched, self.axis] - self.start
        return float(place), float(self.atoms("v")[self.watched, self.axis])

    def _momentum(self):
        """Of all spheres, upwards [N s]."""
        return float(self.masses() @ self.atoms("v")[:, 2])

    def masses(self):
        """Of the spheres, in the order of `atoms` [kg]."""
        radii = np.array(self.world.spheres)[:, 3]
        return 4.0 / 3.0 * math.pi * radii**3 * self.world.density
