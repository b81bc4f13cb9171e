"""What a run leaves, as arrays: `Run` reads the folder of ``cograin run``, `read_frame` one frame.

>>> from cograin.results import unit_of
>>> unit_of("lid.mean_force.z"), unit_of("energy.lost.sliding"), unit_of("contacts.count")
('N', 'J', '1')
"""

from cograin.results.errors import ResultError
from cograin.results.frames import Cloud, Frame, frames_in, read_frame
from cograin.results.images import Image, read_image
from cograin.results.run import Run
from cograin.results.table import Table, joined, read_table
from cograin.results.units import unit_of

__all__ = [
    "Cloud",
    "Frame",
    "Image",
    "ResultError",
    "Run",
    "Table",
    "frames_in",
    "joined",
    "read_frame",
    "read_image",
    "read_table",
    "unit_of",
]
