"""Bodies to measure on: two stored mice, and mice of any size made by fTetWild and kept.

fTetWild does not give the same tetrahedra twice, so figures are compared on the stored ones.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.mesh.tetrahedralize import tetrahedralize

PROJECT = Path(__file__).resolve().parents[2]
SCENES = PROJECT / "sample_scenes"
STORED = (PROJECT / "tests" / "meshes", PROJECT.parent / "shared" / "meshes")
MADE = PROJECT / "build" / "bodies"
SHAPE = "mouse-1.7k"
SIZE_OF_MISSING = {"mouse-20k": 20_000}

# Share of the lowest surface nodes that are pinned, as in the stored bodies.
PINNED_SHARE = 0.1

# Nodes that fTetWild made of the mouse's surface at these edge lengths (shares of the diagonal).
EDGE_LENGTHS = (0.08, 0.05, 0.03, 0.02, 0.014, 0.01)
NODES_AT_EDGE = (970, 1_280, 3_170, 11_970, 24_500, 82_950)
EPSILON = 0.003
TIME_LIMIT = 1800.0


@dataclass(frozen=True, eq=False)
class MeasuredBody:
    """Tetrahedra and pins under a name for tables.

    Attributes
    ----------
    name : how tables call it.
    mesh : the tetrahedra.
    fixed : int64 (p,), numbers of the pinned nodes.
    """

    name: str
    mesh: TetMesh
    fixed: NDArray[np.int64]

    @property
    def free_surface_count(self) -> int:
        """Number of surface nodes that are not pinned."""
        return len(np.setdiff1d(self.mesh.surface_nodes, self.fixed))


def stored_body(name: str) -> MeasuredBody:
    """The stored body ``mouse-1.7k`` or ``mouse-20k``.

    The larger one does not come with the project; where it is not found, a body of its size is
    made, and its name says so.
    """
    for folder in STORED:
        file = folder / f"{name}.npz"
        if file.exists():
            return _read(name, file)
    return made_body(SIZE_OF_MISSING[name])


def tets_of(name: str) -> tuple[TetMesh, NDArray[np.int64]]:
    """Tetrahedra and pins of the paper's ``cube``, of a sample scene's ``mouse``, ``drumstick`` or
    ``hare``, or of a stored body.
    """
    if name == "cube":
        return paper_cube()
    scene = SCENES / f"{name}-tets.npz"
    body = _read(name, scene) if scene.exists() else stored_body(name)
    return body.mesh, body.fixed


def surface_of(name: str) -> Surface:
    """The surface of such tetrahedra."""
    return _boundary(tets_of(name)[0])


def made_body(nodes: int) -> MeasuredBody:
    """The mouse's surface filled by fTetWild with about ``nodes`` nodes, kept in build/bodies.

    Fifty thousand take some minutes the first time.
    """
    name = f"made-{nodes / 1000:g}k"
    file = MADE / f"{name}.npz"
    if not file.exists():
        _make(file, nodes)
    return _read(name, file)


def _make(file: Path, nodes: int) -> None:
    """In a process of its own, since fTetWild drops files where it stands and cannot be stopped."""
    edge_length = np.exp(np.interp(np.log(nodes), np.log(NODES_AT_EDGE), np.log(EDGE_LENGTHS)))
    print(f"making a body of about {nodes} nodes ...", file=sys.stderr, flush=True)
    file.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        unfinished = Path(folder) / "body.npz"
        subprocess.run(
            [sys.executable, __file__, str(edge_length), str(unfinished)],
            cwd=folder,
            check=True,
            timeout=TIME_LIMIT,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        file.with_suffix(".tmp").write_bytes(unfinished.read_bytes())
    file.with_suffix(".tmp").replace(file)


def _fill(edge_length: float, file: Path) -> None:
    surface = _boundary(stored_body(SHAPE).mesh)
    mesh = tetrahedralize(surface, edge_length, EPSILON)
    height = mesh.nodes[mesh.surface_nodes, 2]
    lowest = np.argsort(height, kind="stable")[: round(PINNED_SHARE * len(height))]
    np.savez_compressed(file, X=mesh.nodes, T=mesh.tets, fixed=np.sort(mesh.surface_nodes[lowest]))


def _boundary(mesh: TetMesh) -> Surface:
    return Surface.checked(mesh.nodes[mesh.surface_nodes], mesh.surface_local_triangles)


def _read(name: str, file: Path) -> MeasuredBody:
    with np.load(file) as stored:
        mesh = TetMesh.checked(stored["X"], stored["T"])
        return MeasuredBody(name, mesh, np.unique(stored["fixed"]).astype(np.int64))


if __name__ == "__main__":
    _fill(float(sys.argv[1]), Path(sys.argv[2]))
