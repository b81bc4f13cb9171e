"""The first two bending modes of a beam, clamped at both ends, that carries the floor at its middle."""

from cograin import Interface, Modal, Program, Secant, Unit, couple

STEP, END = 2e-4, 0.2  # [s]

program = Program()
program.settle("scene.toml", "settled.checkpoint")
program.export("scene.toml", "loaded_beam.fmu", start="settled.checkpoint")
with Unit("loaded_beam.fmu") as bed:
    # Frequencies [Hz], and how far a unit of each mode moves the middle: an even mode does not.
    beam = Modal([60.0, 160.0], [[1.0], [0.0]], masses=[2.0, 2.0], damping_ratios=0.05)
    record = couple(Interface(bed, "floor.displacement.z"), beam, Secant(), step=STEP, end=END, watch=["floor.work"])
print(record.summary)
print(f"the middle is {-1e3 * record['floor.displacement.z'][-1]:.4f} mm lower")
record.save("coupled.csv")
