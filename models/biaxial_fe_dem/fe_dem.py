"""A biaxial test: a block of sand in plane strain, whose integration points take their stress from cells of grains.

The lid goes down step by step. In each step the cells start from where they came to rest before, take the strains of
the block and come to rest again, until the forces on the nodes balance (Newton; the tangents are differences of cells
at rest).
"""

import argparse
import csv
import os
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from cells import Cell
from picture import draw
from solid import Block

from cograin import Program, Unit

HERE = Path(__file__).resolve().parent
PRESSURE = 1e5  # [Pa], as cell.toml has it
CONSOLIDATION = "pair.sand.sand.friction=0.2"  # what makes the sand dense
PLANE = 'cell.motion={driven=["xx","zz","xz"]}'
FIRM = 0.05  # least stiffness of a tangent over the largest of the sand at first
SINGLE = 'cell.motion={driven=["zz"],servo={xx={stress=-1e5,max_rate=5.0}}}'


def units(program, folder):
    """The sand under pressure, as a cell that follows strains, and as one whose side keeps its pressure by itself."""
    scene, sand = HERE / "cell.toml", folder / "sand.checkpoint"
    print(program("settle", scene, "--set", CONSOLIDATION, "-o", sand, "--overwrite"), end="")
    for name, motion in (("point", PLANE), ("single", SINGLE)):
        program("export", scene, "--from", sand, "--set", motion, "-o", folder / f"{name}.fmu", "--overwrite")
    return folder / "point.fmu", folder / "single.fmu"


def firm(tangents, least):
    """Tangents whose symmetric part has no eigenvalue below this [Pa].

    What softens is taken for stiffer than it is: Newton's steps are too short then, and do not run away.
    """
    even = 0.5 * (tangents + np.moveaxis(tangents, 1, 2))
    values, vectors = np.linalg.eigh(even)
    raised = (vectors * (values.clip(min=least) - values)[:, None, :]) @ np.moveaxis(vectors, 1, 2)
    return tangents + raised


class Test:
    """A block, its cells, and how far they have come."""

    def __init__(self, block, path, threads, *, tolerance=1e-2, most=10):
        self.block, self.tolerance, self.most = block, tolerance, most
        self.cells = [Cell(path) for _ in range(block.points)]
        self.pool = ThreadPoolExecutor(threads)
        self.displacement = block.basis.zeros()
        self.before = np.zeros_like(self.displacement)
        self.responses = 0
        self.stiffest = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.pool.shutdown()
        for cell in self.cells:
            cell.close()

    def _all(self, what, strains, cost):
        self.responses += cost * len(self.cells)
        return list(self.pool.map(lambda pair: what(*pair), zip(self.cells, strains, strict=True)))

    def stresses(self, displacement):
        return np.array(self._all(Cell.respond, self.block.strains(displacement), 1))

    def stresses_and_tangents(self, displacement):
        found = self._all(Cell.tangent, self.block.strains(displacement), 4)
        stresses, tangents = np.array([stress for stress, _ in found]), np.array([tangent for _, tangent in found])
        if self.stiffest is None:
            self.stiffest = np.linalg.eigvalsh(0.5 * (tangents + np.moveaxis(tangents, 1, 2))).max()
        return stresses, firm(tangents, FIRM * self.stiffest)

    def step(self, down):
        """Lowers the lid by `down` [m]. Returns what presses on it [N/m], iterations, and the rest out of balance."""
        block = self.block
        displacement = self.displacement + self.before
        displacement[block.lid] = self.displacement[block.lid] - down
        stresses, tangents = self.stresses_and_tangents(displacement)
        forces = block.forces(displacement, stresses)
        rest, iteration = block.rest(forces), 0
        while rest > self.tolerance and iteration < self.most:
            iteration += 1
            change = block.solve(displacement, stresses, tangents, forces)
            # A step that makes it worse is halved.
            for part in (1.0, 0.5, 0.25):
                there = displacement + part * change
                stresses = self.stresses(there)
                forces = block.forces(there, stresses)
                last, rest = rest, block.rest(forces)
                if rest < last:
                    break
                rest = last if part > 0.25 else rest
            displacement = there
            if rest > self.tolerance and rest > 0.3 * last:
                stresses, tangents = self.stresses_and_tangents(displacement)
        for cell in self.cells:
            cell.keep()
        self.before, self.displacement = displacement - self.displacement, displacement
        return -forces[block.lid].sum(), iteration, rest


def single(path, strains, move=1e-3):
    """Stress [Pa] of one cell that is compressed by itself, its side under pressure."""
    found = []
    with Unit(path) as unit:
        first = unit.number("cell.strain.zz")
        for strain in strains:
            unit["cell.strain.zz"] = first + strain
            unit.step(move)
            for _ in range(100):
                if (
                    unit.number("cell.unbalanced_force") <= 1e-3
                    and abs(unit.number("cell.stress.xx") / PRESSURE + 1) < 1e-3
                ):
                    break
                unit.step(move / 2)
            found.append(unit.number("cell.stress.zz"))
    return np.array(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/biaxial_fe_dem"), help="folder of all results")
    parser.add_argument("--elements", type=int, nargs=2, default=(2, 4), help="elements across and up")
    parser.add_argument("--strain", type=float, default=0.12, help="how far the lid goes, over the height")
    parser.add_argument("--steps", type=int, default=60, help="steps of the lid")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="cells at a time")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    point, alone = units(Program(options.program), options.output)
    levels = np.log(1 - np.arange(1, options.steps + 1) * options.strain / options.steps)
    begin = time.perf_counter()
    reference = single(alone, levels)
    print(
        f"single cell: {time.perf_counter() - begin:.1f} s, peak {-reference.min() / PRESSURE:.2f} times the pressure"
    )
    block = Block(1.0, 2.0, options.elements, PRESSURE, rough=options.elements != [1, 1])
    table = []
    with Test(block, point, options.threads) as test, open(options.output / "biaxial.csv", "w", newline="") as text:
        print(f"{block.points} cells")
        file = csv.writer(text)
        file.writerow(["strain", "stress", "single_cell", "iterations", "rest", "responses", "seconds"])
        for index, level in enumerate(reference):
            force, iterations, rest = test.step(2.0 * options.strain / options.steps)
            strain = (index + 1) * options.strain / options.steps
            seconds = time.perf_counter() - begin
            table.append([strain, force, -level, iterations, rest, test.responses, seconds])
            file.writerow(table[-1])
            text.flush()
            print(*(f"{value:.4g}" for value in table[-1]), flush=True)
            if index % 10 == 9 or index + 1 == options.steps:
                draw(options.output / "biaxial.png", block, test.displacement, table, PRESSURE)
        print(f"{sum(cell.restless for cell in test.cells)} of {test.responses} responses did not come to rest")


if __name__ == "__main__":
    main()
