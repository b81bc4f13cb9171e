"""Pushes the tip of the beam by a spring that is drawn slowly, and prints force over deflection."""

from cograin import Program, Unit

Program().export("scene.toml", "beam.fmu")
with Unit("beam.fmu") as beam:
    print("deflection [m],force [N]")
    for step in range(1, 101):
        beam["tip.displacement.z"] = -1e-8 * step
        beam.step(1e-4)
        if step % 10 == 0:
            print(f"{1e-8 * step:.3g},{beam['tip.force.z']:.5g}")
