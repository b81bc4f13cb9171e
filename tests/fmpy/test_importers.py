"""Three importers with three clocks get the same bits, where the interval is a multiple of the scene's step."""

import ctypes
import sys
from pathlib import Path

from conftest import given
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave


def with_fmpy(slave, path, course):
    """Rows of all real outputs."""
    unit = slave(path)
    return unit, [unit.step(course.displacement(step), course.interval) for step in range(1, course.steps + 1)]


def with_libcosimpy(path, course, names, inputs, outputs):
    """The same rows, from a clock in whole nanoseconds."""
    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_step_size(step_size=round(course.interval * 1e9))
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="unit"))
    manipulator = CosimManipulator.create_override()
    execution.add_manipulator(manipulator)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    rows = []
    for step in range(1, course.steps + 1):
        manipulator.slave_real_values(index, inputs, [given(name, course.displacement(step)) for name in names])
        assert execution.step(), f"libcosimpy: step {step} failed"
        rows.append(observer.last_real_values(index, outputs))
    return rows


def with_ecospy(path, course, inputs, outputs):
    """The same rows, from a clock that sums up intervals."""
    ecospy = linked_ecospy()
    with ecospy.EcosSimulationStructure() as structure:
        structure.add_model("unit", str(path))
        simulation = ecospy.EcosSimulation(structure=structure, step_size=course.interval)
    rows = []
    with simulation:
        simulation.init()
        for step in range(1, course.steps + 1):
            for name in inputs:
                simulation.set_real(f"unit::{name}", given(name, course.displacement(step)))
            simulation.step()
            rows.append([simulation.get_real(f"unit::{name}") for name in outputs])
        simulation.terminate()
    return rows


def linked_ecospy():
    """The package, after the thread library that it expects on the machine; that comes from a package of its own."""
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)
    import ecospy

    return ecospy


def first_difference(names, ours, theirs):
    """Where two lists of rows part; `None` if nowhere."""
    for step, (row, other) in enumerate(zip(ours, theirs, strict=True), 1):
        for name, value, found in zip(names, row, other, strict=True):
            if value != found:
                return f"step {step}, {name}: fmpy {value!r}, the other {found!r}"
    return None


def test_libcosimpy_gets_the_bits_of_fmpy(unit, model, course, slave):
    ours, rows = with_fmpy(slave, unit(model), course)
    references = [[ours.reference(name) for name in names] for names in (ours.inputs, ours.reals)]
    assert first_difference(ours.reals, rows, with_libcosimpy(unit(model), course, ours.inputs, *references)) is None


def test_ecospy_gets_the_bits_of_fmpy(unit, model, course, slave):
    ours, rows = with_fmpy(slave, unit(model), course)
    assert first_difference(ours.reals, rows, with_ecospy(unit(model), course, ours.inputs, ours.reals)) is None
