"""Pictures of boundaries: their facets, coloured by what contacts did to them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cograin.plot.space import VIEWS, proportions
from cograin.plot.style import figure, prefixed
from cograin.plot.values import magnitude
from cograin.results import Frame, ResultError

#: Units of the fields of facets.
FACET_FIELDS = {
    "force": "N",
    "traction": "Pa",
    "normal_pressure": "Pa",
    "wear": "m3",
    "wear_depth": "m",
    "impact_energy_normal": "J",
    "impact_energy_tangential": "J",
}


def facets(frame: Frame, by: str = "wear_depth", view: str = "z", boundaries: Sequence[int] | None = None) -> Any:
    """The facets of the boundaries as seen along an axis, coloured by a field: ``wear_depth``, ``force`` and so on.

    ``boundaries`` chooses some, by their numbers in the scene from 0; by default all.
    """
    surfaces = frame.boundaries
    if surfaces is None or not surfaces.cells:
        raise ResultError("facets: expected files of boundaries; [output] boundaries = true writes them")
    if by not in surfaces.cell_fields:
        raise ResultError(f"facets: expected one of {', '.join(surfaces.cell_fields)}, found {by}")
    from matplotlib.collections import PolyCollection

    kept = (
        np.isin(surfaces["boundary"], list(boundaries))
        if boundaries is not None
        else np.ones(len(surfaces.cells), bool)
    )
    drawn, (panel,) = figure(height=5.5)
    corners = [surfaces.points[cell] for cell, keep in zip(surfaces.cells, kept, strict=True) if keep]
    if not corners:
        return drawn
    points = np.concatenate(corners)
    proportions(panel, points, np.zeros(len(points)), view)
    across, up, depth, sign = VIEWS[view]
    order = np.argsort([-sign * corner[:, depth].mean() for corner in corners], kind="stable")
    found = magnitude(surfaces[by])[kept]
    factor, unit = prefixed(found, FACET_FIELDS.get(by, "1"))
    edges = {"edgecolors": "#999999", "linewidths": 0.4}
    shown = PolyCollection([corners[place][:, [across, up]] for place in order], cmap="viridis", **edges)
    shown.set_array(factor * found[order])
    panel.add_collection(shown)
    drawn.colorbar(shown, ax=panel, label=by.replace("_", " ") + (f" [{unit}]" if unit != "1" else ""))
    panel.set_title(f"t = {frame.time:.6g} s", fontsize=10)
    return drawn
