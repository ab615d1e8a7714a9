"""Files of tables that are kept beside a body's: what belongs to one body, and nothing else.

Keys
----
format : the word ``palpate-table``; version : int; kind : which table.
key : of the body, :attr:`palpate.core.body.soft_body.SoftBody.key`.
checksum : hex digest over all the table's own arrays, and over kind and key.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError
from ...files.atomic_file import UnwritableError, atomic_file
from ...files.npz_archive import ArchiveError, read_arrays, write_arrays
from ...files.own_file import is_free

FORMAT = "palpate-table"
VERSION = 1
HEAD = ("format", "version", "kind", "key", "checksum")


class TableFileError(PalpateError):
    """A table's file that cannot be used; the table is computed anew."""


def table_path(body_file: Path, kind: str) -> Path:
    """Path of a body's table: next to the body file, under its name."""
    return body_file.with_name(f"{body_file.stem}.{kind}{body_file.suffix}")


def write_table(path: Path, kind: str, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write the arrays of a table in one step.

    Raises
    ------
    UnwritableError
        The place cannot be written, or holds something else than a table; that stays as it was.
    """
    if not is_free(path, FORMAT):
        raise UnwritableError(
            "{target}: is no table of Palpate's, so it is not replaced; move it or rename it",
            target=path,
        )
    head = {
        "format": np.array(FORMAT),
        "version": np.array(VERSION),
        "kind": np.array(kind),
        "key": np.array(key),
        "checksum": np.array(_checksum(kind, key, arrays)),
    }
    with atomic_file(path, make_folders=True, follows_links=False) as file:
        write_arrays(file, head | dict(arrays))


def read_table(path: Path, kind: str, key: str) -> dict[str, NDArray[Any]]:
    """The arrays of a table that :func:`write_table` wrote.

    Raises
    ------
    TableFileError
        Damaged or foreign, of another version or kind, or of another body.
    """
    try:
        stored = read_arrays(path)
    except ArchiveError as problem:
        raise TableFileError("{problem}; its table is computed anew", problem=problem) from problem
    told = {name: str(stored[name]) for name in HEAD if name in stored}
    if told.get("format") != FORMAT:
        raise TableFileError("{path}: no table of Palpate's; its table is computed anew", path=path)
    if told.get("version") != str(VERSION) or told.get("kind") != kind:
        raise TableFileError(
            "{path}: holds {held} in version {held_version}, not {kind} in version {version}; its "
            "table is computed anew",
            path=path,
            held=told.get("kind"),
            held_version=told.get("version"),
            kind=kind,
            version=VERSION,
        )
    if told.get("key") != key:
        raise TableFileError(
            "{path}: belongs to another body; its table is computed anew", path=path
        )
    arrays = {name: array for name, array in stored.items() if name not in HEAD}
    if told.get("checksum") != _checksum(kind, key, arrays):
        raise TableFileError(
            "{path}: damaged (its checksum does not match); its table is computed anew", path=path
        )
    return arrays


def _checksum(kind: str, key: str, arrays: Mapping[str, NDArray[Any]]) -> str:
    digest = hashlib.sha256(f"{FORMAT} {VERSION} {kind} {key} ".encode())
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()
