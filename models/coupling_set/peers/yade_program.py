"""Spheres in YADE; run by its own interpreter: ``yade -j1 -n -x yade_program.py FOLDER``."""

import sys
from math import atan, pi, sqrt

sys.path.insert(0, sys.argv[-1])

from serving import serve
from yade import O, Vector3, utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    CohFrictMat,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom6D,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_CohFrictMat_CohFrictMat_CohFrictPhys,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Ip2_ViscElMat_ViscElMat_ViscElPhys,
    Law2_ScGeom6D_CohFrictPhys_CohesionMoment,
    Law2_ScGeom_MindlinPhys_Mindlin,
    Law2_ScGeom_ViscElPhys_Basic,
    MatchMaker,
    NewtonIntegrator,
    ViscElMat,
)

CALMING = 0.5  # share of the force that brakes spheres which come to rest


class World:
    """What all worlds have: a body that is driven and one that is watched, along one axis."""

    first_step = 0.0  # which finds the forces of the beginning [s]

    def run(self, settings, collider, loop, gravity=0.0):
        """Puts its engines together."""
        # Motion first: after a step the forces are those of where the spheres are then.
        O.engines = [
            NewtonIntegrator(damping=0.0, gravity=(0, 0, -gravity), warnNoForceReset=False),
            ForceResetter(),
            collider,
            loop,
        ]
        # The forces of the beginning, before anything moves.
        O.dt = self.first_step
        O.step()
        O.dt = settings["time_step"]
        self.gravity = gravity
        self.start = O.bodies[self.watched].state.pos[self.axis]

    def step(self, speed):
        """One time step with the driven body at this velocity [m/s]."""
        O.bodies[self.driven].state.vel = speed * self.along
        O.step()

    def force(self):
        """Of the spheres on the driven body [N]."""
        return O.forces.f(self.driven)[self.axis]

    def sphere(self):
        """How far the sphere that is watched has come, and its velocity [m, m/s]."""
        state = O.bodies[self.watched].state
        rate = O.forces.f(self.watched)[self.axis] / state.mass - self.gravity
        # Its velocities are those of half a step earlier.
        return state.pos[self.axis] - self.start, state.vel[self.axis] + 0.5 * O.dt * rate

    def save(self):
        """Saves all that it can."""
        O.saveTmp("step")

    def restore(self):
        """Restores that, and makes the forces, which are not in it, again."""
        O.loadTmp("step")
        for engine in O.engines[1:]:
            engine()


class OverFloor(World):
    """Spheres over a wall that goes along z."""

    axis, along = 2, Vector3(0, 0, 1)

    def __init__(self, settings):
        density, gravity, width = (settings[name] for name in ("density", "gravity", "width"))
        spheres = settings["spheres"]
        mass = 4.0 / 3.0 * pi * spheres[0][3] ** 3 * density
        # Two of these in a row give a contact its stiffness, and its damping for its effective mass; a wall has no end
        # of the latter.
        touching = {"kn": 2.0 * settings["stiffness"], "ks": 0.0, "cs": 0.0, "frictionAngle": 0.0, "density": density}
        ball = O.materials.append(ViscElMat(cn=settings["damping"] * mass, **touching))
        solid = O.materials.append(ViscElMat(cn=1e30 if settings["damping"] else 0.0, **touching))
        collider = self.fill(spheres, width, ball, solid, solid)
        found = [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()]
        law = Law2_ScGeom_ViscElPhys_Basic()
        self.run(settings, collider, InteractionLoop(found, [Ip2_ViscElMat_ViscElMat_ViscElPhys()], [law]), gravity)
        for number, body in enumerate(O.bodies):
            if body.dynamic:
                rate = O.forces.f(number)[2] / body.state.mass - gravity
                body.state.vel = Vector3(0, 0, settings["velocity"] - 0.5 * O.dt * rate)

    def fill(self, spheres, width, ball, floor, wall):
        """Adds spheres, floor and walls of these materials; returns what finds neighbours."""
        self.watched = O.bodies.append([utils.sphere(tuple(each[:3]), each[3], material=ball) for each in spheres])[0]
        self.driven = O.bodies.append(utils.wall(0.0, axis=2, sense=1, material=floor))
        for axis in (0, 1) if width else ():
            O.bodies.append(utils.wall(0.0, axis=axis, sense=1, material=wall))
            O.bodies.append(utils.wall(width, axis=axis, sense=-1, material=wall))
        smallest = min(each[3] for each in spheres)
        return InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.1 * smallest)


class Rough(OverFloor):
    """Spheres by Hertz with friction over a wall as rough as they, between smooth ones."""

    first_step = 1e-12  # its law divides by the step

    def __init__(self, settings):
        modulus, restitution = settings["youngs_modulus"], settings["restitution"]
        same = {"poisson": settings["poissons_ratio"], "density": settings["density"]}
        angle = atan(settings["friction"])
        # At a wall it takes half of the sphere's radius for the effective one; a stiffer wall makes up for the root of 2.
        hard = modulus / (sqrt(2.0) - 1.0)
        ball = O.materials.append(FrictMat(young=modulus, frictionAngle=angle, **same))
        floor = O.materials.append(FrictMat(young=hard, frictionAngle=angle, **same))
        wall = O.materials.append(FrictMat(young=hard, frictionAngle=0.0, **same))
        collider = self.fill(settings["spheres"], settings["width"], ball, floor, wall)
        found = [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()]
        bounce = [MatchMaker(algo="val", val=restitution) for _ in range(2)]
        pressing = Ip2_FrictMat_FrictMat_MindlinPhys(en=bounce[0], es=bounce[1])
        self.run(
            settings,
            collider,
            InteractionLoop(found, [pressing], [Law2_ScGeom_MindlinPhys_Mindlin()]),
            settings["gravity"],
        )
        O.engines[0].damping = CALMING
        O.run(settings["settling"], True)
        O.engines[0].damping = 0.0


class Row(World):
    """Three spheres that touch, with cohesion; the last is driven along x."""

    axis, along = 0, Vector3(1, 0, 0)

    def __init__(self, settings):
        radius = settings["radius"]
        density = settings["mass"] / (4.0 / 3.0 * pi * radius**3)
        law = {"momentRotationLaw": False, "isCohesive": True, "normalCohesion": 1e30, "shearCohesion": 1e30}
        material = O.materials.append(CohFrictMat(young=1e3, poisson=0.0, frictionAngle=0.0, density=density, **law))
        fixed, self.watched, self.driven = (
            O.bodies.append(utils.sphere((2 * radius * number, 0, 0), radius, material=material, fixed=number != 1))
            for number in range(3)
        )
        # The springs stay where the spheres part.
        collider = InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.5)])
        found = Ig2_Sphere_Sphere_ScGeom6D(interactionDetectionFactor=1.5)
        bonds = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)
        loop = InteractionLoop([found], [bonds], [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()])
        self.run(settings, collider, loop)
        for other, stiffness in ((fixed, settings["outer"]), (self.driven, settings["middle"])):
            spring = O.interactions[self.watched, other].phys
            spring.kn, spring.ks = stiffness, 0.0
        O.bodies[self.watched].state.vel = Vector3(settings["speed"], 0, 0)


serve(lambda settings: {"OverFloor": OverFloor, "Rough": Rough, "Row": Row}[settings["kind"]](settings))
