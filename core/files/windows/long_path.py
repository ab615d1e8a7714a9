r"""Paths as Windows takes them beyond 260 characters: ``\\?\C:\folder\file``."""

from __future__ import annotations

import os
from pathlib import Path

EXTENDED = "\\\\?\\"
DEVICES = "\\\\.\\"
NETWORK = "\\\\"
LONGEST_PLAIN = 200
"""Characters; folders may have 247, and beside a file its unfinished ones have longer names."""


def reaching(path: Path) -> Path:
    """The path in a form that opens also where it is long; elsewhere than on Windows as it is.

    Apply it where a file is opened, not before: messages name the path that was given.
    """
    return Path(extended(os.path.abspath(path))) if os.name == "nt" else path  # noqa: PTH100 - no link is to be followed


def extended(absolute: str) -> str:
    """An absolute path of Windows in the form that has no limit, if it is long."""
    if len(absolute) <= LONGEST_PLAIN or absolute.startswith((EXTENDED, DEVICES)):
        return absolute
    if absolute.startswith(NETWORK):
        return f"{EXTENDED}UNC\\{absolute.removeprefix(NETWORK)}"
    return EXTENDED + absolute
