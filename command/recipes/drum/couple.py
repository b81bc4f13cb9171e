"""A motor holds the speed of the drum: its torque follows the error."""

from cograin import Program, Unit

SPEED, GAIN, STEP = 3.0, 5e-2, 1e-3  # [rad/s], [N m s], [s]

Program().export("scene.toml", "drum.fmu")
with Unit("drum.fmu") as drum:
    print("time [s],speed [rad/s],torque [N m]")
    for step in range(1, 1601):
        drum["drum.applied_moment.x"] = GAIN * (SPEED - drum["drum.angular_velocity.x"])
        drum.step(STEP)
        if step % 40 == 0:
            print(f"{drum.time:.3f},{drum['drum.angular_velocity.x']:.4f},{drum['drum.applied_moment.x']:.5g}")
