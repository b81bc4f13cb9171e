"""What another particle program is told of a problem: spheres over a driven floor, rough ones, or masses in a row."""

from dataclasses import asdict, dataclass

GRAVITY = 9.81  # [m/s²], as in the scenes
DENSITY = 2500.0  # of the spheres over a floor [kg/m³]


@dataclass(frozen=True)
class OverFloor:
    """Spheres over a floor that goes along z, in a box with smooth walls if it has a width."""

    interface = "floor.displacement.z"

    spheres: list  # coordinates of the centre, and radius [m]
    time_step: float  # [s]
    stiffness: float  # of every contact [N/m]
    damping: float = 0.0  # of it, for each effective mass [1/s]
    gravity: float = GRAVITY  # downwards [m/s²]
    velocity: float = 0.0  # of the spheres as they begin, along z [m/s]
    width: float = 0.0  # of the box [m]
    density: float = DENSITY  # [kg/m³]

    def told(self):
        """As plain words."""
        return {"kind": type(self).__name__, **asdict(self)}


@dataclass(frozen=True)
class Rough:
    """Spheres by Hertz with friction, of several sizes, over a floor as rough as they, in a box with smooth walls."""

    interface = "floor.displacement.z"

    spheres: list  # coordinates of the centre, and radius [m]
    time_step: float  # [s]
    youngs_modulus: float  # [Pa]
    poissons_ratio: float
    restitution: float
    friction: float
    width: float  # of the box [m]
    settling: int  # time steps in which they come to rest first, with friction of a fluid
    gravity: float = GRAVITY  # downwards [m/s²]
    velocity: float = 0.0  # of the spheres as they begin, along z [m/s]
    density: float = DENSITY  # [kg/m³]

    told = OverFloor.told


@dataclass(frozen=True)
class Row:
    """Three spheres in a row along x with springs between them: the first is fixed, the last is driven."""

    interface = "right.displacement.x"

    time_step: float  # [s]
    outer: float  # stiffness of the spring to the fixed one [N/m]
    middle: float  # of that to the driven one [N/m]
    speed: float  # of the mass between them as it begins [m/s]
    mass: float = 1.0  # [kg]
    radius: float = 0.05  # [m]

    told = OverFloor.told
