"""Drops the ball on beds of several seeds, with several time steps, and draws both beside the published curves."""

import argparse
import csv
import json
import math
import re
from pathlib import Path

import numpy as np

from cograin import Program
from cograin.results import Run

HERE = Path(__file__).resolve().parent
RADIUS, LARGER = 1e-3, 2e-3  # of a grain [m], and the part by which it is larger while it falls
GRAVITY = 9.81  # [m/s2]
MODULI = ("material.m1.youngs_modulus", "material.steel.youngs_modulus")


def settings(values):
    """Words of the command line for other values of keys."""
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def bed(program, scene, folder, given, soft=1e7, fall=0.2, friction=None):
    """The scene with the ball over a bed at rest, and that state.

    The grains fall from a loose random arrangement, a hundred times softer than they are, which permits longer steps.
    They are also larger by as much as such grains overlap; what has come to rest is read with its true size, and
    settles once more as hard as it is.
    """
    folder.mkdir(parents=True, exist_ok=True)
    text = scene.read_text()
    alone = re.sub(r"^\[(particles|probe)\.ball\]\n(.+\n)*", "", text, flags=re.MULTILINE)
    alone = re.sub(r"^columns = .*$", "", alone, flags=re.MULTILINE)
    (folder / "falling.toml").write_text(alone)
    values = {"run.safety": 0.8, "run.end": fall, "output.frame_interval": fall, "output.history_interval": fall}
    values |= {"particles.grains.packing.radius": RADIUS * (1.0 + LARGER)} | given
    values |= dict.fromkeys(MODULI, soft) | ({} if friction is None else {"pair.m1.m1.friction": friction})
    program("run", folder / "falling.toml", "-o", folder / "falling", "--overwrite", *settings(values))
    grains = Run(folder / "falling").frames[-1].particles.points
    with (folder / "grains.csv").open("w", newline="") as file:
        csv.writer(file).writerows([("x", "y", "z", "radius"), *((*place, RADIUS) for place in grains.tolist())])
    for name, source in (("bed", alone), ("scene", text)):
        (folder / f"{name}.toml").write_text(
            re.sub(r"^packing = .*$", 'file = "grains.csv"', source, flags=re.MULTILINE)
        )
    kept = {key: value for key, value in given.items() if ".packing." not in key}
    values = {"run.safety": 0.8, "run.settle_tolerance": 5e-2} | kept
    values |= {} if friction is None else {"pair.m1.m1.friction": friction}
    program("settle", folder / "bed.toml", "-o", folder / "bed.cograin", "--overwrite", *settings(values))
    return folder / "scene.toml", folder / "bed.cograin"


def drop(program, start, folder, given, begin=0.0, end=0.04, ball=(0.06, 5.0)):
    """Time [s], height [m] and speed [m/s] of the ball, and the summary of the run.

    The ball falls freely until it touches the bed: with `begin` the run starts so much later, with the ball there.
    """
    scene, state = start
    height, speed = ball[0] - ball[1] * begin - 0.5 * GRAVITY * begin**2, ball[1] + GRAVITY * begin
    values = {"run.end": end - begin} | {key: value for key, value in given.items() if ".packing." not in key}
    values |= {
        "particles.ball.list.1.position": [0.0, 0.0, height],
        "particles.ball.list.1.velocity": [0.0, 0.0, -speed],
    }
    program("run", scene, "--from", state, "-o", folder, "--overwrite", *settings(values))
    rows = np.genfromtxt(folder / "history.csv", delimiter=",", skip_header=1)
    summary = json.loads((folder / "summary.json").read_text())
    return rows[:, 0] + begin, rows[:, 1], rows[:, 2], summary


def turn(time, height):
    """When the ball turns [s], and its height then [m], from rows 1 ms apart, as published.

    It turns in a tenth of that: where a parabola through three rows before the lowest one meets free flight after it.
    """
    rows = np.arange(math.ceil(1e3 * time[0] - 1e-6), math.floor(1e3 * time[-1] + 1e-6) + 1)
    heights = np.interp(1e-3 * rows, time, height)
    at = min(max(int(np.nanargmin(heights)), 3), len(rows) - 5)
    begun, falls = rows[at], np.poly1d([-0.5e-6 * GRAVITY, 0.0, 0.0])
    before, after = slice(at - 3, at), slice(at + 1, at + 5)
    down = np.poly1d(np.polyfit(rows[before] - begun, heights[before], 2))
    flown = rows[after] - begun
    up = np.poly1d(np.polyfit(flown, heights[after] - falls(flown), 1)) + falls
    meets = min((float(root.real) for root in (down - up).roots if root.imag == 0.0), key=abs)
    return 1e-3 * (begun + meets), float(down(meets))


def at_40_ms(time, height, speed):
    """The height then [m]: the ball flies freely once it is on its way up."""
    left = 0.04 - time[-1]
    return height[-1] + speed[-1] * left - 0.5 * GRAVITY * left**2


def published():
    """Time [s], and the mean height [m] of each program."""
    rows = list(csv.reader((HERE / "published.csv").open()))
    values = np.array([[float(cell or "nan") for cell in row] for row in rows[1:]])
    return values[:, 0], {name.split("_")[0]: values[:, place] for place, name in enumerate(rows[0]) if "_mean" in name}


def report(path, found):
    """Writes the figures of each run as a table."""
    rows = [
        (seed, friction, safety or "default", *turn(*course[:2]), at_40_ms(*course), steps)
        for seed, friction, safety, course, steps in found
    ]
    with path.open("w", newline="") as text:
        names = ("seed", "friction_at_rest", "safety", "turn_s", "lowest_m", "at_40_ms_m", "steps")
        csv.writer(text).writerows([names, *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/bulk_impact"), help="folder of all results")
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(1, 11)), help="of the beds")
    parser.add_argument(
        "--safeties", type=float, nargs="*", default=[], help="parts of the stable step, beside the default"
    )
    parser.add_argument("--begin", type=float, default=0.021, help="of a run [s]; the ball touches the bed at 0.0214")
    parser.add_argument("--end", type=float, default=0.036, help="of a run [s]; the ball flies up from 0.032 on")
    parser.add_argument(
        "--frictions",
        type=float,
        nargs="+",
        default=[0.3],
        help="of grains while a bed comes to rest: less makes it denser",
    )
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    program, found = Program(options.program), []
    for seed, friction in ((seed, friction) for friction in options.frictions for seed in options.seeds):
        given = {"run.seed": seed, "run.threads": options.threads}
        folder = options.output / f"bed_{friction}_{seed}"
        start = bed(program, HERE / "scene.toml", folder, given, friction=friction)
        for safety in (None, *options.safeties):
            with_step = given | ({} if safety is None else {"run.safety": safety})
            run = folder / f"run_{safety or 'default'}"
            *course, summary = drop(program, start, run, with_step, options.begin, options.end)
            found.append((seed, friction, safety, course, summary["session_steps"]))
            print(f"bed {seed}, friction {friction}, safety {safety or 'default'}:", end=" ")
            when, least = turn(*course[:2])
            print(f"turns after {1e3 * when:.2f} ms at {1e3 * least:.2f} mm,", end=" ")
            print(f"at 40 ms {1e3 * at_40_ms(*course):.2f} mm", flush=True)
    report(options.output / "found.csv", found)
    from picture import draw

    draw(options.output / "impact.png", published(), found)


if __name__ == "__main__":
    main()
