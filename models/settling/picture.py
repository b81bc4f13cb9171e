"""The picture: speeds over the porosity."""

import numpy as np
from matplotlib.figure import Figure


def draw(path, rows, slip, richardson_zaki):
    """Writes speeds of the suspensions beside closed forms."""
    figure = Figure(figsize=(6.5, 4.8), layout="constrained")
    panel, single = figure.subplots(), slip(1.0)
    over = np.linspace(0.68, 0.98, 60)
    panel.plot(over, [each * slip(each) / single for each in over], color="#0072b2", label="closed form, Di Felice")
    law = "Richardson and Zaki"
    panel.plot(over, [richardson_zaki(each) for each in over], color="#000000", linestyle="--", label=law)
    panel.plot(rows[:, 1], rows[:, 2] / single, "o", color="#d55e00", label="beads and column")
    panel.set(xlabel="porosity", ylabel="speed over that of a single bead", xscale="log", yscale="log")
    panel.set_xticks([0.7, 0.8, 0.9], ["0.7", "0.8", "0.9"])
    panel.set_yticks([0.2, 0.4, 0.6, 0.8], ["0.2", "0.4", "0.6", "0.8"])
    panel.minorticks_off()
    panel.legend(frameon=False)
    panel.grid(color="#dddddd", linewidth=0.6)
    figure.savefig(path, dpi=110)
