"""Pictures of a run: ``python -m cograin.plot OUT``.

``OUT`` is the folder of ``cograin run``, or the CSV file of a coupled run's record. Each function here gives a figure
of matplotlib, so that a script can change and save it:

    from cograin.plot import packing
    from cograin.results import Run
    packing(Run("out").frames[-1], by="velocity").savefig("packing.png")

Colours are told apart with any colour vision, and in print by their lightness or the kind of line.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cograin.extras import needed
from cograin.results import Cloud, Frame, ResultError, Run, Table, read_table

#: Colours after Okabe and Ito, in an order in which neighbours differ in lightness, too.
COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#000000"]
LINES = ["-", "--", "-.", ":"]
MOST_LINES = 6
VIEWS = {"x": (1, 2, 0, -1.0), "y": (0, 2, 1, 1.0), "z": (0, 1, 2, -1.0)}
NAMES = "xyz"


def _figure(rows: int = 1, width: float = 7.0, height: float = 4.0) -> tuple[Any, Any]:
    """A figure with so many panels, one above the other."""
    # A figure of its own: no window, no state of pyplot that others share.
    figure = needed("matplotlib.figure", "plot").Figure(figsize=(width, height * rows), layout="constrained")
    needed("matplotlib.backends.backend_agg", "plot").FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, 1, squeeze=False, sharex=rows > 1)[:, 0]


def _prefixed(values: Any, unit: str) -> tuple[float, str]:
    """A factor that makes numbers readable, and the unit with its prefix."""
    finite = np.abs(np.asarray(values, dtype=float))
    finite = finite[np.isfinite(finite)]
    largest = float(finite.max()) if finite.size else 0.0
    if unit not in {"m", "s", "N", "J", "Pa", "N.m", "m/s"} or largest == 0.0:
        return 1.0, unit
    exponent = int(np.clip(3 * np.floor(np.log10(largest) / 3.0), -9, 9))
    prefix = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}[exponent]
    return 10.0**-exponent, prefix + unit


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
        if spread > 0.0 and not is_mean and not name.endswith((".residual", ".physical_residual")):
            groups.setdefault(_shared(table, name), []).append((spread, name))
    chosen = {}
    for key, columns in groups.items():
        columns.sort(reverse=True)
        chosen[key] = [name for spread, name in columns if spread > 0.01 * columns[0][0]][:MOST_LINES]
    # What has a unit comes before counts and ratios.
    return dict(sorted(chosen.items(), key=lambda group: table.unit_of(group[1][0]) == "1"))


def history(table: Table, columns: Sequence[str] | None = None) -> Any:
    """Columns over time, a panel for each unit (or quantity without one); those that change most if none are named."""
    if columns is None:
        groups = _interesting(table)
    else:
        groups = {}
        for name in columns:
            table[name]  # refuses an unknown one by name
            groups.setdefault(_shared(table, name), []).append(name)
    if not groups:
        raise ResultError("expected a column that changes over time, found none")
    figure, panels = _figure(len(groups), height=2.3)
    long, second = _prefixed(table["time"], "s")
    for panel, names in zip(panels, groups.values(), strict=True):
        unit = table.unit_of(names[0])
        factor, shown = _prefixed([table[name] for name in names], unit)
        for place, name in enumerate(names):
            style = {"color": COLOURS[place % len(COLOURS)], "linestyle": LINES[place % len(LINES)]}
            panel.plot(long * table["time"], factor * table[name], label=name, linewidth=1.3, **style)
        panel.set_ylabel(f"[{shown}]" if unit != "1" else "")
        panel.legend(fontsize=7, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
        panel.grid(color="#dddddd", linewidth=0.6)
    panels[-1].set_xlabel(f"time [{second}]")
    return figure


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
    figure, (panel,) = _figure()
    factor, unit = _prefixed(list(shown.values()), "J")
    long, second = _prefixed(table["time"], "s")
    for place, (name, values) in enumerate(shown.items()):
        colour = "#000000" if place == 0 else COLOURS[(place - 1) % (len(COLOURS) - 1)]
        line = LINES[place % len(LINES)]
        width = 1.0 if name.startswith("lost.") else 1.8
        panel.plot(long * table["time"], factor * values, label=name, color=colour, linestyle=line, linewidth=width)
    panel.set_xlabel(f"time [{second}]")
    panel.set_ylabel(f"energy [{unit}]")
    panel.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    panel.grid(color="#dddddd", linewidth=0.6)
    return figure


def _view(panel: Any, points: Any, radius: Any, view: str) -> None:
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
        factor, unit = _prefixed(high - low, "m")
    panel.set_aspect("equal")
    for axis, name in ((panel.xaxis, NAMES[across]), (panel.yaxis, NAMES[up])):
        axis.set_major_formatter(FuncFormatter(lambda place, _: f"{factor * place:g}"))
        axis.set_label_text(f"{name} [{unit}]")


def _circles(panel: Any, particles: Cloud, view: str, **style: Any) -> Any:
    """The particles as circles, those behind first."""
    from matplotlib.collections import EllipseCollection

    across, up, depth, sign = VIEWS[view]
    order = np.argsort(-sign * particles.points[:, depth], kind="stable")
    size = 2.0 * particles["radius"][order]
    places = particles.points[order][:, [across, up]]
    values = style.pop("values", None)
    drawn = EllipseCollection(
        size, size, np.zeros(len(order)), offsets=places, units="xy", offset_transform=panel.transData, **style
    )
    if values is not None:
        drawn.set_array(values[order])
    panel.add_collection(drawn)
    return drawn


def _magnitude(values: Any) -> Any:
    """Lengths of vectors; numbers as they are."""
    return np.linalg.norm(values, axis=1) if values.ndim == 2 else values.astype(float)


def _scale(values: Any) -> tuple[float, float]:
    """The values of the two ends of the colours: one grain in a hundred may be beyond, so that one does not dim all."""
    return float(values.min()), float(np.percentile(values, 99.0))


#: Part of its radius that a grain at rest may have moved since the start, at its present speed.
STILL = 0.01


def _still(particles: Cloud, time: float) -> float:
    """The speed below which particles are at rest, as a picture shows them \\[m/s\\]."""
    return STILL * float(np.median(particles["radius"])) / time if time > 0.0 else 0.0


#: Outlines of particles, which show on every colour.
EDGES: dict[str, Any] = {"edgecolors": "#999999", "linewidths": 0.4}
#: Units of the fields of particles.
FIELDS = {"velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "torque": "N.m", "mass": "kg", "radius": "m"}

#: Units of the fields of grids.
GRID_FIELDS = {
    "density": "kg/m3",
    "velocity": "m/s",
    "stress": "Pa",
    "granular_temperature": "m2/s2",
    "temperature": "K",
}


def packing(frame: Frame, by: str = "velocity", view: str = "y", scale: tuple[float, float] | None = None) -> Any:
    """The particles as seen along an axis, coloured by a field: ``velocity``, ``force``, ``set`` and so on.

    ``scale`` gives the values of the two ends of the colours; by default those of this frame but for its largest
    hundredth.
    """
    particles = frame.particles
    figure, (panel,) = _figure(height=5.5)
    _view(panel, particles.points, particles["radius"] if len(particles) else np.empty(0), view)
    if not len(particles):
        return figure
    if by == "set" and "set" not in particles.fields:
        by = "material"  # a scene of one set does not number it
    values = particles[by]
    if values.dtype.kind in "iu" and by != "id":
        kinds = np.unique(values)
        from matplotlib import colormaps
        from matplotlib.lines import Line2D

        places = np.searchsorted(kinds, values)
        # From dark to light: kinds differ in print, too.
        colours = colormaps["viridis"](np.linspace(0.1, 0.9, len(kinds)))
        order = np.argsort(-VIEWS[view][3] * particles.points[:, VIEWS[view][2]], kind="stable")
        _circles(panel, particles, view, facecolors=colours[places[order]], **EDGES)
        marks = [Line2D([], [], marker="o", linestyle="", color=colours[place]) for place in range(len(kinds))]
        panel.legend(
            marks, [f"{by} {kind}" for kind in kinds], frameon=False, loc="center left", bbox_to_anchor=(1, 0.5)
        )
    else:
        values = _magnitude(values)
        low, high = scale or _scale(values)
        if scale is None and by == "velocity":
            high = max(high, _still(particles, frame.time))
        factor, unit = _prefixed([low, high], FIELDS.get(by, "1"))
        drawn = _circles(panel, particles, view, values=factor * values, cmap="viridis", **EDGES)
        drawn.set_clim(factor * low, factor * high)
        beyond = "max" if values.max() > high else "neither"
        figure.colorbar(drawn, ax=panel, label=f"{by} [{unit}]", shrink=0.8, extend=beyond)
    panel.set_title(f"t = {frame.time:.4g} s", fontsize=10)
    return figure


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
    values = image.box(by).astype(float)
    if values.ndim == 4:
        values = values[..., :3].mean(axis=3) if values.shape[3] == 6 else np.linalg.norm(values, axis=3)
    layer = values.take(min(int(at * image.counts[depth]), image.counts[depth] - 1), axis=depth)
    planes = [image.lower[axis] + image.edges[axis] * np.arange(image.counts[axis] + 1) for axis in range(3)]
    figure, (panel,) = _figure(height=5.5)
    corners = np.array([[plane[0] for plane in planes], [plane[-1] for plane in planes]])
    _view(panel, corners, np.zeros(2), view)
    factor, unit = _prefixed(layer, GRID_FIELDS.get(by, "1"))
    drawn = panel.pcolormesh(planes[across], planes[up], factor * layer.T, cmap="viridis")
    told = {"stress": "mean stress", "velocity": "speed"}.get(by, by.replace("_", " "))
    figure.colorbar(drawn, ax=panel, label=f"{told} [{unit}]", shrink=0.8)
    panel.set_title(f"{grid}, t = {frame.time:.4g} s", fontsize=10)
    return figure


def _ends(frame: Frame, particles: Cloud, contacts: Cloud) -> tuple[Any, Any]:
    """Where the lines of contacts begin and end: at the centres; at a boundary where they touch."""
    place_of = {int(number): place for place, number in enumerate(particles["id"])}
    ends = [np.array([place_of.get(int(number), -1) for number in contacts[name]]) for name in ("id1", "id2")]
    second = np.where((ends[1] >= 0)[:, None], particles.points[ends[1]], contacts.points)
    return particles.points[ends[0]], second


def _joined(first: Any, second: Any, values: Any, edges: Any) -> tuple[Any, Any]:
    """Lines between points, with their values. Through a face of a cell there are two: from each point to the image."""
    lines = np.stack([first, second], axis=1)
    if edges is None:
        return lines, values
    apart = second - first
    way = apart - np.round(apart @ np.linalg.pinv(edges)) @ edges
    through = np.abs(way - apart).max(axis=1) > 1e-6 * np.abs(edges).max()
    lines[:, 1] = first + way
    back = np.stack([second - way, second], axis=1)[through]
    return np.concatenate([lines, back]), np.concatenate([values, values[through]])


def force_chains(frame: Frame, view: str = "y") -> Any:
    """Normal forces between particles as lines, the wider the larger; needs ``[output] contacts = true``."""
    from matplotlib.collections import LineCollection

    contacts, particles = frame.contacts, frame.particles
    if contacts is None:
        raise ResultError("force chains: expected files of contacts; [output] contacts = true writes them")
    figure, (panel,) = _figure(height=5.5)
    _view(panel, particles.points, particles["radius"] if len(particles) else np.empty(0), view)
    if len(particles):
        _circles(panel, particles, view, facecolors="none", edgecolors="#cccccc", linewidths=0.4)
    if len(contacts):
        across, up, _, _ = VIEWS[view]
        first, second = _ends(frame, particles, contacts)
        force = contacts["normal_force"]
        lines, force = _joined(first, second, force, frame.edges)
        order = np.argsort(np.abs(force))
        lines = lines[order][:, :, [across, up]]
        largest = float(np.abs(force).max())
        factor, unit = _prefixed(force, "N")
        # The largest line is as wide as a grain looks; forces of a hundredth vanish.
        width = 5.0 * np.abs(force[order]) / largest if largest else np.zeros(len(force))
        drawn = LineCollection(list(lines), linewidths=width, cmap="viridis_r", capstyle="round")
        drawn.set_array(factor * force[order])
        panel.add_collection(drawn)
        figure.colorbar(drawn, ax=panel, label=f"normal force [{unit}], above 0 pushes", shrink=0.8)
    panel.set_title(f"t = {frame.time:.4g} s", fontsize=10)
    return figure


def cracks(run: Run, view: str = "y") -> Any:
    """Where bonds broke and by what, and how many over time."""
    rows = run.breakage
    if not rows:
        raise ResultError("cracks: expected broken bonds in breakage.csv, found none")
    points = np.array([[float(row[f"position.{axis}"]) for axis in NAMES] for row in rows])
    times = np.array([float(row["time"]) for row in rows])
    causes = sorted({row["cause"] for row in rows})
    figure = needed("matplotlib.figure", "plot").Figure(figsize=(9.0, 4.5), layout="constrained")
    needed("matplotlib.backends.backend_agg", "plot").FigureCanvasAgg(figure)
    where, when = figure.subplots(1, 2)
    across, up, _, _ = VIEWS[view]
    frames = run.frames
    if frames:
        particles = frames[0].particles
        _view(where, particles.points, particles["radius"], view)
        _circles(where, particles, view, facecolors="none", edgecolors="#dddddd", linewidths=0.3)
    else:
        _view(where, points, np.zeros(len(points)), view)
    long, second = _prefixed(times, "s")
    for place, cause in enumerate(causes):
        chosen = np.array([row["cause"] == cause for row in rows])
        colour, mark = COLOURS[place % len(COLOURS)], "o^sDv"[place % 5]
        where.scatter(points[chosen, across], points[chosen, up], s=9, color=colour, marker=mark, label=cause, zorder=3)
        moments = np.append(np.sort(times[chosen]), times.max())
        counts = np.append(np.arange(1, len(moments)), len(moments) - 1)
        style = {"color": colour, "linestyle": LINES[place % len(LINES)], "marker": mark, "markersize": 4.0}
        when.step(long * moments, counts, where="post", markevery=max(1, len(moments) // 8), **style)
    figure.legend(loc="outside lower center", ncols=len(causes), frameon=False, markerscale=2.0)
    when.set_xlabel(f"time [{second}]")
    when.set_ylabel("broken bonds")
    when.grid(color="#dddddd", linewidth=0.6)
    return figure


def animation(run: Run, path: str | Path, by: str = "velocity", view: str = "y", pause: float = 0.1) -> Path:
    """Writes the packing over all frames as an animated GIF, with the same colours in each."""
    import io

    from PIL import Image

    frames = run.frames
    if not frames:
        raise ResultError("animation: expected frames; [output] frame_interval writes them")
    clouds = [frame.particles for frame in frames]
    values = [_magnitude(cloud[by]) for cloud in clouds if len(cloud)]
    if not values:
        raise ResultError("animation: expected particles in the frames, found none")
    scale = _scale(np.concatenate(values))
    filled = [cloud for cloud in clouds if len(cloud)]
    limits = [
        (min(float((c.points[:, axis] - c["radius"]).min()) for c in filled),
         max(float((c.points[:, axis] + c["radius"]).max()) for c in filled))
        for axis in range(3)
    ]  # fmt: skip
    pictures = []
    for frame in frames:
        figure = packing(frame, by, view, scale)
        panel = figure.axes[0]
        panel.set_xlim(*limits[VIEWS[view][0]])
        panel.set_ylim(*limits[VIEWS[view][1]])
        memory = io.BytesIO()
        figure.savefig(memory, format="png", dpi=80)
        pictures.append(Image.open(memory).convert("P", palette=Image.Palette.ADAPTIVE))
    path = Path(path)
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=int(1000 * pause), loop=0)
    return path


def draw(source: str | Path, output: str | Path | None = None, *, by: str = "velocity", view: str = "y") -> list[Path]:
    """Draws all that a run or a record allows, into a folder; returns the files."""
    source = Path(source)
    is_run = source.is_dir()
    run = Run(source) if is_run else None
    table = run.history if run else read_table(source)
    folder = Path(output) if output else (source / "pictures" if is_run else source.with_suffix(""))
    made: list[Path] = []

    def keep(name: str, make: Any) -> None:
        try:
            figure = make()
        except ResultError:
            return  # the run has nothing of this kind
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / f"{name}.png", dpi=150)
        made.append(folder / f"{name}.png")

    keep("history", lambda: history(table))
    keep("energy", lambda: energy(table))
    if run:
        frames = run.frames
        if frames:
            several = {"set", "material"} & {
                name for name, values in frames[-1].particles.fields.items() if len(np.unique(values)) > 1
            }
            for field in dict.fromkeys([by, "force", *sorted(several, reverse=True)[:1]]):
                keep(f"packing_{field}", lambda field=field: packing(frames[-1], field, view))
            keep("force_chains", lambda: force_chains(frames[-1], view))
            for grid in frames[-1].grids:
                for name in frames[-1].grid(grid).fields:
                    if name != "count_by_set":
                        keep(f"{grid}_{name}", lambda grid=grid, name=name: section(frames[-1], grid, name, view))
        keep("cracks", lambda: cracks(run, view))
        if len(frames) > 1:
            folder.mkdir(parents=True, exist_ok=True)
            made.append(animation(run, folder / "animation.gif", by, view))
    if not made:
        raise ResultError(f"{source}: expected something that changes over time, found nothing to draw")
    return made


def main(words: Iterable[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m cograin.plot", description="Draws a run, or the record of a coupled run."
    )
    parser.add_argument("source", type=Path, metavar="OUT", help="folder of cograin run, or CSV file of a record")
    parser.add_argument("-o", "--output", type=Path, help="folder of the pictures; by default OUT/pictures")
    parser.add_argument("--by", default="velocity", help="what colours the particles (default: velocity)")
    parser.add_argument(
        "--view", default="y", choices=sorted(VIEWS), help="axis along which they are seen (default: y)"
    )
    options = parser.parse_args(None if words is None else list(words))
    try:
        for path in draw(options.source, options.output, by=options.by, view=options.view):
            print(path)
    except ModuleNotFoundError as error:
        print(error, file=sys.stderr)
        return 1
    except (ResultError, KeyError, OSError) as error:
        print(error.args[0] if isinstance(error, KeyError) else error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
