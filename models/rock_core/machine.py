"""The two units, specimen and press, connected in fmpy, in libcosimpy or in ecospy.

Each way gives rows of COLUMNS without end, one a communication step.
"""

import ctypes
import sys
from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave

READ = [
    "upper.force.z",
    "upper.mean_force.z",
    "lower.force.z",
    "upper.work",
    "energy.kinetic",
    "energy.elastic",
    "energy.dissipated",
    "energy.residual",
]
PRESS = ["displacement", "crosshead", "drive_work", "specimen_work", "energy", "loss"]
CONNECTIONS = [
    (("press", "displacement"), ("rock", "upper.displacement.z")),
    (("rock", "upper.mean_force.z"), ("press", "force")),
]
COLUMNS = ["time", "upper.displacement.z", *READ, "bonds.broken", *(f"press.{name}" for name in PRESS)]


class Unit:
    """A unit in fmpy."""

    def __init__(self, path, name, parameters=()):
        description = fmpy.read_model_description(path)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=fmpy.extract(path),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.slave.instantiate()
        for key, value in dict(parameters).items():
            self.set(key, value)
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.saved = None

    def set(self, name, value):
        """Sets a real variable."""
        self.slave.setReal([self.references[name]], [value])

    def reals(self, names):
        """Values of real variables."""
        return self.slave.getReal([self.references[name] for name in names])

    def integer(self, name):
        """Value of a whole variable."""
        return self.slave.getInteger([self.references[name]])[0]

    def step(self, name, value, time, interval):
        """Sets an input and takes a communication step."""
        self.set(name, value)
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=interval)

    def save(self):
        """Remembers the present state."""
        if self.saved is not None:
            self.slave.freeFMUstate(self.saved)
        self.saved = self.slave.getFMUstate()

    def restore(self):
        """Goes back to it."""
        self.slave.setFMUstate(self.saved)


def with_fmpy(rock, press, parameters, interval, exchange):
    """A master of our own.

    `sequential`: the press steps with the last mean force of the specimen, then the specimen goes where the press
    went. `parallel`: both step with what the other had at the beginning. `implicit`: a step is repeated from the
    saved states until both sides agree on the mean force.
    """
    rock, press = Unit(rock, "rock"), Unit(press, "press", parameters)
    moves = {"sequential": sequential, "parallel": parallel, "implicit": implicit}[exchange]
    force, count = 0.0, 0
    while True:
        force, moved = moves(rock, press, force, count * interval, interval)
        count += 1
        yield [count * interval, moved, *rock.reals(READ), rock.integer("bonds.broken"), *press.reals(PRESS)]


def sequential(rock, press, force, time, interval):
    """One after the other; gives the mean force and where the platen is in the specimen's unit."""
    press.step("force", force, time, interval)
    moved = press.reals(["displacement"])[0]
    rock.step("upper.displacement.z", moved, time, interval)
    return rock.reals(["upper.mean_force.z"])[0], moved


def parallel(rock, press, force, time, interval):
    """Both at once: the specimen's platen is one step behind."""
    moved = press.reals(["displacement"])[0]
    press.step("force", force, time, interval)
    rock.step("upper.displacement.z", moved, time, interval)
    return rock.reals(["upper.mean_force.z"])[0], moved


def implicit(rock, press, force, time, interval, tolerance=1e-3, limit=20):
    """Repeats the step until the force that the press got is the specimen's, to a tolerance [N].

    The plain repetition converges as fast as the platen's inertia is large beside the specimen's stiffness.
    """
    for unit in (rock, press):
        unit.save()
    for _ in range(limit):
        found, moved = sequential(rock, press, force, time, interval)
        if abs(found - force) <= tolerance:
            return found, moved
        force = found
        for unit in (rock, press):
            unit.restore()
    raise RuntimeError(
        f"t = {time:.6f} s: {limit} evaluations left {abs(found - force):.1e} N between press and specimen; "
        "a heavier platen or a shorter interval would help"
    )


def with_libcosimpy(rock, press, parameters, interval):
    """The fixed-step algorithm of libcosim, which is `parallel`."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_step_size(step_size=round(interval * 1e9))
    references, slaves = {}, {}
    for name, path in (("rock", rock), ("press", press)):
        slaves[name] = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name=name))
        variables = fmpy.read_model_description(path).modelVariables
        references[name] = {variable.name: variable.valueReference for variable in variables}
    for key, value in parameters.items():
        execution.real_initial_value(slaves["press"], references["press"][key], value)
    for (source, output), (target, entry) in CONNECTIONS:
        execution.connect_real_variables(
            slaves[source], references[source][output], slaves[target], references[target][entry]
        )
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    count, moved = 0, 0.0
    while True:
        if not execution.step():
            raise RuntimeError(f"t = {count * interval:.6f} s: libcosim could not take the step")
        count += 1
        outputs = observer.last_real_values(slaves["rock"], [references["rock"][name] for name in READ])
        broken = observer.last_integer_values(slaves["rock"], [references["rock"]["bonds.broken"]])
        machine = observer.last_real_values(slaves["press"], [references["press"][name] for name in PRESS])
        yield [count * interval, moved, *outputs, broken[0], *machine]
        moved = machine[PRESS.index("displacement")]


def with_ecospy(rock, press, parameters, interval):
    """The same algorithm in ecos."""
    # ecospy expects the machine to have the thread library; tools/requirements-test.txt brings it along.
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)
    import ecospy

    with ecospy.EcosSimulationStructure() as structure:
        structure.add_model("rock", str(rock))
        structure.add_model("press", str(press))
        for source, target in CONNECTIONS:
            structure.make_real_connection("::".join(source), "::".join(target))
        structure.add_parameter_set("machine", {f"press::{key}": value for key, value in parameters.items()})
        simulation = ecospy.EcosSimulation(structure=structure, step_size=interval)
    with simulation:
        simulation.init(parameter_set="machine")
        count, moved = 0, 0.0
        while True:
            simulation.step()
            count += 1
            outputs = [simulation.get_real(f"rock::{name}") for name in READ]
            broken = simulation.get_integer("rock::bonds.broken")
            machine = [simulation.get_real(f"press::{name}") for name in PRESS]
            yield [count * interval, moved, *outputs, broken, *machine]
            moved = machine[PRESS.index("displacement")]
