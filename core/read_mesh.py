"""Mesh files for the command line: surfaces (obj, ply, stl) and tetrahedra (npz)."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import PalpateError
from .surface import Surface
from .tet_mesh import TetMesh

SURFACE_SUFFIXES = (".obj", ".ply", ".stl")


def read_surface(path: Path, metres_per_unit: float = 1.0) -> Surface:
    """Read a surface; polygons are triangulated, parts are joined.

    Raises
    ------
    PalpateError
        No such file, an unknown kind, contents that cannot be read or cannot become a solid.
    """
    _refuse_missing(path)
    read = _read_ply if path.suffix.lower() == ".ply" else _read_obj_or_stl
    try:
        vertices, triangles = read(path)
    except Exception as problem:  # readers raise many kinds for a damaged file; all mean the same
        raise PalpateError(
            f"{path}: cannot be read as {path.suffix[1:]} ({problem}); export it again"
        ) from problem
    try:
        return Surface.checked(vertices * metres_per_unit, triangles)
    except PalpateError as problem:
        raise PalpateError(f"{path}: {problem}") from problem


def read_tets(path: Path, metres_per_unit: float = 1.0) -> tuple[TetMesh, NDArray[np.int64] | None]:
    """Read tetrahedra: arrays ``X`` (N, 3), ``T`` (M, 4) and, if there, ``fixed`` node numbers.

    Raises
    ------
    PalpateError
        No such file, not an npz, arrays missing or unusable.
    """
    _refuse_missing(path)
    try:
        # Opened here, since numpy leaves a damaged archive open.
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {name: file[name] for name in ("X", "T", "fixed") if name in file.files}
    except (OSError, EOFError, ValueError, AttributeError, zipfile.BadZipFile) as problem:
        raise PalpateError(
            f"{path}: damaged or not an npz file ({problem}); save it again with numpy.savez"
        ) from problem
    missing = [name for name in ("X", "T") if name not in arrays]
    if missing:
        raise PalpateError(
            f"{path}: has no array {' and '.join(missing)}; a tetrahedral mesh holds X (nodes), "
            "T (tetrahedra) and optionally fixed (pinned nodes)"
        )
    try:
        mesh = TetMesh.checked(arrays["X"] * metres_per_unit, arrays["T"])
    except PalpateError as problem:
        raise PalpateError(f"{path}: {problem}") from problem
    fixed = arrays.get("fixed")
    return mesh, None if fixed is None else fixed.astype(np.int64)


def _read_obj_or_stl(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    import trimesh

    materials = {"skip_materials": True} if path.suffix.lower() == ".obj" else {}
    mesh = trimesh.load_mesh(path, process=False, **materials)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def _read_ply(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read with plyfile, which takes files that mix triangles, quads and larger polygons."""
    from plyfile import PlyData

    data = PlyData.read(path)
    vertex = data["vertex"]
    vertices = np.column_stack([vertex[axis] for axis in "xyz"]).astype(np.float64)
    polygons = data["face"].data[data["face"].data.dtype.names[0]] if "face" in data else []
    fans = [_fan(np.asarray(polygon, dtype=np.int64)) for polygon in polygons]
    return vertices, np.concatenate(fans) if fans else np.empty((0, 3), dtype=np.int64)


def _fan(polygon: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (k - 2, 3) of a polygon of k corners."""
    first = np.repeat(polygon[:1], len(polygon) - 2)
    return np.column_stack([first, polygon[1:-1], polygon[2:]])


def _refuse_missing(path: Path) -> None:
    if not path.is_file():
        raise PalpateError(f"{path}: there is no such file; check the path")
    if path.suffix.lower() not in (*SURFACE_SUFFIXES, ".npz"):
        raise PalpateError(
            f"{path}: files of kind '{path.suffix}' cannot be read; give obj, ply, stl or npz"
        )
