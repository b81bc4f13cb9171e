"""Pictures of grids: a field in the cells that a plane cuts."""

from __future__ import annotations

from typing import Any

import numpy as np

from cograin.plot.space import VIEWS, proportions
from cograin.plot.style import figure, prefixed
from cograin.results import Frame, ResultError

#: Units of the fields of grids.
GRID_FIELDS = {
    "density": "kg/m3",
    "velocity": "m/s",
    "stress": "Pa",
    "granular_temperature": "m2/s2",
    "temperature": "K",
}


def section(frame: Frame, grid: str, by: str | None = None, view: str = "y", at: float = 0.5) -> Any:
    """A field of ``[grid.<name>]`` in the cells that a plane across the axis ``view`` cuts, by default its first.

    ``at`` says where the plane is between the two faces of the box, from 0 to 1. A vector is shown by its length, a
    stress by its mean.
    """
    image = frame.grid(grid)
    by = by or next(iter(image.fields))
    if view not in VIEWS or not 0.0 <= at <= 1.0:
        raise ResultError(f"expected view x, y or z and at from 0 to 1, found {view} and {at:g}")
    across, up, depth, _ = VIEWS[view]
    found = image.box(by).astype(float)
    if found.ndim == 4:
        found = found[..., :3].mean(axis=3) if found.shape[3] == 6 else np.linalg.norm(found, axis=3)
    layer = found.take(min(int(at * image.counts[depth]), image.counts[depth] - 1), axis=depth)
    planes = [image.lower[axis] + image.edges[axis] * np.arange(image.counts[axis] + 1) for axis in range(3)]
    drawn, (panel,) = figure(height=5.5)
    corners = np.array([[plane[0] for plane in planes], [plane[-1] for plane in planes]])
    proportions(panel, corners, np.zeros(2), view)
    factor, unit = prefixed(layer, GRID_FIELDS.get(by, "1"))
    shown = panel.pcolormesh(planes[across], planes[up], factor * layer.T, cmap="viridis")
    told = {"stress": "mean stress", "velocity": "speed"}.get(by, by.replace("_", " "))
    drawn.colorbar(shown, ax=panel, label=f"{told} [{unit}]", shrink=0.8)
    panel.set_title(f"{grid}, t = {frame.time:.4g} s", fontsize=10)
    return drawn
