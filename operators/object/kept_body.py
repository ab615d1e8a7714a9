"""Cache of the body pressed last, valid while its file is unchanged.

Tools need seconds to prepare on a body; the next press on it reuses that.
"""

from __future__ import annotations

from pathlib import Path

import bpy

from ...core.body.soft_body import SoftBody
from ...core.compliance.mapped import MappedCompliance
from . import body_store, hung_map

# The body, its file, and the file's state when read.
_kept: tuple[tuple[object, ...], SoftBody] | None = None


def load(thing: bpy.types.Object) -> SoftBody:
    """Load as :func:`body_store.load`, but the same body while its file is unchanged.

    Raises
    ------
    PalpateError
        As there.
    """
    global _kept  # noqa: PLW0603  one cached body
    path = body_store.locate(thing)
    stamp = None if path is None else _stamp(path, thing.palpate.body_key)
    if _kept is not None and _kept[0] == stamp:
        return _kept[1]
    body = body_store.load(thing)
    # A mapped table keeps its file open, which some systems then cannot replace.
    in_file = isinstance(body.compliance, MappedCompliance)
    _kept = None if stamp is None or in_file else (stamp, body)
    return body


def forget() -> None:
    """Free the memory."""
    global _kept  # noqa: PLW0603  see load
    _kept = None
    hung_map.forget()


def _stamp(path: Path, key: str) -> tuple[object, ...]:
    about = path.stat()
    return (path, key, about.st_mtime_ns, about.st_size, about.st_ino)
