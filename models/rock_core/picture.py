"""The picture of the compression test: stress and cracks over strain, where it cracked, and what it looks like inside."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from fracture import broken_bonds, cracks, cut, frames

STRESS, COUNT, REFERENCE = "#1b6ca8", "#b5482a", "#888888"
SLAB = 0.005  # how far from the cut the cracks of the last picture are, at most [m]


def draw(path, folder, rows, strain, stress, peak, modulus):
    """Writes the picture as PNG."""
    every = list(frames(folder))
    start, last = every[0], every[-1]
    events = cracks(folder, start.number)
    figure, axes = plt.subplot_mosaic(
        [["curve", "before", "after", "inside"]],
        figsize=(15.0, 5.6),
        width_ratios=[2.0, 1.0, 1.0, 1.2],
        layout="constrained",
    )
    curve(axes["curve"], rows, strain, stress, peak, modulus)
    before = events.time <= rows["time"][peak]
    depth = start.position[:, 1]
    near = np.abs(depth[events.first] + depth[events.second]) < 2.0 * SLAB
    broken_bonds(axes["before"], start, events, before)
    broken_bonds(axes["after"], start, events, near)
    axes["before"].set_title(f"cracks up to the peak\nall {before.sum()}", fontsize=10)
    shown = f"{near.sum()} of {len(events.time)}, within {1e3 * SLAB:.0f} mm of the cut"
    axes["after"].set_title(f"cracks at the end\n{shown}", fontsize=10)
    spheres = cut(axes["inside"], last, axis=1)
    axes["inside"].set_title(f"cut through the core\nat {last.time * 1e3:.2f} ms", fontsize=10)
    figure.colorbar(spheres, ax=axes["inside"], label="damage: bonds broken / bonds made", shrink=0.6)
    for name in ("before", "after", "inside"):
        axes[name].set_xlim(-30, 30)
        axes[name].set_ylim(-14, 102)
        axes[name].axis("off")
    for name in ("before", "after"):
        axes[name].plot([-25, 25, 25, -25, -25], [0, 0, 100, 100, 0], color="0.7", linewidth=0.8, zorder=0)
        axes[name].legend(loc="lower center", frameon=False, fontsize=8, ncols=2)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def curve(axes, rows, strain, stress, peak, modulus):
    """Stress and number of cracks over strain."""
    axes.plot(1e3 * strain, 1e-6 * stress, color=STRESS, linewidth=2, zorder=2)
    axes.plot(1e3 * strain[peak], 1e-6 * stress[peak], marker="o", color=STRESS)
    note = f"strength {1e-6 * stress[peak]:.1f} MPa  "
    axes.annotate(note, (1e3 * strain[peak], 1e-6 * stress[peak]), ha="right", va="center", color=STRESS)
    half = int(np.argmin(np.abs(stress[:peak] - 0.5 * stress[peak])))
    ends = np.array([0.0, 1.08]) * stress[peak]
    line = strain[half] + (ends - stress[half]) / modulus
    axes.plot(1e3 * line, 1e-6 * ends, color=REFERENCE, linestyle="--", linewidth=1, zorder=1)
    note = f"modulus at half\nthe strength: {1e-9 * modulus:.1f} GPa"
    place = (1e3 * strain[half], 1e-6 * stress[half])
    axes.annotate(note, place, ha="left", va="top", xytext=(10, -4), textcoords="offset points", color="0.3")
    axes.set_xlabel("axial strain [‰]")
    axes.set_ylabel("axial stress at the lower platen [MPa]", color=STRESS)
    axes.set_ylim(0.0, 1.12e-6 * stress[peak])
    axes.set_xlim(left=0.0)
    count = axes.twinx()
    count.plot(1e3 * strain, np.maximum(rows["bonds.broken"], 0.5), color=COUNT)
    count.set_yscale("log")
    count.set_ylim(bottom=0.9)
    count.set_ylabel("cracks: bonds broken", color=COUNT)
    for each in (axes, count):
        each.spines["top"].set_visible(False)
    axes.set_title("Unconfined compression of a bonded core")
