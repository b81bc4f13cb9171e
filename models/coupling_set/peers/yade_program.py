"""One sphere in YADE; run by its own interpreter: ``yade -j1 -n -x yade_program.py FOLDER``."""

import sys

sys.path.insert(0, sys.argv[-1])

from serving import serve
from yade import O, Vector3, utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    MatchMaker,
    NewtonIntegrator,
)


class World:
    """A sphere that falls, and a wall that goes at a given velocity."""

    def __init__(self, settings):
        self.settings = settings
        radius, mass = settings["radius"], settings["mass"]
        density = mass / (4.0 / 3.0 * 3.141592653589793 * radius**3)
        material = O.materials.append(FrictMat(young=1e6, poisson=0.3, frictionAngle=0.0, density=density))
        place = Vector3(0, 0, settings["height"] + radius)
        self.ball = O.bodies.append(utils.sphere(place, radius, material=material))
        self.floor = O.bodies.append(utils.wall(0.0, axis=2, sense=1, material=material))
        stiffness = MatchMaker(algo="val", val=settings["stiffness"])
        contact = Ip2_FrictMat_FrictMat_FrictPhys(kn=stiffness, ks=MatchMaker(algo="val", val=0.0))
        # Motion first: after a step the forces are those of where the sphere is then.
        O.engines = [
            NewtonIntegrator(damping=0.0, gravity=(0, 0, -settings["gravity"]), warnNoForceReset=False),
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
            InteractionLoop([Ig2_Wall_Sphere_ScGeom()], [contact], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        ]
        O.dt = settings["time_step"]
        # Its velocities are those of half a step earlier.
        O.bodies[self.ball].state.vel = Vector3(0, 0, settings["velocity"] + 0.5 * O.dt * settings["gravity"])

    def step(self, speed):
        """One time step with the floor at this velocity [m/s]."""
        O.bodies[self.floor].state.vel = Vector3(0, 0, speed)
        O.step()

    def force(self):
        """Of the sphere on the floor [N]."""
        return O.forces.f(self.floor)[2]

    def sphere(self):
        """Height and velocity of its lowest point [m, m/s]."""
        state = O.bodies[self.ball].state
        rate = -self.force() / self.settings["mass"] - self.settings["gravity"]
        return state.pos[2] - self.settings["radius"], state.vel[2] + 0.5 * O.dt * rate

    def save(self):
        """Saves all that it can."""
        O.saveTmp("step")

    def restore(self):
        """Restores that, and makes the forces, which are not in it, again."""
        O.loadTmp("step")
        for engine in O.engines[1:]:
            engine()


serve(World)
