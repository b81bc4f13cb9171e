"""Files from which a coupled run goes on: numbers, texts, arrays, and lists, tuples and mappings of them."""

from __future__ import annotations

import json
import os
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

#: What stands in the first place of a file; the number changes with the order of what follows.
FORMAT = "cograin coupled run 2"


def write(path: Path, value: Any) -> None:
    """Writes a value, in place of an earlier file, whole or not at all."""
    arrays: dict[str, Any] = {}
    text = json.dumps([FORMAT, _packed(value, arrays)])
    handle, part = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, text=np.frombuffer(text.encode(), dtype=np.uint8), **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except BaseException:
        Path(part).unlink(missing_ok=True)
        raise


def read(path: Path) -> Any:
    """The value that a file holds."""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            form, value = json.loads(bytes(arrays["text"]).decode())
            if form != FORMAT:
                raise ValueError
            return _unpacked(value, arrays)
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, RuntimeError, zipfile.BadZipFile):
        raise ValueError(f"{path}: expected a checkpoint of a coupled run, found another or a damaged file") from None


def _packed(value: Any, arrays: dict[str, Any]) -> Any:
    """A value as JSON has it; arrays are put aside."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list):
        return [_packed(each, arrays) for each in value]
    if isinstance(value, tuple):
        return {"tuple": [_packed(each, arrays) for each in value]}
    if isinstance(value, dict):
        return {"map": [[_packed(key, arrays), _packed(each, arrays)] for key, each in value.items()]}
    kind = "bytes" if isinstance(value, bytes) else "array"
    if kind == "array" and not (isinstance(value, np.ndarray) and value.dtype.kind in "biuf"):
        expected = "numbers, texts, arrays, and lists, tuples and mappings of them"
        raise ValueError(f"checkpoint: expected {expected} as what memory() gives, found {type(value).__name__}")
    name = f"a{len(arrays)}"
    arrays[name] = np.frombuffer(value, dtype=np.uint8) if kind == "bytes" else value
    return {kind: name}


def _unpacked(value: Any, arrays: Any) -> Any:
    """The value that was packed."""
    if isinstance(value, list):
        return [_unpacked(each, arrays) for each in value]
    if not isinstance(value, dict):
        return value
    ((kind, inner),) = value.items()
    if kind == "tuple":
        return tuple(_unpacked(each, arrays) for each in inner)
    if kind == "map":
        return {_unpacked(key, arrays): _unpacked(each, arrays) for key, each in inner}
    found = arrays[inner]
    return found.tobytes() if kind == "bytes" else found
