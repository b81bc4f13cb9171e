"""The border of each exchange over the ratio of the masses: by theory as a line, measured as marks.

Both are where a course of 400 steps grows by a factor of 600.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = {
    "Gauss–Seidel": "#b5482a",
    "Jacobi": "#c9a66b",
    "Verlet": "#2a7f4f",
    "fixed point": "#777777",
    "secant": "#1b6ca8",
}
CEILING = 0.4  # where "no border found" is drawn [s]


def draw(path, lines):
    """Writes the picture as PNG."""
    figure, axes = plt.subplots(figsize=(8.0, 5.6), layout="constrained")
    for name in dict.fromkeys(line[0] for line in lines):
        ratios, _, theory, found = np.array([line[1:] for line in lines if line[0] == name], dtype=float).T
        axes.plot(ratios, np.minimum(theory, CEILING), color=COLOURS[name], label=f"{name}, theory")
        held = found >= CEILING
        axes.plot(ratios[~held], found[~held], "o", color=COLOURS[name], label=f"{name}, measured")
        axes.plot(ratios[held], np.full(held.sum(), CEILING), "^", color=COLOURS[name])
    axes.axhline(CEILING, color="0.7", linewidth=0.8, linestyle=":")
    axes.text(3.0, 1.04 * CEILING, "no border up to 0.3 s", color="0.4")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("mass of the particles over mass of the partner")
    axes.set_ylabel("communication step at which it grows [s]")
    axes.legend(frameon=False, fontsize=8, ncols=2)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=110)
    plt.close(figure)
