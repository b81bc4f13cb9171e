"""Drops the ball on beds of several seeds, with several time steps, and draws both beside the published curves."""

import argparse
import csv
import json
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


def lowest(time, height):
    """The smallest height, from the parabola through the smallest of the rows and its neighbours [m]."""
    at = min(max(int(height.argmin()), 1), len(height) - 2)
    before, least, after = height[at - 1 : at + 2]
    return least - (after - before) ** 2 / (8.0 * (before - 2.0 * least + after))


def at_40_ms(time, height, speed):
    """The height then [m]: the ball flies freely once it is on its way up."""
    left = 0.04 - time[-1]
    return height[-1] + speed[-1] * left - 0.5 * GRAVITY * left**2


def published():
    """Time [s], and the mean height [m] of each program."""
    rows = list(csv.reader((HERE / "published.csv").open()))
    values = np.array(rows[1:], dtype=float)
    return values[:, 0], {name.split("_")[0]: values[:, place] for place, name in enumerate(rows[0]) if "_mean" in name}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/bulk_impact"), help="folder of all results")
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(1, 11)), help="of the beds")
    parser.add_argument(
        "--safeties", type=float, nargs="*", default=[], help="parts of the stable step, beside the default step"
    )
    parser.add_argument(
        "--begin", type=float, default=0.021, help="when a run begins [s]; the ball touches the bed at 0.0214"
    )
    parser.add_argument(
        "--end", type=float, default=0.036, help="when it ends [s]; the ball is on its way up from 0.032 on"
    )
    parser.add_argument(
        "--friction",
        type=float,
        help="of grains while the bed comes to rest: the smaller, the denser it is; their own by default",
    )
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    program, scene, found = Program(options.program), HERE / "scene.toml", []
    for seed in options.seeds:
        given = {"run.seed": seed, "run.threads": options.threads}
        start = bed(program, scene, options.output / f"bed_{seed}", given, friction=options.friction)
        for safety in (None, *options.safeties):
            name = f"{seed}_{safety or 'default'}"
            with_step = given | ({} if safety is None else {"run.safety": safety})
            *course, summary = drop(program, start, options.output / name, with_step, options.begin, options.end)
            found.append((seed, safety, course, summary))
            print(f"bed {seed}, safety {safety or 'default'}: lowest {1e3 * lowest(*course[:2]):.2f} mm,", end=" ")
            print(f"at 40 ms {1e3 * at_40_ms(*course):.2f} mm, {summary['session_steps']} steps", flush=True)
    with (options.output / "found.csv").open("w", newline="") as text:
        rows = [
            (seed, safety or "default", lowest(*course[:2]), at_40_ms(*course), summary["session_steps"])
            for seed, safety, course, summary in found
        ]
        csv.writer(text).writerows([("seed", "safety", "lowest_m", "at_40_ms_m", "steps"), *rows])
    from picture import draw

    draw(options.output / "impact.png", published(), found)


if __name__ == "__main__":
    main()
