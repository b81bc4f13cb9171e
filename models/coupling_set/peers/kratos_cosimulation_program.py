"""The drop by the coupling that Kratos has itself: its DEM and its structural mechanics under its CoSimulation.

Run by an interpreter that has them, in an empty folder, with one line of settings; prints a line for each step: height
and velocity of the sphere, displacement and velocity of the plate, coupling iterations, processor time.
"""

import json
import os
import sys
import time
from pathlib import Path

import kratos_program as falling
import KratosMultiphysics as Kratos
import KratosMultiphysics.CoSimulationApplication as Coupled
from KratosMultiphysics.CoSimulationApplication.co_simulation_analysis import CoSimulationAnalysis

CORNERS = [str(number) for number in (1, 2, 3)]  # nodes of the plate


def write_plate(settings):
    """A third of the plate's mass and of its spring in each corner of the floor."""
    mass, spring = settings["plate"] / 3.0, settings["spring"] / 3.0
    text = falling.EMPTY.format(0)
    places = zip(CORNERS, falling.CORNERS, strict=True)
    text += falling.block("Nodes", *(f"{node} {x} {y} 0.0" for node, (x, y) in places))
    text += falling.block("Elements NodalConcentratedElement3D1N", *(f"{node} 0 {node}" for node in CORNERS))
    text += falling.block("ElementalData NODAL_MASS", *(f"{node} {mass!r}" for node in CORNERS))
    springs = (f"{node} [3] (0,0,{spring!r})" for node in CORNERS)
    text += falling.block("ElementalData NODAL_DISPLACEMENT_STIFFNESS", *springs)
    text += falling.block("Conditions PointLoadCondition3D1N", *(f"{node} 0 {node}" for node in CORNERS))
    nodes, elements, loads = (
        falling.block(f"SubModelPart{kind}", *CORNERS) for kind in ("Nodes", "Elements", "Conditions")
    )
    Path("pFEM.mdpa").write_text(f"{text}Begin SubModelPart all\n{nodes}{elements}{loads}End SubModelPart\n")
    Path("MatFEM.json").write_text(json.dumps({"properties": []}))


def plate_parameters(settings):
    """Of the plate: Newmark's average acceleration, which keeps its energy."""
    fixed = {"model_part_name": "Structure.all", "variable_name": "DISPLACEMENT", "constrained": [True, True, False]}
    process = {"python_module": "fix_vector_variable_process", "kratos_module": "KratosMultiphysics"}
    data = {"problem_name": "f", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0, "echo_level": 0}
    return {
        "problem_data": data,
        "solver_settings": {
            "solver_type": "Dynamic",
            "echo_level": 0,
            "analysis_type": "linear",
            "time_integration_method": "implicit",
            "scheme_type": "newmark",
            "model_part_name": "Structure",
            "domain_size": 3,
            "rotation_dofs": False,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "pFEM"},
            "material_import_settings": {"materials_filename": "MatFEM.json"},
            "time_stepping": {"time_step": settings["time_step"]},
        },
        "processes": {"fixed": [process | {"Parameters": fixed}]},
    }


def sent(name, to):
    """A value that goes on to the other side."""
    return {"data": name, "to_solver": to, "to_solver_data": name, "data_transfer_operator": "nearest"}


def values(part, **variables):
    """Vectors of a part of a model, by their names in the coupling."""
    return {
        name: {"model_part_name": part, "variable_name": variable, "dimension": 3}
        for name, variable in variables.items()
    }


MOTION = {"displacement": "DISPLACEMENT", "velocity": "VELOCITY"}


def sides():
    """The programs of both sides, and what they give and take."""
    wrapper = "solver_wrappers.kratos"
    spheres = {"input_file": "DEM", "move_mesh_model_part": ["RigidFacePart.0"], "working_directory": str(Path.cwd())}
    return {
        "dem": {
            "type": f"{wrapper}.dem_wrapper",
            "solver_wrapper_settings": spheres,
            "data": values("RigidFacePart.0", load="CONTACT_FORCES", **MOTION),
        },
        "structure": {
            "type": f"{wrapper}.structural_mechanics_wrapper",
            "solver_wrapper_settings": {"input_file": "FEM"},
            "data": values("Structure.all", load="POINT_LOAD", **MOTION),
        },
    }


def coupling(settings):
    """Spheres first, then the plate; where the coupling is strong, both again until the plate stays."""
    load = {"data": "load", "from_solver": "dem", "from_solver_data": "load", "data_transfer_operator": "nearest"}
    nearest = {"type": "kratos_mapping", "mapper_settings": {"mapper_type": "nearest_neighbor"}}
    outputs = [sent(name, "dem") for name in MOTION]
    found = {
        "type": f"coupled_solvers.gauss_seidel_{'strong' if settings['strong'] else 'weak'}",
        "echo_level": 0,
        "data_transfer_operators": {"nearest": nearest},
        "coupling_sequence": [
            {"name": "dem", "input_data_list": [], "output_data_list": []},
            {"name": "structure", "input_data_list": [load], "output_data_list": outputs},
        ],
        "solvers": sides(),
    }
    if settings["strong"]:
        place = {"solver": "structure", "data_name": "displacement"}
        limits = {"type": "relative_norm_previous_residual", "rel_tolerance": 1e-9, "abs_tolerance": 1e-12}
        found |= {"num_coupling_iterations": 20, "convergence_criteria": [limits | place]}
        accelerated = settings["accelerator"]
        found["convergence_accelerators"] = [{"type": accelerated} | place] if accelerated else []
    return found


class Analysis(CoSimulationAnalysis):
    """Prints a line after each step."""

    radius = 0.0

    def FinalizeSolutionStep(self):
        """The name is that of Kratos."""
        super().FinalizeSolutionStep()
        solver = self._GetSolver()
        ball = next(iter(solver.solver_wrappers["dem"].model["SpheresPart"].Nodes))
        plate = next(iter(solver.solver_wrappers["structure"].model["Structure"].Nodes))
        strong = hasattr(solver, "num_coupling_iterations")
        iterations = solver.process_info[Coupled.COUPLING_ITERATION_NUMBER] if strong else 1
        sphere = [ball.Z - self.radius, ball.GetSolutionStepValue(Kratos.VELOCITY_Z)]
        variables = (Kratos.DISPLACEMENT_Z, Kratos.VELOCITY_Z)
        moved = [plate.GetSolutionStepValue(variable) for variable in variables]
        print("##" + json.dumps([*sphere, *moved, iterations, time.process_time()]), flush=True)


def main():
    settings = json.loads(sys.argv[1])
    falling.write_sphere(settings)
    falling.write_materials(settings)
    write_plate(settings)
    end = settings["end"] - 0.5 * settings["time_step"]
    spheres = falling.parameters(settings) | {"FinalTime": end}
    Path("DEM.json").write_text(json.dumps(spheres))
    plate = plate_parameters(settings)
    plate["problem_data"]["end_time"] = end
    Path("FEM.json").write_text(json.dumps(plate))
    data = {"start_time": 0.0, "end_time": end, "echo_level": 0, "print_colors": False, "parallel_type": "OpenMP"}
    whole = {"problem_data": data, "solver_settings": coupling(settings)}
    Analysis.radius = settings["spheres"][0][3]
    Analysis(Kratos.Parameters(json.dumps(whole))).Run()


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # what is left to be freed takes seconds, and sometimes fails
