"""Cells of grains as integration points: strains of the plane in, stresses and their tangent out."""

import numpy as np

from cograin import Unit

STRAINS = [f"cell.strain.{name}" for name in ("xx", "zz", "xz")]
STRESSES = [f"cell.stress.{name}" for name in ("xx", "zz", "xz")]


class Cell:
    """A unit whose strains in the plane are driven. Strains here are those since it was opened."""

    def __init__(self, path, *, move=1e-3, hold=5e-4, tolerance=1e-3, most=20):
        """A strain is made in `move` [s]; then the cell is held for `hold` [s] at a time until its unbalanced force is
        `tolerance` of the mean contact force, `most` times at the most."""
        self.unit = Unit(path)
        self.move, self.hold, self.tolerance, self.most = move, hold, tolerance, most
        self.first = self.unit.get(STRAINS)
        self.kept = self.unit.save()
        self.restless = 0

    def respond(self, strain):
        """Stress [Pa] after the grains, as they were when last kept, took this strain and came to rest."""
        self.unit.restore(self.kept)
        self.unit.set(STRAINS, self.first + strain)
        self.unit.step(self.move)
        for _ in range(self.most):
            if self.unit.number("cell.unbalanced_force") <= self.tolerance:
                break
            self.unit.step(self.hold)
        else:
            self.restless += 1
        return self.unit.get(STRESSES)

    def tangent(self, strain, by=5e-4):
        """Stress at a strain, and its derivatives by the strains: differences of cells that have come to rest."""
        columns = [self.respond(strain + by * one) for one in np.eye(3)]
        stress = self.respond(strain)
        return stress, np.stack([(column - stress) / by for column in columns], axis=1)

    def keep(self):
        """Goes on from where the last response ended."""
        self.unit.save(self.kept)

    def close(self):
        self.unit.close()
