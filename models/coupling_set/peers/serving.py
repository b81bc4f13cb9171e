"""What a program says of its spheres and what it drives, line by line; it runs in that program's own interpreter."""

import json
import sys
import time


def serve(open_world):
    """Answers every line of the standard input with numbers.

    They are force and mean force, way and velocity of the watched sphere, and the processor time so far, which is the
    program's own: words are not counted. The first line opens the world with the numbers of the problem; the next ones
    move the interface to `place` \\[m\\] within `count` time steps, or save and restore. A world has the methods
    `step(speed)`, `force()`, `sphere()`, and `save()` and `restore()` if it can.
    """
    settings = json.loads(sys.stdin.readline())
    world, place, saved = open_world(settings), 0.0, 0.0
    force = mean = world.force()
    taken, begin = 0.0, time.process_time()
    while True:
        place_and_speed = world.sphere()
        taken += time.process_time() - begin
        print("##" + json.dumps([force, mean, *place_and_speed, taken]), flush=True)
        line = sys.stdin.readline()
        if not line:
            return
        asked = json.loads(line)
        begin = time.process_time()
        if "state" in asked:
            getattr(world, asked["state"])()
            saved, place = (place, place) if asked["state"] == "save" else (saved, saved)
            force = world.force()
            continue
        speed = (asked["place"] - place) / (asked["count"] * settings["time_step"])
        impulse = 0.0
        for _ in range(asked["count"]):
            world.step(speed)
            # What moves the sphere in a step of velocity Verlet is half of the force at each of its ends.
            before, force = force, world.force()
            impulse += 0.5 * (before + force)
        mean, place = impulse / asked["count"], asked["place"]
