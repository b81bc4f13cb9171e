"""Opens the gate after half a second and prints what flows."""

from cograin import Program, Unit

Program().export("scene.toml", "silo.fmu")
with Unit("silo.fmu") as silo:
    print("time [s],opening [m],in the hopper [kg],flow [kg/s]")
    for step in range(1, 151):
        silo["gate.displacement.x"] = min(max(0.0, 0.1 * (step * 0.02 - 0.5)), 0.05)
        silo.step(0.02)
        flow, mass = silo["below_the_gate.mass_flow"], silo["hopper_filling.mass"]
        print(f"{silo.time:.2f},{silo['gate.displacement.x']:.3f},{mass:.4f},{flow:.4f}")
