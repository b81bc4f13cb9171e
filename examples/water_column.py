"""A closed column of water along z, by fmpy alone: each communication step is made again until both sides agree.

`bed.fmu` has `[fluid.fluid]` on a grid of 8 cells, with `velocity = "driven"` and `pressure = "total"`. The script
leaves out what the fluid conveys and `mean_pressure_force`. Its relaxation takes tens of repetitions, since the
pressure answers the grains at once; `cograin.QuasiNewton` takes five.
"""

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

density, gravity, area, height, cells, H = 1000.0, -9.81, 2.5e-5, 4e-3, 8, 1e-3  # area and height of a cell
about = fmpy.read_model_description("bed.fmu")
references = {each.name: each.valueReference for each in about.modelVariables}
bed = FMU2Slave(
    guid=about.guid, unzipDirectory=fmpy.extract("bed.fmu"), modelIdentifier=about.coSimulation.modelIdentifier
)
bed.instantiate()
bed.setupExperiment()
bed.enterInitializationMode()
bed.exitInitializationMode()


def names(quantity):
    return [references[f"fluid.cell[{n}].{quantity}"] for n in range(1, cells + 1)]


def read(quantity):
    return np.array(bed.getReal(names(quantity)))


u, dp, volume = np.zeros(cells), np.full(cells, density * gravity), area * height
now, porosity, flow = bed.getFMUState(), read("porosity"), np.zeros(cells)
for count in range(5):
    for _ in range(200):
        bed.setFMUState(now)
        bed.setReal(names("velocity.z") + names("pressure_gradient.z"), [*u, *dp])
        bed.doStep(count * H, H)
        end, drag = read("porosity"), read("mean_drag.z")
        mean = 0.5 * (porosity + end)
        new = -read("mean_solid_flux.z") / mean  # continuity of what is closed
        left = density * (mean * gravity - (end * new - flow) / H) + drag / volume - end * dp
        off = max(abs(new - u).max() / 1e-6, abs(left).max() / 1e-1)
        if off < 1.0:
            break
        u, dp = u + 0.5 * (new - u), dp + 0.3 * left
    else:
        raise SystemExit("both sides do not agree")
    bed.freeFMUState(now)
    now, porosity, flow = bed.getFMUState(), end, end * new
bed.freeFMUState(now)
