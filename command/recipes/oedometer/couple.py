"""Presses the lid through the unit and prints stress over strain."""

from cograin import Program, Unit

AREA, HEIGHT, SPEED = 0.03 * 0.03, 0.0255, 0.01  # [m²], [m], [m/s]

program = Program()
program.settle("scene.toml", "settled.checkpoint")
program.export("scene.toml", "oedometer.fmu", start="settled.checkpoint")
with Unit("oedometer.fmu") as unit:
    print("strain,stress [Pa]")
    for step in range(1, 201):
        unit["lid.displacement.z"] = -SPEED * step * 1e-3  # where the lid is at the end of the step
        unit.step(1e-3)
        if step % 10 == 0:
            print(f"{SPEED * step * 1e-3 / HEIGHT:.5f},{unit['lid.mean_force.z'] / AREA:.5g}")
