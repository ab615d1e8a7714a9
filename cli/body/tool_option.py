"""``--tool``: a rigid tool by a few words, such as ``sphere:0.008``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ...core.contact.tool.convex_tool import convex
from ...core.contact.tool.tools import Tool, plate, rod, sphere
from ...core.errors import PalpateError
from ...core.mesh.read_mesh import read_surface

KINDS = "sphere:RADIUS, rod:RADIUS:LENGTH, plate:WIDTH:DEPTH or convex:MESH"

# Before the file of a convex mesh.
HULL = "convex:"

_SOLIDS: dict[str, tuple[int, Callable[..., Tool]]] = {
    "sphere": (1, sphere),
    "rod": (2, rod),
    "plate": (2, plate),
}


def tool_from(words: str) -> Tool:
    """Tool from text; lengths in metres, a mesh's as in its file.

    Raises
    ------
    PalpateError
        An unknown kind, numbers that are missing or make no tool, a mesh that cannot be read.
    """
    kind, _, rest = words.partition(":")
    if kind == "convex" and rest:
        return convex(read_surface(Path(rest)).vertices, name=words)
    count, make = _SOLIDS.get(kind, (0, sphere))
    try:
        lengths = [float(word) for word in rest.split(":")]
    except ValueError:
        lengths = []
    if not count or len(lengths) != count:
        raise PalpateError(f"--tool: '{words}' is no tool; give {KINDS}, lengths in metres")
    return make(*lengths, name=words)
