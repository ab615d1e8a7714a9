"""The file beside a body that keeps its softenings: one ``.npz``, written whole or not at all.

Keys
----
format : the word ``palpate-softening``.
version : int, of this layout and of how softenings are computed.
key : of the body; see :func:`..body_key.body_key`.
softening (s, 4) f64 and known (s,) bool, by ``mesh.surface_nodes``.
checksum : hex digest over all of these.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..npz_archive import read_arrays, write_arrays
from ..whole_file import whole_file

FORMAT = "palpate-softening"
VERSION = 1


def softening_path(body_file: Path) -> Path:
    """Where the softenings of a body file are kept."""
    return body_file.with_name(f"{body_file.stem}.softening.npz")


def save_softening(
    path: Path, key: str, softening: NDArray[np.float64], known: NDArray[np.bool_]
) -> None:
    """Write the file; an existing one is replaced in one step or stays as it was.

    Raises
    ------
    UnwritableError
        The place cannot be written.
    """
    arrays = {
        "format": np.array(FORMAT),
        "version": np.array(VERSION),
        "key": np.array(key),
        "softening": softening,
        "known": known,
        "checksum": np.array(_checksum(key, softening, known)),
    }
    with whole_file(path) as file:
        write_arrays(file, arrays)


def load_softening(
    path: Path, key: str, count: int
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Softenings (s, 4) and which are known (s,), of the body with this key and ``count`` nodes.

    Raises
    ------
    PalpateError
        Damaged, foreign, of another version or another body.
    """
    arrays = read_arrays(path)
    if str(arrays.get("format")) != FORMAT:
        raise PalpateError(f"{path}: no file of softenings; it will be replaced")
    if str(arrays.get("version")) != str(VERSION) or str(arrays.get("key")) != key:
        raise PalpateError(f"{path}: made for another body or version; it will be replaced")
    softening, known = arrays.get("softening"), arrays.get("known")
    if (
        softening is None
        or known is None
        or softening.shape != (count, 4)
        or known.shape != (count,)
        or softening.dtype != np.float64
        or known.dtype != np.bool_
        or str(arrays.get("checksum")) != _checksum(key, softening, known)
    ):
        raise PalpateError(f"{path}: damaged; it will be replaced")
    return softening, known


def _checksum(key: str, softening: NDArray[np.float64], known: NDArray[np.bool_]) -> str:
    digest = hashlib.sha256(f"{FORMAT} {VERSION} {key}".encode())
    digest.update(np.ascontiguousarray(softening).tobytes())
    digest.update(np.ascontiguousarray(known).tobytes())
    return digest.hexdigest()
