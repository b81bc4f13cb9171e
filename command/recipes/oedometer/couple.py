"""Presses the lid through the unit and prints stress over strain, from where it meets the grains."""

from cograin import Program, Unit

AREA, HEIGHT, SPEED = 0.03 * 0.03, 0.0255, 0.01  # [m²], [m], [m/s]

program = Program()
program.settle("scene.toml", "settled.checkpoint")
program.export("scene.toml", "oedometer.fmu", start="settled.checkpoint")
with Unit("oedometer.fmu") as unit:
    print("strain,stress [Pa]")
    met = None  # how far the lid had gone when it met the grains [m]
    for step in range(1, 201):
        way = SPEED * step * 1e-3
        unit["lid.displacement.z"] = -way  # where the lid is at the end of the step
        unit.step(1e-3)
        stress = unit["lid.mean_force.z"] / AREA
        if met is None and stress > 0.0:
            met = way
        if met is not None and step % 10 == 0:
            print(f"{(way - met) / (HEIGHT - met):.5f},{stress:.5g}")
