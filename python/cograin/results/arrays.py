"""Numbers in the files of frames."""

from __future__ import annotations

import base64
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

#: Types of numbers as VTK calls them.
TYPES = {"Float64": "f8", "Int64": "i8", "UInt64": "u8", "UInt8": "u1", "Float32": "f4", "Int32": "i4"}


def array_of(element: ElementTree.Element) -> NDArray[Any]:
    """The numbers of a DataArray: their count in bytes, then they themselves, in base 64."""
    text = (element.text or "").strip()
    data = base64.b64decode(text) if text else b""
    values = np.frombuffer(data[8:], dtype="<" + TYPES[element.get("type", "Float64")]).copy()
    components = int(element.get("NumberOfComponents", "1"))
    return values.reshape(-1, components) if components > 1 else values
