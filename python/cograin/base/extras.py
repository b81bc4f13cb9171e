"""Packages that only a part of this one needs: installed with an extra."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def needed(module: str, extra: str) -> Any:
    """Imports a module; where it is missing, the message says what installs it."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{module}.".startswith(f"{error.name}."):
            raise
        said = f"{error.name}: not found; install cograin[{extra}]"
        raise ModuleNotFoundError(said, name=error.name) from None
