"""Units of columns and variables, by their names."""

from __future__ import annotations

#: Units of the columns of a history or a record, by the first word of their names.
FIRST = {
    "time": "s",
    "time_step": "s",
    "length": "s",
    "residual": "m",
    "energy": "J",
    "interface_energy": "J",
    "exchanged_work": "J",
}
#: By the last of these words behind the name of a boundary, a region and so on.
UNITS = {
    "displacement": "m",
    "position": "m",
    "overlap": "m",
    "velocity": "m/s",
    "rotation": "rad",
    "angular_velocity": "rad/s",
    "force": "N",
    "mean_force": "N",
    "mean_drag": "N",
    "mean_pressure_force": "N",
    "pressure_gradient": "Pa/m",
    "drag_coefficient": "kg/s",
    "mean_solid_flux": "m/s",
    "target_force": "N",
    "applied_force": "N",
    "servo_error": "N",
    "normal_force": "N",
    "force_slope": "N/s",
    "moment": "N.m",
    "mean_moment": "N.m",
    "applied_moment": "N.m",
    "torque": "N.m",
    "work": "J",
    "impact_energy": "J",
    "elastic_energy": "J",
    "dissipated_energy": "J",
    "mass": "kg",
    "mass_flow": "kg/s",
    "stress": "Pa",
    "mean_stress": "Pa",
    "conjugate_stress": "Pa",
    "target_stress": "Pa",
    "volume": "m3",
    "wear": "m3",
    "density": "kg/m3",
    "granular_temperature": "m2/s2",
    "temperature": "K",
    "heat_flow": "W",
    "mean_heat_flow": "W",
    "heat_conductance": "W/K",
    "applied_heat": "W",
    "heat": "J",
    "stiffness": "N/m",
}
#: Those of the periodic cell, where its words mean something else.
CELL = {"stiffness": "Pa", "servo_error": "Pa"}


def unit_of(name: str) -> str:
    """The unit of a variable of a unit or a column of a history by its name; ``1`` for counts and ratios.

    Names of derived outputs and ``<insertion>.rate`` tell none: `Table.unit_of` knows those of a run or a record.
    """
    first, *words = name.split(".")
    if "count_by_set" in words or "mixing_index" in words:
        return "1"  # a set behind it may have any name
    units = {**UNITS, **CELL} if first == "cell" else UNITS
    return next((units[word] for word in reversed(words) if word in units), FIRST.get(first, "1"))
