"""Kratos by its DEM application, in an interpreter that has it: KRATOS_PYTHON names one that is not this one."""

import os
import subprocess
import sys

from worlds import OverFloor

from peers.process import HERE, Process

OWN = "kratos_cosimulation"  # its own exchanges, beside ours
PYTHON = os.environ.get("KRATOS_PYTHON", sys.executable)


def has_it():
    """Whether that interpreter is there and has what is needed."""
    try:
        asked = [PYTHON, "-c", "import KratosMultiphysics.DEMApplication"]
        return subprocess.run(asked, capture_output=True, check=False).returncode == 0
    except OSError:
        return False


if not has_it():
    raise ImportError(f"no KratosMultiphysics with DEMApplication in {PYTHON}; KRATOS_PYTHON names another interpreter")


class Side(Process):
    """One sphere in Kratos: no state that could be restored, and no springs between spheres without a law of breaking."""

    worlds = (OverFloor,)

    def __init__(self, problem):
        super().__init__([PYTHON, HERE / "kratos_program.py"], problem)
