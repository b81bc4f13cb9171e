"""What cannot be read."""

from __future__ import annotations


class ResultError(Exception):
    """A file that cannot be read, and why."""


def reason(error: Exception) -> str:
    """Why a file could not be read, without its name."""
    return (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
