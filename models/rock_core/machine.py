"""The two units, specimen and press, connected in fmpy, in libcosimpy or in ecospy.

Each way gives rows of COLUMNS without end, one a communication step.
"""

import ctypes
import sys
from pathlib import Path

import fmpy
from cograin import Coupling, GaussSeidel, Interface, Jacobi, Secant, Tolerance, Unit, UnitPartner

PLATEN = "upper.displacement.z"
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
    (("press", "displacement"), ("rock", PLATEN)),
    (("rock", "upper.mean_force.z"), ("press", "force")),
]
COLUMNS = ["time", PLATEN, *READ, "bonds.broken", *(f"press.{name}" for name in PRESS)]


EXCHANGES = {
    "sequential": lambda: GaussSeidel("mean"),
    "parallel": lambda: Jacobi("mean"),
    "implicit": lambda: Secant(tolerance=Tolerance(displacement=1e-12)),
}


def with_fmpy(rock, press, parameters, interval, exchange):
    """Our own master.

    `sequential`: the press steps with the last mean force of the specimen, then the specimen goes where the press
    went. `parallel`: both step with what the other had at the beginning. `implicit`: a step is repeated from the
    saved states until both sides agree to a picometre.
    """
    with Unit(rock, name="rock") as rock, Unit(press, name="press", parameters=parameters) as press:
        platen = UnitPartner(press, force="force", displacement="displacement")
        run = Coupling(Interface(rock, PLATEN), platen, EXCHANGES[exchange](), interval)
        while True:
            row = run.advance()
            broken = rock["bonds.broken"]
            yield [row.time, row.displacement[0], *rock.get(READ), broken, *press.get(PRESS)]


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
