"""Presses the core until it breaks, and prints stress over strain."""

import math

from cograin import Program, Unit

AREA, HEIGHT, SPEED, STEP = math.pi * 0.025**2, 0.1, 0.1, 1e-5  # [m²], [m], [m/s], [s]

Program().export("scene.toml", "core.fmu")
with Unit("core.fmu") as core:
    print("strain,stress [Pa],broken bonds")
    for step in range(1, 601):
        core["upper.displacement.z"] = -SPEED * step * STEP
        core.step(STEP)
        if step % 20 == 0:
            strain, stress = SPEED * step * STEP / HEIGHT, core["upper.mean_force.z"] / AREA
            print(f"{strain:.5f},{stress:.5g},{core['bonds.broken']}")
