"""A strip of ice afloat, pressed down at its edge: Hetényi's beam on an elastic foundation, and Croasdale's estimate."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass
class Strip:
    """The sheet of scene.toml as a beam without end."""

    width: float = 1.0  # [m]
    thickness: float = 1.5  # [m]
    layers: int = 3  # of spheres
    youngs_modulus: float = 5.0e9  # [Pa]
    water_weight: float = 1025.0 * 9.81  # of a cubic metre [N/m³]
    bond_strength: float = 6.548e5  # [Pa]
    length: float = 119.5  # from the edge to the shore [m]
    friction: float = 0.1  # between ice and hull
    slope: float = math.radians(45.0)  # of the hull

    @property
    def foundation(self):
        """Force on a metre of the strip for each metre that it goes down [Pa]."""
        return self.water_weight * self.width

    @property
    def rigidity(self):
        """Bending stiffness EI [N m²]. Layers of spheres have 1/(4 n²) less of it than a full section."""
        full = self.youngs_modulus * self.width * self.thickness**3 / 12.0
        return full * (1.0 - 0.25 / self.layers**2)

    @property
    def wave_number(self):
        """λ = (k/(4 EI))^¼ [1/m]."""
        return (self.foundation / (4.0 * self.rigidity)) ** 0.25

    @property
    def strength_ratio(self):
        """Flexural strength of the sheet, 6 M/(b h²), over the strength of a bond.

        A bond is a circle in the square that it stands for: π/4 of it. Its stress is largest on its rim, which is at
        the surface of the sheet.
        """
        return math.pi / 4.0 * (1.0 - 0.25 / self.layers**2)

    @property
    def flexural_strength(self):
        """[Pa]"""
        return self.bond_strength * self.strength_ratio

    @property
    def push(self):
        """Horizontal over vertical force of a hull with friction: (sin α + µ cos α)/(cos α − µ sin α)."""
        sine, cosine = math.sin(self.slope), math.cos(self.slope)
        return (sine + self.friction * cosine) / (cosine - self.friction * sine)

    @property
    def lever(self):
        """Height of the contact with the hull over the middle of the sheet [m]: on a sphere of the top layer."""
        spacing = self.thickness / self.layers
        return 0.5 * (self.layers - 1) * spacing + 0.5 * spacing * math.sin(self.slope)

    def sag(self, vertical, horizontal, x):
        """How far the sheet goes down at distances from its edge [m]."""
        wave = self.wave_number
        moment = horizontal * self.lever
        shape = vertical * np.cos(wave * x) - wave * moment * (np.cos(wave * x) - np.sin(wave * x))
        return 2.0 * wave / self.foundation * np.exp(-wave * x) * shape

    def hogging(self, vertical, horizontal, x):
        """Bending moment that pulls at the top of the sheet [N m]."""
        wave = self.wave_number
        of_load = vertical / wave * np.sin(wave * x)
        of_push = horizontal * self.lever * (np.cos(wave * x) + np.sin(wave * x))
        return np.exp(-wave * x) * (of_load - of_push)

    def tension(self, vertical, horizontal, x):
        """Stress at the top of the sheet [Pa]."""
        area = self.width * self.thickness
        return self.hogging(vertical, horizontal, x) * 6.0 / (area * self.thickness) - horizontal / area

    def bond_stress(self, vertical, horizontal, x):
        """Largest stress of the bonds of the top layer [Pa], as bonds reckon it: mean pull, and bending on the rim."""
        spacing = self.thickness / self.layers
        curved = self.hogging(vertical, horizontal, x) * self.youngs_modulus / self.rigidity
        pull = curved * 0.5 * (self.thickness - spacing) - horizontal / (self.width * self.thickness)
        return 4.0 / math.pi * (pull + np.abs(curved) * 0.5 * spacing)

    def worst(self, vertical, horizontal):
        """Largest tension at the top [Pa], and how far from the edge [m]."""
        x = np.linspace(0.0, 3.0 / self.wave_number, 3001)
        tension = self.tension(vertical, horizontal, x)
        place = int(np.argmax(tension))
        return tension[place], x[place]

    def breaking(self):
        """Vertical and horizontal force that break the sheet [N], and where [m]."""
        tension, place = self.worst(1.0, self.push)
        vertical = self.flexural_strength / tension
        return vertical, self.push * vertical, place

    def advance(self, vertical, horizontal):
        """Way of the hull that goes with these forces, from touch, without the dent at the contact [m]."""
        spacing = self.thickness / self.layers
        down = self.sag(vertical, horizontal, 0.5 * spacing)
        inclined = (self.sag(vertical, horizontal, 0.0) - self.sag(vertical, horizontal, spacing)) / spacing
        # The sphere in touch is in the first column and the top layer, which the inclination takes towards the hull.
        away = horizontal * self.length / (self.youngs_modulus * self.width * self.thickness)
        away -= inclined * 0.5 * (self.thickness - spacing)
        return down / math.tan(self.slope) + away

    def croasdale(self):
        """Croasdale's breaking force 0.68 σ b (ρ g h⁵/E)^¼ [N]."""
        root = (self.water_weight * self.thickness**5 / self.youngs_modulus) ** 0.25
        return 0.68 * self.flexural_strength * self.width * root
