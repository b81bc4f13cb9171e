"""One sphere in the DEM application of Kratos; run by an interpreter that has it, in an empty folder."""

import json
import math
import os
import sys
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # more of them would cost 38 ms a step

sys.path.insert(0, str(Path(__file__).resolve().parent))

import KratosMultiphysics as Kratos
import KratosMultiphysics.DEMApplication as Dem
from KratosMultiphysics.DEMApplication.DEM_analysis_stage import DEMAnalysisStage
from serving import serve

Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
EMPTY = "Begin ModelPartData\nEnd ModelPartData\nBegin Properties {}\nEnd Properties\n"
CORNERS = ((-0.3, -0.3), (0.6, -0.3), (-0.3, 0.6))
WALL = 100000  # number of the first node of the floor
LAW = "DEM_D_Linear_viscous_Coulomb"


def block(name, *lines):
    """A block of its input files."""
    return "\n".join([f"Begin {name}", *lines, f"End {name.split()[0]}", ""])


def part(name, nodes, kind, elements, data=""):
    """A part of a model, by the numbers of its nodes and of what lies between them."""
    return "\n".join(
        [f"Begin SubModelPart {name}", data + block("SubModelPartNodes", *nodes)]
        + [block(f"SubModelPart{kind}", *elements) + "End SubModelPart", ""]
    )


def write_sphere(settings):
    """Sphere and floor, a triangle."""
    ((x, y, z, radius),) = settings["spheres"]
    text = EMPTY.format(1) + block("Nodes", f"1 {x!r} {y!r} {z!r}")
    text += block("Elements SphericParticle3D", "1 1 1") + block("NodalData RADIUS", f"1 0 {radius!r}")
    Path("pDEM.mdpa").write_text(text + part("1", "1", "Elements", "1"))
    nodes = [str(WALL + number) for number in range(3)]
    text = EMPTY.format(0) + block("Nodes", *(f"{node} {x} {y} 0.0" for node, (x, y) in zip(nodes, CORNERS)))
    text += block("Conditions RigidFace3D3N", " ".join([nodes[0], "0", *nodes]))
    data = block("SubModelPartData", "IDENTIFIER floor", "FIXED_MESH_OPTION 0", "RIGID_BODY_MOTION 0")
    Path("pDEM_FEM_boundary.mdpa").write_text(text + part("0", nodes, "Conditions", nodes[:1], data))
    for name in ("Inlet", "Clusters"):
        Path(f"pDEM_{name}.mdpa").write_text(EMPTY.format(0))


def write_materials(settings):
    """A law whose stiffness at a wall is π · 0.31225 · E · r, without loss."""
    modulus = settings["stiffness"] / (math.pi * 0.31225 * settings["spheres"][0][3])
    pair = dict.fromkeys("STATIC_FRICTION DYNAMIC_FRICTION ROLLING_FRICTION ROLLING_FRICTION_WITH_WALLS".split(), 0.0)
    pair |= {"COEFFICIENT_OF_RESTITUTION": 1.0, "FRICTION_DECAY": 500, "SEVERITY_OF_WEAR": 0.0}
    pair |= {"IMPACT_WEAR_SEVERITY": 0.0, "BRINELL_HARDNESS": 200.0}
    pair |= {"DEM_ROLLING_FRICTION_MODEL_NAME": "DEMRollingFrictionModelConstantTorque"}
    pair |= {"DEM_DISCONTINUUM_CONSTITUTIVE_LAW_NAME": LAW}
    ball = {"PARTICLE_DENSITY": settings["density"], "YOUNG_MODULUS": modulus, "POISSON_RATIO": 0.0}
    floor = {"YOUNG_MODULUS": 1e30, "POISSON_RATIO": 0.0, "COMPUTE_WEAR": False}
    named = [("ball", 1, ball), ("floor", 2, floor)]
    met = [(["ball", "ball"], [1, 1]), (["ball", "floor"], [1, 2])]
    materials = {
        "materials": [{"material_name": n, "material_id": i, "Variables": values} for n, i, values in named],
        "material_relations": [
            {"material_names_list": names, "material_ids_list": numbers, "Variables": pair} for names, numbers in met
        ],
        "material_assignation_table": [["SpheresPart", "ball"], ["RigidFacePart", "floor"]],
    }
    Path("MaterialsDEM.json").write_text(json.dumps(materials))


def parameters(settings):
    """Of the run: velocity Verlet, every time step looks for contacts."""
    return {
        "problem_name": "p",
        "do_print_results_option": False,
        "Dimension": 3,
        "BoundingBoxOption": False,
        "dem_inlet_option": False,
        "GravityX": 0.0,
        "GravityY": 0.0,
        "GravityZ": -settings["gravity"],
        "RotationOption": False,
        "CleanIndentationsOption": False,
        "solver_settings": {"strategy": "sphere_strategy", "RemoveBallsInitiallyTouchingWalls": False},
        "ElementType": "SphericPartDEMElement3D",
        "TranslationalIntegrationScheme": "Velocity_Verlet",
        "RotationalIntegrationScheme": "Direct_Integration",
        "MaxTimeStep": settings["time_step"],
        "FinalTime": 1e9,
        "NeighbourSearchFrequency": 1,
        "GlobalDamping": 0.0,
        "SearchTolerance": 0.0,
        "search_tolerance_against_walls": 0.0,
        "OutputTimeStep": 1e9,
        "GraphExportFreq": 1e9,
        "VelTrapGraphExportFreq": 1e9,
        "ControlTime": 1e9,
    }


class World:
    """A sphere, and a floor that goes at a given velocity."""

    def __init__(self, settings):
        self.settings, self.place = settings, 0.0
        write_sphere(settings)
        write_materials(settings)
        self.stage = DEMAnalysisStage(Kratos.Model(), Kratos.Parameters(json.dumps(parameters(settings))))
        self.stage.Initialize()
        self.solver = self.stage._GetSolver()
        self.ball = next(iter(self.stage.spheres_model_part.Nodes))
        self.ball.SetSolutionStepValue(Kratos.VELOCITY_Z, settings["velocity"])
        self.begin = self.ball.Z
        self.floor = list(self.stage.rigid_face_model_part.GetSubModelPart("0").Nodes)

    def step(self, speed):
        """One time step with the floor at this velocity [m/s]."""
        stage = self.stage
        stage.time = self.solver.AdvanceInTime(stage.time)
        stage.InitializeSolutionStep()
        self.place += speed * self.settings["time_step"]
        for node in self.floor:
            node.Z = self.place
            node.SetSolutionStepValue(Kratos.VELOCITY_Z, speed)
        self.solver.Predict()
        self.solver.SolveSolutionStep()
        stage.FinalizeSolutionStep()

    def force(self):
        """Of the sphere on the floor [N]."""
        return sum(node.GetSolutionStepValue(Dem.CONTACT_FORCES)[2] for node in self.floor)

    def sphere(self):
        """How far the sphere has come, and its velocity [m, m/s]."""
        return self.ball.Z - self.begin, self.ball.GetSolutionStepValue(Kratos.VELOCITY_Z)


if __name__ == "__main__":
    serve(World)
