"""Air lifts a bed of beads: its velocity grows, and the drop of the pressure is printed beside the weight."""

from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import Column, FluidInterface

STEP, END, RATE = 2e-3, 0.5, 2.4  # [s], [s], growth of the velocity [m/s²]

Program().export("scene.toml", "fluidised_column.fmu")
with Unit("fluidised_column.fmu") as bed:
    side = FluidInterface(bed, "air")
    air = Column(side, inflow=lambda time: RATE * time)  # superficial velocity below [m/s]
    coupling = Coupling(side, air, QuasiNewton(), STEP, watch=["floor.force.z"])
    print("time [s],velocity [m/s],pressure drop [Pa],force on the floor [N],evaluations")
    for row in coupling.steps(END):
        floor, drop = bed["floor.force.z"], air.pressure_drop
        print(f"{row.time:.3f},{RATE * row.time:.3f},{drop:.2f},{floor:.5f},{row.evaluations}")
coupling.record.save("coupled.csv")
