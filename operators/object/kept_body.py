"""Cache of the body pressed last, valid while its file is unchanged.

Tools need seconds to prepare on a body; the next press on it reuses that.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import bpy

from ...core.body.soft_body import SoftBody
from ..scene import drawn_surface
from . import body_store, hung_map

# The body, its file, and the file's state when read.
_kept: tuple[tuple[object, ...], SoftBody] | None = None
# A body without a file: a preview.
_unsaved: SoftBody | None = None


def load(thing: bpy.types.Object) -> SoftBody:
    """Load as :func:`body_store.load`, but the same body while its file is unchanged.

    Raises
    ------
    PalpateError
        As there.
    """
    if _unsaved is not None and is_unsaved(thing):
        return _unsaved
    if _kept is not None and _kept[0] == _stamp(thing):
        return _kept[1]
    body = body_store.load(thing)
    keep(thing, body)
    return body


def keep(thing: bpy.types.Object, body: SoftBody) -> None:
    """Keep the body that was just read from an object's file, or written there."""
    global _kept  # noqa: PLW0603  one cached body
    stamp = _stamp(thing)
    _kept = None if stamp is None else (stamp, body)


def let_go() -> None:
    """Keep no body: a mapped table keeps its file open, which some systems then cannot replace."""
    global _kept  # noqa: PLW0603  see keep
    _kept = None
    of_law.cache_clear()


def keep_unsaved(body: SoftBody) -> None:
    """Keep a body that has no file until it is dropped."""
    global _unsaved  # noqa: PLW0603  one preview
    _unsaved = body


def drop_unsaved() -> None:
    """Drop it. Safe to repeat."""
    global _unsaved  # noqa: PLW0603  see keep_unsaved
    _unsaved = None


def is_unsaved(thing: bpy.types.Object) -> bool:
    """Whether the object's body is the one without a file."""
    return _unsaved is not None and _unsaved.key == thing.palpate.body_key


def forget() -> None:
    """Free the memory."""
    let_go()
    drop_unsaved()
    hung_map.forget()
    drawn_surface.forget()


def _stamp(thing: bpy.types.Object) -> tuple[object, ...] | None:
    """What changes with an object's body file; None without one."""
    path = body_store.locate(thing)
    if path is None:
        return None
    about = path.stat()
    return (path, thing.palpate.body_key, about.st_mtime_ns, about.st_size, about.st_ino)


# What is prepared for a body is kept with it: the next press on the object finds the same one.
@lru_cache(maxsize=2)
def of_law(body: SoftBody, law: str) -> SoftBody:
    """The body with this law; the same one each time."""
    return body if body.law == law else replace(body, law=law)
