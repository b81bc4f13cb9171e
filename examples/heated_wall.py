"""A wall that grains cool or warm, by fmpy alone: each communication step is made again until the heat flow agrees.

`bed.fmu` has a boundary `floor` with `temperature = "driven"`. The repetition needs a gain below 1: a wall that is
heavy beside conductance times H. `cograin.Secant` needs none.
"""

import fmpy
from fmpy.fmi2 import FMU2Slave

H, capacity, start = 0.1, 50.0, 400.0  # [s], of a wall [J/K], [K]
about = fmpy.read_model_description("bed.fmu")
name = {each.name: each.valueReference for each in about.modelVariables}
bed = FMU2Slave(
    guid=about.guid, unzipDirectory=fmpy.extract("bed.fmu"), modelIdentifier=about.coSimulation.modelIdentifier
)
bed.instantiate()
bed.setupExperiment(startTime=0.0)
bed.enterInitializationMode()
bed.setReal([name["floor.temperature"]], [start])
bed.exitInitializationMode()
wall, flow = start, 0.0  # [K], of the particles into the floor [W]
for count in range(20):
    saved, before = bed.getFMUState(), None
    while before is None or abs(flow - before) > 1e-9 * abs(flow):
        if before is not None:
            bed.setFMUState(saved)
        bed.setReal([name["floor.temperature"]], [wall + flow * H / capacity])
        bed.doStep(count * H, H)
        before, flow = flow, bed.getReal([name["floor.mean_heat_flow"]])[0]
    bed.freeFMUState(saved)
    wall += flow * H / capacity
heat = bed.getReal([name["energy.heat"]])[0]  # capacity × (start − wall), to rounding
bed.terminate()
bed.freeInstance()
