"""Body file: one ``.npz`` that ``numpy.load(allow_pickle=False)`` reads.

Keys
----
format : the word ``palpate-body``.
version : int, of this layout.
key : hex digest of all that the compliance depends on; see :func:`.body_key.body_key`.
checksum : hex digest over all other arrays but ``compliance``, which has its own.
nodes (N, 3) f64, tets (M, 4) i64, surface_triangles (S, 3) i64, fixed (p,) i64, poisson_ratio f64,
formulation text, young_modulus f64 (what the maker chose; not part of the key),
young_scale (M,) f64 where the body is not equally stiff everywhere,
law text, of :data:`..law.of_material.LAWS`, where it is not rubber's (not part of the key),
density f64, kg/m3, of a free body (whose ``fixed`` is empty) and where it is known,
fit (11,) f64 where the surface that it was made from was known; see :class:`..mesh.fit.Fit`.
form : of the compliance, for a modulus of 1 Pa: ``dense`` or ``compressed``.
free_surface (n,) i64.
dense : compliance (n, 3, 3n) f32, compliance_diagonal (n, 3, 3) f32,
compliance_checksums (n, 32) u8, one SHA-256 for the columns of each node.
compressed : tolerance f64 and the arrays of :class:`.compression.CompressedCompliance`.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..compliance.compression.compressed_compliance import CompressedCompliance
from ..compliance.definite import refuse_indefinite
from ..compliance.dense import DenseCompliance
from ..compliance.free_body.density import density_checked
from ..compliance.mapped import MappedCompliance, node_checksums
from ..compliance.protocol import Compliance
from ..errors import BodyFileError, PalpateError
from ..files.atomic_file import atomic_file
from ..files.npz_archive import Archive, ArchiveError, opened, write_arrays
from ..files.windows.long_path import reaching
from ..files.windows.shared_reading import open_shared
from ..law.of_material import RUBBER, law_checked
from ..mesh.fit import Fit
from ..mesh.tet_mesh import TetMesh, young_scale_checked
from ..stiffness.assembly import lame_parameters
from ..stiffness.formulation import formulation_checked
from ..stiffness.held_pins import free_or_pinned
from .body_key import body_key, is_key_of
from .body_layout import HEAD, NEEDED_BY_FORM, TABLE, refuse_no_text, refuse_wrong_layout
from .soft_body import SoftBody

__all__ = ["BodyFileError", "adopt", "body_key", "load", "save"]

Arrays = dict[str, NDArray[Any]]

FORMAT = "palpate-body"
VERSION = 2
FORMS = tuple(NEEDED_BY_FORM)

MAPPED_FROM_BYTES = 64_000_000
"""Tables from here on are memory-mapped."""


def save(body: SoftBody, path: str | os.PathLike[str]) -> None:
    """Write a body file; an existing one is replaced atomically.

    >>> from tempfile import TemporaryDirectory
    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> body, _ = bake(paper_cube()[0], BakeSettings(poisson_ratio=0.45, young_modulus=1e5))
    >>> with TemporaryDirectory() as folder:
    ...     save(body, f"{folder}/cube.npz")
    ...     load(f"{folder}/cube.npz").key == body.key
    True

    Raises
    ------
    UnwritableError
        The target cannot be written.
    """
    arrays: Arrays = {
        "key": np.array(body.key),
        "nodes": body.mesh.nodes,
        "tets": body.mesh.tets,
        "surface_triangles": body.mesh.surface_triangles,
        "fixed": body.fixed,
        "poisson_ratio": np.array(body.poisson_ratio),
        "formulation": np.array(body.formulation),
        "young_modulus": np.array(body.young_modulus),
        "form": np.array(body.compliance.form),
        "free_surface": body.compliance.free_surface,
    }
    if body.young_scale is not None:
        arrays["young_scale"] = body.young_scale
    if body.fit is not None:
        arrays["fit"] = body.fit.as_array()
    if body.law != RUBBER:
        arrays["law"] = np.array(body.law)
    if body.density is not None:
        arrays["density"] = np.array(body.density)
    arrays |= _compliance_arrays(body.compliance)
    head = {
        "format": np.array(FORMAT),
        "version": np.array(VERSION),
        "checksum": np.array(_checksum(arrays)),
    }
    with atomic_file(Path(path), make_folders=True) as file:
        write_arrays(file, head | arrays)


def load(
    path: str | os.PathLike[str], mapped_from_bytes: int | None = MAPPED_FROM_BYTES
) -> SoftBody:
    """Read a body file and check it: format, version, checksum, key.

    A large dense table is mapped, its columns checked when they are used
    (:class:`..compliance.mapped.MappedCompliance`). The file may be replaced or deleted meanwhile.

    Parameters
    ----------
    path : the file.
    mapped_from_bytes : smallest size of a mapped table; None maps none.

    Raises
    ------
    BodyFileError
        Missing, truncated, damaged, foreign, or of another version. Names the file.
    """
    source = Path(path)
    if not reaching(source).exists():
        raise BodyFileError(
            "{source}: there is no such body file; bake the mesh first", source=source
        )
    if not reaching(source).is_file():
        raise BodyFileError(
            "{path}: is a folder, a device or a pipe; give an ordinary file", path=source
        )
    try:
        with opened(source) as archive:
            return _read(archive, source, mapped_from_bytes)
    except ArchiveError as problem:
        raise BodyFileError("{problem}; bake again", problem=problem) from problem


def adopt(finished: Path, target: Path) -> None:
    """Move the ``finished`` body file to ``target`` atomically, also across file systems.

    Raises
    ------
    UnwritableError
        The target cannot be written; nothing is left there.
    """
    with atomic_file(target, make_folders=True) as file, open_shared(finished) as source:
        shutil.copyfileobj(source, file)


def _compliance_arrays(compliance: Compliance) -> Arrays:
    match compliance:
        case CompressedCompliance():
            return {"tolerance": np.array(compliance.tolerance), **compliance.arrays()}
        case DenseCompliance(table=given) | MappedCompliance(table=given):
            table = given.astype(np.float32, copy=False)
            stored = DenseCompliance(compliance.free_surface, table)
            return {
                TABLE: table,
                "compliance_diagonal": stored.diagonal().astype(np.float32),
                "compliance_checksums": node_checksums(table),
            }
    raise TypeError(f"no layout for a compliance of the form {compliance.form}")


def _read(archive: Archive, source: Path, mapped_from_bytes: int | None) -> SoftBody:
    try:
        refuse_no_text(archive.heads)
        form = _form(archive, source)
        refuse_wrong_layout(archive.heads, form)
        stored = {name: archive.read(name) for name in archive.names if name != TABLE}
        if str(stored["checksum"]) != _checksum(stored):
            raise _damaged()
        return _body(stored, _compliance(stored, archive, source, mapped_from_bytes))
    except PalpateError as problem:
        if isinstance(problem, (ArchiveError, BodyFileError)):
            raise
        raise BodyFileError(
            "{source}: {problem}; bake again", source=source, problem=problem
        ) from problem


def _form(archive: Archive, source: Path) -> str:
    """Form of the compliance of a body file in this version of the format."""
    names = archive.names
    if "format" not in names or str(archive.read("format")) != FORMAT:
        raise BodyFileError(
            "{source}: not a Palpate body file; bake the mesh to make one", source=source
        )
    version = str(archive.read("version")) if "version" in names else "0"
    if version != str(VERSION):
        raise BodyFileError(
            "{source}: written in version {held} of the body format, this Palpate reads "
            "version {own}; bake again",
            source=source,
            held=version,
            own=VERSION,
        )
    form = str(archive.read("form")) if "form" in names else "dense"
    if form not in FORMS:
        raise PalpateError("its compliance has the unknown form '{form}'", form=form)
    return form


def _compliance(
    stored: Arrays, archive: Archive, source: Path, mapped_from_bytes: int | None
) -> Compliance:
    """Compliance in the stored form, checked; a mapped table where it is used."""
    free_surface = stored["free_surface"].astype(np.int64)
    if str(stored["form"]) == "compressed":
        return CompressedCompliance.from_arrays(free_surface, stored, float(stored["tolerance"]))
    checksums, diagonal = stored["compliance_checksums"], stored["compliance_diagonal"]
    is_mapped = mapped_from_bytes is not None and archive.heads[TABLE].nbytes >= mapped_from_bytes
    if is_mapped:
        mapped = archive.map(TABLE)
        return MappedCompliance(free_surface, mapped, diagonal, checksums, str(source))
    table = archive.read(TABLE)
    if not np.array_equal(node_checksums(table), checksums):
        raise _damaged()
    return DenseCompliance(free_surface, table)


def _damaged() -> PalpateError:
    return PalpateError("damaged (its checksum does not match)")


def _body(stored: Arrays, compliance: Compliance) -> SoftBody:
    """Body from arrays with checked checksum; PalpateError where they contradict each other."""
    mesh = TetMesh.checked(stored["nodes"], stored["tets"])
    poisson_ratio, young_modulus = float(stored["poisson_ratio"]), float(stored["young_modulus"])
    lame_parameters(young_modulus, poisson_ratio)
    body = SoftBody(
        mesh,
        free_or_pinned(mesh, stored["fixed"]),
        poisson_ratio,
        compliance,
        young_modulus,
        formulation_checked(str(stored["formulation"])),
        young_scale_checked(stored["young_scale"], len(mesh.tets))
        if "young_scale" in stored
        else None,
        Fit.of_array(stored["fit"]) if "fit" in stored else None,
        density=density_checked(float(stored["density"])) if "density" in stored else None,
        law=law_checked(str(stored["law"])) if "law" in stored else RUBBER,
    )
    if body.is_free and body.density is None:
        raise PalpateError("damaged ({missing} missing)", missing="density")
    key = str(stored["key"])
    if key != body.key and is_key_of(
        key, mesh, body.fixed, poisson_ratio, body.formulation, body.young_scale
    ):
        body = replace(body, older_key=key)
    free_surface = np.setdiff1d(mesh.surface_nodes, body.fixed)
    if key != body.key or not np.array_equal(compliance.free_surface, free_surface):
        raise PalpateError("its compliance does not belong to its mesh, pins or material")
    refuse_indefinite(compliance)
    return body


def _checksum(arrays: Arrays) -> str:
    digest = hashlib.sha256()
    for name in sorted(arrays.keys() - {*HEAD, TABLE}):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.data if array.ndim and array.dtype.kind != "U" else array.tobytes())
    return digest.hexdigest()
