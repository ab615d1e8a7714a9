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
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError
from ...files.atomic_file import UnwritableError, atomic_file
from ...files.npz_archive import ArchiveError, read_arrays, write_arrays
from ...files.own_file import is_free

FORMAT = "palpate-table"
VERSION = 1
HEAD = ("format", "version", "kind", "key", "checksum")


Layout = Mapping[str, tuple[type, tuple[int | None, ...]]]
"""Type and shape of each array of a table, None for any length."""


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


def read_table(path: Path, kind: str, key: str, layout: Layout) -> dict[str, NDArray[Any]]:
    """The arrays of a table that :func:`write_table` wrote.

    Parameters
    ----------
    layout : of the arrays: type and shape, None for any length.

    Raises
    ------
    TableFileError
        Damaged or foreign, of another version or kind, of another body, arrays of another layout,
        numbers that are not finite.
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
    # A checksum is no secret: whoever sends a file can write it.
    for name, (dtype, shape) in layout.items():
        array = arrays.get(name)
        if array is None or not _is_laid_out(array, dtype, shape):
            refuse(path, name)
    return arrays


def refuse(path: Path, name: str) -> NoReturn:
    """Refuse what a table says under a name.

    Raises
    ------
    TableFileError
        Always.
    """
    raise TableFileError(
        "{path}: what it holds as '{name}' cannot be; its table is computed anew",
        path=path,
        name=name,
    )


def _is_laid_out(array: NDArray[Any], dtype: type, shape: tuple[int | None, ...]) -> bool:
    fits = array.ndim == len(shape) and all(
        wanted in {None, length} for wanted, length in zip(shape, array.shape, strict=True)
    )
    return fits and array.dtype == dtype and bool(np.isfinite(array).all())


def _checksum(kind: str, key: str, arrays: Mapping[str, NDArray[Any]]) -> str:
    digest = hashlib.sha256(f"{FORMAT} {VERSION} {kind} {key} ".encode())
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()
