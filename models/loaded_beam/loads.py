"""What loads the beam: the packing and the jack."""

import gzip
import math
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
GRAVITY = 9.81  # [m/s²], as in scene.toml


def particles():
    """The packing: rows of x, y, z, radius, density."""
    with gzip.open(HERE / "dense_20k.csv.gz", "rt") as text:
        return np.loadtxt(text, delimiter=",", skiprows=1, usecols=(1, 2, 3, 4, 5))


def weight_of(packing):
    """Weight of a packing [N]."""
    return float(np.sum(4.0 / 3.0 * np.pi * packing[:, 3] ** 3 * packing[:, 4])) * GRAVITY


def jack_force(load, now, lowering):
    """Force of the jack on the plate [N]: all the load at first, none once it is down."""
    return 0.5 * load * (1.0 + math.cos(math.pi * min(now / lowering, 1.0)))
