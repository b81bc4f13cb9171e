"""What all pictures have in common: figures, colours, kinds of line, and numbers that can be read."""

from __future__ import annotations

from functools import cache
from io import BytesIO
from typing import Any

import numpy as np

from cograin.base.extras import needed

#: Colours after Okabe and Ito, in an order in which neighbours differ in lightness, too.
COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#000000"]
LINES = ["-", "--", "-.", ":"]
#: Units that take a prefix.
PREFIXED = {"m", "s", "N", "J", "W", "Pa", "N.m", "m/s"}


@cache
def _shown(base: Any) -> Any:
    """A class of figures that a notebook shows, without the state of pyplot."""

    class Picture(base):  # type: ignore[misc]
        """A figure that a notebook shows."""

        def _repr_png_(self) -> bytes:
            written = BytesIO()
            self.savefig(written, format="png", dpi=90)
            return written.getvalue()

    return Picture


def figure(rows: int = 1, columns: int = 1, width: float = 7.0, height: float = 4.0) -> tuple[Any, Any]:
    """A figure with so many panels, whose columns share their first axis."""
    # A figure of its own: no window, no state of pyplot that others share.
    drawn = _shown(needed("matplotlib.figure", "plot").Figure)(figsize=(width, height * rows), layout="constrained")
    needed("matplotlib.backends.backend_agg", "plot").FigureCanvasAgg(drawn)
    return drawn, drawn.subplots(rows, columns, squeeze=False, sharex=rows > 1).ravel()


def prefixed(values: Any, unit: str, *, differences: bool = False) -> tuple[float, str]:
    """A factor that makes numbers readable, and the unit with its prefix; of temperatures only for differences."""
    finite = np.abs(np.asarray(values, dtype=float))
    finite = finite[np.isfinite(finite)]
    largest = float(finite.max()) if finite.size else 0.0
    if unit not in PREFIXED | ({"K"} if differences else set()) or largest == 0.0:
        return 1.0, unit
    exponent = int(np.clip(3 * np.floor(np.log10(largest) / 3.0), -9, 9))
    prefix = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}[exponent]
    return 10.0**-exponent, prefix + unit


def line(place: int) -> dict[str, Any]:
    """Colour and kind of the line that is drawn so many places after the first one."""
    return {"color": COLOURS[place % len(COLOURS)], "linestyle": LINES[place % len(LINES)]}


def finished(panel: Any) -> None:
    """Names the lines beside a panel, and rules it."""
    panel.legend(fontsize=7, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    panel.grid(color="#dddddd", linewidth=0.6)
