"""Water seeps beneath a sheet wall and rises in front of it until it lifts the ground: when, beside Terzaghi."""

import argparse
import shutil
from pathlib import Path

import numpy as np
from cograin import Coupling, Program, QuasiNewton, Unit
from cograin.fluid import FluidInterface
from cograin.plane_flow import PlaneFlow
from cograin.results import Table
from scipy.sparse import diags_array, kron
from scipy.sparse.linalg import spsolve

HERE = Path(__file__).resolve().parent
DENSITY, SOLID, GRAVITY = 1000.0, 2500.0, 9.81
TIP = 9e-3  # height of the tip of the wall [m]
WIDTH = 6e-3  # of Terzaghi's prism of ground in front of the wall, half of its depth [m]
LIFTED = [0.05e-3, 0.1e-3, 0.2e-3]  # rises of the prism whose gradients are told [m]


class Ground:
    """The ground in the cells of the water, column by column: (x, z)."""

    def __init__(self, side, plane):
        self.plane, self.shape, self.tip = plane, plane.cells, TIP
        centres, self.volume = side.cells.centres, side.cells.volumes[0]
        self.x, self.z = (np.unique(np.round(centres[:, axis], 12)) for axis in (0, 2))
        self.cell = self.z[1] - self.z[0]
        self.porosity = self.of(side.cells["porosity"])
        # Where the ground ends, were it as dense up to its surface as in the middle.
        solid = (1.0 - self.porosity).sum(axis=1)
        inside = (1.0 - self.porosity[:, 1:5]).mean()
        self.surface = float(solid.mean() / inside) * self.cell
        prism = self.x < WIDTH
        self.inside = float(self.porosity[prism][:, (self.z > TIP) & (self.z < self.surface - self.cell)].mean())
        self.before = self._height(self.porosity)

    def of(self, values):
        """Numbers of the cells by columns: along x first in the unit."""
        return np.asarray(values).reshape(self.shape[1], self.shape[0]).T

    def _height(self, porosity):
        """Mean height of the grains in the prism above the tip of the wall [m]."""
        solid = 1.0 - porosity[np.ix_(self.x < WIDTH, self.z > TIP)]
        return float(solid.sum(axis=0) @ self.z[self.z > TIP] / solid.sum())

    def heads(self):
        """Head above that of the water at rest at the corners of the cells [m], and where they are."""
        corners, pressure = self.plane.pressure
        excess = (pressure + DENSITY * GRAVITY * corners[:, 1]) / (DENSITY * GRAVITY)
        lines = [np.unique(np.round(corners[:, axis], 12)) for axis in range(2)]
        found = np.empty([len(line) for line in lines])
        places = [np.searchsorted(line, corners[:, axis] - 1e-9) for axis, line in enumerate(lines)]
        found[places[0], places[1]] = excess
        return lines, found

    def row(self, porosity):
        """Mean gradient of the prism, and how far it has risen [m]."""
        (x, z), heads = self.heads()
        base = np.interp(np.linspace(0.0, WIDTH, 101), x, heads[:, np.argmin(abs(z - TIP))]).mean()
        return base / (self.surface - TIP), self._height(self.of(porosity)) - self.before


def course(unit, interval, end, rate):
    """The head grows by so much in time [m/s] from 0 on: the ground; table, heads and porosities step by step."""
    side = FluidInterface(unit, "water", "xz")
    # Half of the head is lost on the way down behind the wall: the plane below its tip is one of symmetry.
    half = {"x_low": lambda time: 0.5 * rate * time * DENSITY * GRAVITY}
    smooth = {"x_low": {(TIP, np.inf): (0.0, None)}, "x_high": (0.0, None), "z_low": (None, 0.0)}
    plane = PlaneFlow(side, velocity=smooth, pressure=half)
    ground, rows, heads, porosities = Ground(side, plane), [], [], []
    coupling = Coupling(side, plane, QuasiNewton(), interval)
    for row in coupling.steps(end):
        porosity = side.cells["porosity"]
        rows.append([row.time, rate * row.time, *ground.row(porosity), unit["floor.force.z"]])
        porosities.append(ground.of(porosity))
        heads.append(ground.heads()[1])
    print(coupling.record.summary)
    names = ["time", "head", "gradient", "rise", "floor.force.z"]
    units = dict(zip(names, ["s", "m", "1", "m", "N"], strict=True))
    return ground, (Table(dict(zip(names, np.array(rows).T, strict=True)), units), heads, porosities)


def critical(porosity):
    """Gradient that carries the grains: Terzaghi's."""
    return (1.0 - porosity) * (SOLID / DENSITY - 1.0)


def even(width, surface, points=81):
    """Mean head below the prism over the whole head, in ground of one permeability (Laplace, finite differences)."""
    # The tip of the wall is a node.
    z = np.r_[np.linspace(0.0, TIP, points), np.linspace(TIP, surface, points)[1:]]
    lines, stiff, weights = [np.linspace(0.0, width, 2 * points - 1), z], [], []
    for line in lines:
        steps = np.diff(line)
        stiff.append(diags_array([-1.0 / steps, spread(1.0 / steps), -1.0 / steps], offsets=[-1, 0, 1]))
        weights.append(diags_array(0.5 * spread(steps)))
    matrix = (kron(stiff[0], weights[1]) + kron(weights[0], stiff[1])).tocsr()
    x, z = (each.ravel() for each in np.meshgrid(*lines, indexing="ij"))
    # At the surface 0, below the tip of the wall a half.
    heads = np.where((x == 0.0) & (z <= TIP), 0.5, 0.0)
    free = (z < surface) & ~((x == 0.0) & (z <= TIP))
    heads[free] = spsolve(matrix[free][:, free], -(matrix @ heads)[free])
    level = heads.reshape(2 * points - 1, -1)[:, points - 1]
    return float(np.interp(np.linspace(0.0, WIDTH, 101), lines[0], level).mean())


def spread(between):
    """Numbers between nodes, summed at the nodes."""
    return np.r_[between, 0.0] + np.r_[0.0, between]


def report(table, ground):
    """Prints where the ground was lifted, beside the closed forms."""
    depth, expected = ground.surface - TIP, critical(ground.inside)
    print(f"ground {1e3 * ground.surface:.2f} mm high, wall {1e3 * depth:.2f} mm deep", end=", ")
    print(f"porosity of the prism {ground.inside:.4f}: critical gradient {expected:.3f}")
    early = (table["head"] > 0.3 * depth) & (table["head"] < depth)
    if early.any():
        ratio = (table["gradient"] * depth / table["head"])[early]
        print(f"head below the prism over all: {ratio.mean():.3f} ± {ratio.std():.3f} while nothing moves", end=", ")
        print(f"{even(ground.x[-1] + 0.5 * ground.cell, ground.surface):.3f} in even ground")
    for rise in LIFTED:
        if table["rise"].max() > rise:
            place = int(np.argmax(table["rise"] > rise))
            print(f"risen by {1e3 * rise:g} mm at a head of {1e3 * table['head'][place]:.1f} mm", end=", ")
            print(f"gradient {table['gradient'][place]:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/seepage"))
    parser.add_argument("--end", type=float, default=0.152, help="[s]")
    parser.add_argument("--interval", type=float, default=4e-3, help="communication step [s]")
    parser.add_argument("--rate", type=float, default=0.3, help="growth of the head [m/s]")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    program, settled = Program(options.program), options.output / "settled.checkpoint"
    print(program.settle(HERE / "scene.toml", settled).strip().splitlines()[-1])
    path = program.export(HERE / "scene.toml", options.output / "seepage.fmu", start=settled)
    frames = {}
    if not options.no_picture:
        shutil.rmtree(options.output / "frames", ignore_errors=True)
        frames = {"parameters": {"run.frames": str(options.output / "frames")}}
    with Unit(path, **frames) as unit:
        ground, found = course(unit, options.interval, options.end, options.rate)
    table = found[0]
    rows = np.array([table[name] for name in table]).T
    np.savetxt(options.output / "couple.csv", rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    report(table, ground)
    if not options.no_picture:
        from picture import draw

        draw(options.output / "seepage.png", options.output / "frames", found, ground, critical(ground.inside))


if __name__ == "__main__":
    main()
