"""The body file: one ``.npz`` that ``numpy.load(allow_pickle=False)`` reads.

Keys
----
format : the word ``palpate-body``.
version : int, of this layout.
key : hex digest of all that the compliance depends on; see :func:`body_key`.
checksum : hex digest over all arrays below.
nodes (N, 3) f64, tets (M, 4) i64, surface_triangles (S, 3) i64, fixed (p,) i64,
free_surface (n,) i64, compliance (n, 3, 3n) f32 for a modulus of 1 Pa,
poisson_ratio f64, young_modulus f64 (what the maker chose; not part of the key).
"""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .body_key import body_key
from .dense_compliance import DenseCompliance
from .errors import PalpateError
from .npz_archive import ArchiveError, read_arrays
from .soft_body import SoftBody
from .stiffness import lame_parameters
from .tet_mesh import TetMesh
from .whole_file import whole_file

__all__ = ["BodyFileError", "adopt", "body_key", "load", "save"]

Arrays = dict[str, NDArray[Any]]

FORMAT = "palpate-body"
VERSION = 1
ARRAYS = (
    "nodes",
    "tets",
    "surface_triangles",
    "fixed",
    "free_surface",
    "compliance",
    "poisson_ratio",
    "young_modulus",
)


class BodyFileError(PalpateError):
    """A body file that cannot be used. A new bake replaces it."""


def save(body: SoftBody, path: str | os.PathLike[str]) -> None:
    """Write a body file; an existing one is replaced in one step or stays as it was.

    Raises
    ------
    UnwritableError
        The place cannot be written.
    """
    arrays: Arrays = {
        "nodes": body.mesh.nodes,
        "tets": body.mesh.tets,
        "surface_triangles": body.mesh.surface_triangles,
        "fixed": body.fixed,
        "free_surface": body.compliance.free_surface,
        "compliance": _table(body).astype(np.float32, copy=False),
        "poisson_ratio": np.array(body.poisson_ratio),
        "young_modulus": np.array(body.young_modulus),
    }
    with whole_file(Path(path), make_folders=True) as file:
        np.savez(
            file,
            allow_pickle=False,
            format=np.array(FORMAT),
            version=np.array(VERSION),
            key=np.array(body.key),
            checksum=np.array(_checksum(arrays)),
            **arrays,
        )


def load(path: str | os.PathLike[str]) -> SoftBody:
    """Read a body file and check it: format, version, checksum, key.

    Raises
    ------
    BodyFileError
        Missing, truncated, damaged, foreign, or of another version. Names the file.
    """
    source = Path(path)
    stored = _read(source)
    if "format" not in stored or str(stored["format"]) != FORMAT:
        raise BodyFileError(f"{source}: not a Palpate body file; bake the mesh to make one")
    version = str(stored.get("version", 0))
    if version != str(VERSION):
        raise BodyFileError(
            f"{source}: written in version {version} of the body format, this Palpate reads "
            f"version {VERSION}; bake again"
        )
    missing = [name for name in (*ARRAYS, "key", "checksum") if name not in stored]
    if missing:
        raise BodyFileError(f"{source}: damaged ({', '.join(missing)} missing); bake again")
    if str(stored["checksum"]) != _checksum({name: stored[name] for name in ARRAYS}):
        raise BodyFileError(f"{source}: damaged (its checksum does not match); bake again")
    try:
        return _body(stored)
    except PalpateError as problem:
        raise BodyFileError(f"{source}: {problem}; bake again") from problem


def adopt(finished: Path, target: Path) -> None:
    """Put the ``finished`` body file at ``target`` in one step, also across file systems.

    Raises
    ------
    UnwritableError
        The place cannot be written; nothing is left there.
    """
    with whole_file(target, make_folders=True) as file, finished.open("rb") as source:
        shutil.copyfileobj(source, file)


def _table(body: SoftBody) -> NDArray[np.floating]:
    if not isinstance(body.compliance, DenseCompliance):
        raise TypeError(f"no layout for a compliance of the form {body.compliance.form}")
    return body.compliance.table


def _read(source: Path) -> Arrays:
    if not source.is_file():
        raise BodyFileError(f"{source}: there is no such body file; bake the mesh first")
    try:
        return read_arrays(source)
    except ArchiveError as problem:
        raise BodyFileError(f"{problem}; bake again") from problem


def _body(stored: Arrays) -> SoftBody:
    """The body of arrays whose checksum is right; PalpateError where they contradict each other."""
    mesh = TetMesh.checked(stored["nodes"], stored["tets"])
    fixed = stored["fixed"].astype(np.int64)
    poisson_ratio, young_modulus = float(stored["poisson_ratio"]), float(stored["young_modulus"])
    lame_parameters(young_modulus, poisson_ratio)
    free_surface = stored["free_surface"].astype(np.int64)
    table = stored["compliance"].astype(np.float32, copy=False)
    consistent = (
        str(stored["key"]) == body_key(mesh, fixed, poisson_ratio)
        and np.array_equal(free_surface, np.setdiff1d(mesh.surface_nodes, fixed))
        and table.shape == (len(free_surface), 3, 3 * len(free_surface))
    )
    if not consistent:
        raise PalpateError("its compliance does not belong to its mesh, pins or material")
    return SoftBody(mesh, fixed, poisson_ratio, DenseCompliance(free_surface, table), young_modulus)


def _checksum(arrays: Arrays) -> str:
    digest = hashlib.sha256()
    for name in ARRAYS:
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.data if array.ndim else array.tobytes())
    return digest.hexdigest()
