"""Units, their connections and values of parameters in one file: a system structure of SSP 1.0 (``.ssp``)."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import fmpy

from cograin.units.unit import UnitError, Value

_PLACE = "http://ssp-standard.org/SSP1/SystemStructure"
_DESCRIPTION, _COMMON, _VALUES = (f"{{{_PLACE}{kind}}}" for kind in ("Description", "Common", "ParameterValues"))
_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
#: Elements of the description for types of variables.
_TYPES = {"Real": "Real", "Integer": "Integer", "Boolean": "Boolean", "String": "String"}


def save_ssp(
    path: str | Path,
    units: Mapping[str, str | Path],
    connections: Iterable[tuple[str, str]] = (),
    *,
    parameters: Mapping[str, Value] | None = None,
    end: float | None = None,
    overwrite: bool = False,
) -> Path:
    """Writes units, by their names in the system, with their connections as ``path``, a file of SSP 1.0; gives it.

    A connection joins an output with an input: ``("bed.floor.force.z", "table.load")``. Inputs that nothing is
    connected to are inputs of the system, as ``bed:floor.displacement.z``. ``parameters`` are values by names of
    variables, ``end`` is where the default experiment ends \\[s\\]. SSP 1.0 has no arrays: units are those of FMI 2.0.
    """
    path = Path(path)
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path}: exists; overwrite=True replaces it")
    system = _System({name: _read(name, Path(unit)) for name, unit in units.items()})
    joined = [(system.end(start, "output"), system.end(to, "input")) for start, to in connections]
    ends = [end for _, end in joined]
    for unit, name in ends:
        if ends.count((unit, name)) > 1:
            raise ValueError(f"connections: {unit}.{name} is connected {ends.count((unit, name))} times")
    values = {name: (system.end(name, "parameter", "input"), value) for name, value in (parameters or {}).items()}
    described = system.description(path.stem, joined, bool(values), end)
    part = path.with_name(f".{path.name}.part")
    try:
        with ZipFile(part, "w", ZIP_DEFLATED) as archive:
            _add(archive, "SystemStructure.ssd", _text(described))
            if values:
                _add(archive, "parameters.ssv", _text(system.values(path.stem, values)))
            for name, file in units.items():
                _add(archive, f"resources/{name}.fmu", Path(file).read_bytes(), ZIP_STORED)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def _read(name: str, path: Path) -> Any:
    """Description of a unit that can stand in a system of SSP 1.0."""
    if not name.isidentifier():
        raise ValueError(f"units: expected a name of letters, digits and _, found {name!r}")
    description = fmpy.read_model_description(str(path), validate=False)
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise UnitError(f"{path}: expected a unit for co-simulation of FMI 2.0, found FMI {description.fmiVersion}")
    return description


def _add(archive: ZipFile, name: str, content: bytes, compression: int = ZIP_DEFLATED) -> None:
    """Adds a file; the same content gives the same bytes."""
    entry = ZipInfo(name)
    entry.compress_type = compression
    archive.writestr(entry, content)


def _text(element: ElementTree.Element) -> bytes:
    """An element as a file."""
    for prefix, place in (("ssd", _DESCRIPTION), ("ssc", _COMMON), ("ssv", _VALUES)):
        ElementTree.register_namespace(prefix, place[1:-1])
    ElementTree.indent(element)
    text: bytes = ElementTree.tostring(element, encoding="utf-8", xml_declaration=True)
    return text


class _System:
    """The descriptions of units, by their names."""

    def __init__(self, units: dict[str, Any]) -> None:
        self.units = units
        self.variables = {
            (unit, variable.name): variable for unit, it in units.items() for variable in it.modelVariables
        }

    def end(self, name: str, *causalities: str) -> tuple[str, str]:
        """Unit and variable of a name, where the variable is of one of these kinds."""
        unit, _, variable = name.partition(".")
        if unit not in self.units:
            raise ValueError(
                f"{name}: expected a unit of the system, found {unit!r}; there are {', '.join(self.units)}"
            )
        found = self.variables.get((unit, variable))
        if found is None or found.causality not in causalities:
            what = "no such variable" if found is None else f"one that is of kind {found.causality}"
            raise ValueError(f"{name}: expected a variable of kind {' or '.join(causalities)}, found {what}")
        return unit, variable

    def description(
        self, name: str, joined: list[tuple[tuple[str, str], tuple[str, str]]], has_values: bool, end: float | None
    ) -> ElementTree.Element:
        """``SystemStructure.ssd``"""
        root = ElementTree.Element(f"{_DESCRIPTION}SystemStructureDescription", version="1.0", name=name)
        system = ElementTree.SubElement(root, f"{_DESCRIPTION}System", name=name)
        taken = {end for _, end in joined}
        free = [key for key, it in self.variables.items() if it.causality == "input" and key not in taken]
        if free:
            connectors = ElementTree.SubElement(system, f"{_DESCRIPTION}Connectors")
            for unit, variable in free:
                self._connector(connectors, f"{unit}:{variable}", (unit, variable))
        if has_values:
            bindings = ElementTree.SubElement(system, f"{_DESCRIPTION}ParameterBindings")
            ElementTree.SubElement(bindings, f"{_DESCRIPTION}ParameterBinding", source="parameters.ssv")
        elements = ElementTree.SubElement(system, f"{_DESCRIPTION}Elements")
        for unit in self.units:
            self._component(elements, unit)
        connections = ElementTree.Element(f"{_DESCRIPTION}Connections")
        for unit, variable in free:
            given = {"startConnector": f"{unit}:{variable}", "endElement": unit, "endConnector": variable}
            ElementTree.SubElement(connections, f"{_DESCRIPTION}Connection", given)
        for (start, output), (to, variable) in joined:
            given = {"startElement": start, "startConnector": output, "endElement": to, "endConnector": variable}
            ElementTree.SubElement(connections, f"{_DESCRIPTION}Connection", given)
        if len(connections):
            system.append(connections)
        self._unit_definitions(root)
        if end is not None:
            ElementTree.SubElement(root, f"{_DESCRIPTION}DefaultExperiment", startTime="0.0", stopTime=repr(end))
        return root

    def _component(self, elements: ElementTree.Element, unit: str) -> None:
        """A unit with its inputs and outputs."""
        given = {"name": unit, "type": "application/x-fmu-sharedlibrary", "source": f"resources/{unit}.fmu"}
        component = ElementTree.SubElement(elements, f"{_DESCRIPTION}Component", given, implementation="CoSimulation")
        connectors = ElementTree.SubElement(component, f"{_DESCRIPTION}Connectors")
        for (owner, name), variable in self.variables.items():
            if owner == unit and variable.causality in ("input", "output"):
                self._connector(connectors, name, (unit, name))

    def _connector(self, connectors: ElementTree.Element, name: str, key: tuple[str, str]) -> None:
        """A connector for a variable."""
        variable = self.variables[key]
        connector = ElementTree.SubElement(connectors, f"{_DESCRIPTION}Connector", name=name, kind=variable.causality)
        unit = {"unit": variable.unit} if variable.unit else {}
        ElementTree.SubElement(connector, f"{_COMMON}{_TYPES[variable.type]}", unit)

    def _unit_definitions(self, root: ElementTree.Element) -> None:
        """The units of measure of all variables, each once."""
        known = {unit.name: unit for it in self.units.values() for unit in it.unitDefinitions}
        if not known:
            return
        definitions = ElementTree.SubElement(root, f"{_DESCRIPTION}Units")
        for name, unit in sorted(known.items()):
            element = ElementTree.SubElement(definitions, f"{_COMMON}Unit", name=name)
            base = {it: getattr(unit.baseUnit, it) for it in _BASE} if unit.baseUnit else {}
            ElementTree.SubElement(
                element, f"{_COMMON}BaseUnit", {it: str(power) for it, power in base.items() if power}
            )

    def values(self, name: str, values: dict[str, tuple[tuple[str, str], Value]]) -> ElementTree.Element:
        """``parameters.ssv``"""
        root = ElementTree.Element(f"{_VALUES}ParameterSet", version="1.0", name=name)
        parameters = ElementTree.SubElement(root, f"{_VALUES}Parameters")
        for parameter, (key, value) in values.items():
            element = ElementTree.SubElement(parameters, f"{_VALUES}Parameter", name=parameter)
            text = value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
            ElementTree.SubElement(element, f"{_VALUES}{_TYPES[self.variables[key].type]}", value=text)
        return root
