"""Mesh files for the command line: surfaces (obj, ply, stl) and tetrahedra (npz)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..files.npz_archive import ArchiveError, read_arrays
from ..files.ordinary_file import refuse_missing
from ..files.windows.long_path import reaching
from ..files.windows.shared_reading import open_shared
from ..sentence import Sentence
from .coordinates import refuse_rounded
from .formats.obj import read_obj
from .formats.ply import read_ply
from .formats.polygons import MeshFormatError
from .formats.stl import read_stl
from .surface import Surface
from .tet_mesh import TetMesh, young_scale_checked

# Ten million triangles and more, of which a bake keeps some thousands.
MOST_BYTES = 1_000_000_000


def read_surface(path: Path, metres_per_unit: float = 1.0) -> Surface:
    """Read a surface; polygons are triangulated, parts are joined.

    Raises
    ------
    PalpateError
        No such file, an unknown kind, one too large, contents that cannot be read or cannot become
        a solid.
    """
    refuse_missing(path)
    if path.suffix.lower() not in READERS:
        raise PalpateError(
            f"{path}: a file of kind '{path.suffix}' holds no surface; give obj, ply or stl, or to "
            "bake tetrahedra as npz"
        )
    size = reaching(path).stat().st_size
    if size > MOST_BYTES:
        raise PalpateError(
            f"{path}: has {size / 1e9:.1f} GB, and a surface at most {MOST_BYTES / 1e9:g} GB; "
            "decimate it before you export it"
        )
    try:
        with open_shared(path) as stream:
            vertices, triangles = READERS[path.suffix.lower()](stream, size)
    except MeshFormatError as problem:
        raise PalpateError(
            f"{path}: cannot be read as {path.suffix[1:]} ({problem}); export it again"
        ) from problem
    try:
        # In the file's own precision, of which float64 keeps no trace.
        refuse_rounded(Sentence("mesh"), vertices)
        return Surface.checked(vertices.astype(np.float64) * metres_per_unit, triangles)
    except PalpateError as problem:
        raise PalpateError(f"{path}: {problem}") from problem


@dataclass(frozen=True, eq=False)
class TetFile:
    """Contents of a file of tetrahedra.

    Attributes
    ----------
    mesh : the tetrahedra.
    fixed : int64, numbers of the pinned nodes; None where the file does not say.
    young_scale : float64 (M,), factors on Young's modulus; None where the file does not say.
    """

    mesh: TetMesh
    fixed: NDArray[np.int64] | None
    young_scale: NDArray[np.float64] | None


def read_tets(path: Path, metres_per_unit: float = 1.0) -> TetFile:
    """Read tetrahedra: arrays ``X`` (N, 3), ``T`` (M, 4) and, if there, ``fixed``, ``young_scale``.

    ``fixed`` are node numbers, or a mask with one boolean a node.

    Raises
    ------
    PalpateError
        No such file, not an npz, arrays missing or unusable.
    """
    refuse_missing(path)
    try:
        arrays = read_arrays(path)
    except ArchiveError as problem:
        raise PalpateError(f"{problem}; save it again with numpy.savez") from problem
    missing = [name for name in ("X", "T") if name not in arrays]
    if missing:
        raise PalpateError(
            f"{path}: has no array {' and '.join(missing)}; a tetrahedral mesh holds X (nodes), "
            "T (tetrahedra) and optionally fixed (pinned nodes) and young_scale (stiffness)"
        )
    try:
        refuse_rounded(Sentence("tetrahedral mesh"), arrays["X"])
        mesh = TetMesh.checked(_metres(arrays["X"], metres_per_unit), arrays["T"])
        fixed = _node_numbers(arrays["fixed"], len(mesh.nodes)) if "fixed" in arrays else None
        scale = None
        if "young_scale" in arrays:
            scale = young_scale_checked(arrays["young_scale"], len(mesh.tets))
    except PalpateError as problem:
        raise PalpateError(f"{path}: {problem}") from problem
    return TetFile(mesh, fixed, scale)


def _metres(given: NDArray[Any], metres_per_unit: float) -> NDArray[Any]:
    """Coordinates in metres, double precision, not checked."""
    is_number = given.dtype.kind in "fiu"
    return given.astype(np.float64) * metres_per_unit if is_number else given


def _node_numbers(fixed: NDArray[Any], node_count: int) -> NDArray[np.int64]:
    if fixed.dtype == np.bool_ and fixed.shape == (node_count,):
        return np.flatnonzero(fixed)
    if fixed.size and not np.issubdtype(fixed.dtype, np.integer):
        raise PalpateError(
            f"fixed: an array of {fixed.dtype} and shape {fixed.shape} names no nodes; give node "
            f"numbers as integers, or {node_count} booleans"
        )
    # Before they become signed.
    if fixed.size and fixed.max() >= node_count:
        raise PalpateError(
            f"fixed: names node {fixed.max()}, but nodes are numbered 0 to {node_count - 1}; count "
            "from zero"
        )
    return fixed.astype(np.int64).ravel()


READERS = {".obj": lambda stream, _: read_obj(stream), ".ply": read_ply, ".stl": read_stl}
