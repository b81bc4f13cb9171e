"""Pictures of a run in space: ``python -m cograin.view OUT``.

`scene` gives a plotter of pyvista, so that a script can change, turn and save it:

    from cograin.results import Run
    from cograin.view import scene
    scene(Run("out"), by="set", names={0: "glass", 1: "steel"}).screenshot("packing.png")

Needs the extra ``view``. Without a display pictures are drawn off screen; where that fails, Linux needs a software
renderer (Debian: libosmesa6 or libegl1 with libgl1).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from cograin.base.extras import needed
from cograin.plot.command import numbered
from cograin.plot.values import (
    FACET_FIELDS,
    FIELDS,
    are_kinds,
    colouring,
    contact_lines,
    ends,
    joined,
    magnitude,
    values,
)
from cograin.plot.values import scale as scale_of
from cograin.results import Cloud, Frame, ResultError, Run

#: Directions from which a picture may be seen.
DIRECTIONS = ("x", "y", "z", "isometric")
#: How a bar of colours looks; it leaves room for its last number.
BAR = {"color": "black", "fmt": "%.3g", "n_labels": 4, "position_x": 0.3, "width": 0.5, "height": 0.09}
#: Endings of films.
FILMS = (".gif", ".mp4")
#: Up to so many particles are drawn as fine spheres.
FINE = 2000


def scene(
    run: Run,
    frame: int = -1,
    *,
    by: str = "velocity",
    names: Mapping[int, str] | None = None,
    view: str = "isometric",
    chains: bool = False,
    facets: str | None = None,
    solid: Collection[str] = (),
    scale: tuple[float, float] | None = None,
) -> Any:
    """A frame of a run: particles, surfaces where they are now, bonds, and the edges of a cell.

    ``by`` is the field that colours the particles; ``names`` are those of its numbers, such as sets, where
    others are wanted than those of the scene. ``chains`` draws normal forces as tubes, the wider the larger, and
    particles as thin shells (needs ``[output] contacts``).
    ``facets`` is the field that colours the facets of boundaries, such as ``normal_pressure`` or ``wear_depth`` (needs
    ``[output] boundaries``). Boundaries named in ``solid`` hide what stands behind them; others are of glass.
    """
    frames = run.frames
    if not frames:
        raise ResultError(f"{run.folder}: expected frames; [output] frame_interval writes them")
    if not -len(frames) <= frame < len(frames):
        raise ResultError(f"frame: expected a number from 0 to {len(frames) - 1}, found {frame}")
    chosen = frames[frame]
    pyvista = needed("pyvista", "view")
    plotter = pyvista.Plotter(off_screen=True, window_size=(1200, 900))
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    plotter.enable_depth_peeling()  # glass before and behind glass
    particles = chosen.particles
    if len(particles):
        _particles(pyvista, plotter, chosen, particles, by, names, scale, chains)
    _surfaces(pyvista, plotter, chosen, facets, solid)
    if (bonds := chosen.bonds) is not None and len(bonds) and len(particles):
        _tubes(pyvista, plotter, bonds.points.reshape(-1, 2, 3), np.median(particles["radius"]) / 4.0, "#444444")
    if (cell := chosen.cell) is not None and len(cell):
        plotter.add_mesh(_lines(pyvista, cell.points.reshape(-1, 2, 3)), color="black", line_width=2)
    if chains:
        _chains(pyvista, plotter, chosen, particles)
    plotter.add_text(f"t = {chosen.time:.4g} s", font_size=10, color="black")
    _turned(plotter, view)
    return plotter


def _turned(plotter: Any, view: str) -> None:
    """Looks along an axis, or from a corner."""
    if view not in DIRECTIONS:
        raise ResultError(f"view: expected one of {', '.join(DIRECTIONS)}, found {view}")
    look = {"x": plotter.view_yz, "y": plotter.view_xz, "z": plotter.view_xy, "isometric": plotter.view_isometric}
    if view != "isometric":
        plotter.enable_parallel_projection()
    look[view]()


def _particles(
    pyvista: Any,
    plotter: Any,
    frame: Frame,
    particles: Cloud,
    by: str,
    names: Mapping[int, str] | None,
    scale: Any,
    thin: bool,
) -> None:
    """The particles as spheres, those of clumps, too, coloured by a field."""
    by = colouring(particles, by)
    kinds = are_kinds(particles, by)
    found = particles[by] if kinds else values(frame, particles, by)
    cloud = pyvista.PolyData(particles.points)
    cloud["radius"], cloud[by] = particles["radius"], found
    sides = 24 if len(particles) <= FINE else 10
    ball = pyvista.Sphere(radius=1.0, theta_resolution=sides, phi_resolution=sides)
    spheres = cloud.glyph(geom=ball, scale="radius", orient=False)
    style: dict[str, Any] = {"opacity": 0.12 if thin else 1.0, "smooth_shading": True, "show_scalar_bar": not thin}
    if kinds:
        each = np.unique(found)
        spheres[by] = np.searchsorted(each, spheres[by]).astype(float)
        names = names or frame.names(by)
        told = {float(place): names.get(int(kind), f"{by} {kind}") for place, kind in enumerate(each)}
        style.update(annotations=told, n_colors=len(each), clim=(-0.5, len(each) - 0.5))
        style["scalar_bar_args"] = {**BAR, "title": _title(by, "1"), "n_labels": 0}
    else:
        style.update(clim=scale or ends(particles, by, found, frame.time), cmap="viridis")
        style["scalar_bar_args"] = {"title": _title(by, FIELDS.get(by, "1")), **BAR}
    plotter.add_mesh(spheres, scalars=by, **style)


def _surfaces(pyvista: Any, plotter: Any, frame: Frame, by: str | None, solid: Collection[str]) -> None:
    """The boundaries where they are at this time: glass with dark edges, those of these names metal."""
    surfaces = frame.boundaries
    if surfaces is None or not len(surfaces):
        if by or solid:
            raise ResultError("surfaces: expected files of boundaries; [output] boundaries = true writes them")
        return
    faces = np.concatenate([np.concatenate([[len(cell)], cell]) for cell in surfaces.cells])
    mesh = pyvista.PolyData(surfaces.points, faces)
    if by:
        if by not in surfaces.cell_fields:
            raise ResultError(f"facets: expected one of {', '.join(surfaces.cell_fields)}, found {by}")
        mesh.cell_data[by] = magnitude(surfaces[by])
        bar = {"title": _title(by, FACET_FIELDS.get(by, "1")), "position_y": 0.9, **BAR}
        plotter.add_mesh(mesh, scalars=by, cmap="magma_r", opacity=0.5, scalar_bar_args=bar)
        return
    numbers = {name: number for number, name in frame.names("boundary").items()}
    if unknown := [name for name in solid if name not in numbers]:
        raise ResultError(f"solid: expected one of {', '.join(numbers) or 'a run that ended'}, found {unknown[0]}")
    metal = np.isin(surfaces["boundary"], [numbers[name] for name in solid])
    smooth = {"smooth_shading": True, "split_sharp_edges": True, "feature_angle": 40.0}
    looks = {"color": "#b4bcc4", "specular": 0.3, **smooth}, {"color": "#8899aa", "opacity": 0.15}
    for chosen, look in zip((metal, ~metal), looks, strict=True):
        if not chosen.any():
            continue
        part = mesh.extract_cells(chosen).extract_surface(algorithm=None).clean()
        plotter.add_mesh(part, **look)
        edges = part.extract_feature_edges(feature_angle=40.0, manifold_edges=False)
        if edges.n_points:
            plotter.add_mesh(edges, color="#333c44", line_width=1.5)


def _title(by: str, unit: str) -> str:
    """What a bar of colours says above itself; an empty line keeps it off the numbers."""
    return (by if unit == "1" else f"{by} [{unit}]") + "\n"


def _lines(pyvista: Any, lines: Any) -> Any:
    """Lines (n, 2, 3) as a mesh."""
    return pyvista.line_segments_from_points(lines.reshape(-1, 3)) if len(lines) else pyvista.PolyData()


def _tubes(pyvista: Any, plotter: Any, lines: Any, radius: float, colour: str) -> None:
    """Lines (n, 2, 3) as tubes of one radius \\[m\\]."""
    plotter.add_mesh(_lines(pyvista, lines).tube(radius=radius, n_sides=8), color=colour)


def _chains(pyvista: Any, plotter: Any, frame: Frame, particles: Cloud) -> None:
    """Normal forces as tubes, the wider the larger; through the faces of a cell to the images."""
    contacts = frame.contacts
    if contacts is None:
        raise ResultError("chains: expected files of contacts; [output] contacts = true writes them")
    if not len(contacts):
        return
    lines, force = joined(*contact_lines(frame, particles, contacts), contacts["normal_force"], frame.edges)
    largest = float(np.abs(force).max())
    if not largest:
        return
    mesh = _lines(pyvista, lines)
    share = np.repeat(np.sqrt(np.abs(force) / largest), 2)
    mesh.point_data["width"] = np.median(particles["radius"]) * np.maximum(0.25 * share, 1e-3)
    mesh.point_data["normal force [N]"] = np.repeat(force, 2)
    tubes = mesh.tube(scalars="width", absolute=True, n_sides=8)
    bar = {"title": _title("normal force", "N"), **BAR}
    plotter.add_mesh(tubes, scalars="normal force [N]", cmap="viridis_r", scalar_bar_args=bar)


def film(run: Run, path: str | Path, *, pause: float = 0.1, **named: Any) -> Path:
    """Writes all frames as a film, .gif or .mp4, with the same colours and from the same place.

    ``pause`` \\[s\\] is how long a frame stands. The extra ``film`` has what writes .mp4.
    """
    path = Path(path)
    if path.suffix == ".mp4":
        encoder, pictures = needed("imageio_ffmpeg", "film"), _pictures(run, named)
        first = next(pictures)
        # Sides are whole multiples of the last number, lest they are changed.
        stream = encoder.write_frames(str(path), first.shape[1::-1], fps=1.0 / pause, quality=8, macro_block_size=2)
        stream.send(None)
        for picture in (first, *pictures):
            stream.send(np.ascontiguousarray(picture))
        stream.close()
    else:
        image = needed("PIL.Image", "view")
        first, *others = map(image.fromarray, _pictures(run, named))
        first.save(path, save_all=True, append_images=others, duration=int(1000 * pause), loop=0)
    return path


def _pictures(run: Run, named: dict[str, Any]) -> Iterator[Any]:
    """Frame after frame as numbers of pixels, with the same colours and from the same place."""
    by = named.get("by", "velocity")
    frames = run.frames
    filled = [(frame, cloud) for frame in frames if len(cloud := frame.particles)]
    found = [values(frame, cloud, colouring(cloud, by)) for frame, cloud in filled]
    if found and named.get("scale") is None:
        named = {**named, "scale": scale_of(np.concatenate(found))}
    camera = None
    for number in range(max(len(frames), 1)):
        plotter = scene(run, number, **named)
        if camera is not None:
            plotter.camera_position = camera
        yield plotter.screenshot(None, return_img=True)
        camera = plotter.camera_position
        plotter.close()


def save(run: Run, path: str | Path, **named: Any) -> Path:
    """Writes a picture (.png), a page that one can turn in a browser (.html), or a film of all frames (.gif, .mp4)."""
    path = Path(path)
    if path.suffix not in (".png", ".html", *FILMS):
        raise ResultError(f"{path}: expected a name that ends with .png, .html, .gif or .mp4")
    if path.suffix in FILMS:
        named.pop("frame", None)
        return film(run, path, **named)
    plotter = scene(run, **named)
    if path.suffix == ".png":
        plotter.screenshot(path)
    else:
        for module in ("trame_pyvista", "nest_asyncio2"):
            needed(module, "view")
        plotter.trame.export_html(path)
    plotter.close()
    return path


def main(words: Iterable[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m cograin.view", description="Draws a frame of a run in space.")
    parser.add_argument("source", type=Path, metavar="OUT", help="folder of cograin run")
    parser.add_argument(
        "-o", "--output", type=Path, help=".png, .html, .gif or .mp4 (all frames); default OUT/view.png"
    )
    parser.add_argument("--by", default="velocity", help="what colours the particles (default: velocity)")
    parser.add_argument("--names", nargs="+", metavar="NAME", help="names of sets or materials, in their order")
    parser.add_argument("--frame", type=int, default=-1, help="number of the frame (default: the last)")
    parser.add_argument("--time", type=float, help="the frame that is nearest to this time [s], instead")
    parser.add_argument("--view", default="isometric", choices=DIRECTIONS, help="from where (default: isometric)")
    parser.add_argument("--chains", action="store_true", help="normal forces of contacts as tubes")
    parser.add_argument("--facets", metavar="FIELD", help="what colours the facets: normal_pressure, wear_depth, ...")
    parser.add_argument("--solid", nargs="+", default=(), metavar="NAME", help="boundaries of metal instead of glass")
    options = parser.parse_args(None if words is None else list(words))
    named = {name: getattr(options, name) for name in ("by", "frame", "view", "chains", "facets", "solid")}
    named["names"] = numbered(options.names)
    try:
        run = Run(options.source)
        if options.time is not None:
            named["frame"] = [frame.number for frame in run.frames].index(run.frame_at(options.time).number)
        print(save(run, options.output or options.source / "view.png", **named))
    except ModuleNotFoundError as error:
        print(error, file=sys.stderr)
        return 1
    except (ResultError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
