"""The body that was pressed last, kept while its file stays as it is.

What a tool needs of a body takes seconds to compute and lives as long as the body: the next press
shall not wait for it again.
"""

from __future__ import annotations

from pathlib import Path

import bpy

from ...core.body.soft_body import SoftBody
from ...core.compliance.mapped import MappedCompliance
from . import body_store

# What was read, of which file as it was then.
_kept: tuple[tuple[object, ...], SoftBody] | None = None


def load(thing: bpy.types.Object) -> SoftBody:
    """As :func:`body_store.load`, but the same body again while its file is the same.

    Raises
    ------
    PalpateError
        As there.
    """
    global _kept  # noqa: PLW0603  one body at most is a fact of the module
    path = body_store.locate(thing)
    stamp = None if path is None else _stamp(path, thing.palpate.body_key)
    if _kept is not None and _kept[0] == stamp:
        return _kept[1]
    body = body_store.load(thing)
    # A table that is read in its file would hold the file, which some systems do not let go then.
    in_file = isinstance(body.compliance, MappedCompliance)
    _kept = None if stamp is None or in_file else (stamp, body)
    return body


def forget() -> None:
    """Free the memory."""
    global _kept  # noqa: PLW0603  see load
    _kept = None


def _stamp(path: Path, key: str) -> tuple[object, ...]:
    about = path.stat()
    return (path, key, about.st_mtime_ns, about.st_size, about.st_ino)
