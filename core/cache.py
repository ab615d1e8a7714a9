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
import secrets
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .compliance import Compliance
from .errors import PalpateError
from .soft_body import SoftBody
from .tet_mesh import TetMesh

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


def body_key(mesh: TetMesh, fixed: ArrayLike, poisson_ratio: float) -> str:
    """Hex digest of everything the compliance depends on. Young's modulus is not part of it."""
    digest = hashlib.sha256(f"{FORMAT} {VERSION}".encode())
    digest.update(mesh.nodes.astype("<f8").tobytes())
    digest.update(mesh.tets.astype("<i8").tobytes())
    digest.update(np.unique(np.asarray(fixed)).astype("<i8").tobytes())
    digest.update(np.float64(poisson_ratio).astype("<f8").tobytes())
    return digest.hexdigest()


def save(body: SoftBody, path: str | os.PathLike[str]) -> None:
    """Write a body file; an existing one is replaced in one step or stays as it was.

    Raises
    ------
    BodyFileError
        The place cannot be written.
    """
    arrays: Arrays = {
        "nodes": body.mesh.nodes,
        "tets": body.mesh.tets,
        "surface_triangles": body.mesh.surface_triangles,
        "fixed": body.fixed,
        "free_surface": body.compliance.free_surface,
        "compliance": body.compliance.columns.astype(np.float32, copy=False),
        "poisson_ratio": np.array(body.poisson_ratio),
        "young_modulus": np.array(body.young_modulus),
    }
    with _replacing(Path(path)) as file:
        np.savez(
            file,
            allow_pickle=False,
            format=np.array(FORMAT),
            version=np.array(VERSION),
            key=np.array(body_key(body.mesh, body.fixed, body.poisson_ratio)),
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
    version = int(stored["version"]) if "version" in stored else 0
    if version != VERSION:
        raise BodyFileError(
            f"{source}: written in version {version} of the body format, this Palpate reads "
            f"version {VERSION}; bake again"
        )
    missing = [name for name in (*ARRAYS, "key", "checksum") if name not in stored]
    if missing:
        raise BodyFileError(f"{source}: damaged ({', '.join(missing)} missing); bake again")
    if str(stored["checksum"]) != _checksum({name: stored[name] for name in ARRAYS}):
        raise BodyFileError(f"{source}: damaged (its checksum does not match); bake again")
    return _body(source, stored)


def adopt(finished: Path, target: Path) -> None:
    """Put the ``finished`` body file at ``target`` in one step, also across file systems.

    Raises
    ------
    BodyFileError
        The place cannot be written; nothing is left there.
    """
    with _replacing(target) as file, finished.open("rb") as source:
        shutil.copyfileobj(source, file)


def refuse_unwritable(target: Path) -> None:
    """Check that a body file could be put at ``target``, before the work of a bake is spent.

    Raises
    ------
    BodyFileError
        The target is a folder, or its folder cannot be made or written.
    """
    folder = next(parent for parent in target.absolute().parents if parent.exists())
    if target.is_dir():
        reason = "it is a folder"
    elif not folder.is_dir():
        reason = f"{folder} is not a folder"
    elif not os.access(folder, os.W_OK | os.X_OK):
        reason = f"{folder} may not be written"
    else:
        return
    raise BodyFileError(
        f"{target}: the body file cannot be written ({reason}); choose a folder you may write to"
    )


@contextmanager
def _replacing(target: Path) -> Iterator[IO[bytes]]:
    """A file that becomes ``target`` when all went well, and vanishes otherwise."""
    refuse_unwritable(target)
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")
    try:
        with unfinished.open("xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(target)
    except OSError as problem:
        raise BodyFileError(
            f"{target}: the body file cannot be written ({problem.strerror or problem}); choose a "
            "folder you may write to, with enough room"
        ) from problem
    finally:
        unfinished.unlink(missing_ok=True)


def _read(source: Path) -> Arrays:
    if not source.is_file():
        raise BodyFileError(f"{source}: there is no such body file; bake the mesh first")
    try:
        # Opened here, since numpy leaves a damaged archive open.
        with source.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, EOFError, ValueError, KeyError, AttributeError, zipfile.BadZipFile) as problem:
        raise BodyFileError(
            f"{source}: damaged, cut short or not a Palpate body file "
            f"({type(problem).__name__}); bake again"
        ) from problem


def _body(source: Path, stored: Arrays) -> SoftBody:
    mesh = TetMesh.checked(stored["nodes"], stored["tets"])
    fixed = stored["fixed"].astype(np.int64)
    poisson_ratio = float(stored["poisson_ratio"])
    free_surface = stored["free_surface"].astype(np.int64)
    columns = stored["compliance"].astype(np.float32, copy=False)
    consistent = (
        str(stored["key"]) == body_key(mesh, fixed, poisson_ratio)
        and np.array_equal(free_surface, np.setdiff1d(mesh.surface_nodes, fixed))
        and columns.shape == (len(free_surface), 3, 3 * len(free_surface))
    )
    if not consistent:
        raise BodyFileError(
            f"{source}: its compliance does not belong to its mesh, pins or material; bake again"
        )
    return SoftBody(
        mesh,
        fixed,
        poisson_ratio,
        Compliance(free_surface, columns),
        float(stored["young_modulus"]),
    )


def _checksum(arrays: Arrays) -> str:
    digest = hashlib.sha256()
    for name in ARRAYS:
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.data if array.ndim else array.tobytes())
    return digest.hexdigest()
