"""Pictures of frames: packings as seen along an axis, slices, force chains, cracks, and films of them."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from cograin.base.extras import needed
from cograin.plot.style import COLOURS, LINES, figure, prefixed
from cograin.plot.values import FIELDS, are_kinds, colouring, contact_lines, ends, joined, scale, values
from cograin.results import Cloud, Frame, ResultError, Run

#: Across, up and depth of the views along each axis, and which way its depth goes.
VIEWS = {"x": (1, 2, 0, -1.0), "y": (0, 2, 1, 1.0), "z": (0, 1, 2, -1.0)}
AXES = "xyz"
#: Outlines of particles, which show on every colour.
EDGES: dict[str, Any] = {"edgecolors": "#999999", "linewidths": 0.4}


def proportions(panel: Any, points: Any, radius: Any, view: str) -> None:
    """Axes that show all of these in their proportions."""
    if view not in VIEWS:
        raise ResultError(f"view: expected x, y or z, found {view}")
    across, up, _, _ = VIEWS[view]
    from matplotlib.ticker import FuncFormatter

    factor, unit = 1.0, "m"
    if len(points):
        low, high = (points - radius[:, None]).min(axis=0), (points + radius[:, None]).max(axis=0)
        margin = 0.03 * float((high - low).max())
        panel.set_xlim(low[across] - margin, high[across] + margin)
        panel.set_ylim(low[up] - margin, high[up] + margin)
        factor, unit = prefixed(high - low, "m")
    panel.set_aspect("equal")
    for axis, name in ((panel.xaxis, AXES[across]), (panel.yaxis, AXES[up])):
        axis.set_major_formatter(FuncFormatter(lambda place, _: f"{factor * place:g}"))
        axis.set_label_text(f"{name} [{unit}]")


def _circles(panel: Any, particles: Cloud, view: str, radius: Any, **style: Any) -> Any:
    """The particles as circles, those behind first; colours and values are in the order of the particles."""
    from matplotlib.collections import EllipseCollection

    across, up, depth, sign = VIEWS[view]
    order = np.argsort(-sign * particles.points[:, depth], kind="stable")
    size, places = 2.0 * radius[order], particles.points[order][:, [across, up]]
    found, colours = style.pop("values", None), style.pop("colours", None)
    if colours is not None:
        style["facecolors"] = colours[order]
    flat = np.zeros(len(order))
    drawn = EllipseCollection(size, size, flat, offsets=places, units="xy", offset_transform=panel.transData, **style)
    if found is not None:
        drawn.set_array(found[order])
    panel.add_collection(drawn)
    return drawn


def _walls(panel: Any, surfaces: Cloud, view: str, at: float) -> None:
    """The lines in which a plane across the view cuts the facets of boundaries."""
    from matplotlib.collections import LineCollection

    across, up, depth, _ = VIEWS[view]
    lines = []
    for cell in surfaces.cells:
        corners = surfaces.points[cell]
        before, after = corners[:, depth] - at, np.roll(corners[:, depth], -1) - at
        crossing = np.flatnonzero((before < 0.0) != (after < 0.0))
        share = (before[crossing] / (before[crossing] - after[crossing]))[:, None]
        met = corners[crossing] + share * (np.roll(corners, -1, axis=0)[crossing] - corners[crossing])
        if len(met) == 2:
            lines.append(met[:, [across, up]])
    panel.add_collection(LineCollection(lines, colors="#333333", linewidths=1.5), autolim=False)
    if lines:
        ends_of = np.concatenate(lines)
        for limits, column in (("xlim", 0), ("ylim", 1)):
            low, high = getattr(panel, f"get_{limits}")()
            margin = 0.01 * (high - low)
            reached = ends_of[:, column].min() - margin, ends_of[:, column].max() + margin
            # A wall that goes on far beyond the particles, as a plane does, is shown as far as they are.
            size = high - low
            getattr(panel, f"set_{limits}")(
                max(min(low, reached[0]), low - 0.5 * size), min(max(high, reached[1]), high + 0.5 * size)
            )


def packing(
    frame: Frame,
    by: str = "velocity",
    view: str = "y",
    scale: tuple[float, float] | None = None,
    *,
    at: float | None = None,
    names: Mapping[int, str] | None = None,
    panel: Any = None,
) -> Any:
    """The particles as seen along an axis, coloured by a field: ``velocity``, ``force``, ``set`` and so on.

    ``scale`` gives the values of the two ends of the colours; by default those of this frame but for its largest
    hundredth. ``at`` \\[m\\] shows the slice at this place of the axis: particles where it cuts them, and walls (with
    ``[output] boundaries``). ``names`` are those of numbers, such as sets, where
    others are wanted than those of the scene. ``panel`` is drawn in, where one is given.
    """
    drawn, (panel,) = figure(height=5.5) if panel is None else (panel.figure, (panel,))
    particles = frame.particles
    radius = particles["radius"] if len(particles) else np.empty(0)
    proportions(panel, particles.points, radius, view)
    panel.set_title(f"t = {frame.time:.4g} s", fontsize=10)
    shown = np.ones(len(particles), dtype=bool)
    if at is not None:
        off = particles.points[:, VIEWS[view][2]] - at
        shown = np.abs(off) < radius
        radius = np.sqrt(np.maximum(radius**2 - off**2, 0.0))
        if (surfaces := frame.boundaries) is not None and len(surfaces):
            _walls(panel, surfaces, view, at)
    if not shown.any():
        return drawn
    by = colouring(particles, by)
    style = {"view": view, "radius": radius[shown], **EDGES}
    if are_kinds(particles, by):
        _kinds(panel, _part(particles, shown), particles[by], by, names or frame.names(by), shown, style)
    else:
        found = values(frame, particles, by)
        low, high = scale or ends(particles, by, found, frame.time)
        base = _base(low, high)
        factor, unit = prefixed([low - base, high - base], FIELDS.get(by, "1"), differences=bool(base))
        numbers = factor * (found[shown] - base)
        circles = _circles(panel, _part(particles, shown), values=numbers, cmap="viridis", **style)
        circles.set_clim(factor * (low - base), factor * (high - base))
        above = f" − {base:g} {FIELDS.get(by, '')}".rstrip() if base else ""
        beyond = "max" if found[shown].max() > high else "neither"
        label = f"{by}{above}" + (f" [{unit}]" if unit != "1" else "")
        drawn.colorbar(circles, ax=panel, label=label, shrink=0.8, extend=beyond)
    return drawn


def _base(low: float, high: float) -> float:
    """What is taken off numbers that differ by little: 300 of 300.001 to 300.004."""
    size = max(abs(low), abs(high))
    if size == 0.0 or high - low > 0.02 * size or high <= low:
        return 0.0
    return float(f"{low:.3g}") if abs(low - float(f"{low:.3g}")) < 10.0 * (high - low) else low


def _part(particles: Cloud, shown: Any) -> Cloud:
    """Some of the particles."""
    return Cloud(particles.points[shown], {})


def _kinds(panel: Any, particles: Cloud, numbers: Any, by: str, names: Any, shown: Any, style: dict[str, Any]) -> None:
    """The particles, each kind in a colour of its own, and a legend."""
    from matplotlib import colormaps
    from matplotlib.lines import Line2D

    kinds = np.unique(numbers)
    # From dark to light: kinds differ in print, too.
    colours = colormaps["viridis"](np.linspace(0.1, 0.9, len(kinds)))
    _circles(panel, particles, colours=colours[np.searchsorted(kinds, numbers[shown])], **style)
    marks = [Line2D([], [], marker="o", linestyle="", color=colour) for colour in colours]
    told = [names.get(int(kind), f"{by} {kind}") for kind in kinds]
    panel.legend(marks, told, frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))


def force_chains(frame: Frame, view: str = "y") -> Any:
    """Normal forces between particles as lines, the wider the larger; needs ``[output] contacts = true``."""
    from matplotlib.collections import LineCollection

    contacts, particles = frame.contacts, frame.particles
    if contacts is None:
        raise ResultError("force chains: expected files of contacts; [output] contacts = true writes them")
    drawn, (panel,) = figure(height=5.5)
    radius = particles["radius"] if len(particles) else np.empty(0)
    proportions(panel, particles.points, radius, view)
    if len(particles):
        _circles(panel, particles, view, radius, facecolors="none", edgecolors="#cccccc", linewidths=0.4)
    if len(contacts):
        across, up, _, _ = VIEWS[view]
        first, second = contact_lines(frame, particles, contacts)
        lines, force = joined(first, second, contacts["normal_force"], frame.edges)
        order = np.argsort(np.abs(force))
        lines = lines[order][:, :, [across, up]]
        largest = float(np.abs(force).max())
        factor, unit = prefixed(force, "N")
        # The largest line is as wide as a grain looks; forces of a hundredth vanish.
        width = 5.0 * np.abs(force[order]) / largest if largest else np.zeros(len(force))
        chains = LineCollection(list(lines), linewidths=width, cmap="viridis_r", capstyle="round")
        chains.set_array(factor * force[order])
        panel.add_collection(chains)
        drawn.colorbar(chains, ax=panel, label=f"normal force [{unit}], above 0 pushes", shrink=0.8)
    panel.set_title(f"t = {frame.time:.4g} s", fontsize=10)
    return drawn


def cracks(run: Run, view: str = "y") -> Any:
    """Where bonds broke and by what, and how many over time."""
    rows = run.breakage
    if not rows:
        raise ResultError("cracks: expected broken bonds in breakage.csv, found none")
    points = np.array([[float(row[f"position.{axis}"]) for axis in AXES] for row in rows])
    times = np.array([float(row["time"]) for row in rows])
    causes = sorted({row["cause"] for row in rows})
    drawn, (where, when) = figure(columns=2, width=9.0, height=4.5)
    across, up, _, _ = VIEWS[view]
    if frames := run.frames:
        particles = frames[0].particles
        proportions(where, particles.points, particles["radius"], view)
        faint = {"facecolors": "none", "edgecolors": "#dddddd", "linewidths": 0.3}
        _circles(where, particles, view, particles["radius"], **faint)
    else:
        proportions(where, points, np.zeros(len(points)), view)
    long, second = prefixed(times, "s")
    for place, cause in enumerate(causes):
        chosen = np.array([row["cause"] == cause for row in rows])
        colour, mark = COLOURS[place % len(COLOURS)], "o^sDv"[place % 5]
        where.scatter(points[chosen, across], points[chosen, up], s=9, color=colour, marker=mark, label=cause, zorder=3)
        moments = np.append(np.sort(times[chosen]), times.max())
        counts = np.append(np.arange(1, len(moments)), len(moments) - 1)
        style = {"color": colour, "linestyle": LINES[place % len(LINES)], "marker": mark, "markersize": 4.0}
        when.step(long * moments, counts, where="post", markevery=max(1, len(moments) // 8), **style)
    drawn.legend(loc="outside lower center", ncols=len(causes), frameon=False, markerscale=2.0)
    when.set_xlabel(f"time [{second}]")
    when.set_ylabel("broken bonds")
    when.grid(color="#dddddd", linewidth=0.6)
    return drawn


def animation(
    run: Run, path: str | Path, by: str = "velocity", view: str = "y", pause: float = 0.1, **named: Any
) -> Path:
    """Writes the packing over all frames as an animated GIF, with the same colours in each."""
    image = needed("PIL.Image", "plot")
    frames = run.frames
    if not frames:
        raise ResultError("animation: expected frames; [output] frame_interval writes them")
    filled = [(frame, cloud) for frame in frames if len(cloud := frame.particles)]
    if not filled:
        raise ResultError("animation: expected particles in the frames, found none")
    found = np.concatenate([values(frame, cloud, colouring(cloud, by)) for frame, cloud in filled])
    lows = np.min([(cloud.points - cloud["radius"][:, None]).min(axis=0) for _, cloud in filled], axis=0)
    highs = np.max([(cloud.points + cloud["radius"][:, None]).max(axis=0) for _, cloud in filled], axis=0)
    pictures = []
    for frame in frames:
        drawn = packing(frame, by, view, scale(found), **named)
        panel, (across, up, _, _) = drawn.axes[0], VIEWS[view]
        panel.set_xlim(lows[across], highs[across])
        panel.set_ylim(lows[up], highs[up])
        memory = io.BytesIO()
        drawn.savefig(memory, format="png", dpi=80)
        pictures.append(image.open(memory).convert("P", palette=image.Palette.ADAPTIVE))
    path = Path(path)
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=int(1000 * pause), loop=0)
    return path
