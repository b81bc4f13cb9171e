"""The picture of the run: the bent beam, its force over its deflection, and the spectrum of its ringing."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle

BEAM, FORCE, REFERENCE, GRAIN = "#1b6ca8", "#b5482a", "#333333", "#c9a66b"
DRAWN = 8e-3  # deflection of the tip in the picture [m]


def draw(path, beam, rows, times, tip, found):
    """Writes the picture as PNG."""
    figure, axes = plt.subplot_mosaic(
        [["shape", "shape"], ["force", "spectrum"], ["force", "ringing"]],
        figsize=(11.0, 7.6),
        height_ratios=[1.0, 0.9, 0.9],
        layout="constrained",
    )
    shape(axes["shape"], beam, rows)
    force(axes["force"], beam, np.array(rows))
    spectrum(axes["spectrum"], beam, times, tip, found)
    ringing(axes["ringing"], times, tip, found)
    for name in ("force", "spectrum", "ringing"):
        axes[name].spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def shape(axes, beam, rows):
    """The beam at rest and bent, its deflection magnified."""
    places = beam.spacing * np.arange(beam.bonds + 1)
    bent = -DRAWN * beam.shape()
    for place, drop in zip(places, bent, strict=True):
        axes.add_patch(Circle((place, 0.0), beam.radius, facecolor="none", edgecolor="0.8", linewidth=0.8))
        axes.add_patch(Circle((place, drop), beam.radius, facecolor=GRAIN, edgecolor="#6b5430", linewidth=0.6))
    axes.plot(places, bent, color=BEAM, linewidth=1.2)
    edge = -1.3 * beam.radius
    axes.fill_between([edge - 0.6e-3, edge], -4e-3, 4e-3, color="0.45")
    tip = (places[-1], bent[-1])
    axes.annotate(
        "",
        xy=(tip[0] + 1.8e-3, tip[1]),
        xytext=(tip[0] + 1.8e-3, 0.0),
        arrowprops={"arrowstyle": "->", "color": FORCE, "linewidth": 1.5},
    )
    axes.text(tip[0] + 2.4e-3, 0.5 * tip[1], "tip.displacement.z", color=FORCE, va="center")
    axes.set_aspect("equal")
    axes.set_xlim(-4e-3, places[-1] + 14e-3)
    axes.set_ylim(-DRAWN - 2.5e-3, 4.5e-3)
    times = DRAWN / -rows[-1][1]
    axes.set_title(f"{beam.bonds + 1} bonded spheres, clamped at the left; deflection drawn {times:,.0f} times as large")
    axes.axis("off")


def force(axes, beam, table):
    """Force over deflection, beside theory."""
    deflection = -1e6 * table[:, 1]
    line = np.array([0.0, 1.1 * deflection[-1]])
    label = r"$w\,/\,[\,L^3/(3EI)\,(1-1/(4N^2)) + L/(\kappa GA)\,]$"
    axes.plot(line, line / beam.compliance(), color=REFERENCE, linestyle="--", linewidth=1, label=label)
    axes.plot(deflection, 1e6 * table[:, 2], "o", color=FORCE, label="unit")
    axes.set_xlabel("deflection of the tip [µm]")
    axes.set_ylabel("force of the beam on the tip [µN]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="upper left", frameon=False)


def spectrum(axes, beam, times, tip, found):
    """Spectrum of the ringing tip, with the eigenfrequencies of the chain."""
    window = np.hanning(len(tip))
    amplitude = np.abs(np.fft.rfft(window * tip)) * 4.0 / len(tip)
    frequencies = np.fft.rfftfreq(len(tip), times[1] - times[0])
    shown = (frequencies > 0.0) & (frequencies < 1.3 * found[-1])
    axes.semilogy(frequencies[shown], 1e6 * amplitude[shown], color=BEAM, linewidth=1)
    for mode, (rings, of_chain) in enumerate(zip(found, beam.chain_frequencies(len(found)), strict=True)):
        axes.axvline(of_chain, color=REFERENCE, linestyle="--", linewidth=1, label=None if mode else "chain on paper")
        nearest = np.argmin(np.abs(frequencies - rings))
        axes.annotate(
            f"{rings:.1f} Hz",
            (rings, 1e6 * amplitude[nearest]),
            xytext=(6, 0),
            textcoords="offset points",
            color=BEAM,
            va="center",
        )
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("amplitude [µm]")
    axes.set_ylim(bottom=1e2 * amplitude.max(), top=3e6 * amplitude.max())
    axes.legend(loc="upper center", bbox_to_anchor=(0.53, 1.0), frameon=False)


def ringing(axes, times, tip, found):
    """The first periods of the free tip."""
    shown = times < 3.0 / found[0]
    axes.plot(1e3 * times[shown], 1e6 * tip[shown], color=BEAM, linewidth=1)
    axes.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    axes.set_xlabel("time [ms]")
    axes.set_ylabel("free tip [µm]")
