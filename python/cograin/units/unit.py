"""One unit: an FMU for co-simulation, by names instead of references, with states that can be restored."""

from __future__ import annotations

import ctypes
import logging
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import fmpy
import fmpy.fmi2
import numpy as np
from fmpy.fmi1 import FMICallException

from cograin.base import interrupts
from cograin.base.identity import of_file
from cograin.base.vector import Matrix, Vector
from cograin.units.cells import Cells
from cograin.units.nodes import Nodes
from cograin.units.unpacked import unpacked

_log = logging.getLogger("cograin")
_WARNING = 1  # status of a call that was done but for something beside it
_DISCARD = 2  # status of a step that was not made
_ROUNDING = 1e-3  # of the length of a step, that its end may be off

_PENDING = 5  # status of a step that is still being made

#: GUIDs of the units that are open.
_unique: set[str] = set()

Value = float | int | bool | str


class UnitError(Exception):
    """A call that the unit refused. The message names the unit and gives its own reason."""


class StepDiscarded(UnitError):
    """A communication step that the unit could not make; its state is that of the last good one."""

    def __init__(self, message: str, reason: str, last_successful_time: float) -> None:
        super().__init__(message)
        #: What the unit says of it.
        self.reason = reason
        #: Time of the state that the unit is in \\[s\\].
        self.last_successful_time = last_successful_time


class State:
    """A saved state of a unit. It belongs to the instance that saved it and ends with it."""

    __slots__ = ("handle", "time")

    def __init__(self, handle: ctypes.c_void_p, time: float) -> None:
        self.handle = handle
        self.time = time


class Unit:
    """An instance of an FMU 2.0 for co-simulation, initialised and ready to step.

    A variable is read and set by its name: ``unit["floor.work"]``, ``unit["floor.displacement.z"] = -1e-3``; many at
    once with `get` and `set`. A unit is a context manager: leaving it ends the instance and unloads its library.

    ``parameters`` are set before the initialisation, ``inputs`` within it (a driven boundary is then put there without
    motion). ``start`` is the time at which it begins \\[s\\].
    """

    def __init__(
        self,
        path: str | Path,
        *,
        name: str | None = None,
        parameters: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        start: float = 0.0,
    ) -> None:
        self._open = False
        self.path = Path(path)
        self.name = name or self.path.stem
        try:
            self.description = fmpy.read_model_description(str(path), validate=False)
        except FileNotFoundError:
            raise UnitError(f"{self.path}: expected a unit, found no such file") from None
        except Exception as error:
            raise UnitError(f"{self.path}: expected a unit, found a file that cannot be read as one: {error}") from None
        if self.description.fmiVersion != "2.0":
            raise UnitError(f"{self.path}: expected a unit of FMI 2.0, found FMI {self.description.fmiVersion}")
        if self.description.coSimulation is None:
            raise UnitError(f"{self.path}: offers no co-simulation; a unit for co-simulation is needed")
        self._alone()
        self.variables: dict[str, Any] = {variable.name: variable for variable in self.description.modelVariables}
        self._groups: dict[tuple[str, ...], tuple[Any, Any, int, Vector]] = {}
        self._messages: list[str] = []
        self._ended = False  # whether an interrupt was to end the present step
        self._states = 0  # saved ones that it may return to
        self._files = unpacked(self.path)
        #: Where it is unpacked, for all instances of this file.
        self.folder = self._files.folder
        self.slave = fmpy.fmi2.FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=self.name,
        )
        self._callbacks = self._listening()
        try:
            self.slave.instantiate(callbacks=self._callbacks)
        except Exception:
            reason = "; ".join(self._messages) or "it gives no reason"
            raise UnitError(f"{self.name}: could not be instantiated: {reason}") from None
        self._open = True
        _unique.add(self.description.guid)
        try:
            self._initialise(parameters or {}, inputs or {}, start)
        except BaseException:
            self.close()
            raise

    def _alone(self) -> None:
        """Refuses a second instance of a unit that can be instantiated only once in a process."""
        once = bool(self.description.coSimulation.canBeInstantiatedOnlyOncePerProcess)
        if once and self.description.guid in _unique:
            raise UnitError(
                f"{self.path}: can be instantiated only once in a process (canBeInstantiatedOnlyOncePerProcess), and is"
            )

    def _listening(self) -> Any:
        """Callbacks that keep the messages of the unit until they are read."""

        def listen(_environment: Any, _name: bytes, status: int, category: bytes, message: bytes) -> None:
            text = (message or b"").decode(errors="replace")
            if status >= _DISCARD:
                self._messages.append(text)
            elif status == _WARNING:
                _log.warning("%s: %s", self.name, text)
            else:
                _log.info("%s: %s", self.name, text)

        callbacks = fmpy.fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmpy.fmi2.fmi2CallbackLoggerTYPE(listen)
        callbacks.allocateMemory = fmpy.fmi2.defaultCallbacks.allocateMemory
        callbacks.freeMemory = fmpy.fmi2.defaultCallbacks.freeMemory
        return callbacks

    def _initialise(self, parameters: Mapping[str, Value], inputs: Mapping[str, Value], start: float) -> None:
        """From the new or reset instance to one that can step."""
        for key, value in parameters.items():
            self[key] = value
        self._call(self.slave.setupExperiment, startTime=start)
        self._call(self.slave.enterInitializationMode)
        for key, value in inputs.items():
            self[key] = value
        self._call(self.slave.exitInitializationMode)
        self.time = start
        self._origin, self._length, self._count = start, 0.0, 0

    def _call(self, function: Any, *arguments: Any, **named: Any) -> Any:
        """Calls the unit; its refusal becomes an exception with its own words."""
        self._ready()
        try:
            return function(*arguments, **named)
        except FMICallException as refusal:
            reason = "; ".join(self._messages) or "it gives no reason"
            raise UnitError(f"{self.name}: {refusal.function}: {reason}") from None

    def _ready(self) -> None:
        """Before a call: it is open, and messages of earlier calls are gone."""
        if not self._open:
            raise UnitError(f"{self.name}: the unit is closed")
        self._messages.clear()

    # What it is made of

    def names(self, causality: str) -> list[str]:
        """Names of all variables of one causality: ``input``, ``output``, ``parameter``, in the order of the unit."""
        return [name for name, variable in self.variables.items() if variable.causality == causality]

    @property
    def can_restore(self) -> bool:
        """Whether its states can be saved and restored."""
        return bool(self.description.coSimulation.canGetAndSetFMUstate)

    @property
    def has_variable_steps(self) -> bool:
        """Whether it takes communication steps of any length."""
        return bool(self.description.coSimulation.canHandleVariableCommunicationStepSize)

    @property
    def has_derivatives(self) -> bool:
        """Whether it gives directional derivatives."""
        return bool(self.description.coSimulation.providesDirectionalDerivative)

    def settings(self) -> dict[str, Any]:
        """The file by its content, and the present values of parameters and inputs.

        The number of threads is not among them: it changes no bit.
        """
        found: dict[str, Any] = {"name": self.name, "file": of_file(self.path)}
        names = [name for name in (*self.names("parameter"), *self.names("input")) if name != "run.threads"]
        real = self._real_of(names)
        found.update({name: self[name] for name in names if self.variables[name].type != "Real"})
        return {**found, **dict(zip(real, self.get(real).tolist(), strict=True))}

    def outputs(self) -> Vector:
        """Present values of all real outputs, in the order of the unit."""
        return self.get(self._real_of(self.names("output")))

    def _real_of(self, names: Sequence[str]) -> list[str]:
        """The real variables among these."""
        return [name for name in names if self.variables[name].type == "Real"]

    def variable(self, name: str) -> Any:
        """The description of a variable; an unknown name is answered with the nearest one."""
        try:
            return self.variables[name]
        except KeyError:
            from difflib import get_close_matches

            near = get_close_matches(name, self.variables, n=1)
            hint = f"; the nearest is {near[0]}" if near else ""
            raise UnitError(f"{self.name}: no variable {name}{hint}") from None

    # Values

    def _group(self, names: tuple[str, ...]) -> tuple[Any, Any, int, Vector]:
        """References and room for the values of real variables, also as an array, made once."""
        found = self._groups.get(names)
        if found is None:
            for name in names:
                if self.variable(name).type != "Real":
                    raise UnitError(f"{self.name}: {name} is of type {self.variable(name).type}; a Real is needed")
            references = (ctypes.c_uint32 * len(names))(*(self.variables[name].valueReference for name in names))
            room: Any = (ctypes.c_double * len(names))()
            found = self._groups[names] = (references, room, len(names), np.frombuffer(room))
        return found

    def get(self, names: Sequence[str]) -> Vector:
        """Values of real variables, in SI units."""
        references, room, count, values = self._group(tuple(names))
        self._call(self.slave.fmi2GetReal, self.slave.component, references, count, room)
        return values.copy()

    def set(self, names: Sequence[str], values: Iterable[float]) -> None:
        """Sets real variables: all of them or none."""
        references, room, count, _ = self._group(tuple(names))
        room[:] = self._several(names, values)
        self._call(self.slave.fmi2SetReal, self.slave.component, references, count, room)

    def set_rates(self, names: Sequence[str], rates: Iterable[float], *, order: int = 1) -> None:
        """Sets derivatives of real inputs in time for the next step: all of them or none. Set their values first."""
        most = int(self.description.coSimulation.canInterpolateInputs)
        if not most:
            raise UnitError(f"{self.name}: takes no derivatives of inputs in time (canInterpolateInputs)")
        references, room, count, _ = self._group(tuple(names))
        room[:] = self._several(names, rates)
        orders = (ctypes.c_int * count)(*[order] * count)
        self._call(self.slave.fmi2SetRealInputDerivatives, self.slave.component, references, count, orders, room)

    def _several(self, names: Sequence[str], values: Iterable[float]) -> list[float]:
        """As many values as names."""
        given = [self._real(names, place, value) for place, value in enumerate(values)]
        if len(given) != len(names):
            raise ValueError(f"{self.name}: expected {len(names)} values, one for each name, found {len(given)}")
        return given

    def _real(self, names: Sequence[str], place: int, value: Any) -> float:
        """A value for a real variable."""
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            name = names[place] if place < len(names) else "a value"
            raise UnitError(f"{self.name}: {name}: expected a number, found {_shown(value)}") from None

    def _fitting(self, name: str, kind: str, value: Any) -> Value:
        """A value for a variable that is not real."""
        if kind == "String" and isinstance(value, str) and "\0" not in value and value.isprintable():
            return value
        if kind == "Boolean" and isinstance(value, bool | np.bool_ | int | float) and value in (0, 1):
            return bool(value)
        if kind == "Integer" and not isinstance(value, str):
            try:
                whole = int(value)
            except (TypeError, ValueError, OverflowError):
                whole = None
            if whole is not None and whole == value and -(2**31) <= whole < 2**31:
                return whole
        expected = {"String": "a text", "Boolean": "true or false", "Integer": "a whole number of 32 bits"}[kind]
        raise UnitError(f"{self.name}: {name}: expected {expected}, found {_shown(value)}")

    def __getitem__(self, name: str) -> Value:
        variable = self.variable(name)
        if variable.type == "Real":
            return float(self.get((name,))[0])
        kind = "Integer" if variable.type == "Enumeration" else variable.type
        value = self._call(getattr(self.slave, f"get{kind}"), [variable.valueReference])[0]
        if isinstance(value, bytes):
            return value.decode()
        return bool(value) if kind == "Boolean" else int(value)

    def __setitem__(self, name: str, value: Value) -> None:
        variable = self.variable(name)
        if variable.type == "Real":
            self.set((name,), (value,))  # type: ignore[arg-type]
            return
        kind = "Integer" if variable.type == "Enumeration" else variable.type
        given = self._fitting(name, kind, value)
        self._call(getattr(self.slave, f"set{kind}"), [variable.valueReference], [given])

    def number(self, name: str) -> float:
        """Value of a real, whole or logical variable as a real number."""
        return float(self[name])

    def nodes(self, boundary: str) -> Nodes:
        """The nodes of a boundary whose mesh has ``nodes = "driven"``, as arrays."""
        return Nodes(self, boundary)

    def cells(self, grid: str) -> Cells:
        """The cells of ``[grid.<name>]``, as arrays."""
        return Cells(self, grid)

    # Time

    def step(self, length: float, *, until: float | None = None) -> None:
        """Makes a communication step of this length \\[s\\].

        Steps of one length end at exact multiples of it, not at a sum. ``until`` names the end where the caller
        counts himself. Raises `StepDiscarded` where the unit cannot make the step.
        """
        self._ready()
        if until is not None and not abs(until - self.time - length) <= _ROUNDING * abs(length):
            raise ValueError(f"{self.name}: until: expected about {self.time + length:g} s, found {until:g} s")
        # Where a saved state is kept, it may come back to a time before this one.
        final = fmpy.fmi2.fmi2False if self._states else fmpy.fmi2.fmi2True
        with interrupts.held():
            self._make(length, final)
            if until is not None:
                self._origin, self._length, self._count = until, 0.0, 0
                self.time = until
                return
            if length != self._length:
                self._origin, self._length, self._count = self.time, length, 0
            self._count += 1
            self.time = self._origin + self._count * length

    def _make(self, length: float, final: Any) -> None:
        """Makes a step; an interrupt that comes meanwhile ends it and acts."""
        self._ended = False
        try:
            with interrupts.ending(self._cancel):
                self.slave.doStep(self.time, length, final)
        except FMICallException as refusal:
            if refusal.status == _PENDING and self._waited():
                return
            interrupts.check()
            if self._ended and interrupts.is_main():
                # The interrupt has acted already: it came late, and was meant for an earlier step.
                self._make(length, final)
                return
            raise self._refused(refusal.status, length) from None

    def _cancel(self) -> None:
        """Ends the step that is under way in another thread. Only our own units are sure to allow it."""
        # A step that has just ended by itself is not there to be ended.
        with suppress(FMICallException):
            if not str(self.description.generationTool).startswith("cograin"):
                return
            self._ended = True
            self.slave.fmi2CancelStep(self.slave.component)

    def _waited(self) -> bool:
        """Waits for a step that the unit makes on its own; whether it was made."""
        while (status := self.slave.getStatus(fmpy.fmi2.fmi2DoStepStatus)) == _PENDING:
            time.sleep(1e-4)
        return bool(status <= _WARNING)

    def _refused(self, status: int, length: float) -> UnitError:
        """The exception for a step that was not made."""
        reason = "; ".join(self._messages) or "it gives no reason"
        text = f"{self.name}: the step from {self.time:g} s of {length:g} s was not made: {reason}"
        if status != _DISCARD:
            return UnitError(text)
        try:
            last = float(self.slave.getRealStatus(fmpy.fmi2.fmi2LastSuccessfulTime))
        except FMICallException:
            # Not every tool tells it; only a unit that saves states can then go on.
            last = float("nan")
        return StepDiscarded(f"{text} (last successful time {last:g} s)", reason, last)

    def reset(
        self,
        *,
        parameters: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        start: float = 0.0,
    ) -> None:
        """Resets the unit; all its saved states are lost."""
        self._call(self.slave.reset)
        self._states = 0
        self._initialise(parameters or {}, inputs or {}, start)

    # States

    def save(self, into: State | None = None) -> State:
        """Saves everything that changes; into an earlier saved state if one is given."""
        if not self.can_restore:
            raise UnitError(f"{self.name}: cannot save its state (canGetAndSetFMUstate)")
        state = into or State(ctypes.c_void_p(), self.time)
        new = not state.handle
        self._call(self.slave.fmi2GetFMUstate, self.slave.component, ctypes.byref(state.handle))
        self._states += new
        state.time = self.time
        return state

    def restore(self, state: State) -> None:
        """Restores a saved state. The unit continues from it bit for bit, and the state can be restored again."""
        if not isinstance(state, State):
            raise UnitError(f"{self.name}: expected a saved state, found {state!r}")
        if not state.handle:
            raise UnitError(f"{self.name}: expected a saved state, found one that was freed")
        with interrupts.held():
            self._call(self.slave.fmi2SetFMUstate, self.slave.component, state.handle)
            self.time = state.time
            self._origin, self._length, self._count = state.time, 0.0, 0

    def free(self, state: State) -> None:
        """Frees the memory of a state."""
        kept = bool(state.handle)
        self._call(self.slave.fmi2FreeFMUstate, self.slave.component, ctypes.byref(state.handle))
        self._states -= kept

    def serialise(self, state: State) -> bytes:
        """A state as bytes, for another process."""
        self._serialises()
        # The bytes can come back at any time.
        self._states += 1
        return bytes(self._call(self.slave.serializeFMUstate, state.handle))

    def deserialise(self, data: bytes, time: float) -> State:
        """The state that these bytes hold, of this time \\[s\\]."""
        self._serialises()
        state = State(self._call(self.slave.deSerializeFMUstate, data), time)
        self._states += 1
        return state

    def _serialises(self) -> None:
        """Refuses what a unit without serialised states cannot do."""
        if not self.description.coSimulation.canSerializeFMUstate:
            raise UnitError(f"{self.name}: its states cannot be written as bytes (canSerializeFMUstate)")

    def derivative(self, outputs: Sequence[str], inputs: Sequence[str]) -> Matrix:
        """Change of outputs (rows) at the end of the last step per unit change of inputs (columns) at that end.

        The unit makes its last step again for each input, displaced a little; its state stays as it is.
        """
        if not self.has_derivatives:
            raise UnitError(f"{self.name}: gives no directional derivatives")
        unknown = [self.variable(name).valueReference for name in outputs]
        known = [self.variable(name).valueReference for name in inputs]
        columns = [self._call(self.slave.getDirectionalDerivative, unknown, [one], [1.0]) for one in known]
        return np.array(columns, dtype=float).T.reshape(len(outputs), len(inputs))

    # Its end

    def close(self) -> None:
        """Ends the instance and unloads its library; more than once does no harm."""
        if not self._open:
            return
        self._open = False
        _unique.discard(self.description.guid)
        try:
            self.slave.terminate()
        except FMICallException:
            _log.info("%s: could not be terminated", self.name)
        self.slave.freeInstance()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _shown(value: Any) -> str:
    """A value that was not expected, at most a line of it."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
