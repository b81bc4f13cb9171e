"""The picture of the test: stress over strain beside the single cell, and the deformed block with its shear strain."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

BLOCK, CELL = "#b5482a", "#1b6ca8"


def draw(path, block, displacement, rows, pressure):
    """Writes the picture as PNG, from a block, its displacement, and rows of (strain, stress, that of one cell, ..)."""
    figure, (course, shape) = plt.subplots(1, 2, figsize=(10, 5.5), width_ratios=[1.3, 1], layout="constrained")
    strain, stress, single = np.array(rows)[:, :3].T
    course.plot(100 * strain, stress / pressure, color=BLOCK, label="block between rough plates")
    course.plot(100 * strain, single / pressure, color=CELL, linestyle="--", label="one cell by itself")
    course.set(xlabel="axial strain [%]", ylabel="axial stress over side pressure [1]", ylim=(0, None))
    course.legend(frameon=False)
    xx, zz, xz = block.strains(displacement).T
    shear = np.hypot(xx - zz, xz).reshape(block.basis.dx.shape)
    # Each quarter of an element has the value of its integration point.
    places, values = [], []
    for element in range(shear.shape[0]):
        nodes = block.mesh.p[:, block.mesh.t[:, element]]
        low, high = nodes.min(axis=1), nodes.max(axis=1)
        middle = 0.5 * (low + high)
        where = block.basis.global_coordinates().value[:, element]
        for point in range(shear.shape[1]):
            side = where[:, point] > middle
            a, b = np.where(side, middle, low), np.where(side, high, middle)
            corners = np.array([[a[0], b[0], b[0], a[0]], [a[1], a[1], b[1], b[1]]])
            places.append((corners + _moved(block, displacement, corners)).T)
            values.append(100 * shear[element, point])
    patches = PolyCollection(places, array=np.array(values), cmap="cividis", edgecolor="0.4", linewidth=0.3)
    shape.add_collection(patches)
    shape.autoscale_view()
    shape.set(aspect="equal", xlabel="x [m]", ylabel="z [m]")
    figure.colorbar(patches, ax=shape, label="shear strain [%]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _moved(block, displacement, places):
    """Displacements at places of the block, shape (2, places)."""
    inside = places.clip(1e-9, np.array([[block.width], [block.height]]) - 1e-9)
    return (block.basis.probes(inside) @ displacement).reshape(2, -1)
