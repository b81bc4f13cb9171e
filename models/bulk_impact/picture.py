"""The picture: height of the ball over time, and both figures of it over the time step."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from impact import at_40_ms, turn

OTHERS, OWN = "0.55", "#b5482a"
COLOURS = (OWN, "#1b6ca8", "#2a7f4f")


def draw(path, others, found):
    """Writes both panels, the second one where several time steps were tried."""
    safeties = sorted({safety for *_, safety, _, _ in found if safety})
    figure, axes = plt.subplots(
        1, 3 if safeties else 1, figsize=(13.5 if safeties else 6.0, 4.4), layout="constrained", squeeze=False
    )
    course(axes[0, 0], others, found)
    if safeties:
        time, heights = others
        least = [turn(time, height)[1] for height in heights.values()]
        last = [height[np.searchsorted(time, 0.04)] for height in heights.values()]
        over_the_step(axes[0, 1], found, lambda of: turn(*of[:2])[1], least, "lowest point [mm]")
        over_the_step(axes[0, 2], found, lambda of: at_40_ms(*of), last, "height at 40 ms [mm]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def course(axes, others, found):
    """Height over time: the other programs' means over ten beds, and each bed with the default step."""
    time, heights = others
    for number, height in enumerate(heights.values()):
        label = None if number else "eight programs, means of ten beds"
        axes.plot(1e3 * time, 1e3 * height, color=OTHERS, linewidth=1, label=label)
    named = set()
    for _, friction, safety, (when, height, *_), _ in found:
        if safety is None:
            label = None if friction in named else f"cograin, beds that came to rest with friction {friction}"
            named.add(friction)
            colour = COLOURS[len(named) - 1]
            axes.plot(1e3 * when, 1e3 * height, color=colour, linewidth=1, label=label)
    axes.set(xlim=(20, 40), ylim=(-82, -40), xlabel="time [ms]", ylabel="height of the ball [mm]")
    axes.legend(frameon=False)


def over_the_step(axes, found, figure, range_of_others, of):
    """A figure of the ball over the part of the stable step that a time step takes, beside the other programs."""
    low, high = min(range_of_others), max(range_of_others)
    axes.axhspan(1e3 * low, 1e3 * high, color=OTHERS, alpha=0.4, linewidth=0, label="means of the eight programs")
    beds = sorted({(seed, friction) for seed, friction, *_ in found})
    for number, bed in enumerate(beds):
        rows = sorted((row[2], 1e3 * figure(row[3])) for row in found if row[:2] == bed and row[2])
        if rows:
            label = None if number else "cograin, a line for each bed"
            axes.plot(*zip(*rows, strict=True), "o-", color=OWN, markersize=4, linewidth=1, label=label)
    axes.set(xscale="log", xlabel="time step over the stable one (safety)", ylabel=of)
    shown = sorted({row[2] for row in found if row[2]})
    axes.set_xticks(shown, [f"{safety:g}" for safety in shown])
    axes.minorticks_off()
    axes.legend(frameon=False)
