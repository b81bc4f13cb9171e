"""Pictures of columns: over time, over one another, and the energy balance."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from cograin.plot.style import COLOURS, LINES, figure, finished, line, prefixed
from cograin.results import ResultError, Table

#: Most lines of a panel that are chosen unasked.
MOST_LINES = 6


def _shared(table: Table, name: str) -> str:
    """What shares a panel: columns of one unit, of those without any the components of one quantity."""
    unit = table.unit_of(name)
    return unit if unit != "1" else re.sub(r"\.[xyz]{1,2}$", "", name)


def _interesting(table: Table) -> dict[str, list[str]]:
    """Columns that change, by their unit, the largest first; columns that are a hundredth of another say little."""
    groups: dict[str, list[tuple[float, str]]] = {}
    turns = any(".rotation." in name or ".angular_velocity." in name for name in table)
    for name, values in table.items():
        finite = values[np.isfinite(values)]
        if name == "time" or name.startswith("time_step") or (".moment." in name and not turns) or not finite.size:
            continue
        spread = float(finite.max() - finite.min())
        is_mean = ".mean_" in name and name.replace(".mean_", ".") in table
        if spread > 0.0 and not is_mean and not name.endswith((".residual", "_residual")):
            groups.setdefault(_shared(table, name), []).append((spread, name))
    chosen = {}
    for key, columns in groups.items():
        columns.sort(reverse=True)
        chosen[key] = [name for spread, name in columns if spread > 0.01 * columns[0][0]][:MOST_LINES]
    # What has a unit comes before counts and ratios.
    return dict(sorted(chosen.items(), key=lambda group: table.unit_of(group[1][0]) == "1"))


def history(table: Table, columns: Sequence[str] | None = None, over: str = "time") -> Any:
    """Columns over time or ``over`` another column, a panel for each unit (or quantity without one).

    Those that change most are drawn if none are named.
    """
    groups: dict[str, list[str]] = {}
    if columns is None:
        chosen = {unit: [name for name in names if name != over] for unit, names in _interesting(table).items()}
        groups = {unit: names for unit, names in chosen.items() if names}
    else:
        for name in columns:
            table[name]  # refuses an unknown one by name
            groups.setdefault(_shared(table, name), []).append(name)
    if not groups:
        raise ResultError("expected a column that changes over time, found none")
    drawn, panels = figure(len(groups), height=2.3)
    along, measure = prefixed(table[over], table.unit_of(over))
    for panel, names in zip(panels, groups.values(), strict=True):
        unit = table.unit_of(names[0])
        factor, shown = prefixed([table[name] for name in names], unit)
        for place, name in enumerate(names):
            panel.plot(along * table[over], factor * table[name], label=name, linewidth=1.3, **line(place))
        panel.set_ylabel(f"[{shown}]" if unit != "1" else "")
        finished(panel)
    panels[-1].set_xlabel(f"{over} [{measure}]" if measure != "1" else over)
    return drawn


def energy(table: Table) -> Any:
    """The energy balance: what the boundaries gave, and where it is."""
    works = [name for name in table if name.endswith(".work")]
    parts = [name for name in ("energy.kinetic", "energy.elastic", "energy.dissipated") if name in table]
    lost = {name: float(np.ptp(table[name])) for name in table if name.startswith("energy.lost.")}
    # What is a hundredth of the largest is no line that could be seen.
    losses = [name for name, spread in lost.items() if spread > 0.01 * max(lost.values())]
    if not parts:
        raise ResultError("expected columns energy.kinetic, energy.elastic, energy.dissipated, found none")
    work = np.sum([table[name] for name in works], axis=0) if works else np.zeros(table.rows)
    shown = {"work of the boundaries": work, **{name.removeprefix("energy."): table[name] for name in parts}}
    shown.update({name.removeprefix("energy."): table[name] for name in losses})
    drawn, (panel,) = figure()
    factor, unit = prefixed(list(shown.values()), "J")
    long, second = prefixed(table["time"], "s")
    for place, (name, values) in enumerate(shown.items()):
        colour = "#000000" if place == 0 else COLOURS[(place - 1) % (len(COLOURS) - 1)]
        width = 1.0 if name.startswith("lost.") else 1.8
        kind = LINES[place % len(LINES)]
        panel.plot(long * table["time"], factor * values, label=name, color=colour, linestyle=kind, linewidth=width)
    panel.set_xlabel(f"time [{second}]")
    panel.set_ylabel(f"energy [{unit}]")
    finished(panel)
    return drawn
