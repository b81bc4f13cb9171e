"""The picture of the run: the bed on its beam, sag and floor force over time, and the exchange that fails."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

BEAM, FORCE, REFERENCE, FAILURE, GRAIN = "#1b6ca8", "#b5482a", "#333333", "#8e44ad", "#c9a66b"
MAGNIFIED = 20.0


def draw(path, design, packing, beam, rows, failed, reference, weight):
    """Writes the picture as PNG."""
    table = np.array(rows)
    shown = ["sag", "force", "failure"] if failed else ["sag", "force"]
    figure, axes = plt.subplot_mosaic(
        [["side", name] for name in shown],
        figsize=(12.0, 7.2 if failed else 6.0),
        width_ratios=[1.0, 1.35],
        layout="constrained",
    )
    side_view(axes["side"], design, packing, beam)
    sag_curve(axes["sag"], table, reference)
    force_curve(axes["force"], table, weight, table[-1, 4])
    axes["sag"].sharex(axes["force"])
    axes["sag"].tick_params(labelbottom=False)
    if failed:
        failure_curve(axes["failure"], np.array(failed), table)
    for name in shown:
        axes[name].spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def side_view(axes, design, packing, beam):
    """A slice through the bed, over plate and beam with their deflection magnified."""
    width = 0.2448
    drop = MAGNIFIED * beam.deflection
    x, y, z, radius = packing[:, :4].T
    cut = np.sqrt(np.maximum(radius**2 - (y - 0.5 * width) ** 2, 0.0))
    seen = cut > 0.0
    grains = EllipseCollection(
        2 * cut[seen],
        2 * cut[seen],
        np.zeros(seen.sum()),
        units="xy",
        offsets=np.column_stack([x[seen] - 0.5 * width, z[seen] + drop]),
        transOffset=axes.transData,
        facecolor=GRAIN,
        edgecolor="#6b5430",
        linewidth=0.4,
    )
    axes.add_collection(grains)
    top = z.max() + 0.03
    for sign in (-1, 1):
        axes.plot([sign * 0.5 * width] * 2, [-0.03, top], color="0.6", linewidth=1.5, zorder=0)
    plate, bearing = 0.012, 0.02
    axes.fill_between([-0.49 * width, 0.49 * width], drop - plate, drop, color="0.45")
    axes.fill_between([-0.006, 0.006], drop - plate - bearing, drop - plate, color="0.45")

    positions = np.linspace(-0.5, 0.5, 201) * design.span
    line = MAGNIFIED * deflected(design, beam, positions)
    level = -plate - bearing
    axes.fill_between(positions, level + line - design.height, level + line, color=BEAM)
    axes.plot(positions, np.full_like(positions, level), color="0.5", linewidth=0.8, linestyle=":")
    for end in (-0.5, 0.5):
        axes.plot(end * design.span, level - design.height - 0.012, marker="^", color="0.3", markersize=13)
    axes.set_aspect("equal")
    axes.set_xlim(-0.56 * design.span, 0.56 * design.span)
    axes.set_ylim(level - design.height - 0.09, top)
    axes.set_title(f"{len(packing):,} grains on an elastic beam")
    note = f"a slice; sag drawn {MAGNIFIED:.0f} times as large"
    axes.text(0, level - design.height - 0.06, note, ha="center", color="0.35")
    axes.axis("off")


def deflected(design, beam, positions):
    """Deflection of the beam at positions from its middle [m]: linear between fine enough nodes."""
    nodes = np.linspace(-0.5, 0.5, design.elements + 1) * design.span
    return np.interp(positions, nodes, beam.field[beam.nodes])


def sag_curve(axes, table, reference):
    """Sag of the floor beside the static reference."""
    axes.plot(np.append(0.0, table[:, 0]), np.append(0.0, -1e3 * table[:, 1]), color=BEAM, label="coupled")
    axes.axhline(-1e3 * reference, color=REFERENCE, linestyle="--", linewidth=1, label="static reference")
    axes.set_ylabel("sag of the floor [mm]")
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower right", frameon=False)


def force_curve(axes, table, weight, walls):
    """Force of the grains on the floor beside what rests on it in the end."""
    axes.plot(table[:, 0], -table[:, 3], color=FORCE, label="mean of each communication step")
    axes.axhline(weight + walls, color=REFERENCE, linestyle="--", linewidth=1, label="weight − walls")
    axes.set_ylabel("force on the floor [N]")
    axes.set_xlabel("time [s]")
    axes.legend(loc="lower right", frameon=False)


def failure_curve(axes, failed, table):
    """The exchange that grows, beside the one that holds."""
    shown = table[:, 0] <= failed[-1, 0] * 1.15
    label = "explicit exchange, same plate and interval"
    axes.plot(failed[:, 0] * 1e3, -failed[:, 3], color=FAILURE, marker=".", label=label)
    axes.plot(table[shown, 0] * 1e3, -table[shown, 3], color=FORCE, label="implicit exchange")
    axes.set_ylabel("force on the floor [N]")
    axes.set_xlabel("time [ms]")
    axes.legend(loc="upper left", frameon=False)
