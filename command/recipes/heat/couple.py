"""A plate of steel, which a heater warms, below grains that fall on it and carry heat away."""

from cograin import HeatCapacity, Interface, Program, Secant, Unit, couple

STEP, END = 1e-2, 0.5  # [s]

Program().export("scene.toml", "heat.fmu")
with Unit("heat.fmu") as bed:
    # Heat capacity [J/K], conductance to the room [W/K], temperatures [K], a heater [W].
    plate = HeatCapacity(5.0, 0.02, start=400.0, ambient=293.0, load=lambda time: 20.0)
    record = couple(Interface(bed, "plate.temperature"), plate, Secant(), step=STEP, end=END, watch=["energy.heat", "bed.temperature"])
print(record.summary)
print(f"the plate is at {plate.temperature[0]:.3f} K, the grains at {record['bed.temperature'][-1]:.3f} K")
record.save("coupled.csv")
