"""Mesh files for the command line: surfaces (obj, ply, stl) and tetrahedra (npz)."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..files.npz_archive import ArchiveError, read_arrays
from ..sentence import Sentence
from .coordinates import refuse_rounded
from .surface import Surface
from .tet_mesh import TetMesh, young_scale_checked


def read_surface(path: Path, metres_per_unit: float = 1.0) -> Surface:
    """Read a surface; polygons are triangulated, parts are joined.

    Raises
    ------
    PalpateError
        No such file, an unknown kind, contents that cannot be read or cannot become a solid.
    """
    _refuse_missing(path)
    try:
        vertices, triangles = READERS[path.suffix.lower()](path)
    except Exception as problem:  # readers raise many kinds for a damaged file; all mean the same
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
    _refuse_missing(path)
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
    return fixed.astype(np.int64).ravel()


def _read_obj(path: Path) -> tuple[NDArray[Any], NDArray[np.int64]]:
    # Object names may be in any encoding; they are not used.
    text = path.read_text(encoding="utf-8", errors="replace")
    return _by_trimesh(io.StringIO(text), "obj", skip_materials=True)


def _read_stl(path: Path) -> tuple[NDArray[Any], NDArray[np.int64]]:
    content = path.read_bytes()
    # Binary files may begin with "solid" too; only the length is decisive.
    if len(content) == 84 + 50 * int.from_bytes(content[80:84], "little"):
        vertices, triangles = _by_trimesh(io.BytesIO(content), "stl")
        return vertices.astype(np.float32), triangles
    text = content.decode("utf-8", errors="replace")
    if "facet" not in text:
        raise ValueError("neither text nor as long as its binary header says")
    return _by_trimesh(io.StringIO(text), "stl_ascii")


def _by_trimesh(
    content: io.StringIO | io.BytesIO, kind: str, **options: bool
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import trimesh

    mesh = trimesh.load_mesh(content, file_type=kind, process=False, **options)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def _read_ply(path: Path) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Surface read by plyfile, which takes mixed triangles, quads and larger polygons."""
    from plyfile import PlyData, PlyListProperty

    data = PlyData.read(path)
    vertex = data["vertex"]
    vertices = np.column_stack([vertex[axis] for axis in "xyz"])
    if "face" not in data:
        return vertices, np.empty((0, 3), dtype=np.int64)
    lists = [entry.name for entry in data["face"].properties if isinstance(entry, PlyListProperty)]
    name = next(name for name in ("vertex_indices", "vertex_index", *lists) if name in lists)
    fans = [_fan(np.asarray(polygon, dtype=np.int64)) for polygon in data["face"][name]]
    return vertices, np.concatenate(fans) if fans else np.empty((0, 3), dtype=np.int64)


READERS = {".obj": _read_obj, ".ply": _read_ply, ".stl": _read_stl}


def _fan(polygon: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (k - 2, 3) of a polygon of k corners."""
    first = np.repeat(polygon[:1], len(polygon) - 2)
    return np.column_stack([first, polygon[1:-1], polygon[2:]])


def _refuse_missing(path: Path) -> None:
    if not path.is_file():
        raise PalpateError(f"{path}: there is no such file; check the path")
    if path.suffix.lower() not in (*READERS, ".npz"):
        raise PalpateError(
            f"{path}: files of kind '{path.suffix}' cannot be read; give obj, ply, stl or npz"
        )
