"""LIGGGHTS by its C library: the floor is a mesh that moves at constant velocity; its force is the sphere's."""

import ctypes
import tempfile
from pathlib import Path

import numpy as np
from problems import GRAVITY, MASS, RADIUS

from peers import FallingSphere

library = ctypes.CDLL("libliggghts.so.3", mode=ctypes.RTLD_GLOBAL)
library.lammps_extract_atom.restype = ctypes.c_void_p


class Side(FallingSphere):
    """One sphere in LIGGGHTS."""

    def __init__(self, problem, time_step, height, velocity, gravity):
        super().__init__(problem, time_step)
        self.weight = MASS * GRAVITY if gravity else 0.0
        words = (ctypes.c_char_p * 5)(b"liggghts", b"-log", b"none", b"-screen", b"/dev/null")
        self.handle = ctypes.c_void_p()
        library.lammps_open_no_mpi(5, words, ctypes.byref(self.handle))
        self.folder = tempfile.TemporaryDirectory()
        floor = Path(self.folder.name) / "floor.stl"
        corners = "".join(f"vertex {x} {y} 0\n" for x, y in ((-0.3, -0.3), (0.9, -0.3), (-0.3, 0.9)))
        floor.write_text(f"solid f\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid f\n")
        setup = f"""
            units si
            atom_style granular
            atom_modify map array
            boundary f f f
            newton off
            communicate single vel yes
            region space block -1 1 -1 1 -0.3 0.5 units box
            create_box 1 space
            neighbor 0.002 bin
            neigh_modify delay 0 every 1 check yes
            hard_particles yes
            fix stiffness all property/global kn peratomtypepair 1 {problem.contact}
            fix sideways all property/global kt peratomtypepair 1 0.0
            fix damping all property/global gamman peratomtypepair 1 0.0
            fix friction all property/global gammat peratomtypepair 1 0.0
            fix slip all property/global coefficientFriction peratomtypepair 1 0.0
            pair_style gran model hooke/stiffness tangential off
            pair_coeff * *
            create_atoms 1 single 0 0 {height + RADIUS!r} units box
            set atom 1 diameter {2 * RADIUS} density 2500
            velocity all set 0 0 {velocity!r} units box
            fix floor all mesh/surface/stress file {floor} type 1
            fix wall all wall/gran model hooke/stiffness tangential off mesh n_meshes 1 meshes floor
            fix motion all nve/sphere
            timestep {time_step!r}
            thermo 1000000
        """
        for line in setup.strip().splitlines():
            self.command(line.strip())
        if gravity:
            self.command(f"fix weight all gravity {GRAVITY} vector 0 0 -1")
        self.command("run 0 post no")

    def command(self, text):
        """One line of its input."""
        library.lammps_command(self.handle, text.encode())

    def _vector(self, name):
        """Three numbers of the sphere."""
        rows = ctypes.cast(
            library.lammps_extract_atom(self.handle, name), ctypes.POINTER(ctypes.POINTER(ctypes.c_double))
        )
        return rows[0][:3]

    def force(self, kind):
        """Force of the sphere on the floor [N]."""
        return np.array([-(self._vector(b"f")[2] + self.weight)])

    def advance(self, displacement, step, kind):
        """Moves the floor there during a step."""
        count = round(step.length / self.time_step)
        rate = (float(displacement[0]) - float(self.displacement[0])) / step.length
        self.command(f"fix move all move/mesh mesh floor linear 0. 0. {rate!r}")
        # Without "pre yes" a sphere falls through the mesh.
        self.command(f"run {count} pre yes post no")
        self.command("unfix move")
        self.steps += count
        self.displacement = displacement
        return self.force(kind)

    def sphere(self):
        """Height and velocity of the sphere's lowest point [m, m/s]."""
        return self._vector(b"x")[2] - RADIUS, self._vector(b"v")[2]

    def close(self):
        """Ends it."""
        library.lammps_close(self.handle)
        self.folder.cleanup()
