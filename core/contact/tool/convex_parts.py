"""Convex parts of a mesh that is hollow, such as a bowl or a table.

What hangs together by vertices is a part; a convex one is taken as it is. Others are taken apart by
CoACD (Wei, Liu, Ling, Su, *Approximate Convex Decomposition for 3D Meshes with Collision-Aware
Concavity and Tree Search*, 2022), whose parts follow from the mesh and a seed alone. It ends its
process at meshes it cannot read and may search without end, hence a child with a time limit.
"""

from __future__ import annotations

import importlib.util
import io
import json
import subprocess
import sys
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ...errors import PalpateError
from ...machine import c_runtime, run_module
from ...machine.ends_with_parent import end_with_this_process
from ...mesh.surface import Surface
from ...mesh.tet_mesh import pieces
from .convex_tool import convex
from .decomposition_child import NOT_LOADED
from .tools import Tool, span

Array = NDArray[np.float64]

# Of one mesh at most: sixteen supports are solved together.
MOST_PARTS = 12
# Share by which a convex part's hull may exceed its volume.
HOLLOW = 0.01
# Seconds that CoACD may take.
LONGEST = 60.0
# Meshes whose parts are kept, so that an animation takes each apart once.
MOST_KEPT = 16


def convex_parts(
    vertices: Array,
    triangles: NDArray[np.int64],
    name: str,
    python: Sequence[str] = (sys.executable,),
) -> list[Tool]:
    """Convex tools that fill a mesh of ``vertices`` (v, 3), metres, and ``triangles`` (f, 3).

    Raises
    ------
    PalpateError
        A part is open or flat, there are too many, or it cannot be taken apart, with the remedy.
    """
    surface = Surface(np.asarray(vertices, dtype=np.float64), np.asarray(triangles)).welded()
    corners: list[Array] = []
    hollow: list[Surface] = []
    for part in _loose(surface):
        if not part.is_closed or span(part.vertices)[0] < 3:
            raise PalpateError(
                "colliders: {name} is hollow, and a part of it has open edges or no thickness; "
                "close its holes, or give its sheets thickness (Solidify)",
                name=name,
            )
        if ConvexHull(part.vertices).volume <= (1.0 + HOLLOW) * abs(part.signed_volume):
            corners.append(part.vertices)
        else:
            hollow.append(part)
    if len(corners) + len(hollow) > MOST_PARTS:
        raise PalpateError(
            "colliders: {name} has {count} loose parts, and at most {most} bear a body; take away "
            "what nothing touches, or join parts that are convex together",
            name=name,
            count=len(corners) + len(hollow),
            most=MOST_PARTS,
        )
    for number, part in enumerate(hollow):
        most = (MOST_PARTS - len(corners)) // (len(hollow) - number)
        found = _taken_apart(
            part.vertices.tobytes(), part.triangles.tobytes(), most, name, tuple(python)
        )
        corners.extend(found)
    return [convex(one, name=name) for one in corners]


def forget() -> None:
    """Free the memory."""
    _taken_apart.cache_clear()


def _loose(surface: Surface) -> list[Surface]:
    """Parts that share no vertex, in the order of their first triangles."""
    number = pieces(surface.triangles, len(surface.vertices))[surface.triangles[:, 0]]
    found = []
    for piece in np.unique(number):
        used, corners = np.unique(surface.triangles[number == piece], return_inverse=True)
        found.append(Surface(surface.vertices[used], corners.reshape(-1, 3).astype(np.int64)))
    return found


@lru_cache(maxsize=MOST_KEPT)
def _taken_apart(
    vertices: bytes, triangles: bytes, most: int, name: str, python: tuple[str, ...]
) -> tuple[Array, ...]:
    """Corners (k, 3) of each part of a closed mesh, metres; arrays come as bytes, to be kept by."""
    if importlib.util.find_spec("coacd") is None:
        raise PalpateError(
            "colliders: {name} is hollow, and CoACD, which takes such apart, is not built for this "
            "system; put convex parts of it into the collection, such as the boards of a box",
            name=name,
        )
    places = np.frombuffer(vertices).reshape(-1, 3)
    middle, size = 0.5 * (places.min(axis=0) + places.max(axis=0)), float(np.ptp(places))
    request = io.BytesIO()
    request.write(json.dumps({"path": sys.path, "most": most, "seconds": LONGEST}).encode() + b"\n")
    np.save(request, (places - middle) / size)
    np.save(request, np.frombuffer(triangles, dtype=np.int64).reshape(-1, 3).astype(np.int32))
    answer = io.BytesIO(_answer(request.getvalue(), name, python))
    counts, found = np.load(answer), np.load(answer)
    return tuple(np.split(middle + size * found, np.cumsum(counts)[:-1]))


def _answer(request: bytes, name: str, python: tuple[str, ...]) -> bytes:
    command = [*python, *run_module.command("core.contact.tool.decomposition_child")]
    try:
        child = subprocess.Popen(  # noqa: S603  our own script, by path
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=c_runtime.for_a_child(),
            creationflags=c_runtime.NO_WINDOW,
        )
    except OSError as problem:
        raise PalpateError(
            "colliders: {program} cannot be started ({problem}); reinstall Blender or Python",
            program=command[0],
            problem=problem,
        ) from problem
    end_with_this_process(child)
    with child:
        try:
            answer = child.communicate(request, timeout=LONGEST)[0]
        except subprocess.TimeoutExpired:
            answer = b""
        finally:
            child.kill()
    if child.returncode == NOT_LOADED:
        raise PalpateError(
            "colliders: {name} is hollow, and CoACD, which takes such apart, cannot be loaded; "
            "reinstall Palpate, or put convex parts of it into the collection",
            name=name,
        )
    if child.returncode or not answer:
        raise PalpateError(
            "colliders: {name} cannot be taken apart into convex ones; simplify it (Decimate, or a "
            "voxel Remesh where faces cross), or put convex parts of it into the collection",
            name=name,
        )
    return answer
