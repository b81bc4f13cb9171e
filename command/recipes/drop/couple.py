"""The table is a mass on a spring: both sides agree on every communication step."""

from cograin import Interface, Oscillator, Program, Secant, Unit, couple

Program().export("scene.toml", "drop.fmu")
with Unit("drop.fmu") as marble:
    table = Oscillator(mass=0.1, stiffness=1e4)  # [kg], [N/m]
    record = couple(Interface(marble, "table.displacement.z"), table, Secant(), step=1e-4, end=0.2)
print(record.summary)
record.save("coupled.csv")
