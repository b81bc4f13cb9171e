"""The picture of the run: the strip before and after it breaks, the force on the hull, and the stress in the ice."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshio
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import TwoSlopeNorm

WATER, HULL, FORCE, THEORY, CRACK = "#d7e8f4", "#55585c", "#1b6ca8", "#333333", "#b5482a"
MAGNIFIED = 30.0  # how much larger sag is drawn than length
HEIGHTENED = 2.0  # the same of the sheet's thickness
SHOWN = 62.0  # length of the strip in the picture [m]
AFTER = 5  # frames from the last before the first crack to the one that shows the pieces
DRAUGHT = 1.5 * 917.0 / 1025.0  # of the sheet [m]
BOND_AREA = np.pi * 0.25**2  # [m²]


class Frame:
    """Spheres and bonds along the strip on its near side, at one time."""

    def __init__(self, folder, number, interval):
        spheres = meshio.read(folder / f"particles_{number:06d}.vtu")
        first = meshio.read(folder / "particles_000000.vtu")
        self.time = number * interval
        self.rest, self.sag = first.points, first.points[:, 2] - spheres.points[:, 2]
        self.order = np.argsort(spheres.point_data["id"].ravel())
        ids = spheres.point_data["id"].ravel()[self.order]
        bonds = meshio.read(folder / f"bonds_{number:06d}.vtu")
        # Bonds of the ice; those of the water end at a plane.
        ice = bonds.cell_data["law"][0].ravel() == 0
        ends = bonds.point_data["id"].ravel()[bonds.cells_dict["line"][ice].astype(int)]
        places = self.order[np.searchsorted(ids, ends)]
        one, two = self.rest[places[:, 0]], self.rest[places[:, 1]]
        along = (np.abs(one[:, 2] - two[:, 2]) < 0.1) & (one[:, 1] < 0.1) & (two[:, 1] < 0.1)
        self.bonds = places[along]
        self.pull = -bonds.cell_data["normal_force"][0].ravel()[ice][along] / BOND_AREA
        self.stress = bonds.cell_data["normal_stress"][0].ravel()[ice][along]

    def drawn(self, places):
        """Where spheres stand in the picture."""
        height = HEIGHTENED * (self.rest[places, 2] - DRAUGHT) - MAGNIFIED * self.sag[places]
        return np.stack([self.rest[places, 0], height], axis=-1)


def draw(output, strip, table, peak, interval, cracks):
    """Writes the picture as PNG."""
    folder = output / "frames"
    number = int(cracks[0][0] / interval)
    last = len(list(folder.glob("particles_*.vtu"))) - 1
    before, after = (Frame(folder, place, interval) for place in (number, min(number + AFTER, last)))
    figure, axes = plt.subplot_mosaic(
        [["before", "before"], ["after", "after"], ["force", "stress"]],
        figsize=(12.0, 8.4),
        height_ratios=[1.0, 1.0, 1.35],
        layout="constrained",
    )
    colour = side_view(axes["before"], before, strip, f"t = {before.time:.1f} s: bent")
    side_view(axes["after"], after, strip, f"t = {after.time:.1f} s: {table[-1, -1]:.0f} bonds broken")
    axes["before"].tick_params(labelbottom=False)
    bar = figure.colorbar(colour, ax=[axes["before"], axes["after"]], shrink=0.8)
    bar.set_label("stress in the bonds [MPa]\npull above 0")
    force_curve(axes["force"], strip, table, peak)
    stress_curve(axes["stress"], strip, before, table, cracks)
    for name in ("force", "stress"):
        axes[name].spines[["top", "right"]].set_visible(False)
    figure.savefig(output / "ice_beam.png", dpi=150)
    plt.close(figure)


def side_view(axes, frame, strip, title):
    """The near row of spheres, its bonds coloured by their stress."""
    limit = 0.5
    level = -HEIGHTENED * DRAUGHT
    axes.fill_between([-6.0, SHOWN], level - 8.0, 0.0, color=WATER, linewidth=0.0)
    segments = frame.drawn(frame.bonds)
    axes.add_collection(LineCollection(segments, colors="0.45", linewidths=6.5))
    lines = LineCollection(segments, cmap="RdBu_r", norm=TwoSlopeNorm(0.0, -limit, limit), linewidths=5.0)
    lines.set_array(frame.pull / 1e6)
    axes.add_collection(lines)
    near = np.flatnonzero(frame.rest[:, 1] < 0.1)
    axes.plot(*frame.drawn(near).T, linestyle="none", marker="o", markersize=2.2, color="0.25", markeredgewidth=0.0)
    edge = frame.drawn(near[[np.lexsort((-frame.rest[near, 2], frame.rest[near, 0]))[0]]])[0]
    low, high = edge[1] - 3.0, 3.0
    face = edge[0] - 0.35 + (high - low) * 0.5
    hull = [[edge[0] - 0.35, low], [face, high], [-6.0, high], [-6.0, low]]
    axes.add_patch(plt.Polygon(hull, color=HULL, zorder=3))
    axes.set_xlim(-6.0, SHOWN)
    axes.set_ylim(level - 6.5, 4.0)
    axes.set_yticks([])
    axes.set_ylabel(f"sag drawn {MAGNIFIED:.0f} times,\nthickness twice", color="0.35")
    axes.set_title(title, loc="left")
    axes.spines[["top", "right", "left"]].set_visible(False)
    return lines


def force_curve(axes, strip, table, peak):
    """Vertical force on the edge over the way of the hull."""
    way, force = table[:, 1], table[:, 5] / 1e3
    axes.plot(way, force, color=FORCE, linewidth=1, label="unit, mean of each communication step")
    breaking, _, _ = strip.breaking()
    end = strip.advance(breaking, strip.push * breaking)
    theory = {"color": THEORY, "linestyle": "--", "linewidth": 1}
    axes.plot([0.0, end], [0.0, breaking / 1e3], **theory, label="beam on water, to its strength")
    axes.plot(way[peak], force[peak], marker="o", color=CRACK, label="last before the first bond breaks")
    axes.axhline(strip.croasdale() / 1e3, color="0.6", linestyle=":", label="Croasdale")
    axes.set_xlabel("way of the hull [m]")
    axes.set_ylabel("force down on the edge [kN]")
    axes.set_ylim(0.0, 1.45e-3 * max(table[peak, 5], breaking))
    axes.legend(loc="upper left", frameon=False, fontsize="small")


def stress_curve(axes, strip, frame, table, cracks):
    """Largest stress of the bonds of the top layer along the strip, beside beam theory."""
    middle = 0.5 * (frame.rest[frame.bonds[:, 0]] + frame.rest[frame.bonds[:, 1]])
    top = middle[:, 2] > 1.2
    edge = 0.5 * strip.thickness / strip.layers
    dots = {"color": FORCE, "marker": ".", "markersize": 4, "linestyle": "none"}
    axes.plot(middle[top, 0] + edge, frame.stress[top] / 1e6, **dots, label="bonds of the top layer")
    row = table[np.searchsorted(table[:, 0], frame.time - 1e-6)]
    x = np.linspace(0.0, SHOWN, 400)
    bond = strip.bond_stress(row[5], -row[4], x)
    axes.plot(x, bond / 1e6, color=THEORY, linestyle="--", linewidth=1, label="beam on water")
    axes.axhline(strip.bond_strength / 1e6, color=CRACK, linewidth=1, linestyle=":", label="strength of a bond")
    places = [place for _, place in cracks]
    axes.plot(places, np.zeros(len(places)), marker="|", markersize=14, color=CRACK, linestyle="none", label="cracks")
    axes.set_xlim(0.0, SHOWN)
    axes.set_xlabel("distance from the edge [m]")
    axes.set_ylabel(f"stress at t = {frame.time:.1f} s [MPa]")
    axes.set_ylim(-0.08, 0.82)
    axes.legend(loc="upper right", frameon=False, fontsize="small", ncols=2)
