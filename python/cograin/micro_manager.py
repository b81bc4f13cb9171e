"""A unit as the micro simulation of preCICE's Micro Manager: one instance at each point of a macroscopic model.

The module that ``micro_file_name`` of the Micro Manager's configuration names::

    from cograin.micro_manager import Cell
    from micro_manager import MicroSimulationInterface

    class MicroSimulation(Cell, MicroSimulationInterface):
        path = "cell.fmu"
        read = {
            "NormalStrain": [f"cell.strain.{axis}" for axis in ("xx", "yy", "zz")],
            "ShearStrain": [f"cell.strain.{axis}" for axis in ("xy", "xz", "yz")],
        }
        write = {
            "NormalStress": [f"cell.mean_stress.{axis}" for axis in ("xx", "yy", "zz")],
            "ShearStress": [f"cell.mean_stress.{axis}" for axis in ("xy", "xz", "yz")],
        }

The Micro Manager (``pip install micro-manager-precice``) is not part of this package, and nothing here imports it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cograin.base.vector import Vector
from cograin.units.unit import Unit, UnitError, Value


class Cell:
    """An instance of a unit, usually of a scene with ``[cell]``, stepped by the Micro Manager.

    A class derived from it says which unit, and which of its variables each data name of preCICE stands for: one
    variable for a scalar, as many as there are dimensions for a vector. What is read are values at the end of a time
    window, which is one communication step. ``parameters`` are set before the unit begins, ``threads`` among them: the
    Micro Manager runs cells side by side, so each has one thread.
    """

    path: ClassVar[str | Path]
    read: ClassVar[Mapping[str, Sequence[str]]]
    write: ClassVar[Mapping[str, Sequence[str]]]
    parameters: ClassVar[Mapping[str, Value]] = {"run.threads": 1}

    def __init__(self, sim_id: int) -> None:
        self._id = sim_id
        #: The instance: `Unit.derivative` gives a tangent, `Unit.get` whatever else is wanted.
        self.unit = Unit(self.path, name=f"{Path(self.path).stem}-{sim_id}", parameters=self.parameters)
        try:
            self._check("read", self.read, "input")
            self._check("write", self.write, "output")
        except UnitError:
            self.unit.close()
            raise

    def _check(self, attribute: str, data: Mapping[str, Sequence[str]], causality: str) -> None:
        """Refuses names that are no inputs or no outputs, before the first step."""
        for key, names in data.items():
            if isinstance(names, str):
                raise UnitError(f"{attribute}[{key!r}]: expected a list of names, found {names!r}")
            for name in names:
                found = self.unit.variable(name).causality
                if found != causality:
                    raise UnitError(f"{attribute}[{key!r}]: expected an {causality} of the unit, found {name}: {found}")

    def initialize(self) -> dict[str, Any]:
        """What is written at the start."""
        return self._written()

    def solve(self, micro_sim_input: Mapping[str, ArrayLike], dt: float) -> dict[str, Any]:
        """Makes a communication step to these values; returns what is written."""
        for key, names in self.read.items():
            if key not in micro_sim_input:
                raise UnitError(f"{self.unit.name}: expected data {key}, found {', '.join(micro_sim_input) or 'none'}")
            self.unit.set(names, np.atleast_1d(np.asarray(micro_sim_input[key], dtype=float)))
        self.unit.step(dt)
        return self._written()

    def _written(self) -> dict[str, Any]:
        """The data that are written: a number for one variable, an array for several."""
        values: dict[str, Vector] = {key: self.unit.get(names) for key, names in self.write.items()}
        return {key: float(found[0]) if len(found) == 1 else found for key, found in values.items()}

    def get_state(self) -> tuple[float, bytes]:
        """Everything that changes, for this cell, another one, or one in another process."""
        state = self.unit.save()
        try:
            return self.unit.time, self.unit.serialise(state)
        finally:
            self.unit.free(state)

    def set_state(self, state: tuple[float, bytes]) -> None:
        """Continues from this state, bit for bit."""
        time, data = state
        kept = self.unit.deserialise(data, time)
        try:
            self.unit.restore(kept)
        finally:
            self.unit.free(kept)

    def get_global_id(self) -> int:
        """The number of this cell among all."""
        return self._id

    def set_global_id(self, global_id: int) -> None:
        """Gives it another number."""
        self._id = global_id

    def destroy(self) -> None:
        """Ends the unit."""
        self.unit.close()
