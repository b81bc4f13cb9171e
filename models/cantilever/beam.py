"""The beam on paper: its static deflection, the eigenfrequencies of the chain, and those of a Timoshenko beam."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Beam:
    """What scene.toml says of the beam."""

    bonds: int = 20
    radius: float = 1.0e-3  # of spheres and bonds [m]
    density: float = 2500.0  # [kg/m³]
    normal: float = 1.0e12  # stiffness per unit area [Pa/m]
    tangential: float = 4.0e11  # [Pa/m]

    @property
    def spacing(self):
        """Length of a bond [m]."""
        return 2.0 * self.radius

    @property
    def length(self):
        """From the clamped centre to that of the tip [m]."""
        return self.bonds * self.spacing

    @property
    def shear_rigidity(self):
        """κ G A [N]."""
        return self.tangential * self.spacing * np.pi * self.radius**2

    @property
    def bending_rigidity(self):
        """E I [N m²]."""
        return self.normal * self.spacing * np.pi * self.radius**4 / 4.0

    @property
    def mass(self):
        """Of a sphere [kg]."""
        return 4.0 / 3.0 * np.pi * self.radius**3 * self.density

    @property
    def inertia(self):
        """Of a sphere [kg m²]."""
        return 0.4 * self.mass * self.radius**2

    def compliance(self):
        """Deflection of the tip per force [m/N]: bending, as a chain of bonds does it, and shear."""
        bending = self.length**3 / (3.0 * self.bending_rigidity) * (1.0 - 1.0 / (4.0 * self.bonds**2))
        return bending + self.length / self.shear_rigidity

    def shape(self):
        """Deflection of each centre over that of the tip, at rest."""
        stiffness, _ = self.matrices()
        load = np.zeros(2 * self.bonds)
        load[self.bonds - 1] = 1.0
        deflection = np.linalg.solve(stiffness, load)[: self.bonds]
        return np.append(0.0, deflection / deflection[-1])

    def matrices(self):
        """Stiffness of the chain and its masses: deflections of the free centres, then their inclinations."""
        count = self.bonds
        stiffness = np.zeros((2 * count, 2 * count))
        for bond in range(count):
            shear, bending = np.zeros(2 * count), np.zeros(2 * count)
            for centre, sign in ((bond - 1, -1.0), (bond, 1.0)):
                if centre >= 0:
                    shear[centre] = sign
                    shear[count + centre] = -0.5 * self.spacing
                    bending[count + centre] = sign
            stiffness += self.shear_rigidity / self.spacing * np.outer(shear, shear)
            stiffness += self.bending_rigidity / self.spacing * np.outer(bending, bending)
        return stiffness, np.repeat([self.mass, self.inertia], count)

    def chain_frequencies(self, count):
        """The lowest eigenfrequencies of the chain [Hz]."""
        stiffness, masses = self.matrices()
        scale = 1.0 / np.sqrt(masses)
        squares = np.linalg.eigvalsh(stiffness * np.outer(scale, scale))
        return np.sqrt(squares[:count]) / (2.0 * np.pi)

    def timoshenko_frequencies(self, count):
        """The lowest eigenfrequencies of a clamped Timoshenko beam that ends half a bond behind the last centre [Hz]."""
        guess = self.chain_frequencies(count + 1)
        grid = np.linspace(0.2 * guess[0], guess[-1], 400 * (count + 1))
        values = np.array([self.boundary_determinant(frequency) for frequency in grid])
        roots = []
        for k in np.flatnonzero(np.diff(np.sign(values)))[:count]:
            low, high = grid[k], grid[k + 1]
            for _ in range(60):
                middle = 0.5 * (low + high)
                same = np.sign(self.boundary_determinant(middle)) == np.sign(self.boundary_determinant(low))
                low, high = (middle, high) if same else (low, middle)
            roots.append(0.5 * (low + high))
        return np.array(roots)

    def boundary_determinant(self, frequency):
        """0 where a beam clamped at one end has neither moment nor force at the other.

        Deflection w, inclination t, moment M and force Q change along the beam, lengths in units of the beam's, by
        w' = t + Q/(κGA), t' = M/(EI), M' = −Q − ω² ρI t, Q' = −ω² ρA w.
        """
        length = (self.bonds + 0.5) * self.spacing
        square = (2.0 * np.pi * frequency) ** 2
        rigidity = self.bending_rigidity / length**2  # unit of force
        change = np.array(
            [
                [0.0, 1.0, 0.0, rigidity / self.shear_rigidity],
                [0.0, 0.0, 1.0, 0.0],
                [0.0, -square * self.inertia / self.spacing / rigidity, 0.0, -1.0],
                [-square * self.mass / self.spacing * length**2 / rigidity, 0.0, 0.0, 0.0],
            ]
        )
        values, vectors = np.linalg.eig(change)
        along = (vectors * np.exp(values)) @ np.linalg.inv(vectors)
        return np.linalg.det(along[2:, 2:].real)
