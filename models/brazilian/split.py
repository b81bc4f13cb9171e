"""The picture of the splitting test: load and cracks over displacement, where it cracked, and what it looks like inside."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from fracture import broken_bonds, cracks, cut, frames

LOAD, COUNT = "#1b6ca8", "#b5482a"


def draw(path, folder, rows, peak, strength):
    """Writes the picture as PNG."""
    every = list(frames(folder))
    start, last = every[0], every[-1]
    events = cracks(folder, start.number)
    figure, axes = plt.subplot_mosaic(
        [["curve", "cracks", "inside"]], figsize=(14.0, 5.0), width_ratios=[1.3, 1.0, 1.15], layout="constrained"
    )
    curve(axes["curve"], rows, peak, strength)
    broken_bonds(axes["cracks"], start, events, np.ones(len(events.time), dtype=bool))
    axes["cracks"].set_title(f"{len(events.time)} cracks, where the bonds were at the start", fontsize=10)
    spheres = cut(axes["inside"], last, axis=1)
    axes["inside"].set_title(f"cut through the disc at {last.time * 1e3:.2f} ms", fontsize=10)
    figure.colorbar(spheres, ax=axes["inside"], label="damage: bonds broken / bonds made", shrink=0.7)
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    axes["cracks"].plot(25.0 * np.cos(turn), 25.0 + 25.0 * np.sin(turn), color="0.7", linewidth=0.8, zorder=0)
    for name in ("cracks", "inside"):
        axes[name].set_xlim(-30, 30)
        axes[name].set_ylim(-8, 52)
        axes[name].axis("off")
    axes["cracks"].legend(loc="lower center", frameon=False, fontsize=8, ncols=3)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def curve(axes, rows, peak, strength):
    """Load and number of cracks over the displacement of the upper platen."""
    moved, load = -1e3 * rows["upper.displacement.z"], -1e-3 * rows["lower.force.z"]
    axes.plot(moved, load, color=LOAD)
    axes.plot(moved[peak], load[peak], marker="o", color=LOAD)
    note = f"2P/(πDt) = {1e-6 * strength:.1f} MPa   "
    axes.annotate(note, (moved[peak], load[peak]), ha="right", va="center", color=LOAD)
    axes.set_xlabel("displacement of the upper platen [mm]")
    axes.set_ylabel("load on the lower platen [kN]", color=LOAD)
    axes.set_ylim(0.0, 1.12 * load[peak])
    axes.set_xlim(left=0.0)
    count = axes.twinx()
    count.plot(moved, np.maximum(rows["bonds.broken"], 0.5), color=COUNT)
    count.set_yscale("log")
    count.set_ylim(bottom=0.9)
    count.set_ylabel("cracks: bonds broken", color=COUNT)
    for each in (axes, count):
        each.spines["top"].set_visible(False)
    axes.set_title("A bonded disc, split across its diameter")
