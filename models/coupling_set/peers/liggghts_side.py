"""LIGGGHTS by its C library: the floor is a mesh that moves at constant velocity; its force is the spheres'."""

import ctypes
import tempfile
from pathlib import Path

import numpy as np

from peers.input_side import InputSide
from worlds import OverFloor, Rough, Row

library = ctypes.CDLL("libliggghts.so.3", mode=ctypes.RTLD_GLOBAL)
library.lammps_extract_atom.restype = ctypes.c_void_p


class Side(InputSide):
    """Spheres in LIGGGHTS."""

    ends_all = True
    worlds = (OverFloor, Rough, Row)

    def __init__(self, problem):
        #: How far the floor reaches, a triangle under the whole box. Every run looks for neighbours anew, which takes the longer,
        #: the larger the space.
        width = getattr(problem.world(), "width", 0.0)
        self.low, self.high = (-0.1, 2.0 * width + 0.15) if width else (-0.3, 0.9)
        self.reach = f"{self.low - 0.01} {self.high + 0.01}"  # of the space along x and along y
        words = (ctypes.c_char_p * 5)(b"liggghts", b"-log", b"none", b"-screen", b"/dev/null")
        self.handle = ctypes.c_void_p()
        library.lammps_open_no_mpi(5, words, ctypes.byref(self.handle))
        self.folder = tempfile.TemporaryDirectory()
        super().__init__(problem)

    @property
    def space(self):
        """Where spheres may be."""
        return f"region space block {self.reach} {self.reach} -0.3 0.5 units box"

    def _contact(self):
        """The law of its contacts, and the coefficients of it: the first material is rough, the second is smooth."""
        world = self.world
        if isinstance(world, Rough):
            return "model hertz tangential history", f"""
                fix youngs all property/global youngsModulus peratomtype {world.youngs_modulus} {world.youngs_modulus}
                fix poisson all property/global poissonsRatio peratomtype {world.poissons_ratio} {world.poissons_ratio}
                fix bounce all property/global coefficientRestitution peratomtypepair 2 {_pairs(world.restitution)}
                fix slip all property/global coefficientFriction peratomtypepair 2 {world.friction} 0.0 0.0 0.0
            """
        return "model hooke/stiffness tangential off", f"""
            fix stiffness all property/global kn peratomtypepair 2 {_pairs(world.stiffness)}
            fix sideways all property/global kt peratomtypepair 2 {_pairs(0.0)}
            fix damping all property/global gamman peratomtypepair 2 {_pairs(world.damping)}
            fix friction all property/global gammat peratomtypepair 2 {_pairs(0.0)}
            fix slip all property/global coefficientFriction peratomtypepair 2 {_pairs(0.0)}
        """

    def _open_floor(self):
        world = self.world
        contact, coefficients = self._contact()
        self.say(f"""
            units si
            atom_style granular
            atom_modify map array
            boundary f f f
            newton off
            communicate single vel yes
            read_data {self._spheres()}
            neighbor 0.002 bin
            neigh_modify delay 0 every 1 check yes
            hard_particles yes
        """)
        self.say(coefficients)
        self.say(f"""
            pair_style gran {contact}
            pair_coeff * *
            velocity all set 0 0 {world.velocity!r} units box
            fix floor all mesh/surface/stress file {self._mesh()} type 1
            fix wall all wall/gran {contact} mesh n_meshes 1 meshes floor
            variable none equal 0.0
            variable speed equal 0.0
            fix move all move/mesh mesh floor linear/variable v_none v_none v_speed
            fix motion all nve/sphere
        """)
        for axis in ("x", "y") if world.width else ():
            for place in (0.0, world.width):
                name = f"{axis}{place:g}".replace(".", "_")
                self.command(f"fix {name} all wall/gran {contact} primitive type 2 {axis}plane {place!r}")
        if world.gravity:
            self.command(f"fix weight all gravity {world.gravity} vector 0 0 -1")
        self.settle()

    def _mesh(self):
        """A file with the floor, a triangle."""
        path = Path(self.folder.name) / "floor.stl"
        places = (self.low, self.low), (self.high, self.low), (self.low, self.high)
        corners = "".join(f"vertex {x} {y} 0\n" for x, y in places)
        path.write_text(f"solid f\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid f\n")
        return path

    def _spheres(self):
        """A file with the spheres of the problem: number, kind, diameter, density, place."""
        spheres = self.world.spheres
        lines = [f"{self.reach} {axis}lo {axis}hi" for axis in "xy"] + ["-0.3 0.5 zlo zhi", "", "Atoms", ""]
        for number, (x, y, z, radius) in enumerate(spheres, 1):
            lines.append(f"{number} 1 {2.0 * radius!r} {self.world.density!r} {x!r} {y!r} {z!r}")
        path = Path(self.folder.name) / "spheres.data"
        path.write_text("\n".join(["spheres", "", f"{len(spheres)} atoms", "2 atom types", "", *lines, ""]))
        return path

    def masses(self):
        """Of the spheres, in the order of `atoms` [kg]."""
        found = library.lammps_extract_atom(self.handle, b"rmass")
        return np.ctypeslib.as_array(ctypes.cast(found, ctypes.POINTER(ctypes.c_double)), (len(self.world.spheres),))

    def command(self, text):
        """One line of its input."""
        library.lammps_command(self.handle, text.encode())

    def atoms(self, name):
        """What it knows of its spheres, a line for each."""
        rows = ctypes.cast(
            library.lammps_extract_atom(self.handle, name.encode()), ctypes.POINTER(ctypes.POINTER(ctypes.c_double))
        )
        count = 3 if self.row else len(self.world.spheres)
        return np.ctypeslib.as_array(rows[0], (count, 3))

    def go(self, place, count, length):
        """So many time steps."""
        if self.row:
            self.place_by_variables(place, count)
        else:
            self.command(f"variable speed equal {(place - float(self.displacement[0])) / length!r}")
        # With "pre no" a sphere falls through the mesh, and variables that were given anew are taken for others.
        self.command(f"run {count} pre yes post no")

    def close(self):
        """Ends it."""
        library.lammps_close(self.handle)
        self.folder.cleanup()


def _pairs(value):
    """A coefficient of all pairs of two materials."""
    return " ".join([str(value)] * 4)
